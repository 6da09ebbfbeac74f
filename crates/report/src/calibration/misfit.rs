//! What the equations leave of the readings, and what a reader must know.

use crate::figures::with_unit;
use crate::language::{Language, Word};
use crate::number::{NONE, aligned, freedom, significant};
use crate::phrase::{plural, section, table};
use crate::remarks::REMARK;
use crate::symbol;
use gumption_core::statistics::norm;
use gumption_fault::say;
use gumption_format::document::{
    Block,
    ColumnKind::{Names, Numbers},
    Table,
};
use gumption_lab::calibrate::{
    Apart, Calibration, Campaign, Contradicted, Limit, Misfit, Part, Pattern, PatternTest,
    Residual, ResponseScatter, Scatter, ScatterTest,
};
use gumption_lab::experiment::Words;

use super::sections::{DIGITS, p_of, said, shown_u};

/// More residuals than these are not listed.
const RESIDUALS: usize = 12;

/// More residuals than these are not in the JSON either.
const LISTED: usize = 100_000;

/// The residuals of the JSON in the order of the readings.
pub(super) fn listed(found: &Calibration) -> Vec<&Residual> {
    if found.residuals.len() <= LISTED {
        return found.residuals.iter().collect();
    }
    let mut largest = found.largest_residuals(LISTED);
    largest.sort_by_key(|one| (one.point, one.response));
    largest
}

pub(super) fn residuals(campaign: &Campaign, found: &Calibration, l: Language) -> Vec<Block> {
    let way = match found.scatter {
        Scatter::Residuals => say!("The scatter of the readings in the uncertainties above is the part of the residuals that the stated errors do not explain.").in_language(l),
        Scatter::Dwells => say!("The scatter of the readings in the uncertainties above is that of the samples of each dwell; compare it with the residuals.").in_language(l),
        Scatter::Stated => say!("The uncertainties above contain the stated errors only; the residuals do not enter.").in_language(l),
    };
    let mut blocks = vec![
        section(l, "Residuals", "残差"),
        Block::Table(scatter(campaign, found, l)),
        Block::Paragraph(format!("{way}{}", whole(campaign, found, l))),
    ];
    if found.responses.iter().all(|one| one.dof == 0.0) {
        // What is left is rounding.
        return blocks;
    }
    blocks.push(Block::Table(largest(campaign, found, l)));
    let count = found.residuals.len();
    if count > LISTED {
        blocks.push(Block::Paragraph(
            say!("The {RESIDUALS} largest of {count}; --json has the {LISTED} largest.")
                .in_language(l),
        ));
    } else if count > RESIDUALS {
        blocks.push(Block::Paragraph(
            say!("The {RESIDUALS} largest of {count}; --json has all.").in_language(l),
        ));
    }
    blocks
}

/// Of which responses all of the residuals count as scatter.
fn whole(campaign: &Campaign, found: &Calibration, l: Language) -> String {
    let is_whole = |one: &&ResponseScatter| one.part == Part::Whole;
    let names: Vec<String> = found
        .responses
        .iter()
        .filter(is_whole)
        .map(|one| one.response.clone())
        .collect();
    if names.is_empty() || found.scatter != Scatter::Residuals {
        return String::new();
    }
    let names = l.list(&names);
    let mut text =
        say!(" The residuals of {names} are smaller than the stated errors, and so few that they do not show how much smaller: all of them are taken, in place of the errors stated of each reading.")
            .in_language(l);
    if campaign.points.are_sampled() {
        text += &say!(" The samples of the dwells tell the scatter better where nothing else changes between them: [noise] from = \"dwells\".").in_language(l);
    }
    text
}

fn scatter(campaign: &Campaign, found: &Calibration, l: Language) -> Table {
    let mut table = table(
        l,
        [
            ("response", "响应量", Names),
            ("readings", "读数", Numbers),
            ("RMS residual", "残差均方根", Numbers),
            ("s", "s", Numbers),
            ("ν", "ν", Numbers),
            ("s to expect", "预期 s", Numbers),
            ("χ²/ν", "χ²/ν", Numbers),
            ("p", "p", Numbers),
            ("unit", Word::Unit.of(l), Names),
        ],
    );
    for (one, quantity) in found
        .responses
        .iter()
        .zip(campaign.experiment.equations.responses())
    {
        let of_test = |value: fn(&ScatterTest) -> f64, digits: u8| {
            let test = one.test.as_ref();
            test.map_or(String::new(), |test| significant(value(test), digits))
        };
        table.push(vec![
            one.response.as_str().into(),
            one.readings.to_string().into(),
            shown_u(if one.dof > 0.0 { one.rms } else { 0.0 }).into(),
            shown_u(one.s).into(),
            freedom(one.dof).into(),
            of_test(|test| test.expected, DIGITS).into(),
            of_test(ScatterTest::reduced, DIGITS).into(),
            of_test(|test| test.p_value, 2).into(),
            symbol(&quantity.unit).into(),
        ]);
    }
    table.without_empty_columns()
}

fn largest(campaign: &Campaign, found: &Calibration, l: Language) -> Table {
    let mut table = table(
        l,
        [
            ("point", "测量点", Names),
            ("response", "响应量", Names),
            ("observed", "观测值", Numbers),
            ("equation", "方程值", Numbers),
            ("residual", "残差", Numbers),
            ("residual/s", "标准化残差", Numbers),
        ],
    );
    for one in found.largest_residuals(RESIDUALS) {
        let own = found.responses.get(one.response);
        let s = own.map_or(f64::NAN, |r| r.rms);
        let standardised = match one.standardised.is_nan() {
            true => NONE.to_owned(),
            false => significant(one.standardised, 3),
        };
        table.push(vec![
            said(&campaign.points.names.of(one.point), l).into(),
            own.map_or("", |r| r.response.as_str()).into(),
            aligned(one.observed, s, DIGITS).into(),
            aligned(one.fitted, s, DIGITS).into(),
            significant(one.observed - one.fitted, DIGITS).into(),
            standardised.into(),
        ]);
    }
    table
}

/// Residuals that are larger or smaller than the known errors of the readings let expect.
fn misfit(one: &ResponseScatter, l: Language) -> Option<String> {
    let (test, response) = (one.test?, &one.response);
    let ratio = significant(test.reduced(), 3);
    Some(match test.misfit? {
        Misfit::BetweenDwells => {
            let times = significant(test.reduced().sqrt(), 2);
            say!("The residuals of {response} are {times} times as large as the samples of the dwells let expect: something changes from dwell to dwell that is still within each, labels or reference values are wrong, or the equations leave something out.").in_language(l)
        }
        Misfit::Larger => {
            let p = significant(test.p_value, 2);
            say!("The residuals of {response} are larger than the errors of its readings let expect (χ²/ν = {ratio}, p = {p}): the equations leave something out, or the errors are larger than stated. The uncertainties above do not contain this.").in_language(l)
        }
        Misfit::Smaller => say!("The residuals of {response} are smaller than the errors of its readings let expect (χ²/ν = {ratio}): these errors may be stated too large, or be common to the readings.").in_language(l),
    })
}

fn in_list(points: &[Words], l: Language) -> String {
    let points: Vec<&str> = points.iter().map(|point| said(point, l)).collect();
    points.join(l.list_comma())
}

fn at_limit(limit: &Limit, l: Language) -> String {
    let (response, points) = (&limit.response, in_list(&limit.points, l));
    let value = significant(limit.value, 6);
    say!("{response} is {value} in {points}, although its equation differs there: the instrument looks saturated, and these points bend the coefficients. Leave them out, or measure in a larger range.").in_language(l)
}

/// Readings that look exchanged, and which others instead.
fn exchanged(pairs: &[[Words; 2]], l: Language) -> Option<String> {
    let both = |pair: &[Words; 2]| {
        let [first, second] = pair.each_ref().map(|point| said(point, l));
        say!("{first} and {second}").in_language(l)
    };
    let (first, others) = pairs.split_first()?;
    let mut which = both(first);
    if !others.is_empty() {
        let others: Vec<String> = others.iter().map(both).collect();
        let others = others.join(l.pick(", or of ", "、或 "));
        which += &say!(" (or those of {others})").in_language(l);
    }
    Some(say!("The readings of {which} look exchanged: with each in the other's place the residuals would be less than a tenth of what they are. Check the labels before using these figures.").in_language(l))
}

/// Coefficients with another sign than those like them.
fn reversed(names: &[String], l: Language) -> Option<String> {
    let listed = names.join(l.list_comma());
    (!names.is_empty()).then(|| say!("The sign of {listed} is another than that of the other axes: the two ways of this axis may be exchanged in the labels, or the sensor is mounted or read reversed. Check the labels before using these figures.").in_language(l))
}

fn stands_apart(one: &Apart, l: Language) -> String {
    let (response, point) = (&one.response, said(&one.point, l));
    let times = if one.t.is_finite() {
        significant(one.t, 2)
    } else {
        "∞".to_owned()
    };
    say!("{response} in {point} stands apart: its residual is {times} times the standard deviation that the others give it. Find out why before using these figures: a wrong reading, a wrong label, or something that the equations leave out.").in_language(l)
}

/// A parameter of which the readings say something else than the file.
fn contradicted(campaign: &Campaign, one: &Contradicted, l: Language) -> String {
    let name = &one.parameter;
    let mut parameters = campaign.experiment.parameters.iter();
    let own = parameters.find(|other| other.name == *name);
    let unit = own.map_or(String::new(), |own| symbol(&own.unit));
    let u = [one.stated[1], one.found[1]];
    let shown = |[value, u]: [f64; 2]| with_unit(&aligned(value, u, DIGITS), &unit);
    let [stated, found] = [shown(one.stated), shown(one.found)];
    let [u_stated, u_found] = u.map(|u| with_unit(&significant(u, DIGITS), &unit));
    let difference = (one.stated[0] - one.found[0]).abs();
    let times = significant(difference / norm(u.into_iter()), 2);
    say!("{name} is stated as {stated} with u = {u_stated}, and the readings without that give {found} with u = {u_found}: the difference is {times} times its standard uncertainty. What is stated, the readings or the equations are wrong; the figures above are neither the one nor the other, and their scatter has the difference in it.").in_language(l)
}

/// Residuals that are no scatter.
fn no_scatter(campaign: &Campaign, one: &Pattern, l: Language) -> String {
    let (response, p) = (&one.response, p_of(one.p_value));
    let mut responses = campaign.experiment.equations.responses().iter();
    let own = responses.find(|other| other.name == *response);
    let unit = own.map_or(String::new(), |own| symbol(&own.unit));
    let seen = match &one.by {
        PatternTest::Repeats {
            within,
            between,
            f,
        } => {
            let f = significant(*f, 2);
            let [within, between] =
                [within, between].map(|s| with_unit(&significant(*s, 2), &unit));
            say!("readings of {response} where all stimuli are equal have the standard deviation {within}, and by the distance of their means from the equation it would be {between} (F = {f}, {p})").in_language(l)
        }
        PatternTest::Parts { column, f } => {
            let f = significant(*f, 2);
            say!("the parts that {column} tells apart leave less of {response} by themselves than all points together (F = {f}, {p}); what differs from part to part is an input with by = \"{column}\" and a term in the equation").in_language(l)
        }
        PatternTest::Follows { column } => say!("those of {response} follow {column}, which no equation has ({p})").in_language(l),
        PatternTest::Runs { runs, readings } => say!("those of {response} keep their sign in the order of the readings for longer than by chance ({runs} runs of {readings} residuals, {p})").in_language(l),
    };
    say!("The residuals are no scatter: {seen}. The equations leave something out (curvature, hysteresis, drift), or reference values are wrong. The uncertainties above take it for scatter that averages away. `gumption diagnose` looks for what it is.").in_language(l)
}

/// What a reader must know.
pub(super) fn remarks(
    campaign: &Campaign,
    found: Option<&Calibration>,
    assumed: &[String],
    l: Language,
) -> Vec<Block> {
    let mut items = of_recording(campaign, l);
    items.extend(
        found
            .into_iter()
            .flat_map(|found| of_fit(campaign, found, l)),
    );
    if !assumed.is_empty() {
        let names = assumed.join(", ");
        items.push((REMARK, say!("No values of {names} are stated, and zero was assumed: effects that are proportional to them are not seen. State roughly what is expected: [parameter.{}] start = ….", assumed[0]).in_language(l)));
    }
    let remarks = campaign.experiment.remarks.iter();
    items.extend(remarks.map(|remark| (REMARK, remark.in_language(l))));
    if items.is_empty() {
        return Vec::new();
    }
    let texts = items.into_iter().map(|(_, text)| text).collect();
    vec![
        Block::Section(Word::Remarks.of(l).to_owned()),
        Block::List(texts),
    ]
}

/// The codes of what must be known of a recording, each once; what holds of the experiment with any recording is not among them.
pub(super) fn codes(campaign: &Campaign, found: &Calibration) -> String {
    let l = Language::English;
    let all = of_recording(campaign, l).into_iter();
    let mut codes: Vec<&str> = all
        .chain(of_fit(campaign, found, l))
        .map(|(code, _)| code)
        .filter(|code| *code != REMARK)
        .collect();
    codes.dedup();
    codes.join(" ")
}

/// What is doubtful in a recording, each with its code.
fn of_recording(campaign: &Campaign, l: Language) -> Vec<(&'static str, String)> {
    let findings = campaign.points.findings.iter().map(|finding| {
        let [said, mend] = [finding.said(), finding.mend()].map(|text| text.in_language(l));
        let (between, end) = (l.semicolon(), l.pick(".", "。"));
        ("recording", format!("{said}{between}{mend}{end}"))
    });
    findings.collect()
}

/// What is doubtful in what was found from it, each with its code.
fn of_fit(campaign: &Campaign, found: &Calibration, l: Language) -> Vec<(&'static str, String)> {
    let coded = |code: &'static str| move |text: String| (code, text);
    let count = found.left_out;
    let left_out = (count > 0).then(|| {
        say!(
            "{count} reading{} left out, because a value is missing.",
            plural(count)
        )
        .in_language(l)
    });
    let mut items: Vec<(&str, String)> = left_out.map(coded("left-out")).into_iter().collect();
    items.extend(exchanged(&found.swapped, l).map(coded("exchanged")));
    items.extend(reversed(&found.reversed, l).map(coded("reversed")));
    let apart = found.apart.iter().map(|one| stands_apart(one, l));
    items.extend(apart.map(coded("apart")));
    let known = found.contradicted.iter();
    let known = known.map(|one| contradicted(campaign, one, l));
    items.extend(known.map(coded("contradicted")));
    let limits = found.limits.iter().map(|limit| at_limit(limit, l));
    items.extend(limits.map(coded("saturated")));
    let patterns = found
        .patterns
        .iter()
        .map(|one| no_scatter(campaign, one, l));
    items.extend(patterns.map(coded("no-scatter")));
    if !found.linear {
        items.push((REMARK, say!("The equations are not linear in the parameters: uncertainties and written budgets are of first order in the errors.").in_language(l)));
    }
    let misfits = found.responses.iter().filter_map(|one| misfit(one, l));
    items.extend(misfits.map(coded("misfit")));
    items
}
