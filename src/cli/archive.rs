//! `gumption eval --archive` and `gumption verify FILE.zip`: everything that a result was computed from in one file, and
//! whether it gives the same bits again.

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use super::evaluated::{self, Settings};
use super::form::Form;
use super::output::Complaint;
use super::{Outcome, output};
use gumption::Files;
use gumption::document::Document;
use gumption::fault::{Said, say};
use gumption::files;
use gumption::render::{Page, archive, json as machine};

/// Name and version of the form.
const FORMAT: &str = "gumption-archive/1";
const MANIFEST: &str = "manifest.json";
const RESULT: &str = "result.json";
/// Folder of the files that were read.
const READ: &str = "files/";

/// Everything that was read, what was asked for, and what came out.
pub(super) fn packed(
    budget: &Path,
    settings: &Settings,
    result: &Document,
) -> Result<Vec<u8>, Complaint> {
    let paths: Vec<PathBuf> = files::reads();
    let budget = Files::Disk.identity(budget);
    let folder = common_folder(paths.iter().chain([&budget]));
    let mut members = Vec::new();
    let mut hashes = BTreeMap::new();
    for path in &paths {
        let content = Files::Disk
            .read(path)
            .map_err(|error| say!("cannot read {}: {error}", path.display()))?;
        let name = name_below(path, &folder);
        hashes.insert(name.clone(), hash(&content));
        members.push((format!("{READ}{name}"), content));
    }
    let result = written(result)?;
    let manifest = json!({
        "format": FORMAT,
        "generator": generator(),
        "budget": name_below(&budget, &folder),
        "arguments": settings.arguments(),
        "files": hashes,
        "result": hash(&result),
    });
    members.push((RESULT.to_owned(), result));
    members.push((MANIFEST.to_owned(), format!("{manifest:#}\n").into_bytes()));
    members.sort();
    archive::packed(&members).map_err(|why| say!("no archive is written: {why}").into())
}

/// The result of a document for machines.
fn written(document: &Document) -> Result<Vec<u8>, Complaint> {
    (machine::FORMAT.render)(document, &Page::default()).map_err(|unfit| unfit.0.into())
}

fn generator() -> String {
    format!("gumption {}", env!("CARGO_PKG_VERSION"))
}

fn hash(content: &[u8]) -> String {
    let digest = Sha256::digest(content);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The folder that holds all files.
fn common_folder<'p>(paths: impl Iterator<Item = &'p PathBuf>) -> PathBuf {
    let folders = paths.filter_map(|path| path.parent());
    let common = folders.map(Path::to_path_buf).reduce(|common, folder| {
        let parts = common.components().zip(folder.components());
        let same = parts.take_while(|(a, b)| a == b);
        same.map(|(part, _)| part).collect()
    });
    common.unwrap_or_default()
}

/// The path below a folder, with `/` between its parts.
fn name_below(path: &Path, folder: &Path) -> String {
    let path = path.strip_prefix(folder).unwrap_or(path);
    let parts = path.components().filter_map(|part| match part {
        Component::Normal(part) => Some(part.to_string_lossy()),
        _ => None,
    });
    parts.collect::<Vec<_>>().join("/")
}

/// An archive, taken apart and found whole.
struct Archive {
    manifest: Value,
    members: BTreeMap<String, Vec<u8>>,
}

/// Evaluates what an archive holds again, and says whether the same bits come out.
pub(super) fn verify(path: &Path, form: &Form) -> Outcome {
    match verified(path) {
        Ok((lines, outcome)) => {
            let language = form.language();
            let lines = lines
                .into_iter()
                .map(|line| line.in_language(language) + "\n");
            output::print(lines.collect::<String>()).max(outcome)
        }
        Err(complaint) => output::complain(complaint),
    }
}

fn verified(path: &Path) -> Result<(Vec<Said>, Outcome), Complaint> {
    let shown = path.display();
    let bytes = Files::Disk
        .read(path)
        .map_err(|error| say!("cannot read {shown}: {error}"))?;
    let archive = Archive::read(&bytes).map_err(|why| say!("{shown}: {why}"))?;
    let mut lines = Vec::new();
    let changed = archive.changed();
    if !changed.is_empty() {
        let names = changed.join(", ");
        lines.push(say!(
            "{shown} was changed: the hashes of {names} are not those of its manifest"
        ));
        return Ok((lines, Outcome::Negative));
    }
    let count = archive.members.len().saturating_sub(2);
    lines.push(say!(
        "{shown}: {count} files, all with the hashes of the manifest"
    ));
    let before = archive.text("generator")?;
    let now = generator();
    if before != now {
        lines.push(say!("written by {before}; this is {now}"));
    }
    let again = archive.evaluated()?;
    let stored = archive.members.get(RESULT).cloned().unwrap_or_default();
    if again == stored {
        lines.push(say!("evaluated again: the same bits"));
        return Ok((lines, Outcome::Done));
    }
    lines.push(say!("evaluated again: not the same"));
    let parsed = |bytes: &[u8]| serde_json::from_slice(bytes).unwrap_or(Value::Null);
    let mut found = Vec::new();
    differences(&parsed(&stored), &parsed(&again), String::new(), &mut found);
    /// More are seen in the files themselves.
    const MOST: usize = 20;
    let more = found.len().saturating_sub(MOST);
    lines.extend(found.into_iter().take(MOST));
    if more > 0 {
        lines.push(say!("and {more} further differences"));
    }
    Ok((lines, Outcome::Negative))
}

impl Archive {
    fn read(bytes: &[u8]) -> Result<Self, Said> {
        let members = archive::unpacked(bytes).map_err(|why| say!("no archive: {why}"))?;
        let members: BTreeMap<String, Vec<u8>> = members.into_iter().collect();
        let manifest = members
            .get(MANIFEST)
            .ok_or_else(|| say!("no archive of gumption: it has no {MANIFEST}"))?;
        let manifest: Value = serde_json::from_slice(manifest)
            .map_err(|error| say!("its {MANIFEST} cannot be read: {error}"))?;
        match manifest["format"].as_str() {
            Some(FORMAT) => Ok(Archive { manifest, members }),
            other => {
                let other = other.unwrap_or("—");
                Err(say!("its form is {other}; this program reads {FORMAT}"))
            }
        }
    }

    /// A text of the manifest.
    fn text(&self, key: &str) -> Result<String, Said> {
        let text = self.manifest[key].as_str();
        text.map(str::to_owned)
            .ok_or_else(|| say!("its {MANIFEST} has no `{key}`"))
    }

    /// Names of the files whose hash is not that of the manifest.
    fn changed(&self) -> Vec<String> {
        let mut stated: BTreeMap<String, String> = BTreeMap::new();
        for (name, hash) in self.manifest["files"].as_object().into_iter().flatten() {
            let hash = hash.as_str().unwrap_or_default();
            stated.insert(format!("{READ}{name}"), hash.to_owned());
        }
        let result = self.manifest["result"].as_str().unwrap_or_default();
        stated.insert(RESULT.to_owned(), result.to_owned());
        let held = self.members.keys().filter(|name| *name != MANIFEST);
        let mut names: Vec<&String> = held.chain(stated.keys()).collect();
        names.sort();
        names.dedup();
        let differs = |name: &&String| {
            let held = self.members.get(*name).map(|content| hash(content));
            held.as_ref() != stated.get(*name)
        };
        names.into_iter().filter(differs).cloned().collect()
    }

    /// The result, computed from the files of the archive alone.
    fn evaluated(&self) -> Result<Vec<u8>, Complaint> {
        let arguments = self.manifest["arguments"].as_array();
        let arguments = arguments.into_iter().flatten().filter_map(Value::as_str);
        let settings = Settings::of(arguments)?;
        let read = self
            .members
            .iter()
            .filter_map(|(name, content)| Some((name.strip_prefix(READ)?, content.as_slice())));
        let read: Vec<(&str, &[u8])> = read.collect();
        let budget = self.text("budget")?;
        let document = evaluated::machine(Files::Library(&read), Path::new(&budget), &settings)?;
        written(&document)
    }
}

/// Where two results differ, by their paths.
fn differences(before: &Value, now: &Value, path: String, found: &mut Vec<Said>) {
    let below = |key: &str| match path.as_str() {
        "" => key.to_owned(),
        path => format!("{path}.{key}"),
    };
    match (before, now) {
        (Value::Object(a), Value::Object(b)) => {
            let mut keys: Vec<&String> = a.keys().chain(b.keys()).collect();
            keys.sort();
            keys.dedup();
            for key in keys {
                let of = |map: &serde_json::Map<String, Value>| map.get(key).cloned();
                let (a, b) = (of(a).unwrap_or_default(), of(b).unwrap_or_default());
                differences(&a, &b, below(key), found);
            }
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            for (at, (a, b)) in a.iter().zip(b).enumerate() {
                differences(a, b, below(&at.to_string()), found);
            }
        }
        (before, now) if before == now => {}
        (before, now) => {
            let (before, now) = (before.to_string(), now.to_string());
            found.push(say!("{path}: {before} before, {now} now"));
        }
    }
}
