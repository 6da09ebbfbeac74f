//! Sheets read by meaning: which cells are a budget, and what they say.
//!
//! | chapter | holds |
//! |---|---|
//! | `amounts` | amounts that a text writes out |
//! | `beside` | tables side by side |
//! | `blanks` | tables whose columns stand one blank apart |
//! | `blocks` | tables that are blocks of one budget |
//! | `by_type` | tables with a column of figures for each type of evaluation |
//! | `columns` | what a column is, by its head |
//! | `conditions` | what labels say beside a name: points, multiples |
//! | `counts` | whole numbers that count something in texts |
//! | `coverage` | what a sheet says of its coverage |
//! | `statement` | results that are stated with their uncertainty |
//! | `table` | where a table stands, and its rows |
//! | `kind` | what is known of a quantity, by the words for it |
//! | `converter` | the step of a converter, from its bits and range |
//! | `family` | families of words that say what is known |
//! | `factor` | numbers that may be coverage factors |
//! | `footer` | claimed figures of the whole |
//! | `formulas` | what the formulas of a workbook give away |
//! | `meant` | what figures are of which the head leaves it open: the sums of the sheet tell |
//! | `lines` | lines beside a table, each to the whole or to a row |
//! | `model` | where the model stands, and what its names say of the rows |
//! | `quotients` | quotients that words write out |
//! | `remarks` | what is remarked about readings, and states nothing |
//! | `notes` | what notes say: model, correlations, rules |
//! | `result_unit` | the unit of a result |
//! | `mapping` | what a user says of a sheet |
//! | `points` | sheets with a budget for each calibration point |
//! | `prose` | budgets without a table |
//! | `series` | readings beside a table |
//! | `simulated` | statements of Monte Carlo |
//! | `turned` | tables whose rows and columns are exchanged |
//! | `unread` | lines that may state U, and are not understood |
//! | `words` | words and figures in texts |
//! | `wrapped` | sentences that go on in the next line |

mod amounts;
mod beside;
mod blanks;
mod blocks;
mod by_type;
mod columns;
mod conditions;
mod converter;
mod counts;
mod coverage;
mod factor;
mod family;
mod footer;
mod formulas;
mod kind;
mod lines;
mod mapping;
mod meant;
mod model;
mod notes;
mod points;
mod prose;
mod quotients;
mod remarks;
mod result_unit;
mod series;
mod simulated;
mod statement;
mod table;
mod turned;
mod unread;
mod words;
mod wrapped;

pub use columns::Role;
pub(crate) use counts::count_before;
pub(crate) use coverage::{
    names_level, probability_of_factor, states_usual_level, unusual_level, usual_levels,
};
pub(crate) use factor::FIXED;
pub(crate) use family::{AVERAGE, RESOLUTION, STEP};
pub(crate) use footer::Whole;
pub(crate) use kind::{is_of_type, shape};
pub use mapping::Mapping;
pub(crate) use points::are_several;
pub(crate) use series::{listed, series};
pub(crate) use simulated::MONTE_CARLO;
pub use unread::expanded as unread_expanded;
pub(crate) use words::{figure_after, figures_with_units, has, has_symbol, lowered, symbol_at};

use std::ops::Range;

use crate::claim::{Claimed, Row, Understood, Unplaced};
use crate::printed::{Place, Printed};
use crate::sheet::Grid;

use lines::{Line, lines, place_lines};
use model::{find_model, missing_input, symbols_of_model};
use table::Located;

/// Every budget of a file.
pub fn budgets(grids: &[Grid], mapping: &Mapping) -> Vec<Claimed> {
    let parts = grids.iter().flat_map(beside::parted);
    let parts = parts.flat_map(|part| points::parted(&part));
    let upright = parts.map(|part| turned::upright(&part));
    let grids: Vec<Grid> = upright.map(|grid| by_type::joined(&grid)).collect();
    let mut found: Vec<Found> = Vec::new();
    for (sheet, grid) in grids.iter().enumerate() {
        let tables = table::locate(grid, mapping).into_iter();
        found.extend(tables.map(|located| Found::new(grid, sheet, located)));
    }
    if found.is_empty() {
        let parted: Vec<Option<Grid>> = grids.iter().map(blanks::parted).collect();
        if parted.iter().any(Option::is_some) {
            let both = parted.into_iter().zip(&grids);
            let grids: Vec<Grid> = both
                .map(|(parted, own)| parted.unwrap_or_else(|| own.clone()))
                .collect();
            return budgets(&grids, mapping);
        }
    }
    let (inputs, evaluated): (Vec<Found>, Vec<Found>) = found.iter().cloned().partition(|one| {
        let mut others = found.iter();
        others.any(|other| one.states_inputs_of(other) || one.is_list_beside(other, &grids))
    });
    let evaluated = blocks::joined(&grids, evaluated);
    let is_alone = evaluated.len() == 1;
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
    let results = evaluated.iter().filter_map(Found::titled);
    let beside = Beside {
        common: &common,
        inputs: &inputs,
        results: results.collect(),
        sheets: (0..grids.len())
            .filter(|sheet| is_alone && without(sheet))
            .map(|sheet| (sheet, &grids[sheet]))
            .collect(),
    };
    let tables = evaluated.iter().enumerate().map(|(i, one)| {
        let grid = &grids[one.sheet];
        let near = |j: Option<usize>| {
            j.and_then(|j| evaluated.get(j))
                .filter(|o| o.sheet == one.sheet)
        };
        let start = near(i.checked_sub(1)).map_or(0, |other| {
            between(grid, other.located.end, one.first_head())
        });
        let end = near(Some(i + 1)).map_or(grid.rows.len(), |other| {
            between(grid, one.located.end, other.first_head())
        });
        let mut claimed = budget(grid, one, start..end, &beside, mapping);
        claimed.relocate(|at| grids.get(at.sheet).map_or(at, |grid| grid.origin(at)));
        claimed
    });
    tables.collect()
}

/// What a file has beside the table of a budget.
struct Beside<'a> {
    /// Lines of sheets without a budget.
    common: &'a [Line],
    /// Tables of what is known of inputs.
    inputs: &'a [Found],
    /// Names of the results of all its budgets.
    results: Vec<&'a str>,
    /// Sheets without a budget, with their numbers, where the file has one budget alone.
    sheets: Vec<(usize, &'a Grid)>,
}

/// A table on a sheet, with its rows.
#[derive(Debug, Clone)]
struct Found {
    sheet: usize,
    located: Located,
    /// Blocks of the same budget above it.
    above: Vec<Located>,
    /// Rows of all blocks.
    raw: Vec<table::Raw>,
}

impl Found {
    fn new(grid: &Grid, sheet: usize, located: Located) -> Found {
        let raw = table::rows(grid, sheet, &located);
        Found {
            sheet,
            located,
            above: Vec::new(),
            raw,
        }
    }

    /// The name of its result, where the last row has it.
    fn titled(&self) -> Option<&str> {
        table::symbol_of_result(&self.raw)
    }

    /// The same with another block of its budget above it.
    fn below(mut self, block: Found) -> Found {
        self.above = block.above;
        self.above.push(block.located);
        self.raw.splice(..0, block.raw);
        self
    }

    /// Row of the head of its first block.
    fn first_head(&self) -> usize {
        self.above.first().unwrap_or(&self.located).head
    }

    /// Rows above its last block that are no text, and subtotals: no figures of the whole.
    fn is_of_block(&self, grid: &Grid, row: usize) -> bool {
        let in_block = self.above.iter().any(|block| block.is_used(row));
        in_block || self.has_blocks(grid) && blocks::is_subtotal(grid, row)
    }

    /// Whether its rows are blocks, each with its table, or in one table with subtotals between them.
    fn has_blocks(&self, grid: &Grid) -> bool {
        let mut inside = (0..grid.rows.len()).filter(|row| self.located.is_inside(*row));
        !self.above.is_empty() || inside.any(|row| blocks::is_subtotal(grid, row))
    }

    /// Whether this table says what is known of the rows that another one evaluates.
    fn states_inputs_of(&self, other: &Found) -> bool {
        if self.located.is_evaluated() || !other.located.is_evaluated() {
            return false;
        }
        let shared = other.raw.iter();
        let shared = shared
            .filter(|raw| self.about(raw, other).is_some())
            .count();
        // What evaluates may have its totals among its rows.
        2 * shared > other.raw.len() || shared >= 2 && 2 * shared > self.raw.len()
    }

    /// The row of this table that is about the quantity of a row of another one: what is called the same, or else the only one that is
    /// called alike, and like no other row.
    fn about(&self, raw: &table::Raw, other: &Found) -> Option<&table::Raw> {
        let is_free = |own: &&table::Raw| !other.raw.iter().any(|raw| own.is_of(raw));
        let mut alike = self
            .raw
            .iter()
            .filter(is_free)
            .filter(|own| own.is_like(raw));
        let same = self.raw.iter().find(|own| own.is_of(raw));
        same.or_else(|| alike.next().filter(|_| alike.next().is_none()))
    }

    /// Whether this is a list of figures with their u, such as the parameters of a fit, and no budget, since the file has
    /// one with contributions: nothing below it claims what they come to.
    fn is_list_beside(&self, other: &Found, grids: &[Grid]) -> bool {
        let grid = &grids[self.sheet];
        let until = match other.sheet == self.sheet && other.first_head() > self.located.head {
            true => other.first_head(),
            false => grid.rows.len(),
        };
        let is_claim = |row: usize| {
            let mut cells = grid.filled(row).map(|(_, cell)| cell.text.as_str());
            cells.any(|text| footer::label(text, "").is_some_and(|whole| whole != footer::Whole::Y))
        };
        self.located.is_list()
            && other.located.has_contributions()
            && !(self.located.head + 1..until).any(is_claim)
    }
}

/// A budget that is told in sentences.
fn prose(all: &[Line], mapping: &Mapping) -> Option<Claimed> {
    let all = &with_conclusions(all)[..];
    let mut rows: Vec<(usize, Row)> = all
        .iter()
        .enumerate()
        .filter_map(|(i, line)| Some((i, prose::row(&line.text, line.at)?)))
        .collect();
    // What stands in front of a list of symbols, and comes to no u, is its title, and notes.
    let has_symbol = |(_, row): &(usize, Row)| !row.symbol.is_empty();
    let is_item = |row: &(usize, Row)| has_symbol(row) || row.1.u.is_some();
    if rows.iter().filter(|row| has_symbol(row)).count() >= 2 {
        let first = rows.iter().position(is_item).unwrap_or(0);
        rows.drain(..first);
    }
    if rows.len() < 2 {
        return None;
    }
    Some(told(all, rows, mapping))
}

/// Lines, those of rows with the line below them that says what u they come to: `u_A = s/√10 = 0.00101 V`.
fn with_conclusions(all: &[Line]) -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    for line in all {
        let is_open = |above: &&mut Line| {
            let row = prose::row(&above.text, above.at);
            row.is_some_and(|row| row.u.is_none()) && above.at.row + 1 == line.at.row
        };
        let concludes = prose::is_conclusion(&line.text);
        match lines.last_mut().filter(|above| concludes && is_open(above)) {
            Some(above) => above.text = format!("{}, {}", above.text, line.text),
            None => lines.push(line.clone()),
        }
    }
    lines
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
    // A contribution that is not understood is no reason to doubt the others.
    let mut unread = claimed.unplaced.iter();
    let whole = !unread.any(|line| prose::states_uncertainty(&line.text));
    (whole && (footer.u_c.is_some() || footer.expanded.is_some())).then_some(claimed)
}

/// The budget of these rows, which some of the lines are.
fn told(all: &[Line], rows: Vec<(usize, Row)>, mapping: &Mapping) -> Claimed {
    let others: Vec<&Line> = (0..all.len())
        .filter(|i| rows.iter().all(|(row, _)| row != i))
        .map(|i| &all[i])
        .collect();
    let first = rows.first().map_or(0, |(row, _)| *row);
    let title = all[..first].first().map(|line| line.text.clone());
    let mut raw: Vec<table::Raw> = rows
        .into_iter()
        .map(|(_, row)| table::Raw::told(row))
        .collect();
    let mut claimed = Claimed {
        rows: raw.iter().map(|raw| raw.row.clone()).collect(),
        title: title.unwrap_or_default(),
        ..Claimed::default()
    };
    find_model(&others, None, &mut claimed, mapping);
    symbols_of_model(&mut raw, &mut claimed);
    place_lines(&others, &[], &mut claimed);
    simulated::set_aside(&mut claimed);
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

fn budget(
    grid: &Grid,
    found: &Found,
    bounds: Range<usize>,
    beside: &Beside<'_>,
    mapping: &Mapping,
) -> Claimed {
    let Beside { common, inputs, .. } = *beside;
    let (sheet, mut located) = (found.sheet, found.located.clone());
    let blocks = found.above.iter().chain([&located]);
    let mut claimed = Claimed {
        understood: blocks
            .flat_map(|block| block.understood(grid, sheet))
            .collect(),
        ..Claimed::default()
    };
    let mut raw = found.raw.clone();
    claimed.unplaced.extend(unread_cells(&raw));
    let stating = inputs.iter().filter(|input| input.states_inputs_of(found));
    for raw in &mut raw {
        if let Some(input) = stating.clone().find_map(|input| input.about(raw, found)) {
            raw.absorb(input);
        }
    }
    let elsewhere = |row: usize| {
        let mut inputs = inputs.iter();
        inputs.any(|input| input.sheet == sheet && input.located.is_used(row))
            || found.is_of_block(grid, row)
    };
    let own = |located: &Located| {
        lines(grid, sheet, bounds.clone(), |row| {
            located.is_used(row) || elsewhere(row)
        })
    };
    let first = own(&located);
    claimed.rows = raw.iter().map(|raw| raw.row.clone()).collect();
    claimed.subtotals = bounds
        .clone()
        .filter(|row| blocks::is_subtotal(grid, *row))
        .map(|row| raw.iter().filter(|raw| raw.row.at.row < row).count())
        .collect();
    claimed.unit = located.unit.clone();
    claimed.title = first
        .iter()
        .find(|line| line.at.row < found.first_head() && !line.text.contains('='))
        .map(|line| line.text.clone())
        .unwrap_or_default();
    if !grid.point.is_empty() {
        let parts = [claimed.title.as_str(), &grid.point];
        let parts = parts.into_iter().filter(|part| !part.is_empty());
        claimed.title = parts.collect::<Vec<_>>().join(": ");
    }
    find_model(
        &first.iter().chain(common).collect::<Vec<_>>(),
        table::symbol_of_result(&raw),
        &mut claimed,
        mapping,
    );
    if claimed.measurand.is_empty() {
        claimed.measurand = titled_result(grid, found, &raw).unwrap_or_default();
    }
    drop_measurand(grid, &mut raw, &mut claimed);
    symbols_of_model(&mut raw, &mut claimed);
    let below = located.head + 1..bounds.end;
    table::of_columns(grid, sheet, &mut claimed);
    table::freedom_of_cells(grid, sheet, &located, &mut claimed);
    table::footers(grid, sheet, &mut located, below, elsewhere, &mut claimed);
    if claimed.model.is_none()
        && let Some(y) = table::result(&raw, &claimed.footer)
    {
        take_as_product(&y, &mut raw, &mut claimed);
    }
    claimed.typed = formulas::typed(grid, sheet, &claimed);
    claimed.computed = formulas::is_formula(grid, sheet, &claimed.footer.u_c) == Some(true);
    claimed.stale = formulas::stale(grid, sheet, bounds.clone());
    let open = formulas::without_value(grid, sheet, bounds.clone());
    claimed.unplaced.extend(open);
    if located.has_bare_u_behind_c() {
        meant::u_by_sum(&mut claimed);
    }
    let own = own(&located);
    let all: Vec<&Line> = own.iter().chain(common).collect();
    place_lines(&all, &beside.results, &mut claimed);
    if claimed.correlations.is_empty() && !is_root_of_parts(&claimed) {
        let above = lines(grid, sheet, 0..bounds.start, elsewhere);
        let below = lines(grid, sheet, bounds.end..grid.rows.len(), elsewhere);
        lines::place_correlations(above.iter().chain(&below), &mut claimed);
    }
    let missing = missing_input(&claimed, &all);
    // Some sheets have their result in front of the table.
    if claimed.footer.u_c.is_none() && claimed.footer.expanded.is_none() {
        let above = bounds.start..located.head;
        table::footers(grid, sheet, &mut located, above, elsewhere, &mut claimed);
        if claimed.unit.is_empty() {
            claimed.unit = result_unit::unit_of_result(&claimed);
        }
    }
    // Some have it in further columns beside the table.
    if claimed.footer.u_c.is_none() && claimed.footer.expanded.is_none() {
        table::footers_beside(&located.beside(grid), sheet, &mut claimed);
    }
    // And some on a sheet of its own.
    if claimed.footer.u_c.is_none() && claimed.footer.expanded.is_none() {
        for (sheet, grid) in &beside.sheets {
            let used = table::footers_beside(grid, *sheet, &mut claimed);
            claimed
                .unplaced
                .retain(|line| line.at.sheet != *sheet || !used.contains(&line.at.row));
        }
    }
    simulated::set_aside(&mut claimed);
    let full = located.is_evaluated();
    let other = located
        .open_uncertainty()
        .map(|head| meant::with_standard(&claimed, head));
    table::interpret(&raw, full, &mut claimed);
    if let Some(mut other) = other {
        table::interpret(&raw, full, &mut other);
        claimed = meant::better(claimed, other);
    }
    let unread = claimed.rows.iter();
    let unread = unread.filter_map(|row| row.unread_used.clone());
    claimed.unplaced.extend(unread);
    claimed.rows.extend(missing);
    claimed
}

/// What stands in the place of units and distributions and is none, each once.
fn unread_cells(raw: &[table::Raw]) -> Vec<Unplaced> {
    let mut unread: Vec<Unplaced> = Vec::new();
    let cells = |raw: &table::Raw| {
        let row = &raw.row;
        let unread = [&row.unread_unit, &row.unread_distribution, &row.unread_c];
        unread.map(Clone::clone)
    };
    for cell in raw.iter().flat_map(cells).flatten() {
        if unread.iter().all(|known| known.text != cell.text) {
            unread.push(cell);
        }
    }
    unread
}

/// Whether u_c, or U by its k, is the root of the sum of squares of what the rows state: then nothing is correlated here.
fn is_root_of_parts(claimed: &Claimed) -> bool {
    let part = |row: &Row| {
        let c = row.c.as_ref().map_or(1.0, |c| c.value);
        let of_u = row.u.as_ref().map(|u| c * u.value);
        row.contribution.as_ref().map(|part| part.value).or(of_u)
    };
    let counted = claimed.rows.iter().filter(|row| row.not_counted.is_none());
    let root = libm::sqrt(counted.filter_map(part).map(|part| part * part).sum());
    let footer = &claimed.footer;
    let k = footer.k.as_ref().map_or(2.0, |k| k.value);
    let is_met = |figure: &Printed, x: f64| figure.is_met_within(x, 2.0 * figure.half);
    let by_u = footer.u_c.as_ref().map(|u_c| is_met(u_c, root));
    let by_expanded = || footer.expanded.as_ref().map(|u| is_met(u, k * root));
    by_u.or_else(by_expanded) == Some(true)
}

/// The symbol of the last row, where the line above the head, from which a blank one may part it, calls the table after it:
/// `Uncertainty budget of R`.
fn titled_result(grid: &Grid, found: &Found, raw: &[table::Raw]) -> Option<String> {
    let symbol = table::symbol_of_result(raw)?;
    let above = (0..found.first_head()).rev().take(2);
    let (_, title) = above.filter_map(|row| grid.filled(row).next()).next()?;
    has_symbol(&title.text, symbol).then(|| symbol.to_owned())
}

/// Rows without coefficients as factors of a result.
fn take_as_product(y: &Printed, raw: &mut [table::Raw], claimed: &mut Claimed) {
    for (raw, row) in raw.iter_mut().zip(&mut claimed.rows) {
        raw.row.c = table::coefficient(y, row);
        row.c.clone_from(&raw.row.c);
    }
}

/// Whether a row right below one is called the result, or u_c.
fn is_closed_below(grid: &Grid, row: usize) -> bool {
    const BELOW: usize = 3;
    let mut cells = (row + 1..=row + BELOW).filter_map(|row| grid.filled(row).next());
    cells.any(|(_, cell)| {
        let label = footer::label(&cell.text, "");
        matches!(label, Some(footer::Whole::Y | footer::Whole::Combined))
    })
}

/// Whether the row right below one states u_c in the column of the contributions, and another figure than that of the row:
/// then it is no row of the result, which has the same.
fn is_summed_below(grid: &Grid, row: &Row) -> bool {
    let Some(own) = &row.contribution else {
        return false;
    };
    let below = row.at.row + 1;
    let label = grid.filled(below).next();
    let label = label.and_then(|(_, cell)| footer::label(&cell.text, ""));
    let sum = grid.cell(below, own.at.column).figure();
    label == Some(footer::Whole::Combined) && sum.is_some_and(|sum| sum.value != own.value)
}

/// The last row of a table in the form of EA-4/02 is that of the result.
fn drop_measurand(grid: &Grid, raw: &mut Vec<table::Raw>, claimed: &mut Claimed) {
    let named = raw.iter().position(|raw| raw.is_result(&claimed.measurand));
    let is_source =
        |place: &usize| table::is_like_source(raw) && is_summed_below(grid, &raw[*place].row);
    let closing = || table::closing(raw).filter(|place| !is_source(place));
    let product = table::product(raw).filter(|_| claimed.model.is_none());
    let product = product.filter(|place| !is_closed_below(grid, raw[*place].row.at.row));
    let Some(place) = named.or_else(closing).or(product) else {
        return;
    };
    let closing = raw.remove(place);
    let absolute = table::absolute(&closing).filter(|_| product == Some(place));
    let mut result = closing.row;
    result.u = result.u.or(absolute);
    claimed.rows.remove(place);
    if product == Some(place)
        && let Some(y) = &result.value
    {
        take_as_product(y, raw, claimed);
    }
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
