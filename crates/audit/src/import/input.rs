//! One input of an imported file: an estimate, and its reasons for doubt.

use std::fmt::Write as _;

use crate::calculate::{Case, estimate};
use crate::claim::{Claimed, Relative, Row, Shape, Stated};
use crate::printed::Printed;
use crate::read::{AVERAGE, has, is_of_type};
use crate::units;
use gumption_fault::language::Language;
use gumption_fault::{Said, say};
use gumption_format::toml::writing::quoted;

use super::writing::{comment, line_of_unit, number, of_symbol, remark};

/// What a component of an input is called: by its source, with its number where an earlier one is called alike.
pub(super) fn component_name(claimed: &Claimed, i: usize) -> String {
    let called = |j: usize| {
        let row = &claimed.rows[j];
        let name = if row.name.is_empty() {
            row.label()
        } else {
            &row.name
        };
        name.replace('.', " ")
    };
    let alike = of_symbol(claimed, i);
    let is_taken = alike.iter().any(|j| *j < i && called(*j) == called(i));
    match is_taken {
        true => format!("{} {}", called(i), i + 1),
        false => called(i),
    }
}

/// One input of the file.
pub(super) struct Input<'a> {
    pub(super) case: &'a Case<'a>,
    pub(super) line: usize,
    pub(super) name: &'a str,
    pub(super) of_model: bool,
    pub(super) language: Language,
}

impl<'a> Input<'a> {
    pub(super) fn text(&self, y_unit: &str) -> String {
        let alike = self.of_input();
        match alike.as_slice() {
            [first, _, ..] if *first == self.line => self.with_components(&alike, y_unit),
            [_, _, ..] => String::new(),
            _ => self.alone(y_unit),
        }
    }

    /// The rows of the input that this row is of.
    fn of_input(&self) -> Vec<usize> {
        match self.of_model {
            true => of_symbol(self.case.claimed, self.line),
            false => vec![self.line],
        }
    }

    fn row(&self) -> &'a Row {
        &self.case.claimed.rows[self.line]
    }

    /// The same of another row of the input.
    fn of_row(&self, line: usize) -> Input<'a> {
        Input { line, ..*self }
    }

    fn alone(&self, y_unit: &str) -> String {
        if let Some(left_out) = self.left_out() {
            return format!("\n{left_out}");
        }
        let unit = self.unit(y_unit);
        // Of what is known exactly no uncertainty is stated.
        let (kind, knowledge) = match self.is_exact() {
            true => ("constant", String::new()),
            false => ("input", self.knowledge(&unit)),
        };
        self.head(kind) + &self.words() + &self.estimate() + &line_of_unit(&unit) + &knowledge
    }

    /// An input of several rows: the estimate of one of them, and a component for each.
    fn with_components(&self, lines: &[usize], y_unit: &str) -> String {
        let rows = || lines.iter().map(|line| self.of_row(*line));
        let unit = self.unit(y_unit);
        let doubted: Vec<Input<'_>> = rows()
            .filter(|row| row.row().not_counted.is_none() && !row.is_exact())
            .collect();
        let kind = if doubted.is_empty() {
            "constant"
        } else {
            "input"
        };
        let mut text = self.head(kind) + &self.estimate() + &line_of_unit(&unit);
        for left_out in rows().filter_map(|row| row.left_out()) {
            text += &left_out;
        }
        if !doubted.is_empty() {
            let components: String = doubted.iter().map(|row| row.component(&unit)).collect();
            let _ = writeln!(text, "components = [\n{components}]");
        }
        text
    }

    /// One component, with its remarks in front of it.
    fn component(&self, unit: &str) -> String {
        let said = self.words() + &self.knowledge(unit);
        let (remarks, keys): (Vec<&str>, Vec<&str>) =
            said.lines().partition(|line| line.starts_with('#'));
        let mut text: String = remarks.iter().map(|line| format!("  {line}\n")).collect();
        let name = quoted(&component_name(self.case.claimed, self.line));
        let _ = writeln!(text, "  {{ name = {name}, {} }},", keys.join(", "));
        text
    }

    /// Why a row is left out, if it is.
    fn left_out(&self) -> Option<String> {
        let label = self.row().label();
        let why = self.row().not_counted.as_ref()?;
        Some(self.remark(say!("{label} is not counted: {why}")))
    }

    fn head(&self, kind: &str) -> String {
        let description = self.description();
        format!(
            "\n[{kind}.{}]\ndescription = {}\n",
            self.name,
            quoted(description)
        )
    }

    fn description(&self) -> &'a str {
        let row = self.row();
        let several = self.of_input().len() > 1;
        match row.name.is_empty() || several {
            true => row.label(),
            false => &row.name,
        }
    }

    /// What the sheet says of the row, and what of it is not read.
    fn words(&self) -> String {
        let row = self.row();
        let said = comment(&row.words);
        let mut text = String::new();
        if !said.is_empty() && said != self.description() {
            text += &self.remark(say!("The sheet: {said}"));
        }
        if let Some(unread) = &row.unread_unit {
            let unread = comment(&unread.text);
            text += &self.remark(say!(
                "The sheet writes `{unread}` behind its figures, which is no unit that is known: the figures stand here without it."
            ));
        }
        if let Some(unread) = &row.unread_used {
            let unread = comment(&unread.text);
            text += &self.remark(say!(
                "`{unread}` stands in the place of its limits, and is not understood."
            ));
        }
        text
    }

    fn estimate(&self) -> String {
        let own = estimate(self.case.claimed, self.row());
        match own {
            Some(value) if self.of_model => format!("value = {}\n", number(value.value)),
            Some(value) if value.value != 0.0 => {
                let value = comment(&value.with_unit());
                let left =
                    say!("Its estimate {value} is left out: the result is not computed here.");
                format!("{}value = 0\n", self.remark(left))
            }
            _ => "value = 0\n".into(),
        }
    }

    /// Whether the sheet states neither a figure of its uncertainty nor one from which that follows.
    fn is_exact(&self) -> bool {
        self.row().stated == Stated::Nothing && self.case.right.lines[self.line].u == 0.0
    }

    /// The unit of the estimate, or of the result for a contribution.
    fn unit(&self, y_unit: &str) -> String {
        if !self.of_model {
            return y_unit.to_string();
        }
        match estimate(self.case.claimed, self.row()) {
            Some(value) if !value.unit.is_empty() => value.unit.clone(),
            _ => self.row().unit.clone(),
        }
    }

    fn remark(&self, said: Said) -> String {
        remark(said, self.language)
    }

    /// What a figure of the row is multiplied by to be in the unit of the input.
    fn factor(&self, unit: &str) -> f64 {
        let line = &self.case.right.lines[self.line];
        if self.of_model {
            units::factor(&self.row().unit, unit).unwrap_or(1.0)
        } else {
            let to_result = units::factor(&self.case.claimed.unit, unit).unwrap_or(1.0);
            (line.c * line.to_y).abs() * to_result
        }
    }

    fn knowledge(&self, unit: &str) -> String {
        let factor = self.factor(unit) * self.row().relative_factor();
        let scaled = |figure: &Printed| number(figure.value * factor);
        let line = &self.case.right.lines[self.line];
        let mut text = String::new();
        if self.row().relative != Relative::No {
            text += &self.remark(say!("Relative on the sheet."));
        }
        let dof = match line.dof.is_finite() {
            true => format!("dof = {}\n", number(line.dof)),
            false => String::new(),
        };
        let standard = || format!("u = {}\n{dof}", number(line.u * self.factor(unit)));
        let limits = |half: f64, shape: Shape| {
            let distribution = match shape {
                Shape::Rectangular => String::new(),
                Shape::Triangular => "distribution = \"triangular\"\n".into(),
                Shape::Arcsine => "distribution = \"arcsine\"\n".into(),
                Shape::Trapezoidal(beta) => {
                    format!("distribution = \"trapezoidal\"\nbeta = {beta}\n")
                }
                Shape::Normal(_) | Shape::TwoPoint => return standard(),
            };
            let half = number(half * factor);
            format!("half_width = {half}\n{distribution}{dof}")
        };
        text += &match &self.row().stated {
            Stated::Certificate {
                expanded,
                k,
                k_stated,
            } => {
                let open = match k_stated {
                    true => String::new(),
                    false => self.remark(say!("The sheet does not state k.")),
                };
                let expanded = scaled(expanded);
                let dof = match dof.trim_end() {
                    "" => String::new(),
                    dof => format!(", {dof}"),
                };
                format!("{open}certificate = {{ U = {expanded}, k = {k:?}{dof} }}\n")
            }
            Stated::Limits {
                half_width,
                shape,
                shape_stated,
            } => {
                let open = match shape_stated {
                    true => String::new(),
                    false => self.remark(say!("Nothing but limits is stated: rectangular.")),
                };
                format!("{open}{}", limits(half_width.value, *shape))
            }
            Stated::FullWidth { width, shape } => limits(width.value / 2.0, *shape),
            Stated::Step { step } => format!("step = {}\n{dof}", scaled(step)),
            Stated::Unequal { plus, minus } => {
                let value = self
                    .row()
                    .value
                    .as_ref()
                    .filter(|_| self.of_model)
                    .map_or(0.0, |v| v.value);
                let (low, high) = (value - minus.value * factor, value + plus.value * factor);
                format!("limits = [{}, {}]\n{dof}", number(low), number(high))
            }
            Stated::Deviation { m, .. } | Stated::Range { m, .. } => {
                // What is said to be of a mean, and was not divided, is that of the mean already.
                let is_of_mean = has(&self.row().words.to_lowercase(), AVERAGE);
                let of = match *m {
                    1.0 if is_of_mean => say!("Of the mean, as the sheet states it."),
                    1.0 => say!("Of a single reading."),
                    m => say!("Of the mean of {m} readings."),
                };
                format!("{}{}type = \"A\"\n", self.remark(of), standard())
            }
            Stated::Standard { .. } | Stated::Nothing => {
                let remark = self.remark(say!("The sheet states no more than this figure."));
                let is_of_type_a = is_of_type(&self.row().evaluation.to_lowercase(), "a");
                let of_type = if is_of_type_a { "type = \"A\"\n" } else { "" };
                format!("{remark}{}{of_type}", standard())
            }
        };
        text
    }
}
