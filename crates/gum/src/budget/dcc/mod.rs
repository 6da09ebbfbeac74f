//! Digital calibration certificates (DCC 2.x and 3.x, with quantities of the D-SI 1.x and 2.x) as sources of inputs:
//! value, U, k, p, ν, unit, number, laboratory, date and the end of its use come from the file.

mod certificate;
mod choice;
mod fill;
mod quantity;
#[cfg(test)]
mod tests;
mod validity;
mod xml;

pub(super) use fill::fill;
