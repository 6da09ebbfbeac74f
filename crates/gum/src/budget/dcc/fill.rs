//! `certificate = { dcc = "ref.xml", result = "…" }`: the keys that the certificate states are filled in, at the place of
//! the name of its file, before anything is checked.

use std::path::Path;

use gumption_core::quantity::Unit;
use gumption_fault::{Fault, Rejection, Said, say};
use gumption_format::toml::faults::UNREADABLE_FILE;
use gumption_format::toml::{Amount, Date, Dof, Stated};

use super::certificate::{DigitalCertificate, read};
use super::choice::{Chosen, choose};
use crate::budget::faults::{DIGITAL_CERTIFICATE, FROM_REFUSED, TWO_WAYS};
use crate::budget::open_files::OpenFiles;
use crate::budget::tables::{CertificateTable, ComponentTable, FileTable, InputTable};

/// What was found in the certificates that a file names.
#[derive(Debug, Default)]
pub(in crate::budget) struct Found {
    pub faults: Vec<Fault>,
    pub remarks: Vec<Said>,
}

/// Fills in what the certificates say.
pub(in crate::budget) fn fill(
    file: &mut FileTable,
    files: &OpenFiles<'_>,
    directory: &Path,
) -> Found {
    let mut filling = Filling {
        files,
        directory,
        date: file.date.as_ref().map(|date| date.value.0.clone()),
        found: Found::default(),
    };
    let inputs = file
        .input
        .iter_mut()
        .flat_map(|stated| &mut stated.value.entries);
    for (name, input) in inputs {
        filling.input(name, &mut input.value);
    }
    let sources = file
        .source
        .iter_mut()
        .flat_map(|stated| &mut stated.value.0.entries);
    for (name, source) in sources {
        let own = std::iter::once(&mut source.value.component);
        let more = source
            .value
            .components
            .iter_mut()
            .flat_map(|list| &mut list.value);
        for component in own.chain(more.map(|one| &mut one.value)) {
            filling.component(name, component);
        }
    }
    filling.found
}

struct Filling<'a> {
    files: &'a OpenFiles<'a>,
    /// Folder of the budget.
    directory: &'a Path,
    /// Date of the measurement.
    date: Option<String>,
    found: Found,
}

impl Filling<'_> {
    /// An input takes value and unit from the certificate as well, where it states none.
    fn input(&mut self, name: &str, input: &mut InputTable) {
        let mut chosen = self.component(name, &mut input.component);
        for component in input.components.iter_mut().flat_map(|list| &mut list.value) {
            let of_component = self.component(name, &mut component.value);
            chosen = chosen.or(of_component);
        }
        let Some((file, chosen)) = chosen else {
            return;
        };
        let Chosen { value, .. } = chosen;
        if input.unit.is_none()
            && input
                .value
                .as_ref()
                .is_none_or(|stated| stated.value.unit.is_none())
        {
            input.unit = Some(Box::new(file.map(|_| value.unit.symbol.clone())));
            input.present.push(("unit", file.key.clone()));
        }
        if input.value.is_none() && input.values.is_none() {
            input.value = Some(Box::new(
                file.map(|_| amount(value.value, &value.unit, &file)),
            ));
            input.present.push(("value", file.key.clone()));
        }
    }

    /// Fills in U, k, p, ν, number, laboratory, date and the end of its use.
    fn component(
        &mut self,
        owner: &str,
        component: &mut ComponentTable,
    ) -> Option<(Stated<String>, Chosen)> {
        let table = &mut component.certificate.as_mut()?.value;
        let file = table.dcc.clone()?;
        if let Some(stated) = &table.U {
            let message = say!(
                "U is stated, and comes from the certificate {}, too",
                file.value
            );
            let fault = Fault::new(TWO_WAYS, stated.key.clone(), message);
            self.found
                .faults
                .push(fault.help(say!("leave out `U`, or `dcc`")));
            return None;
        }
        let certificate = self.certificate(&file)?;
        let chosen = match choose(&certificate, &file, table) {
            Ok(chosen) => chosen,
            Err(fault) => {
                self.found.faults.push(*fault);
                return None;
            }
        };
        let Some(uncertainty) = chosen.value.uncertainty else {
            let message = say!("this result of {} has no uncertainty", file.value);
            let fault = Fault::new(DIGITAL_CERTIFICATE, file.span.clone(), message);
            self.found.faults.push(fault);
            return None;
        };
        let difference = chosen.value.unit.difference();
        table.U = Some(Box::new(
            file.map(|_| amount(uncertainty.expanded, &difference, &file)),
        ));
        table.present.push(("U", file.key.clone()));
        // k is what leads back to u; p without it, with ν where the certificate has it.
        match (uncertainty.k, uncertainty.p) {
            (Some(k), _) if table.k.is_none() && table.p.is_none() => {
                table.k = Some(Box::new(file.map(|_| k)));
            }
            (None, Some(p)) if table.k.is_none() && table.p.is_none() => {
                table.p = Some(Box::new(file.map(|_| p)));
            }
            _ => {}
        }
        if let (None, Some(freedom)) = (&table.dof, chosen.freedom) {
            table.dof = Some(Box::new(file.map(|_| Dof(freedom))));
        }
        self.identity(owner, table, &file, &certificate);
        Some((*file, chosen))
    }

    /// Number, laboratory, date and end of use; what the budget states otherwise is remarked on, as the file may have been exchanged.
    fn identity(
        &mut self,
        owner: &str,
        table: &mut CertificateTable,
        file: &Stated<String>,
        certificate: &DigitalCertificate,
    ) {
        let name = &file.value;
        let keys = [
            (say!("number"), &mut table.number, &certificate.number),
            (
                say!("laboratory"),
                &mut table.laboratory,
                &certificate.laboratory,
            ),
        ];
        for (key, stated, found) in keys {
            match (stated.as_ref().map(|stated| stated.value.clone()), found) {
                (Some(stated), Some(found)) if stated != *found => self.found.remarks.push(say!("The certificate of {owner} in {name} has the {key} {found}, where the budget states {stated}: it was exchanged, or is another one.")),
                (None, Some(found)) => *stated = Some(Box::new(file.map(|_| found.clone()))),
                _ => {}
            }
        }
        match (
            table.date.as_ref().map(|date| date.value.0.clone()),
            &certificate.date,
        ) {
            (Some(stated), Some(found)) if stated.get(..10) != found.get(..10) => {
                self.found.remarks.push(say!("The certificate of {owner} in {name} is of {found}, where the budget states {stated}: it was exchanged, or is another one."));
            }
            (None, Some(found)) => table.date = Some(Box::new(file.map(|_| Date(found.clone())))),
            _ => {}
        }
        // Whether that day is past is looked at where the other certificates are.
        if let (None, Some(until)) = (&table.due, &certificate.validity.until) {
            table.due = Some(Box::new(file.map(|_| Date(until.to_string()))));
        }
        for statement in &certificate.validity.refused {
            self.found.remarks.push(say!(
                "The certificate of {owner} in {name} marks a statement as not valid: {statement}."
            ));
        }
        if let (Some(measured), Some(certified)) = (&self.date, &certificate.date)
            && measured.get(..10) < certified.get(..10)
        {
            self.found.remarks.push(say!("The certificate of {owner} in {name} is of {certified}, after the measurement on {measured}."));
        }
        if let Some(replaced) = &certificate.replaces
            && table
                .number
                .as_ref()
                .is_some_and(|number| number.value == *replaced)
        {
            self.found.remarks.push(say!(
                "The certificate {replaced} of {owner} was replaced by the one in {name}."
            ));
        }
    }

    /// Reads a certificate; its faults are told under its own lines.
    fn certificate(&mut self, file: &Stated<String>) -> Option<DigitalCertificate> {
        let name = &file.value;
        let path = self.directory.join(name);
        let bytes = match self.files.files.read(&path) {
            Ok(bytes) => bytes,
            Err(error) => {
                let message = say!("the certificate {name} cannot be read: {error}");
                let fault = Fault::new(UNREADABLE_FILE, file.span.clone(), message);
                self.found.faults.push(fault.label(say!("named here")));
                return None;
            }
        };
        let content = String::from_utf8_lossy(&bytes).into_owned();
        match read(&content) {
            Ok(certificate) => Some(certificate),
            Err(faults) => {
                let shown = path.display().to_string();
                self.files.refused(Rejection::new(&shown, &content, faults));
                let message = say!("{name} has faults itself");
                let fault = Fault::new(FROM_REFUSED, file.span.clone(), message);
                let fault = fault.label(say!("cannot be used as it is"));
                self.found
                    .faults
                    .push(fault.help(say!("its faults are listed after those of this file")));
                None
            }
        }
    }
}

/// An amount in a unit, at the place of the file's name.
fn amount(number: f64, unit: &Unit, file: &Stated<String>) -> Amount {
    Amount {
        number,
        unit: (!unit.is_one()).then(|| (unit.symbol.clone(), file.span.clone())),
    }
}
