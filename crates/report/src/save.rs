//! Results for other budgets: in linear form, with the identity of every component.

use std::collections::HashMap;
use std::path::{Component as Step, Path};
use std::sync::Arc;

use super::Report;
use super::language::Language;
use gumption_gum::budget::chain::{Identity, Part};
use gumption_gum::budget::saved::{
    ComponentEntry, Document, FileEntry, GroupEntry, LawEntry, RemarkEntry, ResultEntry, TermEntry,
    TypeEntry,
};
use gumption_gum::budget::{Component, Evaluation as Kind, Law, Owner, RESULT_FORMAT};
use gumption_gum::propagate::{Clause8, MeasurandResult};
use nalgebra::DMatrix;

/// The results of the rows of one file, as the text of a file in `folder` that `from = { result = … }`
/// reads.
///
/// # Errors
/// See [`Unsaved`].
pub fn saved(rows: &[Report<'_>], folder: &Path) -> Result<String, Unsaved> {
    let mut writer = Writer {
        document: Document {
            format: RESULT_FORMAT.to_string(),
            generator: format!("gumption {}", env!("CARGO_PKG_VERSION")),
            title: rows
                .first()
                .map(|row| row.budget.heading.title.clone())
                .unwrap_or_default(),
            files: Vec::new(),
            results: Vec::new(),
            components: Vec::new(),
            correlated: Vec::new(),
            remarks: Vec::new(),
        },
        folder,
        files: HashMap::new(),
        components: HashMap::new(),
    };
    for row in rows {
        writer.row(row)?;
    }
    let text = serde_json::to_string_pretty(&writer.document);
    text.map(|text| text + "\n").map_err(Unsaved::Form)
}

/// Why results cannot be saved for other budgets.
#[derive(Debug)]
pub enum Unsaved {
    /// The budget was not read from a file: it has no components that others could know.
    NoFile,
    /// The estimate or a sensitivity coefficient of this measurand is not finite: it has no linear form.
    NotLinear(String),
    /// The results cannot be written as JSON.
    Form(serde_json::Error),
}

impl std::fmt::Display for Unsaved {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Unsaved::NoFile => f.write_str("the budget has no file"),
            Unsaved::NotLinear(name) => write!(
                f,
                "{name} has no linear form: a sensitivity coefficient is not finite"
            ),
            Unsaved::Form(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for Unsaved {}

struct Writer<'f> {
    document: Document,
    folder: &'f Path,
    files: HashMap<Arc<Path>, usize>,
    components: HashMap<Identity, usize>,
}

impl Writer<'_> {
    fn row(&mut self, report: &Report<'_>) -> Result<(), Unsaved> {
        let chain = &report.budget.chain;
        let own = chain.own.as_ref().ok_or(Unsaved::NoFile)?;
        for (index, result) in report.evaluation.results.iter().enumerate() {
            self.result(report, own, index, result)?;
        }
        for ensemble in &chain.ensembles {
            let first = ensemble.members.first().map(|member| &member.identity);
            let known = first.and_then(|identity| self.components.get(identity));
            let written = self.document.correlated.iter();
            if known.is_some_and(|first| written.clone().any(|g| g.members.contains(first))) {
                continue;
            }
            let mut members = Vec::new();
            for member in &ensemble.members {
                members.push(self.component(report, &member.identity, &member.component));
            }
            self.document.correlated.push(GroupEntry {
                members,
                correlation: lists(&ensemble.correlation),
                law: match &ensemble.law {
                    Law::Normal => LawEntry::Normal,
                    Law::StudentT { dof, scale } => LawEntry::StudentT {
                        dof: *dof,
                        scale: scale.clone(),
                    },
                    Law::GaussianCopula { latent } => LawEntry::GaussianCopula {
                        latent: lists(latent),
                    },
                },
                degrees_of_freedom: ensemble.dof,
            });
        }
        for (part, remark) in &chain.remarks {
            let entry = RemarkEntry {
                file: self.file(report, &part.file),
                row: part.row.as_deref().map(str::to_string),
                en: remark.to_string(),
                zh: remark.in_language(Language::Chinese),
            };
            if !self.document.remarks.contains(&entry) {
                self.document.remarks.push(entry);
            }
        }
        Ok(())
    }

    fn result(
        &mut self,
        report: &Report<'_>,
        own: &Part,
        index: usize,
        result: &MeasurandResult,
    ) -> Result<(), Unsaved> {
        let budget = report.budget;
        let (name, unit) = report.measurand(index);
        // Σ c_i a_ij over the inputs on which a component acts.
        let mut sensitivities = vec![0.0; budget.components.len()];
        let mut acts = vec![false; budget.components.len()];
        for (input, line) in budget.inputs.iter().zip(&result.gum.inputs) {
            for term in &input.terms {
                acts[term.component] |= line.sensitivity != 0.0;
                sensitivities[term.component] += line.sensitivity * term.coefficient;
            }
        }
        if !result.gum.estimate.is_finite() || sensitivities.iter().any(|c| !c.is_finite()) {
            return Err(Unsaved::NotLinear(name.to_string()));
        }
        let mut terms = Vec::new();
        for (component, sensitivity) in sensitivities.into_iter().enumerate() {
            if acts[component] {
                let identity = &budget.chain.components[component];
                terms.push(TermEntry {
                    component: self.component(report, identity, &budget.components[component]),
                    sensitivity,
                });
            }
        }
        let used = budget.model.inputs_of(index);
        let curved = budget.model.nonlinear_inputs();
        let mut uncertain = budget.inputs.iter().map(|input| !input.terms.is_empty());
        let linear = !used
            .iter()
            .zip(&curved)
            .any(|(used, curved)| uncertain.next() == Some(true) && *used && *curved);
        let digits = budget.conventions.digits;
        let validated = result
            .validation
            .and_then(|both| both.into_iter().find(|one| one.digits == digits))
            .filter(|one| one.verdict != Clause8::Undecided)
            .map(|one| one.is_validated());
        let entry = ResultEntry {
            file: self.file(report, &own.file),
            row: own.row.as_deref().map(str::to_string),
            measurand: name.to_string(),
            description: budget
                .measurands
                .get(index)
                .and_then(|m| m.description.clone()),
            unit: unit.symbol.clone(),
            estimate: result.gum.estimate,
            standard_uncertainty: result.gum.u,
            effective_degrees_of_freedom: result.gum.freedom.value(),
            linear,
            validated,
            terms,
        };
        self.document.results.push(entry);
        Ok(())
    }

    fn component(
        &mut self,
        report: &Report<'_>,
        identity: &Identity,
        component: &Component,
    ) -> usize {
        if let Some(index) = self.components.get(identity) {
            return *index;
        }
        let entry = ComponentEntry {
            file: self.file(report, &identity.part.file),
            row: identity.part.row.as_deref().map(str::to_string),
            name: identity.name.to_string(),
            label: component.label.to_string(),
            source: match &component.owner {
                Owner::Source(name) => {
                    Some(name.rsplit('.').next().unwrap_or_default().to_string())
                }
                Owner::Input(_) => None,
            },
            unit: component.unit.symbol.clone(),
            standard_uncertainty: component.u,
            degrees_of_freedom: component.dof,
            distribution: component.distribution.clone(),
            evaluation: match component.evaluation {
                Kind::TypeA => TypeEntry::A,
                Kind::TypeB => TypeEntry::B,
            },
            how: component.how.to_string(),
            certificate: component.certificate.clone(),
            reference: component.reference.clone(),
        };
        let index = self.document.components.len();
        self.document.components.push(entry);
        self.components.insert(identity.clone(), index);
        index
    }

    fn file(&mut self, report: &Report<'_>, file: &Arc<Path>) -> usize {
        if let Some(index) = self.files.get(file) {
            return *index;
        }
        let units = report.budget.chain.units.get(file).into_iter().flatten();
        let index = self.document.files.len();
        self.document.files.push(FileEntry {
            path: relative(file, self.folder),
            units: units
                .map(|(name, definition)| [name.clone(), definition.clone()])
                .collect(),
        });
        self.files.insert(Arc::clone(file), index);
        index
    }
}

fn lists(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    let rows = matrix.row_iter();
    rows.map(|row| row.iter().copied().collect()).collect()
}

/// The way from a folder to a file, with `/` between its parts; the file itself where there is none.
fn relative(file: &Path, folder: &Path) -> String {
    let (to, from): (Vec<Step<'_>>, Vec<Step<'_>>) =
        (file.components().collect(), folder.components().collect());
    let common = to.iter().zip(&from).take_while(|(a, b)| a == b).count();
    if common == 0 && file.is_absolute() {
        return file.display().to_string();
    }
    let up = std::iter::repeat_n("..".to_string(), from.len() - common);
    let down = to[common..]
        .iter()
        .map(|step| step.as_os_str().to_string_lossy().into_owned());
    up.chain(down).collect::<Vec<_>>().join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_to_a_file() {
        let way = |file: &str, folder: &str| relative(Path::new(file), Path::new(folder));
        assert_eq!(way("/lab/mass/a.toml", "/lab/mass"), "a.toml");
        assert_eq!(
            way("/lab/mass/a.toml", "/lab/results/2026"),
            "../../mass/a.toml"
        );
        assert_eq!(way("mass/a.toml", "mass"), "a.toml");
    }
}
