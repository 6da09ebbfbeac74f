//! The results of a batch, row by row, as lines of a table or as columns.

use super::rows::{Cell, Head};
use super::{Report, failure, remarks, rows};
use gumption_core::model::Output;
use gumption_fault::language::Language;
use gumption_fault::{Fault, Rejection};
use gumption_gum::batch::{BLOCK, Evaluated, Failed, Found};
use gumption_gum::budget::{BatchFile, Budget};
use gumption_gum::propagate::Verdict;
use std::borrow::Cow;

/// What the lines hold beside what is reported.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Columns {
    /// The share of each input in u²(y).
    pub shares: bool,
    /// c·u of each component: products of those that rows share are their covariance.
    pub contributions: bool,
    /// The seeds of the trials.
    pub seeds: bool,
    /// The language in which errors are told.
    pub language: Language,
}

/// Lines of some rows, made by whoever evaluated them.
#[derive(Debug, Default)]
pub struct Lines {
    /// The names of the columns, where a row has told them.
    heads: Option<Vec<Head>>,
    /// The heads of what is kept.
    kept: Option<Vec<String>>,
    /// The lines of those that have results, the labels of the others with what is kept of them.
    text: Vec<u8>,
    lines: Vec<Line>,
}

#[derive(Debug)]
struct Line {
    /// Where its label ends in the text with what is kept of it, and where the line does.
    label: usize,
    end: usize,
    /// How many cells it has; or why there are none.
    cells: Result<usize, String>,
    rejected: bool,
}

impl Lines {
    /// Adds the line of a row of numbers behind its label; or why there are none.
    pub(super) fn push(
        &mut self,
        label: &str,
        found: Result<(Vec<Head>, Vec<Option<f64>>), String>,
    ) {
        push_field(&mut self.text, label);
        let label = self.text.len();
        let cells = found.map(|(heads, numbers)| {
            for number in &numbers {
                self.text.push(b',');
                Cell::Number(*number).push(&mut self.text);
            }
            // There is no error.
            self.text.extend_from_slice(b",\n");
            self.heads.get_or_insert(heads);
            numbers.len() + 2
        });
        self.lines.push(Line {
            label,
            end: self.text.len(),
            cells,
            rejected: false,
        });
    }
}

impl Columns {
    /// Adds the line of a row: label or number, what is kept of it, then as [`super::rows`], the shares, the contributions, the seed of the trials,
    /// the findings, and the error of a row that has no result.
    pub fn add(self, lines: &mut Lines, row: &Evaluated<'_>) {
        let text = &mut lines.text;
        match row.label {
            Some(label) => push_field(text, label),
            None => Cell::Seed(Some(row.number)).push(text),
        }
        let (heads, kept) = row.kept;
        lines.kept.get_or_insert_with(|| heads.to_vec());
        for field in kept {
            text.push(b',');
            push_field(text, field);
        }
        let label = text.len();
        let mut rejected = false;
        let cells = match &row.found {
            Ok((budget, found)) => {
                lines.heads.get_or_insert_with(|| self.heads(budget));
                let mut cells = 1;
                rejected = self.cells(budget, found, |cell| {
                    cells += 1;
                    text.push(b',');
                    cell.push(text);
                });
                text.push(b'\n');
                Ok(cells)
            }
            Err(failed) => Err(why(failed, self.language)),
        };
        if lines.lines.is_empty() {
            // The others are about as long.
            text.reserve(BLOCK * text.len());
        }
        lines.lines.push(Line {
            label,
            end: text.len(),
            cells,
            rejected,
        });
    }

    /// Adds the values of a row: as [`Columns::add`], but for the label of a row that has none.
    pub fn add_values(self, values: &mut Values, row: &Evaluated<'_>) {
        let label = Cell::Text(row.label.unwrap_or_default());
        values.keep(row.kept);
        match &row.found {
            Ok((budget, found)) => {
                values.heads.get_or_insert_with(|| self.heads(budget));
                values.add(|give| {
                    give(label);
                    self.cells(budget, found, give)
                });
            }
            Err(failed) => values.add_failed(label, &why(failed, self.language)),
        }
    }

    /// The heads of the columns that rows of this budget have.
    fn heads(self, budget: &Budget) -> Vec<Head> {
        let mut heads = rows::heads(budget);
        if self.shares {
            let share = |output: &Output| {
                let name = output.name.clone();
                let inputs = budget.inputs.iter();
                inputs.map(move |input| Head::numbers(format!("share({name}, {})", input.name)))
            };
            heads.extend(budget.model.outputs().iter().flat_map(share));
        }
        if self.contributions {
            let contribution = |output: &Output| {
                let (name, unit) = (output.name.clone(), output.unit.difference());
                let components = budget.components.iter();
                components.map(move |one| {
                    let head = format!("contribution({name}, {})", one.name);
                    Head::numbers(rows::in_unit(head, &unit))
                })
            };
            heads.extend(budget.model.outputs().iter().flat_map(contribution));
        }
        heads.extend(self.seeds.then(|| Head::numbers("seed".into())));
        heads.extend(["findings", "error"].map(Head::texts));
        heads
    }

    /// Gives the cells behind the label; tells whether an item does not conform.
    fn cells(self, budget: &Budget, found: &Found<'_>, mut give: impl FnMut(Cell<'_>)) -> bool {
        let number = |x: f64| Cell::Number(Some(x));
        match found {
            Found::Figures(row) => {
                let measurands = 0..budget.model.outputs().len();
                for measurand in measurands.clone() {
                    rows::figures(&row.figures(measurand), &mut give);
                }
                if self.shares {
                    let shares = measurands.clone().flat_map(|one| row.shares(one));
                    shares.for_each(|one| give(number(one)));
                }
                if self.contributions {
                    let all = measurands.clone().flat_map(|one| row.contributions(one));
                    all.for_each(|one| give(number(one)));
                }
                if self.seeds {
                    give(Cell::Seed(None));
                }
                let few = |one| Some((remarks::code(&row.few_degrees(one)?), Some(one)));
                let few = measurands.filter_map(few);
                give(Cell::Text(&codes(budget, few)));
                give(Cell::Text(""));
                false
            }
            Found::Evaluation(evaluation) => {
                let report = Report {
                    budget,
                    evaluation,
                    label: None,
                    language: self.language,
                };
                rows::cells(&report, &mut give);
                if self.shares {
                    let lines = evaluation.results.iter();
                    let lines = lines.flat_map(|result| &result.gum.inputs);
                    lines.for_each(|line| give(number(line.share)));
                }
                if self.contributions {
                    let lines = evaluation.results.iter();
                    let lines = lines.flat_map(|result| &result.gum.components);
                    lines.for_each(|line| give(number(line.contribution)));
                }
                if self.seeds {
                    give(Cell::Seed(evaluation.run.as_ref().map(|run| run.seed)));
                }
                let findings = evaluation.findings.iter();
                let findings = findings.map(|one| (remarks::code(&one.kind), one.measurand));
                give(Cell::Text(&codes(budget, findings)));
                give(Cell::Text(""));
                let refuses = |verdict| verdict == Some(Verdict::NotConforming);
                let mut conformity = evaluation.conformity.iter();
                conformity.any(|found| refuses(found.verdict))
            }
        }
    }
}

/// Adds a field, in quotes where it has to be.
fn push_field(text: &mut Vec<u8>, field: &str) {
    match field.contains([',', '"', '\n', '\r']) {
        true => {
            text.push(b'"');
            text.extend(field.replace('"', "\"\"").bytes());
            text.push(b'"');
        }
        false => text.extend(field.bytes()),
    }
}

/// Adds a line of fields.
fn push_line(text: &mut Vec<u8>, fields: impl IntoIterator<Item = String>) {
    for (at, field) in fields.into_iter().enumerate() {
        text.extend((at > 0).then_some(b','));
        push_field(text, &field);
    }
    text.push(b'\n');
}

/// The codes of findings; behind each the measurand that it is about, where there are several.
fn codes<'c>(budget: &Budget, findings: impl Iterator<Item = (&'c str, Option<usize>)>) -> String {
    let outputs = budget.model.outputs();
    let mut codes = String::new();
    for (code, measurand) in findings {
        let space = if codes.is_empty() { "" } else { " " };
        codes.extend([space, code]);
        if let Some(measurand) = measurand.filter(|_| outputs.len() > 1) {
            codes.extend(["(", &outputs[measurand].name, ")"]);
        }
    }
    codes
}

fn why(failed: &Failed, language: Language) -> String {
    match failed {
        Failed::Row(fault) => described(fault, language),
        Failed::Refused(rejection) => refused(rejection, language),
        Failed::NoResult(error) => failure(error, language),
    }
}

/// All faults of a file and of those that it uses, in one line.
pub(super) fn refused(rejection: &Rejection, language: Language) -> String {
    let Rejection { faults, others, .. } = rejection;
    let others = others.iter().flat_map(|other| &other.faults);
    let all = faults.iter().chain(others);
    let all: Vec<String> = all.map(|fault| described(fault, language)).collect();
    all.join("; ")
}

/// A fault in one line, with its code.
fn described(fault: &Fault, language: Language) -> String {
    let message = fault.message.in_language(language);
    let help = fault.help.as_ref().map(|help| help.in_language(language));
    let help = help.map_or(String::new(), |help| format!(" ({help})"));
    format!("{}: {message}{help}", fault.code.id).replace('\n', " ")
}

/// The table of a batch, which grows by lines; nothing of it is kept but what the first line needs.
#[derive(Debug, Default)]
pub struct Table {
    heads: Option<Vec<Head>>,
    kept: Option<Vec<String>>,
    /// Whether they are written.
    headed: bool,
    /// Rows without a result, as long as no row has told what the columns are.
    waiting: Vec<Lines>,
    count: Count,
}

/// How the rows of a batch have ended.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Count {
    /// All of them.
    pub rows: u64,
    /// Those without a result.
    pub failed: u64,
    /// Those whose item does not conform.
    pub rejected: u64,
}

impl Table {
    /// Nothing is in it yet. Its columns are those of the budget where that is whole without a row, else those of the first row
    /// that has a result.
    pub fn of(columns: Columns, file: &BatchFile<'_>) -> Table {
        Table {
            heads: file.alone().map(|budget| columns.heads(&budget)),
            ..Table::default()
        }
    }

    /// The bytes that these lines add, as comma-separated values.
    pub fn add(&mut self, mut lines: Lines) -> Vec<u8> {
        self.heads = self.heads.take().or(lines.heads.take());
        self.kept = self.kept.take().or(lines.kept.take());
        let Some(heads) = &self.heads else {
            self.waiting.push(lines);
            return Vec::new();
        };
        let is_good = |line: &Line| line.cells.as_ref().is_ok_and(|cells| *cells == heads.len());
        if self.headed && lines.lines.iter().all(is_good) {
            self.count.rows += lines.lines.len() as u64;
            let rejected = lines.lines.iter().filter(|line| line.rejected);
            self.count.rejected += rejected.count() as u64;
            return lines.text;
        }
        let mut text = Vec::with_capacity(lines.text.len());
        if !self.headed {
            let (label, others) = heads.split_at(1);
            let name = |head: &'_ Head| head.name.clone();
            let kept = self.kept.iter().flatten().cloned();
            let names = label.iter().map(name).chain(kept);
            push_line(&mut text, names.chain(others.iter().map(name)));
            self.headed = true;
        }
        let waiting = std::mem::take(&mut self.waiting);
        for lines in waiting.into_iter().chain([lines]) {
            let mut start = 0;
            for line in lines.lines {
                let (label, whole) = (&lines.text[start..line.label], &lines.text[start..line.end]);
                start = line.end;
                self.count.rows += 1;
                self.count.rejected += u64::from(line.rejected);
                let why = match line.cells {
                    Ok(cells) if cells == heads.len() => {
                        text.extend_from_slice(whole);
                        continue;
                    }
                    Ok(cells) => of_another_length(cells, heads),
                    Err(why) => why,
                };
                self.count.failed += 1;
                text.extend_from_slice(label);
                text.extend(std::iter::repeat_n(b',', heads.len().saturating_sub(1)));
                push_field(&mut text, &why);
                text.push(b'\n');
            }
        }
        text
    }

    /// What is left where no row has a result, and how the rows have ended.
    pub fn end(mut self) -> (Vec<u8>, Count) {
        if self.headed {
            return (Vec::new(), self.count);
        }
        let head = Lines {
            heads: Some(nothing()),
            ..Lines::default()
        };
        (self.add(head), self.count)
    }
}

/// The heads of a table in which no row has a result.
fn nothing() -> Vec<Head> {
    ["label", "error"].map(Head::texts).to_vec()
}

fn of_another_length(cells: usize, heads: &[Head]) -> String {
    format!("{cells} figures where the first row has {}", heads.len())
}

/// Values of some rows, made by whoever evaluated them.
#[derive(Debug, Default)]
pub struct Values {
    /// As of [`Lines`].
    heads: Option<Vec<Head>>,
    /// What is kept of them, below its heads.
    kept: Vec<(String, Vec<String>)>,
    stretches: Vec<Stretch>,
}

/// Rows that have equally many cells, as columns: the first are their labels, the last the errors of those among them that
/// have no result.
#[derive(Debug, Default)]
struct Stretch {
    columns: Vec<ResultColumn>,
    count: Count,
}

impl Values {
    /// Keeps the fields of a row below their heads.
    fn keep(&mut self, (heads, fields): (&[String], &[Cow<'_, str>])) {
        if self.kept.is_empty() {
            let heads = heads.iter().cloned();
            self.kept = heads.map(|head| (head, Vec::new())).collect();
        }
        for ((_, texts), field) in self.kept.iter_mut().zip(fields) {
            texts.push(field.to_string());
        }
    }

    /// Adds a row, of which `cells` gives the cells and tells whether an item does not conform.
    fn add(&mut self, cells: impl Fn(&mut dyn FnMut(Cell<'_>)) -> bool) {
        let added = self.stretches.last_mut().map(|last| last.add(&cells));
        if added != Some(true) {
            let mut stretch = Stretch::default();
            stretch.add(&cells);
            self.stretches.push(stretch);
        }
    }

    fn add_failed(&mut self, label: Cell<'_>, why: &str) {
        let why = Cell::Text(why);
        match self.stretches.last_mut() {
            Some(last) => last.add_failed(label, why),
            None => self.add(|give| {
                give(label);
                give(why);
                false
            }),
        }
    }
}

impl Stretch {
    /// Adds a row; false, and nothing is added, where it has another number of cells than those before it.
    fn add(&mut self, cells: impl Fn(&mut dyn FnMut(Cell<'_>)) -> bool) -> bool {
        let Stretch { columns, count } = self;
        let row = count.rows as usize;
        let mut at = 0;
        let rejected = cells(&mut |cell| {
            if row == 0 {
                columns.push(ResultColumn::Texts(None));
            }
            if let Some(column) = columns.get_mut(at) {
                column.set(row, cell);
            }
            at += 1;
        });
        let fits = at == columns.len();
        match fits {
            true => {
                count.rows += 1;
                count.rejected += u64::from(rejected);
            }
            false => columns.iter_mut().for_each(|column| column.cut(row)),
        }
        fits
    }

    fn add_failed(&mut self, label: Cell<'_>, why: Cell<'_>) {
        let row = self.count.rows as usize;
        if let [labels, .., errors] = self.columns.as_mut_slice() {
            labels.set(row, label);
            errors.set(row, why);
        }
        self.count.rows += 1;
    }

    /// As many columns as these heads: where it has others, its rows have labels and errors alone.
    fn below(self, heads: &[Head]) -> Vec<ResultColumn> {
        let Stretch { mut columns, count } = self;
        let cells = columns.len();
        if cells == heads.len() {
            return columns;
        }
        let mut errors = columns.pop().map_or(Vec::new(), ResultColumn::texts);
        errors.resize(count.rows as usize, String::new());
        for error in errors.iter_mut().filter(|error| error.is_empty()) {
            // A vector of another length, or an assessment more.
            *error = of_another_length(cells, heads);
        }
        columns.truncate(1);
        columns.extend(heads[2..].iter().map(ResultColumn::below));
        columns.push(ResultColumn::Texts(Some(errors)));
        columns
    }
}

/// A column of results.
#[derive(Debug, Clone, PartialEq)]
pub enum ResultColumn {
    /// Numbers; none where one is not a number.
    Numbers(Vec<f64>),
    /// Texts; nothing where all of them are empty.
    Texts(Option<Vec<String>>),
}

/// The results of a batch as columns, which grow by rows.
#[derive(Debug, Default)]
pub struct Results {
    heads: Option<Vec<Head>>,
    columns: Vec<ResultColumn>,
    /// What is kept of the rows.
    kept: Vec<(String, Vec<String>)>,
    waiting: Vec<Values>,
    count: Count,
    /// Rows that were taken away.
    taken: u64,
}

impl Results {
    /// Nothing is in them yet. Columns are as of [`Table::of`].
    pub fn of(columns: Columns, file: &BatchFile<'_>) -> Results {
        Results {
            heads: file.alone().map(|budget| columns.heads(&budget)),
            ..Results::default()
        }
    }

    /// Adds rows.
    pub fn add(&mut self, mut values: Values) {
        self.heads = self.heads.take().or(values.heads.take());
        if self.kept.is_empty() {
            let heads = values.kept.iter().map(|(head, _)| head.clone());
            self.kept = heads.map(|head| (head, Vec::new())).collect();
        }
        self.waiting.push(values);
        let Some(heads) = &self.heads else { return };
        if self.columns.is_empty() {
            self.columns = heads.iter().map(ResultColumn::below).collect();
        }
        for values in std::mem::take(&mut self.waiting) {
            for ((_, texts), (_, added)) in self.kept.iter_mut().zip(values.kept) {
                texts.extend(added);
            }
            for stretch in values.stretches {
                self.add_below(stretch);
            }
        }
    }

    /// Adds rows below the heads that are there.
    fn add_below(&mut self, stretch: Stretch) {
        let at = self.rows();
        self.count.rows += stretch.count.rows;
        self.count.rejected += stretch.count.rejected;
        let added = stretch.below(self.heads.as_deref().unwrap_or_default());
        if let Some(ResultColumn::Texts(Some(errors))) = added.last() {
            let failed = errors.iter().filter(|error| !error.is_empty());
            self.count.failed += failed.count() as u64;
        }
        let columns = self.columns.iter_mut().zip(added);
        columns.for_each(|(column, added)| column.append(at, added));
    }

    /// How many rows are in them.
    pub fn rows(&self) -> usize {
        (self.count.rows - self.taken) as usize
    }

    /// The columns of the rows that are in them, with their heads; the next ones follow those.
    pub fn take(&mut self) -> Vec<(String, ResultColumn)> {
        let rows = self.rows();
        self.taken = self.count.rows;
        self.columns.iter_mut().for_each(|column| column.fill(rows));
        let columns = self.columns.iter_mut();
        let columns = columns.map(|column| std::mem::replace(column, column.emptied()));
        let names = self.heads.iter().flatten().map(|head| head.name.clone());
        let mut found: Vec<_> = names.zip(columns).collect();
        let kept = self.kept.iter_mut();
        let kept = kept.map(|(head, texts)| {
            let texts = ResultColumn::Texts(Some(std::mem::take(texts)));
            (head.clone(), texts)
        });
        found.splice(1..1, kept);
        found
    }

    /// The columns with their heads, and how the rows have ended.
    pub fn end(mut self) -> (Vec<(String, ResultColumn)>, Count) {
        // A table without rows has columns, too.
        self.add(Values {
            heads: Some(nothing()),
            ..Values::default()
        });
        (self.take(), self.count)
    }
}

impl ResultColumn {
    /// The empty one below a head.
    fn below(head: &Head) -> ResultColumn {
        match head.numbers {
            true => ResultColumn::Numbers(Vec::new()),
            false => ResultColumn::Texts(None),
        }
    }

    /// How many cells it has; of texts that are all empty nobody knows.
    pub fn cells(&self) -> usize {
        match self {
            ResultColumn::Numbers(numbers) => numbers.len(),
            ResultColumn::Texts(texts) => texts.as_ref().map_or(0, Vec::len),
        }
    }

    /// One of the same kind, with nothing in it.
    fn emptied(&self) -> ResultColumn {
        match self {
            ResultColumn::Numbers(_) => ResultColumn::Numbers(Vec::new()),
            ResultColumn::Texts(_) => ResultColumn::Texts(None),
        }
    }

    fn texts(self) -> Vec<String> {
        match self {
            ResultColumn::Texts(texts) => texts.unwrap_or_default(),
            ResultColumn::Numbers(_) => Vec::new(),
        }
    }

    /// Makes it so long.
    fn fill(&mut self, rows: usize) {
        match self {
            ResultColumn::Numbers(numbers) => numbers.resize(rows, f64::NAN),
            ResultColumn::Texts(Some(texts)) => texts.resize(rows, String::new()),
            ResultColumn::Texts(None) => {}
        }
    }

    /// Makes it no longer than this.
    fn cut(&mut self, rows: usize) {
        match self {
            ResultColumn::Numbers(numbers) => numbers.truncate(rows),
            ResultColumn::Texts(Some(texts)) => texts.truncate(rows),
            ResultColumn::Texts(None) => {}
        }
    }

    /// Sets the cell of a row behind those that are there; a column of which nothing is there becomes one of numbers by one.
    fn set(&mut self, row: usize, cell: Cell<'_>) {
        match cell {
            Cell::Number(x) => self.set_number(row, x.unwrap_or(f64::NAN)),
            // A seed is at most 2^53.
            Cell::Seed(seed) => self.set_number(row, seed.map_or(f64::NAN, |x| x as f64)),
            Cell::Text("") => {}
            Cell::Text(text) => self.append(row, ResultColumn::Texts(Some(vec![text.to_owned()]))),
        }
    }

    fn set_number(&mut self, row: usize, x: f64) {
        if let ResultColumn::Texts(None) = self {
            *self = ResultColumn::Numbers(Vec::with_capacity(BLOCK));
        }
        if let ResultColumn::Numbers(numbers) = self {
            if numbers.len() < row {
                numbers.resize(row, f64::NAN);
            }
            numbers.push(x);
        }
    }

    /// Adds a column from this row on, behind what is there.
    fn append(&mut self, row: usize, added: ResultColumn) {
        match (self, added) {
            (ResultColumn::Numbers(numbers), ResultColumn::Numbers(added)) => {
                numbers.resize(row, f64::NAN);
                numbers.extend_from_slice(&added);
            }
            (ResultColumn::Texts(texts), ResultColumn::Texts(Some(added))) => {
                let texts = texts.get_or_insert_default();
                texts.resize(row, String::new());
                texts.extend(added);
            }
            _ => {}
        }
    }
}
