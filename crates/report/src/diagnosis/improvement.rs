//! The improved model: its terms, how much better it describes the recording, and what it changes in the
//! parameters.

use crate::language::Language;
use crate::number::{aligned, freedom, in_unit, significant};
use crate::phrase::{named_row, section, table};
use crate::symbol;
use gumption_fault::say;
use gumption_format::document::{
    Block,
    ColumnKind::{Names, Numbers, Wrapped},
    Row, Table,
};
use gumption_lab::diagnose::case::Case;
use gumption_lab::diagnose::{Adopted, Agreement, Diagnosis, HeldOutQuality, Quality, Shape};

use super::labels::spoken;
use super::listed;
use super::names::unknown;
use super::words::p_is;

/// Before and after.
pub(super) fn blocks(case: &Case, diagnosis: &Diagnosis, l: Language) -> Vec<Block> {
    let mut blocks = Vec::new();
    if let Some(adopted) = &diagnosis.adopted {
        blocks.push(section(l, "Before and after", "改进前后"));
        blocks.push(Block::Formula(improved_model(adopted)));
        blocks.push(Block::Table(coefficients(adopted, l)));
        blocks.extend(signal(adopted, l));
    } else {
        blocks.push(section(l, "Agreement of the model", "模型的符合程度"));
    }
    blocks.push(Block::Table(qualities(case, diagnosis, l)));
    blocks.extend(
        diagnosis
            .adopted
            .as_ref()
            .and_then(|adopted| confirmation(adopted, l)),
    );
    blocks.extend(not_predicted(diagnosis, l).or_else(|| badly_predicted(case, diagnosis, l)));
    blocks.extend(listed::blocks(diagnosis, l));
    blocks
}

fn improved_model(adopted: &Adopted) -> Vec<String> {
    let lines = adopted.extended.case.model_lines().into_iter();
    let definitions = adopted.extended.definitions();
    let definitions = definitions.map(|(column, text)| format!("{column} = {text}"));
    lines.map(str::to_owned).chain(definitions).collect()
}

fn coefficients(adopted: &Adopted, l: Language) -> Table {
    let mut table = table(
        l,
        [
            ("size", "大小", Names),
            ("multiplies", "乘以", Wrapped),
            ("estimate", "估计值", Numbers),
            ("u", "u", Numbers),
            ("unit", "单位", Names),
        ],
    );
    for (estimated, addition) in adopted.coefficients.iter().zip(&adopted.extended.additions) {
        table.push(vec![
            estimated.name.as_str().into(),
            addition
                .column
                .as_ref()
                .map_or("–", |_| addition.text.as_str())
                .into(),
            aligned(estimated.value, estimated.u, 2).into(),
            significant(estimated.u, 2).into(),
            estimated.unit.as_str().into(),
        ]);
    }
    for shape in &adopted.shapes.all {
        let estimated = &shape.estimated;
        table.push(vec![
            estimated.name.as_str().into(),
            meaning(shape, adopted, l).into(),
            aligned(estimated.value, estimated.u, 2).into(),
            significant(estimated.u, 2).into(),
            estimated.unit.as_str().into(),
        ]);
    }
    table
}

/// What a shape is, and where it stands in the formulas.
fn meaning(shape: &Shape, adopted: &Adopted, l: Language) -> String {
    let what = match shape.estimated.name.as_str() {
        "τ" => l.pick("time constant", "时间常数"),
        "t₀" => l.pick("time scale", "时间尺度"),
        "P" => l.pick("period", "周期"),
        "w" => l.pick("width", "宽度"),
        "x₀" => l.pick("knee", "拐点"),
        "x½" => l.pick("value at which half is reached", "达到一半时的值"),
        _ => l.pick("shape", "形状参数"),
    };
    let additions = adopted.extended.additions.iter();
    let own = additions.filter(|addition| addition.effect == shape.effect);
    let mut columns: Vec<&str> = own.filter_map(|one| one.column.as_deref()).collect();
    columns.dedup();
    let columns = columns.join(", ");
    say!("– ({what} of {columns})").in_language(l)
}

/// What the formulas call the signal, where they do.
fn signal(adopted: &Adopted, l: Language) -> Option<Block> {
    let mut additions = adopted.extended.additions.iter();
    let named = additions.any(|addition| addition.text.contains("signal"));
    named.then(|| {
        Block::Paragraph(
            say!("signal: what the fitted declared model gives besides constant terms.")
                .in_language(l),
        )
    })
}

/// A row for the declared model and the one with the physics in it; three digits.
fn compared(label: String, before: Option<f64>, after: Option<f64>) -> Row {
    let texts = [before, after];
    named_row(
        label,
        texts.map(|x| x.map_or(String::new(), |x| significant(x, 3))),
    )
}

fn qualities(case: &Case, diagnosis: &Diagnosis, l: Language) -> Table {
    let (before, after) = (
        &diagnosis.before,
        diagnosis.adopted.as_ref().map(|a| &a.quality),
    );
    let mut table = table(
        l,
        [
            ("", "", Names),
            ("declared model", "声明的模型", Numbers),
            ("with the physics", "加入遗漏效应后", Numbers),
        ],
    );
    let known = !diagnosis.noise.is_estimated();
    for (index, response) in case.responses.iter().enumerate() {
        let label = |what: &str| {
            let of = format!("{what}{}{}", l.comma(), response.name);
            in_unit(&of, &symbol(&response.unit))
        };
        let mut row = |what: &str, of: fn(&Quality) -> &Vec<f64>| {
            let value = |quality| of(quality).get(index).copied();
            table
                .rows
                .push(compared(label(what), value(before), after.and_then(value)));
        };
        row(l.pick("residual RMS", "残差均方根"), |quality| {
            &quality.residual
        });
        if known {
            row(l.pick("expected noise", "预期噪声"), |quality| {
                &quality.expected
            });
        }
        row(
            l.pick("error predicting held-out rows", "留出数据的预测误差"),
            |quality| &quality.held_out,
        );
    }
    if let Some(held) = &diagnosis.held_out {
        held_out(&mut table, case, held, l);
    }
    if known {
        let (before, after) = (before.reduced(), after.map(|after| after.reduced()));
        table
            .rows
            .push(compared("χ²/ν".to_owned(), Some(before), after));
    }
    let after = after.map_or(String::new(), |after| freedom(after.dof));
    let label = l.pick("degrees of freedom", "自由度");
    table
        .rows
        .push(named_row(label, [freedom(before.dof), after]));
    table.without_empty_columns()
}

/// Prediction of the recording that was held out.
fn held_out(table: &mut Table, case: &Case, held: &HeldOutQuality, l: Language) {
    let (before, after, file) = (&held.before, held.after.as_ref(), &held.file);
    for (index, response) in case.responses.iter().enumerate() {
        let (expected, name) = (significant(held.expected[index], 3), &response.name);
        let label = say!("error predicting {file} (noise {expected}), {name}").in_language(l);
        let label = in_unit(&label, &symbol(&response.unit));
        let after = after.map(|after| after.rms[index]);
        table
            .rows
            .push(compared(label, Some(before.rms[index]), after));
    }
    let n = held.observations;
    let label = say!("χ²/n of that prediction, n = {n}").in_language(l);
    let reduced = |chi_squared: f64| chi_squared / n as f64;
    let after = after.map(|after| reduced(after.chi_squared));
    table
        .rows
        .push(compared(label, Some(reduced(before.chi_squared)), after));
}

/// A remark where the recording that was held out is predicted by the declared model alone.
fn not_predicted(diagnosis: &Diagnosis, l: Language) -> Option<Block> {
    let held = diagnosis.held_out.as_ref()?;
    let is_open = diagnosis.adopted.is_some() && held.after.is_none();
    let file = &held.file;
    let told = say!("With the physics {file} is not predicted: what it did there does not follow from the columns.").in_language(l);
    is_open.then_some(Block::Paragraph(told))
}

/// A remark where the recording that was held out is predicted worse than the noise allows.
fn badly_predicted(case: &Case, diagnosis: &Diagnosis, l: Language) -> Option<Block> {
    let p = p_is(diagnosis.badly_predicted(case)?);
    let file = &diagnosis.held_out.as_ref()?.file;
    Some(Block::Paragraph(say!("{file} is predicted worse than the noise allows ({p}): its conditions show something that those of the recording do not. Diagnose it too.").in_language(l)))
}

fn confirmation(adopted: &Adopted, l: Language) -> Option<Block> {
    let name = &adopted.coefficients.first()?.name;
    let parts = adopted.confirmation.parts.iter().map(|(part, value, u)| {
        let part = spoken(part, l);
        let size = format!("{} ± {}", aligned(*value, *u, 2), significant(*u, 2));
        l.with_head(&part, &size)
    });
    let parts: Vec<String> = parts.collect();
    let agreed = adopted
        .confirmation
        .agreed()
        .map_or(String::new(), |(agreement, p)| {
            let p = p_is(p);
            match agreement {
                Agreement::Agree => say!("; they agree ({p})").in_language(l),
                Agreement::Doubtful => {
                    say!("; it is doubtful whether they agree ({p})").in_language(l)
                }
                Agreement::Differ => say!("; they do not agree ({p})").in_language(l),
            }
        });
    let is_any = !parts.is_empty();
    let parts = parts.join(l.comma());
    is_any.then(|| {
        Block::Paragraph(
            say!("{name} from parts of the recording: {parts}{agreed}.").in_language(l),
        )
    })
}

/// The parameters before and after, and with what may be there unseen.
pub(super) fn parameters(diagnosis: &Diagnosis, l: Language) -> Vec<Block> {
    /// Longer lists, one for each label, are in the JSON.
    const MOST: usize = 30;
    let mut table = table(
        l,
        [
            ("parameter", "参数", Names),
            ("declared model", "声明的模型", Numbers),
            ("u", "u", Numbers),
            ("with the physics", "加入遗漏效应后", Numbers),
            ("u", "u", Numbers),
            ("u with unseen", "计入未见影响的 u", Numbers),
            ("unit", "单位", Names),
        ],
    );
    let unseen = diagnosis.u_with_unseen();
    let adopted = diagnosis.adopted.as_ref();
    for (index, own) in diagnosis.unknowns.iter().take(MOST).enumerate() {
        let after = adopted.and_then(|adopted| adopted.unknowns.get(index));
        let after = after.map_or([String::new(), String::new()], |after| {
            [
                aligned(after.rounded(), after.u, 2),
                significant(after.u, 2),
            ]
        });
        let [value, u] = after;
        table.push(vec![
            unknown(&own.name, l).into(),
            aligned(own.rounded(), own.u, 2).into(),
            significant(own.u, 2).into(),
            value.into(),
            u.into(),
            unseen
                .get(index)
                .map_or(String::new(), |u| significant(*u, 2))
                .into(),
            own.unit.as_str().into(),
        ]);
    }
    let mut blocks = vec![
        section(
            l,
            "What it changes in the result and its uncertainty",
            "对结果及其不确定度的影响",
        ),
        Block::Table(table.without_empty_columns()),
    ];
    if diagnosis.noise.may_be_correlated() {
        let allowed = say!("u allows for errors that successive rows may have in common: the recording does not show any, and does not exclude them. `gumption calibrate` takes the errors of rows as independent.").in_language(l);
        blocks.push(Block::Paragraph(allowed));
    }
    blocks
}
