//! Components that state a whole distribution: with parameters, as a sample, from counts.

use super::checker::Checker;
use super::draft::{Context, Core, Location};
use super::ways::Way;
use crate::budget::distributions::{self, DistributionEntry};
use crate::budget::faults::{COUNT, DISTRIBUTION, MISSING_KEY, TOO_FEW_READINGS, UNIT_CLASH};
use crate::budget::tables::{ComponentTable, PriorWord};
use gumption_core::distribution::stating::Parametric;
use gumption_core::distribution::{Distribution, Empirical, StudentT, binomial, poisson};
use gumption_core::quantity::Factor;
use gumption_fault::{Fault, say};
use gumption_format::toml::Stated;

impl Checker<'_> {
    /// The component that a stated distribution, a sample or a count describes.
    pub(super) fn given(
        &mut self,
        table: &ComponentTable,
        way: Way,
        context: &Context<'_>,
    ) -> Option<Core> {
        match way {
            Way::Sample => self.sample(table, context),
            Way::Distribution => self.parametric(table),
            Way::Count => self.count(table, context),
            Way::Successes => self.proportion(table, context),
            _ => None,
        }
    }

    fn sample(&mut self, table: &ComponentTable, context: &Context<'_>) -> Option<Core> {
        let stated = table.sample.as_ref()?;
        let mut sample = self.numbers(stated, Some(context.unit))?;
        if sample.len() < 2 || super::type_a::all_equal(&sample) {
            return self.refuse(
                Fault::new(
                    TOO_FEW_READINGS,
                    stated.span.clone(),
                    say!("the sample of {} has no spread", context.owner),
                )
                .label(say!("needs at least two different values")),
            );
        }
        // With fewer values no two of them enclose the coverage probability with as much left on either side.
        let fewest = 2.0 / (1.0 - self.conventions.coverage_probability);
        if (sample.len() as f64) < fewest {
            let (owner, n) = (context.owner, sample.len());
            self.remark(say!("{owner}: {n} values of `sample` are taken for the whole distribution: u is their standard deviation (divisor n), without degrees of freedom. Repeated measurements are `readings`: u = s/√n, ν = n − 1."));
        }
        sample.sort_by(f64::total_cmp);
        let how = format!("sample of {}", sample.len());
        self.centred(
            sample.into_iter().collect::<Empirical>().into(),
            how,
            &stated.key,
        )
    }

    fn parametric(&mut self, table: &ComponentTable) -> Option<Core> {
        let entry = table.distribution.as_ref()?;
        let DistributionEntry::Full(full) = &entry.value else {
            return None;
        };
        let parametric = match distributions::parametric(full, &entry.map(|_| ())) {
            Ok(parametric) => parametric,
            Err(fault) => return self.refuse(*fault),
        };
        let Parametric {
            distribution,
            located,
            limits,
            how,
        } = parametric;
        let dof = self.dof(table)?;
        let mut core = self.centred(distribution.clone(), how, &entry.key)?;
        if let Distribution::StudentT(StudentT { scale, dof: nu, .. }) = distribution {
            // GUM propagates the scale, as it does for readings (JCGM 101 6.4.9).
            core.u = scale;
            core.dof = nu;
        } else {
            core.dof = dof;
        }
        if !located {
            core.location = Location::None;
        } else if let (Location::Expectation(expectation), Some([lower, upper])) =
            (core.location, limits)
        {
            core.location = Location::Between {
                expectation,
                lower,
                upper,
            };
        }
        Some(core)
    }

    /// Events of a Poisson process: the rate is gamma distributed (JCGM 101 6.4.11).
    fn count(&mut self, table: &ComponentTable, context: &Context<'_>) -> Option<Core> {
        let stated = table.count.as_ref()?;
        if let Some(fault) = unit_of_a_count(stated, context) {
            return self.refuse(fault.help(say!(
                "leave `unit` out: the model makes of a count what it stands for, as in `{} / t` for a rate", context.owner
            )));
        }
        let n = stated.value as f64;
        let Some(expected) = poisson::expected_events(n, prior_counts(table)) else {
            return self.refuse(no_events(stated, context));
        };
        if table.prior.is_none() {
            let (owner, estimate) = (context.owner, expected.shape);
            self.remark(match stated.value {
                0 => say!("{owner}: of no counted event the estimate is {estimate} and u² = {estimate}, by the uniform prior (JCGM 101, 6.4.11); with prior = \"jeffreys\" both are 0.5. Write the prior that is meant."),
                n => say!("{owner}: of {n} counted events the estimate is {estimate} and u² = {estimate}, by the uniform prior (JCGM 101, 6.4.11). ISO 11929 and n ± √n are prior = \"reciprocal\": estimate {n}. Write the prior that is meant. The number of repeated readings is no `count`: it follows from `readings`, or is `of` beside `pooled`."),
            });
        }
        let how = format!("n = {n}, G({}, 1)", expected.shape);
        self.centred(expected.into(), how, &stated.key)
    }

    /// Successes of Bernoulli trials: the proportion is beta distributed.
    fn proportion(&mut self, table: &ComponentTable, context: &Context<'_>) -> Option<Core> {
        let stated = table.successes.as_ref()?;
        if let Some(fault) = unit_of_a_count(stated, context) {
            return self.refuse(fault.help(say!(
                "leave `unit` out: the proportion is a number from 0 to 1, which a measurand in % shows in percent"
            )));
        }
        let Some(trials) = &table.trials else {
            return self.refuse(
                Fault::new(
                    MISSING_KEY,
                    stated.key.clone(),
                    say!(
                        "the successes of {} have no number of trials",
                        context.owner
                    ),
                )
                .label(say!("`trials` is missing")),
            );
        };
        if stated.value > trials.value || trials.value == 0 {
            return self.refuse(
                Fault::new(
                    COUNT,
                    stated.span.clone(),
                    say!("{} successes in {} trials", stated.value, trials.value),
                )
                .label(say!("more than there were trials"))
                .related(trials.span.clone(), say!("trials")),
            );
        }
        let (s, f) = (stated.value as f64, (trials.value - stated.value) as f64);
        let Some(proportion) = binomial::proportion(s, f, prior_counts(table)) else {
            return self.refuse(no_events(stated, context));
        };
        if table.prior.is_none() {
            let owner = context.owner;
            let (s, n) = (stated.value, trials.value);
            let estimate = format!(
                "{} / {}",
                proportion.alpha,
                proportion.alpha + proportion.beta
            );
            self.remark(match s == 0 || s == n {
                true => say!("{owner}: of {s} successes in {n} trials the estimate is (s + 1)/(n + 2) = {estimate}, by the uniform prior; with prior = \"jeffreys\" it is (s + 1/2)/(n + 1). Write the prior that is meant."),
                false => say!("{owner}: of {s} successes in {n} trials the estimate is (s + 1)/(n + 2) = {estimate}, by the uniform prior. s/n is prior = \"reciprocal\". Write the prior that is meant."),
            });
        }
        let how = format!(
            "{} of {}, B({}, {})",
            stated.value, trials.value, proportion.alpha, proportion.beta
        );
        self.centred(proportion.into(), how, &stated.key)
    }

    /// Moves a distribution to mean zero; its mean is the estimate.
    fn centred(
        &mut self,
        distribution: Distribution,
        how: String,
        place: &std::ops::Range<usize>,
    ) -> Option<Core> {
        if let Err(reason) = distribution.validate() {
            return self.refuse(
                Fault::new(DISTRIBUTION, place.clone(), reason.said())
                    .label(say!("parameters do not fit")),
            );
        }
        // A t distribution with ν ≤ 1 has no mean; its location takes the place.
        let mean = match &distribution {
            Distribution::StudentT(StudentT { location, .. }) => *location,
            other => other.mean().unwrap_or(0.0),
        };
        let u = distribution.standard_deviation().unwrap_or(0.0);
        let location = Location::Expectation(mean);
        Some(Core {
            location,
            ..Core::new(distribution.shifted(-mean), u, how)
        })
    }
}

/// What the prior adds to a count (JCGM 101 6.4.11 for the uniform one).
fn prior_counts(table: &ComponentTable) -> f64 {
    match table.prior.as_ref().map(|prior| prior.value) {
        None | Some(PriorWord::Uniform) => 1.0,
        Some(PriorWord::Jeffreys) => 0.5,
        Some(PriorWord::Reciprocal) => 0.0,
    }
}

fn no_events(stated: &Stated<u64>, context: &Context<'_>) -> Fault {
    Fault::new(
        COUNT,
        stated.span.clone(),
        say!(
            "the prior \"reciprocal\" of {} needs a count other than {}",
            context.owner,
            stated.value
        ),
    )
    .label(say!("gives no proper distribution"))
    .help(say!("write prior = \"jeffreys\" or \"uniform\""))
}

/// A count in a unit that is not one: 2591 in `1/min` would be a rate already.
fn unit_of_a_count(stated: &Stated<u64>, context: &Context<'_>) -> Option<Fault> {
    let unit = context.unit;
    let is_one = unit.dimension.is_none() && unit.factor == Factor::ONE;
    (!is_one).then(|| {
        let message = say!("{} is counted, but in {}", context.owner, unit.symbol);
        Fault::new(UNIT_CLASH, stated.key.clone(), message).label(say!("a number without unit"))
    })
}
