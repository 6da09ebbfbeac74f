//! The recording that a declared model and its claimed noise predict, with the band that covers it.

use gumption_lanes::sampler::normal_block;
use gumption_lanes::{Block as Lanes, Generator, level};
use nalgebra::DVector;

use super::case::{Blocks, Case, Column, Data, Observed};
use super::design::Design;
use super::failure::Failure;
use super::fit::Fit;
use super::noise::Claimed;
use super::{chance, confirm};
use super::{settled, size};
use crate::recording::Heading;
use gumption_core::least_squares::lower_factor;
use gumption_core::quantity::UnitTable;
use gumption_core::special::student_t_two_sided_quantile;

/// Coverage probability of the band.
const COVERAGE: f64 = 0.95;

/// A table of texts: the first line and the rows of a CSV file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sheet {
    /// Texts of the first line.
    pub header: Vec<String>,
    /// Fields of the rows.
    pub rows: Vec<Vec<String>>,
}

impl Sheet {
    /// As CSV text.
    pub fn csv(&self) -> String {
        let quoted = |field: &String| match field.contains([',', '"', '\n']) {
            true => format!("\"{}\"", field.replace('"', "\"\"")),
            false => field.clone(),
        };
        let line = |fields: &Vec<String>| {
            let fields: Vec<String> = fields.iter().map(quoted).collect();
            fields.join(",") + "\n"
        };
        [&self.header]
            .into_iter()
            .chain(&self.rows)
            .map(line)
            .collect()
    }
}

/// The columns of a case, as they are.
pub fn recorded(case: &Case) -> Sheet {
    let heading = |column: &Column| heading(column, &case.units);
    let mut columns: Vec<&Column> = Vec::new();
    for column in &case.columns {
        // One column of the file may have several roles.
        let is_there = columns.iter().any(|c| heading(c) == heading(column));
        if !matches!(column.data, Data::Absent) && !is_there {
            columns.push(column);
        }
    }
    let field = |column: &Column, row: usize| match &column.data {
        Data::Numbers(numbers) => numbers[row].to_string(),
        Data::Labels(labels) => labels.text(row).to_owned(),
        Data::Absent => String::new(),
    };
    let row = |row: usize| columns.iter().map(|column| field(column, row)).collect();
    Sheet {
        header: columns.iter().map(|column| heading(column)).collect(),
        rows: (0..case.rows).map(row).collect(),
    }
}

/// Name and unit of a column as its recording has them, so that the case, and a recording at rest with the
/// same first line, find it again.
pub(super) fn heading(column: &Column, units: &UnitTable) -> String {
    let header = &column.header;
    let has_unit = matches!(Heading::read(header, units).unit, Ok(Some(_)));
    if has_unit || column.labels().is_some() || column.unit.is_one() {
        return header.clone();
    }
    format!("{header} [{}]", column.unit.symbol)
}

/// A simulated recording.
#[derive(Debug)]
pub struct Simulation {
    /// The recording.
    pub sheet: Sheet,
    /// The noise that its outputs have.
    pub noise: Claimed,
}

/// Simulates the outputs of a case: the model at its parameters (fitted to the recording, or where the
/// outputs were not recorded as the case states them) with the noise that is claimed or that the recording
/// shows. Each output is followed by the model and the ends of the band that covers it with 95 %.
///
/// # Errors
/// When the model cannot be fitted, or correlated noise takes too much memory.
pub fn simulate(case: &Case, seed: u64) -> Result<Simulation, Failure> {
    size::draws_fit_into_memory(case)?;
    let mut by_row = case.clone();
    by_row.averaging.blocks = Blocks::Rows;
    by_row.averaging.settle = 0;
    let design = Design::new(&by_row);
    let (fit, claimed) = match case.is_recorded() {
        true => settled::settle_spread_out(&design)?,
        false => settled::stated(&design)?,
    };
    let band = half_widths(&design, &fit, &claimed);
    let errors = drawn(&claimed, case, seed);
    let mut sheet = recorded(case);
    for (response, declared) in case.responses.iter().enumerate() {
        let at = |row: usize| response * case.rows + row;
        let modelled = &fit.linear.values[response];
        let replaced = match declared.observed {
            Observed::Column(column) => {
                let heading = heading(&case.columns[column], &case.units);
                sheet.header.iter().position(|text| *text == heading)
            }
            Observed::Constant(_) => None,
        };
        let place = replaced.unwrap_or_else(|| {
            sheet.header.push(match declared.observed {
                Observed::Column(column) => heading(&case.columns[column], &case.units),
                Observed::Constant(_) => declared.name.clone(),
            });
            for row in &mut sheet.rows {
                row.push(String::new());
            }
            sheet.header.len() - 1
        });
        for (row, fields) in sheet.rows.iter_mut().enumerate() {
            fields[place] = (modelled[row] + errors[at(row)]).to_string();
        }
        for (suffix, side) in [("model", 0.0), ("low", -1.0), ("high", 1.0)] {
            sheet.header.push(format!("{}_{suffix}", declared.name));
            for (row, fields) in sheet.rows.iter_mut().enumerate() {
                fields.push((modelled[row] + side * band[at(row)]).to_string());
            }
        }
    }
    Ok(Simulation {
        sheet,
        noise: claimed,
    })
}

/// Errors of all observations, correlated as the noise is.
fn drawn(claimed: &Claimed, case: &Case, seed: u64) -> DVector<f64> {
    let streams = 0..case.responses.len() as u64;
    let normals =
        |generator: &mut Generator, block: &mut Lanes| normal_block(level(), generator, block);
    let independent =
        streams.flat_map(|response| chance::numbers(seed, response, case.rows, normals));
    let independent = DVector::from_vec(independent.collect());
    let errors = match &claimed.correlated {
        Some(correlated) => lower_factor(correlated.correlation.matrix()) * independent,
        None => independent,
    };
    errors.component_mul(&claimed.u)
}

/// Half-widths of the band: noise and parameters together.
fn half_widths(design: &Design<'_>, fit: &Fit, claimed: &Claimed) -> Vec<f64> {
    let covariance = confirm::covariance(design, fit, claimed);
    let dof = match claimed.is_estimated() {
        true => confirm::degrees(design),
        false => claimed.dof,
    };
    let factor = student_t_two_sided_quantile(COVERAGE, dof);
    let half_width = |observation: usize| {
        let (slopes, u) = (
            fit.jacobian.row(observation).transpose(),
            claimed.u[observation],
        );
        let of_model = slopes.dot(&(&covariance * &slopes));
        factor * (u * u + of_model.max(0.0)).sqrt()
    };
    (0..design.observations()).map(half_width).collect()
}
