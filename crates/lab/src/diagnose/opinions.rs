//! What other methods in common use would say of a case, with the same candidates.

use super::candidates::{baseline, question, settings};
use super::case::Case;
use super::catalogue::{self, EffectId, FittedModel};
use super::design::Design;
use super::evidence::Question;
use super::failure::Failure;
use super::{noise, other_methods};

/// A name that a method gives.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pick {
    /// Identifier of the catalogue.
    pub id: EffectId,
    /// What it follows.
    pub along: String,
}

/// A method with the names that it gives, in its order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Opinion {
    /// The method.
    pub method: &'static str,
    /// Its names.
    pub picks: Vec<Pick>,
}

/// Forward selection by BIC, and the w-test.
///
/// # Errors
/// When the model cannot be fitted.
pub fn opinions(case: &Case) -> Result<Vec<Opinion>, Failure> {
    let design = Design::new(case);
    let (fit, claimed) = noise::settle(&design)?;
    let fitted = FittedModel::new(&design, &fit);
    let cells = catalogue::cells(&fitted);
    let baseline = baseline(&design, &fit, &claimed)?;
    let (candidates, atoms, _) = question(&fitted, &cells, &claimed, &baseline);
    let question = Question {
        baseline: &baseline,
        candidates: &candidates,
        atoms: &atoms,
        settings: settings(case),
    };
    let opinion = |method, found: Vec<usize>| Opinion {
        method,
        picks: found
            .into_iter()
            .map(|candidate| Pick {
                id: cells[candidate].effect.id,
                along: cells[candidate].place.along.clone(),
            })
            .collect(),
    };
    Ok(vec![
        opinion("forward-bic", other_methods::forward_bic(&question)),
        opinion("w-test", other_methods::w_test(&question)),
    ])
}
