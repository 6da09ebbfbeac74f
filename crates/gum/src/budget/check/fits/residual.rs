//! `residual_of`: the scatter of a further reading, as the residuals of a fit tell it.

use super::super::checker::Checker;
use super::super::draft::{Context, Core, show};
use crate::budget::faults::{MODIFIER, RESIDUAL_OF, UNIT_CLASH, UNKNOWN_NAME};
use crate::budget::tables::ComponentTable;
use crate::budget::variants::ReadingsOf;
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, nearest, say};
use gumption_format::toml::Stated;

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
        let Some(index) = self.fit_named(table) else {
            let fault = self.no_such_fit(stated);
            return self.refuse(fault);
        };
        let scatter = self.scatters[index].clone();
        if scatter.refused {
            return None;
        }
        let Some((s, dof, unit)) = scatter.known else {
            return self.refuse(own_uncertainties(&scatter.fit, stated, context.owner));
        };
        let m = self.mean_of(table, context.owner)?;
        let Some(conversion) = unit.conversion_to(&context.unit.difference()) else {
            return self.refuse(other_unit(&scatter.fit, &unit, stated, context));
        };
        let u = s * conversion.factor / m.sqrt();
        if u == 0.0 {
            return self.refuse(no_scatter(&scatter.fit, stated));
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

    /// Of how many readings a value is the mean.
    fn mean_of(&mut self, table: &ComponentTable, owner: &str) -> Option<f64> {
        let Some(of) = &table.of else {
            return Some(1.0);
        };
        match of.value {
            ReadingsOf::Single => Some(1.0),
            ReadingsOf::Several(count) => Some(count as f64),
            ReadingsOf::Mean => {
                let message = say!("it is not stated how many readings {owner} is the mean of");
                self.refuse(
                    Fault::new(MODIFIER, of.span.clone(), message)
                        .label(say!("of how many?"))
                        .help(say!("write `of = 3` for the mean of three, or leave it out for a single reading")),
                )
            }
        }
    }

    fn no_such_fit(&self, stated: &Stated<String>) -> Fault {
        let known: Vec<&str> = self.scatters.iter().map(|s| s.fit.as_str()).collect();
        let help = match nearest(&stated.value, known.iter().copied()) {
            Some(near) => say!("did you mean \"{near}\"?"),
            None if known.is_empty() => say!("declare it: [fit.{}]", stated.value),
            None => say!("fits: {}", known.join(", ")),
        };
        let message = say!("there is no fit \"{}\"", stated.value);
        Fault::new(UNKNOWN_NAME, stated.span.clone(), message)
            .label(say!("not declared"))
            .help(help)
    }
}

fn own_uncertainties(fit: &str, stated: &Stated<String>, owner: &str) -> Fault {
    let message = say!("the data of the fit {fit} have uncertainties of their own");
    Fault::new(RESIDUAL_OF, stated.span.clone(), message)
        .label(say!(
            "its residuals do not stand for the scatter of a reading"
        ))
        .help(say!(
            "state the uncertainty of {owner} as that of the data: u = …"
        ))
}

fn other_unit(fit: &str, unit: &Unit, stated: &Stated<String>, context: &Context<'_>) -> Fault {
    let message = say!(
        "the fit {fit} scatters in {}, {} is in {}",
        unit.symbol,
        context.owner,
        context.unit.symbol
    );
    Fault::new(UNIT_CLASH, stated.span.clone(), message)
        .label(say!("units do not fit"))
        .help(say!(
            "the scatter is that of the column on the left of the formula"
        ))
}

fn no_scatter(fit: &str, stated: &Stated<String>) -> Fault {
    let message = say!("the fit {fit} passes through all its points");
    Fault::new(RESIDUAL_OF, stated.span.clone(), message)
        .label(say!("no scatter"))
        .help(say!("state the resolution of the readings: {{ step = … }}"))
}
