//! A proposal: the experiment that a recording may be of, for somebody to look over.
//!
//! Names and units come from the first line. Roles are told by how the numbers behave, which decides nothing: the file says of each column what is in
//! it, and that its role is a guess. Without a procedure the equation is a straight line, the least that has a coefficient to calibrate; along
//! several axes that are set, the sum of one for each, and of axes that labels turn up and down likewise; around a turn, a wave;
//! of what a speed of rotation presses outwards, along its square.

mod asked;
mod centrifuge;
mod field;
mod guess;
mod line;
mod positions;
mod roles;

use std::collections::BTreeSet;
use std::path::Path;

use gumption_core::quantity::{UnitTable, show};
use gumption_core::statistics::range;
use gumption_fault::language::Language;
use gumption_fault::{Rejection, Said, say};
use gumption_format::csv::{Column, Data, Recording};
use gumption_format::toml::writing::{key, quoted};

use super::entries::RoleWord;
use super::procedure::Procedure;
use asked::by_procedure;
use guess::{Guess, identifier};
use line::{Lines, by_line};
use roles::{roles, stretches};

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
    language: Language,
) -> Result<String, Rejection> {
    let table = Recording::read_all(file, recording, &UnitTable::default())?;
    let numbers: Vec<Column> = table.columns.iter().map(as_numbers).collect();
    let columns = guessed(&table, &numbers);
    let body = match procedure {
        Some(procedure) => by_procedure(procedure, &columns, language),
        None => without_procedure(&columns, language),
    };
    let rows = table.rows();
    let proposed = say!(
        "Proposed from {rows} rows. Roles and equations are guesses: look them over, then run `gumption calibrate` or `gumption diagnose`."
    );
    let title = Path::new(file).file_stem().map_or_else(
        || "Experiment".into(),
        |stem| stem.to_string_lossy().into_owned(),
    );
    Ok(format!(
        "# {}\ntitle = {}\nrecording = {}\n{body}\n{}",
        proposed.in_language(language),
        quoted(&title),
        source(file, &columns, rows),
        unknown(language),
    ))
}

/// What nobody can guess.
fn unknown(language: Language) -> String {
    let [all, u, error] = [
        say!("What is known of the readings and of the references, stated as in a budget:"),
        say!("standard uncertainty of one reading, if it is known; else the residuals tell it"),
        say!("an error that all rows share; write it into an equation"),
    ]
    .map(|said| said.in_language(language));
    format!(
        "# {all}\n# [noise]\n# u = 0.01                     # {u}\n# [input.e]                    # {error}\n# half_width = 0.001\n"
    )
}

fn guessed<'r>(table: &'r Recording, numbers: &'r [Column]) -> Vec<Guess<'r>> {
    let mut taken = BTreeSet::new();
    let guesses = table.columns.iter().zip(numbers).zip(roles(numbers));
    guesses
        .map(|((written, column), role)| Guess {
            name: identifier(&column.role, &mut taken),
            column,
            role,
            stray: match (&written.data, &column.data) {
                (Data::Labels(labels), Data::Numbers(_)) => {
                    let mut levels = labels.levels.iter().filter(|level| !level.is_empty());
                    levels
                        .find(|level| number(level).is_none())
                        .map(String::as_str)
                }
                _ => None,
            },
        })
        .collect()
}

/// A column of texts of which more than half are numbers is one of numbers, of which some cells are to be mended.
fn as_numbers(column: &Column) -> Column {
    let Data::Labels(labels) = &column.data else {
        return column.clone();
    };
    let of_row = labels.of_row.iter();
    let numbers = of_row.map(|level| number(labels.levels.get(*level as usize)?));
    let numbers: Vec<Option<f64>> = numbers.collect();
    let count = numbers.iter().flatten().count();
    match 2 * count > numbers.len() {
        true => Column {
            data: Data::Numbers(numbers.into_iter().map(|x| x.unwrap_or(f64::NAN)).collect()),
            ..column.clone()
        },
        false => column.clone(),
    }
}

fn number(text: &str) -> Option<f64> {
    text.trim().parse().ok()
}

// ---- the text --------------------------------------------------------------------------------------------------

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
        Data::Numbers(numbers) => guess.is_set() && is_dwell(stretches(numbers)),
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

/// The equations without a procedure, and the columns.
fn without_procedure(columns: &[Guess<'_>], language: Language) -> String {
    let Lines {
        equations,
        positions,
    } = by_line(columns, language);
    let columns: String = columns
        .iter()
        .map(|guess| declared(guess, language))
        .collect();
    format!("{equations}\n[columns]\n{columns}{positions}")
}

fn declared(guess: &Guess<'_>, language: Language) -> String {
    let (role, name) = (quoted(guess.role.word()), key(&guess.name));
    let value = match guess.name == guess.column.name {
        true => role,
        false => format!(
            "{{ role = {role}, column = {} }}",
            quoted(&guess.column.header)
        ),
    };
    format!(
        "{name} = {value}   # {}\n",
        within(guess).in_language(language)
    )
}

/// What is in a column, in one line.
fn within(guess: &Guess<'_>) -> Said {
    let Guess { column, role, .. } = guess;
    if let Some(stray) = guess.stray {
        return say!("numbers but for some cells: \"{stray}\" is none, and is to be mended");
    }
    match &column.data {
        Data::Labels(labels) if *role == RoleWord::Time => {
            let rows = [labels.of_row.first(), labels.of_row.last()]
                .into_iter()
                .flatten();
            let mut texts = rows.filter_map(|level| labels.levels.get(*level as usize));
            match (texts.next(), texts.next()) {
                (Some(first), Some(last)) => say!("{first} to {last}"),
                _ => say!("no number"),
            }
        }
        Data::Labels(labels) => {
            let count = labels.levels.len();
            let shown = labels.levels.iter().take(3).map(|label| quoted(label));
            let more = (count > 3).then(|| "…".to_owned());
            let shown: Vec<String> = shown.chain(more).collect();
            let shown = shown.join(", ");
            say!("{count} labels: {shown}")
        }
        Data::Numbers(numbers) => {
            let (low, high) = range(numbers.iter().copied().filter(|x| x.is_finite()));
            let (first, last) = (show(low), show(high));
            let range = match low < high {
                _ if low > high => return say!("no number"),
                true => say!("{first} to {last}"),
                false => say!("{first} throughout"),
            };
            match &column.unit {
                Some(unit) => {
                    let unit = unit.typeset();
                    say!("{range} {unit}")
                }
                None => say!("{range}; no unit in the first line"),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::procedure::procedure_named;

    fn of(recording: &str) -> toml::Table {
        let text = proposal("run.csv", recording, None, Language::English).expect("a table");
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

    /// A cell with a thousands separator, or of what was not found, makes no labels of the others.
    #[test]
    fn a_stray_cell_makes_no_labels() {
        for stray in ["\"1,020.3\"", "<0.6"] {
            let text = format!("Load [N],Reading [N]\n0,0.0\n10,10.1\n20,{stray}\n30,30.2\n");
            let table = of(&text);
            assert_eq!(role(&table, "Reading"), "output", "{stray}");
            let written = proposal("run.csv", &text, None, Language::English).expect("a table");
            assert!(
                written.contains("is none, and is to be mended"),
                "{written}"
            );
        }
    }

    #[test]
    fn what_is_called_a_setpoint_is_read_by_nothing() {
        let rows = "0,-0.01,0.19\n20,19.97,20.25\n40,40.01,40.32\n";
        for rows in [rows.to_owned(), rows.repeat(3)] {
            let table = of(&format!("Setpoint,Reference [°C],DUT [°C]\n{rows}"));
            let roles = ["Setpoint", "Reference", "DUT"].map(|name| role(&table, name));
            assert_eq!(roles, ["ignore", "stimulus", "output"]);
            assert_eq!(table["equations"].as_str(), Some("DUT = a + b*Reference"));
        }
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

    /// What counts how often something was gone through is no stimulus, and the uncertainty of what was read no output.
    #[test]
    fn counts_of_repeats_are_runs_and_uncertainties_are_left() {
        let table = of("Zyklus;Druck [bar];Strom [mA];u [mA]\n\
            1;0;4,01;0,002\n1;5;12,02;0,003\n1;10;20,01;0,004\n2;0;4,02;0,002\n2;5;12,01;0,003\n2;10;20,03;0,004\n");
        let roles = ["Zyklus", "Druck", "Strom", "u"].map(|name| role(&table, name));
        assert_eq!(roles, ["run", "stimulus", "output", "ignore"]);
        let table = of("面,第几遍,ax (LSB)\nX+,1,99.8\nX-,1,-101\nX+,2,99.9\nX-,2,-101.5\n");
        assert_eq!(role(&table, "第几遍"), "run");
        assert_eq!(table["equations"].as_str(), Some("ax = a + b*nx"));
        // A unit of time stands for its name.
        let table = of("Days,Weight [kg]\n0,184.35\n4,182.51\n7,180.45\n");
        assert_eq!(role(&table, "Days"), "time");
        // A word that stands throughout, or nothing, tells no runs apart; a name does.
        let table =
            of("load,out,chassis,note,run\n0,0.1,A7,,first\n1,1.1,A7,,first\n2,2.1,A7,,first\n");
        let roles = ["chassis", "note", "run"].map(|name| role(&table, name));
        assert_eq!(roles, ["ignore", "ignore", "run"]);
        // What rises once is set.
        let table = of("level,U [mV]\n1,0.1\n1,0.2\n2,1.1\n2,1.2\n3,2.1\n3,2.2\n");
        assert_eq!(role(&table, "level"), "stimulus");
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

    /// An accelerometer on a centrifuge feels the square of the speed, a gyroscope on a rate table the speed.
    #[test]
    fn a_centrifuge_goes_with_the_square_of_its_speed() {
        let rows = |of: &dyn Fn(f64) -> f64| -> String {
            let speeds = (0..8).map(|place| f64::from(40 * place));
            speeds
                .map(|speed| format!("{speed},500,{:.5}\n", of(speed)))
                .collect()
        };
        let head = "speed [r/min],arm [mm],U [V]\n";
        let table = of(&format!("{head}{}", rows(&|x| 0.01 + 3e-5 * x * x)));
        assert_eq!(table["equations"].as_str(), Some("U = a + b*speed^2*arm"));
        let table = of(&format!(
            "{head}{}",
            rows(&|x| 0.01 + 3e-3 * x + 1e-9 * x * x)
        ));
        assert_eq!(table["equations"].as_str(), Some("U = a + b*speed"));
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
            Language::English,
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

    /// A time in the last column is what was measured, where all else is set.
    #[test]
    fn a_time_of_fall_is_an_output() {
        let table = of("h [m],t [s]\n0.2,0.205\n0.2,0.204\n0.4,0.288\n0.4,0.289\n");
        assert_eq!(table["equations"].as_str(), Some("t = a + b*h"));
        let table = of("t [s],x [mm],y [V]\n0,1,0.5\n1,2,1\n2,1,0.5\n3,2,1\n");
        let roles = ["t", "x", "y"].map(|name| role(&table, name));
        assert_eq!(roles, ["time", "stimulus", "output"]);
    }

    /// What counts the rows is their order, unless it is all there is; what is read beside something that is set is a condition.
    #[test]
    fn rows_are_counted_and_conditions_are_read() {
        let table = of(
            "k,V [cm^3],rho [kg/m^3],T_bath [°C],dm [mg]\n1,20,1.18,20,0.1\n2,90,1.19,30,0.5\n3,20,1.2,20,0.2\n4,90,1.21,30,0.6\n",
        );
        let roles = ["k", "V", "rho", "T_bath", "dm"].map(|name| role(&table, name));
        assert_eq!(
            roles,
            ["order", "stimulus", "covariate", "covariate", "output"]
        );
        let table = of("x,y\n1,16.08\n2,33.83\n3,65.8\n");
        assert_eq!(role(&table, "x"), "stimulus");
        // What is set counts along where the rest is the number of the run.
        for runs in ["1,1,1", "1,1,2"] {
            let run: Vec<&str> = runs.split(',').collect();
            let table = of(&format!(
                "load,out,run\n1,1.01,{}\n2,2.02,{}\n3,3.01,{}\n",
                run[0], run[1], run[2]
            ));
            assert_eq!(table["equations"].as_str(), Some("out = a + b*load"));
        }
        let table = of("位置 [mm],示值 [mm]\n0,0.001\n10,10.002\n20,20.001\n");
        assert_eq!(role(&table, "位置"), "stimulus");
        let table =
            of("t_bath [°C],t_room [°C],R [ohm]\n0,22,100\n50,23,119.4\n0,22,100.1\n50,23,119.5\n");
        assert_eq!(role(&table, "t_room"), "covariate");
        assert_eq!(table["equations"].as_str(), Some("R = a + b*t_bath"));
    }

    /// Three axes that were turned by hand.
    #[test]
    fn axes_in_a_field_have_a_length() {
        let text = proposal(
            "run.csv",
            "mx [uT],my [uT],mz [uT]\n48,1,2\n3,47,1\n0,2,49\n",
            None,
            Language::English,
        );
        let text = text.expect("a table");
        let line = "# equations = \"F = sqrt((mx - b1)^2 + (my - b2)^2 + (mz - b3)^2)\"";
        assert!(text.contains(line), "{text}");
    }

    /// Samples that a clock counts, of axes of which the length stays: they were turned, and nothing drifts.
    #[test]
    fn axes_that_are_turned_by_hand_keep_their_length() {
        let sample = |i: u32, length: f64| {
            let (a, b) = (0.7 * f64::from(i), 0.31 * f64::from(i));
            let of_axis = [a.sin() * b.cos(), a.sin() * b.sin(), a.cos()];
            let [x, y, z] = of_axis.map(|part| length * part + 0.1);
            format!("{},{x:.3},{y:.3},{z:.3}\n", 0.1 * f64::from(i))
        };
        let head = "t [s],ax [m/s^2],ay [m/s^2],az [m/s^2]\n";
        let rows = |length: &dyn Fn(u32) -> f64| -> String {
            (0..60).map(|i| sample(i, length(i))).collect()
        };
        let table = of(&format!("{head}{}", rows(&|_| 9.8)));
        assert_eq!(table["equations"][0].as_str(), Some("ax = a1"));
        let table = of(&format!("{head}{}", rows(&|i| f64::from(i))));
        assert_eq!(table["equations"][0].as_str(), Some("ax = a1 + b1*t"));
    }

    /// A rate about the axis that a label names acts on every output.
    #[test]
    fn what_is_set_acts_along_the_axis_of_the_label() {
        let row = |i: i32| {
            let (axis, rate) = (["X", "Y", "Z"][(i / 4) as usize], 10 * (i % 4 - 2));
            format!("{axis},{rate},{},{},{}\n", rate + 1, i % 3, 2 - i % 5)
        };
        let rows: String = (0..12).map(row).collect();
        let table = of(&format!("轴,转速(°/s),gx(°/s),gy(°/s),gz(°/s)\n{rows}"));
        assert_eq!(
            table["equations"][1].as_str(),
            Some("gy = a2 + b21*转速*nx + b22*转速*ny + b23*转速*nz")
        );
        assert_eq!(table["positions"]["column"].as_str(), Some("轴"));
    }

    /// Six positions without columns of what acts along the axes: the labels say it.
    #[test]
    fn labels_turn_axes_up_and_down() {
        let labels = ["X+", "X-", "Y+", "Y-"];
        let rows: String = (0..8)
            .map(|i| format!("{},{}.5,{}.25\n", labels[i / 2], i, i * i))
            .collect();
        let table = of(&format!("pos,ax [V],ay [V]\n{rows}"));
        let equations = table["equations"].as_array().expect("a list");
        assert_eq!(equations[0].as_str(), Some("ax = a1 + b11*nx + b12*ny"));
        let positions = &table["positions"];
        assert_eq!(positions["column"].as_str(), Some("pos"));
        let down: Vec<i64> = positions["at"]["Y-"]
            .as_array()
            .expect("values")
            .iter()
            .filter_map(toml::Value::as_integer)
            .collect();
        assert_eq!(down, [0, -1]);
    }

    /// A single axis: `up`, `down` and `level`, as the documentation of positions has them.
    #[test]
    fn labels_turn_a_single_axis() {
        let rows = "up,2.45\ndown,-2.44\nlevel,0.003\nup,2.46\ndown,-2.45\nlevel,0.002\n";
        let table = of(&format!("position,U [V]\n{rows}"));
        assert_eq!(table["equations"].as_str(), Some("U = a + b*n"));
        let of_label = |label: &str| table["positions"]["at"][label][0].as_integer();
        assert_eq!(
            ["up", "down", "level"].map(of_label),
            [Some(1), Some(-1), Some(0)]
        );
    }

    #[test]
    fn what_is_no_table_is_refused() {
        assert!(proposal("run.csv", "", None, Language::English).is_err());
        assert!(proposal("run.csv", "a,b\n1\n", None, Language::English).is_err());
    }

    /// In Chinese the comments are, and everything else of the file is the same.
    #[test]
    fn comments_are_in_the_language() {
        let recording =
            "t [s],load,day,out [mm]\n0,0,mon,0.01\n1,10,mon,1.02\n2,20,tue,2.01\n3,0,tue,0.02\n";
        let procedure = procedure_named("accelerometer-tumble");
        assert!(procedure.is_some());
        for procedure in [None, procedure] {
            let of =
                |language| proposal("run.csv", recording, procedure, language).expect("a table");
            let (english, chinese) = (of(Language::English), of(Language::Chinese));
            let parts = |text: &str| -> Vec<(String, String)> {
                let lines = text
                    .lines()
                    .map(|line| line.split_once('#').unwrap_or((line, "")));
                lines
                    .map(|(stated, comment)| (stated.into(), comment.into()))
                    .collect()
            };
            let (english, chinese) = (parts(&english), parts(&chinese));
            assert_eq!(english.len(), chinese.len());
            for (one, other) in english.iter().zip(&chinese) {
                assert_eq!(one.0, other.0);
                let is_said = one.1.contains("   # ") || one.1.contains(" to ");
                assert!(!is_said || one.1 != other.1, "{}", one.1);
            }
        }
    }
}
