//! Positions of a triad: labels that say which axis points up or down, or along which one acts what is set.

use gumption_fault::language::Language;
use gumption_fault::{Said, say};
use gumption_format::csv::{Column, Data};
use gumption_format::toml::writing::quoted;

/// The axes, as labels have them.
const AXES: [char; 3] = ['x', 'y', 'z'];

/// What a label says: which axis (a place among x, y, z; none where there is one only), and what that does.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Direction {
    axis: Option<usize>,
    sense: Sense,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Sense {
    Up,
    Down,
    Level,
    Unsaid,
}

/// What the labels of a column stand for.
pub(super) struct Positions {
    of_label: Vec<(String, Direction)>,
}

impl Positions {
    /// Of a column of which every label says an axis, and may say a sense: `x up`, `X+`, `-z`, `y轴朝下`, `X`; or of which
    /// every label says how the only axis points: `up`, `down`, `level`.
    pub(super) fn of(column: &Column) -> Option<Positions> {
        let Data::Labels(labels) = &column.data else {
            return None;
        };
        let named = labels.levels.iter().filter(|label| !label.is_empty());
        let of_label = named.map(|label| Some((label.clone(), direction(label)?)));
        let of_label: Vec<_> = of_label.collect::<Option<_>>()?;
        let found = Positions { of_label };
        let without_axis = || found.of_label.iter().all(|(_, one)| one.axis.is_none());
        let is_alike = found.name_axes() || without_axis();
        (is_alike && found.of_label.len() > 1).then_some(found)
    }

    /// Whether every label says a sense: what acts is gravity.
    pub(super) fn are_up_or_down(&self) -> bool {
        self.of_label
            .iter()
            .all(|(_, one)| one.sense != Sense::Unsaid)
    }

    /// Whether the labels say which axis they are about.
    pub(super) fn name_axes(&self) -> bool {
        self.of_label.iter().all(|(_, one)| one.axis.is_some())
    }

    /// The axes that occur.
    fn places(&self) -> Vec<Option<usize>> {
        let places = [None, Some(0), Some(1), Some(2)].into_iter();
        let occurs =
            |place: &Option<usize>| self.of_label.iter().any(|(_, one)| one.axis == *place);
        places.filter(occurs).collect()
    }

    /// Their names; nothing where there is one only.
    pub(super) fn axes(&self) -> Vec<String> {
        let places = self.places().into_iter();
        let names =
            places.map(|place| place.map_or(String::new(), |place| AXES[place].to_string()));
        names.collect()
    }

    /// The table that says what each label stands for, by the names of the axes that occur.
    pub(super) fn table(
        &self,
        column: &str,
        names: &[String],
        one: &Said,
        language: Language,
    ) -> String {
        let places = self.places();
        let gives: Vec<String> = names.iter().map(|name| quoted(name)).collect();
        let at = self.of_label.iter().map(|(label, one)| {
            let values = places
                .iter()
                .map(|place| match (one.axis == *place, one.sense) {
                    (false, _) | (true, Sense::Level) => "0",
                    (true, Sense::Down) => "-1",
                    (true, Sense::Up | Sense::Unsaid) => "1",
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

/// What a label says of an axis.
fn direction(label: &str) -> Option<Direction> {
    const UP: [&str; 7] = ["up", "plus", "+", "朝上", "朝天", "上", "正"];
    const DOWN: [&str; 8] = ["down", "minus", "-", "−", "朝下", "朝地", "下", "负"];
    const LEVEL: [&str; 5] = ["level", "horizontal", "水平", "平放", "平"];
    let label = label.to_lowercase();
    let without = |words: &[&str], sense| {
        let word = words.iter().find(|word| label.contains(**word))?;
        Some((label.replacen(word, "", 1), sense))
    };
    let said = [
        without(&UP, Sense::Up),
        without(&DOWN, Sense::Down),
        without(&LEVEL, Sense::Level),
    ];
    let mut said = said.into_iter().flatten();
    let (rest, sense) = match (said.next(), said.next()) {
        (first, None) => first.unwrap_or((label.clone(), Sense::Unsaid)),
        (_, Some(_)) => return None,
    };
    let letters = rest.replace("axis", "").replace('轴', "");
    let letters = letters.trim_matches(|c: char| !c.is_alphanumeric());
    let axis = AXES.iter().position(|axis| letters == axis.to_string());
    match (axis, sense) {
        (Some(_), Sense::Level) | (None, Sense::Unsaid) => None,
        (None, _) if !letters.is_empty() => None,
        (axis, sense) => Some(Direction { axis, sense }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_say_an_axis_and_a_sense() {
        for (label, axis, sense) in [
            ("x up", Some(0), Sense::Up),
            ("X+", Some(0), Sense::Up),
            ("-z", Some(2), Sense::Down),
            ("Y_down", Some(1), Sense::Down),
            ("z轴朝天", Some(2), Sense::Up),
            ("X", Some(0), Sense::Unsaid),
            ("y轴", Some(1), Sense::Unsaid),
            ("up", None, Sense::Up),
            ("轴朝下", None, Sense::Down),
            ("水平", None, Sense::Level),
        ] {
            assert_eq!(direction(label), Some(Direction { axis, sense }), "{label}");
        }
        for label in ["+-x", "P1+", "x level", "P1", "axis", ""] {
            assert_eq!(direction(label), None, "{label}");
        }
    }
}
