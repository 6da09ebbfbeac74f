//! Least-squares fits: formula, parameters, how well the curve describes the data.

use gumption_core::quantity::Decimal;
use gumption_fault::{Between, Said, say};
use gumption_gum::budget::{Fit, FitColumn, FitDoubt, FitVerdict, LackOfFit, LackOfFitTest};

use super::figures::with_unit;
use super::language::{Language, Word};
use super::number::{TABLE_DIGITS, aligned, at_place, exact, freedom, in_unit, print, significant};
use super::statement::coefficient;
use super::{Report, joint, symbol};
use gumption_format::document::Block;
use gumption_format::document::{Cell, Column, ColumnKind, Table};

/// Points up to which the data stand in the report, beside the curve.
const MOST_POINTS: usize = 25;

/// Parameters up to which their correlation coefficients stand in the report.
const MOST_CORRELATED: usize = 12;

/// One section for each fit.
pub(super) fn blocks(report: &Report<'_>) -> Vec<Block> {
    let fits = report.budget.fits.iter();
    fits.flat_map(|fit| section(report.language, fit)).collect()
}

fn section(l: Language, fit: &Fit) -> Vec<Block> {
    let head = say!("Least-squares fit {}", fit.name).in_language(l);
    let mut blocks = vec![Block::Section(match &fit.description {
        Some(description) => l.with_head(&head, description),
        None => head,
    })];
    blocks.push(Block::Formula(
        fit.equation.lines().map(str::to_string).collect(),
    ));
    blocks.push(Block::Paragraph(data(l, fit)));
    blocks.push(Block::Table(parameters(l, fit).without_empty_columns()));
    let names: Vec<&str> = fit.parameters.iter().map(|p| p.name.as_str()).collect();
    if (3..=MOST_CORRELATED).contains(&names.len()) {
        let of = l.pick("parameters of the fit", "拟合参数");
        let matrix = joint::matrix(l, &names, &fit.correlation, of);
        blocks.push(Block::Table(matrix));
    }
    blocks.push(Block::Fields(quality(l, fit)));
    blocks.extend(verdict(l, fit).map(Block::Paragraph));
    if fit.points() <= MOST_POINTS {
        blocks.push(Block::Table(points(l, fit).without_empty_columns()));
    }
    blocks.extend(farthest(l, fit).map(Block::Paragraph));
    blocks
}

/// How many points, and what is known of their errors.
fn data(l: Language, fit: &Fit) -> String {
    let n = fit.points();
    let own: Vec<String> = fit
        .columns
        .iter()
        .filter(|column| column.u.is_some())
        .map(|column| column.name.clone())
        .collect();
    let common: Vec<String> = fit
        .columns
        .iter()
        .flat_map(|column| column.common.iter().cloned())
        .collect();
    let y = &fit.response().name;
    let names = l.list(&own);
    let mut text = match (l, fit.weighted, fit.stated) {
        (Language::English, false, _) => format!(
            "{n} points; the predictors are taken as exact, and the residuals tell the scatter of {y}."
        ),
        (Language::English, true, true) => {
            format!("{n} points, weighted by the uncertainties of {names} as stated.")
        }
        (Language::English, true, false) => format!(
            "{n} points, weighted by the uncertainties of {names}, which are known up to a common factor that the residuals tell."
        ),
        (Language::Chinese, false, _) => {
            format!("{n} 个数据点；自变量视为精确，{y} 的分散性由残差得出。")
        }
        (Language::Chinese, true, true) => {
            format!("{n} 个数据点，按给出的 {names} 的不确定度加权。")
        }
        (Language::Chinese, true, false) => {
            format!("{n} 个数据点，按 {names} 的不确定度加权，其公共因子由残差得出。")
        }
    };
    if !common.is_empty() {
        let names = l.list(&common);
        text.push_str(
            &say!(
                " {names} act{} on all points together.",
                if common.len() == 1 { "s" } else { "" }
            )
            .in_language(l),
        );
    }
    if !fit.linear {
        let steps = fit.iterations;
        text.push_str(
            &say!(" The formula is not linear in its parameters; the search took {steps} steps.")
                .in_language(l),
        );
    }
    text
}

/// Estimates and standard uncertainties.
fn parameters(l: Language, fit: &Fit) -> Table {
    let column = |head: String, kind| Column { head, kind };
    let caused = fit.parameters.iter().any(|p| p.combined_u > p.u);
    let columns = vec![
        column(l.pick("parameter", "参数").into(), ColumnKind::Names),
        column(Word::Estimate.of(l).into(), ColumnKind::Numbers),
        column(Word::Unit.of(l).into(), ColumnKind::Words),
        column(l.pick("u (fit)", "u（拟合）").into(), ColumnKind::Numbers),
        column(
            l.pick("u (with common causes)", "u（含共同因素）").into(),
            ColumnKind::Numbers,
        ),
    ];
    let mut table = Table {
        columns,
        rows: Vec::new(),
    };
    for parameter in &fit.parameters {
        table.push(vec![
            parameter.name.clone().into(),
            aligned(parameter.estimate, parameter.u, TABLE_DIGITS).into(),
            symbol(&parameter.unit).into(),
            significant(parameter.u, TABLE_DIGITS).into(),
            if caused {
                significant(parameter.combined_u, TABLE_DIGITS).into()
            } else {
                Cell::Empty
            },
        ]);
    }
    table
}

/// How closely the curve follows the data; the correlation coefficient of two parameters.
fn quality(l: Language, fit: &Fit) -> Vec<(String, String)> {
    let mut fields = Vec::new();
    if let [first, second] = fit.parameters.as_slice() {
        fields.push((
            l.pick("correlation coefficient", "相关系数").to_string(),
            format!(
                "r({}, {}) = {}",
                first.name,
                second.name,
                coefficient(fit.correlation[(0, 1)])
            ),
        ));
    }
    let freedom_of = format!(
        "ν = n − p = {} − {} = {}",
        fit.points(),
        fit.parameters.len(),
        fit.dof
    );
    if fit.weighted {
        let per = fit.chi_squared_per_dof().map_or(String::new(), |ratio| {
            format!(", χ²/ν = {}", significant(ratio, TABLE_DIGITS))
        });
        fields.push((
            l.pick("weighted sum of squares", "加权平方和").to_string(),
            format!(
                "χ² = {}, {freedom_of}{per}",
                significant(fit.chi_squared, 4)
            ),
        ));
    } else if let Some(s) = fit.residual_sd {
        let unit = symbol(&fit.response().unit);
        let gap = if unit.is_empty() { "" } else { " " };
        fields.push((
            l.pick("residual standard deviation", "残差标准差")
                .to_string(),
            format!(
                "s = {}{gap}{unit}, {freedom_of}",
                significant(s, TABLE_DIGITS)
            ),
        ));
    }
    if fit.r_squared.is_finite() {
        // Enough digits to tell it from one.
        let rest = 1.0 - fit.r_squared;
        let text = if rest > 0.0 {
            aligned(fit.r_squared, rest, 2)
        } else {
            exact(fit.r_squared)
        };
        fields.push((
            l.pick("coefficient of determination", "决定系数")
                .to_string(),
            format!("R² = {text}"),
        ));
    }
    fields
}

/// p of a test, for the eye.
fn shown(p: f64) -> String {
    if p < 0.001 {
        "< 0.001".to_string()
    } else {
        format!("= {}", at_place(p, -3).print_plain())
    }
}

/// The test and its outcome, in words.
fn verdict(l: Language, fit: &Fit) -> Option<String> {
    let test = fit.lack_of_fit.as_ref()?;
    let (figures, p) = (test_figures(test), shown(test.p));
    let said = match test.verdict() {
        FitVerdict::Accepted => say!("The curve describes the data: {figures}, p {p}."),
        FitVerdict::Rejected => say!("The curve does not describe the data: {figures}, p {p}."),
        FitVerdict::TooSmall => say!(
            "The residuals are smaller than the stated uncertainties let expect: {figures}, 1 − p {}.",
            shown(1.0 - test.p)
        ),
    };
    Some(said.in_language(l))
}

/// `χ² = 2.74 for ν = 4`, `F = 0.8 for ν = 3 and 7 (…)`.
pub(super) fn test_figures(test: &LackOfFit) -> Said {
    let statistic = significant(test.statistic, TABLE_DIGITS);
    let dof = freedom(test.dof);
    match test.test {
        LackOfFitTest::ChiSquared => say!("χ² = {statistic} for ν = {dof}"),
        LackOfFitTest::Replicates => {
            let below = freedom(test.denominator.unwrap_or_default());
            say!(
                "F = {statistic} for ν = {dof} and {below}, against the scatter of repeated points"
            )
        }
    }
}

/// What speaks against a fit, with its number.
pub(super) fn doubtful_fit(fit: &str, doubt: &FitDoubt) -> Said {
    match doubt {
        FitDoubt::Pattern { runs, points, p } => {
            let p = probability_of(*p);
            say!(
                "The residuals of the fit {fit} follow a pattern: along the predictor their signs make only {runs} runs in {points} points, which comes about by chance with a probability of {p}. The curve is not the one that the points follow, or their errors are not independent; the uncertainties of its parameters are then too small. Try another formula; a drift or a common cause stands in the data as a component with common = true."
            )
        }
        FitDoubt::Pole {
            argument,
            predictor,
            between: [low, high],
            unit,
        } => {
            let high = with_unit(&exact(*high), &symbol(unit));
            let low = exact(*low);
            say!(
                "The curve of the fit {fit} breaks off between two points: `{argument}` reaches the end of its range, or nearly so, between {predictor} = {low} and {high}. There the curve says nothing of the quantity, however well it meets the points. Begin at other start values, or take a formula with fewer parameters or without that divisor."
            )
        }
        FitDoubt::BetterMinimum {
            parameters,
            residuals,
        } => {
            let values = parameters
                .iter()
                .map(|(name, value)| format!("{name} = {}", significant(*value, 4)));
            let values = Said::row(Between::And, values);
            let percent = significant(100.0 * residuals, 2);
            say!(
                "The search of the fit {fit} ended in a minimum that is not the best: from other start values it ends at {values}, where the residuals are {percent} % as large. Write these values as `start`, and see which of the two curves is the one that is meant."
            )
        }
    }
}

/// A small probability in percent.
fn probability_of(p: f64) -> String {
    if p < 1e-6 {
        "< 0.0001 %".to_string()
    } else {
        format!("{} %", significant(100.0 * p, 2))
    }
}

/// The points with their distances from the curve.
fn points(l: Language, fit: &Fit) -> Table {
    let y = fit.response();
    let predictors = &fit.columns[1..];
    // Where predictors are in doubt, a point lies beside the curve in both directions: the nearest point of
    // the curve is shown, and the distance from it as a whole.
    let adjusted: Vec<usize> = (0..predictors.len())
        .filter(|k| predictors[*k].u.is_some())
        .collect();
    let mut table = Table {
        columns: heads(l, fit, &adjusted),
        rows: Vec::new(),
    };
    // All to the digits that the smallest uncertainty has, or the spread of the residuals.
    let smallest = |c: &FitColumn| {
        let known = c.u.iter().flatten().copied().filter(|u| *u > 0.0);
        known.min_by(f64::total_cmp)
    };
    let rms = match fit.residual_sd {
        // In the unit of the response; the sum of squares of 10¹⁶⁰ is infinite.
        Some(s) if !fit.weighted => s * (fit.dof as f64 / fit.points().max(1) as f64).sqrt(),
        _ => (fit.rss() / fit.points().max(1) as f64).sqrt(),
    };
    let of_y = shown_to(&y.values, smallest(y).unwrap_or(rms));
    let of_x: Vec<i32> = adjusted
        .iter()
        .map(|k| {
            let column = &predictors[*k];
            shown_to(&column.values, smallest(column).unwrap_or_default())
        })
        .collect();
    let plain = |x: f64, place: i32| {
        // Beyond the digits of a double, zeros would only fill up.
        let rounded = at_place(x, place);
        Cell::from(match place.abs() <= 15 {
            true => rounded.print_plain(),
            false => print(&rounded),
        })
    };
    for i in 0..fit.points() {
        let mut cells: Vec<Cell> = predictors
            .iter()
            .chain([y])
            .map(|c| exact(c.values[i]).into())
            .collect();
        for (k, place) in adjusted.iter().zip(&of_x) {
            cells.push(plain(fit.adjusted[(i, *k)], *place));
        }
        cells.push(plain(fit.fitted[i], of_y));
        if adjusted.is_empty() {
            cells.push(plain(fit.residuals[i], of_y));
        }
        cells.push(match &fit.normalised {
            Some(normalised) => plain(normalised[i], -1),
            None => Cell::Empty,
        });
        table.push(cells);
    }
    table
}

/// The heads of the points, where these predictors are in doubt.
fn heads(l: Language, fit: &Fit, adjusted: &[usize]) -> Vec<Column> {
    let y = fit.response();
    let predictors = &fit.columns[1..];
    let mut heads: Vec<String> = predictors
        .iter()
        .chain([y])
        .map(|c| in_unit(&c.name, &symbol(&c.unit)))
        .collect();
    let on_the_curve = |name: &str| say!("{name} on the curve").in_language(l);
    heads.extend(adjusted.iter().map(|k| on_the_curve(&predictors[*k].name)));
    if adjusted.is_empty() {
        heads.push(l.pick("on the curve", "曲线值").into());
        heads.push(l.pick("residual", "残差").into());
    } else {
        heads.push(on_the_curve(&y.name));
    }
    heads.push(if fit.weighted {
        l.pick("distance / u", "距离 / u").into()
    } else {
        l.pick("residual / s", "残差 / s").into()
    });
    let numbers = |head| Column {
        head,
        kind: ColumnKind::Numbers,
    };
    heads.into_iter().map(numbers).collect()
}

/// The last place to which values are shown beside deviations of this size: two digits of these, but never
/// digits that are rounding errors of the values.
fn shown_to(values: &[f64], deviation: f64) -> i32 {
    /// Digits of a double that can be relied on.
    const SURE: i32 = 13;
    let leading = |x: f64| Decimal::from_f64(x).leading_place();
    let largest = values.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let finest = leading(largest).map_or(0, |place| place - SURE);
    match leading(deviation).map(|place| place - 1) {
        Some(place) if place >= finest => place,
        // On the curve to the last digit: as the values are written.
        _ => values
            .iter()
            .filter_map(|x| Decimal::from_f64(*x).place())
            .fold(0, i32::min),
    }
}

/// The point that is farthest from the curve.
fn farthest(l: Language, fit: &Fit) -> Option<String> {
    let (point, distance) = fit.farthest()?;
    let place: Vec<String> = fit.columns[1..]
        .iter()
        .map(|c| {
            let unit = symbol(&c.unit);
            let gap = if unit.is_empty() { "" } else { " " };
            format!("{} = {}{gap}{unit}", c.name, exact(c.values[point]))
        })
        .collect();
    let place = match place.is_empty() {
        true => String::new(),
        false => l.with_aside("", &place.join(", ")),
    };
    let number = point + 1;
    let distance = significant(distance.abs(), 2);
    let what = if fit.weighted {
        l.pick("standard uncertainties", "倍标准不确定度")
    } else {
        l.pick("residual standard deviations", "倍残差标准差")
    };
    Some(
        say!("Point {number}{place} lies farthest from the curve: {distance} {what}.")
            .in_language(l),
    )
}
