//! Type A evaluation: uncertainty from repeated readings (GUM 4.2).

use super::Checker;
use super::draft::{Context, Core, Location, show};
use crate::budget::faults::{MISSING_KEY, MODIFIER, NO_SCATTER, SERIAL, TOO_FEW_READINGS};
use crate::budget::table::Stated;
use crate::budget::tables::{ComponentTable, PooledTable};
use crate::budget::variants::{Numbers, ReadingsOf};
use crate::distribution::Distribution;
use crate::fault::Fault;

/// Mean and sum of squared deviations, by two passes.
pub(super) fn mean_and_squares(readings: &[f64]) -> (f64, f64) {
    let n = readings.len() as f64;
    let rough = readings.iter().sum::<f64>() / n;
    // The second pass removes the rounding of the first.
    let mean = rough + readings.iter().map(|x| x - rough).sum::<f64>() / n;
    (mean, readings.iter().map(|x| (x - mean) * (x - mean)).sum())
}

/// Whether readings all have the same value, up to the rounding of their mean.
pub(super) fn all_equal(readings: &[f64]) -> bool {
    readings.windows(2).all(|pair| pair[0] == pair[1])
}

impl Checker<'_> {
    /// The component of uncertainty that readings or a pooled standard deviation state.
    pub(super) fn type_a(&mut self, table: &ComponentTable, context: &Context<'_>) -> Option<Core> {
        let of = table.of.as_ref().map_or(ReadingsOf::Mean, |of| of.value);
        let Some(readings) = &table.readings else {
            return self.pooled_alone(table.pooled.as_ref()?, table, context);
        };
        let numbers = self.numbers(readings)?;
        if let Some(pooled) = &table.pooled {
            return self.pooled(pooled, &numbers, of, readings, context);
        }
        if numbers.len() < 2 {
            return self.refuse(too_few(readings, numbers.len(), context));
        }
        if all_equal(&numbers) {
            return self.refuse(no_scatter(readings, &numbers, context));
        }
        if table
            .autocorrelated
            .as_ref()
            .is_some_and(|stated| stated.value)
        {
            return self.autocorrelated(&numbers, of, readings, table, context);
        }
        let n = numbers.len() as f64;
        let (mean, squares) = mean_and_squares(&numbers);
        let s = (squares / (n - 1.0)).sqrt();
        let (m, words) = averaged(of, n);
        let u = s / m.sqrt();
        let how = format!("{words}, s = {}, n = {n}", show(s));
        self.scattered(u, n - 1.0, how, Location::Mean(mean), readings, of)
    }

    fn scattered(
        &mut self,
        u: f64,
        dof: f64,
        how: String,
        location: Location,
        place: &Stated<Numbers>,
        of: ReadingsOf,
    ) -> Option<Core> {
        let distribution = self.t_or_normal(u, dof, &place.key)?;
        let location = if of == ReadingsOf::Mean {
            location
        } else {
            Location::None
        };
        Some(Core {
            distribution,
            u,
            dof,
            how,
            location,
        })
    }

    fn pooled(
        &mut self,
        pooled: &Stated<PooledTable>,
        numbers: &[f64],
        of: ReadingsOf,
        readings: &Stated<Numbers>,
        context: &Context<'_>,
    ) -> Option<Core> {
        if numbers.is_empty() {
            return self.refuse(too_few(readings, 0, context));
        }
        let (s, dof) = self.pooled_numbers(pooled, context)?;
        let (mean, _) = mean_and_squares(numbers);
        let (m, words) = averaged(of, numbers.len() as f64);
        let how = format!("{words}, pooled s = {}", show(s));
        self.scattered(s / m.sqrt(), dof, how, Location::Mean(mean), readings, of)
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
                        "it is not stated how many readings the value is the mean of",
                    )
                    .label("s of a single reading")
                    .help("add the readings, `of = 3` for the mean of three, or `of = \"single\"`"),
                );
            }
        };
        let u = s / m.sqrt();
        let distribution = self.t_or_normal(u, dof, &pooled.key)?;
        let how = if m == 1.0 {
            format!("pooled s = {}", show(s))
        } else {
            format!("s/√{m}, pooled s = {}", show(s))
        };
        Some(Core {
            distribution,
            u,
            dof,
            how,
            location: Location::None,
        })
    }

    fn pooled_numbers(
        &mut self,
        pooled: &Stated<PooledTable>,
        context: &Context<'_>,
    ) -> Option<(f64, f64)> {
        let (Some(s), Some(dof)) = (&pooled.value.s, &pooled.value.dof) else {
            if pooled.value.refused {
                return None;
            }
            let missing = if pooled.value.s.is_none() { "s" } else { "dof" };
            return self.refuse(
                Fault::new(MISSING_KEY, pooled.span.clone(), format!("the pooled standard deviation lacks `{missing}`"))
                    .label(format!("`{missing}` is missing"))
                    .help("write pooled = { s = …, dof = … }; dof is the sum of n - 1 over the earlier series"),
            );
        };
        let s = self.positive_deviation(s, "s", context, false);
        let dof = self.positive_dof(&dof.map(|dof| dof.0));
        Some((s?, dof?))
    }

    /// u of the mean of serially correlated readings: the variance of the mean is
    /// σ²/n·(1 + 2Σ(1 − k/n)ρ_k), summed up to the last lag before the estimated ρ_k first falls
    /// below its own standard deviation under independence (1/√n, doubled).
    fn autocorrelated(
        &mut self,
        numbers: &[f64],
        of: ReadingsOf,
        readings: &Stated<Numbers>,
        table: &ComponentTable,
        context: &Context<'_>,
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
                    "serial correlation changes the uncertainty of a mean only",
                )
                .label("not the mean of the readings")
                .help("leave out `autocorrelated`"),
            );
        }
        if numbers.len() < 10 {
            return self.refuse(
                Fault::new(
                    SERIAL,
                    readings.span.clone(),
                    format!(
                        "{} readings are too few to estimate their serial correlation",
                        numbers.len()
                    ),
                )
                .label("at least 10 are needed"),
            );
        }
        let n = numbers.len() as f64;
        let (mean, squares) = mean_and_squares(numbers);
        let factor = inflation(numbers, mean, squares);
        let effective = n / factor;
        if effective < 2.0 {
            return self.refuse(
                Fault::new(
                    SERIAL,
                    readings.span.clone(),
                    format!(
                        "the {n} readings are worth only {} independent ones",
                        show(effective)
                    ),
                )
                .label("they drift")
                .help("model the drift, or take readings over a longer time"),
            );
        }
        // E Σ(x − x̄)² = σ²(n − factor), because the mean takes up factor/n of the variance.
        let sigma = (squares / (n - factor)).sqrt();
        let u = sigma / effective.sqrt();
        let how = format!(
            "s/√n_eff, s = {}, n = {n}, n_eff = {}",
            show(sigma),
            show(effective)
        );
        self.scattered(u, effective - 1.0, how, Location::Mean(mean), readings, of)
    }
}

/// By what serial correlation multiplies the variance of the mean; at least 1.
fn inflation(readings: &[f64], mean: f64, squares: f64) -> f64 {
    let n = readings.len();
    let limit = 2.0 / (n as f64).sqrt();
    let sum: f64 = (1..=n / 4)
        .map(|lag| {
            let products: f64 = readings
                .iter()
                .zip(&readings[lag..])
                .map(|(a, b)| (a - mean) * (b - mean))
                .sum();
            (lag, products / squares)
        })
        .take_while(|(_, rho)| *rho > limit)
        .map(|(lag, rho)| (1.0 - lag as f64 / n as f64) * rho)
        .sum();
    1.0 + 2.0 * sum
}

/// How many readings the reported value averages, and u in words.
fn averaged(of: ReadingsOf, n: f64) -> (f64, String) {
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
        format!("{} has {count} reading{plural}", context.owner),
    )
    .label("at least two are needed for a standard deviation")
    .help("with a single reading, add pooled = { s = …, dof = … } from earlier work")
}

fn no_scatter(readings: &Stated<Numbers>, numbers: &[f64], context: &Context<'_>) -> Fault {
    let value = numbers.first().copied().unwrap_or_default();
    Fault::new(NO_SCATTER, readings.span.clone(), format!("all {} readings of {} are {value}", numbers.len(), context.owner))
        .label("no scatter, so no uncertainty follows from them")
        .help("the scatter is below the resolution: state `value` and the resolution, { step = … }, or add the resolution to `components`")
}

/// Zero-mean t distribution of a mean of readings, for reuse by joint readings.
pub(super) fn student(scale: f64, dof: f64) -> Distribution {
    Distribution::StudentT {
        location: 0.0,
        scale,
        dof,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_squares_survive_a_large_offset() {
        let (mean, squares) = mean_and_squares(&[1e9 + 1.0, 1e9 + 2.0, 1e9 + 3.0]);
        assert_eq!((mean, squares), (1e9 + 2.0, 2.0));
    }

    #[test]
    fn alternating_readings_are_not_deflated() {
        let readings: Vec<f64> = (0..40).map(|i| f64::from(i % 2)).collect();
        let (mean, squares) = mean_and_squares(&readings);
        assert_eq!(inflation(&readings, mean, squares), 1.0);
    }

    #[test]
    fn doubled_readings_are_worth_about_half() {
        // Every reading twice: ρ_1 is about ½, higher lags about 0, so the factor is about 2.
        let mut state = 1_u64;
        let mut noise = move || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 33) as f64
        };
        let readings: Vec<f64> = (0..2000)
            .flat_map(|_| {
                let reading = noise();
                [reading, reading]
            })
            .collect();
        let (mean, squares) = mean_and_squares(&readings);
        assert!((inflation(&readings, mean, squares) - 2.0).abs() < 0.1);
    }
}
