//! Results of other files in a budget, and who a component is wherever it is used.
//!
//! A component belongs to the file that states it. Its [`Identity`], that file and its name there, stays
//! the same whichever way it gets into a budget: directly, through a budget that uses that file, or through
//! a saved result. Components of one identity are one component, and so nothing that results have in common
//! is lost on the way.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use nalgebra::DMatrix;
use smol_str::SmolStr;

use super::{Component, Group, Law};
use gumption_fault::Said;

/// A file, or one row of its series.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Part {
    /// The file, in the one way that [`Files::identity`](super::Files::identity) gives.
    pub file: Arc<Path>,
    /// Label of the row of the file's series, or its number where it has none.
    pub row: Option<Arc<str>>,
}

/// An input or a component, the same wherever it is used.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub struct Identity {
    /// The file that states it.
    pub part: Part,
    /// Its name in that file.
    pub name: SmolStr,
}

/// A group of correlated components with all of its members, of which a budget may need some only.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Ensemble {
    /// The members.
    pub members: Vec<Member>,
    /// As in [`Group`].
    pub correlation: Arc<DMatrix<f64>>,
    /// As in [`Group`].
    pub law: Law,
    /// As in [`Group`].
    pub dof: Option<f64>,
}

/// A member of an [`Ensemble`].
#[derive(Debug, Clone, PartialEq)]
pub struct Member {
    /// Who it is.
    pub identity: Identity,
    /// What it is; the names in it are those of its own file.
    pub component: Component,
}

impl Ensemble {
    /// What is left of the group for the members that `place` knows; nothing where they are fewer than two.
    pub(super) fn reduced(&self, place: impl Fn(&Identity) -> Option<usize>) -> Option<Group> {
        let (rows, members): (Vec<usize>, Vec<usize>) = self
            .members
            .iter()
            .enumerate()
            .filter_map(|(row, member)| Some((row, place(&member.identity)?)))
            .unzip();
        if rows.len() < 2 {
            return None;
        }
        let part = |whole: &DMatrix<f64>| {
            DMatrix::from_fn(rows.len(), rows.len(), |i, j| whole[(rows[i], rows[j])])
        };
        let law = match &self.law {
            Law::Normal => Law::Normal,
            Law::StudentT { dof, scale } => Law::StudentT {
                dof: *dof,
                scale: rows.iter().map(|row| scale[*row]).collect(),
            },
            Law::GaussianCopula { latent } => Law::GaussianCopula {
                latent: part(latent),
            },
        };
        Some(Group {
            members,
            correlation: part(&self.correlation).into(),
            law,
            dof: self.dof,
        })
    }

    /// Whether the two have a member in common.
    pub(super) fn meets(&self, other: &Ensemble) -> bool {
        self.members.iter().any(|member| {
            other
                .members
                .iter()
                .any(|its| its.identity == member.identity)
        })
    }
}

/// A result of another file that an input of this one takes over.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct TakenResult {
    /// The input.
    pub input: String,
    /// The file, as this one names it.
    pub file: String,
    /// Row of its series.
    pub row: Option<String>,
    /// Its measurand.
    pub measurand: String,
    /// What the file says to be about.
    pub title: String,
    /// How the result is computed there; nothing for a saved result, which is taken over in linear form.
    pub equation: Option<String>,
}

/// The part of a budget that comes from other files.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct Chain {
    /// The budget's own file and row.
    pub own: Option<Part>,
    /// Who each input of the budget is.
    pub inputs: Vec<Identity>,
    /// Who each component of the budget is.
    pub components: Vec<Identity>,
    /// All correlated components of all files concerned.
    pub ensembles: Vec<Arc<Ensemble>>,
    /// Inputs that take over a result.
    pub taken: Vec<TakenResult>,
    /// What must be known of each file concerned.
    pub remarks: Vec<(Part, Said)>,
    /// Units that the files define for themselves.
    pub units: BTreeMap<Arc<Path>, Vec<(String, String)>>,
}

impl Chain {
    /// Makes components of a file the same for all rows of its series.
    pub(super) fn share(&mut self, file: &Path, names: &[&str]) {
        let share = |identity: &mut Identity| {
            if &*identity.part.file == file && names.contains(&&*identity.name) {
                identity.part.row = None;
            }
        };
        self.components.iter_mut().for_each(share);
        for ensemble in &mut self.ensembles {
            let members = &mut Arc::make_mut(ensemble).members;
            members
                .iter_mut()
                .map(|member| &mut member.identity)
                .for_each(share);
        }
    }
}

/// Words before the names of inputs and components of other files, different for every file and row:
/// the name of the file, with its row or its folder where several have that name.
pub(super) fn prefixes(parts: &[Part]) -> Vec<String> {
    let level = |part: &Part, level: usize| {
        let stem = part.file.file_stem().unwrap_or_default();
        let stem = stem.to_string_lossy();
        let folder = part.file.parent().and_then(Path::file_name);
        let folder = folder.unwrap_or_default().to_string_lossy();
        let row = part.row.as_deref().unwrap_or_default();
        match (level, part.row.is_some()) {
            (0, _) | (1, false) => stem.into_owned(),
            (1, true) => format!("{stem}[{row}]"),
            (2, false) => format!("{folder}/{stem}"),
            (2, true) => format!("{folder}/{stem}[{row}]"),
            (_, false) => part.file.with_extension("").display().to_string(),
            (_, true) => format!("{}[{row}]", part.file.with_extension("").display()),
        }
    };
    parts
        .iter()
        .map(|part| {
            let alone = |at: &usize| {
                let own = level(part, *at);
                !parts
                    .iter()
                    .any(|other| other != part && level(other, *at) == own)
            };
            level(part, (0..3).find(alone).unwrap_or(3))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prefixes_are_short_and_different() {
        let part = |file: &str, row: Option<&str>| Part {
            file: Path::new(file).into(),
            row: row.map(Into::into),
        };
        let found = prefixes(&[
            part("/lab/mass/weights.toml", Some("1 kg")),
            part("/lab/mass/weights.toml", Some("2 kg")),
            part("/lab/mass/air.toml", None),
            part("/lab/a/voltmeter.toml", None),
            part("/lab/b/voltmeter.toml", None),
            part("/other/b/ohm.toml", None),
            part("/lab/b/ohm.toml", None),
        ]);
        let expected = [
            "weights[1 kg]",
            "weights[2 kg]",
            "air",
            "a/voltmeter",
            "b/voltmeter",
            "/other/b/ohm",
            "/lab/b/ohm",
        ];
        assert_eq!(found, expected);
    }
}
