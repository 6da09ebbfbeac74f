//! No circle: neither between crates, nor between the files of a crate, nor between its folders.

use std::collections::{BTreeMap, BTreeSet};

use super::matrix::{CRATES, sources};
use super::modules::{Module, Uses, name};

/// Groups of nodes that use one another in a circle.
pub fn rings<N: Ord + Clone>(uses: &BTreeMap<N, BTreeSet<N>>) -> Vec<Vec<N>> {
    let reach: BTreeMap<&N, BTreeSet<&N>> = uses
        .keys()
        .map(|node| (node, reachable(uses, node)))
        .collect();
    let mut found: Vec<Vec<N>> = Vec::new();
    for (node, reached) in &reach {
        if !reached.contains(node) || found.iter().flatten().any(|known| known == *node) {
            continue;
        }
        let ring = reached.iter().filter(|other| reach[**other].contains(node));
        found.push(ring.map(|other| (*other).clone()).collect());
    }
    found
}

fn reachable<'a, N: Ord>(uses: &'a BTreeMap<N, BTreeSet<N>>, start: &N) -> BTreeSet<&'a N> {
    let mut reached = BTreeSet::new();
    let mut open: Vec<&N> = uses.get(start).into_iter().flatten().collect();
    while let Some(node) = open.pop() {
        if uses.contains_key(node) && reached.insert(node) {
            open.extend(&uses[node]);
        }
    }
    reached
}

/// The same between the first folders or files below the root.
pub fn folders(uses: &Uses) -> BTreeMap<String, BTreeSet<String>> {
    let first = |module: &Module| module.first().cloned();
    let mut found: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for (module, used) in uses {
        let Some(folder) = first(module) else {
            continue;
        };
        let others = used
            .iter()
            .filter_map(first)
            .filter(|other| *other != folder);
        found.entry(folder.clone()).or_default().extend(others);
    }
    found
}

#[test]
fn no_circle_between_files_or_folders() {
    let mut circles = Vec::new();
    for krate in CRATES {
        let uses = &sources(krate);
        let (files, folders) = (rings(uses), rings(&folders(uses)));
        if !files.is_empty() || !folders.is_empty() {
            circles.push(krate.to_owned());
            circles.extend(files.iter().map(|ring| told(ring, uses)));
            circles.extend(
                folders
                    .iter()
                    .map(|ring| format!("  folders: {}", ring.join(", "))),
            );
        }
    }
    assert!(circles.is_empty(), "{}", circles.join("\n"));
}

fn told(ring: &[Module], uses: &Uses) -> String {
    let of = |module: &Module| {
        let within = uses[module].iter().filter(|used| ring.contains(used));
        let within: Vec<String> = within.map(|used| name(used)).collect();
        format!("    {} -> {}", name(module), within.join(", "))
    };
    let lines: Vec<String> = ring.iter().map(of).collect();
    format!("  {} files:\n{}", ring.len(), lines.join("\n"))
}

#[test]
fn a_ring_is_found_and_a_line_is_none() {
    let uses = |pairs: &[(&'static str, &[&'static str])]| {
        pairs
            .iter()
            .map(|(node, used)| (*node, used.iter().copied().collect()))
            .collect()
    };
    let line: BTreeMap<&str, BTreeSet<&str>> =
        uses(&[("a", &["b", "c"]), ("b", &["c"]), ("c", &[])]);
    assert!(rings(&line).is_empty());
    let ring = uses(&[("a", &["b"]), ("b", &["c"]), ("c", &["a"]), ("d", &["a"])]);
    assert_eq!(rings(&ring), [["a", "b", "c"]]);
}
