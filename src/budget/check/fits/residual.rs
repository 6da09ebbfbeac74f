//! `residual_of`: the scatter of a further reading, as the residuals of a fit tell it.

use super::super::Checker;
use super::super::draft::{Context, Core, show};
use super::Fitted;
use crate::budget::faults::{MODIFIER, RESIDUAL_OF, UNIT_CLASH, UNKNOWN_NAME};
use crate::budget::tables::ComponentTable;
use crate::budget::variants::ReadingsOf;
use crate::fault::{Fault, nearest};
use crate::quantity::Unit;

/// What a fit says about the scatter of its response.
#[derive(Debug, Clone)]
pub(in crate::budget::check) struct Scatter {
    fit: String,
    /// Names of the parameters; none where the fit was refused.
    pub parameters: Vec<String>,
    /// The residual standard deviation, its ν and the unit of the response; `None` where uncertainties of
    /// the data are stated, or the fit was refused.
    known: Option<(f64, f64, Unit)>,
    refused: bool,
}

impl Scatter {
    pub(super) fn of(name: &str, fitted: Option<&Fitted>) -> Self {
        let known = fitted.and_then(|found| {
            let fit = &found.fit;
            let s = fit.residual_sd.filter(|_| !fit.weighted && !fit.stated)?;
            Some((s, fit.dof as f64, fit.response().unit.difference()))
        });
        Scatter {
            fit: name.to_string(),
            parameters: fitted.map_or_else(Vec::new, |found| {
                found
                    .fit
                    .parameters
                    .iter()
                    .map(|p| p.name.clone())
                    .collect()
            }),
            known,
            refused: fitted.is_none(),
        }
    }

    /// Whether a figure of this name is missing because the fit was refused.
    pub(in crate::budget::check) fn withholds(&self, figure: &str) -> bool {
        self.refused
            && figure
                .strip_prefix(&self.fit)
                .is_some_and(|rest| rest.starts_with('.'))
    }

    pub(super) fn is(&self, name: &str) -> bool {
        self.fit == name
    }
}

impl Checker<'_> {
    /// The number of the fit whose scatter a component takes.
    pub(in crate::budget::check) fn fit_named(&self, table: &ComponentTable) -> Option<usize> {
        let name = table.residual_of.as_ref()?;
        self.scatters
            .iter()
            .position(|scatter| scatter.is(&name.value))
    }

    /// u = s/√m with the ν of the fit.
    pub(in crate::budget::check) fn residual_of(
        &mut self,
        table: &ComponentTable,
        context: &Context<'_>,
    ) -> Option<Core> {
        let stated = table.residual_of.as_ref()?;
        let owner = context.owner;
        let Some(scatter) = self
            .fit_named(table)
            .map(|index| self.scatters[index].clone())
        else {
            let known: Vec<&str> = self.scatters.iter().map(|s| s.fit.as_str()).collect();
            let help = match nearest(&stated.value, known.iter().copied()) {
                Some(near) => format!("did you mean \"{near}\"?"),
                None if known.is_empty() => format!("declare it: [fit.{}]", stated.value),
                None => format!("fits: {}", known.join(", ")),
            };
            return self.refuse(
                Fault::new(
                    UNKNOWN_NAME,
                    stated.span.clone(),
                    format!("there is no fit \"{}\"", stated.value),
                )
                .label("not declared")
                .help(help),
            );
        };
        if scatter.refused {
            return None;
        }
        let Some((s, dof, unit)) = scatter.known else {
            return self.refuse(
                Fault::new(
                    RESIDUAL_OF,
                    stated.span.clone(),
                    format!(
                        "the data of the fit {} have uncertainties of their own",
                        scatter.fit
                    ),
                )
                .label("its residuals do not stand for the scatter of a reading")
                .help(format!(
                    "state the uncertainty of {owner} as that of the data: u = …"
                )),
            );
        };
        let m = match table.of.as_ref().map(|of| (of.value, of)) {
            None | Some((ReadingsOf::Single, _)) => 1.0,
            Some((ReadingsOf::Several(count), _)) => count as f64,
            Some((ReadingsOf::Mean, of)) => {
                return self.refuse(
                    Fault::new(
                        MODIFIER,
                        of.span.clone(),
                        format!("it is not stated how many readings {owner} is the mean of"),
                    )
                    .label("of how many?")
                    .help("write `of = 3` for the mean of three, or leave it out for a single reading"),
                );
            }
        };
        let Some(conversion) = unit.conversion_to(&context.unit.difference()) else {
            return self.refuse(
                Fault::new(
                    UNIT_CLASH,
                    stated.span.clone(),
                    format!(
                        "the fit {} scatters in {}, {owner} is in {}",
                        scatter.fit, unit.symbol, context.unit.symbol
                    ),
                )
                .label("units do not fit")
                .help("the scatter is that of the column on the left of the formula"),
            );
        };
        let u = s * conversion.factor / m.sqrt();
        if u == 0.0 {
            return self.refuse(
                Fault::new(
                    RESIDUAL_OF,
                    stated.span.clone(),
                    format!("the fit {} passes through all its points", scatter.fit),
                )
                .label("no scatter")
                .help("state the resolution of the readings: { step = … }"),
            );
        }
        let root = if m == 1.0 {
            "s".to_string()
        } else {
            format!("s/√{m}")
        };
        let how = format!("{root} about the fit {}, s = {}", scatter.fit, show(s));
        let distribution = self.t_or_normal(u, dof, &stated.key)?;
        let mut core = Core::new(distribution, u, how);
        core.dof = dof;
        Some(core)
    }
}
