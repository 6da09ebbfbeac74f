//! What stands at the head of a certificate, in every format.

use gumption_format::document::{Administration, Attachment, Block, Contact, Document, Item};

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
    let head = fields(given, &document);
    let signature = document.words("Signature", "签字");
    let behind_statement = |block: &Block| matches!(block, Block::Statement(_));
    let behind_statement = document.blocks().iter().position(behind_statement);
    if let (Some(at), Some(signs)) = (behind_statement, given.persons.first()) {
        let line = "_".repeat(SIGNATURE);
        let line = format!("{line}  {}", signs.name);
        document.edit(|blocks| blocks.insert(at + 1, Block::Fields(vec![(signature, line)])));
    }
    let behind_title = usize::from(matches!(document.blocks().first(), Some(Block::Title(_))));
    document.edit(|blocks| blocks.insert(behind_title, Block::Fields(head)));
    document
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
        let text = format!("{}: {}", document.told(&condition.name), condition.text);
        add("Condition", "环境条件", Some(text));
    }
    add("Issued", "签发日期", given.issued.clone());
    add("Next calibration", "下次校准日期", given.due.clone());
    for person in &given.persons {
        let role = person.role.as_ref().map(|role| document.told(role));
        let text = role.map_or(person.name.clone(), |role| {
            format!("{}, {role}", person.name)
        });
        add("Responsible", "责任人", Some(text));
    }
    fields
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
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
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
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}
