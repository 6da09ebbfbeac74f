//! A certificate, read as a whole.

use gumption_fault::{Fault, say};
use roxmltree::{Document, Node};

use super::quantity::{Value, values};
use super::validity::{Validity, validity};
use super::xml::{Faults, at, child, children, fault, numbers, text};
use crate::budget::faults::DIGITAL_CERTIFICATE;

/// What a certificate says.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct DigitalCertificate {
    /// Its number.
    pub number: Option<String>,
    /// Who issued it.
    pub laboratory: Option<String>,
    /// Last day of the measurement.
    pub date: Option<String>,
    /// The number of the certificate that it replaces.
    pub replaces: Option<String>,
    /// Until when it is to be used.
    pub validity: Validity,
    /// Its quantities, in the order of the file.
    pub quantities: Vec<Quantity>,
}

/// A quantity among the results.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Quantity {
    /// Its own names: identifier, name in every language.
    pub names: Vec<String>,
    /// The names of the result that it belongs to.
    pub of: Vec<String>,
    /// Whether it is what was found, and not a setting or reference beside it.
    pub measured: bool,
    /// The names of its points, where there are more.
    pub labels: Vec<String>,
    /// Its points.
    pub values: Vec<Value>,
    /// ν_eff, one for each point or none.
    pub freedom: Vec<Option<f64>>,
}

/// Reads a certificate.
///
/// # Errors
/// All faults, at their places in the text.
pub(super) fn read(content: &str) -> Result<DigitalCertificate, Faults> {
    let document = Document::parse(content).map_err(|error| {
        let position = error.pos();
        let start: usize = content
            .split_inclusive('\n')
            .take(position.row.saturating_sub(1) as usize)
            .map(str::len)
            .sum();
        let error = error.to_string();
        let message = say!("the file is not well-formed XML: {error}");
        vec![Fault::new(DIGITAL_CERTIFICATE, start..start, message)]
    })?;
    let root = document.root_element();
    if root.tag_name().name() != "digitalCalibrationCertificate" {
        let name = root.tag_name().name();
        let start = root.range().start;
        let message = say!(
            "a digital calibration certificate begins with digitalCalibrationCertificate, not with {name}"
        );
        return Err(vec![Fault::new(
            DIGITAL_CERTIFICATE,
            start..start + 1,
            message,
        )]);
    }
    let version = root.attribute("schemaVersion").unwrap_or_default();
    if !(version.starts_with("2.") || version.starts_with("3.")) {
        let start = root.range().start;
        let message =
            say!("the version `{version}` of the certificate is not known: 2.x and 3.x are");
        return Err(vec![Fault::new(
            DIGITAL_CERTIFICATE,
            start..start + 1,
            message,
        )]);
    }
    let mut faults = Faults::new();
    let mut quantities = Vec::new();
    for measured in root
        .descendants()
        .filter(|node| node.tag_name().name() == "result")
    {
        let of = names(measured);
        if let Some(data) = child(measured, "data") {
            within(data, &of, &mut quantities, &mut faults);
        }
    }
    if quantities.is_empty() && faults.is_empty() {
        faults.push(fault(
            root,
            say!("the certificate has no result with a number"),
        ));
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    let core = at(root, &["administrativeData", "coreData"]);
    let of_core = |path: &[&'static str]| {
        let words = text(at(core?, path)?);
        (!words.is_empty()).then(|| words.to_owned())
    };
    let laboratory = [
        "administrativeData",
        "calibrationLaboratory",
        "contact",
        "name",
    ];
    let date = of_core(&["endPerformanceDate"]).or_else(|| of_core(&["issueDate"]));
    let administration = child(root, "administrativeData");
    let validity = administration.map(|all| validity(all, date.as_deref()));
    Ok(DigitalCertificate {
        number: of_core(&["uniqueIdentifier"]),
        laboratory: at(root, &laboratory)
            .and_then(|name| Some(text(child(name, "content")?).to_owned())),
        date,
        validity: validity.unwrap_or_default(),
        replaces: of_core(&["reportAmendedSubstituted", "replacedUniqueIdentifier"]),
        quantities,
    })
}

/// The identifier and the names of an element in every language.
fn names(node: Node<'_, '_>) -> Vec<String> {
    let identifier = node.attribute("id").map(str::to_owned);
    let told = child(node, "name").into_iter();
    let told = told.flat_map(|name| children(name, "content"));
    let told = told.map(|content| text(content).to_owned());
    identifier.into_iter().chain(told).collect()
}

/// The quantities of data, and of lists in it.
fn within(data: Node<'_, '_>, of: &[String], found: &mut Vec<Quantity>, faults: &mut Faults) {
    let named = labels(data);
    for quantity in children(data, "quantity") {
        let values = values(quantity, faults);
        if values.is_empty() {
            continue;
        }
        let refers = quantity.attribute("refType").unwrap_or_default();
        let own = child(quantity, "realListXMLList").and_then(|list| child(list, "labelXMLList"));
        let own = own.map(words).filter(|own| own.len() == values.len());
        let labels = own.or_else(|| named.clone().filter(|all| all.len() == values.len()));
        found.push(Quantity {
            names: names(quantity),
            of: of.to_vec(),
            measured: refers
                .split_ascii_whitespace()
                .any(|one| matches!(one, "basic_measuredValue" | "basic_measurementError")),
            labels: labels.unwrap_or_default(),
            freedom: freedom(quantity, values.len(), faults),
            values,
        });
    }
    for list in children(data, "list") {
        let mut all = of.to_vec();
        all.extend(names(list));
        within(list, &all, found, faults);
    }
}

/// What the points of a list are called: by the texts beside its values, else by their nominal or reference values.
fn labels(data: Node<'_, '_>) -> Option<Vec<String>> {
    let texts: Vec<String> = children(data, "quantity")
        .filter_map(|quantity| child(quantity, "charsXMLList"))
        .flat_map(words)
        .collect();
    if !texts.is_empty() {
        return Some(texts);
    }
    let kinds = ["basic_nominalValue", "basic_referenceValue"].into_iter();
    let mut settings = kinds.filter_map(|kind| {
        let is_of = |quantity: &Node<'_, '_>| {
            let refers = quantity.attribute("refType").unwrap_or_default();
            refers.split_ascii_whitespace().any(|one| one == kind)
        };
        children(data, "quantity").find(is_of)
    });
    // Their faults are told where they are read as quantities.
    let settings = values(settings.next()?, &mut Faults::new()).into_iter();
    let label = |one: Value| match one.unit.is_one() {
        true => one.value.to_string(),
        false => format!("{} {}", one.value, one.unit.symbol),
    };
    Some(settings.map(label).collect())
}

/// The words of a list; a space that no line breaks at stands for one inside of them.
fn words(list: Node<'_, '_>) -> Vec<String> {
    let words = text(list).split_ascii_whitespace();
    words.map(|word| word.replace('\u{a0}', " ")).collect()
}

/// ν_eff, where a certificate states it beside the quantity.
fn freedom(quantity: Node<'_, '_>, points: usize, faults: &mut Faults) -> Vec<Option<f64>> {
    let stated = child(quantity, "measurementMetaData").into_iter();
    let mut stated = stated
        .flat_map(|all| children(all, "metaData"))
        .filter(|one| {
            let refers = one.attribute("refType").unwrap_or_default();
            refers.to_ascii_lowercase().contains("degreesoffreedom")
        });
    let Some(quantity) = stated.next().and_then(|one| at(one, &["data", "quantity"])) else {
        return Vec::new();
    };
    let list = at(quantity, &["real", "value"])
        .or_else(|| at(quantity, &["realListXMLList", "valueXMLList"]));
    let all = list.map(|list| numbers(list, faults));
    all.filter(|all| all.len() == points).unwrap_or_default()
}
