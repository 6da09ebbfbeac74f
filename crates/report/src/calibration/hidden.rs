//! What an experiment tells apart, and what hides in its coefficients.

use crate::language::Language;
use crate::number::{percent, significant};
use crate::phrase::section;
use crate::symbol;
use gumption_core::quantity::Unit;
use gumption_fault::say;
use gumption_format::document::Block;
use gumption_lab::calibrate::{Alias, Campaign, Figures, Identifiability, Omitted, Plan};

use super::sections::said;
use super::trouble::{changes, in_words};

pub(super) fn schedule(plan: &Plan, l: Language) -> Vec<Block> {
    let (readings, count) = (plan.readings, plan.identifiability.parameters);
    vec![Block::Paragraph(
        say!("The schedule gives {readings} readings for {count} parameters.").in_language(l),
    )]
}

/// What the experiment tells apart.
pub(super) fn identifiability(found: &Identifiability, l: Language) -> Vec<Block> {
    let mut items = Vec::new();
    let (rank, count) = (found.rank, found.parameters);
    if rank == count {
        let condition = significant(found.condition, 3);
        items.push(say!("The readings determine all {count} parameters (rank {rank}; condition number of the scaled equations {condition}).").in_language(l));
    } else {
        items.push(say!("The readings determine {rank} combinations of {count} parameters: not all can be found.").in_language(l));
    }
    items.extend(found.undetermined.iter().map(|combination| {
        let what = in_words(combination, l);
        say!("Not determined: {what}.").in_language(l)
    }));
    for near in &found.near {
        let times = significant(near.inflation, 3);
        let together = changes(&near.combination);
        items.push(say!("{} is nearly hidden: {together} together change the readings by little, and its standard uncertainty is {times} times what it would be if the others were known.", near.parameter).in_language(l));
    }
    let heading = section(l, "What the experiment tells apart", "可辨识性");
    vec![heading, Block::List(items)]
}

/// What omitted effects would shift.
pub(super) fn aliases(
    campaign: &Campaign,
    aliases: &[Alias],
    figures: Option<&Figures>,
    l: Language,
) -> Vec<Block> {
    if aliases.is_empty() {
        return Vec::new();
    }
    let parameters = campaign
        .experiment
        .parameters
        .iter()
        .map(|p| (&p.name, &p.unit));
    let results = campaign.results.iter().map(|r| (&r.name, &r.unit));
    let all = figures.map_or(&[][..], |figures| &figures.coefficients);
    let told = Told {
        coefficients: parameters
            .chain(results)
            .map(|(name, unit)| (&**name, behind(unit)))
            .collect(),
        u: all.iter().map(|one| one.u).collect(),
        l,
    };
    let pairs = campaign.omitted.iter().zip(aliases);
    vec![
        section(
            l,
            "What effects outside the equations would shift",
            "方程未计入的效应会引起的偏移",
        ),
        Block::List(
            pairs
                .map(|(omitted, alias)| told.sentence(omitted, alias))
                .collect(),
        ),
    ]
}

/// A unit behind a number.
fn behind(unit: &Unit) -> String {
    match symbol(unit) {
        none if none.is_empty() => none,
        unit => format!(" {unit}"),
    }
}

/// How omitted effects are told.
struct Told<'a> {
    /// Coefficients, with their units behind a number.
    coefficients: Vec<(&'a str, String)>,
    /// Their standard uncertainties; empty where they are not known.
    u: Vec<f64>,
    l: Language,
}

impl Told<'_> {
    /// An omitted effect and what it would do: at its usual size, or per unit where none is stated.
    fn sentence(&self, omitted: &Omitted, alias: &Alias) -> String {
        let (l, name) = (self.l, &alias.name);
        let physics = omitted
            .description
            .as_ref()
            .map_or("", |words| said(words, l));
        let physics = match physics {
            "" => format!(" [{}]", omitted.term),
            _ => format!("{} [{}]", l.with_aside("", physics), omitted.term),
        };
        if !alias.acts {
            return say!("{name}{physics}: acts on no reading of this schedule.").in_language(l);
        }
        let visible = match alias.visible {
            0.0 => say!("the residuals show nothing of it").in_language(l),
            share => say!("the residuals show {} % of it", percent(share)).in_language(l),
        };
        let unit = behind(&omitted.unit);
        match omitted.typical {
            Some(size) => {
                let amount = format!("{name} = {}{unit}", significant(size, 3));
                let shifts = self.shifts(alias, size, &self.u);
                [format!("{amount}{physics} {shifts}"), visible].join(l.semicolon())
                    + l.pick(".", "。")
            }
            None => {
                let shifts = self.shifts(alias, 1.0, &[]);
                say!("{name}{physics}: each 1{unit} {shifts}; {visible}. Its usual size is not stated; [omitted.{name}] typical = … tells the shifts in multiples of u.").in_language(l)
            }
        }
    }

    /// What an effect of this size does to each coefficient.
    fn shifts(&self, alias: &Alias, size: f64, u: &[f64]) -> String {
        let l = self.l;
        let shifts = alias.shifts_at(size, u);
        if shifts.listed.is_empty() {
            return l.pick("shifts no coefficient", "不使系数偏移").to_owned();
        }
        let listed = shifts.listed.iter().map(|one| {
            let (name, unit) = &self.coefficients[one.coefficient];
            let sign = if one.by < 0.0 { '−' } else { '+' };
            let times = one.times.map_or(String::new(), |times| {
                let times = significant(times, 2);
                say!(" ({times} u)").in_language(l)
            });
            let by = l.pick("by", "偏移");
            format!(
                "{name} {by} {sign}{}{unit}{times}",
                significant(one.by.abs(), 3)
            )
        });
        let listed: Vec<String> = listed.collect();
        let rest = shifts.bound.map_or(String::new(), |bound| {
            let bound = significant(bound, 1);
            say!(", and the others by less than {bound} u").in_language(l)
        });
        let listed = listed.join(l.comma());
        say!("shifts {listed}{rest}").in_language(l)
    }
}
