//! Graded answers as a document.

use gumption_fault::say;
use gumption_format::document::{Block, ColumnKind, Document, Table};
use gumption_format::machine::{self, Machine, record};
use gumption_report::{Language, significant};
use serde_json::Value;

use super::case::SheetTruth;
use super::grade::{GradedSheet, SheetGrade};

/// The document of graded answers.
pub fn sheet_grades_document(graded: &[GradedSheet], language: Language) -> Document {
    Document::new(&form(graded), language, blocks(graded, language))
}

/// JSON Schema of the output of `gumption grade --audit --json`.
pub fn sheet_grades_schema() -> Value {
    machine::schema::<SheetGradesJson<'_>>("gumption grade --audit --json")
}

record! {
    /// Answers about claimed budgets held against the truth.
    SheetGradesJson<'a> {
        /// Answers that name the truth first.
        exact: usize,
        /// Answers that have the truth in their list, first or not.
        in_list: usize,
        /// Every budget.
        sheets: Vec<SheetGradeJson<'a>>,
    }

    /// One budget.
    SheetGradeJson<'a> {
        /// Its file.
        file: &'a str,
        /// What it is: `sound`, `slips` or `unexplained`.
        truth: &'a str,
        /// The slips that are in it.
        slips: &'a [String],
        /// What the answer says it is; empty where there is none.
        verdict: &'a str,
        /// The first set of slips of the answer.
        first: Vec<String>,
        /// `exact`, `listed`, `wrong`, `missed` or `false alarm`.
        grade: &'static str,
        /// Whether u_c and U of the answer are right to two digits.
        right_figures: bool,
        /// Other sets of slips that give the same sheet to every digit.
        rivals: usize,
    }
}

impl Machine for SheetGradesJson<'_> {
    const KIND: &'static str = "sheet grades";
    const VERSION: u32 = 1;
}

fn is_listed(graded: &&GradedSheet) -> bool {
    matches!(graded.grade, SheetGrade::Exact | SheetGrade::Listed)
}

fn exact(graded: &[GradedSheet]) -> usize {
    let exact = |one: &&GradedSheet| one.grade == SheetGrade::Exact;
    graded.iter().filter(exact).count()
}

fn form(graded: &[GradedSheet]) -> SheetGradesJson<'_> {
    fn sheet(one: &GradedSheet) -> SheetGradeJson<'_> {
        SheetGradeJson {
            file: &one.sheet.file,
            truth: &one.sheet.truth.verdict,
            slips: &one.sheet.truth.slips,
            verdict: &one.answer.verdict,
            first: one.answer.candidates.first().cloned().unwrap_or_default(),
            grade: one.grade.name(),
            right_figures: one.answer.has_right_figures(&one.sheet.truth),
            rivals: one.sheet.truth.rivals,
        }
    }
    SheetGradesJson {
        exact: exact(graded),
        in_list: graded.iter().filter(is_listed).count(),
        sheets: graded.iter().map(sheet).collect(),
    }
}

fn blocks(graded: &[GradedSheet], language: Language) -> Vec<Block> {
    let pick = |english: &'static str, chinese: &'static str| language.pick(english, chinese);
    let mut table = Table::new([
        (pick("file", "文件"), ColumnKind::Names),
        (pick("concealed", "隐藏的差错"), ColumnKind::Wrapped),
        (pick("answer", "回答"), ColumnKind::Wrapped),
        (pick("grade", "评分"), ColumnKind::Wrapped),
        (pick("right u_c; U", "正确的 u_c；U"), ColumnKind::Wrapped),
    ]);
    for one in graded {
        let answer = match one.answer.candidates.first() {
            Some(set) if one.answer.verdict == "slips" => set.join(" + "),
            _ => verdict(&one.answer.verdict, language),
        };
        let concealed = match one.sheet.truth.slips.as_slice() {
            [] => verdict(&one.sheet.truth.verdict, language),
            slips => slips.join(" + "),
        };
        table.push(vec![
            one.sheet.file.clone().into(),
            concealed.into(),
            answer.into(),
            words(one, language).into(),
            figures(one, language).into(),
        ]);
    }
    let of = graded.len();
    let (exact, listed) = (exact(graded), graded.iter().filter(is_listed).count());
    let closing = say!("{exact} of {of} named first, {listed} in the list").in_language(language);
    vec![Block::Table(table), Block::Closing(vec![closing])]
}

fn verdict(verdict: &str, language: Language) -> String {
    match verdict {
        "sound" => language.pick("sound", "正确"),
        "unexplained" => language.pick("unexplained", "无法解释"),
        "" => language.pick("no answer", "未作答"),
        other => other,
    }
    .to_string()
}

/// The right figures, and whether the answer has them.
fn figures(one: &GradedSheet, language: Language) -> String {
    let SheetTruth { u_c, expanded, .. } = &one.sheet.truth;
    let answered = match (
        one.answer.u_c.is_some(),
        one.answer.has_right_figures(&one.sheet.truth),
    ) {
        (false, _) => "",
        (true, true) => language.pick(", as answered", "，与回答一致"),
        (true, false) => language.pick(", not as answered", "，与回答不一致"),
    };
    let [u_c, expanded] = [*u_c, *expanded].map(|figure| significant(figure, 4));
    format!("{u_c}; {expanded}{answered}")
}

fn words(one: &GradedSheet, language: Language) -> String {
    let word = match one.grade {
        SheetGrade::Exact => language.pick("exact", "正确"),
        SheetGrade::Listed => language.pick("listed, not first", "在列表中，但非首选"),
        SheetGrade::Wrong => language.pick("wrong", "错误"),
        SheetGrade::Missed => language.pick("missed", "漏判"),
        SheetGrade::FalseAlarm => language.pick("false alarm", "误报"),
    };
    let alike = match (one.grade, one.sheet.truth.rivals) {
        (SheetGrade::Exact, _) | (_, 0) => String::new(),
        (_, n) => say!("; {n} other sets give the same sheet").in_language(language),
    };
    word.to_string() + &alike
}
