//! The tables of the file with the data of a certificate.

use gumption_fault::{Said, say};
use gumption_format::toml::{Amount, Date, Hints, Stated, Table, table, words};

type List<T> = Vec<Stated<T>>;

table! {
    /// The data of a certificate: its number and dates, the laboratory, the customer, the item.
    CertificateFile "the data of a certificate" {
        /// Number of the certificate.
        number: String,
        /// Date of receipt of the item.
        received: Date,
        /// First day of the measurement.
        begin: Date,
        /// Last day of the measurement; the first one when left out.
        end: Date,
        /// Date of issue.
        issued: Date,
        /// Date of the next calibration, where it is agreed with the customer (ISO/IEC 17025, 7.8.4.3).
        due: Date,
        /// Where it was measured; in the laboratory when left out.
        place: PlaceWord,
        /// Who issues the certificate.
        laboratory: LaboratoryTable,
        /// For whom.
        customer: ContactTable,
        /// What was measured.
        item: List<ItemTable>,
        /// Who answers for it; the first one signs.
        person: List<PersonTable>,
        /// Conditions of the measurement.
        condition: List<ConditionTable>,
    }
}

words! {
    /// Where an item was measured.
    PlaceWord {
        /// In the laboratory.
        Laboratory "laboratory",
        /// At the customer's.
        Customer "customer",
        /// In a branch of the laboratory.
        LaboratoryBranch "laboratory branch",
        /// In a branch of the customer.
        CustomerBranch "customer branch",
        /// Elsewhere.
        Other "other",
    }
}

table! {
    /// Who issues the certificate.
    LaboratoryTable "laboratory" {
        /// Its number with the accreditation body.
        code: String,
        with contact: ContactTable
    }
}

table! {
    /// Somebody with an address.
    ContactTable "customer" {
        /// Name.
        name: String,
        /// The name in Chinese.
        name_zh: String,
        /// Street and number.
        street: String,
        /// Postal code.
        post_code: String,
        /// Town.
        city: String,
        /// Country, two letters: CN, DE.
        country: String,
        /// Address for mail.
        email: String,
        /// Telephone.
        phone: String,
    }
}

table! {
    /// What was measured.
    ItemTable "item" {
        /// What it is.
        name: String,
        /// The same in Chinese.
        name_zh: String,
        /// Who made it.
        manufacturer: String,
        /// Its model.
        model: String,
        /// Serial number.
        serial: String,
        /// Number given by the customer.
        customer_number: String,
        /// Number given by the laboratory.
        laboratory_number: String,
    }
}

table! {
    /// Who answers for the certificate.
    PersonTable "person" {
        /// Name.
        name: String,
        /// Function.
        role: String,
        /// Function in Chinese.
        role_zh: String,
    }
}

table! {
    /// A condition of the measurement.
    ConditionTable "condition" {
        /// The quantity.
        name: String,
        /// The same in Chinese.
        name_zh: String,
        /// Its value with unit: `"20.0 °C"`.
        value: Amount,
        /// Expanded uncertainty.
        U: Amount,
        /// Coverage factor of U; 2 when left out.
        k: f64,
        /// Coverage probability of U.
        p: f64,
    }
}

/// What is known of mistakes.
pub(super) static HINTS: Hints = Hints {
    whole: say!("the data of a certificate"),
    synonyms: &[
        ("nr", "number"),
        ("no", "number"),
        ("date", "begin"),
        ("client", "customer"),
        ("object", "item"),
        ("address", "street"),
        ("postcode", "post_code"),
        ("zip", "post_code"),
        ("town", "city"),
        ("serial_number", "serial"),
        ("mail", "email"),
    ],
    top: CertificateFile::keys,
    unknown_key: |_, _, _| -> Option<Said> { None },
    no_table: |_, _| -> Option<Said> { None },
    wrong_type: |_, _| None,
    list_of_amounts: say!("one number with its unit stands here"),
};

/// Said of a key that must be there.
pub(super) fn needed(key: &str, table: &str) -> Said {
    match table {
        "" => say!("the data of the certificate have no `{key}`"),
        table => say!("[{table}] has no `{key}`"),
    }
}
