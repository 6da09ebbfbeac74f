//! Expanded uncertainties from certificates: U with k, or with p and ν.

use std::ops::Range;

use super::checker::Checker;
use super::draft::{Context, Core, show};
use crate::budget::faults::{DOF, K_AND_P, NO_COVERAGE_FACTOR, NOT_POSITIVE, PROBABILITY};
use crate::budget::tables::{CertificateTable, ComponentTable};
use gumption_core::distribution::stating::Width;
use gumption_core::distribution::{Entry, Normal};
use gumption_core::special::student_t_two_sided_quantile;
use gumption_fault::Fault;
use gumption_format::toml::Stated;

impl Checker<'_> {
    pub(super) fn expanded(
        &mut self,
        table: &ComponentTable,
        relative: bool,
        context: &Context<'_>,
    ) -> Option<Core> {
        let certificate = table.certificate.as_ref()?;
        let expanded = certificate.value.U.as_ref()?;
        if certificate.value.refused {
            return None;
        }
        let u_capital = self.positive_deviation(expanded, "U", context, relative)?;
        if let (Some(inner), Some(outer)) = (&certificate.value.dof, &table.dof) {
            return self.refuse(
                Fault::new(
                    DOF,
                    outer.key.clone(),
                    "degrees of freedom are stated twice",
                )
                .label("stated again here")
                .related(inner.key.clone(), "stated in the certificate")
                .help("leave out one"),
            );
        }
        let dof = match &certificate.value.dof {
            Some(dof) => self.positive_dof(&dof.map(|dof| dof.0))?,
            None => self.dof(table)?,
        };
        let k = self.coverage_factor(&certificate.value, &expanded.span, dof)?;
        let how = format!("U/k = {}/{}", show(u_capital), show(k));
        let mut core = if certificate.value.dof.is_some() && table.distribution.is_none() {
            let distribution = self.t_or_normal(u_capital / k, dof, &certificate.key)?;
            Core::new(distribution, u_capital / k, how)
        } else {
            self.shaped(
                table,
                Width::U(u_capital / k),
                Entry::of::<Normal>(),
                how,
                context,
            )?
        };
        core.dof = dof;
        Some(core)
    }

    /// k as stated, or t_p(ν) from the stated coverage probability.
    fn coverage_factor(
        &mut self,
        table: &CertificateTable,
        place: &Range<usize>,
        dof: f64,
    ) -> Option<f64> {
        let k = match &table.k {
            Some(k) if k.value == 0.0 => {
                return self.refuse(
                    Fault::new(NOT_POSITIVE, k.span.clone(), "a coverage factor of 0")
                        .label("must be greater than zero")
                        .help("write the k of the certificate, mostly 2; if it states a coverage probability instead, write p = 0.95"),
                );
            }
            Some(k) => Some(self.positive(k, "k")?),
            None => None,
        };
        let from_p = match &table.p {
            Some(p) => Some(student_t_two_sided_quantile(self.probability(p)?, dof)),
            None => None,
        };
        match (k, from_p) {
            (Some(k), None) => Some(k),
            (None, Some(t)) => Some(t),
            // Certificates print k with two or three digits and p as "approximately 95 %".
            (Some(k), Some(t)) if (k / t - 1.0).abs() <= 0.03 => Some(k),
            (Some(k), Some(t)) => {
                let (k_key, p_key) = (table.k.as_ref()?.key.clone(), table.p.as_ref()?.key.clone());
                self.refuse(
                    Fault::new(
                        K_AND_P,
                        k_key,
                        format!(
                            "k = {k} does not belong to the stated p, which gives k = {}",
                            show(t)
                        ),
                    )
                    .label(format!("k = {k}"))
                    .related(p_key, format!("k = {} follows from p", show(t)))
                    .help("leave out the one that is not on the certificate"),
                )
            }
            (None, None) => self.refuse(
                Fault::new(
                    NO_COVERAGE_FACTOR,
                    place.clone(),
                    "U has no coverage factor",
                )
                .label("k or p is missing")
                .help(
                    "add the k of the certificate (k = 2), or its coverage probability (p = 0.95)",
                ),
            ),
        }
    }

    /// A number that must be a probability.
    pub(super) fn probability(&mut self, p: &Stated<f64>) -> Option<f64> {
        if p.value > 0.0 && p.value < 1.0 {
            return Some(p.value);
        }
        let fault = Fault::new(
            PROBABILITY,
            p.span.clone(),
            format!("a probability of {}", p.value),
        )
        .label("expected a number between 0 and 1");
        self.refuse(if p.value > 1.0 && p.value < 100.0 {
            fault.help(format!("for {} % write {}", p.value, show(p.value / 100.0)))
        } else {
            fault
        })
    }
}
