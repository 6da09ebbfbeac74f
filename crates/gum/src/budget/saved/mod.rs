//! Saved results: what `gumption eval --save` writes and `from = { result = … }` reads.
//!
//! A result is saved in linear form, y + Σ c·E over the elementary components E of its budget, each with the
//! file that states it and its name there ([`Identity`]). Two results that are read
//! back are therefore correlated as they were, and so are a saved result and a budget that uses the same
//! files directly. Numbers read back as the same doubles.

mod schema;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::budget::chain::{Ensemble, Identity, Member, Part};
use crate::budget::{Certificate, Component, Evaluation, Law, Owner};
use gumption_core::distribution::Distribution;
use gumption_core::quantity::{Unit, UnitTable};
use gumption_fault::libraries::of_json;
use gumption_fault::{Said, say};

pub use schema::result_schema;

/// Name and version of the format; the number changes when a field changes its meaning or goes.
pub const RESULT_FORMAT: &str = "gumption-result/1";

/// A file of saved results, as JSON.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Document {
    /// Name and version of this format.
    pub format: String,
    /// Program that wrote it, with its version.
    pub generator: String,
    /// Title of the budget.
    pub title: String,
    /// Files that state components or results.
    pub files: Vec<FileEntry>,
    /// The results, in linear form.
    pub results: Vec<ResultEntry>,
    /// Every component that acts on one of them, once.
    pub components: Vec<ComponentEntry>,
    /// Groups of correlated components.
    pub correlated: Vec<GroupEntry>,
    /// What must be known of the files.
    pub remarks: Vec<RemarkEntry>,
}

/// What tells such a file from others, which are not kept.
#[derive(Deserialize)]
struct Head {
    format: Option<String>,
}

/// A file that states components.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileEntry {
    /// From the folder of this file, with `/` between its parts.
    pub path: String,
    /// Units that the file defines: name and definition.
    pub units: Vec<[String; 2]>,
}

/// One measurand.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ResultEntry {
    /// Index into files: the budget.
    pub file: usize,
    /// Row of its series.
    pub row: Option<String>,
    /// Name of the measurand.
    pub measurand: String,
    /// What it is.
    pub description: Option<String>,
    /// Unit of the estimate.
    pub unit: String,
    /// Estimate y.
    pub estimate: f64,
    /// Combined standard uncertainty, first order; follows from the terms.
    pub standard_uncertainty: f64,
    /// Effective degrees of freedom; follow from the terms.
    #[serde(with = "gumption_core::distribution::extended")]
    pub effective_degrees_of_freedom: f64,
    /// Whether the model is linear in everything that is uncertain.
    pub linear: bool,
    /// Whether Monte Carlo validated the result (JCGM 101 clause 8, at the digits of the statement); nothing where it was not run.
    pub validated: Option<bool>,
    /// How the components enter.
    pub terms: Vec<TermEntry>,
}

/// How a component enters a result.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TermEntry {
    /// Index into components.
    pub component: usize,
    /// Change of the result per unit of the component.
    pub sensitivity: f64,
}

/// An elementary component.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ComponentEntry {
    /// Index into files: the file that states it.
    pub file: usize,
    /// Row of that file's series.
    pub row: Option<String>,
    /// Its name in that file.
    pub name: String,
    /// Its name without that of its input.
    pub label: String,
    /// Name of the shared cause, for a component of a `[source.NAME]`.
    pub source: Option<String>,
    /// Unit of the deviation.
    pub unit: String,
    /// Standard uncertainty as GUM propagates it.
    pub standard_uncertainty: f64,
    /// Degrees of freedom.
    #[serde(with = "gumption_core::distribution::extended")]
    pub degrees_of_freedom: f64,
    /// Distribution of the deviation.
    pub distribution: Distribution,
    /// Type of evaluation.
    pub evaluation: TypeEntry,
    /// How the standard uncertainty was found.
    pub how: String,
    /// The certificate behind it.
    pub certificate: Option<Box<Certificate>>,
    /// Where the number comes from.
    pub reference: Option<String>,
}

/// Type A or Type B.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum TypeEntry {
    /// From a statistical analysis of readings.
    A,
    /// By other means.
    B,
}

/// Correlated components.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GroupEntry {
    /// Indices into components.
    pub members: Vec<usize>,
    /// Correlation matrix.
    pub correlation: Vec<Vec<f64>>,
    /// Joint distribution.
    pub law: LawEntry,
    /// Common degrees of freedom.
    pub degrees_of_freedom: Option<f64>,
}

/// How correlated components are distributed together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "name", rename_all = "kebab-case", deny_unknown_fields)]
pub enum LawEntry {
    /// Multivariate normal.
    Normal,
    /// Multivariate t.
    #[serde(rename = "t")]
    StudentT {
        /// ν of all members.
        dof: f64,
        /// Scale of each member.
        scale: Vec<f64>,
    },
    /// Margins as stated, joined by a Gaussian copula.
    GaussianCopula {
        /// Correlation of the latent normal variables.
        latent: Vec<Vec<f64>>,
    },
}

/// A remark on a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RemarkEntry {
    /// Index into files.
    pub file: usize,
    /// Row of its series.
    pub row: Option<String>,
    /// In English.
    pub en: String,
    /// In Chinese.
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
    pub remarks: Vec<(Part, Said)>,
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
    pub fn read(bytes: &[u8], place: &dyn Fn(&str) -> PathBuf) -> Result<Self, Said> {
        let head = match serde_json::from_slice(bytes) {
            Ok(head) => head,
            Err(error) if error.is_data() => Head { format: None },
            Err(error) => {
                let why = of_json(&error.to_string());
                return Err(say!("it is not well-formed JSON: {}", why));
            }
        };
        match head.format.as_deref() {
            Some(RESULT_FORMAT) => {}
            Some(other) => {
                return Err(say!("it is of the format {other}, not {RESULT_FORMAT}"));
            }
            None => return Err(say!("it does not say that it is {RESULT_FORMAT}")),
        }
        let document: Document =
            serde_json::from_slice(bytes).map_err(|error| of_json(&error.to_string()))?;
        document.resolved(place)
    }
}

impl Document {
    fn resolved(self, place: &dyn Fn(&str) -> PathBuf) -> Result<SavedResults, Said> {
        let mut files = Vec::new();
        for entry in &self.files {
            let mut units = UnitTable::default();
            let pairs = entry.units.iter().map(|[a, b]| (a.as_str(), b.as_str()));
            if let Some((index, _)) = units.define_all(pairs).first() {
                return Err(say!("the unit {} is not usable", entry.units[*index][0]));
            }
            let path: Arc<Path> = place(&entry.path).into();
            files.push((path, units));
        }
        let file = |index: usize| {
            files
                .get(index)
                .ok_or_else(|| say!("an index of a file is too large"))
        };
        let part = |index: usize, row: &Option<String>| -> Result<Part, Said> {
            Ok(Part {
                file: Arc::clone(&file(index)?.0),
                row: row.as_deref().map(Into::into),
            })
        };
        let unit = |index: usize, text: &str| {
            let units = &file(index)?.1;
            let fault = |_| say!("the unit {text} is not known");
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
            remarks.push((part(*file, row)?, Said::pair(en.clone(), zh.clone())));
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
    fn component(&self, unit: Unit) -> Result<Component, Said> {
        let name = &self.name;
        let possible = self.standard_uncertainty > 0.0
            && self.standard_uncertainty.is_finite()
            && self.degrees_of_freedom > 0.0;
        if !possible {
            return Err(say!("the standard uncertainty of {name} is not usable"));
        }
        self.distribution
            .validate()
            .map_err(|fault| say!("the distribution of {name} is not usable: {fault}"))?;
        Ok(Component {
            name: name.as_str().into(),
            label: self.label.as_str().into(),
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
            how: self.how.as_str().into(),
            certificate: self.certificate.clone(),
            reference: self.reference.clone(),
        })
    }
}

impl ResultEntry {
    fn result(&self, unit: Unit, components: usize) -> Result<SavedResult, Said> {
        let name = &self.measurand;
        if !self.estimate.is_finite() {
            return Err(say!("the estimate of {name} is not finite"));
        }
        let usable = |term: &TermEntry| term.component < components && term.sensitivity.is_finite();
        if !self.terms.iter().all(usable) {
            return Err(say!("the terms of {name} are not usable"));
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
    fn ensemble(&self, members: &[Member]) -> Result<Ensemble, Said> {
        let size = self.members.len();
        let unfit = || say!("a group of correlated components is not usable");
        let found: Option<Vec<Member>> = self
            .members
            .iter()
            .map(|index| members.get(*index).cloned())
            .collect();
        let matrix = |rows: &[Vec<f64>]| -> Result<DMatrix<f64>, Said> {
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
            correlation: matrix(&self.correlation)?.into(),
            law,
            dof: self.degrees_of_freedom,
        })
    }
}
