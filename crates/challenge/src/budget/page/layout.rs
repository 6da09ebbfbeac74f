//! The layouts in which laboratories keep their sheets: which columns, and what follows what.

use rand::RngExt;
use rand::seq::IndexedRandom;

use crate::random::Random;

/// Layouts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::budget) enum Form {
    Ea,
    M3003,
    Jjf,
    Free,
    Squares,
    TwoHeads,
    Turned,
    TwoPages,
    Short,
    Groups,
    Summary,
    Prose,
}

impl Form {
    pub(in crate::budget) const ALL: [Form; 12] = [
        Form::Ea,
        Form::M3003,
        Form::Jjf,
        Form::Free,
        Form::Squares,
        Form::TwoHeads,
        Form::Turned,
        Form::TwoPages,
        Form::Short,
        Form::Groups,
        Form::Summary,
        Form::Prose,
    ];

    pub(in crate::budget) fn name(self) -> &'static str {
        match self {
            Form::Ea => "EA-4/02",
            Form::M3003 => "M3003",
            Form::Jjf => "JJF 1059.1",
            Form::Free => "free",
            Form::Squares => "squares and shares",
            Form::TwoHeads => "head of two lines",
            Form::Turned => "rows and columns exchanged",
            Form::TwoPages => "two tables",
            Form::Short => "no inputs",
            Form::Groups => "grouped rows",
            Form::Summary => "summary",
            Form::Prose => "sentences",
        }
    }

    /// Whether the estimates stand in it.
    pub(in crate::budget) fn has_estimates(self) -> bool {
        !matches!(
            self,
            Form::M3003 | Form::Free | Form::Squares | Form::Short | Form::Groups
        )
    }
}

/// How a page is written.
#[derive(Debug, Clone, Copy)]
pub(in crate::budget) struct Manner {
    pub form: Form,
    pub chinese: bool,
    /// Digits of u and contributions.
    pub digits: usize,
    /// Which of several ways to say things.
    pub variant: usize,
    /// Formulas beside the figures.
    pub formulas: bool,
}

/// A manner that suits a budget.
pub(in crate::budget) fn manner(random: &mut Random) -> Manner {
    let form = *Form::ALL.choose(random).unwrap_or(&Form::Ea);
    Manner {
        form,
        chinese: form == Form::Jjf || form != Form::M3003 && random.random_bool(0.3),
        digits: random.random_range(2..5),
        variant: random.random_range(0..60),
        formulas: false,
    }
}

/// What columns hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Column {
    Number,
    Symbol,
    Name,
    Estimate,
    Unit,
    Type,
    Used,
    Distribution,
    Divisor,
    U,
    C,
    Contribution,
    Square,
    Share,
    Nu,
    Known,
}

/// What stands below the opening lines of a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    /// A table of the rows with these columns.
    Table(&'static [Column]),
    /// The same with rows and columns exchanged.
    Turned(&'static [Column]),
    /// The row of the result below the table, as EA-4/02 has it.
    Result,
    /// u_c and U as rows of the table with these columns, as M3003 has them.
    Footer(&'static [Column]),
    /// The claim.
    Claims,
    /// A line for each row, with what is known of it.
    Notes,
    /// A new page.
    Page,
}

use Column::*;
use Part::*;

/// The columns of the table of M3003.
const M3003: &[Column] = &[
    Symbol,
    Name,
    Known,
    Used,
    Distribution,
    Divisor,
    C,
    Contribution,
    Nu,
];

impl Form {
    /// The parts of a page; `is_sum`: of a budget whose coefficients are all 1.
    pub(super) fn parts(self, is_sum: bool) -> &'static [Part] {
        match self {
            Form::Ea => &[
                Table(&[Symbol, Estimate, U, Distribution, C, Contribution]),
                Result,
                Claims,
                Notes,
            ],
            Form::M3003 => &[Table(M3003), Footer(M3003)],
            Form::Jjf => &[
                Table(&[
                    Number,
                    Symbol,
                    Name,
                    Estimate,
                    Type,
                    Distribution,
                    Used,
                    Divisor,
                    U,
                    C,
                    Contribution,
                    Nu,
                    Known,
                ]),
                Claims,
            ],
            Form::Free => &[
                Table(&[
                    Name,
                    Symbol,
                    Known,
                    Type,
                    Used,
                    Unit,
                    Divisor,
                    U,
                    C,
                    Contribution,
                ]),
                Claims,
            ],
            Form::Squares => &[
                Table(&[
                    Symbol,
                    Known,
                    Used,
                    Divisor,
                    U,
                    C,
                    Contribution,
                    Square,
                    Share,
                    Nu,
                ]),
                Claims,
            ],
            Form::TwoHeads => &[
                Table(&[
                    Symbol,
                    Name,
                    Estimate,
                    Used,
                    Divisor,
                    U,
                    C,
                    Contribution,
                    Nu,
                ]),
                Claims,
                Notes,
            ],
            Form::Turned => &[
                Claims,
                Turned(&[
                    Symbol,
                    Known,
                    Estimate,
                    Used,
                    Divisor,
                    U,
                    C,
                    Contribution,
                    Nu,
                ]),
            ],
            Form::TwoPages => &[
                Table(&[Symbol, Name, Estimate, Known]),
                Page,
                Table(&[Symbol, U, C, Contribution, Nu]),
                Claims,
            ],
            Form::Short => &[Table(&[Symbol, Known, Nu, C, Contribution]), Claims],
            Form::Groups => &[
                Table(&[
                    Symbol,
                    Name,
                    Used,
                    Distribution,
                    Divisor,
                    U,
                    C,
                    Contribution,
                ]),
                Claims,
                Notes,
            ],
            Form::Summary if is_sum => &[Table(&[Symbol, Estimate, Known]), Claims],
            Form::Summary => &[Table(&[Name, Symbol, Estimate, Known, C]), Claims],
            Form::Prose => &[Notes, Claims],
        }
    }
}
