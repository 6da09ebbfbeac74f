//! What other methods in common use would say of a case, with the same candidates.

use super::case::Case;
use super::catalogue::{self, EffectId, Ground};
use super::evidence::Question;
use super::failure::Failure;
use super::frame::Frame;
use super::inquiry::{baseline, question, settings};
use super::{noise, rivals};

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
    let frame = Frame::new(case);
    let (fit, claimed) = noise::settle(&frame)?;
    let ground = Ground::new(&frame, &fit);
    let cells = catalogue::cells(&ground);
    let baseline = baseline(&frame, &fit, &claimed)?;
    let (candidates, atoms, _) = question(&ground, &cells, &claimed, &baseline);
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
        opinion("forward-bic", rivals::forward_bic(&question)),
        opinion("w-test", rivals::w_test(&question)),
    ])
}
