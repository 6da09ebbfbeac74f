//! Without a procedure: for each output a straight line along what is set.

use std::collections::BTreeSet;

use gumption_fault::language::Language;
use gumption_fault::say;
use gumption_format::csv::Column;
use gumption_format::toml::writing::quoted;

use super::guess::{Guess, identifier};
use super::positions::{Positions, of_gravity, of_stimulus};
use super::roles::{followed, goes_around, is_kin};
use super::{centrifuge, field};
use crate::experiment::entries::RoleWord;

/// Equations and the tables that go with them.
pub(super) struct Lines {
    pub equations: String,
    /// The table that says which positions labels name, where it is needed.
    pub positions: String,
}

/// For each output a straight line along what is set; along its other axes, too. Around with an angle it is a wave.
pub(super) fn by_line(columns: &[Guess<'_>], language: Language) -> Lines {
    let outputs = columns
        .iter()
        .filter(|guess| guess.role == RoleWord::Output);
    let outputs: Vec<&Guess<'_>> = outputs.collect();
    let mut taken: BTreeSet<String> = columns.iter().map(|guess| guess.name.clone()).collect();
    let Along { terms, positions } = along(columns, &outputs, &mut taken, language);
    // Numbered: a name that is nearly that of a column would be taken for a slip of the pen.
    let equations = outputs.iter().zip(1..).map(|(output, number)| {
        let number = match outputs.len() {
            1 => String::new(),
            _ => number.to_string(),
        };
        quoted(&equation(output, &number, &terms, &mut taken))
    });
    let equations: Vec<String> = equations.collect();
    let equations = match equations.as_slice() {
        [] => {
            let why = say!("no column looks like an output").in_language(language);
            format!("# equations = \"y = a + b*x\"   # {why}")
        }
        [one] => format!("equations = {one}"),
        several => format!("equations = [\n    {},\n]", several.join(",\n    ")),
    };
    let field = match (outputs.as_slice(), terms.is_empty()) {
        ([x, y, z], true) => field::equation(x, y, z, language),
        _ => String::new(),
    };
    Lines {
        equations: format!("{equations}\n{field}"),
        positions,
    }
}

/// What the outputs follow.
#[derive(Default)]
struct Along<'r> {
    /// Expressions; with its column where it is one.
    terms: Vec<(String, Option<&'r Column>)>,
    /// The table of the positions that they use.
    positions: String,
}

fn along<'r>(
    columns: &[Guess<'r>],
    outputs: &[&Guess<'r>],
    taken: &mut BTreeSet<String>,
    language: Language,
) -> Along<'r> {
    let set = set(columns);
    let best = best(outputs, &set);
    let is_timed = set.iter().all(|guess| guess.role == RoleWord::Time);
    let labels = columns.iter();
    let labels = labels.filter_map(|guess| Some((guess, Positions::of(guess.column)?)));
    // Of several outputs, labels without an axis do not say which points up.
    let mut labels = labels.filter(|(_, found)| found.name_axes() || outputs.len() == 1);
    let label = labels.next();
    let mut axes = |positions: &Positions| -> Vec<String> {
        let axes = positions.axes().into_iter();
        axes.map(|axis| identifier(&format!("n{axis}"), taken))
            .collect()
    };
    match (label, best) {
        // Gravity acts along the axes, or what is set does.
        (Some((guess, positions)), _) if is_timed && positions.are_up_or_down() => {
            let names = axes(&positions);
            Along {
                positions: positions.table(&guess.name, &names, &of_gravity(), language),
                terms: names.into_iter().map(|name| (name, None)).collect(),
            }
        }
        (Some((guess, positions)), Some(best)) if !is_timed && outputs.len() > 1 => {
            let names = axes(&positions);
            let along = names.iter().map(|name| format!("{}*{name}", best.name));
            let one = of_stimulus(&best.name);
            Along {
                positions: positions.table(&guess.name, &names, &one, language),
                terms: along.map(|along| (along, None)).collect(),
            }
        }
        _ if is_timed && field::is_constant(outputs) => Along::default(),
        (None, Some(best)) if centrifuge::is_one(outputs, best) => Along {
            terms: vec![(centrifuge::acceleration(best, columns), None)],
            positions: String::new(),
        },
        _ => {
            let is_along = |guess: &&&Guess<'r>| {
                best.is_some_and(|best| {
                    best.name == guess.name || is_kin(best.column, guess.column)
                })
            };
            let along = set.iter().filter(is_along);
            Along {
                terms: along
                    .map(|guess| (guess.name.clone(), Some(guess.column)))
                    .collect(),
                positions: String::new(),
            }
        }
    }
}

/// The columns that are set; time, where there is nothing else. What differs from position to position is no drift.
fn set<'g, 'r>(columns: &'g [Guess<'r>]) -> Vec<&'g Guess<'r>> {
    let of = |role| columns.iter().filter(move |guess| guess.role == role);
    let mut set: Vec<&Guess<'r>> = columns.iter().filter(|guess| guess.is_set()).collect();
    if set.is_empty() && of(RoleWord::Position).next().is_none() {
        set.extend(of(RoleWord::Time));
    }
    set
}

/// The one of them that the first output follows best.
fn best<'g, 'r>(outputs: &[&Guess<'r>], set: &[&'g Guess<'r>]) -> Option<&'g Guess<'r>> {
    let columns = set.iter().map(|guess| guess.column);
    let of_first = outputs.first();
    let best = of_first.and_then(|output| followed(output.column, columns));
    set.get(best.unwrap_or(0)).copied()
}

/// A constant and a term for each that the output follows; two for a wave.
fn equation(
    output: &Guess<'_>,
    number: &str,
    terms: &[(String, Option<&Column>)],
    taken: &mut BTreeSet<String>,
) -> String {
    let mut coefficient = |name: String| identifier(&name, taken);
    let constant = coefficient(format!("a{number}"));
    let of_terms = terms.iter().zip(1..).map(|((along, column), axis)| {
        let slope = coefficient(match terms.len() {
            1 => format!("b{number}"),
            _ => format!("b{number}{axis}"),
        });
        match column.is_some_and(|column| goes_around(output.column, column)) {
            true => {
                let across = coefficient(format!("c{number}"));
                format!(" + {slope}*sin({along}) + {across}*cos({along})")
            }
            false => format!(" + {slope}*{along}"),
        }
    });
    let of_terms: String = of_terms.collect();
    format!("{} = {constant}{of_terms}", output.name)
}
