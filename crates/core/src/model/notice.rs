//! What a reader must know about a model at its estimates, in both languages of the report.

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
    /// A clause, in English.
    pub fn english(&self) -> String {
        match self {
            Notice::Steps { call } => {
                format!("{call} is a step function: its derivative is 0 although it jumps")
            }
            Notice::Kink { call, argument } => {
                format!("{call} has a kink where {argument} is 0, which is just here")
            }
            Notice::Tie { call } => {
                format!("{call} has a kink where two arguments are equal, which is just here")
            }
            Notice::Condition { call } => format!("the condition {call} changes just here"),
            Notice::Jump { call } => format!("{call} jumps from -π to π just here"),
            Notice::Knot { call, argument, at } => {
                format!(
                    "{call} has a kink at the point {argument} = {at} of its table, which is just here"
                )
            }
            Notice::BeyondTable {
                call,
                argument,
                at,
                ends: [low, high],
            } => {
                format!(
                    "{argument} = {at} lies outside the table of {call}, which goes from {low} to {high}"
                )
            }
            Notice::Near {
                argument,
                role,
                distance,
                edge,
            } => {
                let role = match role {
                    Office::Argument(function) => format!("argument of {function}"),
                    Office::Divisor => "divisor".to_string(),
                    Office::Base => "base of a power".to_string(),
                };
                format!(
                    "{argument} ({role}) is {distance:.1} u from {}",
                    shown(*edge)
                )
            }
            Notice::Wrap { call, distance } => {
                format!("{call} is {distance:.1} u from ±π")
            }
            Notice::Filled { call, u } => {
                format!("{call} has a standard uncertainty of {u:.2} rad")
            }
            Notice::Corner { call, distance } => {
                format!("{call} has a kink or jump {distance:.1} u from the estimates")
            }
            Notice::CoarseStep { call, ratio } => {
                format!(
                    "the step of {call} is {ratio:.1} times the standard uncertainty of what it rounds"
                )
            }
        }
    }

    /// The same in Chinese.
    pub fn chinese(&self) -> String {
        match self {
            Notice::Steps { call } => format!("{call} 是阶梯函数，其导数为 0，函数值却有跳变"),
            Notice::Kink { call, argument } => {
                format!("{call} 在 {argument} 为 0 处有折点，估计值恰在该处")
            }
            Notice::Tie { call } => format!("{call} 在两个自变量相等处有折点，估计值恰在该处"),
            Notice::Condition { call } => format!("条件 {call} 恰在估计值处改变"),
            Notice::Jump { call } => format!("{call} 恰在估计值处由 -π 跳变到 π"),
            Notice::Knot { call, argument, at } => {
                format!("{call} 在表中的点 {argument} = {at} 处有折点，估计值恰在该处")
            }
            Notice::BeyondTable {
                call,
                argument,
                at,
                ends: [low, high],
            } => {
                format!("{argument} = {at} 超出 {call} 的表的范围（{low} 至 {high}）")
            }
            Notice::Near {
                argument,
                role,
                distance,
                edge,
            } => {
                let role = match role {
                    Office::Argument(function) => format!("{function} 的自变量"),
                    Office::Divisor => "除数".to_string(),
                    Office::Base => "幂的底数".to_string(),
                };
                format!(
                    "{argument}（{role}）与 {} 相距 {distance:.1} u",
                    shown(*edge)
                )
            }
            Notice::Wrap { call, distance } => format!("{call} 与 ±π 相距 {distance:.1} u"),
            Notice::Filled { call, u } => format!("{call} 的标准不确定度为 {u:.2} rad"),
            Notice::Corner { call, distance } => {
                format!("{call} 在距估计值 {distance:.1} u 处有折点或跳变")
            }
            Notice::CoarseStep { call, ratio } => {
                format!("{call} 的步长是被修约量的标准不确定度的 {ratio:.1} 倍")
            }
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
