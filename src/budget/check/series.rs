//! `[series]`: the same budget for a table of values.

use crate::budget::faults::{SERIES, UNKNOWN_NAME};
use crate::budget::table::Stated;
use crate::budget::tables::{ClaimTable, FileTable, SeriesTable};
use crate::budget::values::{Amount, Cell, OneOrMany};
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
    Claim(String),
}

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
            "columns are inputs, constants, `label`, or numbers of the claim such as `claim.value`",
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
        Column::Claim(key) => set_claim(&mut variant.file, key, number, cell),
    }
}

/// Sets a number of the first claim, which is added where there is none.
fn set_claim(file: &mut FileTable, key: &str, number: f64, cell: &Stated<Cell>) {
    let claims = file
        .claim
        .get_or_insert_with(|| cell.map(|_| OneOrMany(Vec::new())));
    if claims.value.0.is_empty() {
        claims.value.0.push(cell.map(|_| ClaimTable::default()));
    }
    let Some(claim) = claims.value.0.first_mut().map(|claim| &mut claim.value) else {
        return;
    };
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
