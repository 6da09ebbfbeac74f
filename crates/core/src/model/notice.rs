//! What a reader must know about a model at its estimates.

use gumption_fault::{Said, say};

/// An operation that is not smooth at the estimates, or comes near a point where it is not.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub enum Notice {
    /// A staircase: derivative 0 although it jumps.
    Steps {
        /// As the user wrote it, `round(x)`.
        call: String,
    },
    /// A corner just here.
    Kink {
        /// As the user wrote it, `abs(x - a)`.
        call: String,
        /// What is zero there, `x - a`.
        argument: String,
    },
    /// `min` or `max` of equal arguments.
    Tie {
        /// As the user wrote it.
        call: String,
    },
    /// A condition that changes just here.
    Condition {
        /// As the user wrote it, `x > a`.
        call: String,
    },
    /// A phase that jumps from -π to π just here.
    Jump {
        /// As the user wrote it, `atan2(y, x)`.
        call: String,
    },
    /// A point of a table, where two lines meet.
    Knot {
        /// As the user wrote it, `interpolate(t, ts, cs)`.
        call: String,
        /// `t`
        argument: String,
        /// The x of the point.
        at: f64,
    },
    /// An argument beyond the ends of a table.
    BeyondTable {
        /// As the user wrote it, `interpolate(t, ts, cs)`.
        call: String,
        /// `t`
        argument: String,
        /// Its value.
        at: f64,
        /// First and last x of the table.
        ends: [f64; 2],
    },
    /// A quantity that comes close to a pole or to the end of a domain.
    Near {
        /// The quantity as the user wrote it.
        argument: String,
        /// What it is used as.
        role: Office,
        /// In standard uncertainties of the quantity.
        distance: f64,
        /// The pole or end.
        edge: f64,
    },
    /// A phase whose distribution reaches the jump between -π and π.
    Wrap {
        /// As the user wrote it, `atan2(y, x)`.
        call: String,
        /// In standard uncertainties of the phase.
        distance: f64,
    },
    /// A phase whose distribution reaches all round the circle.
    Filled {
        /// As the user wrote it, `atan2(y, x)`.
        call: String,
        /// Standard uncertainty of the phase, in radians.
        u: f64,
    },
    /// A corner, condition or step that comes near.
    Corner {
        /// As the user wrote it, `abs(x - a)`.
        call: String,
        /// In standard uncertainties.
        distance: f64,
    },
    /// `quantize` with a step that is large against the uncertainty of what it rounds.
    CoarseStep {
        /// As the user wrote it.
        call: String,
        /// Step divided by standard uncertainty.
        ratio: f64,
    },
}

/// What a quantity near a pole is used as.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub enum Office {
    /// Argument of this function.
    Argument(&'static str),
    /// Divisor.
    Divisor,
    /// Base of a power.
    Base,
}

impl Notice {
    /// A clause.
    pub fn said(&self) -> Said {
        match self {
            Notice::Steps { call } => {
                say!("{call} is a step function: its derivative is 0 although it jumps")
            }
            Notice::Kink { call, argument } => {
                say!("{call} has a kink where {argument} is 0, which is just here")
            }
            Notice::Tie { call } => {
                say!("{call} has a kink where two arguments are equal, which is just here")
            }
            Notice::Condition { call } => say!("the condition {call} changes just here"),
            Notice::Jump { call } => say!("{call} jumps from -π to π just here"),
            Notice::Knot { call, argument, at } => say!(
                "{call} has a kink at the point {argument} = {at} of its table, which is just here"
            ),
            Notice::BeyondTable {
                call,
                argument,
                at,
                ends: [low, high],
            } => say!(
                "{argument} = {at} lies outside the table of {call}, which goes from {low} to {high}"
            ),
            Notice::Near {
                argument,
                role,
                distance,
                edge,
            } => {
                let (role, edge) = (role.said(), shown(*edge));
                say!("{argument} ({role}) is {distance:.1} u from {edge}")
            }
            Notice::Wrap { call, distance } => say!("{call} is {distance:.1} u from ±π"),
            Notice::Filled { call, u } => say!("{call} has a standard uncertainty of {u:.2} rad"),
            Notice::Corner { call, distance } => {
                say!("{call} has a kink or jump {distance:.1} u from the estimates")
            }
            Notice::CoarseStep { call, ratio } => say!(
                "the step of {call} is {ratio:.1} times the standard uncertainty of what it rounds"
            ),
        }
    }
}

impl Office {
    fn said(self) -> Said {
        match self {
            Office::Argument(function) => say!("argument of {function}"),
            Office::Divisor => say!("divisor"),
            Office::Base => say!("base of a power"),
        }
    }
}

/// A number as short as it may be.
pub(super) fn shown(edge: f64) -> String {
    if edge.fract() == 0.0 {
        format!("{edge}")
    } else {
        format!("{edge:.4}")
    }
}
