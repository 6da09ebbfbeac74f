//! The improved model as files: a case with the new terms, and the recording with the columns that they
//! need.

use super::Diagnosis;
use super::case::{Case, Data, Role};
use super::simulate::recorded;

/// Name of the recording beside the improved case.
pub const RECORDING: &str = "recording.csv";

/// The improved case and its recording; nothing if no effect was adopted.
pub fn improved(case: &Case, diagnosis: &Diagnosis) -> Option<(String, String)> {
    let adopted = diagnosis.adopted.as_ref()?;
    let extended = &adopted.extended.case;
    let mut text = String::new();
    text += &format!(
        "title = {}\n",
        quoted(&format!("{} (improved)", case.title))
    );
    if let Some(reference) = &case.reference {
        text += &format!("reference = {}\n", quoted(reference));
    }
    text += &format!(
        "recording = {{ file = {}, average = {} }}\n",
        quoted(RECORDING),
        averaging(diagnosis)
    );
    let models: Vec<String> = extended.model.iter().map(|model| quoted(model)).collect();
    text += &match models.as_slice() {
        [one] => format!("model = {one}\n"),
        several => format!("model = [\n    {},\n]\n", several.join(",\n    ")),
    };
    text += "\n[columns]\n";
    for column in &extended.columns {
        if matches!(column.data, Data::Absent) {
            continue;
        }
        let addition = adopted
            .extended
            .additions
            .iter()
            .find(|addition| addition.column == column.name);
        let remark = addition.map_or(String::new(), |addition| format!("  # {}", addition.text));
        text += &format!("{} = {}{remark}\n", key(&column.name), entry(column));
    }
    text += "\n[parameter]\n";
    let values = adopted.unknowns.iter().chain(&adopted.coefficients);
    for parameter in &extended.parameters {
        let of = values.clone().find(|value| {
            value.name == parameter.name || value.name.starts_with(&format!("{}[", parameter.name))
        });
        let start = of.map_or(1.0, |value| value.value);
        let mut parts = vec![format!("start = {start:e}")];
        if !parameter.unit.is_one() {
            parts.push(format!("unit = {}", quoted(&parameter.unit.symbol)));
        }
        if let Some(per) = parameter.per {
            parts.push(format!("per = {}", quoted(&extended.columns[per].name)));
        }
        if let Some((value, u)) = parameter.prior {
            parts.push(format!("value = {value:e}, u = {u:e}"));
        }
        text += &format!("{} = {{ {} }}\n", key(&parameter.name), parts.join(", "));
    }
    text += &constants(case);
    text += &claims(case);
    Some((text, recorded(extended).csv()))
}

fn quoted(text: &str) -> String {
    if text.contains('\n') {
        return format!("'''\n{text}'''");
    }
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

fn key(name: &str) -> String {
    let bare = name
        .chars()
        .all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    if bare { name.to_owned() } else { quoted(name) }
}

fn averaging(diagnosis: &Diagnosis) -> String {
    let rows: usize = diagnosis.blocks.iter().map(Vec::len).sum();
    if rows == diagnosis.blocks.len() {
        "\"none\"".to_owned()
    } else {
        diagnosis.blocks.len().to_string()
    }
}

fn entry(column: &super::case::Column) -> String {
    let role = match column.role {
        Role::Uncertainty => "u",
        other => other.word(),
    };
    let mut parts = vec![format!("role = \"{role}\"")];
    if let Some(u) = column.u {
        parts.push(format!("u = {u:e}"));
    }
    if let Some(u) = column.u_common {
        parts.push(format!("u_common = {u:e}"));
    }
    if parts.len() == 1 {
        format!("\"{role}\"")
    } else {
        format!("{{ {} }}", parts.join(", "))
    }
}

fn constants(case: &Case) -> String {
    use crate::model::Role as SymbolRole;
    let mut text = String::new();
    for constant in &case.constants {
        if text.is_empty() {
            text += "\n[constant]\n";
        }
        let value = match &constant.role {
            SymbolRole::Constant(value) => format!("value = {value:e}"),
            SymbolRole::ConstantVector(values) => {
                let list: Vec<String> = values.iter().map(|value| format!("{value:e}")).collect();
                format!("values = [{}]", list.join(", "))
            }
            _ => continue,
        };
        let unit = if constant.unit.is_one() {
            String::new()
        } else {
            format!(", unit = {}", quoted(&constant.unit.symbol))
        };
        text += &format!("{} = {{ {value}{unit} }}\n", key(&constant.name));
    }
    text
}

/// The claim about the noise, and the settings.
fn claims(case: &Case) -> String {
    use super::case::NoiseClaim;
    let noise = match &case.noise {
        NoiseClaim::Stated { u, dof, .. } => {
            let dof = if dof.is_finite() {
                format!("\ndof = {dof}")
            } else {
                String::new()
            };
            u.first()
                .map_or(String::new(), |u| format!("\n[noise]\nu = {u:e}{dof}\n"))
        }
        NoiseClaim::Replicates(columns) => {
            let names: Vec<String> = columns
                .iter()
                .map(|c| quoted(&case.columns[*c].name))
                .collect();
            format!("\n[noise]\nreplicates = [{}]\n", names.join(", "))
        }
        NoiseClaim::AtRest { file, .. } => {
            format!("\n[noise]\nat_rest = {{ file = {} }}\n", quoted(file))
        }
        NoiseClaim::Estimated | NoiseClaim::PerRow(_) => String::new(),
    };
    format!(
        "{noise}\n[diagnosis]\nalpha = {}\nseed = {}\n",
        case.settings.alpha, case.settings.seed
    )
}
