//! `distribution = …`: a shape for another way, or a distribution with all of its parameters.

use serde_json::{Value, json};
use toml::Spanned;
use toml::de::{DeString, DeValue};

use crate::distribution::{Kind, kind_named};
use crate::fault::Fault;
use gumption_format::toml::Dof;
use gumption_format::toml::faults::{UNKNOWN_KEY, UNKNOWN_WORD, WRONG_TYPE};
use gumption_format::toml::{FromToml, KeyRow, Raw, Reader, Stated, table, words};

words! {
    /// A shape whose width another way states.
    Shape {
        /// Rectangular.
        Uniform "uniform" | "rectangular",
        /// Normal.
        Normal "normal" | "gaussian",
        /// Symmetric triangle.
        Triangular "triangular",
        /// U-shaped.
        Arcsine "arcsine" | "u-shaped",
        /// Isosceles trapezoid (`beta`).
        Trapezoidal "trapezoidal" | "trapezoid",
        /// Rectangle with doubtful limits (`d`).
        CurvilinearTrapezoid "curvilinear-trapezoid",
        /// Scaled and shifted t (`dof`).
        StudentT "t",
    }
}

table! {
    /// Normal distribution.
    NormalTable "normal" {
        /// Expectation; the value when left out.
        mean: f64,
        /// Standard deviation.
        sd: f64,
    }
}

table! {
    /// Scaled and shifted t distribution.
    StudentTable "t" {
        /// Location; the value when left out.
        location: f64,
        /// Scale.
        scale: f64,
        /// Degrees of freedom.
        dof: Dof,
    }
}

table! {
    /// Distribution between two limits.
    LimitsTable "this distribution" {
        /// Lower limit.
        lower: f64,
        /// Upper limit.
        upper: f64,
        /// Half-width about the value, in place of the limits.
        half_width: f64,
        /// Most likely value (triangular only).
        mode: f64,
        /// Ratio of the top to the base (trapezoidal only).
        beta: f64,
        /// Doubt about the limits (curvilinear trapezoid only).
        d: f64,
    }
}

table! {
    /// Exponential distribution.
    ExponentialTable "exponential" {
        /// Lower end (default 0).
        origin: f64,
        /// Mean above the origin.
        mean: f64,
    }
}

table! {
    /// Gamma distribution.
    GammaTable "gamma" {
        /// Lower end (default 0).
        origin: f64,
        /// Shape.
        shape: f64,
        /// Scale.
        scale: f64,
    }
}

table! {
    /// Log-normal distribution.
    LogNormalTable "lognormal" {
        /// Lower end (default 0).
        origin: f64,
        /// Expectation of the logarithm.
        mu: f64,
        /// Standard deviation of the logarithm.
        sigma: f64,
    }
}

table! {
    /// Beta distribution.
    BetaTable "beta" {
        /// First shape.
        alpha: f64,
        /// Second shape.
        beta: f64,
        /// Lower limit (default 0).
        lower: f64,
        /// Upper limit (default 1).
        upper: f64,
    }
}

table! {
    /// Finitely many values.
    DiscreteTable "discrete" {
        /// The values.
        values: Vec<Stated<f64>>,
        /// Their probabilities; equal when left out.
        probabilities: Vec<Stated<f64>>,
    }
}

table! {
    /// A distribution by name, with its parameters in the unit of the input.
    DistributionTable "distribution" {
        /// Normal: mean, sd.
        normal: NormalTable,
        /// t: location, scale, dof.
        t: StudentTable,
        /// Rectangular: lower and upper, or half_width.
        uniform: LimitsTable,
        /// Triangular: lower, mode and upper, or half_width.
        triangular: LimitsTable,
        /// Trapezoidal: limits or half_width, beta.
        trapezoidal: LimitsTable,
        /// Curvilinear trapezoid: limits or half_width, d.
        curvilinear_trapezoid as "curvilinear-trapezoid": LimitsTable,
        /// Arc sine (U-shaped): limits or half_width.
        arcsine: LimitsTable,
        /// Exponential: origin, mean.
        exponential: ExponentialTable,
        /// Gamma: origin, shape, scale.
        gamma: GammaTable,
        /// Log-normal: origin, mu, sigma.
        lognormal: LogNormalTable,
        /// Beta: alpha, beta, lower, upper.
        beta: BetaTable,
        /// Discrete: values, probabilities.
        discrete: DiscreteTable,
    }
}

/// What `distribution` is set to.
#[derive(Debug, Clone)]
pub enum DistributionEntry {
    /// A shape.
    Shape(Shape),
    /// A distribution with parameters.
    Full(Box<DistributionTable>),
}

/// A shape by any of its names, in any case.
fn shape(text: &str, value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Shape> {
    let Some(kind) = kind_meant(text) else {
        return Shape::read(value, reader);
    };
    Shape::named(kind.key).or_else(|| {
        reader.refuse(
            Fault::new(
                UNKNOWN_WORD,
                value.span(),
                format!("the {} distribution needs its parameters", kind.name_en),
            )
            .label("a name alone does not fix it")
            .help(format!(
                "state it with its parameters, without `u` or `half_width`; `gumption explain {}` shows them",
                kind.key
            )),
        )
    })
}

/// The kind of distribution of a name, whatever its case, hyphens and spaces.
fn kind_meant(text: &str) -> Option<&'static Kind> {
    kind_named(&text.to_lowercase().replace([' ', '_'], "-"))
}

/// The fault of a table with parameters under another name than the file format's.
fn other_name(key: &Spanned<DeString<'_>>) -> Option<Fault> {
    let name = key.get_ref();
    let kind = kind_meant(name).filter(|kind| kind.key != name.as_ref())?;
    Some(
        Fault::new(
            UNKNOWN_KEY,
            key.span(),
            format!("a distribution with parameters has no key `{name}`"),
        )
        .label("unknown key")
        .help(format!("write `{}`", kind.key)),
    )
}

impl FromToml for DistributionEntry {
    fn expected() -> String {
        "the name of a shape, or { NAME = { parameters } }".into()
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        match value.get_ref() {
            DeValue::String(text) => shape(text, value, reader).map(DistributionEntry::Shape),
            DeValue::Table(table) => {
                let other_names = table.keys().find_map(other_name);
                match other_names {
                    Some(fault) => reader.refuse(fault),
                    None => DistributionTable::read(value, reader)
                        .map(|table| DistributionEntry::Full(Box::new(table))),
                }
            }
            _ => reader.wrong_type(WRONG_TYPE, value, &Self::expected()),
        }
    }

    fn schema() -> Value {
        json!({ "oneOf": [Shape::schema(), DistributionTable::schema()] })
    }

    fn tables(path: &str, rows: &mut Vec<KeyRow>) {
        DistributionTable::tables(path, rows);
    }
}
