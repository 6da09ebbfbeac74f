//! One definition per table of a file.
//!
//! [`table!`] makes four things from one definition: the raw structure, its reader over spanned
//! TOML that reports every fault at once, its JSON Schema and the rows of the reference of keys.
//! Adding a key is one line with its documentation.

use std::ops::Range;

use gumption_fault::{Code, Fault, Said, nearest, say};
use serde_json::{Map, Value};
use smallvec::SmallVec;
use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use super::faults::{UNKNOWN_KEY, UNKNOWN_WORD, WRONG_TYPE};
use super::matrix::Matrices;
use super::syntax::Synonyms;

/// A value of the file as the parser gives it.
pub type Raw<'t> = Spanned<DeValue<'t>>;

/// A value that the file states, and where.
#[derive(Debug, Clone, PartialEq)]
pub struct Stated<T> {
    /// What is stated.
    pub value: T,
    /// Place of the value.
    pub span: Range<usize>,
    /// Place of the key (of the value itself in a list).
    pub key: Range<usize>,
}

impl<T> Stated<T> {
    /// The same place with another value.
    pub fn map<U>(&self, f: impl FnOnce(&T) -> U) -> Stated<U> {
        Stated {
            value: f(&self.value),
            span: self.span.clone(),
            key: self.key.clone(),
        }
    }
}

/// What a table states under one of its keys, if anything. Tables have dozens of keys, of which a file states few, and
/// there may be a table for each of ten thousand inputs.
pub type Slot<T> = Option<Box<Stated<T>>>;

/// The keys that a table states, with their places: mostly one or two.
pub type Present = SmallVec<[(&'static str, Range<usize>); 2]>;

/// A key as the parser gives it.
pub type Key<'t> = Spanned<DeString<'t>>;

/// What a kind of file knows about the mistakes of its writers.
#[derive(Debug, Clone)]
pub struct Hints {
    /// Words that people try, and the key that they mean.
    pub synonyms: &'static Synonyms,
    /// What such a file is, with the article.
    pub whole: Said,
    /// The keys at the top of the file.
    pub top: fn() -> Vec<&'static str>,
    /// What to say of a key of a table that is not among the known ones, before anything else is tried.
    pub unknown_key: fn(key: &str, table: &str, known: &[&'static str]) -> Option<Said>,
    /// What to write in place of a value that stands where a table of this title is expected.
    pub no_table: fn(title: &str, found: &DeValue<'_>) -> Option<Said>,
    /// What to write for a value of the wrong type, as it stands in the file, at this key.
    pub wrong_type: fn(key: &str, found: &str) -> Option<Said>,
    /// What to say of a list where an amount stands.
    pub list_of_amounts: Said,
}

/// Collects faults while tables are read.
#[derive(Debug)]
pub struct Reader<'f> {
    /// The whole file.
    pub file: &'f str,
    /// What this kind of file knows about mistakes.
    pub hints: &'static Hints,
    /// The matrices that the parser has not seen.
    pub matrices: Matrices,
    /// What was found wrong, in the order of reading.
    pub faults: Vec<Fault>,
}

impl<'f> Reader<'f> {
    /// A reader of a file of this kind.
    pub fn new(file: &'f str, hints: &'static Hints) -> Self {
        Reader {
            file,
            hints,
            matrices: Matrices::default(),
            faults: Vec::new(),
        }
    }

    /// Reports a fault and yields nothing, for use as the last expression of a reader.
    pub fn refuse<T>(&mut self, fault: Fault) -> Option<T> {
        self.faults.push(fault);
        None
    }

    /// Reports a key that the table does not have.
    pub fn unknown_key(&mut self, key: &Key<'_>, table: &'static str, known: &[&'static str]) {
        let fault = unknown_key(key, table, known, self.hints);
        self.faults.push(fault);
    }

    /// Reports that the value is of the wrong type, with what to write in its place.
    pub fn wrong_type_with<T>(
        &mut self,
        value: &Raw<'_>,
        expected: Said,
        help: Option<Said>,
    ) -> Option<T> {
        let before = self.faults.len();
        let refused = self.wrong_type(WRONG_TYPE, value, expected);
        if let Some(fault) = self.faults.get_mut(before) {
            fault.help = help;
        }
        refused
    }

    /// Gives the faults since this one the mend that the key has for a value of the wrong type.
    pub fn mend_of_key(&mut self, before: usize, key: &str, value: &Raw<'_>) {
        let place = value.span();
        let wrong = |fault: &&mut Fault| fault.code == WRONG_TYPE && fault.span == place;
        let Some(fault) = self.faults.iter_mut().skip(before).find(wrong) else {
            return;
        };
        let found = self.file.get(place.clone()).unwrap_or_default();
        if let Some(help) = (self.hints.wrong_type)(key, found) {
            fault.help = Some(help);
        }
    }

    /// Reports a value that stands in the place of a table of this title.
    pub fn no_table<T>(&mut self, value: &Raw<'_>, title: &str) -> Option<T> {
        let help = (self.hints.no_table)(title, value.get_ref());
        self.wrong_type_with(value, say!("a table"), help)
    }

    /// Reports that the value is of the wrong type.
    pub fn wrong_type<T>(&mut self, code: Code, value: &Raw<'_>, expected: Said) -> Option<T> {
        let found = found(value.get_ref());
        self.refuse(
            Fault::new(
                code,
                value.span(),
                say!("expected {expected}, found {found}"),
            )
            .label(say!("expected {expected}")),
        )
    }
}

/// A value in words, for "found …".
fn found(value: &DeValue<'_>) -> Said {
    match value {
        DeValue::String(text) if text.chars().count() <= 30 => say!("the text {text:?}"),
        DeValue::String(_) => say!("a text"),
        DeValue::Integer(number) => say!("the number {number}"),
        DeValue::Float(number) => say!("the number {number}"),
        DeValue::Boolean(truth) => say!("{truth}"),
        DeValue::Datetime(date) => say!("the date {date}"),
        DeValue::Array(_) => say!("a list"),
        DeValue::Table(_) => say!("a table"),
    }
}

/// Something that a key may be set to.
pub trait FromToml: Sized {
    /// What is expected, in words with the article: `a number`.
    fn expected() -> Said;

    /// The same without article and in the plural, where that can be said: `numbers`.
    fn plural() -> Option<Said> {
        None
    }

    /// Reads the value, or reports why not.
    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self>;

    /// JSON Schema (draft-07) of the value.
    fn schema() -> Value;

    /// The tables inside, for the reference of keys.
    fn tables(_path: &str, _rows: &mut Vec<KeyRow>) {}
}

/// JSON Schema (draft-07) of a file with this title, for editors; one of its keys may be set to one of these names.
pub fn schema_of<T: FromToml>(title: &str, (key, names): (&str, Vec<&str>)) -> Value {
    let mut schema = T::schema();
    if let Value::Object(entries) = &mut schema {
        let draft = "http://json-schema.org/draft-07/schema#";
        entries.insert("$schema".into(), draft.into());
        entries.insert("title".into(), title.into());
        if let Some(Value::Object(properties)) = entries.get_mut("properties")
            && let Some(Value::Object(one)) = properties.get_mut(key)
        {
            one.insert("enum".into(), names.into());
        }
    }
    schema
}

/// One row of the reference of keys.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeyRow {
    /// Where the key stands: `input.X.certificate`.
    pub table: String,
    /// The key.
    pub key: &'static str,
    /// What it may be set to, in words.
    pub kind: Said,
    /// What it says.
    pub doc: String,
}

/// A table of known keys.
pub trait Table: Default {
    /// Takes the entry if the table has such a key.
    fn accept(&mut self, key: &Key<'_>, value: &Raw<'_>, reader: &mut Reader<'_>) -> bool;

    /// Notes that the table has a key that is not known.
    fn refuse(&mut self);

    /// What this table says, and where it says nothing, what `below` says.
    #[must_use]
    fn over(self, below: Self) -> Self;

    /// Every key, in the order of the definition.
    fn keys() -> Vec<&'static str>;

    /// Adds the schema of every key.
    fn properties(into: &mut Map<String, Value>);

    /// Adds the rows of this table and of those inside it.
    fn rows(path: &str, rows: &mut Vec<KeyRow>);
}

/// The known key that an unknown one most likely means.
fn meant(name: &str, known: &[&'static str], hints: &Hints) -> Option<&'static str> {
    let plain = name.to_lowercase().replace(['-', ' '], "_");
    synonym(name, known, hints).or_else(|| nearest(&plain, known.iter().copied()))
}

/// The known word or key of which this one is a synonym, whatever its case, hyphens and spaces.
fn synonym(name: &str, known: &[&'static str], hints: &Hints) -> Option<&'static str> {
    let plain = name.to_lowercase().replace(['-', ' '], "_");
    let mut synonyms = hints.synonyms.iter();
    synonyms
        .find(|(word, key)| *word == plain && known.contains(key))
        .map(|(_, key)| *key)
}

/// Reads the entries of a table in the order of the file.
pub fn read_table<T: Table>(table: &DeTable<'_>, name: &'static str, reader: &mut Reader<'_>) -> T {
    let mut result = T::default();
    for (key, value) in in_order(table) {
        if !result.accept(key, value, reader) {
            match keys_too_deep(key, value, &T::keys()) {
                Some(fault) => reader.faults.push(fault),
                None => reader.unknown_key(key, name, &T::keys()),
            }
            // What an unknown key was meant to state is not asked for a second time.
            result.refuse();
        }
    }
    result
}

/// A table that the file does not have around keys that belong where it stands: `[input.V.uncertainty]`, `u = …`.
fn keys_too_deep(key: &Key<'_>, value: &Raw<'_>, known: &[&'static str]) -> Option<Fault> {
    let DeValue::Table(inner) = value.get_ref() else {
        return None;
    };
    // The path of a column of a series stands in one place.
    let behind = key.span().end;
    let own = |key: &Key<'_>| known.contains(&key.get_ref().as_ref()) && key.span().start >= behind;
    if inner.is_empty() || !inner.keys().all(own) {
        return None;
    }
    let name = key.get_ref();
    let keys: Vec<String> = in_order(inner)
        .iter()
        .map(|(key, _)| format!("`{}`", key.get_ref()))
        .collect();
    let keys = keys.join(", ");
    Some(
        Fault::new(
            UNKNOWN_KEY,
            key.span(),
            say!("there is no table `{name}` here"),
        )
        .label(say!("unknown key"))
        .help(say!(
            "write {keys} directly in the table around it, without `{name}`"
        )),
    )
}

/// The entries of a table in the order of the file, where one may have been begun by the header of a table inside it.
pub fn in_order<'a, 't>(table: &'a DeTable<'t>) -> SmallVec<[(&'a Key<'t>, &'a Raw<'t>); 4]> {
    let mut entries: SmallVec<[_; 4]> = table.iter().collect();
    entries.sort_by_key(|(key, _)| key.span().start);
    entries
}

fn unknown_key(key: &Key<'_>, table: &'static str, known: &[&'static str], hints: &Hints) -> Fault {
    let name = key.get_ref();
    let title = match known == (hints.top)() {
        true => hints.whole.clone(),
        false => Said::plain(table),
    };
    let fault = Fault::new(UNKNOWN_KEY, key.span(), say!("{title} has no key `{name}`"))
        .label(say!("unknown key"));
    if let Some(help) = (hints.unknown_key)(name, table, known) {
        return fault.help(help);
    }
    match meant(name, known, hints) {
        Some(near) => fault.help(say!("did you mean `{near}`?")),
        None if (hints.top)().contains(&name.as_ref()) => fault.help(above_the_first_table(name)),
        None => fault.help(say!("known keys: {}", known.join(", "))),
    }
}

/// The mend of a key of the whole file that stands below a header.
pub(super) fn above_the_first_table(name: &str) -> Said {
    say!(
        "`{name}` belongs to the top of the file, above the first [table]: a line belongs to the header above it"
    )
}

/// A documentation comment as one line of text.
pub fn doc_text(lines: &[&str]) -> String {
    lines
        .iter()
        .map(|line| line.trim())
        .collect::<Vec<_>>()
        .join(" ")
}

/// Defines one table of a file; see the module.
///
/// `key as "spelling"` gives a key a spelling that is no Rust name; `with rest: Other` adds all
/// keys of another table.
#[macro_export]
macro_rules! table {
    (
        $( #[doc = $doc:literal] )+
        $name:ident $title:literal {
            $( $( #[doc = $key_doc:literal] )+ $key:ident $( as $spelling:literal )? : $kind:ty, )*
            $( with $rest:ident : $rest_kind:ty )?
        }
    ) => {
        $( #[doc = $doc] )+
        #[derive(Debug, Clone, Default)]
        #[allow(non_snake_case)]
        pub struct $name {
            $( $( #[doc = $key_doc] )+ pub $key: $crate::toml::Slot<$kind>, )*
            $( /// The keys that this table shares with another.
            pub $rest: $rest_kind, )?
            /// Every own key that the file states, also those whose value was refused.
            pub present: $crate::toml::Present,
            /// Whether a key or its value was refused (what is missing is then not asked for).
            pub refused: bool,
            /// Whether it has a key that is not known, which may have been meant for any other.
            pub unknown: bool,
        }

        impl $crate::toml::Table for $name {
            fn accept(
                &mut self,
                key: &$crate::toml::Key<'_>,
                value: &$crate::toml::Raw<'_>,
                reader: &mut $crate::toml::Reader<'_>,
            ) -> bool {
                use $crate::toml::{FromToml, Stated};
                let name: &str = key.get_ref();
                let before = reader.faults.len();
                $(
                    if name == $crate::table!(@spelling $key $( $spelling )?) {
                        self.present.push(($crate::table!(@spelling $key $( $spelling )?), key.span()));
                        self.$key = <$kind as FromToml>::read(value, reader)
                            .map(|read| Box::new(Stated { value: read, span: value.span(), key: key.span() }));
                        reader.mend_of_key(before, name, value);
                        self.refused |= self.$key.is_none() || reader.faults.len() > before;
                        return true;
                    }
                )*
                $( if self.$rest.accept(key, value, reader) {
                    return true;
                } )?
                let _ = (name, value, before, reader);
                false
            }

            fn refuse(&mut self) {
                self.refused = true;
                self.unknown = true;
                $( self.$rest.refuse(); )?
            }

            fn over(self, below: Self) -> Self {
                $name {
                    $( $key: self.$key.or(below.$key), )*
                    $( $rest: $crate::toml::Table::over(self.$rest, below.$rest), )?
                    present: self.present.into_iter().chain(below.present).collect(),
                    refused: self.refused || below.refused,
                    unknown: self.unknown || below.unknown,
                }
            }

            fn keys() -> Vec<&'static str> {
                #[allow(unused_mut)]
                let mut keys = vec![ $( $crate::table!(@spelling $key $( $spelling )?) ),* ];
                $( keys.extend(<$rest_kind as $crate::toml::Table>::keys()); )?
                keys
            }

            fn properties(into: &mut $crate::toml::Map<String, $crate::toml::Value>) {
                $(
                    let doc = $crate::toml::doc_text(&[ $( $key_doc ),+ ]);
                    let schema = $crate::toml::described(
                        <$kind as $crate::toml::FromToml>::schema(), doc);
                    into.insert($crate::table!(@spelling $key $( $spelling )?).to_string(), schema);
                )*
                $( <$rest_kind as $crate::toml::Table>::properties(into); )?
            }

            fn rows(path: &str, rows: &mut Vec<$crate::toml::KeyRow>) {
                $(
                    rows.push($crate::toml::KeyRow {
                        table: path.to_string(),
                        key: $crate::table!(@spelling $key $( $spelling )?),
                        kind: <$kind as $crate::toml::FromToml>::expected(),
                        doc: $crate::toml::doc_text(&[ $( $key_doc ),+ ]),
                    });
                )*
                $( <$rest_kind as $crate::toml::Table>::rows(path, rows); )?
                $(
                    <$kind as $crate::toml::FromToml>::tables(
                        &$crate::toml::inner(path, $crate::table!(@spelling $key $( $spelling )?)), rows);
                )*
            }
        }

        impl $crate::toml::FromToml for $name {
            fn expected() -> $crate::toml::Said {
                $crate::toml::say!("a table")
            }

            fn plural() -> Option<$crate::toml::Said> {
                Some($crate::toml::say!("tables"))
            }

            fn read(
                value: &$crate::toml::Raw<'_>,
                reader: &mut $crate::toml::Reader<'_>,
            ) -> Option<Self> {
                match value.get_ref() {
                    $crate::toml::DeValue::Table(table) =>
                        Some($crate::toml::read_table::<Self>(table, $title, reader)),
                    _ => reader.no_table(value, $title),
                }
            }

            fn schema() -> $crate::toml::Value {
                let mut properties = $crate::toml::Map::new();
                <Self as $crate::toml::Table>::properties(&mut properties);
                $crate::toml::json!({
                    "type": "object",
                    "description": $crate::toml::doc_text(&[ $( $doc ),+ ]),
                    "properties": properties,
                    "additionalProperties": false,
                })
            }

            fn tables(path: &str, rows: &mut Vec<$crate::toml::KeyRow>) {
                <Self as $crate::toml::Table>::rows(path, rows);
            }
        }
    };
    (@spelling $key:ident) => { stringify!($key) };
    (@spelling $key:ident $spelling:literal) => { $spelling };
}
pub use table;

/// Defines a choice of words, each with its documentation; further spellings after `|`. Further traits may be derived.
#[macro_export]
macro_rules! words {
    (
        $( #[doc = $doc:literal] )+
        $( #[derive($($derive:path),+)] )?
        $name:ident {
            $( $( #[doc = $word_doc:literal] )+ $variant:ident $word:literal $( | $alias:literal )*, )+
        }
    ) => {
        $( #[doc = $doc] )+
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        $( #[derive($($derive),+)] )?
        pub enum $name {
            $( $( #[doc = $word_doc] )+ $variant, )+
        }

        impl $name {
            /// The word as the file spells it.
            #[allow(dead_code)]
            pub fn word(self) -> &'static str {
                match self {
                    $( Self::$variant => $word, )+
                }
            }

            /// What a word stands for.
            #[allow(dead_code)]
            pub fn named(word: &str) -> Option<Self> {
                match word {
                    $( $word $( | $alias )* => Some(Self::$variant), )+
                    _ => None,
                }
            }
        }

        impl $crate::toml::FromToml for $name {
            fn expected() -> $crate::toml::Said {
                let words: Vec<String> = [ $( $word ),+ ].iter().map(|word| format!("\"{word}\"")).collect();
                $crate::toml::say!("one of {}", words.join(", "))
            }

            fn read(
                value: &$crate::toml::Raw<'_>,
                reader: &mut $crate::toml::Reader<'_>,
            ) -> Option<Self> {
                let $crate::toml::DeValue::String(text) = value.get_ref() else {
                    return reader.wrong_type(
                        $crate::toml::faults::WRONG_TYPE, value, <Self as $crate::toml::FromToml>::expected());
                };
                match text.as_ref() {
                    $( $word $( | $alias )* => Some(Self::$variant), )+
                    other => {
                        let known = [ $( $word, $( $alias, )* )+ ];
                        reader.refuse($crate::toml::unknown_word(
                            value, other, &known, <Self as $crate::toml::FromToml>::expected(), reader.hints))
                    }
                }
            }

            fn schema() -> $crate::toml::Value {
                $crate::toml::json!({ "enum": [ $( $word, $( $alias, )* )+ ] })
            }
        }
    };
}
pub use words;

/// The fault for a word that is none of the choice.
pub fn unknown_word(
    value: &Raw<'_>,
    word: &str,
    known: &[&'static str],
    expected: Said,
    hints: &Hints,
) -> Fault {
    let fault = Fault::new(
        UNKNOWN_WORD,
        value.span(),
        say!("`{word}` is not known here"),
    )
    .label(say!("expected {expected}"));
    match synonym(word, known, hints).or_else(|| nearest(word, known.iter().copied())) {
        Some(near) => fault.help(say!("did you mean \"{near}\"?")),
        None => fault,
    }
}

/// A schema with its description.
pub fn described(mut schema: Value, doc: String) -> Value {
    if let Value::Object(entries) = &mut schema {
        entries.insert("description".into(), doc.into());
    }
    schema
}

/// The path of a table inside another.
pub fn inner(path: &str, key: &str) -> String {
    if path.is_empty() {
        key.to_string()
    } else {
        format!("{path}.{key}")
    }
}
