//! What a slip is, and what it does to a calculation.

use gumption_fault::{Said, say};

use crate::calculate::{Calculation, Case, Combined, Factor, Freedom, Line, Printout};

/// A change of the calculation, in a row or in the whole.
pub type Place = (Option<usize>, Change);

/// One kind of slip.
#[derive(Debug, Clone, Copy)]
pub struct Slip {
    /// Its name.
    pub id: &'static str,
    /// The rules that it breaks.
    pub rule: &'static str,
    /// How much it weighs.
    pub weight: Weight,
    /// What happened, in English.
    pub en: &'static str,
    /// What happened, in Chinese.
    pub zh: &'static str,
    /// Everywhere it can act, and what it would do there.
    pub acts: fn(&Case<'_>) -> Vec<Place>,
}

/// How much a slip weighs, the most first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Weight {
    /// E.
    Error,
    /// W.
    Warning,
    /// I.
    Information,
}

impl Weight {
    /// The word for it.
    pub const fn said(self) -> Said {
        match self {
            Weight::Error => say!("error"),
            Weight::Warning => say!("warning"),
            Weight::Information => say!("information"),
        }
    }

    /// Its word in files.
    pub const fn name(self) -> &'static str {
        match self {
            Weight::Error => "error",
            Weight::Warning => "warning",
            Weight::Information => "information",
        }
    }
}

/// What a slip does to a calculation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Change {
    /// The standard uncertainty of the row is this one.
    U(f64),
    /// It is multiplied.
    Scaled(f64),
    /// The sensitivity coefficient is this one.
    C(f64),
    /// The degrees of freedom are these.
    Dof(f64),
    /// The row enters the sum, or does not.
    Counted(bool),
    /// Its contribution is a number that was typed in.
    Typed(f64),
    /// Contributions are combined in this way.
    Combined(Combined),
    /// All correlations are multiplied by nothing, or are one.
    Correlation(Option<f64>),
    /// ν_eff is found in this way.
    Freedom(Freedom),
    /// k is found in this way.
    Factor(Factor),
    /// U is made in this way.
    Report(Reporting),
    /// The result itself is another one; this is right, where signs of the estimates are known.
    Result(Option<f64>),
}

/// What can be different about U.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reporting {
    /// Power of k in it.
    Power(i32),
    /// u_c is multiplied by this in the place of k.
    Factor(f64),
    /// A factor of units that does not belong there.
    Scale(f64),
    /// The CMC is not heeded.
    BelowCmc,
    /// It is rounded down.
    Down,
    /// It has more digits than two.
    Long,
    /// Digits are exchanged: of which figure, and which pair.
    Exchanged(Printout, usize),
}

/// A slip at a place.
#[derive(Debug, Clone, Copy)]
pub struct Act {
    /// Which.
    pub slip: &'static Slip,
    /// The row, for one that sits in a row.
    pub row: Option<usize>,
    /// What it does.
    pub change: Change,
}

/// What a change acts on: two on the same thing at the same place exclude one another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Group {
    /// u of a row.
    U,
    /// c of a row.
    C,
    /// ν of a row.
    Dof,
    /// Whether a row counts.
    Counted,
    /// c·u of a row.
    Contribution,
    /// The sum.
    Sum,
    /// The correlations.
    Correlation,
    /// ν_eff.
    Freedom,
    /// k.
    Factor,
    /// Power of k in U.
    Power,
    /// Unit of U.
    Scale,
    /// Rounding of U.
    Rounding,
    /// Length of U.
    Length,
    /// The CMC.
    Cmc,
    /// Digits of U or u_c.
    Digits,
    /// The result itself.
    Result,
}

impl Change {
    /// Changes the row that it acts on; what acts on the whole calculation leaves it.
    pub fn apply(&self, line: &mut Line) {
        match *self {
            Change::U(u) => line.u = u,
            Change::Scaled(factor) => line.u *= factor,
            Change::C(c) => line.c = c,
            Change::Dof(dof) => line.dof = dof,
            Change::Counted(counted) => line.counted = counted,
            Change::Typed(contribution) => line.typed = Some(contribution),
            _ => {}
        }
    }
}

impl Act {
    /// As in the neutral answer form: `s-not-mean@dm`.
    pub fn id(&self, case: &Case<'_>) -> String {
        match self.row {
            Some(row) => format!("{}@{}", self.slip.id, case.claimed.rows[row].label()),
            None => self.slip.id.to_string(),
        }
    }

    /// What it acts on.
    pub fn group(&self) -> Group {
        match self.change {
            Change::U(_) | Change::Scaled(_) => Group::U,
            Change::C(_) => Group::C,
            Change::Dof(_) => Group::Dof,
            Change::Counted(_) => Group::Counted,
            Change::Typed(_) => Group::Contribution,
            Change::Combined(_) => Group::Sum,
            Change::Correlation(_) => Group::Correlation,
            Change::Freedom(_) => Group::Freedom,
            Change::Factor(_) => Group::Factor,
            Change::Result(_) => Group::Result,
            Change::Report(reporting) => match reporting {
                Reporting::Power(_) | Reporting::Factor(_) => Group::Power,
                Reporting::Scale(_) => Group::Scale,
                Reporting::BelowCmc => Group::Cmc,
                Reporting::Down => Group::Rounding,
                Reporting::Long => Group::Length,
                Reporting::Exchanged(..) => Group::Digits,
            },
        }
    }

    /// Whether both can be made in one calculation.
    pub fn goes_with(&self, other: &Act) -> bool {
        (self.row, self.group()) != (other.row, other.group())
    }

    /// Makes the slip.
    pub fn apply(&self, to: &mut Calculation) {
        if let Some(line) = self.row.and_then(|row| to.lines.get_mut(row)) {
            self.change.apply(line);
        }
        match self.change {
            Change::Combined(combined) => to.combined = combined,
            Change::Correlation(None) => to.correlations.clear(),
            Change::Correlation(Some(r)) => {
                for correlation in &mut to.correlations {
                    correlation.r = r.copysign(correlation.r);
                }
            }
            Change::Freedom(freedom) => to.freedom = freedom,
            Change::Factor(factor) => to.factor = factor,
            Change::Report(reporting) => match reporting {
                Reporting::Power(power) => to.report.power = power,
                Reporting::Factor(factor) => to.report.factor = Some(factor),
                Reporting::Scale(scale) => to.report.scale = scale,
                Reporting::BelowCmc => to.report.cmc = false,
                Reporting::Down => to.report.down = true,
                Reporting::Long => to.report.long = true,
                Reporting::Exchanged(figure, pair) => to.report.exchanged = Some((figure, pair)),
            },
            _ => {}
        }
    }
}
