//! Which result of a certificate is meant.

use gumption_fault::{Fault, Said, nearest, say};
use gumption_format::toml::Stated;

use super::certificate::{DigitalCertificate, Quantity};
use super::quantity::Value;
use crate::budget::faults::FROM_MEASURAND;
use crate::budget::tables::CertificateTable;

/// A point of a result.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Chosen {
    pub value: Value,
    pub freedom: Option<f64>,
}

/// The result that the table names, or the only one.
pub(super) fn choose(
    certificate: &DigitalCertificate,
    file: &Stated<String>,
    table: &CertificateTable,
) -> Result<Chosen, Box<Fault>> {
    let quantity = quantity(certificate, file, table.result.as_deref())?;
    let at = point(quantity, file, table)?;
    Ok(Chosen {
        value: quantity.values[at].clone(),
        freedom: quantity.freedom.get(at).copied().flatten(),
    })
}

fn quantity<'c>(
    certificate: &'c DigitalCertificate,
    file: &Stated<String>,
    wanted: Option<&Stated<String>>,
) -> Result<&'c Quantity, Box<Fault>> {
    let name = &file.value;
    let all = &certificate.quantities;
    let (mut found, place): (Vec<&Quantity>, _) = match wanted {
        None => (all.iter().collect(), file.span.clone()),
        Some(wanted) => {
            let is = |names: &[String]| names.contains(&wanted.value);
            let own: Vec<&Quantity> = all.iter().filter(|one| is(&one.names)).collect();
            let found = match own.is_empty() {
                true => all.iter().filter(|one| is(&one.of)).collect(),
                false => own,
            };
            (found, wanted.span.clone())
        }
    };
    if found.len() > 1 && found.iter().any(|one| one.measured) {
        found.retain(|one| one.measured);
    }
    let known: Vec<String> = all
        .iter()
        .flat_map(|one| one.of.iter().chain(&one.names))
        .cloned()
        .collect();
    match (found.as_slice(), wanted) {
        ([one], _) => Ok(one),
        ([], Some(wanted)) => {
            let near = nearest(&wanted.value, known.iter().map(String::as_str));
            let message = say!("{name} has no result \"{}\"", wanted.value);
            let fault = Fault::new(FROM_MEASURAND, place, message).label(say!("no such result"));
            Err(Box::new(match near {
                Some(near) => fault.help(say!("did you mean \"{near}\"?")),
                None => fault.help(say!("its results are {}", shown(&known))),
            }))
        }
        _ => {
            let message = say!("{name} has more than one such result");
            let fault = Fault::new(FROM_MEASURAND, place, message);
            let fault = fault.label(say!("which one is not said"));
            let help = say!("add result = \"…\", one of {}", shown(&known));
            Err(Box::new(fault.help(help)))
        }
    }
}

fn point(
    quantity: &Quantity,
    file: &Stated<String>,
    table: &CertificateTable,
) -> Result<usize, Box<Fault>> {
    let name = &file.value;
    match (&table.point, quantity.values.len()) {
        (None, 1) => Ok(0),
        (None, n) => {
            let message = say!("this result of {name} has {n} points");
            let fault = Fault::new(FROM_MEASURAND, file.span.clone(), message);
            Err(Box::new(match quantity.labels.is_empty() {
                true => fault.help(say!("add point = \"1\" … \"{n}\"")),
                false => fault.help(say!(
                    "add point = \"…\", one of {}",
                    shown(&quantity.labels)
                )),
            }))
        }
        (Some(point), n) => {
            let label = quantity
                .labels
                .iter()
                .position(|label| *label == point.value);
            let number = || {
                let number: usize = point.value.parse().ok()?;
                (1..=n).contains(&number).then(|| number - 1)
            };
            label.or_else(number).ok_or_else(|| {
                let message = say!("this result of {name} has no point \"{}\"", point.value);
                let fault = Fault::new(FROM_MEASURAND, point.span.clone(), message);
                Box::new(fault.label(say!("no such point")))
            })
        }
    }
}

/// The first names.
fn shown(names: &[String]) -> Said {
    /// More are read in the file itself.
    const MOST: usize = 8;
    let mut shown: Vec<String> = Vec::new();
    for name in names {
        let name = format!("\"{name}\"");
        if !shown.contains(&name) {
            shown.push(name);
        }
    }
    Said::first(&shown, MOST)
}
