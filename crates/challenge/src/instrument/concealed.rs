//! A case of an instrument: drawing what is concealed, its truth, and its files.

use std::fmt::Write as _;

use nalgebra::DVector;
use rand::RngExt;
use rand::seq::IndexedRandom;

use super::bench::{Bench, Effect};
use super::campaign::{Campaign, Which, condition};
use super::family::{Drive, Family};
use super::noise::Form;
use super::{Course, Instrument};
use crate::files::{CASE, CaseFile, HELD_OUT, RECORDING, number};
use crate::geometry::{Geometry, height, left, span};
use crate::names::Accepted;
use crate::random::{Random, Stream, log_between, normal, source};
use crate::scenario::{Class, NoiseKnowledge, STRENGTHS};
use crate::truth::{Known, TrueEffect, Truth};

/// What is asked for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Asked {
    pub instrument: &'static Instrument,
    pub class: Class,
    pub noise: NoiseKnowledge,
    pub seed: u64,
}

/// A drawn case.
pub(crate) struct Case {
    asked: Asked,
    bench: Bench,
    geometry: Geometry,
    noise: Form,
    /// With their visible strengths.
    effects: Vec<(Effect, f64)>,
}

/// Strength of every other case that no catalogue names: there anything has to be noticed.
const STRONG: f64 = 40.0;
/// Draws of an effect until one can be made as strong as it should be.
const TRIES: usize = 30;

impl Case {
    /// The case that is asked for; nothing where the entry of the instrument cannot be computed.
    pub(crate) fn new(asked: Asked) -> Option<Case> {
        let bench = Bench::new(asked.instrument, asked.seed, Which::Recording)?;
        let mut random = source(asked.seed, Stream::Effect, 0);
        let noise = Form::draw(asked.noise, asked.instrument.is_norm(), &mut random);
        let geometry = bench.geometry(noise);
        let count = match asked.class {
            Class::Null => 0,
            Class::Double | Class::Masked => 2,
            Class::Triple => 3,
            Class::Single | Class::Outside | Class::Hidden => 1,
        };
        let mut case = Case {
            asked,
            bench,
            geometry,
            noise,
            effects: Vec::new(),
        };
        for _ in 0..count {
            let effect = case.draw(&mut random);
            case.effects.extend(effect);
        }
        Some(case)
    }

    /// An effect of the class beside those that are there.
    fn draw(&self, random: &mut Random) -> Option<(Effect, f64)> {
        let outside = matches!(self.asked.class, Class::Outside | Class::Hidden);
        let possible: Vec<(&'static Family, usize)> = self
            .bench
            .possible()
            .into_iter()
            .filter(|(family, column)| {
                family.is_nameable() != outside
                    && !self
                        .effects
                        .iter()
                        .any(|(e, _)| self.shares_a_name(e, family, *column))
            })
            .collect();
        let mut best: Option<(Effect, f64)> = None;
        for _ in 0..TRIES {
            let (family, column) = *possible.choose(random)?;
            let low = if self.effects.is_empty() && self.asked.class == Class::Single {
                STRENGTHS[0]
            } else {
                8.0
            };
            let target = if outside && random.random() {
                STRONG
            } else {
                log_between(random, low, STRENGTHS[1])
            };
            let drawn = Effect::draw(family, column, self.asked.instrument.reads.len(), random);
            let (effect, strength) = self.bench.sized(&self.geometry, drawn, target);
            if (strength / target - 1.0).abs() < 0.1 {
                return Some((effect, strength));
            }
            // What the declared parameters take up, or what has a least size, comes with the strength that it can have.
            if best.as_ref().is_none_or(|(_, most)| strength > *most) {
                best = Some((effect, strength));
            }
        }
        best
    }

    fn names(&self, family: &Family, column: usize) -> Vec<Accepted> {
        let own = self.bench.column(family, column);
        let names = family.names.iter();
        names
            .map(|(id, follows)| Accepted {
                id: (*id).into(),
                along: if *follows {
                    vec![own.into()]
                } else {
                    Vec::new()
                },
            })
            .collect()
    }

    fn shares_a_name(&self, effect: &Effect, family: &Family, column: usize) -> bool {
        let (own, other) = (
            self.names(effect.family, effect.column),
            self.names(family, column),
        );
        own.iter().any(|a| other.iter().any(|b| a.meets(b)))
    }

    fn others(&self, index: usize) -> Vec<&Effect> {
        self.effects
            .iter()
            .enumerate()
            .filter(|(at, _)| *at != index)
            .map(|(_, (effect, _))| effect)
            .collect()
    }

    /// The truth, without its files.
    pub(crate) fn truth(&self, salt: &str) -> Truth {
        let effects = (0..self.effects.len())
            .map(|index| self.true_effect(index))
            .collect();
        let names: Vec<&str> = self
            .effects
            .iter()
            .map(|(effect, _)| effect.family.name)
            .collect();
        let what = if names.is_empty() {
            "none".to_owned()
        } else {
            names.join("+")
        };
        let equations = self
            .asked
            .instrument
            .compares
            .as_ref()
            .map_or(self.asked.instrument.reads.len(), |_| 1);
        Truth {
            format: crate::truth::FORMAT.into(),
            salt: salt.into(),
            seed: self.asked.seed,
            scenario: format!("{}+{what}", self.asked.instrument.name),
            bench: self.asked.instrument.name.clone(),
            class: self.asked.class,
            noise: self.asked.noise,
            noise_form: format!("{:?}", self.noise),
            sigma: vec![self.fresh().map_or(f64::NAN, |bench| self.claimed(&bench)); equations],
            outputs: Vec::new(),
            effects,
            files: std::collections::BTreeMap::new(),
        }
    }

    fn true_effect(&self, index: usize) -> TrueEffect {
        let (effect, strength) = &self.effects[index];
        let others = self.others(index);
        let added = self.bench.added(&[effect], &others);
        let trace = self.geometry.visible(&added);
        let rest: Vec<DVector<f64>> = others
            .iter()
            .map(|other| self.geometry.visible(&self.bench.added(&[other], &[])))
            .collect();
        let beside = left(&trace, &span(&rest, trace.len())).norm();
        let rivals = self
            .bench
            .possible()
            .into_iter()
            .filter(|(family, column)| {
                family.is_nameable()
                    && !self.shares_a_name(effect, family, *column)
                    && !others
                        .iter()
                        .any(|other| self.shares_a_name(other, family, *column))
            })
            .map(|rival| Known {
                name: rival.0.name.into(),
                names: self.names(rival.0, rival.1),
                left: self.bench.left_by(&self.geometry, rival, &trace, &rest),
            })
            .collect();
        let axes = effect
            .gains
            .iter()
            .enumerate()
            .filter(|(_, gain)| **gain != 0.0)
            .map(|(axis, _)| axis);
        TrueEffect {
            physics: effect.family.name.into(),
            look: format!(
                "form {} along {}, a {:.3}, b {:.3}, noise {:?}",
                effect.form,
                self.bench.column(effect.family, effect.column),
                effect.a,
                effect.b,
                self.noise
            ),
            size: effect.size,
            in_residuals: height(&self.geometry.residuals(&added)),
            nameable: effect.family.is_nameable(),
            names: self.names(effect.family, effect.column),
            once: effect.family.happens_once(),
            lambda: *strength,
            lambda_beside: beside,
            axes: if effect.gains.len() > 1 {
                axes.collect()
            } else {
                Vec::new()
            },
            ..TrueEffect::default()
        }
        .beside(rivals)
    }

    fn fresh(&self) -> Option<Bench> {
        Bench::new(self.asked.instrument, self.asked.seed, Which::Fresh)
    }

    /// What each concealed effect adds to what the declared model leaves beside the others, without noise and digits.
    pub(crate) fn signatures(&self) -> Vec<DVector<f64>> {
        (0..self.effects.len())
            .map(|index| {
                self.bench
                    .added(&[&self.effects[index].0], &self.others(index))
            })
            .collect()
    }

    /// Mean time from one row to the next, hours.
    pub(crate) fn dwell(&self) -> f64 {
        let hours = &self.bench.campaign.hours;
        hours.last().unwrap_or(&0.0) / self.bench.campaign.rows().max(1) as f64
    }

    /// Root mean square of the noise of a row, in the unit of what the declared model predicts.
    fn claimed(&self, bench: &Bench) -> f64 {
        let signal = bench.signal(0);
        let square = signal
            .iter()
            .map(|x| libm::pow(self.noise.height(*x), 2.0))
            .sum::<f64>()
            / signal.len() as f64;
        let slope = if self.asked.instrument.is_norm() {
            // Per unit of the field: the mean of the scales.
            let scales: Vec<f64> = (0..3).map(|k| bench.full_scale(k) / 60.0).collect();
            3.0 / scales.iter().sum::<f64>()
        } else {
            1.0
        };
        self.asked.instrument.noise * libm::sqrt(square) * slope
    }

    /// The files of the case but the experiment.
    pub(crate) fn recordings(&self) -> Vec<CaseFile> {
        let fresh = self.fresh();
        let table = |name, bench: &Bench, which: Which| CaseFile {
            name,
            text: self.table(bench, which),
        };
        let mut files = vec![table(RECORDING, &self.bench, Which::Recording)];
        files.extend(
            fresh
                .iter()
                .map(|bench| table(HELD_OUT, bench, Which::Fresh)),
        );
        files
    }

    /// The columns of conditions that are recorded.
    fn recorded(&self) -> Vec<usize> {
        let hidden = self.effects.iter().any(|(e, _)| e.family.is_hidden());
        let needed = |at: usize| {
            self.effects.iter().any(|(e, _)| {
                matches!(e.family.drive, Drive::Temperature | Drive::Condition) && e.column == at
            })
        };
        // Now and then one is missing where it does no harm, so that its absence tells nothing.
        let mut random = source(self.asked.seed, Stream::Case, 1);
        let spared = random.random_bool(0.15);
        (0..self.asked.instrument.conditions.len())
            .filter(|at| {
                if hidden {
                    *at != 0
                } else {
                    *at != 0 || needed(0) || !spared
                }
            })
            .collect()
    }

    /// Whether the uncertainty of each row is a column.
    fn has_u(&self) -> bool {
        self.asked.noise.is_stated() && matches!(self.noise, Form::Growing(_))
    }

    fn table(&self, bench: &Bench, which: Which) -> String {
        let instrument = self.asked.instrument;
        let effects: Vec<&Effect> = self.effects.iter().map(|(effect, _)| effect).collect();
        let mut readings = bench.outputs_at_rows(&effects);
        let sigma = instrument.noise;
        for (output, series) in readings.iter_mut().enumerate() {
            let random = &mut source(
                self.asked.seed,
                Stream::Noise,
                512 * (1 + which as u64) + output as u64,
            );
            let noise = self.noise.sample(&bench.signal(output), random);
            for (y, e) in series.iter_mut().zip(noise) {
                *y += sigma * e;
            }
        }
        bench.show(&effects, &mut readings);
        if let Some(step) = self.noise.step().map(|step| step * sigma) {
            for y in readings.iter_mut().flatten() {
                *y = (*y / step).round() * step;
            }
        }
        let heading = |name: &str, unit: &str| {
            if unit.is_empty() || unit == "1" {
                name.to_owned()
            } else {
                format!("{name} [{unit}]")
            }
        };
        let mut columns: Vec<(String, usize, Vec<f64>)> = vec![
            (
                "time [h]".into(),
                5,
                Campaign::at_rows(&bench.campaign.hours),
            ),
            (
                "run".into(),
                0,
                Campaign::at_rows(&bench.campaign.run)
                    .into_iter()
                    .map(|run| run as f64 + 1.0)
                    .collect(),
            ),
        ];
        for (stimulus, series) in instrument
            .stimuli
            .iter()
            .zip(&bench.campaign.stimuli)
            .filter(|(s, _)| s.course != Course::Attitude)
        {
            columns.push((
                heading(&stimulus.name, &stimulus.unit),
                stimulus.digits,
                Campaign::at_rows(series),
            ));
        }
        for at in self.recorded() {
            let name = &instrument.conditions[at];
            let (unit, _, reach, digits) = condition(name);
            let random = &mut source(
                self.asked.seed,
                Stream::Instruments,
                8 * (which as u64 + 1) + at as u64,
            );
            let shown = Campaign::at_rows(&bench.campaign.conditions[at])
                .into_iter()
                .map(|x| x + 0.005 * reach * normal(random));
            columns.push((heading(name, unit), digits, shown.collect()));
        }
        if self.has_u() {
            let u = bench
                .signal(0)
                .iter()
                .map(|x| sigma * self.noise.height(*x))
                .collect();
            columns.push((heading("u", &instrument.unit), instrument.digits + 1, u));
        }
        for ((name, _), series) in instrument.outputs().zip(readings) {
            columns.push((heading(name, &instrument.unit), instrument.digits, series));
        }
        let heads: Vec<&str> = columns.iter().map(|(head, ..)| head.as_str()).collect();
        let mut text = heads.join(",") + "\n";
        for row in 0..bench.campaign.rows() {
            let fields: Vec<String> = columns
                .iter()
                .map(|(_, digits, values)| number(values[row], *digits))
                .collect();
            text += &(fields.join(",") + "\n");
        }
        text
    }

    /// The case file, with the seal of the truth.
    pub(crate) fn file(&self, seal: &str) -> CaseFile {
        let instrument = self.asked.instrument;
        let equations: Vec<String> = if instrument.declared.is_empty() {
            instrument.reads.clone()
        } else {
            instrument.declared.clone()
        };
        let mut columns = String::new();
        for stimulus in instrument
            .stimuli
            .iter()
            .filter(|s| s.course != Course::Attitude)
        {
            let _ = writeln!(columns, "{} = \"{}\"", stimulus.name, stimulus.role);
        }
        for at in self.recorded() {
            let _ = writeln!(columns, "{} = \"covariate\"", instrument.conditions[at]);
        }
        if self.has_u() {
            columns += "u = \"u\"\n";
        }
        let role = if instrument.is_norm() {
            "stimulus"
        } else {
            "output"
        };
        for (name, _) in instrument.outputs() {
            let _ = writeln!(columns, "{name} = \"{role}\"");
        }
        let unit = if instrument.is_norm() {
            &instrument.stimuli[0].unit
        } else {
            &instrument.unit
        };
        let u = self.claimed(&self.bench);
        let noise = match (self.asked.noise.is_stated(), self.has_u()) {
            (true, false) => format!("[noise]\nu = \"{u:.6e} {unit}\"\n"),
            _ => String::new(),
        };
        let text = format!(
            "# Diagnose with: gumption diagnose CASE.toml\ntitle = \"{}\"\nnote = \"\"\"\n{}\nThe true causes are sealed in truth.json, which has the SHA-256\n{seal}\"\"\"\nrecording = \"{RECORDING}\"\nequations = {equations:?}\n\n[columns]\ntime = \"time\"\nrun = \"run\"\n{columns}\n{noise}{}\n[held_out]\nfile = \"{HELD_OUT}\"\n",
            instrument.title, instrument.prose, instrument.extra,
        );
        CaseFile { name: CASE, text }
    }
}
