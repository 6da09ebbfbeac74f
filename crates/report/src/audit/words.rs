//! Sentences of an audit.

use gumption_audit::claim::{RoundingStated, Row, Shape, Stated};
use gumption_audit::printed::Printed;
use gumption_audit::read::unread_expanded;
use gumption_audit::search::{Broken, Gap};
use gumption_audit::slips::Change;
use gumption_audit::{Audit, Verdict};
use gumption_core::distribution::Entry;
use gumption_fault::{Said, say};

use crate::language::Language;
use crate::number::{significant, significant_up};
use crate::phrase::{plural, third_person};

/// A row's name, kept short.
pub(super) fn short(row: &Row) -> String {
    let name = row.label();
    let head: String = name.chars().take(24).collect();
    if head.len() < name.len() {
        format!("{head}…")
    } else {
        head
    }
}

/// Where a row stands.
pub(super) fn place(row: &Row, i: usize, language: Language) -> String {
    let name = short(row);
    say!("row {} ({name}), line {}", i + 1, row.at.row + 1).in_language(language)
}

/// A probability in percent with two digits; one that is next to nothing is below what is worth a digit.
fn percent(probability: f64) -> String {
    match 100.0 * probability {
        percent if percent < 0.01 => "<0.01".to_string(),
        percent => significant(percent, 2),
    }
}

/// How many combinations were tried, and whether what gives the figures may be chance: no chance is left where the
/// printed figures themselves show the slip.
fn chance(tried: usize, accident: f64, language: Language) -> String {
    let combinations = match (language, tried) {
        (Language::English, 1) => "1 combination was tried".to_string(),
        (Language::English, tried) => format!("{tried} combinations were tried"),
        (Language::Chinese, tried) => format!("共试 {tried} 种组合"),
    };
    match (language, accident == 0.0) {
        (Language::English, true) => {
            format!(
                "{combinations}; the printed figures themselves show what happened: no chance match."
            )
        }
        (Language::Chinese, true) => {
            format!("{combinations}；所列数值本身已显示差错，并非偶然相符。")
        }
        (Language::English, false) => format!(
            "{combinations}; figures as coarse as these that have nothing to do with slips would be matched with a probability of {} %.",
            percent(accident)
        ),
        (Language::Chinese, false) => format!(
            "{combinations}；与差错无关、位数相同的数值偶然相符的概率为 {} %。",
            percent(accident)
        ),
    }
}

/// The sentences that all comes down to.
pub(super) fn verdict(audit: &Audit<'_>, language: Language) -> Vec<String> {
    let found = &audit.found;
    let claimed = found.case.claimed;
    let unit = &claimed.unit;
    let right_u = match claimed.rounding {
        RoundingStated::Up => significant_up(found.right.expanded, 2),
        RoundingStated::Nearest | RoundingStated::Unstated => significant(found.right.expanded, 2),
    };
    let right_u = format!("{right_u} {unit}").trim_end().to_owned();
    let claimed_u = match (&claimed.footer.expanded, language) {
        (Some(u), Language::English) => format!(" where {} is claimed", as_claimed(audit, u)),
        (Some(u), Language::Chinese) => format!("，声称值为 {}", as_claimed(audit, u)),
        (None, Language::English) => "; none is claimed".to_string(),
        (None, Language::Chinese) => "；表中没有声称值".to_string(),
    };
    let count = found.explanations.first().map_or(0, |e| e.acts.len());
    let slips = || -> String {
        let best = found.explanations.first();
        let acts = best.map_or(&[][..], |e| &e.acts);
        let texts: Vec<String> = acts
            .iter()
            .map(|act| {
                let place = act.row.map(|row| place(&claimed.rows[row], row, language));
                let text = language.pick(act.slip.en, act.slip.zh);
                match (language, place) {
                    (Language::English, Some(place)) => format!("{text} ({place})"),
                    (Language::Chinese, Some(place)) => format!("{text}（{place}）"),
                    (_, None) => text.to_string(),
                }
            })
            .collect();
        texts.join(language.semicolon())
    };
    let named = || match (language, count) {
        (Language::English, 1) => format!("One slip gives every claimed figure: {}.", slips()),
        (Language::English, n) => {
            format!("{n} slips together give every claimed figure: {}.", slips())
        }
        (Language::Chinese, 1) => format!("有一处差错能给出全部声称值：{}。", slips()),
        (Language::Chinese, n) => format!("{n} 处差错合在一起能给出全部声称值：{}。", slips()),
    };
    let chance = || chance(found.tried, found.accident, language);
    match audit.verdict {
        Verdict::Sound => {
            let mut sentences = sound(audit, language);
            sentences.extend(untold(audit, language));
            sentences
        }
        Verdict::WithEffect => vec![
            named(),
            corrected(audit, language).unwrap_or_else(|| say!("Corrected, U is {right_u}{claimed_u}.").in_language(language)),
            chance(),
        ],
        Verdict::WithoutEffect if found.is_long_alone() => vec![match language {
            Language::English => format!("Every claimed figure follows from what the sheet states; U has more digits than the two that are reported: U = {right_u}{claimed_u}."),
            Language::Chinese => format!("全部声称值均可由所述信息得出；只是 U 的有效数字多于应报告的两位：U = {right_u}{claimed_u}。"),
        }],
        Verdict::WithoutEffect => vec![
            named(),
            unchanged(audit, &right_u).in_language(language),
            chance(),
        ],
        Verdict::Unexplained => {
            let recomputed = recomputed(audit, language).unwrap_or_else(|| say!("Recomputed, U is {right_u}{claimed_u}.").in_language(language));
            let mut sentences = vec![say!("Unexplained: the claimed figures do not follow from what is stated, and no slip that is known gives them. {recomputed}").in_language(language)];
            let accidental = found.withheld > 0 && found.gaps.iter().all(|gap| !matches!(gap, Gap::Row(..)));
            if accidental {
                let (n, p) = (found.withheld, percent(found.accident));
                sentences.push(say!("{n} combination{} of slips fit{}, but figures as coarse as these would be matched by accident with a probability of {p} %: none is named.", plural(n), third_person(n)).in_language(language));
            }
            sentences
        }
        Verdict::NotRecomputed if !audit.missing.is_empty() => vec![missing(audit, language)],
        Verdict::NotRecomputed if found.right.u_c > 0.0 => {
            let k = significant(found.right.k, 3);
            vec![say!("Nothing is claimed that could be held against a calculation. From what is stated, U is {right_u} with k = {k}.").in_language(language)]
        }
        Verdict::NotRecomputed => vec![say!("Cannot be recomputed: the sheet holds no budget with figures and a claim that could be understood.").in_language(language)],
    }
}

/// That U stays as it is printed, which is how the laboratory rounded it; `right_u` where none is claimed.
fn unchanged(audit: &Audit<'_>, right_u: &str) -> Said {
    let expanded = audit.found.case.claimed.footer.expanded.as_ref();
    let right_u = expanded.map_or_else(|| right_u.to_owned(), |u| as_claimed(audit, u));
    say!("The result as printed does not change: U = {right_u}.")
}

/// What a claim lacks that cannot be recomputed: what leads from some rows to the result, or what their u were made from.
fn missing(audit: &Audit<'_>, language: Language) -> String {
    let claimed = audit.found.case.claimed;
    let row = |i: &usize| {
        let row = &claimed.rows[*i];
        let unread = row.unread_used.as_ref();
        let of_row = unread.map_or(&row.unit, |cell| &cell.text);
        format!("{} [{of_row}]", place(row, *i, language))
    };
    let rows: Vec<String> = audit.missing.iter().map(row).collect();
    let rows = rows.join(language.semicolon());
    let is_unread = audit
        .missing
        .iter()
        .all(|row| claimed.rows[*row].unread_used.is_some());
    match claimed.unit.as_str() {
        _ if is_unread => say!("Not recomputed: what is claimed follows with the standard uncertainties as they stand, and of these rows it is not understood what they were made from: {rows}."),
        "" => say!("Not recomputed: the rows are in units of several quantities, and neither sensitivity coefficients c_i, contributions u_i(y) nor a model with the estimates lead to the result. They are missing for: {rows}."),
        unit => say!("Not recomputed: nothing leads to the result in {unit} from these rows, for which a sensitivity coefficient c_i, a contribution u_i(y) or a model with the estimates is missing: {rows}."),
    }
    .in_language(language)
}

/// What departs where U is printed as claimed: u_c, or neither.
fn recomputed(audit: &Audit<'_>, language: Language) -> Option<String> {
    let (right, footer) = (audit.found.right, &audit.found.case.claimed.footer);
    let is_met = |figure: &&Printed, x: f64| figure.is_met_within(x, figure.half);
    let u = footer
        .expanded
        .as_ref()
        .filter(|u| is_met(u, right.expanded))?;
    let u = as_claimed(audit, u);
    let u_c = footer.u_c.as_ref().filter(|u_c| !is_met(u_c, right.u_c));
    Some(match (u_c, language) {
        (Some(u_c), _) => {
            // So many digits that it is seen which way it is rounded.
            let exact = in_unit(audit, right.u_c, u8::try_from(u_c.digits).unwrap_or(8) + 2);
            let claimed = as_claimed(audit, u_c);
            say!("Recomputed, u_c is {exact} where {claimed} is claimed; U is {u}, as claimed.")
                .in_language(language)
        }
        (None, Language::English) => format!("Recomputed, U is {u}, as claimed."),
        (None, Language::Chinese) => format!("重新计算 U = {u}，与声称值一致。"),
    })
}

/// A claimed figure with its unit, else with that of the result.
fn as_claimed(audit: &Audit<'_>, figure: &Printed) -> String {
    match figure.unit.as_str() {
        "" => {
            let unit = &audit.found.case.claimed.unit;
            format!("{} {unit}", figure.as_read()).trim_end().to_owned()
        }
        _ => figure.with_unit(),
    }
}

/// A number in the unit of the result.
fn in_unit(audit: &Audit<'_>, x: f64, digits: u8) -> String {
    match audit.found.case.claimed.unit.as_str() {
        "" => significant(x, digits),
        unit => format!("{} {unit}", significant(x, digits)),
    }
}

/// That a claim is right, with U as the sheet prints it and as it is before rounding; as far as printed digits tell.
fn sound(audit: &Audit<'_>, language: Language) -> Vec<String> {
    let found = &audit.found;
    let footer = &found.case.claimed.footer;
    let other = found.other_result().zip(footer.y.as_ref());
    let verdict = match &other {
        None => say!("Sound: every claimed figure follows from what the sheet states."),
        Some((right, y)) => {
            let (y, right) = (y.as_read(), significant(*right, 9));
            say!(
                "Sound: every claimed figure of the uncertainty follows from what the sheet states. The result does not: y is {y} where the estimates give {right}."
            )
        }
    };
    let right = found.right.expanded;
    let open = found.open * right / found.right.u_c;
    let exact = in_unit(audit, right, 4);
    let reach = || [right - open, right + open].map(|x| in_unit(audit, x, 4));
    let before = match open > 1e-3 * right {
        true => {
            let [low, high] = reach();
            say!(
                "from {low} to {high} before rounding, since rows state no more than printed digits"
            )
        }
        false => say!("{exact} before rounding"),
    };
    let u = match &footer.expanded {
        Some(claimed) => {
            let claimed = as_claimed(audit, claimed);
            say!("U = {claimed}: {before}.")
        }
        None if audit.found.case.claimed.is_simulated() => say!(
            "The U of Monte Carlo that is stated was not recomputed; by the law of propagation it is {before}."
        ),
        None => match unread_expanded(audit.found.case.claimed) {
            Some(line) => {
                let line = &line.text;
                say!("No U is understood, which may stand in the line “{line}”; it is {before}.")
            }
            None => say!("No U is claimed; it is {before}."),
        },
    };
    let [verdict, u] = [verdict, u].map(|said| said.in_language(language));
    vec![format!("{verdict}{}{u}", language.pick(" ", ""))]
}

/// What is wrong with the statement while U is right: the result, or the unit of U.
fn corrected(audit: &Audit<'_>, language: Language) -> Option<String> {
    let best = audit.found.explanations.first()?;
    let right = best.acts.iter().find_map(|act| match act.change {
        Change::Result(right) => right,
        _ => None,
    })?;
    let y = audit.found.case.claimed.footer.y.as_ref()?.as_read();
    let (right, u) = (
        significant(right, 9),
        in_unit(audit, audit.found.right.expanded, 2),
    );
    Some(
        say!("Corrected, the result is {right} where {y} is claimed; U is {u}.")
            .in_language(language),
    )
}

/// Rows in which an error would give the same printed figures.
fn untold(audit: &Audit<'_>, language: Language) -> Option<String> {
    let rows = &audit.found.case.claimed.rows;
    let mut places: Vec<usize> = audit
        .found
        .untold
        .iter()
        .filter_map(|act| act.row)
        .collect();
    places.sort_unstable();
    places.dedup();
    let names: Vec<String> = places
        .iter()
        .map(|row| place(&rows[*row], *row, language))
        .collect();
    let names = names.join(language.semicolon());
    (!places.is_empty()).then(|| say!("Cannot be told within the printed digits: an error in {names} would give the same figures.").in_language(language))
}

/// What the laboratory should be asked where several explanations are equally good.
pub(super) fn question(audit: &Audit<'_>, language: Language) -> Option<String> {
    let [first, second, ..] = audit.found.explanations.as_slice() else {
        return None;
    };
    let differs = first.acts.iter().find(|act| {
        !second
            .acts
            .iter()
            .any(|other| other.slip.id == act.slip.id && other.row == act.row)
    })?;
    let rows = &audit.found.case.claimed.rows;
    Some(match (language, differs.row) {
        (Language::English, Some(row)) => format!("To decide between them, ask the laboratory how u of {} was found.", short(&rows[row])),
        (Language::English, None) => "To decide between them, ask the laboratory how U was found from the contributions, step by step.".to_string(),
        (Language::Chinese, Some(row)) => format!("要加以区分，请询问实验室 {} 的标准不确定度是如何得到的。", short(&rows[row])),
        (Language::Chinese, None) => "要加以区分，请实验室逐步说明 U 是如何由各分量得到的。".to_string(),
    })
}

/// Where a claim departs.
pub(super) fn gap(audit: &Audit<'_>, gap: &Gap, language: Language) -> String {
    let rows = &audit.found.case.claimed.rows;
    match gap {
        Gap::Row(i, figure) => {
            let (en, zh) = match figure {
                Broken::U => (
                    "the standard uncertainty does not follow from what is stated",
                    "标准不确定度不能由所述信息得出",
                ),
                Broken::C => (
                    "the sensitivity coefficient is not the derivative of the model",
                    "灵敏系数不是模型的偏导数",
                ),
                Broken::Contribution => ("the contribution is not c·u", "分量不等于 c·u"),
                Broken::Dof => (
                    "the degrees of freedom do not follow from what is stated",
                    "自由度不能由所述信息得出",
                ),
            };
            language.with_head(&place(&rows[*i], *i, language), language.pick(en, zh))
        }
        Gap::Sum => {
            say!("Between the rows and u_c: no known way of combining the contributions gives it.")
                .in_language(language)
        }
        Gap::Freedom => {
            say!("At ν_eff: it is not that of Welch and Satterthwaite.").in_language(language)
        }
        Gap::Factor => say!("At k: it is not that of the rule.").in_language(language),
        Gap::Expanded => {
            say!("Between u_c, k and U: the product, rounded, is not what is printed.")
                .in_language(language)
        }
    }
}

/// What is known of a row.
pub(super) fn stated(row: &Row, language: Language) -> String {
    let named = |key: &str| {
        Entry::named(key).map_or("", |entry| {
            language.pick(entry.kind.name_en, entry.kind.name_zh)
        })
    };
    let shape = |shape: Shape| match shape {
        Shape::Rectangular => named("uniform").to_string(),
        Shape::Triangular => named("triangle").to_string(),
        Shape::Arcsine => named("u-shaped").to_string(),
        Shape::Trapezoidal(beta) => {
            format!("{} β = {}", named("trapezoid"), significant(beta, 2))
        }
        Shape::Normal(k) => format!(
            "{} k = {}",
            language.pick("normal", "正态"),
            significant(k, 3)
        ),
        Shape::TwoPoint => language.pick("two points", "两点").to_string(),
    };
    // As it is written, where no unit was changed: further digits would be made up.
    let number = |figure: &Printed| {
        let own = Printed::parse(&figure.text).is_some_and(|own| own.value == figure.value);
        // What another program's file states is exact, and may have been computed.
        let is_computed = figure.half == 0.0 && figure.text.len() > 10;
        if is_computed {
            significant(figure.value, 4)
        } else if own {
            let text = figure.text.trim_end_matches(figure.unit.as_str());
            text.trim_start_matches('±').trim().to_string()
        } else {
            significant(figure.value, figure.digits.clamp(1, 4) as u8)
        }
    };
    match &row.stated {
        Stated::Nothing => String::new(),
        Stated::Certificate {
            expanded,
            k,
            k_stated,
        } => {
            let mark = if *k_stated {
                ""
            } else {
                language.pick(" (taken)", "（默认）")
            };
            format!("U = {}, k = {}{mark}", number(expanded), significant(*k, 3))
        }
        Stated::Limits {
            half_width,
            shape: s,
            ..
        } => format!("±{}, {}", number(half_width), shape(*s)),
        Stated::FullWidth { width, shape: s } => format!(
            "{} {}, {}",
            language.pick("width", "全宽"),
            number(width),
            shape(*s)
        ),
        Stated::Step { step } => {
            format!("{} {}", language.pick("step", "步进"), number(step))
        }
        Stated::Unequal { plus, minus } => {
            format!("+{}/−{}", number(plus), number(minus))
        }
        Stated::Deviation { s, n, m, pooled } => {
            let n = n.map_or(String::new(), |n| format!(", n = {n}"));
            let pooled = pooled.map_or(String::new(), |dof| {
                format!(", {} ν = {dof}", language.pick("pooled", "合并"))
            });
            format!("s = {}{n}, m = {m}{pooled}", number(s))
        }
        Stated::Range { range, n, m } => format!("R = {}, n = {n}, m = {m}", number(range)),
        Stated::Standard { u, .. } => format!("u = {}", number(u)),
    }
}

/// As what a cell was taken.
pub(super) fn role(role: &str, language: Language) -> String {
    let chinese = match role {
        "number" => "序号",
        "symbol" => "符号",
        "source" => "来源",
        "estimate" => "估计值",
        "half_width" => "半宽（所用数值）",
        "unit" => "单位",
        "type" => "评定类别",
        "distribution" => "分布",
        "divisor" => "除数",
        "u" => "标准不确定度",
        "sensitivity" => "灵敏系数",
        "contribution" => "分量",
        "dof" => "自由度",
        "readings" => "次数",
        "derived" => "由其他列算出，不用",
        "remark" => "说明",
        "model" => "测量模型",
        "correlation" => "相关性",
        "rule for k" => "k 的规则",
        "of Monte Carlo, not recomputed" => "蒙特卡洛法的结果，未重新计算",
        "rule for rounding" => "修约规则",
        "note to a row" => "某行的说明",
        "known, but not in the table" => "已知，但表中没有此项",
        "?" => "未识别",
        "u, since u_c follows from it" => "标准不确定度（由此可得表中的 u_c）",
        other => other,
    };
    let english = match role {
        "half_width" => "± (what was used)",
        "derived" => "computed from others, not used",
        "?" => "not understood",
        other => other,
    };
    language.pick(english, chinese).to_string()
}
