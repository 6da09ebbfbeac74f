//! A sheet while it is written, and what its parts know of one another.

use gumption_format::document::{Entry, Held, Sheet};

use crate::{Report, symbol};

/// A sheet while it is written.
pub(super) struct Writer<'a> {
    pub report: &'a Report<'a>,
    pub measurand: usize,
    pub sheet: Sheet,
    /// Inputs that act on the measurand, each with the row of its estimate.
    pub inputs: Vec<(usize, usize)>,
}

/// Columns of the inputs.
pub(super) const ESTIMATE: usize = 1;
pub(super) const INPUT_U: usize = 3;
pub(super) const SENSITIVITY: usize = 4;
pub(super) const EVALUATED: usize = 5;

/// Row of u(y) below the components.
pub(super) const U_BELOW: usize = 3;

impl<'a> Writer<'a> {
    pub(super) fn new(report: &'a Report<'a>, measurand: usize) -> Self {
        let name = report.measurand(measurand).0;
        let name = match report.label {
            Some(label) => format!("{name} {label}"),
            None => name.to_string(),
        };
        Writer {
            report,
            measurand,
            sheet: Sheet {
                name,
                ..Sheet::default()
            },
            inputs: Vec::new(),
        }
    }

    pub(super) fn word(&self, english: &str, chinese: &str) -> String {
        self.report.language.pick(english, chinese).to_string()
    }

    pub(super) fn words(&self, english: &str, chinese: &str) -> Entry {
        Entry::Words(self.word(english, chinese))
    }

    pub(super) fn title(&mut self, english: &str, chinese: &str) {
        self.sheet.push(Vec::new());
        let title = Entry::Title(self.word(english, chinese));
        self.sheet.push(vec![title]);
    }

    pub(super) fn heads(&mut self, heads: &[(&str, &str)]) {
        let heads = heads.iter().map(|(en, zh)| Entry::Head(self.word(en, zh)));
        let heads = heads.collect();
        self.sheet.push(heads);
    }

    /// Unit of u(y).
    pub(super) fn unit_of_u(&self) -> String {
        symbol(self.report.measurand(self.measurand).1)
    }
}

/// Degrees of freedom: a number, or `∞`.
pub(super) fn freedom(dof: f64) -> Held {
    match dof.is_finite() {
        true => Held::Number(dof),
        false => Held::Words("∞".to_string()),
    }
}
