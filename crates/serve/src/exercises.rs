//! Exercises: budgets with a concealed slip and recordings with concealed physics, made from a number, answered on the page,
//! graded as `gumption grade` grades.
//!
//! What is handed out is all that the page is sent; the truth is made anew from the number when an answer has come.

use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

use serde::Deserialize;
use serde_json::{Value, json};

use gumption_audit::sheet::{self, Grid};
use gumption_audit::slips::{is_of_a_row, slip, slips};
use gumption_challenge::budget::{
    SealedSheet, Sheet, SheetsTruth, grade_sheets, read_sheet_answers, sheet, sheet_grades_document,
};
use gumption_challenge::grade::{self, Refused};
use gumption_challenge::{Request, SealedCase, challenge};
use gumption_fault::language::Language;
use gumption_fault::{Said, say};
use gumption_format::document::{Block, Column, ColumnKind, Document, Row, Table};
use gumption_format::machine::{Machine, record};
use gumption_lab::diagnose::catalogue::{Words, effects};

/// Exercises of a number: `gumption challenge --audit` writes as many where it is not told another count.
const MOST: u64 = 20;

/// Numbers that the server draws: short enough to be called out in a class.
const DRAWN: u64 = 1_000_000;

/// Exercises that a server remembers having shown; a class asks for fewer.
const MOST_SHOWN: usize = 10_000;

/// What is concealed, and in what.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Kind {
    /// Slips in a claimed budget.
    Budget,
    /// Physics in a recording.
    Recording,
}

/// An exercise, and what is wanted of it.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Practice {
    kind: Kind,
    /// The number that a class shares; one is drawn where there is none.
    seed: Option<u64>,
    /// Which of the exercises of that number, from 1.
    number: u64,
    wanted: Wanted,
}

/// What is wanted of an exercise.
#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Wanted {
    /// What is handed out.
    Task,
    /// An answer, in the form that `gumption grade` reads, held against the truth.
    Grade(Value),
    /// The truth about all exercises of the number up to this one, for the teacher.
    Answers,
}

/// Exercises of which somebody has seen the truth.
#[derive(Debug, Default)]
pub(crate) struct Shown(Mutex<BTreeSet<(Kind, u64, u64)>>);

impl Shown {
    /// Remembers that an exercise was shown, and says whether it had been.
    fn show(&self, kind: Kind, seed: u64, number: u64) -> bool {
        let mut shown = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let exercise = (kind, seed, number);
        shown.contains(&exercise) || {
            if shown.len() < MOST_SHOWN {
                shown.insert(exercise);
            }
            false
        }
    }
}

record! {
    /// An exercise as it is handed out.
    ExerciseJson {
        /// The number that a class shares.
        seed: u64,
        /// Which of its exercises.
        number: u64,
        /// The files that are handed out.
        files: Vec<String>,
    }

    /// The truth about exercises.
    AnswersJson {
        /// The number that a class shares.
        seed: u64,
        /// What is concealed in each of its exercises.
        concealed: Vec<String>,
    }
}

impl Machine for ExerciseJson {
    const KIND: &'static str = "exercise";
    const VERSION: u32 = 1;
}

impl Machine for AnswersJson {
    const KIND: &'static str = "exercise answers";
    const VERSION: u32 = 1;
}

/// An exercise that has a number.
#[derive(Debug, Clone, Copy)]
struct Exercise {
    seed: u64,
    number: u64,
    language: Language,
}

/// The document of what is wanted, and what the page shows beside it.
///
/// # Errors
/// The answer is none, or the system has no random numbers.
pub(crate) fn practice(
    wanted: &Practice,
    language: Language,
    shown: &Shown,
) -> Result<(Document, Value), Said> {
    let exercise = Exercise {
        seed: wanted.seed.map_or_else(drawn, Ok)?,
        number: wanted.number.clamp(1, MOST),
        language,
    };
    let Exercise { seed, number, .. } = exercise;
    match &wanted.wanted {
        Wanted::Task => Ok(match wanted.kind {
            Kind::Budget => exercise.budget(),
            Kind::Recording => exercise.recording(),
        }),
        Wanted::Grade(answer) => {
            let answer = answer.to_string();
            let graded = match wanted.kind {
                Kind::Budget => exercise.graded_budget(&answer),
                Kind::Recording => exercise.graded_recording(&answer),
            };
            let mut document = graded.map_err(|refused| no_answer(&refused))?;
            if shown.show(wanted.kind, seed, number) {
                let note = say!("The truth of this exercise had been shown before this answer.");
                let note = Block::Paragraph(note.in_language(language));
                document.edit(|blocks| blocks.insert(0, note));
            }
            Ok((document, json!({ "graded": true })))
        }
        Wanted::Answers => {
            for number in 1..=number {
                shown.show(wanted.kind, seed, number);
            }
            Ok((exercise.answers(wanted.kind), Value::Null))
        }
    }
}

fn drawn() -> Result<u64, Said> {
    let drawn = getrandom::u64().map(|drawn| 1 + drawn % DRAWN);
    drawn.map_err(|error| {
        let error = Said::quoted(error.to_string());
        say!("the system has no random number: {error}")
    })
}

fn no_answer(refused: &Refused) -> Said {
    match refused {
        Refused::NoAnswer(why) | Refused::NoDiagnosis(why) => {
            say!("this is no answer to the exercise: {why}")
        }
        _ => say!("this is no answer to the exercise"),
    }
}

impl Exercise {
    fn say(&self, said: &Said) -> String {
        said.in_language(self.language)
    }

    fn title(&self) -> Block {
        let (seed, number) = (self.seed, self.number);
        Block::Title(self.say(&say!("Exercise {seed}, no. {number}")))
    }

    fn document(&self, files: Vec<String>, blocks: Vec<Block>) -> Document {
        let form = ExerciseJson {
            seed: self.seed,
            number: self.number,
            files,
        };
        Document::new(&form, self.language, blocks)
    }

    /// What stands in the page's form and is the same for both kinds.
    fn beside(&self, files: &[(String, Vec<u8>)]) -> Value {
        json!({ "seed": self.seed, "number": self.number, "most": MOST, "files": files })
    }

    fn sheet(&self) -> (String, Sheet) {
        let sheet = sheet(self.seed, self.number);
        let name = format!("budget-{:02}.{}", self.number, sheet.ending);
        (name, sheet)
    }

    fn budget(&self) -> (Document, Value) {
        let (name, sheet) = self.sheet();
        let grids = sheet::grids(&name, &sheet.bytes).unwrap_or_default();
        let task = say!(
            "This budget is sound, or has a slip or two in it, or a figure that nothing explains. Say what it is; of a slip, which kind and in which row."
        );
        let task = self.say(&task);
        let mut blocks = vec![self.title(), Block::Paragraph(task.clone())];
        blocks.extend(grids.iter().map(|grid| Block::Table(cells(grid))));
        // Only symbols that the sheet shows: one that is missing there may be what is concealed.
        let is_shown = |symbol: &&&str| {
            let mut all = grids.iter().flat_map(|grid| grid.rows.iter().flatten());
            all.any(|cell| cell.text.contains(**symbol))
        };
        let symbols: Vec<&&str> = sheet.symbols.iter().filter(is_shown).collect();
        let kinds = slips().map(|slip| {
            let words = self.language.pick(slip.en, slip.zh);
            (slip.id, words, is_of_a_row(slip.id))
        });
        let kinds: Vec<_> = kinds.collect();
        let files = [(name.clone(), sheet.bytes)];
        let mut beside = self.beside(&files);
        beside["task"] = json!(task);
        beside["symbols"] = json!(symbols);
        beside["kinds"] = json!(kinds);
        (self.document(vec![name], blocks), beside)
    }

    fn graded_budget(&self, answer: &str) -> Result<Document, Refused> {
        let (file, sheet) = self.sheet();
        let mut answers = read_sheet_answers(answer)?;
        for answer in &mut answers {
            answer.file.clone_from(&file);
        }
        let truth = SheetsTruth::of(self.seed, vec![SealedSheet::new(file, sheet)]);
        let graded = grade_sheets(&truth, &answers);
        let mut document = sheet_grades_document(&graded, self.language);
        let named = graded.iter().flat_map(|one| {
            let answered = one.answer.candidates.iter().flatten();
            one.sheet.truth.slips.iter().chain(answered)
        });
        let named: BTreeSet<&String> = named.collect();
        let words: Vec<String> = named.iter().filter_map(|name| self.words(name)).collect();
        if !words.is_empty() {
            document.edit(|blocks| blocks.push(Block::List(words)));
        }
        document.edit(|blocks| blocks.insert(0, self.title()));
        Ok(document)
    }

    /// A slip with what it is.
    fn words(&self, name: &str) -> Option<String> {
        let id = name.split('@').next().unwrap_or(name);
        let slip = slip(id)?;
        let words = self.language.pick(slip.en, slip.zh);
        Some(format!("{name}: {words}"))
    }

    /// As `gumption challenge --seed` makes it; the next exercise is that of the next seed.
    fn case(&self) -> SealedCase {
        challenge(&Request {
            seed: self.seed.saturating_add(self.number - 1),
            ..Request::default()
        })
    }

    fn recording(&self) -> (Document, Value) {
        let case = self.case();
        let files = case.files.iter();
        let files: Vec<(String, Vec<u8>)> = files
            .map(|file| (file.name.to_owned(), file.text.clone().into_bytes()))
            .collect();
        let recording = case.files.get(1).and_then(|file| file.text.lines().next());
        let columns = recording.unwrap_or_default().split(',');
        let columns: Vec<&str> = columns
            .map(|column| column.split(" [").next().unwrap_or(column))
            .collect();
        let blanks = Words {
            x: "x".into(),
            y: "y".into(),
            z: "z".into(),
            p: "p".into(),
        };
        let kinds = effects().iter().map(|effect| {
            let name = self.language.pick(&effect.name.en, &effect.name.zh);
            (effect.id.to_string(), blanks.fill(name))
        });
        let kinds: Vec<_> = kinds.collect();
        let task = say!(
            "A calibration in which something may act that the declared model leaves out. The case stands on the left with its recording: look at the residuals, say what was left out, what it follows, and how large it is in the residuals."
        );
        let task = self.say(&task);
        let blocks = vec![self.title(), Block::Paragraph(task.clone())];
        let mut beside = self.beside(&files);
        beside["task"] = json!(task);
        beside["columns"] = json!(columns);
        beside["kinds"] = json!(kinds);
        let names = files.into_iter().map(|(name, _)| name).collect();
        (self.document(names, blocks), beside)
    }

    fn graded_recording(&self, answer: &str) -> Result<Document, Refused> {
        let answer = grade::read_answer(answer)?;
        let graded = grade::grade(&self.case().truth, &answer);
        let mut document = grade::document(&graded, self.language);
        document.edit(|blocks| blocks.insert(0, self.title()));
        Ok(document)
    }

    /// The sheet for the teacher.
    fn answers(&self, kind: Kind) -> Document {
        let numbers = (1..=self.number).map(|number| Exercise { number, ..*self });
        let table = match kind {
            Kind::Budget => self.slips_of(numbers),
            Kind::Recording => self.physics_of(numbers),
        };
        let concealed = table.rows.iter().filter_map(|row| match row {
            Row::Cells(cells) => cells.get(1).map(|cell| format!("{cell:?}")),
            _ => None,
        });
        let form = AnswersJson {
            seed: self.seed,
            concealed: concealed.collect(),
        };
        let seed = self.seed;
        let title = say!("For the teacher: exercises {seed}");
        let command = match kind {
            Kind::Budget => {
                say!("`gumption challenge --audit --seed {seed}` writes the same budgets.")
            }
            Kind::Recording => say!(
                "`gumption challenge --seed {seed}` writes the first of these cases, the next seed the second, and so on."
            ),
        };
        let blocks = vec![
            Block::Title(self.say(&title)),
            Block::Table(table),
            Block::Paragraph(self.say(&command)),
        ];
        Document::new(&form, self.language, blocks)
    }

    fn slips_of(&self, exercises: impl Iterator<Item = Exercise>) -> Table {
        let pick = |english, chinese| self.language.pick(english, chinese);
        let mut table = Table::new([
            (pick("no.", "序号"), ColumnKind::Numbers),
            (pick("concealed", "隐藏的差错"), ColumnKind::Wrapped),
            (pick("right u_c", "正确的 u_c"), ColumnKind::Numbers),
            (pick("right U", "正确的 U"), ColumnKind::Numbers),
        ]);
        for exercise in exercises {
            let truth = exercise.sheet().1.truth;
            let slips = truth.slips.iter().filter_map(|name| self.words(name));
            let slips: Vec<String> = slips.collect();
            let concealed = match truth.verdict.as_str() {
                "sound" => pick("sound", "正确").to_owned(),
                "unexplained" => {
                    pick("a figure that nothing explains", "无法解释的数值").to_owned()
                }
                _ => slips.join("; "),
            };
            table.push(vec![
                exercise.number.to_string().into(),
                concealed.into(),
                format!("{:.4e}", truth.u_c).into(),
                format!("{:.4e}", truth.expanded).into(),
            ]);
        }
        table
    }

    fn physics_of(&self, exercises: impl Iterator<Item = Exercise>) -> Table {
        let pick = |english, chinese| self.language.pick(english, chinese);
        let mut table = Table::new([
            (pick("no.", "序号"), ColumnKind::Numbers),
            (pick("concealed", "隐藏的效应"), ColumnKind::Wrapped),
            (pick("right names", "正确的名称"), ColumnKind::Wrapped),
            (pick("in the residuals", "在残差中"), ColumnKind::Numbers),
            ("λ", ColumnKind::Numbers),
        ]);
        for exercise in exercises {
            let truth = exercise.case().truth;
            if truth.effects.is_empty() {
                table.push(vec![
                    exercise.number.to_string().into(),
                    pick("nothing", "无").into(),
                ]);
            }
            for effect in &truth.effects {
                let names = effect.names.iter().chain(&effect.aliases);
                let names = names.map(|name| match name.along.as_slice() {
                    [] => name.id.clone(),
                    along => format!("{} ({})", name.id, along.join(", ")),
                });
                let names: Vec<String> = names.collect();
                table.push(vec![
                    exercise.number.to_string().into(),
                    effect.physics.clone().into(),
                    names.join("; ").into(),
                    format!("{:.2e}", effect.in_residuals).into(),
                    format!("{:.1}", effect.lambda_beside).into(),
                ]);
            }
        }
        table
    }
}

/// A sheet as it is: rows by number, columns by letter, formulas behind their values.
fn cells(grid: &Grid) -> Table {
    let widest = grid.rows.iter().map(Vec::len).max().unwrap_or(0);
    let column = |head: String| Column {
        head,
        kind: ColumnKind::Wrapped,
    };
    let letters = (0..widest).map(|at| column(letters(at)));
    let mut table = Table {
        columns: std::iter::once(column(String::new()))
            .chain(letters)
            .collect(),
        rows: Vec::new(),
    };
    for (at, row) in grid.rows.iter().enumerate() {
        if row.iter().all(sheet::Cell::is_empty) {
            continue;
        }
        let texts = row.iter().map(|cell| match &cell.formula {
            Some(formula) => format!("{} [={formula}]", cell.text),
            None => cell.text.clone(),
        });
        // A heading runs over all columns.
        if let [text] = &row
            .iter()
            .filter(|cell| !cell.is_empty())
            .collect::<Vec<_>>()[..]
        {
            let text = format!("{}  {}", at + 1, text.text);
            table.rows.push(Row::Across(text));
            continue;
        }
        let number = std::iter::once((at + 1).to_string());
        table.push(number.chain(texts).map(Into::into).collect());
    }
    table
}

/// The letters of a column of a workbook, from 0: A, B … Z, AA …
fn letters(at: usize) -> String {
    let own = char::from(b'A' + (at % 26) as u8);
    match at / 26 {
        0 => own.to_string(),
        left => format!("{}{own}", letters(left - 1)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asked(kind: Kind, wanted: Wanted) -> Practice {
        Practice {
            kind,
            seed: Some(7),
            number: 2,
            wanted,
        }
    }

    fn found(wanted: &Practice, shown: &Shown) -> (Document, Value) {
        practice(wanted, Language::English, shown).expect("an exercise")
    }

    #[test]
    fn columns_have_letters() {
        assert_eq!(
            [0, 25, 26, 27, 701, 702].map(letters),
            ["A", "Z", "AA", "AB", "ZZ", "AAA"]
        );
    }

    /// What the page is sent before an answer is the sheet and what every exercise has.
    #[test]
    fn an_exercise_is_handed_out_without_its_truth() {
        let shown = Shown::default();
        for number in 1..=8 {
            let exercise = Exercise {
                seed: 7,
                number,
                language: Language::English,
            };
            let (document, mut beside) = exercise.budget();
            let truth = exercise.sheet().1.truth;
            // The list of kinds is that of the program.
            beside["kinds"] = Value::Null;
            beside["files"] = Value::Null;
            let sent = format!("{:?}{}{beside}", document.blocks(), document.machine.text());
            for name in &truth.slips {
                assert!(!sent.contains(name.as_str()), "{name}");
            }
        }
        let recording = asked(Kind::Recording, Wanted::Task);
        let (_, beside) = found(&recording, &shown);
        let files = beside["files"].as_array().expect("files");
        assert!(files.iter().all(|file| file[0] != "truth.json"));
        assert_eq!(files[0][0], "CASE.toml");
    }

    #[test]
    fn the_truth_is_exact_and_known_only_once() {
        let shown = Shown::default();
        let truth = sheet(7, 2).truth;
        let answer = json!({ "file": "", "verdict": truth.verdict, "candidates": [truth.slips] });
        let right = asked(Kind::Budget, Wanted::Grade(answer));
        let (document, _) = found(&right, &shown);
        assert_eq!(document.machine.value()["sheets"][0]["grade"], "exact");
        assert!(!matches!(document.blocks()[0], Block::Paragraph(_)));
        let (again, _) = found(&right, &shown);
        assert!(matches!(again.blocks()[0], Block::Paragraph(_)));
    }

    #[test]
    fn physics_is_graded_with_its_size() {
        let shown = Shown::default();
        let number = (1..=MOST).find(|number| {
            let seed = 7 + number - 1;
            let truth = challenge(&Request { seed, ..Request::default() }).truth;
            matches!(truth.effects.as_slice(), [one] if !one.names.is_empty() && one.aliases.is_empty())
        });
        let number = number.expect("a case with one effect that has a name");
        let exercise = Exercise {
            seed: 7,
            number,
            language: Language::English,
        };
        let truth = exercise.case().truth;
        let name = &truth.effects[0].names[0];
        let answer = json!({ "verdict": "departs", "effects": [{
            "state": "identified", "in_residuals": truth.effects[0].in_residuals,
            "named": [{ "id": name.id, "along": name.along.join(" ") }],
        }] });
        let wanted = Practice {
            number,
            ..asked(Kind::Recording, Wanted::Grade(answer))
        };
        let (document, _) = found(&wanted, &shown);
        let value = document.machine.value();
        assert_eq!(value["points"], 1.0);
        assert_eq!(value["attainable"], 1.0);
        assert_eq!(
            value["effects"][0]["answered_size"],
            value["effects"][0]["truth"]["in_residuals"]
        );
        let broken = asked(Kind::Recording, Wanted::Grade(json!(3)));
        assert!(practice(&broken, Language::English, &shown).is_err());
    }
}
