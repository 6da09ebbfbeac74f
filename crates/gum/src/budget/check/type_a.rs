//! Type A evaluation: uncertainty from repeated readings (GUM 4.2).

use std::ops::Range;

use super::amounts::Share;
use super::checker::Checker;
use super::draft::{Context, Core, Location, show};
use crate::budget::faults::{
    MISSING_KEY, MODIFIER, NO_SCATTER, OUTLIER_TEST, PROBABILITY, SERIAL, TOO_FEW_READINGS,
    TWO_TURNS, TWO_WAYS,
};
use crate::budget::tables::{ComponentTable, OutlierWord, PooledTable};
use crate::budget::variants::{Numbers, ReadingsOf};
use crate::budget::{Finding, Outlier, Statistics};
use gumption_core::distribution::{Distribution, StudentT};
use gumption_core::quantity::{Decimal, Unit, to_digits};
use gumption_core::special::student_t_sf;
use gumption_core::statistics::{Dd, OutlierTest, Serial, Series, pooled, range};
use gumption_fault::{Fault, say};
use gumption_format::toml::Stated;

/// Mean and sum of squared deviations, by two passes.
pub(super) fn mean_and_squares(readings: &[f64]) -> (f64, f64) {
    let readings: Vec<Dd> = readings.iter().copied().map(Dd::from).collect();
    let series = Series::new(&readings);
    (series.mean(), series.squares())
}

/// Whether readings all have the same value, up to the rounding of their mean.
pub(super) fn all_equal(readings: &[f64]) -> bool {
    readings.windows(2).all(|pair| pair[0] == pair[1])
}

/// Fewer readings say nothing about their serial correlation.
const FEWEST_FOR_SERIAL: usize = 10;

/// Level of significance where none is stated.
const SIGNIFICANCE: f64 = 0.05;

/// The reading farthest from the others.
struct Farthest {
    reading: f64,
    /// Of one so far among as many with normal errors, at most.
    probability: f64,
}

/// The reading farthest from the mean of the others, in units of their standard deviation, with the rounding of all in it: what is rounded
/// may show no scatter.
fn farthest(readings: &[f64]) -> Option<Farthest> {
    let places = readings
        .iter()
        .filter_map(|x| Decimal::from_f64(*x).place());
    let step = libm::exp10(f64::from(places.min()?));
    let n = readings.len() as f64;
    let (mean, squares) = mean_and_squares(readings);
    let far = |x: &f64| (x - mean).abs();
    let reading = *readings.iter().max_by(|a, b| far(a).total_cmp(&far(b)))?;
    if n < 3.0 {
        return None;
    }
    // Of the others: n·(x − mean)² / (n − 1) of the squares are its own.
    let apart = (reading - mean) * n / (n - 1.0);
    let of_others = (squares - apart * apart * (n - 1.0) / n).max(0.0);
    let s = libm::hypot((of_others / (n - 2.0)).sqrt(), step / 12f64.sqrt());
    let t = apart.abs() / (s * (1.0 + 1.0 / (n - 1.0)).sqrt());
    Some(Farthest {
        reading,
        probability: (2.0 * n * student_t_sf(t, n - 2.0)).min(1.0),
    })
}

/// What readings say of themselves.
fn statistics(series: &Series, readings: &[Dd], effective: Option<f64>) -> Statistics {
    let (min, max) = range(readings.iter().map(|reading| reading.value()));
    Statistics {
        n: series.count(),
        mean: series.mean(),
        s: series.standard_deviation(),
        min,
        max,
        lag1: series.autocorrelation(1),
        effective,
    }
}

/// A Type A component before its distribution is made.
pub(super) struct Evaluated {
    pub u: f64,
    pub dof: f64,
    pub how: String,
    pub mean: Option<f64>,
    pub findings: Vec<Finding>,
}

impl Checker<'_> {
    /// The component of uncertainty that readings or a pooled standard deviation state.
    pub(super) fn type_a(&mut self, table: &ComponentTable, context: &Context<'_>) -> Option<Core> {
        let of = table.of.as_ref().map_or(ReadingsOf::Mean, |of| of.value);
        let Some(readings) = &table.readings else {
            return self.pooled_alone(table.pooled.as_ref()?, table, context);
        };
        let numbers = self.exact_numbers(readings, Some(context.unit))?;
        let plain: Vec<f64> = numbers.iter().map(|number| number.value()).collect();
        if let Some(fault) = on_two_turns(readings, &plain, context) {
            return self.refuse(fault);
        }
        if let Some(pooled) = &table.pooled {
            let findings = match plain.len() > 1 && !all_equal(&plain) {
                true => self.describe(&numbers, None, readings, table)?,
                false => Vec::new(),
            };
            return self.pooled(pooled, &numbers, of, readings, context, findings);
        }
        if numbers.len() < 2 {
            return self.refuse(too_few(readings, numbers.len(), context));
        }
        if all_equal(&plain) {
            return self.refuse(no_scatter(readings, &plain, context));
        }
        if table
            .autocorrelated
            .as_ref()
            .is_some_and(|stated| stated.value)
        {
            return self.autocorrelated(&numbers, of, readings, table);
        }
        let series = Series::new(&numbers);
        let n = numbers.len() as f64;
        let s = series.standard_deviation();
        let (m, words) = averaged(of, n);
        if of == ReadingsOf::Mean && table.autocorrelated.is_none() {
            self.serial_remark(&series, context);
        }
        if table.outlier_test.is_none() {
            self.slip_remark(&plain, context);
        }
        let evaluated = Evaluated {
            u: s / m.sqrt(),
            dof: n - 1.0,
            how: format!("{words}, s = {}, n = {n}", show(s)),
            mean: Some(series.mean()),
            findings: self.describe(&numbers, None, readings, table)?,
        };
        self.scattered(evaluated, &readings.key, of)
    }

    /// The statistics of readings, and the test for an outlier if one is asked for.
    fn describe(
        &mut self,
        numbers: &[Dd],
        effective: Option<f64>,
        readings: &Stated<Numbers>,
        table: &ComponentTable,
    ) -> Option<Vec<Finding>> {
        let series = Series::new(numbers);
        let mut findings = vec![Finding::Readings(statistics(&series, numbers, effective))];
        if let Some(test) = &table.outlier_test {
            findings.push(self.outlier(numbers, test, readings, table)?);
        } else if let Some(significance) = &table.significance {
            return self.refuse(
                Fault::new(
                    MODIFIER,
                    significance.key.clone(),
                    say!("a level of significance without a test"),
                )
                .label(say!("no meaning here"))
                .help(say!(
                    "add outlier_test = \"grubbs\" or \"dixon\", or leave it out"
                )),
            );
        }
        Some(findings)
    }

    fn outlier(
        &mut self,
        numbers: &[Dd],
        stated: &Stated<OutlierWord>,
        readings: &Stated<Numbers>,
        table: &ComponentTable,
    ) -> Option<Finding> {
        let (test, leveled) = match stated.value {
            OutlierWord::Grubbs => (OutlierTest::Grubbs, true),
            OutlierWord::Dixon => (OutlierTest::Dixon, true),
            OutlierWord::Q => (OutlierTest::DixonQ, true),
            OutlierWord::FourD => (OutlierTest::FourMeanDeviations, false),
            OutlierWord::ThreeS => (OutlierTest::ThreeSigma, false),
        };
        let (fewest, most) = test.counts();
        let (n, word) = (numbers.len(), stated.value.word());
        if n < fewest || n > most {
            let range = match most {
                usize::MAX => say!("{fewest} or more"),
                _ => say!("{fewest} to {most}"),
            };
            return self.refuse(
                Fault::new(
                    OUTLIER_TEST,
                    stated.span.clone(),
                    say!("the test \"{word}\" is not for {n} readings"),
                )
                .label(say!("for {range} readings"))
                .related(readings.key.clone(), say!("{n} readings"))
                .help(say!("\"grubbs\" is for any number of readings from 3 on")),
            );
        }
        if let (false, Some(significance)) = (leveled, &table.significance) {
            return self.refuse(
                Fault::new(
                    OUTLIER_TEST,
                    significance.key.clone(),
                    say!("the test \"{word}\" has no level of significance"),
                )
                .label(say!("no meaning here"))
                .related(stated.key.clone(), say!("the test"))
                .help(say!("leave it out, or choose \"grubbs\" or \"dixon\"")),
            );
        }
        let significance = self.significance(table)?;
        let suspect = test.run(numbers, significance);
        Some(Finding::Outlier(Outlier {
            test,
            significance: leveled.then_some(significance),
            value: numbers.get(suspect.place)?.value(),
            suspect,
        }))
    }

    /// The level of significance of a test.
    pub(super) fn significance(&mut self, table: &ComponentTable) -> Option<f64> {
        let Some(stated) = &table.significance else {
            return Some(SIGNIFICANCE);
        };
        if stated.value > 0.0 && stated.value < 1.0 {
            return Some(stated.value);
        }
        self.refuse(
            Fault::new(
                PROBABILITY,
                stated.span.clone(),
                say!("a level of significance of {}", stated.value),
            )
            .label(say!("expected a number between 0 and 1"))
            .help(say!("write 0.05 for 5 %")),
        )
    }

    /// Remarks on readings that are no independent ones (GUM 4.2.7).
    fn serial_remark(&mut self, series: &Series, context: &Context<'_>) {
        let (rho, limit) = (series.autocorrelation(1), series.serial_limit());
        if series.count() < FEWEST_FOR_SERIAL || rho.abs() <= limit {
            return;
        }
        let owner = context.owner;
        let (rho, limit) = (coefficient(rho), coefficient(limit));
        self.remark(match rho.starts_with('-') {
            false => say!("{owner}: successive readings are correlated (lag-1 coefficient {rho}, beyond ±{limit}; GUM 4.2.7). s/√n is then too small. Write autocorrelated = true, or model the drift."),
            true => say!("{owner}: successive readings are correlated (lag-1 coefficient {rho}, beyond ±{limit}; GUM 4.2.7). They alternate; look for a periodic disturbance."),
        });
    }

    /// Remarks on a reading so far from the others that it may be a slip of the pen: it is not left out, and nobody asked for a test.
    fn slip_remark(&mut self, readings: &[f64], context: &Context<'_>) {
        /// So few sets of normal readings are told to hold a slip that do not.
        const FEW: f64 = 0.001;
        if let Some(slip) = farthest(readings).filter(|farthest| farthest.probability < FEW) {
            let (owner, reading) = (context.owner, show(slip.reading));
            self.remark(say!("{owner}: the reading {reading} lies far from the others, with normal errors in one of {} series at most. If it is a slip, correct it: it was not left out. outlier_test = \"grubbs\" tests it.", show(to_digits(1.0 / slip.probability.max(1e-9), 1))));
        }
    }

    /// The component with its t distribution.
    pub(super) fn scattered(
        &mut self,
        evaluated: Evaluated,
        place: &Range<usize>,
        of: ReadingsOf,
    ) -> Option<Core> {
        let Evaluated {
            u,
            dof,
            how,
            mean,
            findings,
        } = evaluated;
        let distribution = self.t_or_normal(u, dof, place)?;
        let mean = mean.filter(|_| of == ReadingsOf::Mean);
        Some(Core {
            distribution,
            u,
            dof,
            how: how.into(),
            location: mean.map_or(Location::None, Location::Mean),
            findings,
        })
    }

    fn pooled(
        &mut self,
        pooled: &Stated<PooledTable>,
        numbers: &[Dd],
        of: ReadingsOf,
        readings: &Stated<Numbers>,
        context: &Context<'_>,
        findings: Vec<Finding>,
    ) -> Option<Core> {
        if numbers.is_empty() {
            return self.refuse(too_few(readings, 0, context));
        }
        let (s, dof) = self.pooled_numbers(pooled, context)?;
        let (m, words) = averaged(of, numbers.len() as f64);
        let evaluated = Evaluated {
            u: s / m.sqrt(),
            dof,
            how: format!("{words}, pooled s = {}", show(s)),
            mean: Some(Series::new(numbers).mean()),
            findings,
        };
        self.scattered(evaluated, &readings.key, of)
    }

    fn pooled_alone(
        &mut self,
        pooled: &Stated<PooledTable>,
        table: &ComponentTable,
        context: &Context<'_>,
    ) -> Option<Core> {
        let (s, dof) = self.pooled_numbers(pooled, context)?;
        let m = match table.of.as_ref().map(|of| of.value) {
            Some(ReadingsOf::Single) => 1.0,
            Some(ReadingsOf::Several(count)) => count as f64,
            Some(ReadingsOf::Mean) | None => {
                return self.refuse(
                    Fault::new(
                        MODIFIER,
                        pooled.key.clone(),
                        say!("it is not stated how many readings the value is the mean of"),
                    )
                    .label(say!("s of a single reading"))
                    .help(say!(
                        "add the readings, `of = 3` for the mean of three, or `of = \"single\"`"
                    )),
                );
            }
        };
        // Of an s that is stated it is not known how it was found: it may be that of a range.
        let word = match pooled.value.readings {
            Some(_) => "pooled",
            None => "stated",
        };
        let how = if m == 1.0 {
            format!("{word} s = {}", show(s))
        } else {
            format!("s/√{m}, {word} s = {}", show(s))
        };
        let evaluated = Evaluated {
            u: s / m.sqrt(),
            dof,
            how,
            mean: None,
            findings: Vec::new(),
        };
        self.scattered(evaluated, &pooled.key, ReadingsOf::Single)
    }

    fn pooled_numbers(
        &mut self,
        pooled: &Stated<PooledTable>,
        context: &Context<'_>,
    ) -> Option<(f64, f64)> {
        if let Some(readings) = &pooled.value.readings {
            return self.pooled_readings(&pooled.value, readings, context);
        }
        let (Some(s), Some(dof)) = (&pooled.value.s, &pooled.value.dof) else {
            if pooled.value.refused {
                return None;
            }
            let missing = if pooled.value.s.is_none() { "s" } else { "dof" };
            return self.refuse(
                Fault::new(MISSING_KEY, pooled.span.clone(), say!("the pooled standard deviation lacks `{missing}`"))
                    .label(say!("`{missing}` is missing"))
                    .help(say!("write pooled = {{ s = …, dof = … }}; dof is the sum of n - 1 over the earlier series")),
            );
        };
        let s = self.positive_deviation(s, "s", context, Share::Unsaid);
        let dof = self.positive_dof(&dof.map(|dof| dof.0));
        Some((s?, dof?))
    }

    /// A standard deviation pooled over earlier series.
    fn pooled_readings(
        &mut self,
        table: &PooledTable,
        stated: &Stated<Vec<Stated<Vec<Stated<f64>>>>>,
        context: &Context<'_>,
    ) -> Option<(f64, f64)> {
        let other = table.present.iter().find(|(key, _)| *key != "readings");
        if let Some((key, span)) = other {
            return self.refuse(
                Fault::new(
                    TWO_WAYS,
                    span.clone(),
                    say!("the pooled standard deviation has readings and `{key}`"),
                )
                .label(say!("stated again here"))
                .related(
                    stated.key.clone(),
                    say!("s and ν follow from these readings"),
                )
                .help(say!("leave out `{key}`, or the readings")),
            );
        }
        let lists: Vec<Vec<Dd>> = stated
            .value
            .iter()
            .map(|list| self.exact(&list.value))
            .collect();
        let plenty: Vec<Series> = lists
            .iter()
            .filter(|list| list.len() > 1)
            .map(|list| Series::new(list))
            .collect();
        let (s, dof) = pooled(&plenty);
        if plenty.is_empty() || s == 0.0 {
            return self.refuse(
                Fault::new(
                    TOO_FEW_READINGS,
                    stated.span.clone(),
                    say!("the earlier readings of {} do not scatter", context.owner),
                )
                .label(say!(
                    "at least one series of two different readings is needed"
                )),
            );
        }
        Some((s, dof))
    }

    /// u of the mean of serially correlated readings (GUM 4.2.7): see [`Series::serial`].
    fn autocorrelated(
        &mut self,
        numbers: &[Dd],
        of: ReadingsOf,
        readings: &Stated<Numbers>,
        table: &ComponentTable,
    ) -> Option<Core> {
        if of != ReadingsOf::Mean {
            let place = table
                .of
                .as_ref()
                .map_or(readings.key.clone(), |of| of.key.clone());
            return self.refuse(
                Fault::new(
                    MODIFIER,
                    place,
                    say!("serial correlation changes the uncertainty of a mean only"),
                )
                .label(say!("not the mean of the readings"))
                .help(say!("leave out `autocorrelated`")),
            );
        }
        if numbers.len() < FEWEST_FOR_SERIAL {
            return self.refuse(
                Fault::new(
                    SERIAL,
                    readings.span.clone(),
                    say!(
                        "{} readings are too few to estimate their serial correlation",
                        numbers.len()
                    ),
                )
                .label(say!("at least {FEWEST_FOR_SERIAL} are needed")),
            );
        }
        let n = numbers.len() as f64;
        let series = Series::new(numbers);
        let Serial { factor, dof } = series.serial();
        let effective = n / factor;
        if effective < 2.0 {
            return self.refuse(
                Fault::new(
                    SERIAL,
                    readings.span.clone(),
                    say!(
                        "the {n} readings are worth only {} independent ones",
                        show(effective)
                    ),
                )
                .label(say!("they drift"))
                .help(say!("model the drift, or take readings over a longer time")),
            );
        }
        // E Σ(x − x̄)² = σ²(n − factor), because the mean takes up factor/n of the variance.
        let sigma = (series.squares() / (n - factor)).sqrt();
        let evaluated = Evaluated {
            u: sigma / effective.sqrt(),
            dof,
            how: format!(
                "σ/√n_eff, σ = {}, n = {n}, n_eff = {}",
                show(sigma),
                show(effective)
            ),
            mean: Some(series.mean()),
            findings: self.describe(numbers, Some(effective), readings, table)?,
        };
        self.scattered(evaluated, &readings.key, of)
    }
}

/// A correlation coefficient with two decimals.
fn coefficient(r: f64) -> String {
    format!("{r:.2}")
}

/// How many readings the reported value averages, and u in words.
pub(super) fn averaged(of: ReadingsOf, n: f64) -> (f64, String) {
    match of {
        ReadingsOf::Mean => (n, "s/√n".into()),
        ReadingsOf::Single => (1.0, "s".into()),
        ReadingsOf::Several(count) => (count as f64, format!("s/√{count}")),
    }
}

fn too_few(readings: &Stated<Numbers>, count: usize, context: &Context<'_>) -> Fault {
    let plural = if count == 1 { "" } else { "s" };
    Fault::new(
        TOO_FEW_READINGS,
        readings.span.clone(),
        say!("{} has {count} reading{plural}", context.owner),
    )
    .label(say!("at least two are needed for a standard deviation"))
    .help(say!(
        "with a single reading, add pooled = {{ s = …, dof = … }} from earlier work"
    ))
}

fn no_scatter(readings: &Stated<Numbers>, numbers: &[f64], context: &Context<'_>) -> Fault {
    let value = numbers.first().copied().unwrap_or_default();
    Fault::new(NO_SCATTER, readings.span.clone(), say!("all {} readings of {} are {value}", numbers.len(), context.owner))
        .label(say!("no scatter, so no uncertainty follows from them"))
        .help(say!("the scatter is below the resolution: state `value` and the resolution, {{ step = … }}, or add the resolution to `components`"))
}

/// Of directions that lie within half a turn of one another and are written on two turns: the first, one on the
/// other turn, and what to write for that.
pub(super) fn two_turns(plain: &[f64], unit: &Unit) -> Option<[f64; 3]> {
    let turn = unit.full_turn()?;
    let first = *plain.first()?;
    let spread = |angles: &[f64]| {
        let (low, high) = range(angles.iter().copied());
        high - low
    };
    let beside = |angle: f64| angle - turn * ((angle - first) / turn).round();
    let unwrapped: Vec<f64> = plain.iter().map(|angle| beside(*angle)).collect();
    if spread(plain) <= turn / 2.0 || spread(&unwrapped) > turn / 2.0 {
        return None;
    }
    let other = plain
        .iter()
        .copied()
        .find(|angle| (angle - first).abs() > turn / 2.0)?;
    Some([first, other, at_twelve(beside(other))])
}

/// Readings on two turns, whose arithmetic mean points elsewhere.
fn on_two_turns(readings: &Stated<Numbers>, plain: &[f64], context: &Context<'_>) -> Option<Fault> {
    let [first, other, beside] = two_turns(plain, context.unit)?;
    let unit = &context.unit.symbol;
    Some(
        Fault::new(
            TWO_TURNS,
            readings.span.clone(),
            say!("the readings of {} lie on both sides of the end of a turn: {first} {unit} and {other} {unit}", context.owner),
        )
        .label(say!("their arithmetic mean is another direction"))
        .help(say!("write all of them on one turn: {} in place of {other}", Decimal::from_f64(beside))),
    )
}

/// What the subtraction of a turn leaves behind twelve digits is not the file's.
fn at_twelve(x: f64) -> f64 {
    to_digits(x, 12)
}

/// Zero-mean t distribution of a mean of readings, for reuse by joint readings.
pub(super) fn student(scale: f64, dof: f64) -> Distribution {
    Distribution::StudentT(StudentT {
        location: 0.0,
        scale,
        dof,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_squares_survive_a_large_offset() {
        let (mean, squares) = mean_and_squares(&[1e9 + 1.0, 1e9 + 2.0, 1e9 + 3.0]);
        assert_eq!((mean, squares), (1e9 + 2.0, 2.0));
    }
}
