//! Expanded uncertainties from certificates: U with k, or with p and ν.

use std::ops::Range;

use super::checker::Checker;
use super::draft::{Context, Core, show};
use super::factors::no_factor;
use super::register::Register;
use crate::budget::faults::{DOF, K_AND_P, NO_COVERAGE_FACTOR, NOT_POSITIVE, PROBABILITY};
use crate::budget::tables::{CertificateTable, ComponentTable};
use crate::budget::{Group, Owner};
use gumption_core::distribution::stating::Width;
use gumption_core::distribution::{Entry, Normal};
use gumption_core::special::student_t_two_sided_quantile;
use gumption_fault::{Fault, Said, say};
use gumption_format::toml::Stated;

impl Checker<'_> {
    pub(super) fn expanded(
        &mut self,
        table: &ComponentTable,
        context: &Context<'_>,
    ) -> Option<Core> {
        let certificate = table.certificate.as_ref()?;
        let expanded = certificate.value.U.as_ref()?;
        if certificate.value.refused {
            return None;
        }
        let constant = self.positive_deviation(expanded, "U", context, table.share())?;
        let share = certificate.value.reading.as_deref();
        let u_capital = constant + self.of_value(share, context)?;
        self.remark_on_nothing(share, context);
        if let (Some(inner), Some(outer)) = (&certificate.value.dof, &table.dof) {
            return self.refuse(
                Fault::new(
                    DOF,
                    outer.key.clone(),
                    say!("degrees of freedom are stated twice"),
                )
                .label(say!("stated again here"))
                .related(inner.key.clone(), say!("stated in the certificate"))
                .help(say!("leave out one")),
            );
        }
        let dof = match &certificate.value.dof {
            Some(dof) => self.positive_dof(&dof.map(|dof| dof.0))?,
            None => self.dof(table)?,
        };
        let k = self.coverage_factor(&certificate.value, &expanded.span, dof)?;
        self.remark_on_factor(context.owner, k, certificate.value.p.is_some());
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

    /// A k that is the divisor of a rectangle or a triangle.
    fn remark_on_factor(&mut self, owner: &str, k: f64, with_p: bool) {
        /// √3 and √6 are written with three digits at least.
        const ROUNDED: f64 = 0.003;
        let shapes = [
            (3f64.sqrt(), "√3", say!("rectangle"), ""),
            (
                6f64.sqrt(),
                "√6",
                say!("triangle"),
                ", distribution = \"triangular\"",
            ),
        ];
        for (divisor, root, shape, more) in shapes {
            if (k - divisor).abs() < ROUNDED && !with_p {
                self.remark(say!("{owner}: k = {k} is {root}, the divisor of a {shape}, and no coverage factor of a certificate. The U was taken as that of a normal distribution; if it is a limit, write half_width = U{more}."));
            }
        }
    }

    /// Inputs with one certificate, and nothing said of what they have in common.
    pub(super) fn remark_on_shared_certificates(&mut self, register: &Register, groups: &[Group]) {
        let mut known: Vec<(&str, Vec<usize>)> = Vec::new();
        for (index, component) in register.components.iter().enumerate() {
            let number = component
                .certificate
                .as_ref()
                .and_then(|c| c.number.as_deref());
            let (Some(number), Owner::Input(_)) = (number, &component.owner) else {
                continue;
            };
            match known.iter_mut().find(|(other, _)| *other == number) {
                Some((_, members)) => members.push(index),
                None => known.push((number, vec![index])),
            }
        }
        for (number, members) in known {
            let mut owners: Vec<&str> = Vec::new();
            for member in &members {
                if let Owner::Input(input) = &register.components[*member].owner {
                    let name = register.inputs[*input].name.as_str();
                    if !owners.contains(&name) {
                        owners.push(name);
                    }
                }
            }
            let together = |group: &Group| members.iter().all(|m| group.members.contains(m));
            if owners.len() < 2 || groups.iter().any(together) {
                continue;
            }
            /// More names say nothing more.
            const MOST: usize = 4;
            let names = Said::first(&owners, MOST);
            self.remark(say!("{names} have the certificate {number}, and are taken as uncorrelated. What they owe to one calibration is common to them: state it as a [source.NAME], or their correlation as [[correlation]] (r = 0 if there is none)."));
        }
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
                    Fault::new(NOT_POSITIVE, k.span.clone(), say!("a coverage factor of 0"))
                        .label(say!("must be greater than zero"))
                        .help(say!("write the k of the certificate, mostly 2; if it states a coverage probability instead, write p = 0.95")),
                );
            }
            Some(k) => Some(match no_factor(k, dof, "p") {
                Some(fault) => return self.refuse(fault),
                None => self.positive(k, "k")?,
            }),
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
                let p = table.p.as_ref()?.value;
                let fitting = |dof: &u32| {
                    (student_t_two_sided_quantile(p, f64::from(*dof)) / k - 1.0).abs() <= 0.005
                };
                let help = match (1..=200).find(fitting).filter(|_| dof.is_infinite()) {
                    Some(dof) => say!(
                        "this k is that of dof = {dof}: add it, or leave out p, since u = U/k needs k alone"
                    ),
                    None => say!(
                        "leave out p: u = U/k needs k alone, whatever distribution p was meant of"
                    ),
                };
                let (k_key, p_key) = (table.k.as_ref()?.key.clone(), table.p.as_ref()?.key.clone());
                self.refuse(
                    Fault::new(
                        K_AND_P,
                        k_key,
                        say!(
                            "k = {k} does not belong to the stated p, which gives k = {}",
                            show(t)
                        ),
                    )
                    .label(say!("k = {k}"))
                    .related(p_key, say!("k = {} follows from p", show(t)))
                    .help(help),
                )
            }
            (None, None) => self.refuse(
                Fault::new(
                    NO_COVERAGE_FACTOR,
                    place.clone(),
                    say!("U has no coverage factor"),
                )
                .label(say!("k or p is missing"))
                .help(say!(
                    "add the k of the certificate (k = 2), or its coverage probability (p = 0.95)"
                )),
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
            say!("a probability of {}", p.value),
        )
        .label(say!("expected a number between 0 and 1"));
        self.refuse(if p.value > 1.0 && p.value < 100.0 {
            fault.help(say!("for {} % write {}", p.value, show(p.value / 100.0)))
        } else {
            fault
        })
    }
}
