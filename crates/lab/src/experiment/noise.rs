//! What a file says of the noise of its readings: one way of saying it, checked.

use std::ops::Range;

use super::checker::Checker;
use super::entries::RoleWord;
use super::faults::{NOISE, UNIT};
use super::source::entries;
use super::tables::{ColumnTable, NoiseTable, NoiseWord};
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, Rejection, Said, say};
use gumption_format::toml::{Amount, Stated};
use gumption_gum::budget::{self, Loaded};
use gumption_gum::propagate::{self, Freedom};

/// The ways of `[noise]`, of which a file takes one.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Way<'t> {
    /// A standard uncertainty with its degrees of freedom.
    Stated(&'t Stated<Amount>, f64),
    /// Rows that agree in these columns differ by noise only.
    Replicates(&'t [Stated<String>]),
    /// A recording at rest.
    AtRest(&'t Stated<super::tables::StaticTable>),
    /// A budget.
    Budget(&'t Stated<String>),
    /// What a word says.
    From(NoiseWord),
}

impl<'s> Checker<'s> {
    /// The way in which the noise is stated, and its place; `None` where nothing is, or after a fault.
    /// `per_row`: a column holds it.
    pub fn noise_way(&mut self, per_row: bool) -> Option<(Way<'s>, Range<usize>)> {
        let stated = self.source.table.noise.as_ref()?;
        let table = &stated.value;
        let dof = table.dof.as_ref().map_or(f64::INFINITY, |dof| dof.value.0);
        let ways = [
            ("`u`", table.u.as_ref().map(|u| Way::Stated(u, dof))),
            (
                "`replicates`",
                table
                    .replicates
                    .as_ref()
                    .map(|r| Way::Replicates(&r.value.0)),
            ),
            ("`at_rest`", table.at_rest.as_deref().map(Way::AtRest)),
            ("`budget`", table.budget.as_deref().map(Way::Budget)),
            (
                "`from`",
                table.from.as_ref().map(|from| Way::From(from.value)),
            ),
        ];
        // A column of the role "u" is what `from = "stated"` means.
        let is_column = |way: &Way<'_>| per_row && matches!(way, Way::From(NoiseWord::Stated));
        let there = ways.into_iter().filter_map(|(key, way)| Some((key, way?)));
        let mut there: Vec<(&str, Way<'s>)> = there.filter(|(_, way)| !is_column(way)).collect();
        let before = self.faults.len();
        let column = per_row.then_some("`role = \"u\"`");
        let said: Vec<&str> = there.iter().map(|(key, _)| *key).chain(column).collect();
        self.only_with_u(table);
        let is_told = said.is_empty() && self.faults.len() > before;
        if said.len() != 1 && !table.refused && !is_told {
            self.faults.push(not_one_way(stated.span.clone(), &said));
        }
        if dof <= 0.0 {
            let message = say!("degrees of freedom are positive");
            self.faults
                .push(Fault::new(NOISE, stated.span.clone(), message));
        }
        let (_, way) = there.pop()?;
        (self.faults.len() == before && said.len() == 1).then(|| (way, stated.span.clone()))
    }

    /// The noise that a budget claims for outputs of these names and units of differences, with its degrees of
    /// freedom.
    pub fn noise_of_budget(
        &mut self,
        path: &Stated<String>,
        outputs: &[(String, Unit)],
    ) -> Option<(Vec<f64>, f64)> {
        let loaded = budget::load_from(self.files, &self.folder.join(&path.value), None);
        match of_budget(&loaded, &path.value, outputs) {
            Ok(found) => Some(found),
            Err(message) => self.refuse(Fault::new(NOISE, path.span.clone(), message)),
        }
    }

    /// The column that holds the standard uncertainty of each row, with its place.
    pub fn column_of_u(&self) -> Option<(&'s str, Range<usize>)> {
        let mut declared = entries(&self.source.table.columns).iter();
        let role = |entry: &ColumnTable| entry.role.as_ref().map(|role| role.value);
        let found = declared.find(|(_, entry)| role(&entry.value.0) == Some(RoleWord::Uncertainty));
        found.map(|(name, entry)| (name.as_str(), entry.key.clone()))
    }

    /// What the numbers of that column are multiplied by for each of these outputs: they are in the unit of the column, or in that
    /// of the output where it has none.
    pub fn factors_of_u(&mut self, own: &Unit, outputs: &[(String, Unit)]) -> Option<Vec<f64>> {
        let stated = own.difference();
        let factor = |(_, unit): &(String, Unit)| match own.is_one() {
            true => Some(1.0),
            false => stated.conversion_to(unit).map(|to| to.factor),
        };
        let found: Vec<Option<f64>> = outputs.iter().map(factor).collect();
        let wrong = found.iter().position(Option::is_none);
        if let (Some(at), Some((column, place))) = (wrong, self.column_of_u()) {
            let (output, unit) = &outputs[at];
            let message = say!("{} cannot be converted to {}", stated.symbol, unit.symbol);
            return self.refuse(
                Fault::new(NOISE, place, message)
                    .label(say!("the standard uncertainty of {output}"))
                    .help(say!(
                        "write its unit into the heading of the column, or {column} = {{ role = \"u\", unit = \"{}\" }}",
                        unit.symbol
                    )),
            );
        }
        found.into_iter().collect()
    }

    fn only_with_u(&mut self, table: &NoiseTable) {
        let with_u = [
            (
                "walk",
                &table.walk,
                say!("state `u` beside it; without `u` noise that wanders is looked for by itself"),
            ),
            (
                "resolution",
                &table.resolution,
                say!(
                    "state `u` beside it; where the noise is estimated, the step of a display stands with its column: [columns] NAME = {{ resolution = … }}"
                ),
            ),
        ];
        for (key, stated, help) in with_u {
            if let (Some(stated), None) = (stated, &table.u) {
                let fault = Fault::new(NOISE, stated.span.clone(), say!("`{key}` goes with `u`"));
                self.faults
                    .push(fault.label(say!("`u` is missing")).help(help));
            }
        }
    }

    /// One stated u for outputs in these units. Without a unit of its own it is in theirs, which must be one.
    pub fn noise_in(&mut self, u: &Stated<Amount>, units: &[&Unit]) -> Option<Vec<f64>> {
        let first = units.first();
        let differs = |unit: &&&Unit| first.is_some_and(|first| first.symbol != unit.symbol);
        if u.value.unit.is_none()
            && let (Some(first), Some(other)) = (first, units.iter().find(differs))
        {
            let message = say!(
                "the noise has no unit, and the outputs are in {} and in {}",
                first.symbol,
                other.symbol
            );
            return self.refuse(Fault::new(NOISE, u.span.clone(), message)
                .label(say!("in which unit?"))
                .help(say!("state it with its unit, or for each output below [reading.NAME] with from = \"stated\"")));
        }
        if let Some(share) = self.share_of_readings(u, units) {
            return self.refuse(share);
        }
        units.iter().map(|unit| self.spread(u, unit)).collect()
    }

    /// What is wrong with a noise of 0.05 % where the outputs have units: it is not the same in all rows.
    fn share_of_readings(&mut self, u: &Stated<Amount>, units: &[&Unit]) -> Option<Fault> {
        let (text, place) = u.value.unit.as_ref()?;
        let own = self.unit(&Stated {
            value: text.clone(),
            span: place.clone(),
            key: place.clone(),
        })?;
        let is_a_number = |unit: &Unit| unit.conversion_to(&Unit::one()).is_some();
        let output = units.iter().find(|unit| !is_a_number(unit))?;
        is_a_number(&own).then(|| {
            let message = say!("a noise in {text} is a share of each reading, and `u` is that of all rows");
            Fault::new(UNIT, place.clone(), message)
                .label(say!("expected {} or a unit like it", output.symbol))
                .help(say!(
                    "compute it for each row into a column with the role \"u\"; or leave it out: noise that grows with the reading is seen in the residuals"
                ))
        })
    }
}

/// The standard uncertainty that a budget claims for each output, in its unit, with the fewest degrees of freedom:
/// that of the measurand of its name, or of the only one.
fn of_budget(
    loaded: &Result<Loaded, Rejection>,
    path: &str,
    outputs: &[(String, Unit)],
) -> Result<(Vec<f64>, f64), Said> {
    let loaded = loaded.as_ref().map_err(|rejection| {
        let first = rejection.said();
        say!("the budget {path} is refused: {first}")
    })?;
    let row = loaded.rows.first().ok_or(say!("the budget is empty"))?;
    let options = propagate::Options {
        monte_carlo: propagate::MonteCarloChoice::Off,
        ..propagate::Options::default()
    };
    let evaluation =
        propagate::evaluate(&row.budget, &options).map_err(|_| say!("the budget has no result"))?;
    let claimed = row.budget.model.outputs();
    let mut u = Vec::new();
    let mut least = f64::INFINITY;
    for (name, unit) in outputs {
        let named = claimed.iter().position(|output| output.name == *name);
        let only = (claimed.len() == 1).then_some(0);
        let at = named.or(only);
        let at = at.ok_or_else(|| say!("the budget has no measurand {name}"))?;
        let own = claimed[at].unit.difference();
        let conversion = own.conversion_to(unit).ok_or_else(|| {
            let (own, unit) = (&own.symbol, &unit.symbol);
            say!("{name} is in {own} in the budget and in {unit} here")
        })?;
        let gum = &evaluation.results[at].gum;
        u.push(conversion.apply(gum.u));
        least = least.min(match gum.freedom {
            Freedom::WelchSatterthwaite(dof) | Freedom::Ensembles(dof) => dof,
            Freedom::Refused { lower_bound, .. } => lower_bound,
            Freedom::Infinite => f64::INFINITY,
        });
    }
    Ok((u, least))
}

/// Noise that is claimed twice, or not at all.
fn not_one_way(span: Range<usize>, present: &[&str]) -> Fault {
    let fault = Fault::new(NOISE, span, say!("the noise is to be stated in one way"));
    if present.is_empty() {
        return fault.label(say!(
            "expected one of `u`, `replicates`, `at_rest`, `budget`, `from`, or a column \"u\""
        ));
    }
    fault
        .label(say!("stated by {}", present.join(", ")))
        .help(say!("keep one of them"))
}
