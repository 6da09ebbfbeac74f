use std::path::{Path, PathBuf};

use gumption_format::files::{Files, Folder};
use gumption_gum::propagate::{MonteCarloChoice, Options, evaluate};

use super::*;

/// Every budget of the repository: its folder, its name and its text.
fn budgets() -> Vec<(PathBuf, String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../budgets");
    let root = root.canonicalize().expect("a folder");
    let folders = std::fs::read_dir(root).expect("budgets").flatten();
    let files = folders.filter_map(|folder| std::fs::read_dir(folder.path()).ok());
    let files = files.flatten().flatten().map(|file| file.path());
    let texts = files.filter(|path| path.extension().is_some_and(|ending| ending == "toml"));
    let read = texts.map(|path| {
        let name = path
            .file_name()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        let text = std::fs::read_to_string(&path).expect("a text");
        (path.parent().expect("a folder").to_owned(), name, text)
    });
    read.collect()
}

fn key(text: &str) -> Step {
    Step::Key(text.into())
}

fn path(text: &str) -> Vec<Step> {
    let step = |part: &str| part.parse().map_or_else(|_| key(part), Step::Index);
    text.split('.').map(step).collect()
}

fn typed(text: &str, at: &str, typed: &str) -> String {
    let edit = Edit::Set {
        path: path(at),
        typed: typed.into(),
    };
    edited(text, &[edit]).expect(at)
}

fn at<'v>(tree: &'v mut toml::Value, path: &[Step]) -> &'v mut toml::Value {
    path.iter().fold(tree, |there, step| match step {
        Step::Key(key) => &mut there[key.as_str()],
        Step::Index(at) => &mut there[*at],
    })
}

fn tree(text: &str) -> toml::Value {
    toml::Value::Table(text.parse().expect("TOML"))
}

/// Of every entry of every budget: what is there already changes no byte; another value changes that entry, and no line beside it.
#[test]
fn an_edit_changes_its_entry_alone() {
    let budgets = budgets();
    assert!(budgets.len() > 50);
    let mut count = 0;
    for (_, name, text) in &budgets {
        assert_eq!(edited(text, &[]).as_ref(), Ok(text));
        let places = Places::of(text).expect("TOML");
        let scalars = places.scalars();
        // Long lists hold the same again and again.
        for (entry, span) in scalars.iter().step_by(scalars.len().div_ceil(60)) {
            let token = |token: &str| Content::Token(token.into());
            assert_eq!(
                places.set(entry, token(&text[span.clone()])).as_ref(),
                Ok(text)
            );
            let new = places.set(entry, token("-7.250e3")).expect(name);
            let mut wanted = tree(text);
            *at(&mut wanted, entry) = toml::Value::Float(-7250.0);
            assert_eq!(tree(&new), wanted, "{name} {entry:?}");
            assert!(text.starts_with(&new[..span.start]) && new.ends_with(&text[span.end..]));
            count += 1;
        }
    }
    assert!(count > 1000, "{count}");
}

/// An entry that is removed takes no other with it, and every line that stays is as it was.
#[test]
fn what_is_removed_is_alone() {
    for (_, name, text) in budgets() {
        let places = Places::of(&text).expect("TOML");
        let mut entries: Vec<Vec<Step>> = places
            .scalars()
            .into_iter()
            .map(|(path, _)| path[..path.len().min(2)].to_vec())
            .collect();
        entries.dedup();
        for entry in entries.iter().take(40) {
            let new = places.remove(entry).expect(&name);
            let lines: Vec<&str> = text.lines().collect();
            let mut left = lines.iter();
            let is_elsewhere = entry.len() > 1 && places.value(&entry[..1]).is_some()
                || entry.iter().any(|step| matches!(step, Step::Index(_)));
            assert!(
                is_elsewhere || new.lines().all(|line| left.any(|one| *one == line)),
                "{name} {entry:?}"
            );
            let parent = &entry[..entry.len() - 1];
            let mut wanted = tree(&text);
            match (at(&mut wanted, parent), entry.last()) {
                (toml::Value::Table(table), Some(Step::Key(key))) => drop(table.remove(key)),
                (toml::Value::Array(list), Some(Step::Index(at))) => drop(list.remove(*at)),
                _ => panic!("{entry:?}"),
            }
            // Without a header of its own, a table goes with the last that it held.
            let mut without = wanted.clone();
            if let (toml::Value::Table(top), [Step::Key(parent)]) = (&mut without, parent) {
                let text = top.get(parent).map(ToString::to_string);
                if text.is_some_and(|text| ["", "[]", "{}"].contains(&text.trim())) {
                    top.remove(parent);
                }
            }
            let found = tree(&new);
            assert!(found == wanted || found == without, "{name} {entry:?}");
        }
    }
}

/// Rows of every budget in each other's place: the order of the inputs changes, and no figure; back again it is the same text.
#[test]
fn rows_are_moved_and_moved_back() {
    let mut count = 0;
    for (root, name, text) in budgets() {
        let entries = &view(&text)["entries"]["keys"];
        let rows = entries.as_array().into_iter().flatten();
        let inputs = rows.filter(|entry| entry[0] == "input");
        let inputs: Vec<&str> = inputs
            .flat_map(|entry| entry[1]["keys"].as_array().into_iter().flatten())
            .filter_map(|row| row[0].as_str())
            .collect();
        for pair in inputs.windows(2) {
            let [one, other] = [pair[0], pair[1]].map(|row| vec![key("input"), key(row)]);
            let edit = |path: &[Step], with: &[Step]| {
                let (path, with) = (path.to_vec(), with.to_vec());
                [Edit::Exchange { path, with }]
            };
            let moved = edited(&text, &edit(&one, &other));
            let moved = moved.unwrap_or_else(|why| panic!("{name} {pair:?}: {why}"));
            assert_ne!(moved, text);
            assert_eq!(
                edited(&moved, &edit(&one, &other)),
                Ok(text.clone()),
                "{name}"
            );
            if count % 40 == 0 {
                let [moved, own] = [&moved, &text].map(|text| figures(&root, &name, text));
                let number = |bits: u64| f64::from_bits(bits);
                let alike = |a: u64, b: u64| {
                    let (a, b) = (number(a), number(b));
                    // Sums in another order.
                    a.to_bits() == b.to_bits() || (a - b).abs() <= 1e-9 * a.abs().max(b.abs())
                };
                let both = moved.iter().zip(&own);
                let same = |((y, u), (own_y, own_u)): (&(u64, u64), &(u64, u64))| {
                    alike(*y, *own_y) && alike(*u, *own_u)
                };
                assert!(
                    moved.len() == own.len() && both.into_iter().all(same),
                    "{name}"
                );
            }
            count += 1;
        }
    }
    assert!(count > 100, "{count}");
}

/// A value that is added and removed again leaves the text as it was.
#[test]
fn what_was_added_can_be_removed() {
    for (_, name, text) in budgets() {
        let places = Places::of(&text).expect("TOML");
        let inputs = tree(&text)
            .get("input")
            .and_then(toml::Value::as_table)
            .cloned();
        let added: Vec<Vec<Step>> = inputs
            .iter()
            .flat_map(|table| table.keys())
            .map(|input| [path("input"), vec![key(input), key("added")]].concat())
            .chain([path("added"), path("input.added")])
            .collect();
        for entry in added {
            let content = if entry == path("input.added") {
                Content::Table(Vec::new())
            } else {
                Content::Token("'x'".into())
            };
            // An input may be a number by itself.
            let Ok(new) = places.set(&entry, content) else {
                continue;
            };
            let back = Places::of(&new).expect("TOML").remove(&entry).expect(&name);
            let solid = |text: &str| {
                text.lines()
                    .filter(|line| !line.is_empty())
                    .map(str::to_owned)
                    .collect::<Vec<_>>()
            };
            assert_eq!(solid(&back), solid(&text), "{name} {entry:?}");
        }
    }
}

fn figures(root: &Path, name: &str, text: &str) -> Vec<(u64, u64)> {
    let instead = [(name, text.as_bytes())];
    let folder = Folder {
        root,
        instead: &instead,
    };
    let loaded = budget::load_from(Files::Folder(&folder), Path::new(name), None);
    let loaded = loaded.unwrap_or_else(|faults| {
        panic!(
            "{}",
            faults.render_in(gumption_fault::language::Language::English, false)
        )
    });
    let options = Options {
        monte_carlo: MonteCarloChoice::Off,
        ..Options::default()
    };
    let row = loaded.rows.first().expect("a row");
    let found = evaluate(&row.budget, &options).expect("a result");
    let bits = found.results.iter().map(|one| {
        (
            one.gum.estimate.to_bits(),
            one.gum.coverage.expanded.to_bits(),
        )
    });
    bits.collect()
}

/// Names mean nothing: with every input of every budget renamed, every result is the same to the last bit.
#[test]
fn a_quantity_is_renamed_wherever_it_is_named() {
    let mut count = 0;
    for (root, name, text) in budgets() {
        let Some(inputs) = tree(&text)
            .get("input")
            .and_then(toml::Value::as_table)
            .cloned()
        else {
            continue;
        };
        let edits: Vec<Edit> = inputs
            .keys()
            .enumerate()
            .map(|(at, input)| Edit::Rename {
                path: vec![key("input"), key(input)],
                name: format!("renamed_{at}"),
            })
            .collect();
        let new = edited(&text, &edits).unwrap_or_else(|why| panic!("{name}: {why}"));
        assert_eq!(new.lines().count(), text.lines().count());
        assert_eq!(
            figures(&root, &name, &new),
            figures(&root, &name, &text),
            "{name}"
        );
        count += edits.len();
    }
    assert!(count > 100, "{count}");
}

#[test]
fn a_name_that_is_taken_or_none_is_refused() {
    let text =
        "[measurand.Y]\nmodel = \"a * z(1)\"\n[input]\na = { value = 1 }\nb = { value = 2 }\n";
    for name in ["b", "Y", "z", "2a", "a b", ""] {
        let edit = Edit::Rename {
            path: path("input.a"),
            name: name.into(),
        };
        assert!(edited(text, &[edit]).is_err(), "{name}");
    }
}

/// Numbers stay as they were typed; the schema says what is a list, a text or a word.
#[test]
fn what_is_typed_is_written_by_the_schema() {
    let text = "[input.x]\n";
    for (at, said, written) in [
        ("input.x.value", "1.00010", "value = 1.00010"),
        ("input.x.value", "23 °C", "value = \"23 °C\""),
        ("input.x.unit", "1", "unit = \"1\""),
        ("input.x.readings", "1.0, 2.50", "readings = [1.0, 2.50]"),
        (
            "input.x.readings",
            "1.0 2.50\n3",
            "readings = [1.0, 2.50, 3]",
        ),
        ("input.x.relative", "true", "relative = true"),
        ("input.x.u", "0,5", "u = \"0,5\""),
        ("input.x.u", "1, 2.0", "u = [1, 2.0]"),
        (
            "input.x.readings",
            "1,5 2,5",
            "readings = [\"1,5\", \"2,5\"]",
        ),
        ("input.x.dof", "inf", "dof = inf"),
        ("input.x.dof", "many", "dof = \"many\""),
        (
            "input.x.limits",
            "1 mm, 2 mm",
            "limits = [\"1 mm\", \"2 mm\"]",
        ),
        ("input.x.certificate.U", "0.5", "certificate = { U = 0.5 }"),
    ] {
        assert_eq!(
            typed(text, at, said),
            format!("[input.x]\n{written}\n"),
            "{at}"
        );
    }
    assert_eq!(
        typed("", "correlation.0.between", "a, b"),
        "[[correlation]]\nbetween = [\"a\", \"b\"]\n"
    );
    assert_eq!(
        typed("", "measurand.Y.model", "a = 1\na \"x\"\n"),
        "[measurand.Y]\nmodel = \"\"\"\na = 1\na \\\"x\\\"\n\"\"\"\n"
    );
    assert_eq!(
        typed("recording = 'r.csv'\n", "columns.x.unit", "V"),
        "recording = 'r.csv'\n\n[columns.x]\nunit = \"V\"\n"
    );
}

#[test]
fn entries_are_shown_with_their_places() {
    let text = "title = 'µ'\n[input]\nx = { u = 1.0, readings = [1] }\n[[correlation]]\nr = 1\n";
    let view = view(text);
    let entries = &view["entries"]["keys"];
    assert_eq!(
        entries[0],
        json!(["title", { "text": "µ", "place": [0, 11] }])
    );
    let x = &entries[1][1]["keys"][0][1];
    assert_eq!(
        x["keys"][0],
        json!(["u", { "text": "1.0", "place": [26, 33] }])
    );
    assert_eq!(entries[2][1]["items"][0]["keys"][0][0], "r");
    assert_eq!(self::view("a = "), Value::Null);
}
