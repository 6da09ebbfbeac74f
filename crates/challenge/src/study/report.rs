//! The tables of a study.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::rate::Rate;
use super::record::{Outcome, Record};
use super::trial::Ablation;
use crate::scenario::{Class, NoiseKnowledge};

/// The report as Markdown; `made` says how the records were made.
pub fn report(records: &[Record], made: &str) -> String {
    let study = Study { records };
    let mut text = String::from("# Diagnosis on concealed data\n\n");
    let _ = writeln!(text, "{made}\n");
    text += &study.counts();
    text += &study.bars();
    text += &study.by_scenario();
    text += &study.against_strength();
    text += &study.against_separability();
    text += &study.alarms();
    text += &study.calibration();
    text += &study.rivals();
    text += &study.ablations();
    text += &study.further();
    text + &study.misses()
}

/// The records of a study.
pub(super) struct Study<'a> {
    pub(super) records: &'a [Record],
}

/// A table with a heading.
pub(super) fn table(title: &str, note: &str, head: &[&str], rows: &[Vec<String>]) -> String {
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

/// Whether something was found at all.
pub(super) fn detected(record: &Record) -> bool {
    record.verdict != "none"
}

pub(super) fn is_listed(outcome: &Outcome) -> bool {
    outcome.finding.starts_with("list-")
}

impl<'a> Study<'a> {
    pub(super) fn whole(&self) -> impl Iterator<Item = &'a Record> + Clone + use<'a> {
        self.records.iter().filter(|record| record.is_whole())
    }

    pub(super) fn of_class(&self, class: Class) -> impl Iterator<Item = &'a Record> + Clone {
        self.whole().filter(move |record| record.class == class)
    }

    /// Single effects that have names, with what became of them.
    pub(super) fn singles(&self) -> impl Iterator<Item = (&'a Record, &'a Outcome)> + Clone {
        self.of_class(Class::Single)
            .filter_map(|record| Some((record, record.outcomes.first()?)))
    }

    pub(super) fn nulls(&self, noise: NoiseKnowledge) -> impl Iterator<Item = &'a Record> + Clone {
        self.of_class(Class::Null)
            .filter(move |record| record.noise == noise)
    }

    pub(super) fn several(&self) -> impl Iterator<Item = &'a Record> + Clone {
        self.whole()
            .filter(|r| matches!(r.class, Class::Double | Class::Triple | Class::Masked))
    }

    fn counts(&self) -> String {
        let mut classes: BTreeMap<Class, (usize, Vec<&str>)> = BTreeMap::new();
        for record in self.whole() {
            let entry = classes.entry(record.class).or_default();
            entry.0 += 1;
            entry.1.push(&record.scenario);
        }
        let rows: Vec<Vec<String>> = classes
            .into_iter()
            .map(|(class, (count, mut names))| {
                names.sort_unstable();
                names.dedup();
                vec![
                    class_word(class).into(),
                    names.len().to_string(),
                    count.to_string(),
                ]
            })
            .collect();
        table(
            "Cases",
            "",
            &["what is concealed", "scenarios", "cases"],
            &rows,
        )
    }

    /// Unique claims with their posteriors and whether they are right.
    pub(super) fn claims(&self) -> impl Iterator<Item = (f64, bool)> + use<'a> {
        self.whole().flat_map(|record| {
            let right = record
                .outcomes
                .iter()
                .filter(|o| o.finding == "unique")
                .map(|o| (o.probability, true));
            let wrong = record.wrong_names.iter().map(|(_, p)| (*p, false));
            right.chain(wrong).collect::<Vec<_>>()
        })
    }

    fn by_scenario(&self) -> String {
        let mut scenarios: BTreeMap<&str, Vec<&Record>> = BTreeMap::new();
        for record in self.whole() {
            scenarios.entry(&record.scenario).or_default().push(record);
        }
        let rows: Vec<Vec<String>> = scenarios
            .into_iter()
            .map(|(name, records)| {
                let strong: Vec<&Outcome> = records
                    .iter()
                    .flat_map(|r| &r.outcomes)
                    .filter(|o| o.lambda >= 6.0)
                    .collect();
                let share = |holds: fn(&Outcome) -> bool| {
                    strong.iter().filter(|o| holds(o)).count().to_string()
                };
                let mut wrong: Vec<&str> = records
                    .iter()
                    .flat_map(|r| r.wrong_names.iter().map(|(name, _)| name.as_str()))
                    .collect();
                wrong.sort_unstable();
                vec![
                    name.to_string(),
                    records.len().to_string(),
                    strong.len().to_string(),
                    share(|o| o.finding == "unique"),
                    share(is_listed),
                    share(|o| o.finding == "unexplained"),
                    share(|o| o.finding == "missed"),
                    wrong.join(", "),
                    records
                        .iter()
                        .map(|r| r.wrong_lists)
                        .sum::<usize>()
                        .to_string(),
                ]
            })
            .collect();
        table(
            "What became of each effect",
            "Effects of λ ≥ 6 beside the others of their case; wrong names at any strength.",
            &[
                "scenario",
                "cases",
                "effects",
                "named",
                "listed",
                "unexplained",
                "missed",
                "wrong names",
                "wrong lists",
            ],
            &rows,
        )
    }

    fn against_strength(&self) -> String {
        let bins = [2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 15.0, 20.0, 1e9];
        let rows: Vec<Vec<String>> = bins
            .windows(2)
            .map(|bin| {
                let inside: Vec<(&Record, &Outcome)> = self
                    .singles()
                    .filter(|(_, o)| (bin[0]..bin[1]).contains(&o.lambda))
                    .collect();
                let share = |holds: fn(&(&Record, &Outcome)) -> bool| {
                    Rate::count(inside.iter().copied(), holds).to_string()
                };
                vec![
                    interval(bin),
                    share(|(r, _)| detected(r)),
                    share(|(_, o)| o.finding == "unique"),
                    share(|(_, o)| is_listed(o)),
                    share(|(_, o)| o.finding == "unexplained"),
                    share(|(r, _)| !r.wrong_names.is_empty()),
                ]
            })
            .collect();
        table(
            "Detection against strength",
            "One effect.",
            &[
                "λ",
                "detected",
                "named",
                "listed",
                "unexplained",
                "wrong name",
            ],
            &rows,
        )
    }

    fn against_separability(&self) -> String {
        let bins = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 12.0, 1e9];
        let rows: Vec<Vec<String>> = bins
            .windows(2)
            .map(|bin| {
                let inside: Vec<&Outcome> = self
                    .singles()
                    .map(|(_, o)| o)
                    .filter(|o| o.lambda >= 6.0 && (bin[0]..bin[1]).contains(&o.kappa))
                    .collect();
                let share = |holds: fn(&&Outcome) -> bool| {
                    Rate::count(inside.iter().copied(), holds).to_string()
                };
                vec![
                    interval(bin),
                    share(|o| o.finding == "unique"),
                    share(|o| is_listed(o)),
                    share(|o| o.finding == "unexplained"),
                ]
            })
            .collect();
        table(
            "Naming against separability",
            "One effect of λ ≥ 6; κ is what the nearest rival of the simulator leaves.",
            &["κ", "named", "listed", "unexplained"],
            &rows,
        )
    }

    fn alarms(&self) -> String {
        let row = |words: &str, noise| {
            let alarms = Rate::count(self.nulls(noise), |r| detected(r));
            let names = Rate::count(self.nulls(noise), |r| !r.wrong_names.is_empty());
            vec![words.to_string(), alarms.to_string(), names.to_string()]
        };
        let rows = [
            row("stated", NoiseKnowledge::Stated),
            row("from a recording at rest", NoiseKnowledge::AtRest),
        ];
        table(
            "Nothing concealed",
            "",
            &["noise", "alarms", "unique names"],
            &rows,
        )
    }

    fn calibration(&self) -> String {
        let bins = [0.0, 0.9, 0.95, 0.97, 0.99, 0.999, 1.1];
        let claims: Vec<(f64, bool)> = self.claims().collect();
        let rows: Vec<Vec<String>> = bins
            .windows(2)
            .map(|bin| {
                let inside = claims.iter().filter(|(p, _)| (bin[0]..bin[1]).contains(p));
                vec![
                    format!("{} – {}", bin[0], bin[1].min(1.0)),
                    Rate::count(inside, |(_, right)| *right).to_string(),
                ]
            })
            .collect();
        table(
            "Posteriors of unique names",
            "All cases, also those that no catalogue names.",
            &["posterior", "right"],
            &rows,
        )
    }

    fn rivals(&self) -> String {
        let mut names: Vec<&str> = self
            .whole()
            .flat_map(|r| r.rivals.iter().map(|(rival, _)| rival.as_str()))
            .collect();
        names.sort_unstable();
        names.dedup();
        if names.is_empty() {
            return String::new();
        }
        let answer = |record: &Record, rival: &str| {
            record
                .rivals
                .iter()
                .find(|(name, _)| name == rival)
                .map(|(_, a)| a.clone())
        };
        let mut rows = vec![vec![
            "this program".to_string(),
            Rate::count(self.of_class(Class::Null), |r| detected(r)).to_string(),
            Rate::count(self.singles().filter(|(_, o)| o.lambda >= 8.0), |(_, o)| {
                o.finding == "unique"
            })
            .to_string(),
            Rate::count(self.singles().filter(|(_, o)| o.lambda >= 8.0), |(r, _)| {
                !r.wrong_names.is_empty()
            })
            .to_string(),
            Rate::count(self.of_class(Class::Outside), |r| !r.wrong_names.is_empty()).to_string(),
        ]];
        for rival in names {
            let says = |r: &Record, word: &str| answer(r, rival).is_some_and(|a| a == word);
            rows.push(vec![
                rival.to_string(),
                Rate::count(self.of_class(Class::Null), |r| !says(r, "none")).to_string(),
                Rate::count(self.singles().filter(|(_, o)| o.lambda >= 8.0), |(r, _)| {
                    says(r, "right")
                })
                .to_string(),
                Rate::count(self.singles().filter(|(_, o)| o.lambda >= 8.0), |(r, _)| {
                    says(r, "wrong")
                })
                .to_string(),
                Rate::count(self.of_class(Class::Outside), |r| says(r, "wrong")).to_string(),
            ]);
        }
        table(
            "Beside other methods",
            "On the same cases with the same catalogue.",
            &[
                "method",
                "alarms on nothing",
                "right and unique, λ ≥ 8",
                "wrong, λ ≥ 8",
                "wrong where no catalogue names it",
            ],
            &rows,
        )
    }

    fn ablations(&self) -> String {
        let of = |ablation| self.records.iter().filter(move |r| r.ablation == ablation);
        let strong = |r: &&Record| r.outcomes.iter().any(|o| o.lambda >= 8.0);
        let rows: Vec<Vec<String>> = [Ablation::WithoutTruth, Ablation::ForeignConditions]
            .into_iter()
            .map(|ablation| {
                let right = |r: &&Record| r.outcomes.iter().any(|o| o.finding == "unique");
                vec![
                    ablation_word(ablation).to_string(),
                    Rate::count(of(ablation).filter(strong), right).to_string(),
                    Rate::count(of(ablation).filter(strong), |r| r.verdict == "unexplained")
                        .to_string(),
                    Rate::count(of(ablation).filter(strong), |r| !r.wrong_names.is_empty())
                        .to_string(),
                ]
            })
            .collect();
        table(
            "Proofs that must fail",
            "One effect of λ ≥ 8. Where nothing but noise is fed in, see the table of alarms.",
            &[
                "what was done",
                "named rightly",
                "unexplained",
                "unique wrong name",
            ],
            &rows,
        )
    }

    /// Cases that went wrong, so that anyone can make them again.
    fn misses(&self) -> String {
        let rows: Vec<Vec<String>> = self
            .whole()
            .filter(|r| !r.wrong_names.is_empty())
            .map(|r| {
                let truth: Vec<String> = r
                    .outcomes
                    .iter()
                    .map(|o| format!("{} (λ {:.1}, κ {:.1})", o.physics, o.lambda, o.kappa))
                    .collect();
                let names: Vec<String> = r
                    .wrong_names
                    .iter()
                    .map(|(name, p)| format!("{name} {p:.3}"))
                    .collect();
                vec![
                    format!("`--scenario {} --seed {}`", r.scenario, r.seed),
                    truth.join(", "),
                    names.join(", "),
                ]
            })
            .collect();
        table(
            "Every unique wrong name",
            "`gumption challenge` makes any of these cases again.",
            &["case", "truth", "wrong name with posterior"],
            &rows,
        )
    }
}

fn interval(bin: &[f64]) -> String {
    if bin[1] > 1e6 {
        format!("≥ {}", bin[0])
    } else {
        format!("{} – {}", bin[0], bin[1])
    }
}

fn class_word(class: Class) -> &'static str {
    match class {
        Class::Null => "nothing",
        Class::Single => "one effect",
        Class::Double => "two effects",
        Class::Triple => "three effects",
        Class::Masked => "two that mask each other",
        Class::Outside => "something that no catalogue names",
        Class::Hidden => "temperature, without a thermometer",
    }
}

fn ablation_word(ablation: Ablation) -> &'static str {
    match ablation {
        Ablation::Whole => "nothing",
        Ablation::WithoutTruth => "the true name taken out of the catalogue",
        Ablation::ForeignConditions => "conditions from another case",
    }
}
