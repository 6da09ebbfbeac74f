//! Saved results: what `gumption eval --save` writes and `from = { result = … }` reads.
//!
//! A result is saved in linear form, y + Σ c·E over the elementary components E of its budget, each with the
//! file that states it and its name there ([`Identity`](crate::budget::chain::Identity)). Two results that are read
//! back are therefore correlated as they were, and so are a saved result and a budget that uses the same
//! files directly. Numbers read back as the same doubles.

mod schema;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::budget::chain::{Ensemble, Identity, Member, Part};
use crate::budget::{Certificate, Component, Evaluation, Law, Owner, Remark};
use crate::distribution::Distribution;
use crate::quantity::{Unit, UnitTable};

pub use schema::result_schema;

/// Name and version of the format; the number changes when a field changes its meaning or goes.
pub const RESULT_FORMAT: &str = "gumption-result/1";

/// A file of saved results, as JSON.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Document {
    pub format: String,
    pub generator: String,
    pub title: String,
    pub files: Vec<FileEntry>,
    pub results: Vec<ResultEntry>,
    pub components: Vec<ComponentEntry>,
    pub correlated: Vec<GroupEntry>,
    pub remarks: Vec<RemarkEntry>,
}

/// A file that states components.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileEntry {
    pub path: String,
    pub units: Vec<[String; 2]>,
}

/// One measurand.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ResultEntry {
    pub file: usize,
    pub row: Option<String>,
    pub measurand: String,
    pub description: Option<String>,
    pub unit: String,
    pub estimate: f64,
    pub standard_uncertainty: f64,
    #[serde(with = "crate::distribution::extended")]
    pub effective_degrees_of_freedom: f64,
    pub linear: bool,
    pub validated: Option<bool>,
    pub terms: Vec<TermEntry>,
}

/// How a component enters a result.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TermEntry {
    pub component: usize,
    pub sensitivity: f64,
}

/// An elementary component.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ComponentEntry {
    pub file: usize,
    pub row: Option<String>,
    pub name: String,
    pub label: String,
    /// Name of the shared cause, for a component of a `[source.NAME]`.
    pub source: Option<String>,
    pub unit: String,
    pub standard_uncertainty: f64,
    #[serde(with = "crate::distribution::extended")]
    pub degrees_of_freedom: f64,
    pub distribution: Distribution,
    pub evaluation: TypeEntry,
    pub how: String,
    pub certificate: Option<Certificate>,
    pub reference: Option<String>,
}

/// Type A or Type B.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum TypeEntry {
    A,
    B,
}

/// Correlated components.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GroupEntry {
    pub members: Vec<usize>,
    pub correlation: Vec<Vec<f64>>,
    pub law: LawEntry,
    pub degrees_of_freedom: Option<f64>,
}

/// How correlated components are distributed together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "name", rename_all = "kebab-case", deny_unknown_fields)]
pub enum LawEntry {
    Normal,
    #[serde(rename = "t")]
    StudentT {
        dof: f64,
        scale: Vec<f64>,
    },
    GaussianCopula {
        latent: Vec<Vec<f64>>,
    },
}

/// A remark on a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RemarkEntry {
    pub file: usize,
    pub row: Option<String>,
    pub en: String,
    pub zh: String,
}

/// Units that a file defines: names and definitions.
pub(super) type Definitions = Vec<(String, String)>;

/// Saved results with everything resolved.
#[derive(Debug)]
pub(super) struct SavedResults {
    pub title: String,
    pub results: Vec<SavedResult>,
    pub members: Vec<Member>,
    pub ensembles: Vec<Arc<Ensemble>>,
    pub remarks: Vec<(Part, Remark)>,
    pub units: Vec<(Arc<Path>, Definitions)>,
}

/// One saved result.
#[derive(Debug)]
pub(super) struct SavedResult {
    pub measurand: String,
    pub row: Option<String>,
    pub unit: Unit,
    pub estimate: f64,
    /// Its model was linear in everything uncertain, or Monte Carlo validated first order.
    pub trusted: bool,
    /// Monte Carlo was asked.
    pub judged: bool,
    /// Index of a member, and the coefficient.
    pub terms: Vec<(usize, f64)>,
}

impl SavedResults {
    /// Reads a file; `place` gives the identity of a file from its path as written.
    ///
    /// # Errors
    /// What is wrong with the file, in words.
    pub fn read(bytes: &[u8], place: &dyn Fn(&str) -> PathBuf) -> Result<Self, String> {
        let value: Value = serde_json::from_slice(bytes)
            .map_err(|error| format!("it is not well-formed JSON: {error}"))?;
        let format = value.get("format").and_then(Value::as_str);
        match format {
            Some(RESULT_FORMAT) => {}
            Some(other) => {
                return Err(format!("it is of the format {other}, not {RESULT_FORMAT}"));
            }
            None => return Err(format!("it does not say that it is {RESULT_FORMAT}")),
        }
        let document: Document =
            serde_json::from_value(value).map_err(|error| error.to_string())?;
        document.resolved(place)
    }
}

impl Document {
    fn resolved(self, place: &dyn Fn(&str) -> PathBuf) -> Result<SavedResults, String> {
        let mut files = Vec::new();
        for entry in &self.files {
            let mut units = UnitTable::default();
            let pairs = entry.units.iter().map(|[a, b]| (a.as_str(), b.as_str()));
            if let Some((index, _)) = units.define_all(pairs).first() {
                return Err(format!("the unit {} is not usable", entry.units[*index][0]));
            }
            let path: Arc<Path> = place(&entry.path).into();
            files.push((path, units));
        }
        let file = |index: usize| files.get(index).ok_or("an index of a file is too large");
        let part = |index: usize, row: &Option<String>| -> Result<Part, String> {
            Ok(Part {
                file: Arc::clone(&file(index)?.0),
                row: row.as_deref().map(Into::into),
            })
        };
        let unit = |index: usize, text: &str| {
            let units = &file(index)?.1;
            let fault = |_| format!("the unit {text} is not known");
            units.parse(text).map_err(fault)
        };
        let mut members = Vec::new();
        for entry in &self.components {
            let identity = Identity {
                part: part(entry.file, &entry.row)?,
                name: entry.name.as_str().into(),
            };
            let component = entry.component(unit(entry.file, &entry.unit)?)?;
            members.push(Member {
                identity,
                component,
            });
        }
        let mut results = Vec::new();
        for entry in &self.results {
            let unit = unit(entry.file, &entry.unit)?;
            results.push(entry.result(unit, members.len())?);
        }
        let mut ensembles = Vec::new();
        for entry in &self.correlated {
            ensembles.push(Arc::new(entry.ensemble(&members)?));
        }
        let mut remarks = Vec::new();
        for RemarkEntry { file, row, en, zh } in &self.remarks {
            let (en, zh) = (en.clone(), zh.clone());
            remarks.push((part(*file, row)?, Remark { en, zh }));
        }
        let own = |entry: &FileEntry| {
            let pairs = entry.units.iter().cloned();
            pairs.map(|[name, is]| (name, is)).collect()
        };
        let units = files.iter().zip(&self.files);
        let units = units.map(|((path, _), entry)| (Arc::clone(path), own(entry)));
        Ok(SavedResults {
            title: self.title.clone(),
            results,
            members,
            ensembles,
            remarks,
            units: units.collect(),
        })
    }
}

impl ComponentEntry {
    fn component(&self, unit: Unit) -> Result<Component, String> {
        let name = &self.name;
        let possible = self.standard_uncertainty > 0.0
            && self.standard_uncertainty.is_finite()
            && self.degrees_of_freedom > 0.0;
        if !possible {
            return Err(format!("the standard uncertainty of {name} is not usable"));
        }
        self.distribution
            .validate()
            .map_err(|fault| format!("the distribution of {name} is not usable: {fault}"))?;
        Ok(Component {
            name: name.clone(),
            label: self.label.clone(),
            // Which input it acts on is seen when it is used.
            owner: Owner::Source(self.source.clone().unwrap_or_default()),
            unit,
            distribution: self.distribution.clone(),
            u: self.standard_uncertainty,
            dof: self.degrees_of_freedom,
            evaluation: match self.evaluation {
                TypeEntry::A => Evaluation::TypeA,
                TypeEntry::B => Evaluation::TypeB,
            },
            how: self.how.clone(),
            certificate: self.certificate.clone(),
            reference: self.reference.clone(),
        })
    }
}

impl ResultEntry {
    fn result(&self, unit: Unit, components: usize) -> Result<SavedResult, String> {
        let name = &self.measurand;
        if !self.estimate.is_finite() {
            return Err(format!("the estimate of {name} is not finite"));
        }
        let usable = |term: &TermEntry| term.component < components && term.sensitivity.is_finite();
        if !self.terms.iter().all(usable) {
            return Err(format!("the terms of {name} are not usable"));
        }
        Ok(SavedResult {
            measurand: name.clone(),
            row: self.row.clone(),
            unit,
            estimate: self.estimate,
            trusted: self.linear || self.validated == Some(true),
            judged: self.validated.is_some(),
            terms: self
                .terms
                .iter()
                .map(|term| (term.component, term.sensitivity))
                .collect(),
        })
    }
}

impl GroupEntry {
    fn ensemble(&self, members: &[Member]) -> Result<Ensemble, String> {
        let size = self.members.len();
        let unfit = || "a group of correlated components is not usable".to_string();
        let found: Option<Vec<Member>> = self
            .members
            .iter()
            .map(|index| members.get(*index).cloned())
            .collect();
        let matrix = |rows: &[Vec<f64>]| -> Result<DMatrix<f64>, String> {
            let square = rows.len() == size && rows.iter().all(|row| row.len() == size);
            let possible = square
                && (0..size).all(|i| (0..i).all(|j| rows[i][j] == rows[j][i]))
                && rows.iter().flatten().all(|r| r.abs() <= 1.0 + 1e-9);
            if !possible {
                return Err(unfit());
            }
            Ok(DMatrix::from_fn(size, size, |i, j| rows[i][j]))
        };
        let law = match &self.law {
            LawEntry::Normal => Law::Normal,
            LawEntry::StudentT { dof, scale } if scale.len() == size && *dof > 0.0 => {
                Law::StudentT {
                    dof: *dof,
                    scale: scale.clone(),
                }
            }
            LawEntry::StudentT { .. } => return Err(unfit()),
            LawEntry::GaussianCopula { latent } => Law::GaussianCopula {
                latent: matrix(latent)?,
            },
        };
        Ok(Ensemble {
            members: found.ok_or_else(unfit)?,
            correlation: matrix(&self.correlation)?,
            law,
            dof: self.degrees_of_freedom,
        })
    }
}
