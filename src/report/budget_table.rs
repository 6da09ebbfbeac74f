//! The budget table: one row per input, its components below it, shared sources, the result; then
//! where each standard uncertainty comes from.

use crate::budget::{Component, Evaluation as Kind, Input, Owner, Term};
use crate::propagate::{Contribution, CoverageBasis, FindingKind, Freedom, Gum, is_residue};

use super::document::Block;
use super::language::{Language, Word};
use super::number::{
    NONE, TABLE_DIGITS, aligned, exact, freedom, percent, probability, significant,
};
use super::statement::coefficient;
use super::table::{Cell, ColumnKind, Row, Table};
use super::{Report, difference_symbol, symbol};

/// Rows that a reader takes in; a longer budget is sorted and its small rows are summed up.
const LONG: usize = 40;

/// Share of variance below which a row of a long budget is not shown.
const SMALL: f64 = 0.001;

/// The inputs of one measurand in the order of display.
struct Selection {
    shown: Vec<usize>,
    /// Inputs left out of a long table.
    elided: Vec<usize>,
    /// Inputs that do not act on this measurand at all.
    without_effect: Vec<usize>,
}

/// The table of one measurand with what belongs below it.
pub(super) fn blocks(report: &Report<'_>, measurand: usize) -> Vec<Block> {
    let selection = select(report, measurand);
    let mut blocks = vec![Block::Table(table(report, measurand, &selection))];
    if !selection.without_effect.is_empty() {
        let names: Vec<String> = selection
            .without_effect
            .iter()
            .map(|i| report.budget.inputs[*i].name.clone())
            .collect();
        let shown = shortened(&names, report.language);
        blocks.push(Block::Paragraph(match report.language {
            Language::English => format!(
                "Without effect on {}: {shown}.",
                report.measurand(measurand).0
            ),
            Language::Chinese => format!(
                "对 {} 没有影响的输入量：{shown}。",
                report.measurand(measurand).0
            ),
        }));
    }
    blocks.push(Block::Fields(footer(report, measurand)));
    if let Some(groups) = subtotals(report, measurand) {
        blocks.push(Block::Section(
            report.language.word(Word::Groups).to_string(),
        ));
        blocks.push(Block::Table(groups));
    }
    blocks
}

/// At most a dozen names, and how many more there are.
fn shortened(names: &[String], language: Language) -> String {
    const MOST: usize = 12;
    if names.len() <= MOST {
        return language.list(names);
    }
    let more = names.len() - MOST;
    match language {
        Language::English => format!("{} and {more} more", names[..MOST].join(", ")),
        Language::Chinese => format!("{}等 {} 个", names[..MOST].join("、"), more + MOST),
    }
}

fn select(report: &Report<'_>, measurand: usize) -> Selection {
    let contributions = &report.evaluation.results[measurand].gum.inputs;
    let several = report.evaluation.results.len() > 1;
    let hidden = |i: &usize| {
        let name = &report.budget.inputs[*i].name;
        let flagged = |k: &FindingKind| matches!(k, FindingKind::VanishingSensitivity { inputs, .. } if inputs.contains(name));
        several && contributions[*i].sensitivity == 0.0 && !report.finds(measurand, flagged)
    };
    let (without_effect, mut shown): (Vec<usize>, Vec<usize>) =
        (0..contributions.len()).partition(hidden);
    let mut elided = Vec::new();
    if shown.len() > LONG {
        shown.sort_by(|a, b| {
            contributions[*b]
                .share
                .abs()
                .total_cmp(&contributions[*a].share.abs())
        });
        let keep = shown
            .iter()
            .take(LONG)
            .take_while(|i| contributions[**i].share.abs() >= SMALL)
            .count();
        elided = shown.split_off(keep);
    }
    Selection {
        shown,
        elided,
        without_effect,
    }
}

fn table(report: &Report<'_>, measurand: usize, selection: &Selection) -> Table {
    let l = report.language;
    let gum = &report.evaluation.results[measurand].gum;
    let (name, unit) = report.measurand(measurand);
    let mut table = Table::new([
        (l.word(Word::Quantity), ColumnKind::Names),
        (l.word(Word::Estimate), ColumnKind::Numbers),
        (l.word(Word::Unit), ColumnKind::Words),
        ("u", ColumnKind::Numbers),
        (l.word(Word::Distribution), ColumnKind::Words),
        (l.word(Word::FreedomShort), ColumnKind::Numbers),
        (l.word(Word::Sensitivity), ColumnKind::Numbers),
        (l.word(Word::Contribution), ColumnKind::Numbers),
        (l.word(Word::Share), ColumnKind::Numbers),
        ("", ColumnKind::Bar),
    ]);
    for i in &selection.shown {
        input_rows(report, gum, *i, &mut table);
    }
    if !selection.elided.is_empty() {
        table
            .rows
            .push(Row::Across(elision(l, gum, &selection.elided)));
    }
    source_rows(report, gum, &mut table);
    table.rows.push(Row::Rule);
    table.push(vec![
        name.into(),
        aligned(gum.estimate, gum.u, 2).into(),
        symbol(unit).into(),
        significant(gum.u, TABLE_DIGITS).into(),
        Cell::Empty,
        freedom(gum.freedom.value()).into(),
        Cell::Empty,
        significant(gum.u, TABLE_DIGITS).into(),
        percent(gum.inputs.iter().map(|c| c.share).sum()).into(),
    ]);
    table
}

fn input_rows(report: &Report<'_>, gum: &Gum, i: usize, table: &mut Table) {
    let budget = report.budget;
    let (input, line) = (&budget.inputs[i], &gum.inputs[i]);
    let only: Option<&Component> = match input.terms.as_slice() {
        [term] => budget.components.get(term.component),
        _ => None,
    };
    table.push(vec![
        input.name.clone().into(),
        aligned(input.estimate, line.u, 2).into(),
        symbol(&input.unit).into(),
        significant(line.u, TABLE_DIGITS).into(),
        only.map_or(Cell::Empty, |c| distribution(c, report.language).into()),
        freedom(line.dof).into(),
        sensitivity(line, gum, input.estimate).into(),
        contribution(line.contribution, gum).into(),
        share(line, gum).into(),
        Cell::Share(line.share),
    ]);
    if input.terms.len() > 1 {
        for term in &input.terms {
            component_row(report, gum, (input, line), term, table);
        }
    }
}

fn component_row(
    report: &Report<'_>,
    gum: &Gum,
    (input, line): (&Input, &Contribution),
    term: &Term,
    table: &mut Table,
) {
    let component = &report.budget.components[term.component];
    let u = term.coefficient.abs() * component.u;
    // The share of a shared component is in its own row: it acts through several inputs at once.
    let share: Cell = if shared_components(report).contains(&term.component) {
        NONE.into()
    } else {
        share(&gum.components[term.component], gum).into()
    };
    table.push(vec![
        Cell::Part(component.label.clone()),
        Cell::Empty,
        difference_symbol(&input.unit).into(),
        significant(u, TABLE_DIGITS).into(),
        distribution(component, report.language).into(),
        freedom(component.dof).into(),
        Cell::Empty,
        contribution(line.sensitivity * term.coefficient * component.u, gum).into(),
        share,
    ]);
}

fn source_rows(report: &Report<'_>, gum: &Gum, table: &mut Table) {
    let sources: Vec<usize> = shared_components(report);
    if sources.is_empty() {
        return;
    }
    table.rows.push(Row::Rule);
    table
        .rows
        .push(Row::Across(report.language.word(Word::Shared).to_string()));
    for t in sources {
        let (component, line) = (&report.budget.components[t], &gum.components[t]);
        table.push(vec![
            component.name.clone().into(),
            Cell::Empty,
            symbol(&component.unit).into(),
            significant(line.u, TABLE_DIGITS).into(),
            distribution(component, report.language).into(),
            freedom(line.dof).into(),
            sensitivity(line, gum, 0.0).into(),
            contribution(line.contribution, gum).into(),
            share(line, gum).into(),
            Cell::Share(line.share),
        ]);
    }
}

/// A sensitivity coefficient; zero where only rounding kept it from being zero. An input whose u is
/// negligible has a small contribution too, but its c still carries its estimate into y.
fn sensitivity(line: &Contribution, gum: &Gum, estimate: f64) -> String {
    let whole = gum.estimate.abs().max(gum.u);
    let residue =
        is_residue(line.contribution, gum.u) && is_residue(line.sensitivity * estimate, whole);
    significant(if residue { 0.0 } else { line.sensitivity }, 4)
}

fn contribution(product: f64, gum: &Gum) -> String {
    let residue = is_residue(product, gum.u);
    significant(if residue { 0.0 } else { product }, TABLE_DIGITS)
}

fn share(line: &Contribution, gum: &Gum) -> String {
    let residue = is_residue(line.contribution, gum.u);
    percent(if residue { 0.0 } else { line.share })
}

/// Sources, and components that several elements of a vector have in common; ascending.
fn shared_components(report: &Report<'_>) -> Vec<usize> {
    let mut inputs = vec![0_usize; report.budget.components.len()];
    for term in report.budget.inputs.iter().flat_map(|input| &input.terms) {
        inputs[term.component] += 1;
    }
    let components = report.budget.components.iter().zip(inputs).enumerate();
    components
        .filter(|(_, (c, inputs))| *inputs > 1 || matches!(c.owner, Owner::Source(_)))
        .map(|(t, _)| t)
        .collect()
}

/// `normal (B)`.
fn distribution(component: &Component, language: Language) -> String {
    let named = component.distribution.kind();
    // The table has no room for second names and for the word distribution in every row.
    let short = named
        .name_zh
        .split('(')
        .next()
        .unwrap_or_default()
        .trim_end_matches("分布");
    format!(
        "{} ({})",
        language.pick(named.key, short),
        kind(component.evaluation)
    )
}

fn kind(evaluation: Kind) -> &'static str {
    match evaluation {
        Kind::TypeA => "A",
        Kind::TypeB => "B",
    }
}

fn elision(language: Language, gum: &Gum, elided: &[usize]) -> String {
    let largest = elided
        .iter()
        .map(|i| gum.inputs[*i].share.abs())
        .fold(0.0, f64::max);
    let together: f64 = elided.iter().map(|i| gum.inputs[*i].share).sum();
    let count = elided.len();
    let together = percent(together);
    match (largest < SMALL, language) {
        (true, Language::English) => {
            format!("… {count} inputs below 0.1 % each, together {together} %")
        }
        (true, Language::Chinese) => {
            format!("…… 其余 {count} 个输入量各小于 0.1 %，合计 {together} %")
        }
        (false, Language::English) => format!(
            "… {count} inputs of at most {} % each, together {together} %",
            percent(largest)
        ),
        (false, Language::Chinese) => format!(
            "…… 其余 {count} 个输入量各不大于 {} %，合计 {together} %",
            percent(largest)
        ),
    }
}

/// y, u_c, ν_eff, k and U.
fn footer(report: &Report<'_>, measurand: usize) -> Vec<(String, String)> {
    let gum = &report.evaluation.results[measurand].gum;
    let (name, unit) = report.measurand(measurand);
    let l = report.language;
    let with = |number: String, unit: &str| {
        if unit.is_empty() {
            number
        } else {
            format!("{number} {unit}")
        }
    };
    let difference = difference_symbol(unit);
    let dof = match &gum.freedom {
        Freedom::Refused { lower_bound, .. } => format!("≥ {}", freedom(*lower_bound)),
        Freedom::Ensembles(v) | Freedom::WelchSatterthwaite(v) => format!("= {}", freedom(*v)),
        Freedom::Infinite => "= ∞".to_string(),
    };
    let coverage = &gum.coverage;
    let k = significant(coverage.k, TABLE_DIGITS);
    let basis = super::comparison::basis_of_k(coverage, l);
    let fixed = coverage.basis == CoverageBasis::Fixed;
    // A fixed k has the profile's probability only where the distribution of the result grants it.
    let conventions = &report.budget.conventions;
    let granted = (coverage.probability - conventions.coverage_probability).abs() < 0.01;
    let p = if fixed && !(conventions.state_probability && granted) {
        l.pick("no probability stated", "不注明包含概率")
            .to_string()
    } else {
        format!("p = {}", probability(coverage.probability))
    };
    [
        (
            Word::Estimate,
            format!(
                "{name} = {}",
                with(aligned(gum.estimate, gum.u, 2), &symbol(unit))
            ),
        ),
        (
            Word::CombinedUncertainty,
            format!(
                "u_c = {}",
                with(significant(gum.u, TABLE_DIGITS), &difference)
            ),
        ),
        (Word::FreedomEffective, format!("ν_eff {dof}")),
        (
            Word::Factor,
            l.pick(
                format!("k = {k} ({basis}, {p})"),
                format!("k = {k}（{basis}，{p}）"),
            ),
        ),
        (
            Word::Expanded,
            format!(
                "U = {}",
                with(significant(coverage.expanded, TABLE_DIGITS), &difference)
            ),
        ),
    ]
    .map(|(word, text)| (l.word(word).to_string(), text))
    .to_vec()
}

fn subtotals(report: &Report<'_>, measurand: usize) -> Option<Table> {
    let gum = &report.evaluation.results[measurand].gum;
    let l = report.language;
    let mut groups: Vec<(Option<&str>, f64)> = Vec::new();
    for (input, line) in report.budget.inputs.iter().zip(&gum.inputs) {
        let group = input.group.as_deref();
        match groups.iter_mut().find(|(g, _)| *g == group) {
            Some((_, share)) => *share += line.share,
            None => groups.push((group, line.share)),
        }
    }
    if groups.iter().all(|(g, _)| g.is_none()) {
        return None;
    }
    let mut table = Table::new([
        (l.word(Word::InputGroup), ColumnKind::Names),
        (l.word(Word::StandardUncertainty), ColumnKind::Numbers),
        (l.word(Word::Share), ColumnKind::Numbers),
        ("", ColumnKind::Bar),
    ]);
    for (group, share) in groups {
        // Under correlation a group may lower u(y): it then has no standard uncertainty of its own.
        let u = if share >= 0.0 {
            significant(share.sqrt() * gum.u, TABLE_DIGITS)
        } else {
            NONE.to_string()
        };
        let name = group.unwrap_or(l.pick("(without group)", "（未分组）"));
        table.push(vec![
            name.into(),
            u.into(),
            percent(share).into(),
            Cell::Share(share),
        ]);
    }
    Some(table)
}

/// How each u was found, and from which certificate.
pub(super) fn origins(report: &Report<'_>) -> Vec<Block> {
    let l = report.language;
    let mut table = Table::new([
        (l.word(Word::Component), ColumnKind::Names),
        (l.word(Word::TypeShort), ColumnKind::Words),
        (l.word(Word::Where), ColumnKind::Wrapped),
        (l.word(Word::Sources), ColumnKind::Wrapped),
    ]);
    let components = &report.budget.components;
    let mut order: Vec<usize> = (0..components.len()).collect();
    let weight = |t: usize| -> f64 {
        let shares = report
            .evaluation
            .results
            .iter()
            .filter_map(|r| r.gum.components.get(t));
        shares.map(|c| c.share.abs()).fold(0.0, f64::max)
    };
    if order.len() > LONG {
        order.sort_by(|a, b| weight(*b).total_cmp(&weight(*a)));
        order.truncate(LONG);
        order.retain(|t| weight(*t) >= SMALL);
    }
    for t in &order {
        let component = &components[*t];
        let from = provenance(component, l);
        table.push(vec![
            component.name.clone().into(),
            kind(component.evaluation).into(),
            super::how::how(&component.how, l).into(),
            from.into(),
        ]);
    }
    let left_out = components.len() - order.len();
    if left_out > 0 {
        table.rows.push(Row::Across(match l {
            Language::English => {
                format!("… and {left_out} smaller ones; all are in the JSON output")
            }
            Language::Chinese => format!("…… 其余 {left_out} 个较小的分量见 JSON 输出"),
        }));
    }
    vec![
        Block::Section(l.word(Word::Origin).to_string()),
        Block::Table(table.without_empty_columns()),
    ]
}

fn provenance(component: &Component, language: Language) -> String {
    let certificate = component.certificate.iter();
    let mut parts: Vec<String> = certificate
        .flat_map(|c| {
            let due = c
                .due
                .as_ref()
                .map(|due| language.pick(format!("due {due}"), format!("有效期至 {due}")));
            [c.number.clone(), c.laboratory.clone(), c.date.clone(), due]
        })
        .flatten()
        .collect();
    parts.extend(component.reference.clone());
    parts.join(language.pick(", ", "，"))
}

/// Correlated components, as pairs or in short.
pub(super) fn correlated(report: &Report<'_>) -> Vec<Block> {
    /// More pairs are for the JSON output.
    const MOST: usize = 24;
    let l = report.language;
    let name = |t: usize| report.budget.components[t].name.as_str();
    let mut pairs = Vec::new();
    for group in &report.budget.groups {
        for (i, a) in group.members.iter().enumerate() {
            for (j, b) in group.members.iter().enumerate().skip(i + 1) {
                let r = group.correlation[(i, j)];
                if r != 0.0 {
                    pairs.push(format!(
                        "r({}, {}) = {}",
                        name(*a),
                        name(*b),
                        coefficient(r)
                    ));
                }
            }
        }
    }
    if pairs.is_empty() {
        return Vec::new();
    }
    let left_out = pairs.len().saturating_sub(MOST);
    pairs.truncate(MOST);
    if left_out > 0 {
        pairs.push(l.pick(
            format!("… and {left_out} more"),
            format!("…… 其余 {left_out} 对"),
        ));
    }
    vec![
        Block::Section(l.word(Word::CorrelatedComponents).to_string()),
        Block::List(pairs),
    ]
}

/// Exactly known quantities.
pub(super) fn constants(report: &Report<'_>) -> Vec<Block> {
    /// Elements of a vector that are shown.
    const MOST: usize = 6;
    let lines: Vec<(String, String)> = report
        .budget
        .constants
        .iter()
        .map(|c| {
            let unit = symbol(&c.unit);
            let mut numbers: Vec<String> = c.values.iter().take(MOST).map(|v| exact(*v)).collect();
            if c.values.len() > MOST {
                numbers.push(format!("… ({})", c.values.len()));
            }
            let mut text = numbers.join(", ");
            for more in [Some(&unit), c.description.as_ref(), c.reference.as_ref()]
                .into_iter()
                .flatten()
                .filter(|t| !t.is_empty())
            {
                text.push_str(if more == &unit { " " } else { "; " });
                text.push_str(more);
            }
            (c.name.clone(), text)
        })
        .collect();
    if lines.is_empty() {
        return Vec::new();
    }
    vec![
        Block::Section(report.language.word(Word::Exact).to_string()),
        Block::Fields(lines),
    ]
}
