//! Sobol' sensitivity indices as a table.

use gumption_fault::say;
use gumption_gum::propagate::{SensitivityIndices, SobolIndex};

use super::Report;
use super::number::{at_place, grouped, print};
use gumption_format::document::Block;
use gumption_format::document::{Cell, ColumnKind, Table};

/// Indices with a standard error of less than half of 10⁻³ are printed with three decimals.
const PLACE: i32 = -3;

/// The table of one measurand; nothing where none was asked for.
pub(super) fn blocks(report: &Report<'_>, measurand: usize) -> Vec<Block> {
    let Some(indices) = &report.evaluation.indices else {
        return Vec::new();
    };
    let l = report.language;
    let title = l
        .pick("Sensitivity indices (Sobol')", "灵敏度指数（Sobol'）")
        .to_string();
    let Some(Some(of)) = indices.measurands.get(measurand) else {
        let none = say!(
            "There are no sensitivity indices, because the measurand has no standard deviation."
        )
        .in_language(l);
        return vec![Block::Section(title), Block::Paragraph(none)];
    };
    let mut blocks = vec![
        Block::Section(title),
        Block::Table(table(report, indices, of)),
    ];
    blocks.push(Block::List(sentences(report, indices, of)));
    blocks
}

/// Names of the inputs of a factor.
pub(super) fn names<'a>(report: &Report<'a>, factor: &[usize]) -> Vec<&'a str> {
    factor
        .iter()
        .map(|input| report.budget.inputs[*input].name.as_str())
        .collect()
}

fn table(report: &Report<'_>, indices: &SensitivityIndices, of: &[SobolIndex]) -> Table {
    let l = report.language;
    let mut table = Table::new([
        (l.pick("input", "输入量"), ColumnKind::Wrapped),
        (l.pick("first-order S", "一阶指数 S"), ColumnKind::Numbers),
        (l.pick("error of S", "S 的误差"), ColumnKind::Numbers),
        (l.pick("total S_T", "总指数 S_T"), ColumnKind::Numbers),
        (l.pick("error of S_T", "S_T 的误差"), ColumnKind::Numbers),
    ]);
    let show = |x: f64| print(&at_place(x, PLACE));
    let mut order: Vec<usize> = (0..of.len()).collect();
    order.sort_by(|a, b| of[*b].total.total_cmp(&of[*a].total));
    for factor in order {
        let index = of[factor];
        table.push(vec![
            Cell::Text(names(report, &indices.factors[factor]).join(", ")),
            show(index.first).into(),
            show(index.first_error).into(),
            show(index.total).into(),
            show(index.total_error).into(),
        ]);
    }
    table
}

fn sentences(report: &Report<'_>, indices: &SensitivityIndices, of: &[SobolIndex]) -> Vec<String> {
    let l = report.language;
    let trials = grouped(indices.trials);
    let sum = print(&at_place(of.iter().map(|index| index.first).sum(), PLACE));
    let of_sum = match SobolIndex::leave_a_part(of) {
        true => say!(
            "The first-order indices sum to {sum}; what is missing to 1 comes from inputs acting together."
        ),
        false => say!(
            "The first-order indices sum to {sum}, which is 1 within their errors: nothing shows inputs acting together."
        ),
    };
    let mut lines = vec![
        say!("S is the part of the variance that the input makes alone, S_T the part that it takes part in. {of_sum} Errors are standard errors, from two times {trials} trials.").in_language(l),
    ];
    for factor in indices.factors.iter().filter(|factor| factor.len() > 1) {
        let names: Vec<String> = names(report, factor)
            .into_iter()
            .map(String::from)
            .collect();
        let names = l.list(&names);
        lines.push(say!("{names} are correlated or share a source: they have indices together only, because the variance cannot be divided among inputs that are not independent.").in_language(l));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::super::language::Language;
    use super::super::{evaluation, fixtures};
    use super::*;
    use gumption_format::render::{Page, markdown::markdown, text::text};

    fn case() -> fixtures::Case {
        let mut case = fixtures::resistor();
        let index = |first, total| SobolIndex {
            first,
            first_error: 0.0004,
            total,
            total_error: 0.0006,
        };
        let inputs = case.budget.inputs.len();
        case.evaluation.indices = Some(SensitivityIndices {
            trials: 1 << 20,
            factors: vec![vec![0, 1], (2..inputs).collect()],
            measurands: vec![Some(vec![index(0.25, 0.3), index(0.7, 0.75)])],
        });
        case
    }

    #[test]
    fn the_largest_total_index_comes_first() {
        let case = case();
        let page = Page::default();
        let english = text(&evaluation(&case.report(Language::English)), page);
        let (first, second) = (english.find("0.750"), english.find("0.300"));
        assert!(first.is_some() && first < second, "{english}");
        assert!(english.contains("sum to 0.950") && english.contains("indices together only"));
        let chinese = text(&evaluation(&case.report(Language::Chinese)), page);
        assert!(chinese.contains("灵敏度指数") && chinese.contains("仅给出其整体指数"));
        assert!(markdown(&evaluation(&case.report(Language::English))).contains("| 0.750 |"));
    }

    #[test]
    fn machines_get_them_by_factor() {
        let case = case();
        let value = evaluation(&case.report(Language::English)).machine.value();
        let indices = &value["sensitivity_indices"];
        assert_eq!(indices["measurands"][0][1]["total"], 0.75);
        assert_eq!(indices["factors"][0].as_array().map(Vec::len), Some(2));
    }

    #[test]
    fn without_a_standard_deviation_there_are_none() {
        let mut case = case();
        let indices = case.evaluation.indices.as_mut();
        indices.expect("the case has indices").measurands = vec![None];
        let blocks = blocks(&case.report(Language::English), 0);
        assert!(matches!(
            &blocks[..],
            [Block::Section(_), Block::Paragraph(_)]
        ));
    }
}
