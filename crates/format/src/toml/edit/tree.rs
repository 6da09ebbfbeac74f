//! The same edits in the tree of what a text says, which the edited text has to say.

use toml::{Table, Value};

use crate::toml::places::Step;

/// The value at a path of a tree.
pub(super) fn at<'v>(tree: &'v mut Value, path: &[Step]) -> Option<&'v mut Value> {
    path.iter()
        .try_fold(tree, |there, step| match (there, step) {
            (Value::Table(table), Step::Key(key)) => table.get_mut(key),
            (Value::Array(list), Step::Index(at)) => list.get_mut(*at),
            _ => None,
        })
}

/// Writes a value into a tree, with the tables and lists on the way to it.
pub(super) fn put(tree: &mut Value, path: &[Step], value: Value) -> Option<()> {
    let Some((first, rest)) = path.split_first() else {
        *tree = value;
        return Some(());
    };
    let empty = match rest.first() {
        Some(Step::Index(_)) => Value::Array(Vec::new()),
        _ => Value::Table(Table::new()),
    };
    let next = match (tree, first) {
        (Value::Table(table), Step::Key(key)) => table.entry(key.clone()).or_insert(empty),
        (Value::Array(list), Step::Index(at)) => {
            if *at == list.len() {
                list.push(empty);
            }
            list.get_mut(*at)?
        }
        _ => return None,
    };
    put(next, rest, value)
}

/// Takes a value out of a tree.
pub(super) fn taken(tree: &mut Value, path: &[Step]) -> Option<Value> {
    let (last, parent) = path.split_last()?;
    match (at(tree, parent)?, last) {
        (Value::Table(table), Step::Key(key)) => table.remove(key),
        (Value::Array(list), Step::Index(at)) => (*at < list.len()).then(|| list.remove(*at)),
        _ => None,
    }
}

/// A tree from which something was taken, and those without the tables that it left empty: without a header of its own, a table goes
/// with the last that it held.
pub(super) fn with_emptied(tree: Value, path: &[Step]) -> Vec<Value> {
    let mut all = vec![tree];
    for length in (1..path.len()).rev() {
        let mut next = all[all.len() - 1].clone();
        let emptied = at(&mut next, &path[..length]).is_some_and(|there| match there {
            Value::Table(table) => table.is_empty(),
            Value::Array(list) => list.is_empty(),
            _ => false,
        });
        if !emptied || taken(&mut next, &path[..length]).is_none() {
            break;
        }
        all.push(next);
    }
    all
}
