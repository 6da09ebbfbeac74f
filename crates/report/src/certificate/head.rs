//! What stands at the head of a certificate, in every format.

use gumption_fault::language::Language;
use gumption_fault::{Said, say};
use gumption_format::document::{
    Administration, Attachment, Block, Certificate, Condition, Contact, Document, Finding, Item,
    Severity,
};

/// The document of an evaluation as that of a certificate: its number, dates, laboratory, customer and items stand first,
/// and a digital certificate can be written of it, with these files in it.
#[must_use]
pub fn certified(
    mut document: Document,
    given: &Administration,
    attachments: Vec<Attachment>,
) -> Document {
    let Some(certificate) = document.certificate.as_mut() else {
        return document;
    };
    certificate.administration = Some(given.clone());
    certificate.attachments = attachments;
    let doubts = doubts(certificate, given);
    let head = fields(given, &document);
    let signature = document.words("Signature", "签字");
    let item_only = document.words(
        "The results relate only to the item described above, as it was when it was calibrated.",
        "校准结果仅与上述被校对象校准时的状态有关。",
    );
    let behind_statement = |block: &Block| matches!(block, Block::Statement(_));
    let behind_statement = document.blocks().iter().position(behind_statement);
    if let (Some(at), Some(signs)) = (behind_statement, given.persons.first()) {
        let line = "_".repeat(SIGNATURE);
        let line = format!("{line}  {}", signs.name);
        let signature = Block::Fields(vec![(signature, line)]);
        document.edit(|blocks| {
            blocks.splice(at + 1..at + 1, [Block::Paragraph(item_only), signature]);
        });
    }
    let title = document.words("Calibration certificate", "校准证书");
    let subject = document.words("Calibration", "校准项目");
    document.edit(|blocks| {
        // The title of a certificate says that it is one (ISO/IEC 17025, 7.8.2.1 a); that of the budget, what was calibrated.
        let of_budget = match blocks.first() {
            Some(Block::Title(text)) => Some((subject, text.clone())),
            _ => None,
        };
        let told = usize::from(of_budget.is_some());
        let head = of_budget.into_iter().chain(head).collect();
        let doubts = (!doubts.is_empty()).then_some(Block::Findings(doubts));
        let first = [Block::Title(title), Block::Fields(head)];
        blocks.splice(..told, first.into_iter().chain(doubts));
    });
    document
}

/// Dates of the budget that do not fit the days of the measurement, in each language of the certificate.
fn doubts(certificate: &Certificate, given: &Administration) -> Vec<Finding> {
    let [begin, end] = &given.performed;
    let day = |date: &str| date.get(..10).unwrap_or(date).to_owned();
    let expired = certificate
        .references
        .iter()
        .filter(|one| day(&one.due) < *end);
    let expired = expired.map(|one| {
        let (of, due) = (&one.of, &one.due);
        let name = one.number.as_deref().unwrap_or(of);
        let said = say!("The certificate {name} of {of} was due on {due}, before the measurement of this certificate ended on {end}.");
        ("expired_reference", said)
    });
    let measured = certificate.measured.as_deref().map(day);
    let other = measured.filter(|measured| measured < begin || measured > end);
    let other = other.map(|measured| {
        let said =
            say!("The budget was measured on {measured}, this certificate says {begin} to {end}.");
        ("other_date", said)
    });
    let all: Vec<(&str, Said)> = expired.chain(other).collect();
    let told = all.iter().flat_map(|(id, said)| {
        certificate.languages.iter().map(|language| Finding {
            id: (*id).to_owned(),
            severity: Severity::Warning,
            language: *language,
            text: said.in_language(*language),
        })
    });
    told.collect()
}

/// Letters that a signature takes.
const SIGNATURE: usize = 28;

fn fields(given: &Administration, document: &Document) -> Vec<(String, String)> {
    let mut fields = Vec::new();
    let mut add = |english: &'static str, chinese: &'static str, text: Option<String>| {
        let text = text.filter(|text| !text.is_empty());
        fields.extend(text.map(|text| (document.words(english, chinese), text)));
    };
    add("Certificate", "证书编号", Some(given.number.clone()));
    let laboratory = contact(&given.laboratory, document);
    let code = given
        .code
        .as_ref()
        .map(|code| format!("{laboratory} ({code})"));
    add("Laboratory", "实验室", Some(code.unwrap_or(laboratory)));
    add(
        "Customer",
        "委托方",
        Some(contact(&given.customer, document)),
    );
    for one in &given.items {
        add("Item", "被校对象", Some(item(one, document)));
    }
    add("Received", "接收日期", given.received.clone());
    let [begin, end] = &given.performed;
    let days = match begin == end {
        true => begin.clone(),
        false => format!("{begin} – {end}"),
    };
    add("Measured", "测量日期", Some(days));
    let place = match given.place.as_str() {
        "laboratory" => document.words("laboratory", "实验室"),
        "customer" => document.words("customer's premises", "委托方现场"),
        "laboratoryBranch" => document.words("branch of the laboratory", "实验室分支机构"),
        "customerBranch" => document.words("branch of the customer", "委托方分支机构"),
        _ => document.words("elsewhere", "其他地点"),
    };
    add("Place", "测量地点", Some(place));
    for condition in &given.conditions {
        add("Condition", "环境条件", Some(stated(condition, document)));
    }
    add("Issued", "签发日期", given.issued.clone());
    add("Next calibration", "下次校准日期", given.due.clone());
    for person in &given.persons {
        let role = person.role.as_ref().map(|role| document.told(role));
        let text = role.map_or(person.name.clone(), |role| {
            [person.name.as_str(), &role].join(punctuated(document).comma())
        });
        add("Responsible", "责任人", Some(text));
    }
    fields
}

/// The language of what is punctuated: English marks stand between words of two languages.
fn punctuated(document: &Document) -> Language {
    document
        .other
        .map_or(document.language, |_| Language::English)
}

/// A condition with its uncertainty, k and p.
fn stated(condition: &Condition, document: &Document) -> String {
    let l = punctuated(document);
    let text = condition.text.join(l.comma());
    l.with_head(&document.told(&condition.name), &text)
}

fn contact(contact: &Contact, document: &Document) -> String {
    let town = [contact.post_code.as_deref(), contact.city.as_deref()];
    let town: Vec<&str> = town.into_iter().flatten().collect();
    let town = (!town.is_empty()).then(|| town.join(" "));
    let parts = [
        Some(document.told(&contact.name)),
        contact.street.clone(),
        town,
        contact.country.clone(),
    ];
    parts
        .into_iter()
        .flatten()
        .collect::<Vec<_>>()
        .join(punctuated(document).comma())
}

fn item(item: &Item, document: &Document) -> String {
    let numbered = |english: &str, chinese: &str, number: &Option<String>| {
        let number = number.as_ref()?;
        Some(format!("{} {number}", document.words(english, chinese)))
    };
    let parts = [
        Some(document.told(&item.name)),
        item.manufacturer.clone(),
        item.model.clone(),
        numbered("serial number", "出厂编号", &item.serial),
        numbered("customer's number", "委托方编号", &item.customer_number),
        numbered("laboratory's number", "实验室编号", &item.laboratory_number),
    ];
    parts
        .into_iter()
        .flatten()
        .collect::<Vec<_>>()
        .join(punctuated(document).comma())
}
