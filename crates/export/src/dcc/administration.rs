//! Administrative data: who certified what for whom.

use gumption_fault::language::Language;
use gumption_format::document::{Administration, Certificate, Contact, Item, Told};

use super::{code, tidy, told, words};
use crate::xml::{self, Element, text};

pub(super) fn element(certificate: &Certificate, given: &Administration) -> Element {
    xml::element("dcc:administrativeData")
        .with(software())
        .with(core(certificate, given))
        .with(xml::element("dcc:items").with_all(given.items.iter().map(item)))
        .with(
            xml::element("dcc:calibrationLaboratory")
                .with_all(
                    given
                        .code
                        .iter()
                        .map(|code| tidy("dcc:calibrationLaboratoryCode", code)),
                )
                .with(contact("dcc:contact", &given.laboratory)),
        )
        .with(persons(certificate, given))
        .with(contact("dcc:customer", &given.customer))
        .with_all(statements(certificate, given))
}

/// The program, with its version as others compare them.
fn software() -> Element {
    let name = Told::everywhere("gumption");
    xml::element("dcc:dccSoftware").with(
        xml::element("dcc:software")
            .with(told("dcc:name", &name))
            .with(text("dcc:release", concat!("v", env!("CARGO_PKG_VERSION"))))
            .with(text("dcc:type", "application")),
    )
}

fn core(certificate: &Certificate, given: &Administration) -> Element {
    let languages = &certificate.languages;
    let used = |name: &'static str, all: &[Language]| {
        let all: Vec<Element> = all.iter().map(|one| text(name, code(*one))).collect();
        all
    };
    let date = |name: &'static str, date: &Option<String>| {
        date.iter()
            .map(|date| text(name, date.as_str()))
            .collect::<Vec<_>>()
    };
    let [begin, end] = &given.performed;
    xml::element("dcc:coreData")
        .with(text("dcc:countryCodeISO3166_1", given.country.as_str()))
        .with_all(used("dcc:usedLangCodeISO639_1", languages))
        .with_all(used(
            "dcc:mandatoryLangCodeISO639_1",
            &languages[..languages.len().min(1)],
        ))
        .with(tidy("dcc:uniqueIdentifier", &given.number))
        .with_all(date("dcc:receiptDate", &given.received))
        .with(text("dcc:beginPerformanceDate", begin.as_str()))
        .with(text("dcc:endPerformanceDate", end.as_str()))
        .with(text("dcc:performanceLocation", given.place.as_str()))
        .with_all(date("dcc:issueDate", &given.issued))
}

fn item(item: &Item) -> Element {
    let maker = item.manufacturer.iter().map(|maker| {
        xml::element("dcc:manufacturer").with(told("dcc:name", &Told::everywhere(maker)))
    });
    let numbers = [
        ("manufacturer", &item.serial),
        ("customer", &item.customer_number),
        ("calibrationLaboratory", &item.laboratory_number),
    ];
    let numbers = numbers.into_iter().filter_map(|(issuer, number)| {
        let number = number.as_deref()?;
        Some(
            xml::element("dcc:identification")
                .with(text("dcc:issuer", issuer))
                .with(tidy("dcc:value", number)),
        )
    });
    xml::element("dcc:item")
        .with(told("dcc:name", &item.name))
        .with_all(maker)
        .with_all(item.model.iter().map(|model| tidy("dcc:model", model)))
        .with(xml::element("dcc:identifications").with_all(numbers))
}

fn contact(name: &'static str, contact: &Contact) -> Element {
    let maybe = |name: &'static str, words: &Option<String>| {
        words
            .iter()
            .map(|words| tidy(name, words))
            .collect::<Vec<_>>()
    };
    let mut place: Vec<Element> = Vec::new();
    place.extend(maybe("dcc:street", &contact.street));
    place.extend(maybe("dcc:postCode", &contact.post_code));
    place.extend(maybe("dcc:city", &contact.city));
    place.extend(maybe("dcc:countryCode", &contact.country));
    xml::element(name)
        .with(told("dcc:name", &contact.name))
        .with_all(maybe("dcc:eMail", &contact.email))
        .with_all(maybe("dcc:phone", &contact.phone))
        .with(xml::element("dcc:location").with_all(place))
}

fn persons(certificate: &Certificate, given: &Administration) -> Element {
    let binding = certificate.languages.first().copied().unwrap_or_default();
    let persons = given.persons.iter().enumerate().map(|(at, person)| {
        let name = Told::everywhere(&person.name);
        // A role is one text in this schema: in the language that is binding.
        let role = person.role.iter().map(|role| role.text(binding));
        xml::element("dcc:respPerson")
            .with(xml::element("dcc:person").with(told("dcc:name", &name)))
            .with_all(role.map(|role| tidy("dcc:role", role)))
            .with(text(
                "dcc:mainSigner",
                if at == 0 { "true" } else { "false" },
            ))
    });
    xml::element("dcc:respPersons").with_all(persons)
}

/// What holds for all results: how the uncertainty was evaluated and is stated; when the next calibration is due.
fn statements(certificate: &Certificate, given: &Administration) -> Option<Element> {
    let named = |english, chinese| {
        let name = words(certificate, "dcc:name", english, chinese);
        xml::element("dcc:statement").with(name)
    };
    let declaration =
        |sentence| xml::element("dcc:statement").with(told("dcc:declaration", sentence));
    let mut all: Vec<Element> = certificate.statement.iter().map(declaration).collect();
    if !all.is_empty() {
        let first = named(
            "Statement of the results and their uncertainty",
            "结果及其不确定度的说明",
        );
        let guide = Some(certificate.guide.as_str()).filter(|guide| !guide.is_empty());
        all.insert(
            0,
            first.with_all(guide.map(|guide| tidy("dcc:norm", guide))),
        );
    }
    all.extend(given.due.as_ref().map(|due| {
        named("Next calibration", "下次校准日期")
            .attribute("refType", "gumption_nextCalibration")
            .with(text("dcc:date", due.as_str()))
    }));
    (!all.is_empty()).then(|| xml::element("dcc:statements").with_all(all))
}
