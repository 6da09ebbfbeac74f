//! Curves fitted to data.

use gumption_fault::{Said, say};

use super::component::ComponentTable;
use super::list::List;
use crate::budget::variants::Numbers;
use gumption_format::toml::faults::WRONG_TYPE;
use gumption_format::toml::{
    Amount, FromToml, KeyRow, Matrix, Named, Raw, Reader, Stated, table, words,
};
use serde_json::{Value, json};
use toml::de::DeValue;

table! {
    /// A curve fitted to data by least squares; its parameters are inputs under their own names.
    FitTable "[fit]" {
        /// What is fitted.
        description: String,
        /// The formula: the response column on the left, other columns, parameters and constants on the right.
        model: String,
        /// In place of `model`: degree of a polynomial.
        polynomial: u64,
        /// With `polynomial`: the column on the left.
        response: String,
        /// With `polynomial`: the column of which it is a polynomial.
        predictor: String,
        /// With `polynomial`: false for a curve through the origin.
        intercept: bool,
        /// The observed data: one column for each quantity of the formula.
        data: Named<FitColumnTable>,
        /// The parameters with unit and start value, or a list of their names; without it every name of the formula that is no column and no constant.
        parameters: FitParameters,
        /// Whether the uncertainties of the data are used as stated, or known only up to a factor that follows from the residuals.
        scale: ScaleWord,
        /// Correlation coefficients of the errors of predictor and response, one for each point.
        correlation: List<f64>,
        /// Where the data come from.
        reference: String,
    }
}

table! {
    /// A column of data: its values, and why they are in doubt. Without doubt it is exact; where no column has any, the residuals tell the scatter of the response.
    FitColumnTable "[fit.NAME.data]" {
        /// The observed values, as a list or from a CSV file.
        values: Numbers,
        /// Their unit; dimension one when left out.
        unit: String,
        /// What it is.
        description: String,
        /// Covariance matrix of the values in the square of their unit, row by row.
        covariance: Matrix,
        /// Weights of the values, 1/u², as a list or from a CSV file.
        weights: Numbers,
        /// Several reasons to doubt the values; those with `common = true` and shared causes act on all points together.
        components: List<ComponentTable>,
        with component: ComponentTable
    }
}

table! {
    /// A parameter of a fit.
    FitParameterTable "[fit.NAME.parameters]" {
        /// Its unit; where it is left out, the one that follows from the formula if that is linear in the parameters.
        unit: String,
        /// Where the search begins; needed for formulas that are not linear in the parameters.
        start: Amount,
        /// What it is.
        description: String,
    }
}

words! {
    /// What the stated uncertainties of the data of a fit are worth.
    ScaleWord {
        /// Used as they are.
        Stated "stated",
        /// Known up to a common factor, which the residuals tell.
        Residuals "residuals",
    }
}

/// Parameters of a fit: tables with unit and start value, or a list of names.
#[derive(Debug, Clone)]
pub struct FitParameters(pub Named<FitParameterTable>);

impl FromToml for FitParameters {
    fn expected() -> Said {
        say!("tables of parameters, or a list of their names")
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        match value.get_ref() {
            DeValue::Table(_) => Named::read(value, reader).map(FitParameters),
            DeValue::Array(_) => {
                let names: Vec<Stated<String>> = Vec::read(value, reader)?;
                let entries = names.into_iter().map(|name| {
                    let table = name.map(|_| FitParameterTable::default());
                    (name.value.into(), table)
                });
                Some(FitParameters(Named {
                    entries: entries.collect(),
                    refused: false,
                }))
            }
            _ => reader.wrong_type(WRONG_TYPE, value, Self::expected()),
        }
    }

    fn schema() -> Value {
        json!({ "oneOf": [Named::<FitParameterTable>::schema(), Vec::<Stated<String>>::schema()] })
    }

    fn tables(path: &str, rows: &mut Vec<KeyRow>) {
        Named::<FitParameterTable>::tables(path, rows);
    }
}
