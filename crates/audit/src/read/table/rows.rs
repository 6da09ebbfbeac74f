//! The rows of a table with their figures.

use std::ops::Range;

use crate::claim::Row;
use crate::printed::Printed;
use crate::read::words::has;
use crate::sheet::Grid;
use crate::units;

use super::contained::not_counted;
use super::line::Line;
use super::located::Located;
use super::raw::Raw;

/// The rows of a table with their figures.
pub fn rows(grid: &Grid, sheet: usize, located: &Located) -> Vec<Raw> {
    let mut above = String::new();
    let mut last = located.head;
    let mut contained = None;
    let mut rows: Vec<Raw> = located
        .rows
        .iter()
        .map(|&row| {
            let mut raw = Line::new(grid, sheet, row, located).raw(&above);
            if !raw.row.name.is_empty() {
                above.clone_from(&raw.row.name);
            }
            if let Some(heading) = heading(grid, last + 1..row) {
                contained = not_counted(heading);
            }
            raw.row.not_counted.clone_from(&contained);
            last = row;
            raw
        })
        .collect();
    let columns: [fn(&mut Row) -> &mut Option<Printed>; 3] = [
        |row| &mut row.used,
        |row| &mut row.u,
        |row| &mut row.contribution,
    ];
    for column in columns {
        zeros_are_digits(
            rows.iter_mut()
                // The row of the result has digits of its own.
                .filter(|raw| raw.is_input())
                .filter_map(|raw| column(&mut raw.row).as_mut())
                .collect(),
        );
    }
    for column in &columns[1..] {
        let inputs = rows.iter_mut().filter(|raw| raw.is_input());
        let figures = inputs.filter_map(|raw| column(&mut raw.row).as_mut());
        whole_figures_have_decimals(figures.filter(|figure| figure.value != 0.0).collect());
    }
    for Raw { row, .. } in &mut rows {
        let figures = [
            &mut row.value,
            &mut row.used,
            &mut row.u,
            &mut row.c,
            &mut row.contribution,
        ];
        for figure in figures {
            *figure = figure.take().map(units::with_power);
        }
    }
    parts_are_not_counted(&mut rows);
    shared_parts_are_counted_once(&mut rows);
    rows
}

/// Sources that several inputs share, below a heading that says so: what is independent in these inputs counts by itself, and each shared
/// source once, with the coefficient that stands in its row.
fn shared_parts_are_counted_once(rows: &mut [Raw]) {
    let wholes = || (0..rows.len()).filter(|i| rows[*i].is_root);
    let groups: Vec<(usize, Vec<usize>)> = wholes()
        .map(|whole| (whole, parts_of(rows, whole)))
        .collect();
    let is_shared = |row: &usize| {
        let why = rows[*row].row.not_counted.as_ref();
        let says = |why: &String| has(&why.to_lowercase(), &SHARED);
        why.is_some_and(says) && rows[*row].row.contribution.is_some()
    };
    // `m.lin` is what is called `lin` below m[1] and m[2].
    let called = |part: usize, shared: usize| {
        let (own, all) = (rows[part].row.label(), rows[shared].row.label());
        own == all || all.rsplit_once('.').is_some_and(|(_, name)| name == own)
    };
    let of = |shared: usize| -> Vec<usize> {
        let all = groups.iter().flat_map(|(_, parts)| parts.iter().copied());
        all.filter(|part| called(*part, shared)).collect()
    };
    let shared: Vec<(usize, Vec<usize>)> = (0..rows.len())
        .filter(is_shared)
        .map(|shared| (shared, of(shared)))
        .collect();
    // The row of the result stands below the same heading.
    let shared: Vec<(usize, Vec<usize>)> = shared
        .into_iter()
        .filter(|(_, parts)| parts.len() >= 2)
        .collect();
    if shared.is_empty() {
        return;
    }
    for (whole, parts) in groups {
        let (common, own): (Vec<usize>, Vec<usize>) = parts
            .into_iter()
            .partition(|part| shared.iter().any(|(_, parts)| parts.contains(part)));
        if common.is_empty() {
            continue;
        }
        rows[whole].row.not_counted = Some("in the rows of its parts".into());
        // The estimate enters the result once, with the first of them.
        if let Some(first) = own.first() {
            rows[*first].row.value = rows[whole].row.value.clone();
        }
        for part in own {
            rows[part].row.not_counted = None;
        }
    }
    for (row, parts) in shared {
        rows[row].row.not_counted = None;
        let why = format!("in row {}", rows[row].row.label());
        for part in parts {
            rows[part].row.not_counted = Some(why.clone());
        }
    }
}

/// The rows right below one that are not counted because they are in it.
fn parts_of(rows: &[Raw], whole: usize) -> Vec<usize> {
    let why = format!("in row {}", rows[whole].row.label());
    let is_part = |part: &usize| rows[*part].row.not_counted.as_deref() == Some(&why);
    (whole + 1..rows.len()).take_while(is_part).collect()
}

/// Words of a heading above sources that several inputs share.
const SHARED: [&str; 4] = ["shared", "common", "共同", "公共"];

/// The last line between two rows of a table, which is about those below it: `Shared sources (already contained above)`, or a rule.
fn heading(grid: &Grid, between: Range<usize>) -> Option<&str> {
    let lines = between.rev().filter_map(|row| grid.filled(row).next());
    let mut texts = lines.map(|(_, cell)| cell.text.as_str());
    texts.next()
}

/// Rows 1.1 and 1.2, or u_11 and u_12, below a row 1 that is the root of the sum of their squares, or the larger of them,
/// are in it already; so are rows without estimate and coefficient right below one that has them, and is the root.
fn parts_are_not_counted(rows: &mut [Raw]) {
    for whole in 0..rows.len() {
        let numbered = (whole + 1..rows.len()).filter(|part| rows[*part].is_part_of(&rows[whole]));
        let mut parts: Vec<usize> = numbered.collect();
        let by_place =
            parts.is_empty() && rows[whole].row.value.is_some() && rows[whole].row.c.is_some();
        if by_place {
            let is_bare = |part: &usize| {
                let row = &rows[*part].row;
                row.value.is_none() && row.c.is_none()
            };
            parts = (whole + 1..rows.len()).take_while(is_bare).collect();
        }
        let u = |i: usize| rows[i].row.u.as_ref().map(|u| (u.value, u.half));
        let (Some((own, half)), Some(of_parts)) = (
            u(whole),
            parts.iter().map(|i| u(*i)).collect::<Option<Vec<_>>>(),
        ) else {
            continue;
        };
        let root = libm::sqrt(of_parts.iter().map(|(u, _)| u * u).sum());
        let largest = match by_place {
            true => root,
            false => of_parts.iter().map(|(u, _)| *u).fold(0.0, f64::max),
        };
        // By how much the halves of all parts move their root; of one part that is its own.
        let moved: f64 = of_parts.iter().map(|(u, half)| u * half / root).sum();
        let widest = of_parts.iter().map(|(_, half)| *half).fold(0.0, f64::max);
        let open = half + moved.max(widest);
        if parts.len() >= 2 && [root, largest].iter().any(|u| (u - own).abs() <= open) {
            let why = format!("in row {}", rows[whole].row.label());
            let c = rows[whole].row.c.clone().filter(|_| by_place);
            rows[whole].is_root = (root - own).abs() <= open;
            for part in parts {
                let row = &mut rows[part].row;
                row.not_counted = Some(why.clone());
                // Its coefficient is that of the quantity.
                row.c = row.c.take().or_else(|| c.clone());
            }
        }
    }
}

/// Who writes `0.577` and `6.1` in a column does not mean 1.4 by `1`: a cell without a format has lost the zeros behind the
/// point. Figures of one whole digit have as many decimals as the others that have some, if these are more.
fn whole_figures_have_decimals(column: Vec<&mut Printed>) {
    let (whole, others): (Vec<&mut Printed>, Vec<&mut Printed>) = column
        .into_iter()
        .partition(|figure| figure.half == 0.5 && figure.value < 10.0);
    let others = others.iter().filter(|figure| figure.half < 0.5);
    let others: Vec<f64> = others.map(|figure| figure.half).collect();
    let fewest = others.iter().copied().fold(0.0, f64::max);
    if others.len() <= whole.len() || fewest <= 0.0 {
        return;
    }
    for figure in whole {
        let decimals = libm::round(libm::log10(figure.half / fewest)) as usize;
        figure.half = fewest;
        figure.digits += decimals;
    }
}

/// The zeros of `100` are digits as far as the other figures of its column show some.
fn zeros_are_digits(column: Vec<&mut Printed>) {
    let most = column.iter().map(|figure| figure.digits).max().unwrap_or(0);
    for figure in column
        .into_iter()
        .filter(|figure| figure.half == 0.5 && figure.digits > 0)
    {
        let places = libm::floor(libm::log10(figure.value.abs())) as usize + 1;
        figure.digits = figure.digits.max(most.min(places));
    }
}
