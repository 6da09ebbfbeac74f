//! Lists what is found by itself: the identifiers of the effects, from their entries in the catalogue, and
//! the procedures of the library, from their files.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

const ENTRIES: &str = "src/diagnose/catalogue/effects.toml";
const PROCEDURES: &str = "src/experiment/procedures";

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    effects()?;
    procedures()
}

fn effects() -> io::Result<()> {
    println!("cargo::rerun-if-changed={ENTRIES}");
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
    write("effect_id.rs", &code)
}

fn procedures() -> io::Result<()> {
    println!("cargo::rerun-if-changed={PROCEDURES}");
    let mut files = Vec::new();
    for entry in fs::read_dir(PROCEDURES)? {
        let path = entry?.path();
        if path
            .extension()
            .is_some_and(|extension| extension == "toml")
        {
            files.push(path);
        }
    }
    files.sort();
    let mut code =
        String::from("/// All procedures, by name.\npub const PROCEDURES: &[Procedure] = &[\n");
    for path in files {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let file = fs::canonicalize(Path::new(&path))?;
        let file = file.display().to_string();
        let _ = writeln!(
            code,
            "Procedure {{ name: {name:?}, text: include_str!({file:?}) }},"
        );
    }
    code += "];\n";
    write("procedures.rs", &code)
}

fn write(name: &str, code: &str) -> io::Result<()> {
    let folder = env::var_os("OUT_DIR").ok_or_else(|| io::Error::other("no folder to write to"))?;
    fs::write(PathBuf::from(folder).join(name), code)
}

/// A word with a capital.
fn capital(word: &str) -> String {
    let mut letters = word.chars();
    let first = letters.next().map(|letter| letter.to_ascii_uppercase());
    first.into_iter().chain(letters).collect()
}
