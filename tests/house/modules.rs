//! Modules of a crate, each a file, and which of them use which.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use super::lexer::{Token, tokens};

/// A module by the names on its way from the root of its crate; the root has none.
pub type Module = Vec<String>;

/// Which modules use which.
pub type Uses = BTreeMap<Module, BTreeSet<Module>>;

/// A module as text.
pub fn name(module: &[String]) -> String {
    if module.is_empty() {
        "lib".to_owned()
    } else {
        module.join("/")
    }
}

/// The sources of a crate.
pub struct Sources {
    files: BTreeMap<Module, Source>,
}

/// What a source says of other modules.
#[derive(Default)]
struct Source {
    /// Paths that it uses.
    paths: BTreeSet<Vec<String>>,
    /// Names that it hands on: the name, and the path of what it stands for.
    hands_on: Vec<(String, Vec<String>)>,
}

impl Sources {
    /// Reads all files of a folder of sources.
    pub fn read(folder: &Path) -> Sources {
        let mut paths = Vec::new();
        collect(folder, &mut paths);
        let (mut files, mut tests) = (BTreeMap::<Module, Source>::new(), Vec::new());
        for path in paths {
            let module = module(path.strip_prefix(folder).expect("a file of that folder"));
            let text = fs::read_to_string(&path).expect("a source in UTF-8");
            let (found, for_tests) = tokens(&text);
            for test in for_tests {
                tests.push([module.as_slice(), &[test]].concat());
            }
            // `lib.rs` and `main.rs` are both roots.
            files.entry(module).or_default().extend(&found);
        }
        files.retain(|module, _| !tests.iter().any(|test| module.starts_with(test)));
        Sources { files }
    }

    /// Which modules use which. A name that a module hands on is looked up where it comes from.
    pub fn uses(&self) -> Uses {
        let targets = |(module, source): (&Module, &Source)| {
            let used = source
                .paths
                .iter()
                .filter_map(|path| self.target(module, path));
            let others = used.filter(|used| used != module).collect();
            (module.clone(), others)
        };
        self.files.iter().map(targets).collect()
    }

    fn target(&self, module: &Module, path: &[String]) -> Option<Module> {
        let (mut target, mut rest) = self.resolve(module, path)?;
        let mut seen = BTreeSet::new();
        while let Some(name) = rest.first() {
            if !seen.insert((target.clone(), name.clone())) {
                break;
            }
            let Some((_, origin)) = self.files[&target]
                .hands_on
                .iter()
                .find(|(known, _)| known == name)
            else {
                // A crate that the root imports under its name is none of its modules.
                break;
            };
            let (next, further) = self.resolve(&target, origin)?;
            rest = [&further[..], &rest[1..]].concat();
            target = next;
        }
        Some(target)
    }

    /// The module that a path leads to, and what is left of the path there; none for another crate.
    fn resolve(&self, module: &Module, path: &[String]) -> Option<(Module, Vec<String>)> {
        let (mut base, mut rest) = (module.clone(), path);
        match rest.first()?.as_str() {
            "crate" => {
                base.clear();
                rest = &rest[1..];
            }
            "self" => rest = &rest[1..],
            "super" => {
                while rest.first().is_some_and(|word| word == "super") {
                    base.pop();
                    rest = &rest[1..];
                }
            }
            child if self.files.contains_key(&below(&base, child)) => {}
            _ => return None,
        }
        while let Some(next) = rest.first().map(|word| below(&base, word)) {
            if !self.files.contains_key(&next) {
                break;
            }
            base = next;
            rest = &rest[1..];
        }
        Some((base, rest.to_vec()))
    }
}

fn below(module: &[String], child: &str) -> Module {
    [module, &[child.to_owned()]].concat()
}

fn collect(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder of sources") {
        let path = entry.expect("an entry of that folder").path();
        if path.is_dir() {
            collect(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

fn module(file: &Path) -> Module {
    let words = file.with_extension("");
    let mut module: Module = words
        .iter()
        .map(|word| word.to_string_lossy().into_owned())
        .collect();
    if module.last().is_some_and(|last| last == "mod") || module == ["lib"] || module == ["main"] {
        module.pop();
    }
    module
}

impl Source {
    fn extend(&mut self, tokens: &[Token]) {
        let mut at = 0;
        while at < tokens.len() {
            if tokens[at].is("use") {
                let end = at
                    + tokens[at..]
                        .iter()
                        .position(|token| token.is(";"))
                        .unwrap_or(0);
                let public = at > 0 && (tokens[at - 1].is("pub") || is_restricted(&tokens[..at]));
                for (name, path) in branches(&tokens[at + 1..end]) {
                    let foreign = !["crate", "self", "super"].contains(&path[0].as_str());
                    if !public {
                        self.paths.insert(path.clone());
                    }
                    if public || foreign {
                        self.hands_on.push((name, path));
                    }
                }
                at = end.max(at + 1);
            } else if ["crate", "self", "super"]
                .iter()
                .any(|word| tokens[at].is(word))
            {
                let path = path(&tokens[at..]);
                at += 2 * path.len() - 1;
                if path.len() > 1 {
                    self.paths.insert(path);
                }
            } else {
                at += 1;
            }
        }
    }
}

/// Whether what comes before `use` is `pub(crate)`, `pub(super)` or `pub(in …)`.
fn is_restricted(before: &[Token]) -> bool {
    let open = before.iter().rposition(|token| token.is("("));
    before.last().is_some_and(|last| last.is(")"))
        && open.is_some_and(|open| open > 0 && before[open - 1].is("pub"))
}

/// The words of a path.
fn path(tokens: &[Token]) -> Vec<String> {
    let mut words = vec![tokens[0].0.clone()];
    for pair in tokens[1..].chunks(2) {
        match pair {
            [sign, word] if sign.is("::") && word.is_word() => words.push(word.0.clone()),
            _ => break,
        }
    }
    words
}

/// All paths of a tree of imports, with the names that they get.
fn branches(tree: &[Token]) -> Vec<(String, Vec<String>)> {
    let (mut found, mut depth, mut start) = (Vec::new(), 0, 0);
    for at in 0..=tree.len() {
        match tree.get(at).map(|token| token.0.as_str()) {
            Some("{") => depth += 1,
            Some("}") => depth -= 1,
            Some(",") | None if depth == 0 => {
                found.extend(branch(&tree[start..at]));
                start = at + 1;
            }
            _ => {}
        }
    }
    found
}

fn branch(tree: &[Token]) -> Vec<(String, Vec<String>)> {
    if let Some(open) = tree.iter().position(|token| token.is("{")) {
        let stem: Vec<String> = tree[..open]
            .iter()
            .filter(|token| token.is_word())
            .map(|token| token.0.clone())
            .collect();
        let inner = branches(&tree[open + 1..tree.len() - 1]);
        let whole = |(name, path): (String, Vec<String>)| match path.as_slice() {
            [own] if own == "self" => (stem.last().cloned().unwrap_or(name), stem.clone()),
            _ => (name, [stem.as_slice(), &path].concat()),
        };
        return inner.into_iter().map(whole).collect();
    }
    let (words, alias) = match tree.iter().position(|token| token.is("as")) {
        Some(at) => (&tree[..at], tree.get(at + 1)),
        None => (tree, None),
    };
    let path: Vec<String> = words
        .iter()
        .filter(|token| !token.is("::"))
        .map(|token| token.0.clone())
        .collect();
    let Some(last) = path.last() else {
        return Vec::new();
    };
    let name = alias.map_or_else(|| last.clone(), |alias| alias.0.clone());
    vec![(name, path)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(text: &str) -> Source {
        let mut source = Source::default();
        source.extend(&tokens(text).0);
        source
    }

    fn words(text: &str) -> Vec<String> {
        text.split("::").map(str::to_owned).collect()
    }

    #[test]
    fn trees_of_imports_become_paths() {
        let found = source("use crate::{a::{self, B as C}, d::*};\nfn f() { super::e::g(); }");
        let expected = ["crate::a", "crate::a::B", "crate::d::*", "super::e::g"];
        assert_eq!(found.paths, expected.map(words).into());
    }

    #[test]
    fn a_name_that_is_handed_on_is_looked_up_where_it_comes_from() {
        let files = [
            ("", "pub use a::Thing; use other::b;"),
            ("a", "pub struct Thing;"),
            ("c", "use crate::Thing; use crate::b::X;"),
        ];
        let module = |name: &str| {
            name.split('/')
                .filter(|w| !w.is_empty())
                .map(str::to_owned)
                .collect()
        };
        let files = files.map(|(name, text)| (module(name), source(text)));
        let uses = Sources {
            files: files.into(),
        }
        .uses();
        assert_eq!(uses[&module("c")], [module("a")].into());
        assert!(uses[&module("")].is_empty());
    }
}
