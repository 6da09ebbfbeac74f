//! `[series]`: the same budget for a table of values.

use crate::budget::faults::{SERIES, UNKNOWN_NAME};
use crate::budget::table::Stated;
use crate::budget::tables::{ClaimTable, FileTable, ProcessTable, SeriesTable};
use crate::budget::values::{Amount, Cell, Named, OneOrMany};
use crate::budget::variants::Amounts;
use crate::fault::{Fault, nearest};

/// One evaluation: the file with the values of a row in place.
pub(super) struct Variant {
    pub label: Option<String>,
    pub file: FileTable,
}

/// What a column sets.
#[derive(Clone)]
enum Column {
    Label,
    Input(usize),
    Constant(usize),
    /// The standard uncertainty of an input.
    Uncertainty(usize),
    /// A number of the first conformity assessment.
    Conformity(&'static str),
    /// A figure of the first claim.
    Figure(String),
    Claim(String),
}

/// Numbers of a conformity assessment that a column may set.
const CONFORMITY_KEYS: [&str; 7] = [
    "lower",
    "upper",
    "guard_band",
    "guard_band_factor",
    "conformance_probability",
    "nonconformance_probability",
    "in_tolerance_probability",
];

/// Numbers of a claim that a column may set.
const CLAIM_KEYS: [&str; 6] = ["value", "u", "U", "k", "p", "dof"];

/// The files to evaluate: the file itself, or one for each row of its series.
pub(super) fn variants(file: &FileTable, faults: &mut Vec<Fault>) -> Vec<Variant> {
    let alone = || {
        vec![Variant {
            label: None,
            file: file.clone(),
        }]
    };
    let Some(stated) = &file.series else {
        return alone();
    };
    let before = faults.len();
    let variants = from_rows(file, &stated.value, stated, faults);
    // With a faulty series the file itself is still checked.
    if faults.len() > before || variants.is_empty() {
        alone()
    } else {
        variants
    }
}

fn from_rows(
    file: &FileTable,
    table: &SeriesTable,
    stated: &Stated<SeriesTable>,
    faults: &mut Vec<Fault>,
) -> Vec<Variant> {
    let (Some(columns), Some(rows)) = (&table.columns, &table.rows) else {
        if !table.refused {
            let missing = if table.columns.is_none() {
                "columns"
            } else {
                "rows"
            };
            faults.push(
                Fault::new(
                    SERIES,
                    stated.span.clone(),
                    format!("the series has no `{missing}`"),
                )
                .label(format!("`{missing}` is missing")),
            );
        }
        return Vec::new();
    };
    let kinds: Vec<Option<Column>> = columns
        .value
        .iter()
        .map(|name| column(file, name, faults))
        .collect();
    if rows.value.is_empty() {
        faults.push(
            Fault::new(SERIES, rows.span.clone(), "the series has no rows")
                .label("nothing to evaluate"),
        );
    }
    let mut variants = Vec::new();
    for row in &rows.value {
        if row.value.len() != kinds.len() {
            faults.push(
                Fault::new(
                    SERIES,
                    row.span.clone(),
                    format!(
                        "a row of {} entries for {} columns",
                        row.value.len(),
                        kinds.len()
                    ),
                )
                .label(format!("expected {} entries", kinds.len()))
                .related(columns.span.clone(), "the columns"),
            );
            continue;
        }
        let mut variant = Variant {
            label: None,
            file: file.clone(),
        };
        for (kind, cell) in kinds.iter().zip(&row.value) {
            if let Some(kind) = kind {
                set(&mut variant, kind, cell, faults);
            }
        }
        variants.push(variant);
    }
    variants
}

fn column(file: &FileTable, name: &Stated<String>, faults: &mut Vec<Fault>) -> Option<Column> {
    let inputs: Vec<&str> = super::entries(&file.input)
        .iter()
        .map(|(name, _)| name.as_str())
        .collect();
    let constants: Vec<&str> = super::entries(&file.constant)
        .iter()
        .map(|(name, _)| name.as_str())
        .collect();
    let wanted = name.value.as_str();
    if wanted == "label" {
        return Some(Column::Label);
    }
    if let Some(key) = wanted
        .strip_prefix("claim.")
        .filter(|key| CLAIM_KEYS.contains(key))
    {
        return Some(Column::Claim(key.to_string()));
    }
    if let Some(figure) = wanted.strip_prefix("claim.figures.") {
        return Some(Column::Figure(figure.to_string()));
    }
    let key = wanted.strip_prefix("conformity.");
    if let Some(key) = key.and_then(|key| CONFORMITY_KEYS.into_iter().find(|known| *known == key)) {
        if file.conformity.is_none() {
            faults.push(
                Fault::new(SERIES, name.span.clone(), "the file has no [conformity]")
                    .label("nothing to set"),
            );
            return None;
        }
        return Some(Column::Conformity(key));
    }
    let of_input = wanted.strip_suffix(".u");
    if let Some(index) = of_input.and_then(|name| inputs.iter().position(|input| *input == name)) {
        return Some(Column::Uncertainty(index));
    }
    if let Some(index) = inputs.iter().position(|input| *input == wanted) {
        if let Some(values) = super::entries(&file.input)
            .get(index)
            .and_then(|(_, entry)| entry.value.values.as_ref())
        {
            faults.push(
                Fault::new(SERIES, name.span.clone(), format!("{wanted} is a vector"))
                    .label("a column sets one number")
                    .related(values.key.clone(), "its values"),
            );
            return None;
        }
        return Some(Column::Input(index));
    }
    if let Some(index) = constants.iter().position(|constant| *constant == wanted) {
        return Some(Column::Constant(index));
    }
    let claims: Vec<String> = CLAIM_KEYS
        .iter()
        .map(|key| format!("claim.{key}"))
        .collect();
    let known = inputs
        .iter()
        .chain(&constants)
        .copied()
        .chain(["label"])
        .chain(claims.iter().map(String::as_str));
    let fault = Fault::new(
        UNKNOWN_NAME,
        name.span.clone(),
        format!("no input or constant is called {wanted}"),
    )
    .label("unknown column");
    faults.push(match nearest(wanted, known) {
        Some(near) => fault.help(format!("did you mean \"{near}\"?")),
        None => fault.help(
            "columns are inputs (`X`), their standard uncertainties (`X.u`), constants, `label`, numbers of the claim such as `claim.value`, or of the conformity assessment such as `conformity.upper`",
        ),
    });
    None
}

fn set(variant: &mut Variant, column: &Column, cell: &Stated<Cell>, faults: &mut Vec<Fault>) {
    let number = match (&cell.value, column) {
        (Cell::Text(text), Column::Label) => {
            variant.label = Some(text.clone());
            return;
        }
        (Cell::Number(number), Column::Label) => {
            variant.label = Some(number.to_string());
            return;
        }
        (Cell::Number(number), _) => *number,
        (Cell::Text(text), _) => {
            faults.push(
                Fault::new(
                    SERIES,
                    cell.span.clone(),
                    format!("the text {text:?} where a number is expected"),
                )
                .label("expected a number in the unit of the input"),
            );
            return;
        }
    };
    let amount = Some(cell.map(|_| Amount { number, unit: None }));
    match column {
        Column::Label => {}
        Column::Input(index) => {
            if let Some((_, entry)) = variant
                .file
                .input
                .as_mut()
                .and_then(|inputs| inputs.value.entries.get_mut(*index))
            {
                entry.value.value = amount;
            }
        }
        Column::Constant(index) => {
            let constant = variant
                .file
                .constant
                .as_mut()
                .and_then(|constants| constants.value.entries.get_mut(*index));
            if let Some((_, entry)) = constant {
                entry.value.0.value = amount;
            }
        }
        Column::Uncertainty(index) => {
            let inputs = variant.file.input.as_mut();
            let entry = inputs.and_then(|inputs| inputs.value.entries.get_mut(*index));
            if let Some((_, entry)) = entry {
                let component = &mut entry.value.component;
                component.u = amount.map(|amount| amount.map(|a| Amounts::One(a.clone())));
                component.present.retain(|(key, _)| *key != "u");
                component.present.push(("u", cell.span.clone()));
            }
        }
        Column::Conformity(key) => set_conformity(&mut variant.file, key, number, cell),
        Column::Figure(name) => {
            let claim = first_claim(&mut variant.file, cell);
            let figures = claim.figures.get_or_insert_with(|| {
                cell.map(|_| Named {
                    entries: Vec::new(),
                    refused: false,
                })
            });
            figures.value.entries.retain(|(known, _)| known != name);
            figures
                .value
                .entries
                .push((name.clone(), cell.map(|_| number)));
            claim.present.push(("figures", cell.span.clone()));
        }
        Column::Claim(key) => set_claim(&mut variant.file, key, number, cell),
    }
}

/// Sets a number of the first conformity assessment.
fn set_conformity(file: &mut FileTable, key: &str, number: f64, cell: &Stated<Cell>) {
    let tables = file.conformity.as_mut();
    let Some(table) = tables.and_then(|all| all.value.0.first_mut()) else {
        return;
    };
    let table = &mut table.value;
    let amount = Some(cell.map(|_| Amount { number, unit: None }));
    let plain = Some(cell.map(|_| number));
    let known = CONFORMITY_KEYS.iter().find(|known| **known == key);
    match key {
        "lower" => table.lower = amount,
        "upper" => table.upper = amount,
        "guard_band" => table.guard_band = amount,
        "guard_band_factor" => table.guard_band_factor = plain,
        "conformance_probability" => table.conformance_probability = plain,
        "nonconformance_probability" => table.nonconformance_probability = plain,
        _ => {
            let process = table
                .process
                .get_or_insert_with(|| cell.map(|_| ProcessTable::default()));
            process.value.in_tolerance_probability = plain;
        }
    }
    table.present.extend(known.map(|key| (*key, cell.span.clone())));
}

/// The first claim, which is added where there is none.
fn first_claim<'f>(file: &'f mut FileTable, cell: &Stated<Cell>) -> &'f mut ClaimTable {
    let claims = file
        .claim
        .get_or_insert_with(|| cell.map(|_| OneOrMany(Vec::new())));
    if claims.value.0.is_empty() {
        claims.value.0.push(cell.map(|_| ClaimTable::default()));
    }
    &mut claims.value.0[0].value
}

/// Sets a number of the first claim.
fn set_claim(file: &mut FileTable, key: &str, number: f64, cell: &Stated<Cell>) {
    let claim = first_claim(file, cell);
    let amount = Some(cell.map(|_| Amount { number, unit: None }));
    let plain = Some(cell.map(|_| number));
    let key = match key {
        "value" => {
            claim.value = amount;
            "value"
        }
        "u" => {
            claim.u = amount;
            "u"
        }
        "U" => {
            claim.U = amount;
            "U"
        }
        "k" => {
            claim.k = plain;
            "k"
        }
        "p" => {
            claim.p = plain;
            "p"
        }
        _ => {
            claim.dof = plain;
            "dof"
        }
    };
    claim.present.push((key, cell.span.clone()));
}
