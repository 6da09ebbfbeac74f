//! The tables of a study.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::rate::Rate;
use super::record::{Outcome, Record};
use super::trial::Ablation;
use crate::challenge::scenario::{Class, NoiseKnowledge};

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
    text += &study.misses();
    text
}

struct Study<'a> {
    records: &'a [Record],
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

/// Whether something was found at all.
fn detected(record: &Record) -> bool {
    record.verdict != "none"
}

fn is_listed(outcome: &Outcome) -> bool {
    outcome.finding.starts_with("list-")
}

impl<'a> Study<'a> {
    fn whole(&self) -> impl Iterator<Item = &'a Record> + Clone + use<'a> {
        self.records.iter().filter(|record| record.is_whole())
    }

    fn of_class(&self, class: Class) -> impl Iterator<Item = &'a Record> + Clone {
        self.whole().filter(move |record| record.class == class)
    }

    /// Single effects that have names, with what became of them.
    fn singles(&self) -> impl Iterator<Item = (&'a Record, &'a Outcome)> + Clone {
        self.of_class(Class::Single)
            .filter_map(|record| Some((record, record.outcomes.first()?)))
    }

    fn nulls(&self, noise: NoiseKnowledge) -> impl Iterator<Item = &'a Record> + Clone {
        self.of_class(Class::Null)
            .filter(move |record| record.noise == noise)
    }

    fn several(&self) -> impl Iterator<Item = &'a Record> + Clone {
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

    /// Every bar with what was obtained.
    fn bars(&self) -> String {
        let single = |least: f64| self.singles().filter(move |(_, o)| o.lambda >= least);
        let alarms = |noise| Rate::count(self.nulls(noise), |r| detected(r));
        let named_on_null = Rate::count(self.of_class(Class::Null), |r: &&Record| {
            !r.wrong_names.is_empty()
        });
        let detection = |least| Rate::count(single(least), |(r, _)| detected(r));
        let separable = single(8.0).filter(|(_, o)| o.kappa >= 6.0);
        let listed = |(_, o): &(&Record, &Outcome)| o.finding == "unique" || is_listed(o);
        let wrong = |r: &&Record| !r.wrong_names.is_empty();
        let aliased = self
            .whole()
            .flat_map(|r| &r.outcomes)
            .filter(|o| o.finding == "unique");
        let open = self
            .records
            .iter()
            .filter(|r| r.ablation == Ablation::WithoutTruth)
            .filter(|r| {
                r.outcomes
                    .iter()
                    .all(|o| o.lambda >= 10.0 && o.kappa >= 5.0)
            });
        let sure: Vec<bool> = self
            .claims()
            .filter(|(p, _)| *p >= 0.99)
            .map(|(_, ok)| ok)
            .collect();
        let fixed: Vec<&Record> = self
            .singles()
            .filter(|(_, o)| o.finding == "unique")
            .map(|(r, _)| r)
            .collect();
        let sizes = self
            .whole()
            .flat_map(|r| &r.outcomes)
            .map(|o| o.deviation)
            .filter(|z| z.is_finite());
        let row = |what: &str, bar: &str, got: Rate, holds: fn(f64, f64) -> bool, limit: f64| {
            let verdict = if got.of == 0 {
                "–"
            } else if holds(got.share(), limit) {
                "yes"
            } else {
                "**no**"
            };
            vec![
                what.to_string(),
                bar.to_string(),
                got.to_string(),
                verdict.to_string(),
            ]
        };
        let most: fn(f64, f64) -> bool = |x, limit| x <= limit;
        let least: fn(f64, f64) -> bool = |x, limit| x >= limit;
        let rows = vec![
            row(
                "alarms on nothing, noise stated, α = 1 %",
                "≤ 1.5 %",
                alarms(NoiseKnowledge::Stated),
                most,
                0.015,
            ),
            row(
                "alarms on nothing, noise from a recording at rest",
                "≤ 2.5 %",
                alarms(NoiseKnowledge::AtRest),
                most,
                0.025,
            ),
            row(
                "unique wrong name on nothing",
                "≤ 0.2 %",
                named_on_null,
                most,
                0.002,
            ),
            row(
                "detected, one effect, λ ≥ 6",
                "≥ 95 %",
                detection(6.0),
                least,
                0.95,
            ),
            row(
                "detected, one effect, λ ≥ 8",
                "≥ 99.5 %",
                detection(8.0),
                least,
                0.995,
            ),
            row(
                "named uniquely and rightly, λ ≥ 8 and κ ≥ 6",
                "≥ 97 %",
                Rate::count(separable, |(_, o)| o.finding == "unique"),
                least,
                0.97,
            ),
            row(
                "named or listed, one effect, λ ≥ 8",
                "≥ 95 %",
                Rate::count(single(8.0), listed),
                least,
                0.95,
            ),
            row(
                "unique wrong name, one effect",
                "≤ 1 %",
                Rate::count(self.of_class(Class::Single), wrong),
                most,
                0.01,
            ),
            row(
                "unique wrong name, two or three effects",
                "≤ 2 %",
                Rate::count(self.several(), wrong),
                most,
                0.02,
            ),
            row(
                "unique name where another gives the same recording",
                "0",
                Rate::count(aliased, |o| o.overclaimed),
                most,
                0.0,
            ),
            row(
                "claims at posterior ≥ 0.99 right",
                "≥ 98 %",
                Rate::count(sure, |ok| *ok),
                least,
                0.98,
            ),
            row(
                "true name taken out, λ ≥ 10, κ ≥ 5: unique wrong name",
                "≤ 8 %",
                Rate::count(open, wrong),
                most,
                0.08,
            ),
            row(
                "no catalogue names it: unique wrong name",
                "≤ 8 %",
                Rate::count(self.of_class(Class::Outside), wrong),
                most,
                0.08,
            ),
            row(
                "χ²/dof between 0.8 and 1.3 after the fix (one effect, named)",
                "–",
                Rate::count(&fixed, |r| (0.8..=1.3).contains(&r.chi[1])),
                least,
                0.9,
            ),
            row(
                "error of prediction ≤ 1.2 × noise after the fix (one effect, named)",
                "–",
                Rate::count(&fixed, |r| r.held_out[1] <= 1.2),
                least,
                0.9,
            ),
            row(
                "true size inside the stated 95 % interval",
                "93–97 %",
                Rate::count(sizes, |z| z.abs() <= 1.96),
                |x, limit| (limit..=0.97).contains(&x),
                0.93,
            ),
        ];
        table(
            "Bars",
            "Shares with the exact 95 % interval of Clopper and Pearson.",
            &["figure", "bar", "obtained", "holds"],
            &rows,
        )
    }

    /// Unique claims with their posteriors and whether they are right.
    fn claims(&self) -> impl Iterator<Item = (f64, bool)> + use<'a> {
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
