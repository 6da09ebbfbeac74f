//! Points side by side: heads such as `1 MHz`, or `± at 10 N` and `u at 10 N`, above columns of the same kind.

use std::collections::BTreeSet;

use crate::printed::Printed;
use crate::read::columns::{Role, apart, is_unit, role};
use crate::read::footer::{self, Whole};
use crate::sheet::{Cell, Grid};

use super::{amount, figures, rows_below, whole_of_row, without};

/// A point with its columns, and what their heads say without it.
struct Point {
    name: String,
    columns: Vec<(usize, String)>,
}

/// The sheet parted by the points in this row of heads, if they stand there.
pub(super) fn parted(grid: &Grid, head: usize) -> Option<Vec<Grid>> {
    let points = points(grid, head, &of_amount, 1).or_else(|| {
        let labelled = points(grid, head, &labelled, 2)?;
        have_own_whole(grid, &rows_below(grid, head), &labelled).then_some(labelled)
    })?;
    let rows = rows_below(grid, head);
    let bare = points.iter().all(|point| is_bare(&point.columns));
    let kind = match bare {
        true => Some(kind(grid, head, &rows, &points)?),
        false => None,
    };
    let all: BTreeSet<usize> = of_points(&points).collect();
    let part = |point: &Point| {
        let own = |column: usize| point.columns.iter().any(|(own, _)| *own == column);
        let mut part = without(grid, |row, column| {
            row >= head && all.contains(&column) && !own(column)
        });
        // `Contribution` above names is their head, and no figure.
        for (column, cell) in grid
            .filled(head)
            .filter(|(column, _)| !all.contains(column))
        {
            if role(&cell.text).is_some_and(|(role, _)| role == Role::Contribution) {
                part.rows[head][column] = Cell::new("Source");
            }
        }
        for (column, rest) in &point.columns {
            let text = match kind {
                Some(kind) => unit_behind(kind, rest),
                None => rest.clone(),
            };
            part.rows[head][*column] = Cell::new(&text);
        }
        part.point.clone_from(&point.name);
        part
    };
    Some(points.iter().map(part).collect())
}

fn of_points(points: &[Point]) -> impl Iterator<Item = usize> + '_ {
    points
        .iter()
        .flat_map(|point| point.columns.iter().map(|(column, _)| *column))
}

/// Everything that an amount, or several of them, says of a point, `10 V (50 Hz)`, and what is left of a head.
fn of_amount(text: &str) -> Option<(String, String)> {
    let (mut name, mut rest) = amount(text)?;
    while let Some((more, left)) = amount(&rest) {
        name = format!("{name}, {more}");
        rest = left;
    }
    let rest = rest.replace("()", "").replace('@', "");
    Some((name, rest.split_whitespace().collect::<Vec<_>>().join(" ")))
}

/// A point that has a name and no amount, `Point 1`, `low`, in a bracket behind what its figures are: `u (low) / mK`.
fn labelled(text: &str) -> Option<(String, String)> {
    let (front, unit) = apart(text);
    let (front, name) = front.strip_suffix(')')?.rsplit_once('(')?;
    let (front, name) = (front.trim(), name.trim());
    let is_figure = role(front).is_some_and(|(role, _)| role.is_figure());
    // What spans several heads is no unit of them, and what stands in front of one is none.
    let spans = name.strip_prefix('@');
    let is_name = !name.is_empty()
        && !name.contains('=')
        && (spans.is_some() || !unit.is_empty() || !is_unit(name));
    let name = spans.unwrap_or(name);
    let rest = match unit.is_empty() {
        true => front.to_owned(),
        false => format!("{front} / {unit}"),
    };
    (is_figure && is_name).then(|| (name.to_owned(), rest))
}

/// Whether a row states u_c or U of each point: what is called alike may be something else, as the two types of evaluation are.
fn have_own_whole(grid: &Grid, rows: &BTreeSet<usize>, points: &[Point]) -> bool {
    let is_stated = |row: usize, point: &Point| {
        let mut columns = point.columns.iter();
        columns.any(|(column, _)| grid.cell(row, *column).figure().is_some())
    };
    let mut whole = rows
        .iter()
        .filter(|row| whole_of_row(grid, **row).is_some());
    whole.any(|row| points.iter().all(|point| is_stated(*row, point)))
}

/// At least two points of the same columns beside a column of sources, each of as many columns as that.
fn points(
    grid: &Grid,
    head: usize,
    parted: &dyn Fn(&str) -> Option<(String, String)>,
    fewest: usize,
) -> Option<Vec<Point>> {
    let mut points: Vec<Point> = Vec::new();
    let mut is_named = false;
    for (column, cell) in grid.filled(head) {
        match parted(&cell.text) {
            Some((name, rest)) => match points.iter_mut().find(|point| point.name == name) {
                Some(point) => point.columns.push((column, rest)),
                None => points.push(Point {
                    name,
                    columns: vec![(column, rest)],
                }),
            },
            None => {
                let role = role(&cell.text).map(|(role, _)| role);
                is_named |= matches!(role, Some(Role::Name | Role::Symbol | Role::Contribution));
            }
        }
    }
    let rests = |point: &Point| -> Vec<String> {
        let rests = point.columns.iter();
        rests.map(|(_, rest)| rest.clone()).collect()
    };
    let first = rests(points.first()?);
    let alike = points.iter().all(|point| rests(point) == first);
    let is_figure = |rest: &String| role(rest).is_some_and(|(role, _)| role.is_figure());
    let known = is_bare(&points[0].columns) || first.iter().all(is_figure);
    let enough = points.len() >= 2 && first.len() >= fewest;
    (enough && is_named && alike && known).then_some(points)
}

/// Whether heads have nothing but the point, or a unit behind it.
fn is_bare(columns: &[(usize, String)]) -> bool {
    // `u (mN)` is no product of units.
    let says_figure = |rest: &str| role(&apart(rest).0).is_some_and(|(role, _)| role.is_figure());
    let is_nothing = |rest: &str| rest.is_empty() || is_unit(unmarked(rest)) && !says_figure(rest);
    columns.len() == 1 && columns.iter().all(|(_, rest)| is_nothing(rest))
}

/// What the figures of bare columns are, told by the figures of the whole: `u` where u_c is the root of the sum of their squares,
/// `±` where it is that of the figures over their divisors.
fn kind(
    grid: &Grid,
    head: usize,
    rows: &BTreeSet<usize>,
    points: &[Point],
) -> Option<&'static str> {
    let of_whole = |row: &usize| {
        let first = grid.filled(*row).next();
        first.is_some_and(|(_, cell)| footer::label(&cell.text, "").is_some())
    };
    let (whole, sources): (BTreeSet<usize>, BTreeSet<usize>) =
        rows.iter().partition(|row| of_whole(row));
    let divisor = grid.filled(head).find_map(|(column, cell)| {
        let (role, _) = role(&cell.text)?;
        (role == Role::Divisor).then_some(column)
    });
    let divisors: Vec<f64> = match divisor {
        Some(column) => {
            let divisors = figures(grid, &sources, column).into_iter();
            divisors
                .map(|figure| figure.map_or(1.0, |f| f.value))
                .collect()
        }
        None => vec![1.0; sources.len()],
    };
    let votes = |divided: bool| {
        let fits = |column: &usize| {
            let u_c = combined(grid, &whole, *column);
            let own = figures(grid, &sources, *column);
            let sum = own.iter().zip(&divisors).map(|(figure, divisor)| {
                let x = figure.as_ref().map_or(0.0, |figure| figure.value);
                let u = if divided { x / divisor } else { x };
                u * u
            });
            let sum = libm::sqrt(sum.sum());
            u_c.is_some_and(|(u_c, half)| (sum - u_c).abs() <= half + 0.02 * u_c)
        };
        of_points(points).filter(fits).count()
    };
    let (plain, divided) = (votes(false), votes(true));
    match (2 * plain > points.len(), 2 * divided > points.len()) {
        (true, _) if plain >= divided => Some("u_i"),
        (_, true) => Some("±"),
        _ => None,
    }
}

/// The u_c of a point as its column has it, also from U and the k in its label, and half a unit of its last digit.
fn combined(grid: &Grid, rows: &BTreeSet<usize>, column: usize) -> Option<(f64, f64)> {
    let found = |wanted: Whole| {
        let row = rows
            .iter()
            .find(|row| whole_of_row(grid, **row) == Some(wanted))?;
        Some((*row, grid.cell(*row, column).figure()?))
    };
    let plain = |(_, figure): (usize, Printed)| (figure.value, figure.half);
    found(Whole::Combined).map(plain).or_else(|| {
        let (row, figure) = found(Whole::Expanded)?;
        let k = grid.filled(row).find_map(|(_, cell)| {
            let (_, behind) = cell.text.split_once("k")?;
            Printed::parse(behind.trim_start_matches([' ', '=']).trim_end_matches(')'))
        });
        let k = k.map_or(2.0, |k| k.value);
        Some((figure.value / k, figure.half / k))
    })
}

/// The unit of `/ Hz`, `(Hz)` and `[Hz]`.
fn unmarked(rest: &str) -> &str {
    let rest = rest.trim_start_matches(['/', ' ']);
    let brackets = [('(', ')'), ('[', ']')];
    let inner = brackets
        .iter()
        .find_map(|(open, close)| rest.strip_prefix(*open)?.strip_suffix(*close));
    inner.unwrap_or(rest)
}

/// `u_i / Hz` of `/ Hz`.
fn unit_behind(kind: &str, rest: &str) -> String {
    let rest = unmarked(rest);
    let (_, unit) = apart(&format!("{kind} / {rest}"));
    match unit.is_empty() {
        true => kind.to_owned(),
        false => format!("{kind} / {unit}"),
    }
}
