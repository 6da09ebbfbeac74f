//! What a diagnosis leaves open: effects that the recording does not exclude, and explanations that it
//! cannot tell apart.

use crate::language::Language;
use crate::number::{percent, significant};
use crate::phrase::{section, table};
use gumption_fault::say;
use gumption_format::document::{
    Block,
    ColumnKind::{Names as NamesColumn, Numbers, Wrapped},
    Table,
};
use gumption_lab::diagnose::{Diagnosis, Estimated, Separating, Unseen};

use super::names::{Names, unknown};
use super::words::measure;

/// More are in the JSON.
const MOST: usize = 8;

/// What effects cost that are not in the model, and the choice between explanations.
pub(super) fn lines(diagnosis: &Diagnosis, l: Language) -> Vec<Block> {
    let names = Names::of_diagnosis(diagnosis, l);
    let mut blocks = unseen(&diagnosis.unseen(), diagnosis.estimates(), names);
    blocks.extend(choices(diagnosis, names));
    blocks
}

/// What it costs not to know which explanation is right.
fn choices(diagnosis: &Diagnosis, names: Names<'_>) -> Option<Block> {
    let l = names.l;
    let choices = diagnosis.dear_choices().into_iter().map(|(slot, costs)| {
        let costs = costs.into_iter().map(|(own, u)| {
            let text = format!(
                "{} {} {}",
                unknown(&own.name, l),
                significant(u, 2),
                own.unit
            );
            text.trim().to_owned()
        });
        let costs: Vec<String> = costs.collect();
        let slot = &diagnosis.examination.slots[slot];
        let either = l.either(&names.slot(diagnosis, slot));
        let costs = costs.join(l.comma());
        say!("Not to know whether it is {either} costs u: {costs}.").in_language(l)
    });
    let choices: Vec<String> = choices.collect();
    (!choices.is_empty()).then_some(Block::List(choices))
}

/// What may be there unseen, for a diagnosis or a plan.
pub(super) fn unseen(unseen: &Unseen<'_>, estimates: &[Estimated], names: Names<'_>) -> Vec<Block> {
    let l = names.l;
    let mut blocks = Vec::new();
    if !unseen.dear.is_empty() {
        blocks.push(Block::Table(dear(unseen, estimates, names)));
        let rest = unseen.dear.len().saturating_sub(MOST);
        if rest > 0 {
            blocks.push(Block::Paragraph(
                say!("{rest} more are in the JSON.").in_language(l),
            ));
        }
        blocks.push(Block::Paragraph(say!("Sizes are uniformly distributed between − and + the usual shift of the output, as far as the recording does not exclude them. State better ones below [diagnosis] typical.").in_language(l)));
    }
    let hidden = unseen.hidden.iter().take(MOST).map(|(line, at)| {
        let (what, parameter) = (names.full(line.cell), &estimates[*at].name);
        let gain = significant(line.after.gain[*at], 2);
        say!("{what}: hides in {parameter}, {gain} per unit of the largest shift of the output; no size is usual").in_language(l)
    });
    let hidden: Vec<String> = hidden.collect();
    if !hidden.is_empty() {
        blocks.push(Block::List(hidden));
    }
    if !blocks.is_empty() {
        let heading = section(
            l,
            "What may be there unseen, and its line in the budget",
            "可能存在而未被看见的影响及其不确定度分量",
        );
        blocks.insert(0, heading);
    }
    blocks
}

fn dear(unseen: &Unseen<'_>, estimates: &[Estimated], names: Names<'_>) -> Table {
    let l = names.l;
    let mut table = table(
        l,
        [
            ("effect", "影响", Wrapped),
            ("visible", "可见", Numbers),
            ("usual shift", "常见大小", Numbers),
            ("parameter", "参数", NamesColumn),
            ("u", "u", Numbers),
            ("u without it", "不计此项的 u", Numbers),
        ],
    );
    for (line, at) in unseen.dear.iter().take(MOST) {
        let own = &estimates[*at];
        table.push(vec![
            names.full(line.cell).into(),
            format!("{} %", percent(line.visibility)).into(),
            line.shift
                .map_or(String::new(), |s| significant(s, 2))
                .into(),
            unknown(&own.name, l).into(),
            significant(line.after.u[*at], 2).into(),
            significant(own.u, 2).into(),
        ]);
    }
    table
}

/// What cannot be told apart, and what would help.
pub(super) fn rivals(diagnosis: &Diagnosis, l: Language) -> Vec<Block> {
    let names = Names::of_diagnosis(diagnosis, l);
    let mut all = diagnosis.separating.iter();
    let heading = match all.all(|of| diagnosis.stands_alone(of)) {
        true => section(
            l,
            "What would tell near rivals apart for certain",
            "可进一步排除相近解释的补充测量",
        ),
        false => section(
            l,
            "What this recording cannot tell apart, and what would",
            "本记录无法区分的解释及所需的补充测量",
        ),
    };
    let lists = diagnosis.separating.iter();
    let lists: Vec<Block> = lists
        .flat_map(|of| separating(diagnosis, of, names))
        .collect();
    match lists.is_empty() {
        true => lists,
        false => [vec![heading], lists].concat(),
    }
}

fn separating(diagnosis: &Diagnosis, of: &Separating, names: Names<'_>) -> Vec<Block> {
    /// Measurements that are shown.
    const SHOWN: usize = 4;
    let l = names.l;
    let rivals: Vec<String> = of.rivals.iter().map(|cell| names.full(*cell)).collect();
    let same = inseparable(of, &rivals, l);
    let rivals = match rivals.as_slice() {
        [first, others @ ..] if diagnosis.stands_alone(of) => {
            let others = others.join(l.list_comma());
            say!("{first}, named alone; {others} could look the same, but is less likely")
                .in_language(l)
        }
        _ => l.either(&rivals),
    };
    let kappa = significant(of.kappa, 2);
    let mut table = table(
        l,
        [
            ("further measurement", "补充测量", Wrapped),
            ("κ", "κ", Numbers),
            ("decides", "可判定", Numbers),
            ("times", "次数", Numbers),
            ("cost", "代价", Numbers),
        ],
    );
    for (extra, worth) in of.useful().take(SHOWN) {
        table.push(vec![
            measure(&extra.measure, l).into(),
            significant(worth.kappa, 2).into(),
            format!("{} %", percent(worth.resolved)).into(),
            significant(worth.repeats.ceil(), 2).into(),
            significant(extra.cost, 2).into(),
        ]);
    }
    if table.rows.is_empty() {
        return vec![Block::Paragraph(say!("{rivals}: κ = {kappa}, and no measurement that is known here is likely to decide. Name others as [[action]].").in_language(l))];
    }
    let head =
        say!("{rivals}: κ = {kappa} as it is.{same} With a further measurement:").in_language(l);
    vec![Block::Paragraph(head), Block::Table(table)]
}

/// Explanations that no measurement of the table tells apart.
fn inseparable(of: &Separating, rivals: &[String], l: Language) -> String {
    let sentence = |class: Vec<usize>| {
        let own: Vec<String> = class.into_iter().map(|at| rivals[at].clone()).collect();
        let own = l.pick(own.join(" and "), l.list(&own));
        say!(" What says the same in all of these, and stays undecided: {own}.").in_language(l)
    };
    of.inseparable().into_iter().map(sentence).collect()
}
