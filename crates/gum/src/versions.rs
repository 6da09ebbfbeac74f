//! Two versions of a budget: what each edit between them changes of y and U.
//!
//! An edit is an entry of the file that differs: an input, a measurand, the profile. Every mixture of both versions is a
//! budget by itself and is evaluated by the law of propagation of uncertainty. What an edit changes depends on which others are
//! made already; its share is the mean over all orders in which the edits can be made (the Shapley value), so that the shares add
//! up to the whole change. Of many edits each is made alone, and what their changes leave is said to be left.

use gumption_fault::Rejection;
use serde::Deserialize;
use toml::{Table, Value};

use crate::budget::Loaded;
use crate::propagate::{EvaluationError, MonteCarloChoice, Options, evaluate};

/// Edits whose mixtures are all evaluated: 2⁸ budgets.
const MOST_MIXED: usize = 8;

/// What describes a budget and enters no figure.
const WORDS: [&str; 7] = [
    "title",
    "method",
    "object",
    "author",
    "date",
    "reference",
    "note",
];

/// What edits between two versions change.
#[derive(Debug, Clone, PartialEq)]
pub struct Versions {
    /// The edits: entries of the file, several where none of them can be made without the others.
    pub edits: Vec<Vec<String>>,
    /// How shares were found.
    pub shares: Shares,
    /// The measurands that both versions have.
    pub measurands: Vec<Changed>,
}

/// How the shares of edits were found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shares {
    /// The mean over all orders; they add up to the change.
    Mean,
    /// Each edit alone in the earlier version; they need not add up.
    Alone,
}

/// A measurand in both versions.
#[derive(Debug, Clone, PartialEq)]
pub struct Changed {
    /// Its name.
    pub name: String,
    /// Its unit, as it is printed.
    pub unit: String,
    /// In the earlier version.
    pub before: Figures,
    /// In the later one.
    pub after: Figures,
    /// What each edit changes.
    pub by_edit: Vec<Figures>,
}

/// An estimate and its expanded uncertainty, or what was added to them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Figures {
    /// y.
    pub estimate: f64,
    /// U.
    pub expanded: f64,
}

impl Figures {
    /// The difference from others.
    #[must_use]
    pub fn less(self, other: Figures) -> Figures {
        Figures {
            estimate: self.estimate - other.estimate,
            expanded: self.expanded - other.expanded,
        }
    }

    fn plus(self, other: Figures, weight: f64) -> Figures {
        Figures {
            estimate: self.estimate + weight * other.estimate,
            expanded: self.expanded + weight * other.expanded,
        }
    }
}

impl Changed {
    /// What the shares of the edits leave of the change.
    pub fn left(&self) -> Figures {
        let change = self.after.less(self.before);
        let edits = self.by_edit.iter();
        edits.fold(change, |left, edit| left.less(*edit))
    }
}

/// Why versions cannot be compared.
#[derive(Debug)]
pub enum Incomparable {
    /// A version has faults.
    Refused(Box<Rejection>),
    /// A version cannot be evaluated.
    Failed(EvaluationError),
    /// A version has no rows, or is no TOML; its own evaluation says what is wrong.
    Unreadable,
}

/// The entries of a budget file, read as files of budgets are: names of quantities in all letters need no quotes.
fn table(text: &str) -> Option<Table> {
    let (table, errors) = gumption_format::toml::document(text, &[]);
    let read = || Table::deserialize(toml::de::Deserializer::from(table)).ok();
    errors.is_empty().then(read).flatten()
}

/// One measurand of an evaluated version: name, unit, figures.
type Row = (String, String, Figures);

/// What the edits from one text to another change, of the first row of a series. `load` reads a text as a budget.
///
/// # Errors
/// One of the versions cannot be evaluated.
pub fn versions(
    before: &str,
    after: &str,
    load: impl Fn(&str) -> Result<Loaded, Rejection>,
) -> Result<Versions, Incomparable> {
    let (old, new) = table(before)
        .zip(table(after))
        .ok_or(Incomparable::Unreadable)?;
    let first = figures(before, &load)?;
    let last = figures(after, &load)?;
    let mixed = |made: &dyn Fn(&str) -> bool| -> Option<Vec<Row>> {
        let text = toml::to_string(&mixture(&old, &new, made)).ok()?;
        figures(&text, &load).ok()
    };
    let edits = together(entries(&old, &new), &mixed);
    let with = |made: &[bool]| {
        let of = |path: &str| {
            let mut edits = edits.iter().zip(made);
            edits.any(|(edit, made)| *made && edit.iter().any(|entry| entry == path))
        };
        mixed(&of)
    };
    let count = edits.len();
    let all = match count <= MOST_MIXED {
        true => (0..1_usize << count)
            .map(|set| {
                with(
                    &(0..count)
                        .map(|edit| set >> edit & 1 == 1)
                        .collect::<Vec<_>>(),
                )
            })
            .collect::<Option<Vec<Vec<Row>>>>(),
        false => None,
    };
    let alone = || {
        let one = |edit: usize| with(&(0..count).map(|other| other == edit).collect::<Vec<_>>());
        (0..count).map(one).collect::<Vec<_>>()
    };
    let (shares, alone) = match all {
        Some(_) => (Shares::Mean, Vec::new()),
        None => (Shares::Alone, alone()),
    };
    let of = |rows: &[Row], name: &str| rows.iter().find(|row| row.0 == name).map(|row| row.2);
    let measurands = first.iter().filter_map(|(name, unit, before)| {
        let by_edit = match &all {
            Some(all) => {
                let values: Option<Vec<Figures>> = all.iter().map(|rows| of(rows, name)).collect();
                mean_over_orders(&values?, count)
            }
            None => alone
                .iter()
                .map(|rows| {
                    let one = rows.as_ref().and_then(|rows| of(rows, name));
                    one.map_or_else(Figures::default, |one| one.less(*before))
                })
                .collect(),
        };
        Some(Changed {
            name: name.clone(),
            unit: unit.clone(),
            before: *before,
            after: of(&last, name)?,
            by_edit,
        })
    });
    Ok(Versions {
        measurands: measurands.collect(),
        edits,
        shares,
    })
}

/// y and U of every measurand, of the first row.
fn figures(
    text: &str,
    load: impl Fn(&str) -> Result<Loaded, Rejection>,
) -> Result<Vec<Row>, Incomparable> {
    let loaded = load(text).map_err(|rejection| Incomparable::Refused(Box::new(rejection)))?;
    let row = loaded.rows.first().ok_or(Incomparable::Unreadable)?;
    let options = Options {
        monte_carlo: MonteCarloChoice::Off,
        ..Options::default()
    };
    let found = evaluate(&row.budget, &options).map_err(Incomparable::Failed)?;
    let outputs = row.budget.model.outputs().iter().zip(&found.results);
    let rows = outputs.map(|(output, result)| {
        let figures = Figures {
            estimate: result.gum.estimate,
            expanded: result.gum.coverage.expanded,
        };
        let unit = output.unit.difference().after_number();
        (output.name.clone(), unit, figures)
    });
    Ok(rows.collect())
}

/// The names of entries: `input.x` of a table of named ones, `profile` of all others.
fn names(table: &Table) -> impl Iterator<Item = String> {
    table.iter().flat_map(|(key, value)| match value {
        Value::Table(named) => named.keys().map(|name| format!("{key}.{name}")).collect(),
        _ => vec![key.clone()],
    })
}

fn entry<'t>(table: &'t Table, name: &str) -> Option<&'t Value> {
    match name.split_once('.') {
        Some((key, inner)) => table.get(key)?.as_table()?.get(inner),
        None => table.get(name),
    }
}

/// The entries that differ.
fn entries(old: &Table, new: &Table) -> Vec<String> {
    let mut all: Vec<String> = names(old).chain(names(new)).collect();
    all.sort();
    all.dedup();
    all.retain(|name| !WORDS.contains(&name.as_str()) && entry(old, name) != entry(new, name));
    all
}

/// The later version where an edit is made, the earlier one elsewhere.
fn mixture(old: &Table, new: &Table, made: &dyn Fn(&str) -> bool) -> Table {
    let mut mixed = Table::new();
    // In the order of the file: a measurand may use those above it.
    let taken_out = names(old).filter(|name| entry(new, name).is_none());
    for name in names(new).chain(taken_out) {
        let from = if made(&name) { new } else { old };
        let Some(value) = entry(from, &name) else {
            continue;
        };
        match name.split_once('.') {
            Some((key, inner)) => {
                let table = mixed
                    .entry(key.to_owned())
                    .or_insert_with(|| Value::Table(Table::new()));
                if let Value::Table(table) = table {
                    table.insert(inner.to_owned(), value.clone());
                }
            }
            None => {
                mixed.insert(name, value.clone());
            }
        }
    }
    mixed
}

/// Edits that cannot be made, or taken back, alone are one: a new input and the formula that uses it.
fn together(
    entries: Vec<String>,
    mixed: &impl Fn(&dyn Fn(&str) -> bool) -> Option<Vec<Row>>,
) -> Vec<Vec<String>> {
    let free = |entry: &String| {
        mixed(&|path| path == entry).is_some()
            && mixed(&|path| path != entry && entries.iter().any(|one| one == path)).is_some()
    };
    let (free, bound): (Vec<String>, Vec<String>) = entries.iter().cloned().partition(free);
    let free = free.into_iter().map(|entry| vec![entry]);
    let bound = (!bound.is_empty()).then_some(bound);
    free.chain(bound).collect()
}

/// Shares by the mean over all orders (L. S. Shapley, 1953); `values` by the set of the edits that are made, edit i with weight 2ⁱ.
fn mean_over_orders(values: &[Figures], count: usize) -> Vec<Figures> {
    let factorial = |n: usize| (1..=n).map(|k| k as f64).product::<f64>();
    let share = |edit: usize| {
        let without = (0..values.len()).filter(|set| set >> edit & 1 == 0);
        without.fold(Figures::default(), |sum, set| {
            let made = set.count_ones() as usize;
            let weight = factorial(made) * factorial(count - 1 - made) / factorial(count);
            let with = values.get(set | 1 << edit).copied().unwrap_or_default();
            sum.plus(with.less(values[set]), weight)
        })
    };
    (0..count).map(share).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget;
    use gumption_format::files::Files;

    const OLD: &str = "title = \"T\"\n[measurand.Y]\nmodel = \"a + b\"\nunit = \"V\"\n[input]\n\
        a = { value = 2, unit = \"V\", u = 3 }\nb = { value = 3, unit = \"V\", u = 4 }\n";

    fn load(text: &str) -> Result<Loaded, Rejection> {
        let files: &[(&str, &[u8])] = &[("b.toml", text.as_bytes())];
        budget::load_from(Files::Library(files), "b.toml".as_ref(), None)
    }

    fn compared(after: &str) -> Versions {
        versions(OLD, after, load).expect("two budgets")
    }

    /// U = 2 √(u_a² + u_b²) from 10 to 2 √(u_a'² + u_b'²): by hand over both orders.
    #[test]
    fn shares_are_the_mean_over_orders() {
        let after = OLD
            .replace("u = 3", "u = 12")
            .replace("u = 4", "u = 5")
            .replace("T", "Other");
        let found = compared(&after);
        assert_eq!(found.edits, [["input.a"], ["input.b"]]);
        assert_eq!(found.shares, Shares::Mean);
        let [changed] = &found.measurands[..] else {
            panic!("one measurand")
        };
        let k = changed.before.expanded / 5.0;
        let u = |a: f64, b: f64| k * libm::sqrt(a * a + b * b);
        let a = 0.5 * (u(12.0, 4.0) - u(3.0, 4.0) + u(12.0, 5.0) - u(3.0, 5.0));
        assert!((changed.by_edit[0].expanded - a).abs() < 1e-12);
        assert!((changed.after.expanded - k * 13.0).abs() < 1e-12);
        assert!(changed.left().expanded.abs() < 1e-12 && changed.left().estimate == 0.0);
    }

    /// `[input.电压]` is read without quotes, as in every budget file.
    #[test]
    fn names_in_all_letters_need_no_quotes() {
        let own = |u: &str| {
            format!(
                "title = \"T\"\n[measurand.Y]\nmodel = \"电压 + δ\"\nunit = \"V\"\n[input.电压]\nvalue = 2\nunit = \"V\"\n\
                 u = {u}\n[input.δ]\nvalue = 3\nunit = \"V\"\nu = 4\n"
            )
        };
        let found = versions(&own("3"), &own("12"), load).expect("two budgets");
        assert_eq!(found.edits, [["input.电压"]]);
        assert!(found.measurands[0].left().expanded.abs() < 1e-12);
    }

    /// A new input and the formula that uses it are one edit.
    #[test]
    fn what_cannot_be_alone_is_one_edit() {
        let after = OLD.replace("a + b", "a + b + c").replace("u = 3", "u = 1");
        let found = compared(&(after + "c = { value = 1, unit = \"V\", u = 12 }\n"));
        assert_eq!(
            found.edits,
            [vec!["input.a"], vec!["input.c", "measurand.Y"]]
        );
        let changed = &found.measurands[0];
        assert_eq!(changed.by_edit[1].estimate, 1.0);
        assert!(changed.left().expanded.abs() < 1e-12);
    }

    /// A measurand may use those above it, whatever their names: P = R·I² with I = 2 A and R from 3 Ω to 5 Ω.
    #[test]
    fn measurands_keep_their_order() {
        let old = "[measurand.R]\nmodel = \"r\"\nunit = \"ohm\"\n[measurand.P]\nmodel = \"R*I^2\"\nunit = \"W\"\n\
            [input]\nr = { value = 3, unit = \"ohm\", u = 0.1 }\nI = { value = 2, unit = \"A\", u = 0.1 }\n";
        let new = old.replace("value = 3", "value = 5").replace(
            "value = 2, unit = \"A\", u = 0.1",
            "value = 2, unit = \"A\", u = 0.2",
        );
        let found = versions(old, &new, load).expect("two budgets");
        assert_eq!(found.edits, [["input.I"], ["input.r"]]);
        let power = &found.measurands[1];
        assert_eq!(
            (power.by_edit[0].estimate, power.by_edit[1].estimate),
            (0.0, 8.0)
        );
    }

    #[test]
    fn many_edits_are_made_alone_and_leave_something() {
        let inputs = |u: f64| -> String {
            let input = |i| format!("x{i} = {{ value = 1, u = {u} }}\n");
            let sum: Vec<String> = (0..9).map(|i| format!("x{i}")).collect();
            let head = format!("[measurand.Y]\nmodel = \"{}\"\n[input]\n", sum.join(" + "));
            head + &(0..9).map(input).collect::<String>()
        };
        let found = versions(&inputs(1.0), &inputs(2.0), load).expect("two budgets");
        assert_eq!((found.edits.len(), found.shares), (9, Shares::Alone));
        let changed = &found.measurands[0];
        // From k·3 to k·6; each alone from √9 to √12.
        let k = changed.before.expanded / 3.0;
        let left = k * (3.0 - 9.0 * (libm::sqrt(12.0) - 3.0));
        assert!((changed.left().expanded - left).abs() < 1e-12);
    }

    #[test]
    fn a_version_with_faults_is_refused() {
        let refused = versions(OLD, &OLD.replace("u = 3", "uu = 3"), load);
        assert!(matches!(refused, Err(Incomparable::Refused(_))));
        let same = compared(OLD);
        assert!(same.edits.is_empty() && same.measurands[0].by_edit.is_empty());
    }
}
