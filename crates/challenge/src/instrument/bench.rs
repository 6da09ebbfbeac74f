//! Readings of an instrument with effects at work, and what of an effect is visible: twin runs that differ in nothing but
//! the effect.

use nalgebra::{DMatrix, DVector};
use rand::RngExt;

use super::campaign::{Campaign, Which, condition};
use super::family::{Drive, FAMILIES, Family, Place, View};
use super::noise::Form;
use super::{Formulas, Instrument};
use crate::geometry::{Geometry, left, span};
use crate::random::{Random, Stream, normal, sign, source};

/// An effect in a case.
#[derive(Clone)]
pub(super) struct Effect {
    pub family: &'static Family,
    pub form: usize,
    /// Place of the column that it follows, among stimuli or conditions.
    pub column: usize,
    /// Share of each output.
    pub gains: Vec<f64>,
    pub a: f64,
    pub b: f64,
    /// As a part of full scale, of the scale or of the range.
    pub size: f64,
}

impl Effect {
    /// An effect of a family by chance.
    pub(super) fn draw(
        family: &'static Family,
        column: usize,
        outputs: usize,
        random: &mut Random,
    ) -> Effect {
        let one = random.random_range(0..outputs);
        let sign = sign(random);
        Effect {
            family,
            form: random.random_range(0..family.forms.len()),
            column,
            gains: (0..outputs)
                .map(|k| if k == one { sign } else { 0.0 })
                .collect(),
            a: random.random(),
            b: random.random(),
            size: 1e-3,
        }
    }
}

/// A device on its bench, through a campaign.
pub(super) struct Bench {
    pub instrument: &'static Instrument,
    pub campaign: Campaign,
    formulas: Formulas,
    /// True values of the parameters, in the order of their names.
    truth: Vec<f64>,
    zero: Option<usize>,
    seed: u64,
    /// What each output has above its zero, without effects, on the fine grid.
    signals: Vec<Vec<f64>>,
}

impl Bench {
    pub(super) fn new(instrument: &'static Instrument, seed: u64, which: Which) -> Option<Bench> {
        let mut random = source(seed, Stream::Device, 0);
        let truth = instrument
            .truth
            .values()
            .map(|x| x * (1.0 + 0.02 * normal(&mut random)))
            .collect();
        let zero = instrument.zero.as_ref();
        let mut bench = Bench {
            instrument,
            campaign: Campaign::new(instrument, seed, which),
            formulas: instrument.compiled()?,
            truth,
            zero: zero.and_then(|zero| instrument.truth.keys().position(|name| name == zero)),
            seed,
            signals: Vec::new(),
        };
        let readings = bench.run(&[]);
        let zero = |output: usize| bench.zero_of(output);
        bench.signals = readings
            .iter()
            .enumerate()
            .map(|(k, series)| series.iter().map(|y| y - zero(k)).collect())
            .collect();
        Some(bench)
    }

    fn outputs(&self) -> usize {
        self.instrument.reads.len()
    }

    fn zero_of(&self, output: usize) -> f64 {
        if self.instrument.is_norm() {
            // Of a triad the parameters come as offsets of the axes, then scales.
            return self.truth.get(output).copied().unwrap_or(0.0);
        }
        self.zero.map_or(0.0, |at| self.truth[at])
    }

    /// Largest value that an output has above its zero.
    pub(super) fn full_scale(&self, output: usize) -> f64 {
        self.signals[output]
            .iter()
            .fold(0.0, |most: f64, x| most.max(x.abs()))
    }

    /// What an output has above its zero over its largest value, in the rows.
    pub(super) fn signal(&self, output: usize) -> Vec<f64> {
        let full = self.full_scale(output);
        Campaign::at_rows(&self.signals[output])
            .into_iter()
            .map(|x| x / full)
            .collect()
    }

    /// What a form gives for an effect, on the fine grid.
    fn series(&self, effect: &Effect) -> Vec<f64> {
        let campaign = &self.campaign;
        let output = effect
            .gains
            .iter()
            .position(|gain| *gain != 0.0)
            .unwrap_or(0);
        let full = if self.signals.is_empty() {
            1.0
        } else {
            self.full_scale(output)
        };
        let signal: Vec<f64> = self.signals[output].iter().map(|x| x / full).collect();
        let share = campaign.share();
        let drive: Vec<f64> = match effect.family.drive {
            Drive::Temperature | Drive::Condition => {
                let (_, middle, reach, _) = condition(&self.instrument.conditions[effect.column]);
                campaign.conditions[effect.column]
                    .iter()
                    .map(|x| (x - middle) / reach)
                    .collect()
            }
            Drive::Code => {
                let most = f64::from(1_u32 << self.instrument.bits.min(31));
                self.signals[output]
                    .iter()
                    .map(|x| (x / most).clamp(0.0, 1.0))
                    .collect()
            }
            _ if self.instrument.is_norm() => signal.clone(),
            Drive::OneSided | Drive::TwoSided | Drive::Stimulus | Drive::Path | Drive::Moving => {
                let stimulus = &self.instrument.stimuli[effect.column];
                let (low, reach) = if stimulus.is_two_sided() {
                    (0.0, stimulus.high)
                } else {
                    (stimulus.low, stimulus.high - stimulus.low)
                };
                campaign.stimuli[effect.column]
                    .iter()
                    .map(|x| (x - low) / reach)
                    .collect()
            }
            _ => share.clone(),
        };
        let view = View {
            hours: &campaign.hours,
            share: &share,
            drive: &drive,
            signal: &signal,
            run: &campaign.run,
            a: effect.a,
            b: effect.b,
            seed: self.seed,
        };
        (effect.family.forms[effect.form])(&view)
    }

    /// Outputs on the fine grid, without noise.
    fn run(&self, effects: &[&Effect]) -> Vec<Vec<f64>> {
        let mut stimuli = self.campaign.stimuli.clone();
        let of = |place: Place| effects.iter().filter(move |e| e.family.place == place);
        for effect in of(Place::Input) {
            let stimulus = &self.instrument.stimuli[effect.column];
            let reach = stimulus.high - stimulus.low;
            for (x, g) in stimuli[effect.column].iter_mut().zip(self.series(effect)) {
                *x += effect.size * reach * g;
            }
        }
        let moments = self.campaign.hours.len();
        let mut outputs = vec![Vec::with_capacity(moments); self.outputs()];
        let nothing = vec![0.0; self.outputs()];
        for moment in 0..moments {
            let applied = stimuli.iter().map(|series| series[moment]);
            let x: Vec<f64> = applied
                .chain(nothing.iter().copied())
                .chain(self.truth.iter().copied())
                .collect();
            for (series, y) in outputs.iter_mut().zip(self.formulas.reads.values(&x)) {
                series.push(y);
            }
        }
        for effect in of(Place::Scale)
            .chain(of(Place::Offset))
            .chain(of(Place::Axis))
        {
            let form = self.series(effect);
            for (output, gain) in effect
                .gains
                .iter()
                .enumerate()
                .filter(|(_, gain)| **gain != 0.0)
            {
                let factor = effect.size * gain;
                let own = &self.signals[output];
                let other = &self.signals[(output + 1) % self.outputs()];
                let full = self.full_scale(output);
                for (moment, y) in outputs[output].iter_mut().enumerate() {
                    *y += factor
                        * form[moment]
                        * match effect.family.place {
                            Place::Scale => own[moment],
                            Place::Axis => other[moment],
                            // The least bit is the full scale of a converter's errors.
                            _ if effect.family.drive == Drive::Code => 1.0,
                            _ => full,
                        };
                }
            }
        }
        outputs
    }

    /// What the display makes of readings: coarse digits, a limit.
    pub(super) fn show(&self, effects: &[&Effect], readings: &mut [Vec<f64>]) {
        let full = self.full_scale(0);
        for effect in effects {
            let most = self.zero_of(0) + full * (1.0 - effect.size);
            let step = full * effect.size;
            let shown: fn(f64, f64, f64) -> f64 = match effect.family.place {
                Place::Clip => |y, most, _| y.min(most),
                Place::Rounding => |y, _, step| (y / step).round() * step,
                _ => continue,
            };
            for y in readings.iter_mut().take(1).flatten() {
                *y = shown(*y, most, step);
            }
        }
    }

    /// Outputs in the rows, without noise.
    pub(super) fn outputs_at_rows(&self, effects: &[&Effect]) -> Vec<Vec<f64>> {
        self.run(effects)
            .iter()
            .map(|series| Campaign::at_rows(series))
            .collect()
    }

    /// Readings in the rows, without noise.
    fn ideal(&self, effects: &[&Effect]) -> Vec<Vec<f64>> {
        let mut readings = self.outputs_at_rows(effects);
        self.show(effects, &mut readings);
        readings
    }

    /// What is recorded and what was true, as the formulas take it, in one row of readings.
    fn point(&self, readings: &[Vec<f64>], row: usize, applied: &[Vec<f64>]) -> Vec<f64> {
        let stimuli = applied.iter().map(|series| series[row]);
        let readings = readings.iter().map(|series| series[row]);
        stimuli
            .chain(readings)
            .chain(self.truth.iter().copied())
            .collect()
    }

    /// What the declared model, with the true parameters, leaves of readings: all rows of the first equation, then the next.
    fn residuals(&self, readings: &[Vec<f64>]) -> DVector<f64> {
        let applied: Vec<Vec<f64>> = self
            .campaign
            .stimuli
            .iter()
            .map(|s| Campaign::at_rows(s))
            .collect();
        let rows: Vec<Vec<f64>> = (0..self.campaign.rows())
            .map(|row| {
                self.formulas
                    .residuals
                    .values(&self.point(readings, row, &applied))
            })
            .collect();
        let equations = self.formulas.residuals.outputs().len();
        DVector::from_iterator(
            rows.len() * equations,
            (0..equations).flat_map(|k| rows.iter().map(move |row| row[k])),
        )
    }

    /// What noise and the declared parameters leave visible. One equation at a time: those of the instruments have one.
    pub(super) fn geometry(&self, noise: Form) -> Geometry {
        let readings = self.ideal(&[]);
        let applied: Vec<Vec<f64>> = self
            .campaign
            .stimuli
            .iter()
            .map(|s| Campaign::at_rows(s))
            .collect();
        let rows = self.campaign.rows();
        let slopes: Vec<DMatrix<f64>> = (0..rows)
            .map(|row| {
                self.formulas
                    .residuals
                    .gradients(&self.point(&readings, row, &applied))
            })
            .collect();
        let first = applied.len();
        let parameters = first + self.outputs();
        let mut covariance = DMatrix::zeros(rows, rows);
        for output in 0..self.outputs() {
            let own = noise.covariance(&self.signal(output));
            covariance += DMatrix::from_fn(rows, rows, |i, j| {
                own[(i, j)] * slopes[i][(0, first + output)] * slopes[j][(0, first + output)]
            });
        }
        covariance *= self.instrument.noise * self.instrument.noise;
        let mut tangent: Vec<DVector<f64>> = (0..self.truth.len())
            .map(|k| DVector::from_fn(rows, |row, _| slopes[row][(0, parameters + k)]))
            .collect();
        if let Some(at) = self.labels() {
            let labels = &applied[at];
            let (low, high) = (
                self.instrument.stimuli[at].low as i64,
                self.instrument.stimuli[at].high as i64,
            );
            tangent.extend((low..=high).map(|label| {
                DVector::from_fn(rows, |row, _| f64::from(labels[row] as i64 == label))
            }));
        }
        Geometry::new(covariance, &tangent)
    }

    fn labels(&self) -> Option<usize> {
        let per = self.instrument.per.as_ref()?;
        self.instrument
            .stimuli
            .iter()
            .position(|s| s.name == per.column)
    }

    /// What effects add to what the declared model leaves, beside others.
    pub(super) fn added(&self, effects: &[&Effect], others: &[&Effect]) -> DVector<f64> {
        let mut all = others.to_vec();
        all.extend(effects);
        self.residuals(&self.ideal(&all)) - self.residuals(&self.ideal(others))
    }

    /// The effect with the size at which it has a strength, and the strength that it has: some are absorbed.
    pub(super) fn sized(
        &self,
        geometry: &Geometry,
        mut effect: Effect,
        target: f64,
    ) -> (Effect, f64) {
        /// Largest size that still is an error: a part of full scale.
        const LARGEST: f64 = 0.3;
        let strength = |effect: &Effect| geometry.visible(&self.added(&[effect], &[])).norm();
        let (mut low, mut high) = (1e-9_f64, LARGEST);
        if effect.family.drive == Drive::Code {
            high = 50.0;
        }
        // Bisection of the logarithm: the strength grows with the size in every form.
        for _ in 0..45 {
            effect.size = libm::sqrt(low * high);
            if strength(&effect) < target {
                low = effect.size
            } else {
                high = effect.size
            }
            if high / low < 1.0005 {
                break;
            }
        }
        let reached = strength(&effect);
        (effect, reached)
    }

    /// Families that can be here, each with the columns that it may follow.
    pub(super) fn possible(&self) -> Vec<(&'static Family, usize)> {
        let instrument = self.instrument;
        let followed = |test: fn(&super::Stimulus) -> bool| -> Vec<usize> {
            let all = instrument.stimuli.iter().enumerate();
            all.filter(|(_, s)| s.is_followed() && test(s))
                .map(|(at, _)| at)
                .take(1)
                .collect()
        };
        let none = Vec::new();
        let days = self.campaign.hours.last().copied().unwrap_or(0.0) > 48.0;
        let runs = self.campaign.run.last().copied().unwrap_or(0) > 0;
        let norm = instrument.is_norm();
        FAMILIES
            .iter()
            .flat_map(|family| {
                let columns = match family.drive {
                    Drive::TwoSided if norm => vec![0],
                    Drive::OneSided | Drive::Stimulus | Drive::Path | Drive::Moving if norm => {
                        none.clone()
                    }
                    Drive::OneSided => followed(|s| !s.is_two_sided()),
                    Drive::TwoSided => followed(super::Stimulus::is_two_sided),
                    Drive::Stimulus => followed(|_| true),
                    Drive::Moving => followed(super::Stimulus::is_moving),
                    Drive::Path => followed(super::Stimulus::has_history),
                    Drive::Temperature => vec![0],
                    Drive::Condition => (1..instrument.conditions.len()).collect(),
                    Drive::Days if !days => none.clone(),
                    Drive::Run if !runs => none.clone(),
                    Drive::Code if instrument.bits == 0 => none.clone(),
                    Drive::Axes if !norm => none.clone(),
                    Drive::Days | Drive::Run | Drive::Code | Drive::Axes | Drive::Time => vec![0],
                };
                columns.into_iter().map(move |column| (family, column))
            })
            .filter(|(family, _)| !(norm && matches!(family.place, Place::Rounding | Place::Clip)))
            .collect()
    }

    /// The column that an effect follows, by name.
    pub(super) fn column(&self, family: &Family, column: usize) -> &str {
        match family.drive {
            Drive::Temperature | Drive::Condition => &self.instrument.conditions[column],
            Drive::Time | Drive::Days => "time",
            Drive::Run => "run",
            _ => self.instrument.stimuli.get(column).map_or("", |s| &s.name),
        }
    }

    /// What a family leaves of a trace at best beside others, in all its forms and over its shapes.
    pub(super) fn left_by(
        &self,
        geometry: &Geometry,
        rival: (&'static Family, usize),
        trace: &DVector<f64>,
        others: &[DVector<f64>],
    ) -> f64 {
        let (family, column) = rival;
        let mut least = f64::INFINITY;
        for form in 0..family.forms.len() {
            for a in [0.15, 0.5, 0.85] {
                let mut columns = others.to_vec();
                // A quarter of a turn apart, for forms with a phase; two widths for others.
                for b in [0.2, 0.45] {
                    for output in 0..self.outputs() {
                        let gains = (0..self.outputs())
                            .map(|k| f64::from(k == output))
                            .collect();
                        let size = if family.place == Place::Rounding {
                            0.01
                        } else {
                            1e-3
                        };
                        let effect = Effect {
                            family,
                            form,
                            column,
                            gains,
                            a,
                            b,
                            size,
                        };
                        columns.push(geometry.visible(&self.added(&[&effect], &[])));
                    }
                }
                least = least.min(left(trace, &span(&columns, trace.len())).norm());
            }
        }
        least
    }
}
