//! The equations of a case as texts.

use crate::experiment::tables::ExperimentTable;
use gumption_format::toml::{OneOrMany, Stated};

/// The equations, as a file lists them.
pub(super) type Models = Stated<OneOrMany<String>>;

/// The equations, each behind the statements that all of them see.
pub(super) fn models(file: &ExperimentTable) -> Option<Models> {
    let mut models = *file.equations.clone()?;
    if let Some(shared) = &file.model {
        for model in &mut models.value.0 {
            model.value = format!("{}\n{}", shared.value.trim_end(), model.value);
        }
    }
    Some(models)
}
