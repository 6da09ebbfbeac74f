//! What is turned at a speed feels the square of it, along the arm.

use gumption_core::quantity::UnitTable;
use gumption_format::csv::{Column, Data};

use super::guess::Guess;
use super::roles::determination;
use crate::experiment::entries::RoleWord;

/// Whether outputs that are no angular velocity follow the square of one rather than the velocity itself.
pub(super) fn is_one(outputs: &[&Guess<'_>], speed: &Guess<'_>) -> bool {
    let is_speed = |guess: &Guess<'_>| is_in(guess.column, "rad/s");
    is_speed(speed)
        && outputs
            .iter()
            .all(|output| !is_speed(output) && is_bent(output, speed))
}

fn is_bent(output: &Guess<'_>, speed: &Guess<'_>) -> bool {
    let (Data::Numbers(x), Data::Numbers(y)) = (&speed.column.data, &output.column.data) else {
        return false;
    };
    let squares: Vec<f64> = x.iter().map(|x| x * x).collect();
    determination(&squares, y) > determination(x, y)
}

/// The square of the speed times the arm, where one column is a length.
pub(super) fn acceleration(speed: &Guess<'_>, columns: &[Guess<'_>]) -> String {
    let others = columns
        .iter()
        .filter(|guess| guess.role != RoleWord::Output);
    let arms: Vec<&Guess<'_>> = others.filter(|guess| is_in(guess.column, "m")).collect();
    match arms.as_slice() {
        [arm] => format!("{}^2*{}", speed.name, arm.name),
        _ => format!("{}^2", speed.name),
    }
}

fn is_in(column: &Column, unit: &str) -> bool {
    let wanted = UnitTable::default().parse(unit);
    let own = column.unit.as_ref().zip(wanted.ok());
    own.is_some_and(|(own, wanted)| own.conversion_to(&wanted).is_some())
}
