//! The identifiers of the effects, from their entries in the catalogue.

use std::fmt::Write as _;
use std::{env, fs, io, path::PathBuf};

const ENTRIES: &str = "src/diagnose/catalogue/effects.toml";

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed={ENTRIES}");
    println!("cargo::rerun-if-changed=build.rs");
    let text = fs::read_to_string(ENTRIES)?;
    let ids = text.lines();
    let ids = ids.filter_map(|line| line.strip_prefix("id = \"")?.strip_suffix('"'));
    let (mut variants, mut texts) = (String::new(), String::new());
    for id in ids {
        let name: String = id.split('-').map(capital).collect();
        let _ = write!(variants, "/// `{id}`.\n{name},\n");
        let _ = writeln!(texts, "EffectId::{name} => \"{id}\",");
    }
    let code = format!(
        "/// Identifier of an effect of the catalogue.\n\
         #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Deserialize)]\n\
         #[serde(rename_all = \"kebab-case\")]\n\
         pub enum EffectId {{\n{variants}}}\n\
         impl EffectId {{\n\
         /// As it is written in files and reports.\n\
         pub fn as_str(self) -> &'static str {{\nmatch self {{\n{texts}}}\n}}\n}}\n"
    );
    let folder = env::var_os("OUT_DIR").ok_or_else(|| io::Error::other("no folder to write to"))?;
    fs::write(PathBuf::from(folder).join("effect_id.rs"), code)
}

/// A word with a capital.
fn capital(word: &str) -> String {
    let mut letters = word.chars();
    let first = letters.next().map(|letter| letter.to_ascii_uppercase());
    first.into_iter().chain(letters).collect()
}
