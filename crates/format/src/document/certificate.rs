//! A certificate as data: what a digital calibration certificate is written from. Numbers are the figures of the blocks,
//! in the notation of machines; units are those of the D-SI.

use gumption_fault::harmless;
use gumption_fault::language::Language;

use super::Document;

/// A text, once in each language of the certificate; without a language where it is the same in all.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Told(pub Vec<(Option<Language>, String)>);

impl Told {
    /// A text in one language.
    pub fn in_language(language: Language, text: impl Into<String>) -> Self {
        Told(vec![(Some(language), text.into())])
    }

    /// A text that no language changes.
    pub fn everywhere(text: impl Into<String>) -> Self {
        Told(vec![(None, text.into())])
    }

    /// The text in a language, else in whichever it is told first.
    pub fn text(&self, language: Language) -> &str {
        let own = self.0.iter().find(|(of, _)| *of == Some(language));
        own.or(self.0.first()).map_or("", |(_, text)| text)
    }
}

impl Told {
    /// Keeps what is told in these languages; a text that is in others alone is kept as the only one that there is.
    fn keep(&mut self, languages: &[Language]) {
        let own = |of: &Option<Language>| of.is_none_or(|of| languages.contains(&of));
        match self.0.iter().any(|(of, _)| own(of)) {
            true => self.0.retain(|(of, _)| own(of)),
            false => {
                self.0.truncate(1);
                self.0.iter_mut().for_each(|(of, _)| *of = None);
            }
        }
    }
}

/// What is certified, and by whom.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Certificate {
    /// Languages, the first one binding.
    pub languages: Vec<Language>,
    /// Who certifies what for whom; a digital certificate has to have it.
    pub administration: Option<Administration>,
    /// What is measured.
    pub title: Told,
    /// The procedure.
    pub method: Option<Told>,
    /// The guides that the evaluation follows.
    pub guide: String,
    /// Sentences about all results.
    pub statement: Vec<Told>,
    /// Results, one for each measurand.
    pub results: Vec<Certified>,
    /// What joins several results of one point.
    pub region: Option<Region>,
    /// The day of the measurement that the budget states.
    pub measured: Option<String>,
    /// Certificates of what was used that are valid up to a day.
    pub references: Vec<Reference>,
    /// Files to be handed over with it.
    pub attachments: Vec<Attachment>,
}

/// A certificate of something that was used, valid up to a day.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Reference {
    /// Of which quantity.
    pub of: String,
    /// Its number.
    pub number: Option<String>,
    /// The day.
    pub due: String,
}

/// The results of one measurand at one point or several.
#[derive(Debug, Clone, PartialEq)]
pub struct Certified {
    /// Its name.
    pub name: String,
    /// What it is.
    pub description: Option<Told>,
    /// Unit of the values.
    pub unit: String,
    /// Unit of the uncertainties: kelvin for a Celsius temperature.
    pub deviation_unit: String,
    /// The points.
    pub points: Vec<CertifiedPoint>,
    /// Conformity, one for each item that is judged by the measurand.
    pub conformity: Vec<CertifiedConformity>,
}

/// One result.
#[derive(Debug, Clone, PartialEq)]
pub struct CertifiedPoint {
    /// Its row; empty where there is one point only.
    pub label: String,
    /// The value.
    pub value: String,
    /// How far it may be off.
    pub uncertainty: CertifiedUncertainty,
    /// ν that gave k.
    pub freedom: Option<String>,
}

/// An uncertainty in the forms of the D-SI. A probability or standard uncertainty that is not stated is `None`.
#[derive(Debug, Clone, PartialEq)]
pub enum CertifiedUncertainty {
    /// U = k·u.
    Expanded {
        /// U.
        expanded: String,
        /// k.
        k: String,
        /// p.
        p: Option<String>,
        /// What k was taken from.
        distribution: Option<String>,
    },
    /// An interval.
    Interval {
        /// u.
        standard: Option<String>,
        /// Its ends.
        ends: [String; 2],
        /// p.
        p: Option<String>,
    },
    /// None.
    None,
}

/// Conformity of an item at one point or at all of them.
#[derive(Debug, Clone, PartialEq)]
pub struct CertifiedConformity {
    /// The item.
    pub name: String,
    /// The point that it is about, where that is not all of them.
    pub point: Option<String>,
    /// Tolerance and decision rule.
    pub rule: Told,
    /// The verdict at each of these points; none where it is withheld.
    pub verdicts: Vec<CertifiedVerdict>,
}

/// A verdict in the words of ILAC-G8.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CertifiedVerdict {
    /// Conforming.
    Pass,
    /// Not conforming.
    Fail,
    /// Undecided, the value inside the tolerance.
    ConditionalPass,
    /// Undecided, the value outside of it.
    ConditionalFail,
}

/// Covariance of the results of one point, with the ellipsoid that covers them together.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    /// Columns of the covariance matrix: value and unit.
    pub columns: Vec<Vec<(String, String)>>,
    /// k of the ellipsoid.
    pub k: String,
    /// p of the ellipsoid.
    pub p: String,
}

/// A file.
#[derive(Debug, Clone, PartialEq)]
pub struct Attachment {
    /// Its name.
    pub name: String,
    /// Its media type (RFC 6838).
    pub media_type: &'static str,
    /// What it holds.
    pub content: Vec<u8>,
}

/// Who certifies what for whom.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Administration {
    /// Number of the certificate.
    pub number: String,
    /// Country whose laws hold (ISO 3166-1).
    pub country: String,
    /// Date of receipt of the item.
    pub received: Option<String>,
    /// First and last day of the measurement.
    pub performed: [String; 2],
    /// Where: `laboratory`, `customer`, `laboratoryBranch`, `customerBranch`, `other`.
    pub place: String,
    /// Date of issue.
    pub issued: Option<String>,
    /// Date of the next calibration.
    pub due: Option<String>,
    /// Code of the laboratory's accreditation.
    pub code: Option<String>,
    /// The laboratory.
    pub laboratory: Contact,
    /// The customer.
    pub customer: Contact,
    /// The items.
    pub items: Vec<Item>,
    /// The persons who answer for it; the first signs.
    pub persons: Vec<Person>,
    /// Conditions of the measurement.
    pub conditions: Vec<Condition>,
}

/// Somebody with an address.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Contact {
    /// Name.
    pub name: Told,
    /// Street and number.
    pub street: Option<String>,
    /// Postal code.
    pub post_code: Option<String>,
    /// Town.
    pub city: Option<String>,
    /// Country (ISO 3166-1).
    pub country: Option<String>,
    /// Address for mail.
    pub email: Option<String>,
    /// Telephone.
    pub phone: Option<String>,
}

/// Something that was measured.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Item {
    /// What it is.
    pub name: Told,
    /// Who made it.
    pub manufacturer: Option<String>,
    /// Its model.
    pub model: Option<String>,
    /// Serial number.
    pub serial: Option<String>,
    /// Number given by the customer.
    pub customer_number: Option<String>,
    /// Number given by the laboratory.
    pub laboratory_number: Option<String>,
}

/// Somebody who answers for the certificate.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Person {
    /// Name.
    pub name: String,
    /// Function.
    pub role: Option<Told>,
}

/// A condition of the measurement.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Condition {
    /// The quantity.
    pub name: Told,
    /// As people read it: the value, U, k and p.
    pub text: Vec<String>,
    /// Value.
    pub value: String,
    /// Unit.
    pub unit: String,
    /// U, and its k and p.
    pub expanded: Option<[String; 3]>,
}

impl Administration {
    /// With the texts of these languages.
    #[must_use]
    pub fn in_languages(mut self, languages: &[Language]) -> Self {
        let contacts = [&mut self.laboratory.name, &mut self.customer.name];
        let items = self.items.iter_mut().map(|item| &mut item.name);
        let roles = self
            .persons
            .iter_mut()
            .filter_map(|person| person.role.as_mut());
        let conditions = self.conditions.iter_mut().map(|one| &mut one.name);
        let all = contacts.into_iter().chain(items).chain(roles);
        all.chain(conditions).for_each(|told| told.keep(languages));
        self
    }
}

impl Certificate {
    /// Every text that is told in languages, in one order.
    fn told(&mut self) -> Vec<&mut Told> {
        let results = self.results.iter_mut().flat_map(|result| {
            let conformity = result.conformity.iter_mut().map(|one| &mut one.rule);
            result.description.iter_mut().chain(conformity)
        });
        let all = std::iter::once(&mut self.title).chain(&mut self.method);
        all.chain(&mut self.statement).chain(results).collect()
    }

    /// Tells the same in the languages of another one, too.
    pub(super) fn join(&mut self, mut other: Certificate) {
        self.languages.append(&mut other.languages);
        let (own, others) = (self.told(), other.told());
        if own.len() != others.len() {
            return;
        }
        for (own, other) in own.into_iter().zip(others) {
            let more = other.0.drain(..).filter(|told| !own.0.contains(told));
            let more: Vec<_> = more.collect();
            own.0.extend(more);
        }
    }
}

impl Document {
    /// With the data of a certificate.
    #[must_use]
    pub fn with_certificate(mut self, mut certificate: Certificate) -> Self {
        for (_, text) in certificate.told().into_iter().flat_map(|told| &mut told.0) {
            *text = harmless(text).into_owned();
        }
        self.certificate = Some(Box::new(certificate));
        self
    }
}
