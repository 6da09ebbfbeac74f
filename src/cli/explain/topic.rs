//! What can be explained, and in which section.

use gumption::fault::{Said, say};

use super::lines::wrapped;

/// One thing that can be explained.
pub(super) struct Topic {
    pub(super) section: Section,
    pub(super) name: String,
    pub(super) aliases: Vec<String>,
    /// What it is, in a few words.
    pub(super) title: String,
    pub(super) text: String,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Section {
    Concepts,
    Distributions,
    Functions,
    Profiles,
    Procedures,
    Effects,
    Slips,
    Rules,
    Keys,
    ExperimentKeys,
    CertificateKeys,
    Errors,
}

impl Section {
    pub(super) const ALL: [Section; 12] = [
        Section::Concepts,
        Section::Distributions,
        Section::Functions,
        Section::Profiles,
        Section::Procedures,
        Section::Effects,
        Section::Slips,
        Section::Rules,
        Section::Keys,
        Section::ExperimentKeys,
        Section::CertificateKeys,
        Section::Errors,
    ];

    /// The topic under which the whole section is listed.
    pub(super) fn name(self) -> &'static str {
        match self {
            Section::Concepts => "concepts",
            Section::Distributions => "distributions",
            Section::Functions => "functions",
            Section::Profiles => "profiles",
            Section::Procedures => "procedures",
            Section::Effects => "effects",
            Section::Slips => "slips",
            Section::Rules => "rules",
            Section::Keys => "keys",
            Section::ExperimentKeys => "experiment-keys",
            Section::CertificateKeys => "certificate-keys",
            Section::Errors => "errors",
        }
    }

    pub(super) fn title(self) -> Said {
        match self {
            Section::Concepts => say!("Concepts"),
            Section::Distributions => say!("Distributions"),
            Section::Functions => say!("Functions of the model language"),
            Section::Profiles => say!("Profiles"),
            Section::Procedures => say!("Procedures of the library"),
            Section::Effects => say!("Effects that a diagnosis can name"),
            Section::Slips => say!("Slips that an audit can name"),
            Section::Rules => say!("Rules that an audit checks"),
            Section::Keys => say!("Keys of a budget file"),
            Section::ExperimentKeys => say!("Keys of an experiment"),
            Section::CertificateKeys => say!("Keys of the data of a certificate"),
            Section::Errors => say!("Error codes"),
        }
    }

    /// Whether it is what experiments name, and budgets and certificates do not.
    pub(super) fn is_of_experiments(self) -> bool {
        matches!(self, Section::Procedures | Section::Effects)
    }

    /// Whether there are too many topics for the overview to say what each one is.
    pub(super) fn is_long(self) -> bool {
        matches!(
            self,
            Section::Effects
                | Section::Slips
                | Section::Rules
                | Section::Keys
                | Section::ExperimentKeys
                | Section::CertificateKeys
                | Section::Errors
        )
    }
}

impl Topic {
    pub(super) fn is_called(&self, wanted: &str) -> bool {
        let wanted = folded(wanted);
        folded(&self.name) == wanted || self.aliases.iter().any(|a| folded(a) == wanted)
    }

    pub(super) fn explained(&self) -> String {
        let paragraphs = self.text.split("\n\n").map(wrapped);
        format!(
            "{}: {}\n\n{}\n",
            self.name,
            self.title,
            paragraphs.collect::<Vec<_>>().join("\n\n")
        )
    }
}

/// Names are compared without regard to case, to the kind of separator and to brackets of tables.
pub(super) fn folded(name: &str) -> String {
    name.trim()
        .trim_start_matches('[')
        .trim_end_matches(']')
        .to_lowercase()
        .replace(['_', ' ', '–'], "-")
}
