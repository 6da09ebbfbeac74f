//! The improved model as files: a case with the new terms, and the recording with the columns that they
//! need.

use super::case::{Blocks, Case, Column, Data, NoiseClaim, Observed, Role};
use super::noise::Claimed;
use super::simulate::{heading, recorded};
use super::{Diagnosis, Origin};
use crate::experiment::written::own_units;
use crate::recording::resolution::u_of_step;
use crate::recording::{Heading, text_of};
use gumption_core::model::{Role as SymbolRole, Symbol};
use gumption_core::quantity::Unit;
use gumption_format::files::Files;
use gumption_format::toml::writing::{key, quoted};

/// Name of the recording beside the improved case.
const RECORDING: &str = "recording.csv";

/// Name of the recording at rest beside the improved case.
const AT_REST: &str = "at_rest.csv";

/// The files of the improved case, names and texts: itself, its recording, and that at rest where it has one;
/// nothing if no effect was adopted, and no rounding beside the stated noise.
pub fn improved(case: &Case, diagnosis: &Diagnosis) -> Option<Vec<(&'static str, String)>> {
    let adopted = diagnosis.adopted.as_ref();
    let steps = steps(case, &diagnosis.noise);
    let is_rounded = diagnosis.noise.rounding.is_some() && steps.iter().any(Option::is_some);
    if adopted.is_none() && !is_rounded {
        return None;
    }
    let extended = adopted.map_or(case, |adopted| &adopted.extended.case);
    let mut text = title(case, &format!("{} (improved)", case.title));
    let (file, averaging) = (quoted(RECORDING), averaging(case, diagnosis));
    text += &format!("recording = {{ file = {file}, average = {averaging} }}\n");
    let models: Vec<String> = extended
        .model
        .iter()
        .map(|model| model_text(model))
        .collect();
    text += &match models.as_slice() {
        [one] => format!("equations = {one}\n"),
        several => format!("equations = [\n    {},\n]\n", several.join(",\n    ")),
    };
    text += &own_units(&case.own_units);
    text += "\n[columns]\n";
    let is_there = |column: &&Column| !matches!(column.data, Data::Absent);
    for (index, column) in extended.columns.iter().enumerate() {
        if !is_there(&column) {
            continue;
        }
        let mut outputs = case.responses.iter().zip(&steps);
        let own = outputs.find(|(output, _)| output.observed == Observed::Column(index));
        let step = own.and_then(|(_, step)| *step);
        let mut definitions = adopted
            .into_iter()
            .flat_map(|one| one.extended.definitions());
        let defined = definitions.find(|(name, _)| *name == column.name);
        let remark = defined.map_or(String::new(), |(_, text)| format!("  # {text}"));
        let (name, entry) = (key(&column.name), entry(column, extended, step));
        text += &format!("{name} = {entry}{remark}\n");
    }
    text += "\n[parameter]\n";
    let coefficients = adopted.map_or(&[][..], |adopted| &adopted.coefficients);
    let values = diagnosis.estimates().iter().chain(coefficients);
    for parameter in &extended.parameters {
        let of = values.clone().find(|value| {
            value.name == parameter.name || value.name.starts_with(&format!("{}[", parameter.name))
        });
        let start = of.map_or(1.0, |value| value.value);
        let per =
            (parameter.per).map(|per| format!("per = {}", quoted(&extended.columns[per].name)));
        let prior = (parameter.prior).map(|(value, u)| format!("value = {value:e}, u = {u:e}"));
        let stated = [
            Some(format!("start = {start:e}")),
            unit(&parameter.unit),
            per,
            prior,
        ];
        text += &entry_of(&parameter.name, stated);
    }
    text += &constants(case);
    let at_rest = at_rest(case);
    text += &claims(case, at_rest.as_deref());
    let mut files = vec![("case.toml", text), (RECORDING, recorded(extended).csv())];
    files.extend(at_rest.map(|text| (AT_REST, text)));
    Some(files)
}

/// The first lines of a file about a case.
pub(super) fn title(case: &Case, title: &str) -> String {
    let reference = case.reference.as_ref();
    let reference = reference.map(|text| format!("reference = {}\n", quoted(text)));
    format!(
        "title = {}\n{}",
        quoted(title),
        reference.unwrap_or_default()
    )
}

/// An entry with what is stated.
fn entry_of(name: &str, stated: impl IntoIterator<Item = Option<String>>) -> String {
    let stated: Vec<String> = stated.into_iter().flatten().collect();
    format!("{} = {{ {} }}\n", key(name), stated.join(", "))
}

fn unit(unit: &Unit) -> Option<String> {
    (!unit.is_one()).then(|| format!("unit = {}", quoted(&unit.symbol)))
}

/// A model as the case has it: several lines stay lines.
fn model_text(model: &str) -> String {
    if model.contains('\n') {
        format!("'''\n{model}'''")
    } else {
        quoted(model)
    }
}

/// The path of a file that the case names, wherever the improved case is put.
fn path(case: &Case, file: &str) -> String {
    let joined = case.path.with_file_name(file);
    let full = std::fs::canonicalize(&joined).unwrap_or(joined);
    quoted(&full.display().to_string())
}

fn averaging(case: &Case, diagnosis: &Diagnosis) -> String {
    // Spread blocks are chosen by the columns again.
    if case.averaging.blocks == Blocks::Auto {
        return "\"auto\"".to_owned();
    }
    let rows: usize = diagnosis.blocks.iter().map(Vec::len).sum();
    if rows == diagnosis.blocks.len() {
        "\"none\"".to_owned()
    } else {
        diagnosis.blocks.len().to_string()
    }
}

fn entry(column: &Column, case: &Case, step: Option<f64>) -> String {
    let role = match column.role {
        Role::Uncertainty => "u",
        other => other.word(),
    };
    let heading = (!is_found_by_name(column, case)).then(|| heading(column, &case.units));
    let stated = [
        ("u", column.u),
        ("u_common", column.u_common),
        ("full_scale", column.full_scale),
        ("resolution", step.or(column.resolution)),
    ];
    let stated = stated.map(|(key, stated)| stated.map(|value| format!("{key} = {value:e}")));
    let heading = heading.map(|heading| format!("column = {}", quoted(&heading)));
    let others: Vec<String> = std::iter::once(heading).chain(stated).flatten().collect();
    match others.as_slice() {
        [] => format!("\"{role}\""),
        others => format!("{{ role = \"{role}\", {} }}", others.join(", ")),
    }
}

/// Whether the first line of the recording calls a column, and no other, as the model does.
fn is_found_by_name(column: &Column, case: &Case) -> bool {
    let headers = case.columns.iter().map(|other| &other.header);
    let names = headers.map(|header| Heading::read(header, &case.units).name);
    let headed = Heading::read(&column.header, &case.units).name;
    headed == column.name && names.filter(|name| *name == headed).count() == 1
}

fn constants(case: &Case) -> String {
    let line = |constant: &Symbol| {
        let value = match &constant.role {
            SymbolRole::Constant(value) => format!("value = {value:e}"),
            SymbolRole::ConstantVector(values) => {
                let list: Vec<String> = values.iter().map(|value| format!("{value:e}")).collect();
                format!("values = [{}]", list.join(", "))
            }
            _ => return None,
        };
        Some(entry_of(
            &constant.name,
            [Some(value), unit(&constant.unit)],
        ))
    };
    let lines: String = case.constants.iter().filter_map(line).collect();
    match lines.is_empty() {
        true => lines,
        false => format!("\n[constant]\n{lines}"),
    }
}

/// The text of the recording at rest, which goes with the improved case.
fn at_rest(case: &Case) -> Option<String> {
    let NoiseClaim::AtRest { file, .. } = &case.noise else {
        return None;
    };
    let path = case.path.parent()?.join(file);
    text_of(Files::Disk, &path, file).ok()
}

/// The step of the numbers of each output whose rounding is a part of a stated noise: as it is stated, or as the readings show it.
fn steps(case: &Case, found: &Claimed) -> Vec<Option<f64>> {
    let NoiseClaim::Stated { steps, .. } = &case.noise else {
        return vec![None; case.responses.len()];
    };
    let seen = |at: usize| found.rounding.as_ref()?.steps[at];
    let of = steps.iter().enumerate();
    of.map(|(at, step)| step.or_else(|| seen(at))).collect()
}

/// The claim about the noise, and the settings; `at_rest` is the text of the recording at rest that is
/// written beside.
fn claims(case: &Case, at_rest: Option<&str>) -> String {
    let noise = match &case.noise {
        NoiseClaim::Stated {
            origin: Origin::Budget(file),
            ..
        } => format!("\n[noise]\nbudget = {}\n", path(case, file)),
        NoiseClaim::Stated {
            u,
            dof,
            walk,
            steps,
            ..
        } => {
            // Resolutions stand beside their outputs.
            let own = |u: &f64| (u * u - steps[0].map_or(0.0, u_of_step).powi(2)).sqrt();
            let mut lines = (u.first()).map_or(String::new(), |u| format!("u = {:e}\n", own(u)));
            if dof.is_finite() {
                lines += &format!("dof = {dof}\n");
            }
            if let Some(walk) = walk.first().filter(|walk| **walk > 0.0) {
                lines += &format!("walk = {walk:e}\n");
            }
            format!("\n[noise]\n{lines}")
        }
        NoiseClaim::Replicates(columns) => {
            let names = columns.iter().map(|c| &case.columns[*c].name);
            format!("\n[noise]\nreplicates = [{}]\n", list(names))
        }
        NoiseClaim::AtRest { file, column, .. } => {
            let file = at_rest.map_or_else(|| path(case, file), |_| quoted(AT_REST));
            let column = column.as_ref();
            let column = column.map_or(String::new(), |c| format!(", column = {}", quoted(c)));
            format!("\n[noise]\nat_rest = {{ file = {file}{column} }}\n")
        }
        NoiseClaim::Estimated | NoiseClaim::PerRow { .. } => String::new(),
    };
    let mut settings = format!(
        "alpha = {}\nseed = {}\ndraws = {}\n",
        case.settings.alpha, case.settings.seed, case.settings.draws
    );
    if let Some(catalogue) = &case.settings.catalogue {
        settings += &format!("catalogue = [{}]\n", list(catalogue));
    }
    if !case.settings.exclude.is_empty() {
        settings += &format!("exclude = [{}]\n", list(&case.settings.exclude));
    }
    for (id, share) in &case.settings.typical {
        settings += &format!("typical.{id} = {share:e}\n");
    }
    format!("{noise}\n[diagnosis]\n{settings}")
}

/// Quoted words, as in a list.
fn list<'w>(words: impl IntoIterator<Item = &'w String>) -> String {
    let words = words.into_iter().map(|word| quoted(word));
    words.collect::<Vec<String>>().join(", ")
}
