//! What is known of the items before one is measured.

use crate::budget::Interval;
use crate::budget::check::Checker;
use crate::budget::distributions::{self, DistributionEntry};
use crate::budget::faults::{MISSING_KEY, PROCESS, TWO_WAYS};
use crate::budget::tables::ProcessTable;
use gumption_core::distribution::{Distribution, Normal};
use gumption_core::special::normal_two_sided_quantile;
use gumption_fault::{Fault, say};
use gumption_format::toml::Stated;

impl Checker<'_> {
    /// The distribution of the items.
    pub(super) fn process(
        &mut self,
        stated: &Stated<ProcessTable>,
        tolerance: Interval,
    ) -> Option<Distribution> {
        let table = &stated.value;
        match (&table.distribution, &table.in_tolerance_probability) {
            (Some(first), Some(second)) => self.refuse(
                Fault::new(
                    TWO_WAYS,
                    second.key.clone(),
                    say!("the process is described twice"),
                )
                .label(say!("by the fraction in tolerance here"))
                .related(first.key.clone(), say!("by its distribution here"))
                .help(say!("leave out one")),
            ),
            (Some(entry), None) => {
                let DistributionEntry::Full(full) = &entry.value else {
                    return self.refuse(
                        Fault::new(PROCESS, entry.span.clone(), say!("the distribution of the process has no parameters"))
                            .label(say!("only its shape is stated"))
                            .help(say!("write for example distribution = {{ normal = {{ mean = 1500, sd = 0.12 }} }}")),
                    );
                };
                match distributions::parametric(full, &entry.map(|_| ())) {
                    Err(fault) => self.refuse(*fault),
                    Ok(found) if !found.located => self.refuse(
                        Fault::new(
                            PROCESS,
                            entry.span.clone(),
                            say!("the distribution of the process has no location"),
                        )
                        .label(say!("where are the items?"))
                        .help(say!(
                            "add its `mean` (or `location`, or `lower` and `upper`)"
                        )),
                    ),
                    Ok(found) => match found.distribution.validate() {
                        Ok(()) => Some(found.distribution),
                        Err(reason) => self.refuse(
                            Fault::new(PROCESS, entry.span.clone(), reason.said())
                                .label(say!("parameters do not fit")),
                        ),
                    },
                }
            }
            (None, Some(p)) => {
                let value = self.probability(p)?;
                let Some(width) = tolerance.width() else {
                    return self.refuse(
                        Fault::new(PROCESS, p.span.clone(), say!("a fraction in tolerance and one tolerance limit do not say how the items scatter"))
                            .label(say!("needs `lower` and `upper`"))
                            .help(say!("state the distribution: process = {{ distribution = {{ normal = {{ mean = …, sd = … }} }} }}")),
                    );
                };
                Some(Distribution::Normal(Normal {
                    mean: tolerance.lower + width / 2.0,
                    sd: width / 2.0 / normal_two_sided_quantile(value),
                }))
            }
            (None, None) if table.refused => None,
            (None, None) => self.refuse(
                Fault::new(
                    MISSING_KEY,
                    stated.span.clone(),
                    say!("`process` says nothing"),
                )
                .label(say!(
                    "expected `distribution` or `in_tolerance_probability`"
                )),
            ),
        }
    }
}
