//! Sheets read by meaning: which cells are a budget, and what they say.
//!
//! | chapter | holds |
//! |---|---|
//! | `beside` | tables side by side |
//! | `columns` | what a column is, by its head |
//! | `table` | where a table stands, and its rows |
//! | `kind` | what is known of a quantity, by the words for it |
//! | `converter` | the step of a converter, from its bits and range |
//! | `footer` | claimed figures of the whole |
//! | `notes` | model, correlations, rules |
//! | `mapping` | what a user says of a sheet |
//! | `prose` | budgets without a table |
//! | `turned` | tables whose rows and columns are exchanged |
//! | `words` | words and figures in texts |

mod beside;
mod columns;
mod converter;
mod footer;
mod kind;
mod mapping;
mod notes;
mod prose;
mod table;
mod turned;
mod words;

pub use columns::Role;
pub use mapping::Mapping;
pub(crate) use words::{count_before, figure_after, figures_with_units, has_symbol, symbol_at};

use std::ops::Range;

use crate::claim::{Claimed, Row, Stale, Understood};

use crate::printed::{Place, Printed};
use crate::sheet::{Cell, Grid};

use table::Located;

/// A line of text beside a table.
#[derive(Debug, Clone)]
struct Line {
    text: String,
    at: Place,
}

/// Every budget of a file.
pub fn budgets(grids: &[Grid], mapping: &Mapping) -> Vec<Claimed> {
    let parts = grids.iter().flat_map(beside::parted);
    let grids: Vec<Grid> = parts.map(|part| turned::upright(&part)).collect();
    let mut found: Vec<Found> = Vec::new();
    for (sheet, grid) in grids.iter().enumerate() {
        let tables = table::locate(grid, mapping).into_iter();
        found.extend(tables.map(|located| Found::new(grid, sheet, located)));
    }
    let (inputs, evaluated): (Vec<Found>, Vec<Found>) = found
        .iter()
        .cloned()
        .partition(|one| found.iter().any(|other| one.states_inputs_of(other)));
    let outside = |sheet: usize| {
        let of_inputs = |row: usize| {
            inputs
                .iter()
                .any(|one| one.sheet == sheet && one.located.is_used(row))
        };
        lines(&grids[sheet], sheet, 0..grids[sheet].rows.len(), of_inputs)
    };
    let without = |sheet: &usize| evaluated.iter().all(|one| one.sheet != *sheet);
    let common: Vec<Line> = (0..grids.len()).filter(without).flat_map(outside).collect();
    if evaluated.is_empty() {
        let told = prose(&common, mapping).or_else(|| running(&common, mapping));
        return told.into_iter().collect();
    }
    let tables = evaluated.iter().enumerate().map(|(i, one)| {
        let grid = &grids[one.sheet];
        let near = |j: Option<usize>| {
            j.and_then(|j| evaluated.get(j))
                .filter(|o| o.sheet == one.sheet)
        };
        let start = near(i.checked_sub(1)).map_or(0, |other| {
            between(grid, other.located.end, one.located.head)
        });
        let end = near(Some(i + 1)).map_or(grid.rows.len(), |other| {
            between(grid, one.located.end, other.located.head)
        });
        let own: Vec<&Found> = inputs
            .iter()
            .filter(|input| input.states_inputs_of(one))
            .collect();
        budget(grid, one, start..end, &common, &own, mapping)
    });
    tables.collect()
}

/// A table on a sheet, with its rows.
#[derive(Debug, Clone)]
struct Found {
    sheet: usize,
    located: Located,
    raw: Vec<table::Raw>,
}

impl Found {
    fn new(grid: &Grid, sheet: usize, located: Located) -> Found {
        let raw = table::rows(grid, sheet, &located);
        Found {
            sheet,
            located,
            raw,
        }
    }

    /// Whether this table says what is known of the rows that another one evaluates.
    fn states_inputs_of(&self, other: &Found) -> bool {
        if self.located.is_evaluated() || !other.located.is_evaluated() {
            return false;
        }
        let shared = other
            .raw
            .iter()
            .filter(|raw| self.raw.iter().any(|own| own.is_of(raw)));
        2 * shared.count() > other.raw.len()
    }
}

/// A budget that is told in sentences.
fn prose(all: &[Line], mapping: &Mapping) -> Option<Claimed> {
    let mut rows: Vec<(usize, Row)> = all
        .iter()
        .enumerate()
        .filter_map(|(i, line)| Some((i, prose::row(&line.text, line.at)?)))
        .collect();
    // What stands in front of a list of symbols is its title, and notes.
    let has_symbol = |(_, row): &(usize, Row)| !row.symbol.is_empty();
    if rows.iter().filter(|row| has_symbol(row)).count() >= 2 {
        let first = rows.iter().position(has_symbol).unwrap_or(0);
        rows.drain(..first);
    }
    if rows.len() < 2 {
        return None;
    }
    Some(told(all, rows, mapping))
}

/// A budget that is told in running text: what its sentences state, and u_c or U of it.
fn running(all: &[Line], mapping: &Mapping) -> Option<Claimed> {
    let sentences = all.iter().flat_map(|line| {
        prose::sentences(&line.text).map(|text| Line {
            text: text.into(),
            at: line.at,
        })
    });
    let sentences: Vec<Line> = sentences.collect();
    let row = |(i, line): (usize, &Line)| Some((i, prose::sentence(&line.text, line.at)?));
    let rows: Vec<(usize, Row)> = sentences.iter().enumerate().filter_map(row).collect();
    let claimed = (rows.len() >= 2).then(|| told(&sentences, rows, mapping))?;
    let footer = &claimed.footer;
    (footer.u_c.is_some() || footer.expanded.is_some()).then_some(claimed)
}

/// The budget of these rows, which some of the lines are.
fn told(all: &[Line], rows: Vec<(usize, Row)>, mapping: &Mapping) -> Claimed {
    let others: Vec<&Line> = (0..all.len())
        .filter(|i| rows.iter().all(|(row, _)| row != i))
        .map(|i| &all[i])
        .collect();
    let mut raw: Vec<table::Raw> = rows
        .into_iter()
        .map(|(_, row)| table::Raw::told(row))
        .collect();
    let mut claimed = Claimed {
        rows: raw.iter().map(|raw| raw.row.clone()).collect(),
        title: others
            .first()
            .map(|line| line.text.clone())
            .unwrap_or_default(),
        ..Claimed::default()
    };
    find_model(&others, &mut claimed, mapping);
    symbols_of_model(&mut raw, &mut claimed);
    place_lines(&others, &mut claimed);
    table::interpret(&raw, false, &mut claimed);
    claimed
}

/// Where the text between two tables passes from one to the other: at the widest gap, the last of equal ones, or half a
/// page.
fn between(grid: &Grid, end: usize, head: usize) -> usize {
    let is_blank = |row: usize| grid.filled(row).next().is_none();
    let gap = |row: usize| (end..=row).rev().take_while(|row| is_blank(*row)).count();
    let last = (end..head).max_by_key(|row| gap(*row));
    last.filter(|row| gap(*row) > 0)
        .map_or(head, |blank| blank + 1)
}

/// Lines of text outside the tables.
fn lines(grid: &Grid, sheet: usize, rows: Range<usize>, used: impl Fn(usize) -> bool) -> Vec<Line> {
    let outside = rows.filter(|row| !used(*row));
    outside
        .filter_map(|row| {
            let cells: Vec<&str> = grid
                .filled(row)
                .map(|(_, cell)| cell.text.as_str())
                .collect();
            let (column, _) = grid.filled(row).next()?;
            Some(Line {
                text: cells.join(" ; "),
                at: Place { sheet, row, column },
            })
        })
        .collect()
}

fn budget(
    grid: &Grid,
    found: &Found,
    bounds: Range<usize>,
    common: &[Line],
    inputs: &[&Found],
    mapping: &Mapping,
) -> Claimed {
    let (sheet, mut located) = (found.sheet, found.located.clone());
    let mut claimed = Claimed {
        understood: located.understood(grid, sheet),
        ..Claimed::default()
    };
    let mut raw = found.raw.clone();
    for raw in &mut raw {
        let of_row = inputs.iter().flat_map(|input| &input.raw);
        if let Some(input) = of_row.into_iter().find(|input| input.is_of(raw)) {
            raw.absorb(input);
        }
    }
    let of_inputs = |row: usize| {
        inputs
            .iter()
            .any(|input| input.sheet == sheet && input.located.is_used(row))
    };
    let own = |located: &Located| {
        lines(grid, sheet, bounds.clone(), |row| {
            located.is_used(row) || of_inputs(row)
        })
    };
    let first = own(&located);
    claimed.rows = raw.iter().map(|raw| raw.row.clone()).collect();
    claimed.unit = located.unit.clone();
    claimed.title = first
        .iter()
        .find(|line| line.at.row < located.head && !line.text.contains('='))
        .map(|line| line.text.clone())
        .unwrap_or_default();
    find_model(
        &first.iter().chain(common).collect::<Vec<_>>(),
        &mut claimed,
        mapping,
    );
    drop_measurand(grid, &mut raw, &mut claimed);
    symbols_of_model(&mut raw, &mut claimed);
    let below = located.head + 1..bounds.end;
    table::footers(grid, sheet, &mut located, below, of_inputs, &mut claimed);
    claimed.typed = typed(grid, sheet, &claimed);
    claimed.stale = stale(grid, sheet, bounds.clone());
    if located.has_bare_u_behind_c() {
        u_by_sum(&mut claimed);
    }
    let own = own(&located);
    let all: Vec<&Line> = own.iter().chain(common).collect();
    place_lines(&all, &mut claimed);
    let missing = missing_input(&claimed, &all);
    // Some sheets have their result in front of the table.
    if claimed.footer.u_c.is_none() && claimed.footer.expanded.is_none() {
        let above = bounds.start..located.head;
        table::footers(grid, sheet, &mut located, above, of_inputs, &mut claimed);
        if claimed.unit.is_empty() {
            claimed.unit = unit_of_result(&claimed);
        }
    }
    let full = located.is_evaluated();
    table::interpret(&raw, full, &mut claimed);
    claimed.rows.extend(missing);
    claimed
}

/// Figures behind the coefficients, of which the head says no more than `u_i`, are u where u_c is the sum of their squares
/// with the coefficients, and not without.
fn u_by_sum(claimed: &mut Claimed) {
    let footer = &claimed.footer;
    let half = footer.expanded.as_ref().zip(footer.k.as_ref());
    let of_expanded = half.map(|(expanded, k)| (expanded.value / k.value, expanded.half / k.value));
    let stated = footer.u_c.as_ref().map(|u_c| (u_c.value, u_c.half));
    let Some((u_c, half)) = stated.or(of_expanded) else {
        return;
    };
    let sum = |with_c: bool| {
        let square = |row: &Row| {
            let c = row.c.as_ref().filter(|_| with_c).map_or(1.0, |c| c.value);
            let part = row.contribution.as_ref().map_or(0.0, |u| c * u.value);
            part * part
        };
        libm::sqrt(claimed.rows.iter().map(square).sum())
    };
    let near = |sum: f64| (sum - u_c).abs() <= half + 0.01 * u_c;
    if near(sum(true)) && !near(sum(false)) {
        for row in &mut claimed.rows {
            row.u = row.contribution.take();
        }
    }
}

/// Cells of a budget whose formulas give other figures than they hold.
fn stale(grid: &Grid, sheet: usize, rows: Range<usize>) -> Vec<Stale> {
    let cells = rows.flat_map(|row| {
        grid.filled(row)
            .map(move |(column, cell)| (row, column, cell))
    });
    let of = |(row, column, cell): (usize, usize, &Cell)| {
        let at = Place { sheet, row, column };
        let formula = cell.formula.clone()?;
        cell.gives.map(|gives| Stale { at, formula, gives })
    };
    cells.filter_map(of).collect()
}

/// Whether u_c stands as a number where U and the computed cells of the rows are formulas.
fn typed(grid: &Grid, sheet: usize, claimed: &Claimed) -> bool {
    let is_formula = |figure: &Option<Printed>| {
        let at = figure.as_ref().map(|figure| figure.at);
        at.filter(|at| at.sheet == sheet)
            .map(|at| grid.cell(at.row, at.column).formula.is_some())
    };
    let rows = &claimed.rows;
    let computed = rows.iter().filter(|row| !row.formulas.is_empty()).count();
    2 * computed > rows.len()
        && is_formula(&claimed.footer.u_c) == Some(false)
        && is_formula(&claimed.footer.expanded) == Some(true)
}

/// An input of the model that no row has and no line gives a value to, where everything else of the model has its row.
fn missing_input(claimed: &Claimed, all: &[&Line]) -> Option<Row> {
    const FUNCTIONS: [&str; 12] = [
        "sin", "cos", "tan", "exp", "ln", "log", "lg", "sqrt", "abs", "pi", "arctan", "atan",
    ];
    let model = claimed.model.as_deref()?;
    let named = |row: &Row| words::has_symbol(model, &row.symbol);
    if claimed.rows.len() < 2 || !claimed.rows.iter().all(named) {
        return None;
    }
    let part = |c: char| c.is_alphanumeric() || c == '_' || c == '\'';
    let is_name = |word: &&str| {
        word.starts_with(char::is_alphabetic)
            && !word.contains(|c: char| ('\u{4e00}'..='\u{9fff}').contains(&c))
            && !FUNCTIONS.contains(word)
    };
    let known = |word: &&str| {
        let of = |rows: &[Row]| rows.iter().any(|row| row.symbol == *word);
        of(&claimed.rows) || of(&claimed.absent) || *word == claimed.measurand
    };
    let mut open: Vec<&str> = model.split(|c: char| !part(c)).filter(is_name).collect();
    open.retain(|word| !known(word));
    open.sort_unstable();
    open.dedup();
    let [symbol] = open.as_slice() else {
        return None;
    };
    let given = |line: &&Line| notes::is_assigned(&line.text, symbol);
    (!all.iter().any(given)).then(|| Row {
        symbol: (*symbol).into(),
        is_absent: true,
        ..Row::default()
    })
}

/// Lines beside a table: each to the whole, or to the row that it is about.
fn place_lines(all: &[&Line], claimed: &mut Claimed) {
    let mut of_row = vec![String::new(); claimed.rows.len()];
    let texts: Vec<&str> = all.iter().map(|line| line.text.as_str()).collect();
    claimed.words = texts.join("\n");
    let title = claimed.title.clone();
    for line in all.iter().filter(|line| line.text != title) {
        place_line(line, claimed, &mut of_row);
    }
    for (row, words) in claimed.rows.iter_mut().zip(&of_row) {
        row.words.push_str(words);
    }
    claimed.reported_mean_of = all
        .iter()
        .find_map(|line| notes::mean_of(&line.text, claimed));
    if claimed.unit.is_empty() {
        claimed.unit = unit_of_result(claimed);
    }
}

fn unit_of_result(claimed: &Claimed) -> String {
    let footer = &claimed.footer;
    let contributions = claimed.rows.iter().map(|row| &row.contribution);
    let figures = [&footer.u_c].into_iter().chain(contributions);
    let unit_of = |figure: &Printed| Some(figure.unit.clone()).filter(|unit| !unit.is_empty());
    let mut stated = figures.chain([&footer.y]).flatten();
    let unit = stated
        .find_map(unit_of)
        .or_else(|| unit_of_plain_rows(claimed));
    unit.or_else(|| unit_of(footer.expanded.as_ref()?))
        .unwrap_or_default()
}

/// The unit of rows whose contribution is printed with the figure of u, by a coefficient of 1: U may be in another one.
fn unit_of_plain_rows(claimed: &Claimed) -> Option<String> {
    let plain = |row: &Row| {
        let c = row.c.as_ref()?;
        let worked = row.used.as_ref().zip(row.divisor.as_ref());
        let worked = worked.map(|(used, divisor)| (used.value / divisor.value, &used.unit));
        let (u, unit) = row.u.as_ref().map(|u| (u.value, &u.unit)).or(worked)?;
        let made = row.contribution.as_ref()?.value.abs();
        let same = c.value.abs() == 1.0 && c.unit.is_empty() && (made - u).abs() <= 0.01 * u;
        let known = [unit, &row.unit].into_iter().find(|unit| !unit.is_empty());
        let unit = known.cloned().or_else(|| unit_in_words(row));
        unit.filter(|_| same)
    };
    let units: Vec<String> = claimed.rows.iter().filter_map(plain).collect();
    let first = units.first()?;
    // A single row is enough to tell a unit from a multiple of it.
    let expanded = claimed.footer.expanded.as_ref();
    let is_multiple = expanded.is_some_and(|u| crate::units::factor(&u.unit, first).is_some());
    let enough = units.len() >= 2 || is_multiple;
    (enough && units.iter().all(|unit| unit == first)).then(|| first.clone())
}

/// The unit in which the words of a row state the figure of its ± column, or twice that: `resolution 0.01 mm` beside 0.005.
fn unit_in_words(row: &Row) -> Option<String> {
    let used = row.used.as_ref()?.value;
    let is_it = |figure: &Printed| {
        let ratio = figure.value / used;
        [1.0, 2.0].iter().any(|times| (ratio - times).abs() < 1e-9)
    };
    let mut figures = words::figures_with_units(&row.words);
    figures.find(is_it).map(|figure| figure.unit)
}

fn find_model(all: &[&Line], claimed: &mut Claimed, mapping: &Mapping) {
    if let Some(model) = &mapping.model {
        let (left, right) = model.split_once('=').unwrap_or(("y", model));
        claimed.measurand = left.trim().into();
        claimed.model = Some(right.trim().into());
        return;
    }
    let found = all.iter().find_map(|line| {
        let parts = line
            .text
            .split(" ; ")
            .find_map(|part| notes::model(part, claimed));
        parts
            .or_else(|| notes::model(&line.text, claimed))
            .map(|model| (line.at, line.text.clone(), model))
    });
    if let Some((at, text, (left, right))) = found {
        claimed.understood.push(Understood {
            at,
            text,
            role: "model",
        });
        claimed.measurand = left;
        claimed.model = Some(right);
    }
}

/// The last row of a table in the form of EA-4/02 is that of the result.
fn drop_measurand(grid: &Grid, raw: &mut Vec<table::Raw>, claimed: &mut Claimed) {
    let named = raw.iter().position(|raw| raw.is_result(&claimed.measurand));
    let closing = || table::closing(raw);
    let Some(place) = named.or_else(closing) else {
        return;
    };
    let result = raw.remove(place).row;
    claimed.rows.remove(place);
    if claimed.measurand.is_empty() {
        claimed.measurand = result.symbol.clone();
    }
    // `U = 59 mg (k = 2)`, `59 mg (k = 2)` in its cells.
    for (column, cell) in grid.filled(result.at.row) {
        let at = Place {
            column,
            ..result.at
        };
        let conditioned = footer::with_factor(&cell.text)
            .map(|figure| footer::set(&mut claimed.footer, footer::Whole::Expanded, figure.at(at)));
        if conditioned == Some(true) || cell.text.contains('=') {
            let measurand = claimed.measurand.clone();
            footer::sentence(&cell.text, &measurand, at, &mut claimed.footer);
        }
    }
    for (whole, figure) in table::figures_of_result(result, raw) {
        let is_known = claimed
            .footer
            .expanded
            .as_ref()
            .is_some_and(|known| known.at == figure.at);
        if !is_known {
            claimed.understood.push(Understood {
                at: figure.at,
                text: figure.text.clone(),
                role: whole.name(),
            });
            footer::set(&mut claimed.footer, whole, figure);
        }
    }
}

/// Rows without a symbol take that word of their name which the model uses.
fn symbols_of_model(raw: &mut [table::Raw], claimed: &mut Claimed) {
    for (raw, row) in raw.iter_mut().zip(&mut claimed.rows) {
        if !row.symbol.is_empty() {
            continue;
        }
        let model = claimed.model.clone().unwrap_or_default();
        let in_model = notes::names_of(row).find(|word| words::has_symbol(&model, word));
        let bracketed = || {
            row.name
                .rsplit_once('(')
                .and_then(|(_, tail)| tail.strip_suffix(')'))
                .filter(|s| s.chars().count() <= 12 && words::may_be_symbol(s))
        };
        let first = || {
            row.name
                .split_once([':', ','])
                .map(|(first, _)| first.trim())
                .filter(|s| s.chars().count() <= 8 && words::may_be_symbol(s))
        };
        let symbol = in_model
            .or_else(bracketed)
            .or_else(first)
            .map(str::to_string);
        let short = || {
            (row.name.chars().count() <= 10 && !row.name.contains(' ')).then(|| row.name.clone())
        };
        row.symbol = symbol.or_else(short).unwrap_or_default();
        raw.row.symbol = row.symbol.clone();
    }
}

/// Finds what a line is about: a row, the whole, or nothing that is known.
fn place_line(line: &Line, claimed: &mut Claimed, of_row: &mut [String]) {
    let lower = line.text.to_lowercase();
    if claimed
        .understood
        .iter()
        .any(|u| u.at == line.at && u.role == "model")
    {
        return;
    }
    let whole = notes::note(&line.text, line.at, claimed);
    if let Some(role) = whole {
        claimed.understood.push(Understood {
            at: line.at,
            text: line.text.clone(),
            role,
        });
        let labelled = matches!(
            footer::label(&line.text, ""),
            Some(footer::Whole::Expanded | footer::Whole::Combined)
        );
        let statement = labelled || footer::states_figures(&lower);
        if role == "correlation" || role == "CMC" || role == "rule for k" && !statement {
            return;
        }
    }
    if let Some(row) = notes::absent(&line.text, line.at, claimed) {
        claimed.understood.push(Understood {
            at: line.at,
            text: line.text.clone(),
            role: "known, but not in the table",
        });
        claimed.absent.push(row);
        return;
    }
    let about = row_of_line(&line.text, &lower, claimed);
    let statement = about.is_none() || footer::label(&line.text, &claimed.measurand).is_some();
    if statement && !words::has(&lower, &["certificate", "证书"]) {
        let found = footer::sentence(
            &line.text,
            &claimed.measurand.clone(),
            line.at,
            &mut claimed.footer,
        );
        let role = found.first().map(|whole| whole.name());
        if let Some(role) = role {
            claimed.understood.push(Understood {
                at: line.at,
                text: line.text.clone(),
                role,
            });
            return;
        }
    }
    if let Some(row) = about {
        of_row[row].push_str("; ");
        of_row[row].push_str(&line.text);
        claimed.understood.push(Understood {
            at: line.at,
            text: line.text.clone(),
            role: "note to a row",
        });
    } else if whole.is_none() {
        claimed.unplaced.push(crate::claim::Unplaced {
            at: line.at,
            text: line.text.clone(),
        });
    }
}

/// The row whose remark refers to the footnote that a line is: `[2] …`, `2) …`, `Note 2: …`, `注2：…`.
fn footnote(text: &str, claimed: &Claimed) -> Option<usize> {
    let lower = text.trim().to_lowercase();
    let inner = ["note", "注", "[", "("]
        .iter()
        .fold(lower.as_str(), |rest, lead| {
            rest.strip_prefix(lead).unwrap_or(rest).trim_start()
        });
    let digits = inner.bytes().take_while(u8::is_ascii_digit).count();
    let marked = digits > 0
        && digits <= 2
        && inner[digits..]
            .trim_start()
            .starts_with([']', ')', ':', '.']);
    let number = inner.get(..digits).filter(|_| marked)?;
    let marks = [
        format!("[{number}]"),
        format!("{number})"),
        format!("({number})"),
        format!("note {number}"),
        format!("注{number}"),
    ];
    let refers = |words: &str| {
        let lower = words.to_lowercase();
        let mut parts = lower.split(';').map(str::trim);
        parts.any(|part| {
            marks
                .iter()
                .any(|mark| part == mark || part.ends_with(&format!(" {mark}")))
        })
    };
    let mut rows = claimed
        .rows
        .iter()
        .enumerate()
        .filter(|(_, row)| refers(&row.words));
    match (rows.next(), rows.next()) {
        (Some((row, _)), None) => Some(row),
        _ => None,
    }
}

/// The row that a line is about: the one whose symbol or name comes first in it, or whose number it gives.
fn row_of_line(text: &str, lower: &str, claimed: &Claimed) -> Option<usize> {
    let numbered = words::count_after(lower, &["row", "note to row", "line", "第"])
        .filter(|_| lower.contains("row") || lower.contains('行') || lower.contains('项'));
    if let Some(n) = numbered
        && n >= 1.0
        && n as usize <= claimed.rows.len()
    {
        return Some(n as usize - 1);
    }
    if let Some(row) = footnote(text, claimed) {
        return Some(row);
    }
    let symbol = (0..claimed.rows.len())
        .filter_map(|row| Some((words::symbol_at(text, &claimed.rows[row].symbol, 0)?, row)))
        .min();
    let name = || {
        (0..claimed.rows.len())
            .filter_map(|row| {
                let name = claimed.rows[row].name.to_lowercase();
                (name.chars().count() >= 3)
                    .then(|| lower.find(&name))
                    .flatten()
                    .map(|at| (at, row))
            })
            .min()
    };
    symbol.or_else(name).map(|(_, row)| row)
}
