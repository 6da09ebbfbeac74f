//! The audit of a claimed budget as a document: the answer on one page, then how the sheet was understood.

mod form;
mod plot;
mod words;

use gumption_audit::calculate::Figures;
use gumption_audit::claim::Claimed;
use gumption_audit::printed::Printed;
use gumption_audit::rules::{self, Bearing, Finding};
use gumption_audit::search::{Explanation, Gap};
use gumption_audit::slips::Act;
use gumption_audit::{Audit, Verdict};
use gumption_fault::say;
use gumption_format::document::{Block, Cell, ColumnKind, Document, KeyFigure, Table};
use gumption_format::machine;
use serde_json::Value;

use crate::language::Language;
use crate::number::{NONE, freedom, significant};

/// The audit of one file as a document: of each budget that it holds.
pub fn audit(file: &str, audits: &[Audit<'_>], language: Language) -> Document {
    let machine = form::AuditJson::of(file, audits);
    let mut blocks = Vec::new();
    for audit in audits {
        blocks.extend(one(file, audit, language));
    }
    let plots = audits.iter().enumerate();
    let plots = plots.filter_map(|(i, audit)| plot::contributions(i + 1, audit, language));
    Document::new(&machine, language, blocks).with_plots(plots.collect())
}

/// Schema of the machine form.
pub fn audit_schema() -> Value {
    machine::schema::<form::AuditJson>("gumption audit --json")
}

fn one(file: &str, audit: &Audit<'_>, language: Language) -> Vec<Block> {
    let claimed = audit.found.case.claimed;
    let title = if claimed.title.is_empty() {
        file
    } else {
        &claimed.title
    };
    let mut blocks = vec![
        Block::Title(title.to_string()),
        Block::Fields(fields(file, claimed, language)),
        Block::Figures(figures(audit, language)),
        Block::Statement(words::verdict(audit, language)),
    ];
    if audit.verdict == Verdict::Sound && !audit.found.untold.is_empty() {
        blocks.push(Block::Section(
            say!("What the printed digits do not tell").in_language(language),
        ));
        let sets = audit.found.untold.iter().map(std::slice::from_ref);
        blocks.push(explanations(audit, sets, language));
    }
    let listed = &audit.found.explanations;
    let is_open = !matches!(audit.verdict, Verdict::Sound | Verdict::NotRecomputed);
    if is_open && !listed.is_empty() {
        blocks.push(Block::Section(
            say!("What gives the claimed figures").in_language(language),
        ));
        let sets = listed.iter().map(|one| one.acts.as_slice());
        blocks.push(explanations(audit, sets, language));
        blocks.extend(words::question(audit, language).map(Block::Paragraph));
    }
    if !audit.found.gaps.is_empty() && listed.is_empty() {
        blocks.push(Block::Section(
            say!("Where the claim departs").in_language(language),
        ));
        blocks.push(Block::List(
            audit
                .found
                .gaps
                .iter()
                .map(|gap| words::gap(audit, gap, language))
                .collect(),
        ));
    }
    blocks.extend(findings(audit, language));
    blocks.push(Block::Section(
        say!("Recomputed from what is stated").in_language(language),
    ));
    blocks.push(Block::Table(rows(audit, language)));
    if let Some(trouble) = &audit.found.case.trouble {
        blocks.push(Block::Paragraph(
            say!("The model was not used: {trouble}").in_language(language),
        ));
    }
    if audit.found.takes_result() {
        blocks.push(Block::Paragraph(say!("The result itself was taken as it stands: the sheet states no model, and no estimates, that would give it.").in_language(language)));
    }
    if audit.found.takes_freedom() {
        blocks.push(Block::Paragraph(
            say!("ν_eff was taken as it stands: no row tells its degrees of freedom.")
                .in_language(language),
        ));
    }
    blocks.push(Block::Section(
        say!("How the sheet was understood").in_language(language),
    ));
    blocks.push(Block::Table(understood(claimed, language)));
    if !claimed.unplaced.is_empty() {
        blocks.push(Block::Paragraph(
            say!("Not used in the calculation:").in_language(language),
        ));
        blocks.push(Block::List(
            claimed
                .unplaced
                .iter()
                .take(20)
                .map(|u| format!("{}: {}", u.at.a1(), u.text))
                .collect(),
        ));
    }
    blocks
}

fn fields(file: &str, claimed: &Claimed, language: Language) -> Vec<(String, String)> {
    let mut fields = vec![(language.pick("File", "文件").to_string(), file.to_string())];
    if let Some(model) = &claimed.model {
        let measurand = if claimed.measurand.is_empty() {
            "y"
        } else {
            &claimed.measurand
        };
        fields.push((
            language.pick("Model", "测量模型").into(),
            format!("{measurand} = {model}"),
        ));
    }
    fields
}

fn with_unit(text: String, unit: &str) -> String {
    if unit.is_empty() {
        text
    } else {
        format!("{text} {unit}")
    }
}

fn shown(figure: Option<&Printed>) -> String {
    figure.map_or(NONE.to_string(), |figure| figure.as_read().to_string())
}

fn figures(audit: &Audit<'_>, language: Language) -> Vec<KeyFigure> {
    let claimed = audit.found.case.claimed;
    let right = |figure: fn(&Figures) -> String| {
        audit.recomputed().as_ref().map_or(NONE.to_string(), figure)
    };
    let pick = |en: &str, zh: &str| language.pick(en, zh).to_string();
    // What is stated in the unit of the right figure beside it needs no unit.
    let in_its_unit = |figure: &Printed| match figure.unit.as_str() {
        unit if unit.is_empty() || unit == claimed.unit => figure.as_read().to_string(),
        _ => figure.with_unit(),
    };
    let figure = |name: &str, stated: Option<&Printed>, right: String| KeyFigure {
        name: name.to_string(),
        value: format!(
            "{right} ({} {})",
            pick("claimed", "声称"),
            stated.map_or(NONE.to_string(), in_its_unit)
        ),
        unit: String::new(),
    };
    let footer = &claimed.footer;
    let in_unit = |text: String| match text == NONE {
        true => text,
        false => with_unit(text, &claimed.unit),
    };
    let k = significant(audit.found.right.k, 3);
    let u_c = in_unit(right(|right| significant(right.u_c, 4)));
    let expanded = in_unit(right(|right| significant(right.expanded, 3)));
    let mut all = vec![figure("u_c", footer.u_c.as_ref(), u_c)];
    if footer.nu_eff.is_some() || audit.found.right.nu_eff < 1e5 {
        let nu_eff = right(|right| freedom(right.nu_eff));
        all.push(figure("ν_eff", footer.nu_eff.as_ref(), nu_eff));
    }
    all.push(figure("k", footer.k.as_ref(), k));
    all.push(figure("U", footer.expanded.as_ref(), expanded));
    all
}

/// Sets of slips, one below the other.
fn explanations<'s>(
    audit: &Audit<'_>,
    sets: impl Iterator<Item = &'s [Act]>,
    language: Language,
) -> Block {
    let mut table = Table::new([
        ("", ColumnKind::Numbers),
        (language.pick("slips", "差错"), ColumnKind::Words),
        (language.pick("where", "位置"), ColumnKind::Words),
        (language.pick("rules", "规则"), ColumnKind::Names),
    ]);
    /// More than these are not read; the machine form has all.
    const MOST: usize = 8;
    for (i, acts) in sets.take(MOST).enumerate() {
        for (j, act) in acts.iter().enumerate() {
            let number = if j == 0 {
                (i + 1).to_string()
            } else {
                String::new()
            };
            let place = act.row.map_or(String::new(), |row| {
                words::place(&audit.found.case.claimed.rows[row], row, language)
            });
            let text = format!(
                "{} [{}]",
                language.pick(act.slip.en, act.slip.zh),
                act.slip.id
            );
            table.push(vec![
                number.into(),
                text.into(),
                place.into(),
                act.slip.rule.into(),
            ]);
        }
    }
    Block::Table(table)
}

/// Whether the first explanation, or a gap, sits in a row.
fn is_marked(audit: &Audit<'_>, i: usize) -> bool {
    let best: Option<&Explanation> = audit.found.explanations.first();
    let slipped = best.is_some_and(|best| best.acts.iter().any(|act| act.row == Some(i)));
    let gaps = &audit.found.gaps;
    slipped
        || gaps
            .iter()
            .any(|gap| matches!(gap, Gap::Row(row, _) if *row == i))
}

/// U if everything in an explanation were corrected is the right one; what a single correction does is shown in words.
fn rows(audit: &Audit<'_>, language: Language) -> Table {
    let case = &audit.found.case;
    let mut table = Table::new([
        (language.pick("row", "行"), ColumnKind::Names),
        (language.pick("stated", "已知信息"), ColumnKind::Words),
        ("u", ColumnKind::Numbers),
        (language.pick("claimed u", "声称 u"), ColumnKind::Numbers),
        ("c", ColumnKind::Numbers),
        ("c·u", ColumnKind::Numbers),
        (language.pick("claimed", "声称"), ColumnKind::Numbers),
        ("ν", ColumnKind::Numbers),
        ("", ColumnKind::Marks),
    ]);
    for (i, (row, line)) in case.claimed.rows.iter().zip(&case.right.lines).enumerate() {
        let mark = if is_marked(audit, i) { "◀" } else { "" };
        let is_open = audit.missing.contains(&i);
        let contribution = match line.counted {
            true if is_open => NONE.to_string(),
            true => significant(line.contribution().abs(), 3),
            false => language.pick("not counted", "不计").to_string(),
        };
        let c = match is_open {
            true => NONE.to_string(),
            false => significant(line.c, 4),
        };
        let is_untold = audit.found.takes_freedom() && row.leaves_freedom_open();
        let dof = if is_untold {
            String::new()
        } else {
            freedom(line.dof)
        };
        table.push(vec![
            Cell::from(words::short(row)),
            words::stated(row, language).into(),
            significant(line.u, 3).into(),
            shown(row.u.as_ref()).into(),
            c.into(),
            contribution.into(),
            shown(row.contribution.as_ref()).into(),
            dof.into(),
            mark.into(),
        ]);
    }
    table.without_empty_columns()
}

/// What is against a rule: figures that slips explain, and what a reviewer asks besides.
fn findings(audit: &Audit<'_>, language: Language) -> Vec<Block> {
    let all = rules::findings(&audit.found);
    let (figures, questions): (Vec<Finding>, Vec<Finding>) = all
        .into_iter()
        .partition(|finding| finding.bearing == Bearing::Figures);
    let mut blocks = Vec::new();
    if !figures.is_empty() {
        blocks.push(Block::Section(
            language
                .pick("Rules that are broken", "违反的规则")
                .to_string(),
        ));
        blocks.push(Block::Table(broken_rules(audit, &figures, language)));
    }
    if !questions.is_empty() {
        blocks.push(Block::Section(
            language
                .pick("Questions to the laboratory", "请实验室说明的问题")
                .to_string(),
        ));
        blocks.push(Block::Paragraph(say!("The verdict does not depend on them: it is about figures that follow from what the sheet states.").in_language(language)));
        let mut questions: Vec<&Finding> = questions.iter().collect();
        questions.sort_by_key(|finding| finding.rule().weight);
        let texts = questions
            .into_iter()
            .map(|finding| question(audit, finding, language));
        blocks.push(Block::List(texts.collect()));
    }
    blocks
}

/// With its numbers, and what U would be if it alone were corrected.
fn broken_rules(audit: &Audit<'_>, figures: &[Finding], language: Language) -> Table {
    let mut table = Table::new([
        (language.pick("rule", "规则"), ColumnKind::Numbers),
        (language.pick("weight", "程度"), ColumnKind::Names),
        (language.pick("finding", "发现"), ColumnKind::Wrapped),
        (language.pick("where", "位置"), ColumnKind::Words),
        (language.pick("numbers", "数值"), ColumnKind::Words),
        (
            language.pick("U corrected", "改正后 U"),
            ColumnKind::Numbers,
        ),
        (language.pick("source", "依据"), ColumnKind::Words),
    ]);
    for finding in figures {
        let rule = finding.rule();
        table.push(vec![
            rule.number.to_string().into(),
            finding.said().in_language(language).into(),
            language.pick(rule.en, rule.zh).into(),
            place(audit, finding, language).into(),
            finding.numbers.clone().into(),
            finding
                .corrected
                .map_or(String::new(), |u| significant(u, 3))
                .into(),
            rule.clause.into(),
        ]);
    }
    table.without_empty_columns()
}

/// One line: what is asked, of which row, with which numbers, by which rule.
fn question(audit: &Audit<'_>, finding: &Finding, language: Language) -> String {
    let rule = finding.rule();
    let asked = language.pick(rule.en, rule.zh);
    let mut details = vec![place(audit, finding, language), finding.numbers.clone()];
    details.retain(|text| !text.is_empty());
    let number = rule.number;
    let clause = rule.clause;
    let source = say!(" (rule {number}; {clause})").in_language(language);
    match details.is_empty() {
        true => format!("{asked}{source}"),
        false => language.with_head(asked, &details.join(language.comma())) + &source,
    }
}

fn place(audit: &Audit<'_>, finding: &Finding, language: Language) -> String {
    let rows = &audit.found.case.claimed.rows;
    finding
        .row
        .map_or(String::new(), |row| words::place(&rows[row], row, language))
}

fn understood(claimed: &Claimed, language: Language) -> Table {
    let mut table = Table::new([
        (language.pick("cell", "单元格"), ColumnKind::Names),
        (language.pick("text", "内容"), ColumnKind::Words),
        (language.pick("taken as", "理解为"), ColumnKind::Words),
    ]);
    for one in &claimed.understood {
        table.push(vec![
            one.at.a1().into(),
            one.text.as_str().into(),
            words::role(one.role, language).into(),
        ]);
    }
    table
}
