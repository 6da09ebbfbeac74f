//! What every command composes, and every format is written from.
//!
//! A [`Document`] holds the same thing twice: as [`Block`]s in the order in which a person reads them, and as one
//! typed structure for machines. Whoever composes it has decided everything; a renderer only draws.

mod bilingual;
mod certificate;
mod math;
mod plot;
mod sheet;
mod table;
mod texts;

use gumption_fault::language::Language;

pub use certificate::{
    Administration, Attachment, Certificate, Certified, CertifiedConformity, CertifiedPoint,
    CertifiedUncertainty, CertifiedVerdict, Condition, Contact, Item, Person, Reference, Region,
    Told,
};
pub use math::Math;
pub use plot::{Axis, Bar, Layer, Marks, Panel, Plot, Scale, Tone};
pub use sheet::{Bars, Entry, Held, Sheet, address, column_letters};
pub use table::{Cell, Column, ColumnKind, Row, Table};

use crate::machine::{Json, Machine};

/// A document of one kind.
#[derive(Debug, Clone, PartialEq)]
pub struct Document {
    /// What is documented (`evaluation`), as in the name of the machine form.
    pub kind: &'static str,
    /// Version of the machine form.
    pub version: u32,
    /// Language of the blocks.
    pub language: Language,
    /// The language whose words stand beside it, where there are two.
    pub other: Option<Language>,
    /// What a person reads: changed by [`edit`](Self::edit) alone.
    blocks: Vec<Block>,
    /// What a machine reads; exact numbers.
    pub machine: Json,
    /// Plots beside the text, for formats and folders that have room for them.
    pub beside: Vec<Plot>,
    /// Sheets that calculate, for spreadsheets.
    pub sheets: Vec<Sheet>,
    /// What is certified, for digital certificates.
    pub certificate: Option<Box<Certificate>>,
}

impl Document {
    /// A document of blocks and of the structure that says the same to machines.
    ///
    /// Blocks quote what users wrote: here, for every format, it becomes text that is shown and not obeyed.
    pub fn new<M: Machine>(machine: &M, language: Language, blocks: Vec<Block>) -> Self {
        let mut document = Document {
            kind: M::KIND,
            version: M::VERSION,
            language,
            other: None,
            blocks: Vec::new(),
            machine: Json::of(machine),
            beside: Vec::new(),
            sheets: Vec::new(),
            certificate: None,
        };
        document.edit(|own| *own = blocks);
        document
    }

    /// What a person reads.
    pub fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    /// Changes the blocks. There is no other way, so that none comes in with text that is obeyed.
    pub fn edit(&mut self, change: impl FnOnce(&mut Vec<Block>)) {
        change(&mut self.blocks);
        for block in &mut self.blocks {
            block.texts(&mut texts::made_harmless);
        }
    }

    /// With plots beside the text.
    #[must_use]
    pub fn with_plots(mut self, mut plots: Vec<Plot>) -> Self {
        for plot in &mut plots {
            plot.texts(&mut texts::made_harmless);
        }
        self.beside.extend(plots);
        self
    }

    /// With sheets that calculate.
    #[must_use]
    pub fn with_sheets(mut self, mut sheets: Vec<Sheet>) -> Self {
        for sheet in &mut sheets {
            sheet.texts(&mut texts::made_harmless);
        }
        self.sheets.extend(sheets);
        self
    }

    /// One document of several of one kind: their blocks one after the other; for machines one value, or an array
    /// where there are more. `None` of none. A certificate is that of the first.
    pub fn together(documents: Vec<Document>) -> Option<Document> {
        let mut documents = documents.into_iter();
        let mut whole = documents.next()?;
        let mut machines = vec![whole.machine];
        for one in documents {
            whole.blocks.extend(one.blocks);
            whole.beside.extend(one.beside);
            whole.sheets.extend(one.sheets);
            machines.push(one.machine);
        }
        whole.machine = Json::together(machines);
        Some(whole)
    }

    /// Words that a format adds, in the languages of the blocks.
    pub fn words(&self, english: &str, chinese: &str) -> String {
        self.in_each(|l| l.pick(english, chinese))
    }

    /// A text in the languages of the blocks; once where it is the same in both.
    pub fn told(&self, text: &Told) -> String {
        self.in_each(|l| text.text(l))
    }

    fn in_each<'a>(&self, text: impl Fn(Language) -> &'a str) -> String {
        let own = text(self.language);
        match self.other.map(text) {
            Some(other) if other != own => format!("{own} / {other}"),
            _ => own.to_owned(),
        }
    }

    /// The plots, first those of the blocks, then those beside them.
    pub fn plots(&self) -> impl Iterator<Item = &Plot> {
        let inside = self.blocks.iter().filter_map(|block| match block {
            Block::Plot(plot) => Some(plot),
            _ => None,
        });
        inside.chain(&self.beside)
    }
}

/// One block of a document.
#[derive(Debug, Clone, PartialEq)]
pub enum Block {
    /// The name of the whole.
    Title(String),
    /// The head of a section.
    Section(String),
    /// Short labelled lines (`Method  In-house procedure 12`).
    Fields(Vec<(String, String)>),
    /// The figures that matter most.
    Figures(Vec<KeyFigure>),
    /// Running text.
    Paragraph(String),
    /// Lines to be kept as they are.
    Formula(Vec<String>),
    /// Rows and columns.
    Table(Table),
    /// A plot as data.
    Plot(Plot),
    /// Independent sentences.
    List(Vec<String>),
    /// What must be known before the figures are used.
    Findings(Vec<Finding>),
    /// Sentences for the certificate.
    Statement(Vec<String>),
    /// The lines that all comes down to.
    Closing(Vec<String>),
    /// Small print.
    Footer(Vec<String>),
}

/// A figure with its name and unit, as it is to be printed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeyFigure {
    /// What it is.
    pub name: String,
    /// The number, rounded, or words where there is none.
    pub value: String,
    /// Its unit; empty for one.
    pub unit: String,
}

impl KeyFigure {
    /// The number with its unit.
    pub fn text(&self) -> String {
        match self.unit.as_str() {
            "" => self.value.clone(),
            unit => format!("{} {unit}", self.value),
        }
    }
}

/// A sentence about the figures, with the name under which machines know it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// Kind of finding (`k_from_t`).
    pub id: String,
    /// How much it weighs.
    pub severity: Severity,
    /// The language of the sentence.
    pub language: Language,
    /// The sentence.
    pub text: String,
}

impl Finding {
    /// What stands before the sentence of what is more than a note, in its own language.
    pub fn caution(&self) -> &'static str {
        match self.severity {
            Severity::Note => "",
            Severity::Warning => self.language.pick("Caution: ", "注意："),
            Severity::Failure => self.language.pick("Not to be used: ", "不可采用："),
        }
    }
}

/// What a finding means for the figures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Severity {
    /// Good to know.
    Note,
    /// The figures are to be used with care.
    Warning,
    /// A figure is not to be used.
    Failure,
}
