//! The documentation is true: every TOML block in it is a budget that evaluates, the generated pages are
//! those that the program makes now, what is quoted from a report is in that report, and nothing that a user
//! may write is left out.

use crate::common;
use std::collections::BTreeSet;
use std::path::Path;

use gumption::budget;
use gumption::diagnose::catalogue::Kind;
use gumption::language::Language;
use gumption::propagate::{self, MonteCarloChoice, Options};

/// What the program prints on a page of 100 columns.
fn gumption(arguments: &[&str]) -> String {
    let output = common::program()
        .current_dir(common::root())
        .args(arguments)
        .output()
        .expect("the program runs");
    assert!(
        output.status.success(),
        "gumption {}:\n{}",
        arguments.join(" "),
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout).expect("the program prints UTF-8")
}

fn read(path: &str) -> String {
    std::fs::read_to_string(common::root().join(path)).expect("a readable page")
}

/// The blocks of a Markdown text between three backquotes with this word and three backquotes, each with the
/// line on which it starts.
fn blocks(text: &str, word: &str) -> Vec<(usize, String)> {
    let opening = format!("```{word}");
    let mut blocks = Vec::new();
    let mut open: Option<(usize, String)> = None;
    for (number, line) in text.lines().enumerate() {
        match (&mut open, line.trim_end()) {
            (None, line) if line == opening => open = Some((number + 1, String::new())),
            (Some(_), "```") => blocks.extend(open.take()),
            (Some((_, block)), line) => {
                block.push_str(line);
                block.push('\n');
            }
            (None, _) => {}
        }
    }
    blocks
}

/// A block that shows single tables only, as the page of units does, needs a measurand to be a budget; a fit
/// reports its parameters.
fn completed(block: String) -> String {
    if block.contains("measurand") || block.contains("[fit.") {
        block
    } else {
        format!("{block}\n[measurand.y]\nmodel = \"x\"\n[input]\nx = {{ value = 1, u = 0.1 }}\n")
    }
}

#[test]
fn every_example_in_the_documentation_evaluates() {
    let options = Options {
        monte_carlo: MonteCarloChoice::Off,
        ..Options::default()
    };
    let mut evaluated = 0;
    let mut pages = common::files("docs", "md");
    pages.push(common::root().join("README.md"));
    for page in pages {
        let text = std::fs::read_to_string(&page).expect("a readable page");
        for (line, block) in blocks(&text, "toml") {
            let name = format!("{}:{line}", common::relative(&page));
            let loaded = budget::read(&completed(block), &name, &common::root().join("docs"))
                .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
            for row in &loaded.rows {
                propagate::evaluate(&row.budget, &options)
                    .unwrap_or_else(|error| panic!("{name}: {error:?}"));
            }
            evaluated += 1;
        }
    }
    assert!(evaluated >= 20, "only {evaluated} examples found");
}

#[test]
fn the_template_evaluates_and_agrees_with_its_own_schema() {
    let loaded = budget::read(
        &budget::template(Language::English),
        "template",
        &common::root(),
    )
    .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
    assert_eq!(loaded.rows.len(), 1);
    propagate::evaluate(&loaded.rows[0].budget, &Options::default()).expect("a result");
}

/// The help of the program and of each of its commands.
fn command_line() -> String {
    let main = gumption(&["--help"]);
    let commands = main
        .lines()
        .skip_while(|line| *line != "Commands:")
        .skip(1)
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.split_whitespace().next())
        .filter(|command| *command != "help");
    let mut page = format!(
        "# Command line\n\nThis page is what `gumption --help` and `gumption COMMAND --help` print.\n\n```text\n{main}```\n"
    );
    for command in commands {
        let help = gumption(&[command, "--help"]);
        page.push_str(&format!("\n## gumption {command}\n\n```text\n{help}```\n"));
    }
    page
}

#[test]
fn what_experiments_name_is_explained() {
    for procedure in gumption::experiment::procedure::PROCEDURES {
        let text = gumption(&["explain", procedure.name]);
        let card = procedure.card();
        assert!(
            text.contains(card.statements().next().expect("an equation")),
            "{text}"
        );
    }
    for effect in gumption::diagnose::catalogue::effects() {
        if matches!(effect.kind, Kind::Physics | Kind::Record) {
            let text = gumption(&["explain", effect.id.as_str(), "--lang", "zh"]);
            assert!(
                text.contains(&effect.formula.replace(['{', '}'], "")),
                "{text}"
            );
        }
    }
}

#[test]
fn generated_pages_are_fresh() {
    let docs = common::root().join("docs");
    let schema = serde_json::to_string_pretty(&budget::schema()).expect("a schema is JSON") + "\n";
    let mut stale = Vec::from_iter(common::stale(&docs.join("budget.schema.json"), &schema));
    stale.extend(common::stale(
        &docs.join("reference/cli.md"),
        command_line(),
    ));
    for section in [
        "experiment-keys",
        "certificate-keys",
        "concepts",
        "distributions",
        "errors",
        "functions",
        "keys",
        "profiles",
        "effects",
        "slips",
        "rules",
    ] {
        let path = docs.join("reference").join(section).with_extension("md");
        let page = gumption(&["explain", section, "--markdown"]);
        stale.extend(common::stale(&path, &page));
    }
    common::assert_fresh(&stale);
}

/// Sections of a text report by the beginnings of their headings, which alone start in the first column.
fn sections(report: &str, headings: &[&str]) -> String {
    let mut kept: Vec<&str> = Vec::new();
    let mut keeps = false;
    for line in report.lines() {
        if line.starts_with(|c: char| c.is_alphanumeric()) {
            keeps = headings.iter().any(|heading| line.starts_with(heading));
        }
        if keeps {
            kept.push(line);
        }
    }
    kept.join("\n").trim_end().to_string()
}

/// The README with its excerpts as the program prints them now. An excerpt is the block that follows a comment
/// `<!-- gumption ARGUMENTS: HEADING, HEADING -->`.
fn with_excerpts(readme: &str) -> (String, usize) {
    let mut pieces = readme.split("<!-- gumption ");
    let mut text = pieces.next().unwrap_or_default().to_string();
    let mut excerpts = 0;
    for piece in pieces {
        let (comment, rest) = piece.split_once(" -->").expect("a closed comment");
        let (arguments, headings) = comment.split_once(": ").expect("headings after a colon");
        let (_, after) = rest
            .split_once("```text\n")
            .and_then(|(_, rest)| rest.split_once("```\n"))
            .expect("a block after the comment");
        let arguments: Vec<&str> = arguments.split_whitespace().collect();
        let headings: Vec<&str> = headings.split(", ").collect();
        let shown = sections(&gumption(&arguments), &headings);
        assert!(!shown.is_empty(), "no section {headings:?}");
        text.push_str(&format!(
            "<!-- gumption {comment} -->\n```text\n{shown}\n```\n{after}"
        ));
        excerpts += 1;
    }
    (text, excerpts)
}

#[test]
fn the_readmes_show_what_the_program_prints() {
    for page in ["README.md", "docs/zh/README.md", "docs/fleet-statistics.md"] {
        let (text, excerpts) = with_excerpts(&read(page));
        assert!(excerpts >= 1, "{page}: no excerpt found");
        let path = common::root().join(page);
        common::assert_fresh(&Vec::from_iter(common::stale(&path, &text)));
    }
}

#[test]
fn the_readme_names_every_folder_of_budgets() {
    let readme = read("README.md");
    let folders: BTreeSet<String> = common::files("budgets", "toml")
        .iter()
        .filter_map(|path| path.parent().map(common::relative))
        .collect();
    for folder in folders {
        assert!(readme.contains(&format!("({folder}/)")), "{folder}/");
    }
}

#[test]
fn links_lead_to_files() {
    let mut pages = common::files("docs", "md");
    pages.push(common::root().join("README.md"));
    for page in pages {
        let text = std::fs::read_to_string(&page).expect("a readable page");
        let folder = page.parent().unwrap_or(Path::new(""));
        for target in text
            .split("](")
            .skip(1)
            .filter_map(|rest| rest.split(')').next())
        {
            let file = target.split('#').next().unwrap_or_default();
            let elsewhere = target.contains("://") || file.is_empty();
            assert!(
                elsewhere || folder.join(file).exists(),
                "{} links to {target}",
                common::relative(&page)
            );
        }
    }
}

/// Whether a page has the word as code of its own: between backquotes, or at the place of a key in an example.
fn names(page: &str, word: &str) -> bool {
    page.match_indices(word).any(|(at, _)| {
        let before = page[..at].chars().next_back();
        let after = page[at + word.len()..].chars().next();
        let part = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
        !part(before) && !part(after)
    })
}

#[test]
fn every_key_is_in_the_page_of_the_budget_file() {
    let page = read("docs/budget-file.md");
    let missing: BTreeSet<String> = budget::keys()
        .iter()
        .filter(|row| !names(&page, row.key))
        .map(|row| format!("{}.{}", row.table, row.key))
        .collect();
    assert!(missing.is_empty(), "{missing:#?}");
}

#[test]
fn every_function_is_in_the_page_of_the_model_language() {
    let page = read("docs/model-language.md");
    for function in gumption::model::functions() {
        assert!(names(&page, function.name), "{}", function.name);
    }
}

#[test]
fn every_finding_is_in_the_page_of_the_results() {
    let page = read("docs/results.md");
    let listed = gumption(&["explain", "findings"]);
    let kinds: Vec<&str> = listed
        .lines()
        .filter_map(|line| line.trim_start().split_once("  "))
        .map(|(kind, _)| kind)
        .filter(|kind| kind.chars().all(|c| c.is_ascii_lowercase() || c == '_'))
        .collect();
    assert!(kinds.len() > 15, "{kinds:?}");
    for kind in kinds {
        assert!(names(&page, kind), "docs/results.md says nothing of {kind}");
    }
}

#[test]
fn every_profile_is_in_the_page_of_profiles() {
    let page = read("docs/reference/profiles.md");
    for profile in budget::PROFILES {
        assert!(
            page.contains(&format!("## {}: ", profile.name)),
            "{}",
            profile.name
        );
    }
}
