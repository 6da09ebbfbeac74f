//! The tables of a study.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::measures::{measures, median_seconds};
use super::rate::Rate;
use super::record::{Outcome, Record};
use super::trial::{Ablation, command};
use crate::grade::Finding;
use crate::scenario::Class;

/// The report as Markdown; `made` says how the records were made.
pub fn report(records: &[Record], made: &str) -> String {
    let mut text = String::from("# Diagnosis on concealed data\n\n");
    let _ = writeln!(text, "{made}\n");
    text += &counts(records);
    text += &outcomes(records);
    text += &grouped("By rig and instrument", "", records, |record, _| {
        record.bench.clone()
    });
    text += &grouped("By what is concealed", "", records, |_, outcome| {
        outcome.physics.clone()
    });
    text += &binned(
        "Detection against strength",
        "One effect with a name, by λ.",
        &[2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 13.0, 20.0, 1e9],
        records,
        0.0,
        |o| o.lambda,
    );
    text += &binned(
        "Naming against separability",
        "One effect with a name, λ ≥ 8, by κ.",
        &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 12.0, 1e9],
        records,
        8.0,
        |o| o.kappa,
    );
    text += &ablations(records);
    text + &misses(records)
}

/// A table with a heading.
fn table(title: &str, note: &str, head: &[&str], rows: &[Vec<String>]) -> String {
    let mut text = format!("## {title}\n\n");
    if !note.is_empty() {
        let _ = writeln!(text, "{note}\n");
    }
    let _ = writeln!(text, "| {} |", head.join(" | "));
    let _ = writeln!(text, "|{}", "---|".repeat(head.len()));
    for row in rows {
        let _ = writeln!(text, "| {} |", row.join(" | "));
    }
    text + "\n"
}

fn counts(records: &[Record]) -> String {
    let rows: Vec<Vec<String>> = Class::COUNTED
        .into_iter()
        .map(|(class, _)| {
            let of_class = records.iter().filter(|r| r.is_whole() && r.class == class);
            vec![class_word(class).into(), of_class.count().to_string()]
        })
        .collect();
    let note = format!(
        "{} diagnoses with those of the ablations; median time of one {:.2} s.",
        records.len(),
        median_seconds(records)
    );
    table("Cases", &note, &["what is concealed", "cases"], &rows)
}

fn outcomes(records: &[Record]) -> String {
    let rows: Vec<Vec<String>> = measures(records)
        .into_iter()
        .map(|measure| {
            let holds = match measure.holds() {
                Some(true) => "yes",
                Some(false) => "**no**",
                None => "–",
            };
            vec![
                measure.name.clone(),
                measure.floor.to_string(),
                measure.rate.to_string(),
                holds.into(),
                measure.definition.into(),
            ]
        })
        .collect();
    table(
        "Outcome",
        "Shares with the exact 95 % interval of Clopper and Pearson.",
        &[
            "measure",
            "floor",
            "obtained",
            "holds",
            "of which cases, and what counts",
        ],
        &rows,
    )
}

/// What became of strong effects, one effect a case, by a word for each.
fn grouped(
    title: &str,
    note: &str,
    records: &[Record],
    word: fn(&Record, &Outcome) -> String,
) -> String {
    let mut groups: BTreeMap<String, Vec<(&Record, &Outcome)>> = BTreeMap::new();
    for record in records.iter().filter(|r| r.is_whole()) {
        for outcome in record.outcomes.iter().filter(|o| o.lambda >= 8.0) {
            groups
                .entry(word(record, outcome))
                .or_default()
                .push((record, outcome));
        }
    }
    let rows: Vec<Vec<String>> = groups
        .into_iter()
        .map(|(name, group)| {
            let count = |holds: fn(&(&Record, &Outcome)) -> bool| {
                group.iter().filter(|one| holds(one)).count().to_string()
            };
            let mut wrong: Vec<&str> = group
                .iter()
                .flat_map(|(r, _)| r.wrong_names.iter().chain(&r.wrong_likes))
                .map(String::as_str)
                .collect();
            wrong.sort_unstable();
            wrong.dedup();
            let mut row = vec![name, group.len().to_string()];
            row.extend([
                count(|(_, o)| o.finding == Finding::Identified),
                count(|(_, o)| o.finding == Finding::ActsLike),
                count(|(_, o)| matches!(o.finding, Finding::Listed(_))),
                count(|(_, o)| o.finding == Finding::Unexplained),
                count(|(_, o)| o.finding == Finding::Missed),
                count(|(r, _)| r.wrong_lists > 0),
                wrong.join(", "),
            ]);
            row
        })
        .collect();
    let note = if note.is_empty() {
        "Effects of λ ≥ 8 beside the others of their case."
    } else {
        note
    };
    table(
        title,
        note,
        &[
            "",
            "effects",
            "identified",
            "acts like",
            "listed",
            "unexplained",
            "missed",
            "beside a wrong list",
            "wrong names",
        ],
        &rows,
    )
}

fn binned(
    title: &str,
    note: &str,
    edges: &[f64],
    records: &[Record],
    least: f64,
    of: fn(&Outcome) -> f64,
) -> String {
    let single = || {
        let whole = records
            .iter()
            .filter(|r| r.is_whole() && r.class == Class::Single);
        whole
            .filter_map(|r| Some((r, r.outcomes.first()?)))
            .filter(|(_, o)| o.lambda >= least)
    };
    let rows: Vec<Vec<String>> = edges
        .windows(2)
        .map(|bin| {
            let share = |holds: fn(&(&Record, &Outcome)) -> bool| {
                Rate::count(
                    single().filter(|(_, o)| (bin[0]..bin[1]).contains(&of(o))),
                    holds,
                )
                .to_string()
            };
            let interval = if bin[1] > 1e6 {
                format!("≥ {}", bin[0])
            } else {
                format!("{} – {}", bin[0], bin[1])
            };
            vec![
                interval,
                share(|(r, _)| r.noticed),
                share(|(_, o)| o.finding == Finding::Identified),
                share(|(_, o)| o.is_alone()),
                share(|(_, o)| o.is_named_or_listed()),
                share(|(r, _)| !r.wrong_names.is_empty()),
            ]
        })
        .collect();
    table(
        title,
        note,
        &[
            "",
            "noticed",
            "identified",
            "alone",
            "named or listed",
            "wrongly identified",
        ],
        &rows,
    )
}

fn ablations(records: &[Record]) -> String {
    let strong = |ablation| {
        let all = records.iter().filter(move |r| r.ablation == ablation);
        all.filter(|r| r.outcomes.iter().any(|o| o.lambda >= 8.0))
    };
    let rows: Vec<Vec<String>> = [
        (
            Ablation::WithoutTruth,
            "the true name taken out of the catalogue",
        ),
        (Ablation::ForeignConditions, "conditions from another case"),
    ]
    .into_iter()
    .map(|(ablation, words)| {
        vec![
            words.into(),
            Rate::count(strong(ablation), |r| {
                r.outcomes.iter().any(Outcome::is_alone)
            })
            .to_string(),
            Rate::count(strong(ablation), |r| {
                r.outcomes.iter().any(|o| o.finding == Finding::Unexplained)
            })
            .to_string(),
            Rate::count(strong(ablation), |r| !r.wrong_names.is_empty()).to_string(),
        ]
    })
    .collect();
    table(
        "Proofs that must fail",
        "One effect of λ ≥ 8. Where nothing but noise is fed in, see the alarms.",
        &[
            "what was done",
            "named rightly",
            "unexplained",
            "wrongly identified",
        ],
        &rows,
    )
}

/// Cases that went wrong, so that anyone can make them again.
fn misses(records: &[Record]) -> String {
    let missed = |o: &Outcome| o.nameable && o.lambda >= 8.0 && !o.is_named_or_listed();
    let failed = |r: &&Record| {
        r.is_whole()
            && (!r.wrong_names.is_empty()
                || r.class == Class::Null && r.noticed
                || r.class == Class::Single && r.outcomes.iter().any(missed)
                || r.class == Class::Outside
                    && !r.noticed
                    && r.outcomes.iter().any(|o| o.lambda >= 36.0))
    };
    let rows: Vec<Vec<String>> = records
        .iter()
        .filter(failed)
        .map(|r| {
            let truth: Vec<String> = r
                .outcomes
                .iter()
                .map(|o| {
                    format!(
                        "{} (λ {:.1}, κ {:.1}): {:?}",
                        o.physics, o.lambda, o.kappa, o.finding
                    )
                })
                .collect();
            vec![
                format!("`{}`", command(r.seed, &r.bench, r.class, r.noise)),
                truth.join(", "),
                r.verdict.clone(),
                r.wrong_names.join(", "),
            ]
        })
        .collect();
    table(
        "Every case that went wrong",
        "A wrong name identified, an alarm on nothing, one effect of λ ≥ 8 neither named nor listed, or λ = 40 not noticed. \
         `gumption challenge` makes any of these cases again.",
        &[
            "case",
            "truth and what became of it",
            "verdict",
            "wrongly identified",
        ],
        &rows,
    )
}

fn class_word(class: Class) -> &'static str {
    match class.counted() {
        Class::Null => "nothing",
        Class::Double => "two effects or three",
        Class::Outside => "something that no catalogue names",
        _ => "one effect",
    }
}
