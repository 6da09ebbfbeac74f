//! Lines of text beside a table: what each is about, the whole or a row.

use std::ops::Range;

use gumption_core::model::functions;

use crate::claim::{Claimed, Row, Understood, Unplaced};
use crate::printed::{Place, Printed, leading};
use crate::sheet::Grid;
use crate::units;

use super::{counts, footer, notes, prose, result_unit, words, wrapped};

/// A line of text beside a table.
#[derive(Debug, Clone)]
pub(super) struct Line {
    pub(super) text: String,
    pub(super) at: Place,
}

/// Lines of text outside the tables.
pub(super) fn lines(
    grid: &Grid,
    sheet: usize,
    rows: Range<usize>,
    used: impl Fn(usize) -> bool,
) -> Vec<Line> {
    let outside = rows.filter(|row| !used(*row));
    let mut lines: Vec<Line> = Vec::new();
    let mut last: Option<usize> = None;
    for row in outside {
        let cells: Vec<&str> = grid
            .filled(row)
            .map(|(_, cell)| cell.text.as_str())
            .collect();
        let Some((column, _)) = grid.filled(row).next() else {
            continue;
        };
        let is_below = last.is_some_and(|last| last + 1 == row && cells.len() == 1);
        last = Some(row).filter(|_| cells.len() == 1);
        let text = cells.join(" ; ");
        match lines
            .last_mut()
            .filter(|above| is_below && wrapped::goes_on(&above.text, &text))
        {
            Some(above) => above.text = format!("{} {text}", above.text),
            None => lines.push(Line {
                text,
                at: Place { sheet, row, column },
            }),
        }
    }
    lines
}

/// Lines beside a table: each to the whole, or to the row that it is about. `results` are those of all budgets of the file.
pub(super) fn place_lines(all: &[&Line], results: &[&str], claimed: &mut Claimed) {
    let mut of_row = vec![String::new(); claimed.rows.len()];
    // Behind what labels have said of the whole.
    for line in all {
        claimed.words.push_str(&line.text);
        claimed.words.push('\n');
    }
    let title = claimed.title.clone();
    let (first, others): (Vec<&Line>, Vec<&Line>) = all.iter().partition(|line| line.text == title);
    for line in first {
        rule_in_title(line, claimed);
    }
    for line in others {
        let stated = results.iter().find(|name| is_statement(&line.text, name));
        match stated.filter(|name| **name != claimed.measurand) {
            Some(_) => claimed.unplaced.push(Unplaced {
                at: line.at,
                text: line.text.clone(),
            }),
            None => place_line(line, claimed, &mut of_row),
        }
    }
    for (row, words) in claimed.rows.iter_mut().zip(&of_row) {
        row.words.push_str(words);
    }
    claimed.reported_mean_of = all
        .iter()
        .find_map(|line| notes::mean_of(&line.text, claimed));
    if claimed.unit.is_empty() {
        claimed.unit = result_unit::unit_of_result(claimed);
    }
}

/// Takes the rule for rounding that stands in the first line of a sheet, which is its title otherwise.
fn rule_in_title(line: &Line, claimed: &mut Claimed) {
    let before = claimed.rounding;
    notes::rounding(&line.text.to_lowercase(), claimed);
    if claimed.rounding != before {
        claimed.understood.push(Understood {
            at: line.at,
            text: line.text.clone(),
            role: "rule for rounding",
        });
    }
}

/// Takes correlations of these rows from lines beside other tables of the sheet, which several budgets may have in common.
pub(super) fn place_correlations<'l>(all: impl Iterator<Item = &'l Line>, claimed: &mut Claimed) {
    for line in all {
        let found = notes::correlation(&line.text, claimed).filter(|found| !found.is_empty());
        let Some(found) = found else {
            continue;
        };
        claimed.correlate(found);
        claimed.understood.push(Understood {
            at: line.at,
            text: line.text.clone(),
            role: "correlation",
        });
    }
}

/// Whether a line is a row of another table: of one that holds figures against one another, by how much they differ being
/// no limit, or of several numbers that nothing is said of.
fn is_of_other_table(lower: &str) -> bool {
    const COMPARED: [&str; 4] = ["agrees within", "agrees,", "differs by", "内一致"];
    let cells: Vec<&str> = lower.split(" ; ").collect();
    let Some((_, cells)) = cells.split_first().filter(|(_, rest)| rest.len() >= 2) else {
        return false;
    };
    let is_number = |cell: &&str| Printed::parse(cell).is_some_and(|figure| figure.unit.is_empty());
    words::has(lower, &COMPARED) || cells.len() >= 3 && cells.iter().all(is_number)
}

/// Whether the cells of a line name rows each for itself, as the head of another table does: `step ; at the estimates ; l + u ; l - u`.
fn names_several(text: &str, claimed: &Claimed) -> bool {
    let named = |cell: &str| {
        let mut rows = claimed.rows.iter();
        rows.position(|row| words::has_symbol(cell, &row.symbol))
    };
    let cells: Vec<Option<usize>> = text.split(" ; ").map(named).collect();
    let is_head = cells.len() >= 4 && cells[0].is_none();
    let mut rows: Vec<usize> = cells.into_iter().flatten().collect();
    let enough = is_head && rows.len() >= 2;
    rows.dedup();
    enough || rows.len() >= 3
}

/// Finds what a line is about: a row, the whole, or nothing that is known.
fn place_line(line: &Line, claimed: &mut Claimed, of_row: &mut [String]) {
    let lower = line.text.to_lowercase();
    if claimed
        .understood
        .iter()
        .any(|u| u.at == line.at && u.role == "model")
    {
        correlate_behind_model(line, claimed);
        return;
    }
    if is_of_other_table(&lower) {
        claimed.unplaced.push(Unplaced {
            at: line.at,
            text: line.text.clone(),
        });
        return;
    }
    let mut cells = line.text.split(" ; ");
    let is_result = cells.any(|cell| footer::is_capital_result(cell, &claimed.measurand));
    let whole = match is_result {
        true => None,
        false => notes::note(&line.text, line.at, claimed),
    };
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
        if let Some(k) = footer::looked_up(&line.text) {
            footer::set(&mut claimed.footer, footer::Whole::Factor, k.at(line.at));
        }
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
    // A sentence of the statement may say which row dominates.
    let is_of_whole = footer::assigned(&line.text, "u_c").is_some();
    let about = about.filter(|_| {
        let is_statement = is_of_whole || is_statement(&line.text, &claimed.measurand);
        !names_several(&line.text, claimed) && !is_statement
    });
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
            // What is called U and has another figure than k, but none that is understood, is told.
            let is_lost = footer::label(&line.text, "") == Some(footer::Whole::Expanded)
                && claimed.footer.expanded.is_none()
                && footer::has_other_figure(&line.text);
            if is_lost {
                claimed.unplaced.push(Unplaced {
                    at: line.at,
                    text: line.text.clone(),
                });
            }
            return;
        }
    }
    if let Some(row) = about {
        of_row[row].push_str("; ");
        of_row[row].push_str(from_its_sentence(&line.text, &claimed.rows[row]));
        claimed.understood.push(Understood {
            at: line.at,
            text: line.text.clone(),
            role: "note to a row",
        });
    } else if whole.is_none() {
        claimed.unplaced.push(Unplaced {
            at: line.at,
            text: line.text.clone(),
        });
    }
}

/// Takes the correlations that stand in the line of the model, behind it.
fn correlate_behind_model(line: &Line, claimed: &mut Claimed) {
    let Some((_, behind)) = line.text.split_once([';', '。']) else {
        return;
    };
    let found = notes::correlation(behind.trim(), claimed).filter(|found| !found.is_empty());
    if let Some(found) = found {
        claimed.correlate(found);
        claimed.understood.push(Understood {
            at: line.at,
            text: line.text.clone(),
            role: "correlation",
        });
    }
}

/// Whether a line states a result, `a = 1.87 ± 0.91`: it says nothing of an input of this name, of which the result is made or
/// which is made of it in another budget.
fn is_statement(text: &str, result: &str) -> bool {
    let begins = |at: &usize| !text[..*at].contains(char::is_alphanumeric);
    let named = words::symbol_at(text, result, 0).filter(begins);
    let behind = named.map(|at| text[at + result.len()..].trim_start());
    let stated = behind.and_then(|behind| behind.strip_prefix('=')?.split_once('±'));
    stated.is_some_and(|(front, _)| {
        let number = front.trim_start().trim_start_matches('(');
        leading(number).is_some_and(|(_, unit)| !unit.contains(['=', ';']))
    })
}

/// What a text says from the sentence on that names a row: those in front of it are about something else.
fn from_its_sentence<'t>(text: &'t str, row: &Row) -> &'t str {
    let mut sentences = prose::sentences(text);
    let own = sentences.find(|sentence| named_at(sentence, row).is_some());
    let start = own.and_then(|own| text.find(own));
    start.map_or(text, |start| &text[start..])
}

/// Where a text names a row by its symbol. What a function is of is not what is said of its
/// argument: `atan2(x2, x1) has a standard uncertainty of 10 rad`.
fn named_at(text: &str, row: &Row) -> Option<usize> {
    let mut from = 0;
    while let Some(at) = words::symbol_at(text, &row.symbol, from) {
        if !is_argument(&text[..at]) && !is_unit(&text[..at], &row.symbol) {
            return Some(at);
        }
        from = at + row.symbol.len();
    }
    None
}

/// Where a text in small letters has a name that is not the beginning of a term: `standard` is none in `standard uncertainty`.
fn called_at(lower: &str, name: &str) -> Option<usize> {
    const TERMS: [&str; 3] = [
        "standard uncertainty",
        "standard deviation",
        "combined standard",
    ];
    let is_term = |at: usize| {
        let mut terms = TERMS.iter().filter(|term| term.len() > name.len());
        terms.any(|term| {
            let mut places = lower
                .match_indices(term)
                .map(|(start, _)| start..start + term.len());
            places.any(|place| place.contains(&at))
        })
    };
    let mut places = lower.match_indices(name).map(|(at, _)| at);
    places.find(|at| !is_term(*at))
}

/// Whether a name behind a text is a unit: of the number in front of it, `0.3 V`, or of what is told, `standard uncertainty / V`.
fn is_unit(front: &str, name: &str) -> bool {
    let is_behind =
        front.ends_with("/ ") || front.trim_end().ends_with(|c: char| c.is_ascii_digit());
    is_behind && units::parse(name).is_some()
}

/// Whether the brackets of a function are open behind a text.
fn is_argument(front: &str) -> bool {
    let open = front
        .rfind('(')
        .filter(|open| !front[*open..].contains(')'));
    let word = open.map(|open| {
        let before = front[..open].trim_end_matches(|c: char| c.is_ascii_alphanumeric());
        &front[before.len()..open]
    });
    word.is_some_and(|word| functions().iter().any(|function| function.name == word))
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
    let numbered = counts::count_after(lower, &["row", "note to row", "line", "第"])
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
    let rows = || claimed.rows.iter().enumerate();
    let symbol = rows()
        .filter_map(|(i, row)| Some((named_at(text, row)?, i)))
        .min();
    let name = || {
        let named = rows().filter_map(|(i, row)| {
            let name = row.name.to_lowercase();
            let at = called_at(lower, &name).filter(|_| name.chars().count() >= 3)?;
            Some((at, i))
        });
        named.min()
    };
    symbol.or_else(name).map(|(_, row)| row)
}
