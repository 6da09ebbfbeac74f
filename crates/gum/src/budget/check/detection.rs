//! `[detection]`: what decision threshold and detection limit need to know.

use super::checker::Checker;
use super::entries::entries;
use super::register::Register;
use crate::budget::Detection;
use crate::budget::faults::{DETECTION, MISSING_KEY, NOT_POSITIVE};
use crate::budget::tables::{DetectionTable, FileTable};
use gumption_core::special::normal_sf;
use gumption_fault::{Fault, say};
use gumption_format::toml::{Slot, Stated};

/// α and β where the file states none (ISO 11929).
const USUAL: f64 = 0.05;

impl Checker<'_> {
    /// Reads `[detection]`.
    pub(super) fn detection(&mut self, file: &FileTable, register: &Register) -> Vec<Detection> {
        let stated = file.detection.as_ref().map_or(&[][..], |all| &all.value.0);
        let mut found: Vec<Detection> = Vec::new();
        for one in stated {
            let Some(detection) = self.limits_of(one, file, register) else {
                continue;
            };
            if found.iter().any(|d| d.measurand == detection.measurand) {
                self.report(
                    Fault::new(
                        DETECTION,
                        one.span.clone(),
                        say!("the characteristic limits of this measurand are asked for twice"),
                    )
                    .label(say!("second time"))
                    .help(say!("leave out one [[detection]]")),
                );
            }
            if let Some((name, _)) = entries(&file.measurand).get(detection.measurand) {
                let names = Detection::FIGURES.map(|figure| format!("{name}.{figure}"));
                self.figures.awaited.extend(names);
            }
            found.push(detection);
        }
        found
    }

    fn limits_of(
        &mut self,
        stated: &Stated<DetectionTable>,
        file: &FileTable,
        register: &Register,
    ) -> Option<Detection> {
        let table = &stated.value;
        let measurand = self.decided(&table.measurand, &stated.span, file, "detection");
        let gross = match &table.gross {
            Some(gross) => self.carrier(gross, register),
            None if table.refused => None,
            None => self.refuse(
                Fault::new(
                    MISSING_KEY,
                    stated.span.clone(),
                    say!("[detection] does not say which input carries the value"),
                )
                .label(say!("`gross` is missing"))
                .help(say!(
                    "name the input that changes when the measurand does: gross = \"n_g\""
                )),
            ),
        };
        let alpha = self.error_probability(&table.alpha, &table.k_alpha);
        let beta = self.error_probability(&table.beta, &table.k_beta);
        let quantile = |stated: &Slot<f64>| stated.as_ref().map(|k| k.value);
        let coverage = match &table.coverage_probability {
            Some(p) => self.probability(p),
            None => Some(self.conventions.coverage_probability),
        };
        let measurand = measurand?;
        let (name, entry) = entries(&file.measurand).get(measurand)?;
        let unit = self.unit(&entry.value.unit)?;
        let guideline = match &table.guideline {
            Some(amount) if amount.value.number <= 0.0 => self.refuse(
                Fault::new(
                    NOT_POSITIVE,
                    amount.span.clone(),
                    say!("the guideline value is not positive"),
                )
                .label(say!("must be greater than zero")),
            ),
            Some(amount) => self.quantity(amount, &unit, name).map(Some),
            None => Some(None),
        };
        Some(Detection {
            measurand,
            gross: gross?,
            alpha: alpha?,
            beta: beta?,
            quantiles: [quantile(&table.k_alpha), quantile(&table.k_beta)],
            coverage_probability: coverage?,
            guideline: guideline?,
        })
    }

    /// From a probability, or from the quantile that is exceeded with it.
    fn error_probability(&mut self, stated: &Slot<f64>, quantile: &Slot<f64>) -> Option<f64> {
        let stated = match (stated, quantile) {
            (None, None) => return Some(USUAL),
            (Some(stated), None) => stated,
            (None, Some(k)) if k.value > 0.0 && normal_sf(k.value) > 0.0 => {
                return Some(normal_sf(k.value));
            }
            (None, Some(k)) => {
                return self.refuse(
                    Fault::new(
                        DETECTION,
                        k.span.clone(),
                        say!("a quantile of {}", k.value),
                    )
                    .label(say!("expected a number above 0, such as 1.645"))
                    .help(say!("state the quantile of the normal distribution for 1 − α, or `alpha` itself")),
                );
            }
            (Some(p), Some(k)) => {
                return self.refuse(
                    Fault::new(
                        DETECTION,
                        k.key.clone(),
                        say!("the probability of a wrong decision is stated twice"),
                    )
                    .label(say!("the quantile"))
                    .related(p.key.clone(), say!("the probability"))
                    .help(say!("leave out one of them")),
                );
            }
        };
        let p = self.probability(stated)?;
        if p < 0.5 {
            return Some(p);
        }
        self.refuse(
            Fault::new(
                DETECTION,
                stated.span.clone(),
                say!("a wrong decision with probability {p}"),
            )
            .label(say!("expected less than 0.5"))
            .help(say!(
                "state the probability of a wrong decision, such as 0.05"
            )),
        )
    }
}
