//! Numbers as these files write them.

use gumption_fault::say;

use super::trouble::{Piece, Trouble};

/// A finite number.
pub(super) fn number(piece: Piece<'_>) -> Result<f64, Trouble> {
    let text = piece.text;
    let parsed = text.parse::<f64>().ok().filter(|x| x.is_finite());
    parsed.ok_or_else(|| piece.trouble(say!("a number was expected here, not `{text}`")))
}

/// A number greater than zero.
pub(super) fn positive(piece: Piece<'_>) -> Result<f64, Trouble> {
    let x = number(piece)?;
    if x > 0.0 {
        Ok(x)
    } else {
        let text = piece.text;
        Err(piece.trouble(say!(
            "a number greater than zero was expected here, not `{text}`"
        )))
    }
}

/// A whole number.
pub(super) fn whole(piece: Piece<'_>) -> Result<u64, Trouble> {
    let text = piece.text;
    let parsed = text.parse::<u64>().ok();
    parsed.ok_or_else(|| piece.trouble(say!("a whole number was expected here, not `{text}`")))
}

/// Degrees of freedom: a positive number, or `None` for infinitely many in any spelling.
pub(super) fn freedom(piece: Piece<'_>) -> Result<Option<f64>, Trouble> {
    let lower = piece.text.to_lowercase();
    if matches!(
        lower.trim_start_matches(['.', '+']),
        "" | "inf" | "infinity" | "∞" | "null" | "~"
    ) {
        return Ok(None);
    }
    // Programs without a word for infinity write a number that is as good.
    const ENDLESS: f64 = 1e9;
    positive(piece).map(|dof| Some(dof).filter(|dof| *dof < ENDLESS))
}
