//! Positions of a triad: labels that say which axis points up or down, or along which one acts what is set.

use gumption_fault::language::Language;
use gumption_fault::{Said, say};
use gumption_format::csv::{Column, Data};
use gumption_format::toml::writing::quoted;

/// The axes, as labels have them.
const AXES: [char; 3] = ['x', 'y', 'z'];

/// What the labels of a column stand for.
pub(super) struct Positions {
    /// The labels, each with its axis (a place among x, y, z) and whether that points up, if it says so.
    of_label: Vec<(String, usize, Option<bool>)>,
}

impl Positions {
    /// Of a column of which every label says an axis, and may say a sense: `x up`, `X+`, `-z`, `y轴朝下`, `X`.
    pub(super) fn of(column: &Column) -> Option<Positions> {
        let Data::Labels(labels) = &column.data else {
            return None;
        };
        let named = labels.levels.iter().filter(|label| !label.is_empty());
        let of_label = named.map(|label| {
            let (axis, up) = direction(label)?;
            Some((label.clone(), axis, up))
        });
        let of_label: Option<Vec<_>> = of_label.collect();
        let found = Positions {
            of_label: of_label?,
        };
        (found.of_label.len() > 1).then_some(found)
    }

    /// Whether every label says a sense: what acts is gravity.
    pub(super) fn are_up_or_down(&self) -> bool {
        self.of_label.iter().all(|(.., up)| up.is_some())
    }

    /// The axes that occur.
    pub(super) fn axes(&self) -> Vec<char> {
        let occurs =
            |(place, _): &(usize, &char)| self.of_label.iter().any(|(_, axis, _)| axis == place);
        let axes = AXES.iter().enumerate().filter(occurs);
        axes.map(|(_, axis)| *axis).collect()
    }

    /// The table that says what each label stands for, by the names of the axes that occur.
    pub(super) fn table(
        &self,
        column: &str,
        names: &[String],
        one: &Said,
        language: Language,
    ) -> String {
        let axes = self.axes();
        let gives: Vec<String> = names.iter().map(|name| quoted(name)).collect();
        let at = self.of_label.iter().map(|(label, axis, up)| {
            let values = axes.iter().map(|name| match (AXES[*axis] == *name, up) {
                (true, Some(false)) => "-1",
                (true, _) => "1",
                (false, _) => "0",
            });
            let values: Vec<&str> = values.collect();
            format!("{} = [{}]", quoted(label), values.join(", "))
        });
        let at: Vec<String> = at.collect();
        format!(
            "\n[positions]   # {}\ncolumn = {}\ngives = [{}]\nat = {{ {} }}\n",
            one.in_language(language),
            quoted(column),
            gives.join(", "),
            at.join(", ")
        )
    }
}

/// What the number 1 of a position is where gravity acts.
pub(super) fn of_gravity() -> Said {
    say!("1: the axis points up, in units of the local acceleration of free fall")
}

/// What it is where something is set.
pub(super) fn of_stimulus(stimulus: &str) -> Said {
    say!("1: {stimulus} acts along the axis, or about it")
}

/// The axis of a label, and its sense where it says one.
fn direction(label: &str) -> Option<(usize, Option<bool>)> {
    const UP: [&str; 7] = ["up", "plus", "+", "朝上", "朝天", "上", "正"];
    const DOWN: [&str; 8] = ["down", "minus", "-", "−", "朝下", "朝地", "下", "负"];
    let label = label.to_lowercase();
    let without = |words: &[&str]| {
        let word = words.iter().find(|word| label.contains(**word))?;
        Some(label.replacen(word, "", 1))
    };
    let (rest, up) = match (without(&UP), without(&DOWN)) {
        (Some(rest), None) => (rest, Some(true)),
        (None, Some(rest)) => (rest, Some(false)),
        (None, None) => (label.clone(), None),
        (Some(_), Some(_)) => return None,
    };
    let letters = rest.replace("axis", "").replace('轴', "");
    let letters = letters.trim_matches(|c: char| !c.is_alphanumeric());
    let place = AXES.iter().position(|axis| letters == axis.to_string())?;
    Some((place, up))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_say_an_axis_and_a_sense() {
        for (label, found) in [
            ("x up", Some((0, Some(true)))),
            ("X+", Some((0, Some(true)))),
            ("-z", Some((2, Some(false)))),
            ("Y_down", Some((1, Some(false)))),
            ("z轴朝天", Some((2, Some(true)))),
            ("X", Some((0, None))),
            ("y轴", Some((1, None))),
            ("level", None),
            ("+-x", None),
            ("up", None),
            ("P1+", None),
        ] {
            assert_eq!(direction(label), found, "{label}");
        }
    }
}
