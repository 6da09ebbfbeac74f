//! What follows from the components: y, u, ν_eff, k, U; beside it what does not follow, the Monte Carlo result.

use gumption_format::document::{Entry, Held, address};
use gumption_gum::budget::{CoverageRule, DofRule, StatementForm};
use gumption_gum::propagate::{Basis, CoverageBasis, Freedom, SecondOrder, StatedProbability};

use super::components::Components;
use super::writer::{U_BELOW, Writer, freedom};
use crate::figures::Figures;
use crate::statement::form;
use crate::symbol;

/// Rows that the outcome takes.
pub(super) fn rows(writer: &Writer<'_>) -> usize {
    let result = &writer.report.evaluation.results[writer.measurand];
    let trials = match result.monte_carlo {
        Some(_) => 11,
        None => 0,
    };
    13 + trials
}

pub(super) fn write<'a>(writer: &mut Writer<'a>, components: &Components<'a>, value: String) {
    let report = writer.report;
    let result = &report.evaluation.results[writer.measurand];
    let (gum, coverage) = (&result.gum, &result.gum.coverage);
    writer.title("Result by the GUM", "GUM 法的结果");
    let name = report.measurand(writer.measurand).0.to_string();
    let (unit, of_u) = (
        symbol(report.measurand(writer.measurand).1),
        writer.unit_of_u(),
    );
    let first = writer.sheet.rows.len();
    let cell = |row: usize| address(1, first + row);
    let line = |name: String, entry: Entry, unit: &str| {
        vec![Entry::Words(name), entry, Entry::Words(unit.to_string())]
    };
    writer
        .sheet
        .push(line(name, Entry::formula(value, gum.estimate), &unit));
    let word = writer.word("combined standard uncertainty u", "合成标准不确定度 u");
    let combined = Entry::formula(components.combined(), gum.u);
    let at = writer.sheet.push(line(word, combined, &of_u));
    debug_assert_eq!(at, components.end() + U_BELOW, "shares refer to it");

    let dof = match gum.freedom {
        Freedom::Infinite | Freedom::WelchSatterthwaite(_) => Entry::Formula(
            components.welch_satterthwaite(&cell(1)),
            freedom(gum.freedom.value()),
        ),
        _ => match freedom(gum.freedom.value()) {
            Held::Number(dof) => Entry::Given(dof),
            Held::Words(words) => Entry::Words(words),
        },
    };
    let word = writer.word("effective degrees of freedom ν_eff", "有效自由度 ν_eff");
    writer.sheet.push(line(word, dof, ""));
    let conventions = &report.budget.conventions;
    let normal = format!("NORMSINV((1+{})/2)", cell(3));
    // Spreadsheets have t for whole numbers of degrees of freedom.
    let whole = conventions.degrees_of_freedom == DofRule::Truncated;
    let k = match (&coverage.basis, conventions.coverage_factor) {
        (CoverageBasis::Normal, CoverageRule::Normal) => Entry::formula(normal, coverage.k),
        (CoverageBasis::Normal, _) | (CoverageBasis::StudentT { .. }, _)
            if whole && gum.freedom.value() >= 1.0 =>
        {
            let t = format!("TINV(1-{},INT(ROUND({},2)))", cell(3), cell(2));
            Entry::formula(
                format!("IF(ISNUMBER({}),{t},{normal})", cell(2)),
                coverage.k,
            )
        }
        _ => Entry::Given(coverage.k),
    };
    let follows = matches!(k, Entry::Formula(..));
    let word = writer.word("coverage probability p", "包含概率 p");
    let p = match (follows, result.reported(conventions).probability) {
        (true, _) => Entry::Given(coverage.probability),
        (false, StatedProbability::Of(_)) => Entry::Fixed(coverage.probability),
        // What the statement does not state is not stated here either.
        (false, _) => writer.words("not stated: k is fixed", "不注明：k 为约定值"),
    };
    writer.sheet.push(line(word, p, ""));
    let word = writer.word("coverage factor k", "包含因子 k");
    writer.sheet.push(line(word, k, ""));
    let word = writer.word("expanded uncertainty U", "扩展不确定度 U");
    let expanded = Entry::formula(format!("{}*{}", cell(4), cell(1)), coverage.expanded);
    writer.sheet.push(line(word, expanded, &of_u));
    notes(writer, follows);
    trials(writer);
}

/// What the figures above do not say.
fn notes(writer: &mut Writer<'_>, follows: bool) {
    let report = writer.report;
    let result = &report.evaluation.results[writer.measurand];
    if !follows {
        let note = writer.words(
            "k is as it was evaluated, and does not follow when other cells are changed.",
            "k 为评定时的值，修改其他单元格时不随之变化。",
        );
        writer.sheet.push(vec![note]);
    }
    let matters = |of: &SecondOrder| of.matters;
    if result.second_order.as_ref().is_some_and(matters) {
        let note = writer.words(
            "This sheet is of first order; the report says what second order adds.",
            "本表只含一阶项，二阶项的影响见报告。",
        );
        writer.sheet.push(vec![note]);
    }
    if result.reported(&report.budget.conventions).basis == Basis::MonteCarlo {
        let note = writer.words(
            "The report states the Monte Carlo result, which this sheet does not follow.",
            "报告采用蒙特卡洛法的结果，本表的公式不反映该结果。",
        );
        writer.sheet.push(vec![note]);
    }
    let figures = Figures::new(report, writer.measurand);
    let apart = || {
        let expanded = figures.amount(&figures.expanded()?);
        Some(format!(
            "{} = {}, U = {expanded}",
            figures.name,
            figures.value()
        ))
    };
    let both = match form(&report.budget.conventions) {
        StatementForm::PlusMinus => figures.plus_minus(),
        StatementForm::Apart => apart(),
    };
    let stated = match (both, figures.interval()) {
        (Some(both), _) => both,
        (None, Some([low, high])) => {
            format!("{}: [{low}, {high}]", figures.name)
        }
        (None, None) => figures.value(),
    };
    let word = writer.word("reported, as evaluated", "评定时报告的结果");
    writer
        .sheet
        .push(vec![Entry::Words(word), Entry::Words(stated)]);
}

/// The Monte Carlo result as it was found.
fn trials(writer: &mut Writer<'_>) {
    let report = writer.report;
    let result = &report.evaluation.results[writer.measurand];
    let (Some(found), Some(run)) = (&result.monte_carlo, &report.evaluation.run) else {
        return;
    };
    writer.title(
        "Monte Carlo, as it was run (does not follow)",
        "蒙特卡洛法的结果（不随单元格变化）",
    );
    let number = Entry::Fixed;
    let moment = |x: Option<f64>| x.map_or(Entry::Words("—".to_string()), Entry::Fixed);
    let lines = [
        (("mean", "均值"), vec![moment(found.estimate)]),
        (
            ("standard uncertainty u", "标准不确定度 u"),
            vec![moment(found.u)],
        ),
        (("median", "中位数"), vec![number(found.median)]),
        (
            ("coverage probability p", "包含概率 p"),
            vec![number(run.coverage_probability)],
        ),
        (
            ("symmetric interval", "概率对称包含区间"),
            found.symmetric.map(number).to_vec(),
        ),
        (
            ("shortest interval", "最短包含区间"),
            found.shortest.map(number).to_vec(),
        ),
        (("trials", "试验次数"), vec![number(run.trials as f64)]),
        (("seed", "随机数种子"), vec![number(run.seed as f64)]),
    ];
    for ((english, chinese), numbers) in lines {
        let mut row = vec![writer.words(english, chinese)];
        row.extend(numbers);
        writer.sheet.push(row);
    }
}
