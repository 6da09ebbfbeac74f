//! The file with the data of a certificate, checked.

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::Path;

use gumption_core::quantity::UnitTable;
use gumption_fault::language::Language;
use gumption_fault::{Fault, Rejection, Said, say};
use gumption_format::document::{Administration, Condition, Contact, Item, Person, Told};
use gumption_format::files::Files;
use gumption_format::toml::faults::{UNKNOWN_WORD, UNREADABLE_FILE};
use gumption_format::toml::{
    Amount, Date, FromToml, KeyRow, Slot, Stated, Table, decoded, tables_of,
};
use gumption_gum::budget::faults::{MISSING_KEY, NOT_POSITIVE, PROBABILITY, UNIT, UNUSED};

use serde_json::{Value, json};

use super::number::Notation;
use super::tables::{
    CertificateFile, ConditionTable, ContactTable, HINTS, ItemTable, LaboratoryTable, PersonTable,
    PlaceWord, needed,
};
use crate::figures::with_unit;
use crate::number::{exact, probability};
use crate::symbol;

/// Reads the data of a certificate.
///
/// # Errors
/// The file cannot be read, or has faults: all of them.
pub fn administration(files: Files<'_>, path: &Path) -> Result<Administration, Rejection> {
    let name = path.display().to_string();
    let bytes = files.read(path).map_err(|error| {
        let fault = Fault::new(
            UNREADABLE_FILE,
            0..0,
            say!("{name} cannot be read: {error}"),
        );
        Rejection::new(&name, "", vec![fault])
    })?;
    let text = decoded(bytes, path)?;
    checked(&name, text.strip_prefix('\u{feff}').unwrap_or(&text))
}

/// Which names of [`certificate_template`] nobody has replaced.
pub fn template_names(given: &Administration) -> Option<Said> {
    let template = checked("template.toml", &certificate_template(Language::English)).ok()?;
    let own = names(given);
    let kept = names(&template)
        .into_iter()
        .filter(|name| own.contains(name));
    let tables: BTreeSet<String> = kept.map(|(table, _)| format!("`{table}`")).collect();
    let tables = tables.into_iter().collect::<Vec<_>>().join(", ");
    (!tables.is_empty()).then(|| {
        say!("the names under {tables} are still those of the template: put in the right ones before anybody signs")
    })
}

/// Who answers for a certificate, who receives it, and what was calibrated, each with its table.
fn names(given: &Administration) -> Vec<(&'static str, &str)> {
    let contacts = [
        ("laboratory", &given.laboratory.name),
        ("customer", &given.customer.name),
    ];
    let items = given.items.iter().map(|item| ("item", &item.name));
    let told = contacts.into_iter().chain(items).flat_map(|(table, told)| {
        let texts = told.0.iter().map(|(_, text)| text.as_str());
        texts.map(move |text| (table, text))
    });
    let signs = given
        .persons
        .iter()
        .map(|one| ("person", one.name.as_str()));
    told.chain(signs).collect()
}

/// The data in a text.
fn checked(name: &str, text: &str) -> Result<Administration, Rejection> {
    let refused = |faults| Rejection::new(name, text, faults);
    let (file, faults) =
        tables_of::<CertificateFile>(text, "the data of a certificate", &HINTS, UNUSED)
            .map_err(refused)?;
    let mut check = Check {
        text,
        faults,
        units: UnitTable::default(),
        present: file.present.iter().map(|(key, _)| *key).collect(),
    };
    let administration = check.whole(&file, text.len());
    match check.faults.is_empty() {
        true => Ok(administration),
        false => Err(refused(check.faults)),
    }
}

/// JSON Schema of the data of a certificate, for editors.
pub fn certificate_schema() -> Value {
    let mut schema = CertificateFile::schema();
    if let Value::Object(entries) = &mut schema {
        let draft = "http://json-schema.org/draft-07/schema#";
        entries.insert("$schema".into(), json!(draft));
        entries.insert("title".into(), json!("gumption data of a certificate"));
    }
    schema
}

/// Every key of the data of a certificate, with its table.
pub fn certificate_keys() -> Vec<KeyRow> {
    let mut rows = Vec::new();
    CertificateFile::rows("", &mut rows);
    rows
}

/// The data of a certificate to fill in, with comments in this language; the data are the same.
pub fn certificate_template(language: Language) -> String {
    let text = language.pick(
        include_str!("template.toml"),
        include_str!("template.zh.toml"),
    );
    text.to_string()
}

/// Where the keys above all tables stand.
const TOP: Range<usize> = 0..0;

/// Collects faults while the tables are checked.
struct Check<'t> {
    text: &'t str,
    faults: Vec<Fault>,
    units: UnitTable,
    /// The keys that the file states, also those of which the value was refused: these are not missing.
    present: Vec<&'static str>,
}

impl Check<'_> {
    fn whole(&mut self, file: &CertificateFile, end: usize) -> Administration {
        let end = end..end;
        let begin = self.day(&file.begin);
        let last = match &file.end {
            None => begin.clone(),
            stated => self.day(stated),
        };
        if file.begin.is_none() && !file.refused {
            self.missing("begin", "", TOP);
        }
        if let (Some(first), Some(stated)) = (&begin, &file.end)
            && last.as_ref().is_some_and(|last| last < first)
        {
            let message = say!("the measurement ends before it begins");
            let fault = Fault::new(MISSING_KEY, stated.span.clone(), message);
            self.faults.push(fault.label(say!("begun on {first}")));
        }
        let received = self.day(&file.received);
        if let (Some(received), Some(stated)) = (&received, &file.received)
            && last.as_ref().is_some_and(|last| received > last)
        {
            let message = say!("the item is received after it was measured");
            self.contradicts(stated.span.clone(), message, last.as_deref());
        }
        let issued = self.day(&file.issued);
        if let (Some(issued), Some(stated)) = (&issued, &file.issued)
            && last.as_ref().is_some_and(|last| issued < last)
        {
            let message = say!("the certificate is issued before the measurement has ended");
            self.contradicts(stated.span.clone(), message, last.as_deref());
        }
        let due = self.day(&file.due);
        if let (Some(last), Some(stated)) = (&last, &file.due)
            && due.as_ref().is_some_and(|due| due <= last)
        {
            let message = say!("the next calibration is due before this one has ended");
            self.contradicts(stated.span.clone(), message, Some(last));
        }
        let laboratory = self.stated(&file.laboratory, "laboratory", &end);
        let customer = self.stated(&file.customer, "customer", &end);
        let items = self.stated(&file.item, "item", &end);
        let persons = self.stated(&file.person, "person", &end);
        let number = self.text(&file.number, "number", "", &TOP);
        let contact = laboratory.map(|table| &table.contact);
        let contact = contact.map(|table| self.contact(table, "laboratory", &end));
        let contact = contact.unwrap_or_default();
        Administration {
            number,
            country: contact.country.clone().unwrap_or_default(),
            received,
            performed: [begin.unwrap_or_default(), last.unwrap_or_default()],
            place: match file.place.as_ref().map(|word| word.value) {
                None | Some(PlaceWord::Laboratory) => "laboratory",
                Some(PlaceWord::Customer) => "customer",
                Some(PlaceWord::LaboratoryBranch) => "laboratoryBranch",
                Some(PlaceWord::CustomerBranch) => "customerBranch",
                Some(PlaceWord::Other) => "other",
            }
            .to_owned(),
            issued,
            due,
            code: laboratory.and_then(|table: &LaboratoryTable| text(&table.code)),
            laboratory: contact,
            customer: customer
                .map(|table| self.contact(table, "customer", &end))
                .unwrap_or_default(),
            items: all(items).map(|one| self.item(one)).collect(),
            persons: all(persons).map(|one| self.person(one)).collect(),
            conditions: all(file.condition.as_ref().map(|list| &list.value))
                .filter_map(|one| self.condition(one))
                .collect(),
        }
    }

    /// A date that does not fit the last day of the measurement.
    fn contradicts(&mut self, place: Range<usize>, message: Said, last: Option<&str>) {
        let last = last.unwrap_or_default();
        let fault = Fault::new(MISSING_KEY, place, message);
        self.faults.push(fault.label(say!("ended on {last}")));
    }

    fn missing(&mut self, key: &str, table: &str, place: Range<usize>) {
        let fault = Fault::new(MISSING_KEY, place.clone(), needed(key, table));
        let fault = fault.label(say!("`{key}` is missing"));
        self.faults.push(match place == TOP {
            true => fault.help(say!("write it above the first header: {key} = \"…\"")),
            false => fault,
        });
    }

    /// What has to be stated.
    fn stated<'t, T>(
        &mut self,
        stated: &'t Slot<T>,
        key: &str,
        end: &Range<usize>,
    ) -> Option<&'t T> {
        if stated.is_none() && !self.present.contains(&key) {
            self.missing(key, "", end.clone());
        }
        stated.as_ref().map(|stated| &stated.value)
    }

    /// A text that has to be there.
    fn text(
        &mut self,
        stated: &Slot<String>,
        key: &str,
        table: &str,
        place: &Range<usize>,
    ) -> String {
        let words = text(stated);
        if words.is_none() {
            let place = stated.as_ref().map_or(place, |stated| &stated.span);
            self.missing(key, table, place.clone());
        }
        words.unwrap_or_default()
    }

    fn day(&mut self, date: &Slot<Date>) -> Option<String> {
        let date = date.as_ref()?;
        date.value.0.get(..10).map(str::to_owned)
    }

    fn contact(&mut self, table: &ContactTable, of: &str, end: &Range<usize>) -> Contact {
        let place = table
            .present
            .first()
            .map_or(end.clone(), |(_, place)| place.clone());
        let contact = Contact {
            name: self.named(&table.name, &table.name_zh, of, &place),
            street: text(&table.street),
            post_code: text(&table.post_code),
            city: text(&table.city),
            country: text(&table.country),
            email: text(&table.email),
            phone: text(&table.phone),
        };
        match (&contact.country, &table.country) {
            (Some(code), Some(stated))
                if code.len() != 2 || !code.bytes().all(|b| b.is_ascii_uppercase()) =>
            {
                let message = say!("`{code}` is not the code of a country");
                let fault = Fault::new(UNKNOWN_WORD, stated.span.clone(), message);
                self.faults.push(fault.label(say!(
                    "expected two capital letters, such as CN or DE (ISO 3166-1)"
                )));
            }
            (None, _) => self.missing("country", of, place),
            _ => {}
        }
        contact
    }

    /// A name in one or two languages.
    fn named(
        &mut self,
        name: &Slot<String>,
        chinese: &Slot<String>,
        of: &str,
        place: &Range<usize>,
    ) -> Told {
        match (text(name), text(chinese)) {
            (Some(one), None) => Told::everywhere(one),
            (None, Some(chinese)) => Told::in_language(Language::Chinese, chinese),
            (Some(english), Some(chinese)) => Told(vec![
                (Some(Language::English), english),
                (Some(Language::Chinese), chinese),
            ]),
            (None, None) => {
                self.missing("name", of, place.clone());
                Told::default()
            }
        }
    }

    fn item(&mut self, stated: &Stated<ItemTable>) -> Item {
        let table = &stated.value;
        let item = Item {
            name: self.named(&table.name, &table.name_zh, "item", &stated.span),
            manufacturer: text(&table.manufacturer),
            model: text(&table.model),
            serial: text(&table.serial),
            customer_number: text(&table.customer_number),
            laboratory_number: text(&table.laboratory_number),
        };
        let numbers = [&item.serial, &item.customer_number, &item.laboratory_number];
        if numbers.iter().all(|number| number.is_none()) && !table.refused {
            let message = say!("nothing tells this item from others of its kind");
            let fault = Fault::new(MISSING_KEY, stated.span.clone(), message);
            self.faults.push(fault.help(say!(
                "add `serial`, `customer_number` or `laboratory_number`"
            )));
        }
        item
    }

    fn person(&mut self, stated: &Stated<PersonTable>) -> Person {
        let table = &stated.value;
        let role = match (text(&table.role), text(&table.role_zh)) {
            (None, None) => None,
            _ => Some(self.named(&table.role, &table.role_zh, "person", &stated.span)),
        };
        Person {
            name: self.text(&table.name, "name", "person", &stated.span),
            role,
        }
    }

    /// A number with the zeros at its end that the file has: `20.0 °C`.
    fn as_written(&self, number: f64, place: &Range<usize>) -> String {
        let written = self.text.get(place.clone()).unwrap_or_default();
        let behind = written.split_once('.').map_or("", |(_, behind)| behind);
        let decimals = behind.chars().take_while(char::is_ascii_digit).count();
        let aligned = format!("{number:.decimals$}");
        match aligned.parse() == Ok(number) {
            true => aligned,
            false => exact(number),
        }
    }

    fn condition(&mut self, stated: &Stated<ConditionTable>) -> Option<Condition> {
        let table = &stated.value;
        let name = self.named(&table.name, &table.name_zh, "condition", &stated.span);
        let Some(value) = &table.value else {
            if !table.refused {
                self.missing("value", "condition", stated.span.clone());
            }
            return None;
        };
        let (number, unit) = self.amount(value)?;
        let notation = Notation::of(&unit)?;
        let shown = with_unit(&self.as_written(number, &value.span), &symbol(&unit));
        let expanded = match &table.U {
            None => None,
            Some(expanded) => {
                let of_unit = expanded.value.unit.is_some();
                let (size, own) = self.amount(expanded)?;
                let own = if of_unit { own } else { unit.difference() };
                let Some(conversion) = own.difference().conversion_to(&unit.difference()) else {
                    let message = say!("the unit {} of `U` does not fit the value", own.symbol);
                    self.faults
                        .push(Fault::new(UNIT, expanded.span.clone(), message));
                    return None;
                };
                let size = size * conversion.factor;
                if size < 0.0 {
                    let message = say!("an expanded uncertainty below zero");
                    self.faults
                        .push(Fault::new(NOT_POSITIVE, expanded.span.clone(), message));
                }
                Some(size)
            }
        };
        let k = table.k.as_ref().map_or(2.0, |k| k.value);
        if let Some(stated) = table.k.as_ref().filter(|k| k.value < 1.0) {
            let message = say!("a coverage factor of {k}: certificates state k ≥ 1");
            self.faults
                .push(Fault::new(NOT_POSITIVE, stated.span.clone(), message));
        }
        if let Some(stated) = table
            .p
            .as_ref()
            .filter(|p| !(p.value > 0.0 && p.value < 1.0))
        {
            let message = say!("a probability of {}", stated.value);
            let fault = Fault::new(PROBABILITY, stated.span.clone(), message);
            self.faults
                .push(fault.label(say!("expected a number between 0 and 1")));
        }
        Some(Condition {
            name,
            text: match expanded {
                None => vec![shown],
                Some(size) => {
                    let stated = table.U.as_ref().map_or(0..0, |stated| stated.span.clone());
                    let size = self.as_written(size, &stated);
                    let size = with_unit(&size, &symbol(&unit.difference()));
                    let p = table
                        .p
                        .as_ref()
                        .map(|p| format!("p = {}", probability(p.value)));
                    let beside = [format!("U = {size}"), format!("k = {}", exact(k))];
                    std::iter::once(shown).chain(beside).chain(p).collect()
                }
            },
            value: notation.value(number),
            unit: notation.unit.clone(),
            expanded: expanded.map(|size| {
                let p = table.p.as_ref().map(|p| notation.plain(p.value));
                [
                    notation.deviation(size),
                    notation.plain(k),
                    p.unwrap_or_default(),
                ]
            }),
        })
    }

    /// A number with its unit; one without is of unit one.
    fn amount(&mut self, stated: &Stated<Amount>) -> Option<(f64, gumption_core::quantity::Unit)> {
        let amount = &stated.value;
        let (unit, place) = match &amount.unit {
            Some((unit, place)) => (unit.as_str(), place.clone()),
            None => ("1", stated.span.clone()),
        };
        match self.units.parse(unit) {
            Ok(unit) => Some((amount.number, unit)),
            Err(error) => {
                self.faults.push(Fault::new(UNIT, place, error.message));
                None
            }
        }
    }
}

/// A text that is not empty.
fn text(stated: &Slot<String>) -> Option<String> {
    let words = stated.as_ref()?.value.trim();
    (!words.is_empty()).then(|| words.to_owned())
}

fn all<T>(list: Option<&Vec<Stated<T>>>) -> impl Iterator<Item = &Stated<T>> {
    list.into_iter().flatten()
}
