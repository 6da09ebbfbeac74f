//! Two versions of a budget: what each edit changes.

use gumption_fault::say;
use gumption_format::document::{Block, ColumnKind, Document, Row, Table};
use gumption_format::machine::{Machine, Number, record};
use gumption_gum::versions::{Changed, Figures, Incomparable, Shares, Versions};

use crate::language::Language;
use crate::number::{TABLE_DIGITS, significant};

/// The document of what edits change.
pub fn versions(found: &Versions, language: Language) -> Document {
    Document::new(&form(found), language, blocks(found, language))
}

/// Why versions cannot be compared.
pub fn incomparable(why: &Incomparable, language: Language) -> String {
    match why {
        Incomparable::Failed(error) => error.said().in_language(language),
        Incomparable::Refused(_) | Incomparable::Unreadable => say!(
            "one of the versions has faults, or no rows: both have to be evaluated to be compared"
        )
        .in_language(language),
    }
}

record! {
    /// What the edits between two versions of a budget change.
    VersionsJson<'a> {
        /// Entries of the file that differ; several where none of them can be made without the others.
        edits: &'a [Vec<String>],
        /// Whether shares are the mean over all orders of the edits, which adds up; else each edit is made alone.
        adds_up: bool,
        /// The measurands that both versions have.
        measurands: Vec<ChangedJson<'a>>,
    }

    /// A measurand in both versions.
    ChangedJson<'a> {
        /// Its name.
        measurand: &'a str,
        /// Its unit.
        unit: &'a str,
        /// The earlier version.
        before: FiguresJson,
        /// The later version.
        after: FiguresJson,
        /// What each edit changes, in the order of the edits.
        by_edit: Vec<FiguresJson>,
        /// What that leaves of the change.
        left: FiguresJson,
    }

    /// An estimate and its expanded uncertainty, or a change of them.
    FiguresJson {
        /// y.
        y: Number,
        /// U.
        expanded: Number,
    }
}

impl Machine for VersionsJson<'_> {
    const KIND: &'static str = "versions";
    const VERSION: u32 = 1;
}

fn form(found: &Versions) -> VersionsJson<'_> {
    let figures = |figures: Figures| FiguresJson {
        y: Number(figures.estimate),
        expanded: Number(figures.expanded),
    };
    let changed = found.measurands.iter().map(|one| ChangedJson {
        measurand: &one.name,
        unit: &one.unit,
        before: figures(one.before),
        after: figures(one.after),
        by_edit: one.by_edit.iter().map(|edit| figures(*edit)).collect(),
        left: figures(one.left()),
    });
    VersionsJson {
        edits: &found.edits,
        adds_up: found.shares == Shares::Mean,
        measurands: changed.collect(),
    }
}

fn blocks(found: &Versions, l: Language) -> Vec<Block> {
    let mut blocks = vec![Block::Title(
        l.pick("What was changed", "改动的影响").to_owned(),
    )];
    if found.edits.is_empty() {
        let same = say!("No entry that enters a figure differs.").in_language(l);
        blocks.push(Block::Paragraph(same));
        return blocks;
    }
    for one in &found.measurands {
        blocks.push(Block::Section(one.name.clone()));
        blocks.push(Block::Table(table(found, one, l)));
    }
    let how = match found.shares {
        Shares::Mean => say!("By the law of propagation of uncertainty. What an edit changes depends on which others are made already: its share is the mean over all orders in which the edits can be made (Shapley value), and the shares add up to the whole change. Entries on one line cannot be made without each other.").in_language(l),
        Shares::Alone => say!("By the law of propagation of uncertainty. There are many edits: each is made alone in the earlier version, and what all of them together change beyond that is left.").in_language(l),
    };
    blocks.push(Block::Paragraph(how));
    blocks
}

fn table(found: &Versions, one: &Changed, l: Language) -> Table {
    let with_unit = |name: &str| match one.unit.as_str() {
        "" => name.to_owned(),
        unit => format!("{name} / {unit}"),
    };
    let mut table = Table::new([
        (l.pick("edit", "改动"), ColumnKind::Wrapped),
        (&with_unit("y"), ColumnKind::Numbers),
        (&with_unit("U"), ColumnKind::Numbers),
    ]);
    let number = |x: f64| significant(x, TABLE_DIGITS).to_string();
    // What rounding leaves of figures that cancel is nothing.
    let size = Figures {
        estimate: one.before.estimate.abs().max(one.after.estimate.abs()),
        expanded: one.before.expanded.abs().max(one.after.expanded.abs()),
    };
    let share = |x: f64, size: f64| match x.abs() <= ROUNDING * size {
        true => "0".to_owned(),
        false if x > 0.0 => format!("+{}", number(x)),
        false => number(x),
    };
    let mut line = |name: String, y: String, expanded: String| {
        table.push(vec![name.into(), y.into(), expanded.into()]);
    };
    let whole = |figures: Figures| (number(figures.estimate), number(figures.expanded));
    let part = |figures: Figures| {
        (
            share(figures.estimate, size.estimate),
            share(figures.expanded, size.expanded),
        )
    };
    let (y, expanded) = whole(one.before);
    line(l.pick("before", "改动前").to_owned(), y, expanded);
    for (edit, figures) in found.edits.iter().zip(&one.by_edit) {
        let (y, expanded) = part(*figures);
        line(edit.join(", "), y, expanded);
    }
    if found.shares == Shares::Alone {
        let (y, expanded) = part(one.left());
        line(l.pick("left", "剩余").to_owned(), y, expanded);
    }
    let (y, expanded) = whole(one.after);
    line(l.pick("after", "改动后").to_owned(), y, expanded);
    table.rows.insert(1, Row::Rule);
    let last = table.rows.len() - 1;
    table.rows.insert(last, Row::Rule);
    table
}

/// Sums of a few hundred doubles are exact to this share of the largest.
const ROUNDING: f64 = 1e-12;
