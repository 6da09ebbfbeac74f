//! A proposal: the experiment that a recording may be of, for somebody to look over.
//!
//! Names and units come from the first line. Roles are told by how the numbers behave, which decides nothing: the file says of each column what is in
//! it, and that its role is a guess. Without a procedure the equation is a straight line, the least that has a coefficient to calibrate; along
//! several axes that are set, the sum of one for each; around a turn, a wave.

mod roles;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use gumption_core::model::{is_reserved, names};
use gumption_core::quantity::{UnitTable, show};
use gumption_fault::Rejection;
use gumption_format::csv::{Column, Data, Recording};
use gumption_format::toml::writing::{key, quoted};

use super::entries::RoleWord;
use super::procedure::Procedure;
use roles::{followed, goes_around, is_kin, roles, stretches};

/// Rows from which on a recording has to say whether they are samples or averages.
const MANY: usize = 100;

/// Rows that a stretch of equal labels or values has on average where it is a dwell.
const DWELL: usize = 10;

/// The text of an experiment with this recording.
///
/// # Errors
/// The recording is no table that can be read.
pub fn proposal(
    file: &str,
    recording: &str,
    procedure: Option<&Procedure>,
) -> Result<String, Rejection> {
    let table = Recording::read_all(file, recording, &UnitTable::default())?;
    let columns = guessed(&table);
    let body = match procedure {
        Some(procedure) => by_procedure(procedure, &columns),
        None => by_line(&columns),
    };
    let title = Path::new(file).file_stem().map_or_else(
        || "Experiment".into(),
        |stem| stem.to_string_lossy().into_owned(),
    );
    Ok(format!(
        "# Proposed from {} rows. Roles and equations are guesses: look them over, then run `gumption calibrate` or `gumption diagnose`.\n\
         title = {}\nrecording = {}\n{body}\n{KNOWN}",
        table.rows(),
        quoted(&title),
        source(file, &columns, table.rows()),
    ))
}

/// What nobody can guess.
const KNOWN: &str = "\
# What is known of the readings and of the references, stated as in a budget:
# [noise]
# u = 0.01                     # standard uncertainty of one reading, if it is known; else the residuals tell it
# [input.e]                    # an error that all rows share; write it into an equation
# half_width = 0.001
";

/// A column with what it may be.
struct Guess<'r> {
    /// As equations can call it.
    name: String,
    column: &'r Column,
    role: RoleWord,
}

fn guessed(table: &Recording) -> Vec<Guess<'_>> {
    let mut taken = BTreeSet::new();
    let roles = roles(&table.columns);
    let guesses = table.columns.iter().zip(roles);
    guesses
        .map(|(column, role)| Guess {
            name: identifier(&column.role, &mut taken),
            column,
            role,
        })
        .collect()
}

// ---- the text --------------------------------------------------------------------------------------------------

/// A name that equations can write, and none of those that are taken.
fn identifier(name: &str, taken: &mut BTreeSet<String>) -> String {
    let letter = |c: char| {
        if c.is_alphanumeric() || c == '_' {
            c
        } else {
            '_'
        }
    };
    let letters: String = name.chars().map(letter).collect();
    let letters = letters.trim_matches('_').to_owned();
    let is_name = |name: &str| {
        let found = names(name);
        let [(found, _)] = found.as_slice() else {
            return false;
        };
        found == name && !is_reserved(name)
    };
    let candidates = [
        letters.clone(),
        format!("{letters}_"),
        format!("c_{letters}"),
    ];
    let first = candidates.into_iter().find(|name| is_name(name));
    let first = first.unwrap_or_else(|| "column".to_owned());
    let numbered = (2..).map(|number| format!("{first}_{number}"));
    let found = std::iter::once(first.clone()).chain(numbered);
    let name = found
        .into_iter()
        .find(|name| !taken.contains(name))
        .unwrap_or(first);
    taken.insert(name.clone());
    name
}

/// The recording: samples in dwells where values or labels stay, else rows that count by themselves.
fn source(file: &str, columns: &[Guess<'_>], rows: usize) -> String {
    let file = quoted(file);
    let is_dwell = |count: usize| count > 1 && rows / count >= DWELL;
    let labelled = columns.iter().find(|guess| match &guess.column.data {
        Data::Labels(labels) => {
            guess.role != RoleWord::Ignore && is_dwell(stretches(&labels.of_row))
        }
        Data::Numbers(numbers) => guess.role == RoleWord::Position && is_dwell(stretches(numbers)),
    });
    let stepped = columns.iter().filter(|guess| match &guess.column.data {
        Data::Numbers(numbers) => is_set(guess.role) && is_dwell(stretches(numbers)),
        Data::Labels(_) => false,
    });
    let stepped: Vec<String> = stepped.map(|guess| quoted(&guess.name)).collect();
    match (rows > MANY, stepped.as_slice(), labelled) {
        (true, [step], _) => format!("{{ file = {file}, steps = {step} }}"),
        (true, _, Some(guess)) => {
            format!("{{ file = {file}, dwells = [{}] }}", quoted(&guess.name))
        }
        (true, [], None) => format!("{{ file = {file}, average = \"none\" }}"),
        (true, steps, None) => format!("{{ file = {file}, steps = [{}] }}", steps.join(", ")),
        (false, ..) => file,
    }
}

fn is_set(role: RoleWord) -> bool {
    matches!(role, RoleWord::Stimulus | RoleWord::Angle)
}

/// For each output a straight line along what is set; along its other axes, too. Around with an angle it is a wave.
fn by_line(columns: &[Guess<'_>]) -> String {
    let of = |role| columns.iter().filter(move |guess| guess.role == role);
    let outputs: Vec<&Guess<'_>> = of(RoleWord::Output).collect();
    let mut set: Vec<&Guess<'_>> = columns.iter().filter(|guess| is_set(guess.role)).collect();
    // What differs from position to position is no drift.
    if set.is_empty() && of(RoleWord::Position).next().is_none() {
        set.extend(of(RoleWord::Time));
    }
    let columns_set = set.iter().map(|guess| guess.column);
    let best = outputs
        .first()
        .and_then(|output| followed(output.column, columns_set));
    let best = set.get(best.unwrap_or(0)).copied();
    let is_along = |guess: &&Guess<'_>| {
        best.is_some_and(|best| best.name == guess.name || is_kin(best.column, guess.column))
    };
    let along: Vec<&Guess<'_>> = set.iter().copied().filter(is_along).collect();
    let along_axes = along.len() > 1;
    let mut taken: BTreeSet<String> = columns.iter().map(|guess| guess.name.clone()).collect();
    // Numbered: a name that is nearly that of a column would be taken for a slip of the pen.
    let equations = outputs.iter().zip(1..).map(|(output, number)| {
        let number = match outputs.len() {
            1 => String::new(),
            _ => number.to_string(),
        };
        let mut coefficient = |name: String| identifier(&name, &mut taken);
        let constant = coefficient(format!("a{number}"));
        let terms = along.iter().zip(1..).map(|(along, axis)| {
            let slope = coefficient(match along_axes {
                true => format!("b{number}{axis}"),
                false => format!("b{number}"),
            });
            match goes_around(output.column, along.column) {
                true => {
                    let across = coefficient(format!("c{number}"));
                    format!(" + {slope}*sin({0}) + {across}*cos({0})", along.name)
                }
                false => format!(" + {slope}*{}", along.name),
            }
        });
        let terms: String = terms.collect();
        format!("{} = {constant}{terms}", output.name)
    });
    let equations: Vec<String> = equations.map(|equation| quoted(&equation)).collect();
    let equations = match equations.as_slice() {
        [] => "# equations = \"y = a + b*x\"   # no column looks like an output".to_owned(),
        [one] => format!("equations = {one}"),
        several => format!("equations = [\n    {},\n]", several.join(",\n    ")),
    };
    let columns: String = columns.iter().map(declared).collect();
    format!("{equations}\n\n[columns]\n{columns}")
}

fn declared(guess: &Guess<'_>) -> String {
    let (role, name) = (quoted(guess.role.word()), key(&guess.name));
    let value = match guess.name == guess.column.name {
        true => role,
        false => format!(
            "{{ role = {role}, column = {} }}",
            quoted(&guess.column.header)
        ),
    };
    format!("{name} = {value}   # {}\n", within(guess.column))
}

/// What is in a column, in one line.
fn within(column: &Column) -> String {
    match &column.data {
        Data::Labels(labels) => {
            let shown: Vec<String> = labels
                .levels
                .iter()
                .take(3)
                .map(|label| quoted(label))
                .collect();
            let more = if labels.levels.len() > 3 { ", …" } else { "" };
            format!("{} labels: {}{more}", labels.levels.len(), shown.join(", "))
        }
        Data::Numbers(numbers) => {
            let known = || numbers.iter().filter(|x| x.is_finite());
            let low = known().copied().fold(f64::INFINITY, f64::min);
            let high = known().copied().fold(f64::NEG_INFINITY, f64::max);
            let unit = column.unit.as_ref().map_or_else(
                || "; no unit in the first line".to_owned(),
                |unit| format!(" {}", unit.typeset()),
            );
            match known().next() {
                Some(_) if low < high => format!("{} to {}{unit}", show(low), show(high)),
                Some(_) => format!("{}{unit} throughout", show(low)),
                None => "no number".to_owned(),
            }
        }
    }
}

/// The columns that a procedure needs, with those of the recording that may be meant, and what it must be told.
fn by_procedure(procedure: &Procedure, columns: &[Guess<'_>]) -> String {
    let base: toml::Table = procedure.text.parse().unwrap_or_default();
    let entries = |table: &str| {
        let entries = base
            .get(table)
            .and_then(toml::Value::as_table)
            .into_iter()
            .flatten();
        let entries =
            entries.filter_map(|(name, entry)| Some((name.clone(), entry.as_table()?.clone())));
        entries.collect::<BTreeMap<String, toml::Table>>()
    };
    let said = |entry: &toml::Table, key: &str| {
        entry
            .get(key)
            .and_then(toml::Value::as_str)
            .unwrap_or_default()
            .to_owned()
    };
    let mut text = format!("procedure = {}\n\n[columns]\n", quoted(procedure.name));
    for (name, entry) in entries("columns") {
        let what = said(&entry, "description");
        let same = columns
            .iter()
            .find(|guess| guess.column.name.to_lowercase() == name.to_lowercase());
        let found = same.or_else(|| only(columns, &entry));
        text += &match found {
            Some(guess) if guess.column.name == name => format!("# {name}: {what}\n"),
            Some(guess) => {
                format!(
                    "{} = {{ column = {} }}   # {what}\n",
                    key(&name),
                    quoted(&guess.column.header)
                )
            }
            None => format!(
                "# {} = {{ column = \"…\" }}   # which column is it? {what}\n",
                key(&name)
            ),
        };
    }
    for (name, entry) in entries("input") {
        if entry.get("required").and_then(toml::Value::as_bool) == Some(true) {
            text += &format!(
                "\n# [input.{name}]   # has to be stated: {}\n# value = …\n# unit = {}\n",
                said(&entry, "description"),
                quoted(&said(&entry, "unit")),
            );
        }
    }
    text
}

/// The only column of the dimension that an entry of a procedure must have, or the only one of labels.
fn only<'g, 'r>(columns: &'g [Guess<'r>], entry: &toml::Table) -> Option<&'g Guess<'r>> {
    let word = |key: &str| entry.get(key).and_then(toml::Value::as_str);
    let like = word("like").and_then(|unit| UnitTable::default().parse(unit).ok());
    let fits = |guess: &&Guess<'_>| match (&guess.column.data, &like) {
        (Data::Labels(_), _) => word("holds") == Some("labels"),
        (Data::Numbers(_), Some(like)) => {
            let unit = guess.column.unit.as_ref();
            unit.is_some_and(|unit| unit.conversion_to(like).is_some())
        }
        (Data::Numbers(_), None) => word("holds").is_none() && guess.role == RoleWord::Output,
    };
    let mut fitting = columns.iter().filter(fits);
    let first = fitting.next();
    first.filter(|_| fitting.next().is_none())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::procedure::procedure_named;

    fn of(recording: &str) -> toml::Table {
        let text = proposal("run.csv", recording, None).expect("a table");
        text.parse()
            .unwrap_or_else(|error| panic!("{error}\n{text}"))
    }

    fn role(table: &toml::Table, name: &str) -> String {
        match &table["columns"][name] {
            toml::Value::String(role) => role.clone(),
            entry => entry["role"].as_str().expect("a role").to_owned(),
        }
    }

    #[test]
    fn what_is_set_is_a_stimulus_and_what_is_read_an_output() {
        let table = of("t [s],load [N],day,T_room [degC],deflection [mm]\n\
            0,0,mon,20.1,0.01\n1,10,mon,20.2,1.02\n2,20,mon,20.2,2.01\n\
            3,0,tue,20.1,0.02\n4,10,tue,20.4,1.01\n5,20,tue,20.3,2.02\n");
        let roles = ["t", "load", "day", "T_room", "deflection"].map(|name| role(&table, name));
        assert_eq!(roles, ["time", "stimulus", "run", "covariate", "output"]);
        assert_eq!(table["equations"].as_str(), Some("deflection = a + b*load"));
        assert_eq!(table["recording"].as_str(), Some("run.csv"));
    }

    /// A reference that is read as well comes before the output; names that equations cannot write get others.
    #[test]
    fn names_are_such_as_equations_can_write() {
        let table = of("a,sin [mV],U out (mV)\n1.01,7,0.1\n2.02,8,0.2\n3.03,9,0.3\n");
        assert_eq!(role(&table, "sin_"), "stimulus");
        assert_eq!(
            table["columns"]["U_out"]["column"].as_str(),
            Some("U out (mV)")
        );
        assert_eq!(table["equations"].as_str(), Some("U_out = a_2 + b*a"));
    }

    #[test]
    fn axes_are_outputs_together() {
        let table = of(
            "position,ax [m/s^2],ay [m/s^2]\nup,9.81,0.02\nup,9.82,0.01\ndown,-9.79,0.03\ndown,-9.78,0.04\n",
        );
        let equations = table["equations"].as_array().expect("a list");
        assert_eq!(
            (equations.len(), role(&table, "position").as_str()),
            (2, "position")
        );
        assert_eq!(equations[0].as_str(), Some("ax = a1"));
    }

    /// Six positions: what is set along each axis acts on every output, and a position is a dwell.
    #[test]
    fn axes_that_are_set_act_on_all_outputs() {
        let set = [
            [1, 0, 0],
            [-1, 0, 0],
            [0, 1, 0],
            [0, -1, 0],
            [0, 0, 1],
            [0, 0, -1],
        ];
        let rows = |head: &dyn Fn(usize) -> String| -> String {
            let row = |i: usize| {
                let ([x, y, z], noise) = (set[i / 20], 0.001 * (i * i % 37) as f64);
                format!(
                    "{}{x},{y},{z},{},{}\n",
                    head(i),
                    f64::from(x) + noise,
                    f64::from(y) - noise
                )
            };
            (0..120).map(row).collect()
        };
        let table = of(&format!("gx,gy,gz,Ux,Uy\n{}", rows(&|_| String::new())));
        let equations = table["equations"].as_array().expect("a list");
        assert_eq!(
            equations[1].as_str(),
            Some("Uy = a2 + b21*gx + b22*gy + b23*gz")
        );
        let steps = table["recording"]["steps"].as_array().expect("a list");
        assert_eq!(steps.len(), 3);
        let numbered = rows(&|i| format!("{},", i / 20 + 1));
        let table = of(&format!("position,gx,gy,gz,Ux,Uy\n{numbered}"));
        assert_eq!(table["recording"]["dwells"][0].as_str(), Some("position"));
    }

    /// Times as a clock writes them, voltages that are called U, a reference in a condition's unit, cycles and ways in words.
    #[test]
    fn columns_are_such_as_laboratories_write() {
        let table = of("Time,U_ref [V],lab [°C],U_out [V]\n\
            2026-03-02 09:00:00,0,21.1,0.01\n2026-03-02 09:00:30,1,21.3,1.02\n2026-03-02 09:01:00,0,21.2,0.02\n\
            2026-03-02 09:01:30,1,21.6,1.01\n");
        let roles = ["Time", "U_ref", "lab", "U_out"].map(|name| role(&table, name));
        assert_eq!(roles, ["time", "stimulus", "covariate", "output"]);
        assert_eq!(table["equations"].as_str(), Some("U_out = a + b*U_ref"));

        let table = of("循环,过程,标准压力（kPa）,输出（mA）\n\
            1,升压,0,4.001\n1,升压,50,12.002\n1,降压,0,4.003\n2,升压,0,4.000\n2,升压,50,12.001\n2,降压,0,4.004\n");
        let roles = ["循环", "过程", "标准压力", "输出"].map(|name| role(&table, name));
        assert_eq!(roles, ["run", "direction", "stimulus", "output"]);
        assert_eq!(table["equations"].as_str(), Some("输出 = a + b*标准压力"));
    }

    /// A temperature that is set is what a thermometer follows; where a rate is, it is a condition.
    #[test]
    fn the_output_follows_what_it_is_calibrated_against() {
        let table = of("no.,I [mA],T [°C],R [ohm]\n\
            1,1,0,100.1\n2,2,0,100.3\n3,1,50,119.4\n4,2,50,119.5\n5,1,100,138.5\n6,2,100,138.6\n");
        let roles = ["no", "I", "T", "R"].map(|name| role(&table, name));
        assert_eq!(roles, ["order", "stimulus", "stimulus", "output"]);
        assert_eq!(table["equations"].as_str(), Some("R = a + b*T"));
        let table = of("gx,rate [deg/s],T [°C],out [mV]\n\
            1,-100,10,-2001\n1,100,10,2003\n-1,-100,40,-2004\n-1,100,40,2000\n");
        assert_eq!(role(&table, "T"), "covariate");
        assert_eq!(table["equations"].as_str(), Some("out = a + b*rate"));
    }

    /// A tumbled accelerometer goes around with the angle, an encoder along it.
    #[test]
    fn angles_are_turned_or_read() {
        let rows = |of: &dyn Fn(f64) -> f64| -> String {
            let angles = (0..12).map(|place| f64::from(30 * place));
            angles
                .map(|angle| format!("{angle},{:.5}\n", of(angle)))
                .collect()
        };
        let table = of(&format!(
            "head [deg],U [V]\n{}",
            rows(&|x| 0.01 + libm::sin(x.to_radians()))
        ));
        assert_eq!(role(&table, "head"), "angle");
        assert_eq!(
            table["equations"].as_str(),
            Some("U = a + b*sin(head) + c*cos(head)")
        );
        let table = of(&format!(
            "ref [deg],enc [deg]\n{}",
            rows(&|x| x + 0.003 * libm::cos(x.to_radians()))
        ));
        assert_eq!(role(&table, "ref"), "angle");
        assert_eq!(table["equations"].as_str(), Some("enc = a + b*ref"));
    }

    #[test]
    fn many_rows_say_what_they_are() {
        let rows: String = (0..200)
            .map(|i| format!("{},{}\n", i / 20, 0.5 * f64::from(i)))
            .collect();
        assert_eq!(
            of(&format!("x,y\n{rows}"))["recording"]["steps"].as_str(),
            Some("x")
        );
        let rows: String = (0..200)
            .map(|i| format!("{},{}\n", i % 7, 0.5 * f64::from(i)))
            .collect();
        assert_eq!(
            of(&format!("x,y\n{rows}"))["recording"]["average"].as_str(),
            Some("none")
        );
    }

    #[test]
    fn a_procedure_is_told_its_columns() {
        let procedure = procedure_named("accelerometer-tumble-4");
        let text = proposal(
            "run.csv",
            "angle [deg],reading [V]\n0,0.1\n90,5\n180,0.2\n270,-5\n",
            procedure,
        )
        .expect("a table");
        assert!(text.contains("E = { column = \"reading [V]\" }"), "{text}");
        assert!(
            text.contains("theta = { column = \"angle [deg]\" }"),
            "{text}"
        );
        assert!(
            text.contains("# [input.R]   # has to be stated: Resistor"),
            "{text}"
        );
        text.parse::<toml::Table>().expect("well-formed");
    }

    #[test]
    fn what_is_no_table_is_refused() {
        assert!(proposal("run.csv", "", None).is_err());
        assert!(proposal("run.csv", "a,b\n1\n", None).is_err());
    }
}
