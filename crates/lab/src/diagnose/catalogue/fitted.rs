//! Slopes of the nodes at the fitted model, and which columns can be what.

use std::sync::OnceLock;

use nalgebra::DVector;

use super::absorbed::Absorbed;
use super::modifiers::{
    amount, centred, correlation, crosses_zero, figure, in_unit, largest, map, map2, middle, range,
    rate,
};
use super::{Finer, Modifier, Term};
use crate::diagnose::case::{Case, Observed, Role};
use crate::diagnose::design::{Clock, Design};
use crate::diagnose::fit::Fit;
use gumption_core::quantity::{Unit, UnitTable};

/// A quantity of the model that can be disturbed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Node {
    /// The output itself: an offset.
    Output,
    /// Everything that the model gives besides constant terms.
    Gain,
    /// Everything that the model gives: a factor of what is read.
    Reading,
    /// A parameter.
    Parameter(usize),
    /// A column that the model uses.
    Column(usize),
}

impl Node {
    /// Whether sizes on it are relative changes of what the model gives.
    pub fn is_scale(self) -> bool {
        matches!(self, Node::Gain | Node::Reading)
    }
}

/// The fitted model, on which effects act.
#[derive(Debug)]
pub struct FittedModel<'f> {
    /// The rows.
    pub design: &'f Design<'f>,
    /// The fitted model.
    pub fit: &'f Fit,
    /// When rows were recorded.
    pub clock: Clock,
    /// What is tried beside the grids of time constants and knees.
    pub finer: Finer,
    /// What the model gives besides constant terms, for each response and row.
    signal: Vec<Vec<f64>>,
    absorbed: OnceLock<Absorbed>,
}

impl<'f> FittedModel<'f> {
    /// Forms the signal of each response.
    pub fn new(design: &'f Design<'f>, fit: &'f Fit) -> FittedModel<'f> {
        let responses = 0..design.case.responses.len();
        FittedModel {
            design,
            fit,
            clock: design.time(),
            finer: Finer::default(),
            signal: responses
                .map(|response| signal(design, fit, response))
                .collect(),
            absorbed: OnceLock::new(),
        }
    }

    /// With values between those of the grids.
    #[must_use]
    pub fn refined(self, finer: Finer) -> FittedModel<'f> {
        FittedModel { finer, ..self }
    }

    /// What its parameters take away.
    pub(super) fn absorbed(&self) -> &Absorbed {
        (self.absorbed).get_or_init(|| Absorbed::by_parameters(self.fit))
    }

    /// Whether its parameters leave something of a term.
    pub fn leaves(&self, term: &Term) -> bool {
        self.absorbed().leaves(&self.column(term))
    }

    /// The case.
    pub fn case(&self) -> &'f Case {
        self.design.case
    }

    /// Rows of the recording.
    pub fn rows(&self) -> usize {
        self.design.case.rows
    }

    /// What the model gives besides constant terms.
    pub fn signal(&self, response: usize) -> &[f64] {
        &self.signal[response]
    }

    /// The signal of a response in a row, if a column had another value there.
    pub fn signal_at(&self, response: usize, row: usize, column: usize, value: f64) -> f64 {
        let case = self.case();
        let mut symbols = self.design.symbols(row, &self.fit.unknowns);
        let there = case.equations.value(response, &symbols);
        symbols[case.parameters.len() + column] = value;
        let other = case.equations.value(response, &symbols);
        self.signal[response][row] + other - there
    }

    /// Whether the model is a line along every column that it takes in.
    pub fn is_straight(&self) -> bool {
        let mut columns = self.numeric().into_iter();
        columns.all(|column| !self.in_model(column) || self.is_line(column))
    }

    /// Whether the model is a line along a column in every row.
    pub fn is_line(&self, column: usize) -> bool {
        /// Bend over the values at the ends: rounding.
        const NOTHING: f64 = 1e-9;
        let (least, most) = range(self.numbers(column));
        let places = [least, 0.5 * (least + most), most];
        let is_bent = |(response, row): (usize, usize)| {
            let [first, middle, last] = places.map(|x| self.signal_at(response, row, column, x));
            let size = first.abs().max(last.abs());
            (first + last - 2.0 * middle).abs() > NOTHING * size
        };
        let responses = 0..self.case().responses.len();
        let mut rows =
            responses.flat_map(|response| (0..self.rows()).map(move |row| (response, row)));
        !rows.any(is_bent)
    }

    /// The slope of a response by a node, row by row. Where it has none by a column, such as a root at zero, it is that of the
    /// chord to the nearest other value of the column.
    pub fn slope(&self, node: Node, response: usize) -> Vec<f64> {
        let symbol = match node {
            Node::Output => {
                let parts = self.design.over_constant(&self.fit.linear, response);
                return parts.unwrap_or_else(|| vec![1.0; self.rows()]);
            }
            Node::Gain => return self.signal[response].clone(),
            Node::Reading => return self.fit.linear.values[response].clone(),
            Node::Parameter(parameter) => parameter,
            Node::Column(column) => self.case().parameters.len() + column,
        };
        let slopes = self.fit.linear.slopes[response].column(symbol);
        let mut slopes: Vec<f64> = slopes.iter().copied().collect();
        if let Node::Column(column) = node {
            let missing = slopes.iter_mut().enumerate();
            for (row, slope) in missing.filter(|(_, slope)| !slope.is_finite()) {
                *slope = self.chord(response, row, column);
            }
        }
        slopes
    }

    fn chord(&self, response: usize, row: usize, column: usize) -> f64 {
        let x = self.numbers(column);
        let others = x.iter().filter(|other| **other != x[row]);
        let away = |other: &&f64| (**other - x[row]).abs();
        let nearest = others.min_by(|a, b| away(a).total_cmp(&away(b)));
        nearest.map_or(f64::NAN, |other| {
            let there = self.signal_at(response, row, column, *other);
            (there - self.signal[response][row]) / (other - x[row])
        })
    }

    /// The regressor of a term.
    pub fn column(&self, term: &Term) -> DVector<f64> {
        self.design.observed_column(|response| {
            if term.response.is_some_and(|only| only != response) {
                return vec![0.0; self.rows()];
            }
            let slope = self.slope(term.node, response);
            map2(&slope, &term.modifier.values, |s, m| s * m)
        })
    }

    /// The name of a column.
    pub fn label(&self, column: usize) -> &str {
        &self.case().columns[column].name
    }

    /// Whether a column is what some output takes in, or acts on it as a function of itself: no mere
    /// factor of other columns.
    pub fn is_direct(&self, column: usize) -> bool {
        /// Values this near to one another, as a part of the range, are the same …
        const NEAR: f64 = 1e-3;
        /// … and so are slopes, as a part of the largest.
        const SAME: f64 = 0.05;
        let x = self.numbers(column);
        let mut order: Vec<usize> = (0..x.len()).collect();
        order.sort_by(|a, b| x[*a].total_cmp(&x[*b]));
        let (least, most) = range(x);
        let by_itself = |response: usize| {
            let slope = self.slope(Node::Column(column), response);
            let size = largest(&slope);
            order.windows(2).all(|pair| {
                let (a, b) = (pair[0], pair[1]);
                let near = x[b] - x[a] <= NEAR * (most - least);
                !near || (slope[a] - slope[b]).abs() <= SAME * size
            })
        };
        let responses = 0..self.case().responses.len();
        responses.clone().all(by_itself) || responses.clone().any(|r| self.takes_in(r, column))
    }

    /// Whether the signal of a response is that column, but for an offset, a factor and a trace.
    pub fn takes_in(&self, response: usize, column: usize) -> bool {
        const TRACE: f64 = 0.01;
        let alike = correlation(&self.signal[response], self.numbers(column));
        alike.abs() > 1.0 - TRACE
    }

    /// Its name in reports.
    pub fn name(&self, node: Node) -> String {
        match node {
            Node::Output => "offset".to_owned(),
            Node::Gain => "scale".to_owned(),
            Node::Reading => "reading".to_owned(),
            Node::Parameter(parameter) => self.case().parameters[parameter].name.clone(),
            Node::Column(column) => self.case().columns[column].name.clone(),
        }
    }

    /// The outputs, as one name.
    pub fn output(&self) -> String {
        let names = self.case().responses.iter().map(|r| r.name.as_str());
        names.collect::<Vec<&str>>().join(", ")
    }

    /// Columns, as one name.
    pub fn names(&self, columns: &[usize]) -> String {
        let names = columns.iter().map(|column| self.label(*column));
        names.collect::<Vec<&str>>().join(", ")
    }

    /// Whether an equation uses a column.
    pub fn in_model(&self, column: usize) -> bool {
        self.case().uses(column)
    }

    /// Columns of a role that the model uses.
    pub fn used(&self, role: Role) -> impl Iterator<Item = usize> {
        let case = self.case();
        case.with_role(role).filter(|column| case.uses(*column))
    }

    /// Columns of numbers that a disturbance may follow, in the model or not.
    pub fn numeric(&self) -> Vec<usize> {
        let case = self.case();
        (0..case.columns.len())
            .filter(|c| matches!(case.columns[*c].role, Role::Stimulus | Role::Covariate))
            .filter(|c| case.columns[*c].numbers().is_some_and(varies))
            .collect()
    }

    /// The numbers of a column.
    pub fn numbers(&self, column: usize) -> &'f [f64] {
        self.case().columns[column].numbers().unwrap_or(&[])
    }

    /// Whether a column is a temperature.
    pub fn is_temperature(&self, column: usize) -> bool {
        self.is_like(column, "K")
    }

    /// Whether a column goes well to both sides of a zero that is nothing: 0 °C is a temperature like any
    /// other.
    pub fn passes_zero(&self, column: usize) -> bool {
        let is_point = self.case().columns[column].unit.is_point();
        !is_point && crosses_zero(self.numbers(column))
    }

    /// Whether a column has the dimension of a unit.
    pub fn is_like(&self, column: usize, unit: &str) -> bool {
        let other = UnitTable::default().parse(unit);
        other.is_ok_and(|other| self.case().columns[column].unit.dimension == other.dimension)
    }

    /// Whether a condition acts at once: pressure, voltage, vibration, speed, frequency, field. Heat and
    /// moisture take their time.
    pub fn is_immediate(&self, column: usize) -> bool {
        let units = ["Pa", "V", "m/s^2", "m/s", "rad/s", "T"];
        units.iter().any(|unit| self.is_like(column, unit))
    }

    /// Whether a column is stated in a unit of angle.
    pub fn is_angle(&self, column: usize) -> bool {
        self.case().columns[column].unit.full_turn().is_some()
    }

    /// The unit of time as text; `row` where no time was recorded.
    pub fn time_unit(&self) -> String {
        (self.clock.column).map_or_else(|| "row".to_owned(), |column| self.unit(column))
    }

    /// A time as formulas and labels show it.
    pub fn duration(&self, time: f64) -> String {
        in_unit(&figure(time), &self.time_unit())
    }

    /// A moment as the recording tells it: by the calendar or the clock, else by its number.
    pub fn moment(&self, time: f64) -> String {
        let numbered = || in_unit(&figure(time), &self.time_unit());
        self.by_calendar(time).unwrap_or_else(numbered)
    }

    /// A moment by the calendar or the clock, where the recording has times of these.
    pub fn by_calendar(&self, time: f64) -> Option<String> {
        let column = &self.case().columns[self.clock.column?];
        let second = UnitTable::default().parse("s").ok()?;
        let to_seconds = column.unit.conversion_to(&second)?;
        Some(column.epoch?.moment(to_seconds.apply(time)))
    }

    /// What the time is called: its column, or the row.
    pub fn along_time(&self) -> String {
        (self.clock.column)
            .map_or("row", |column| self.label(column))
            .to_owned()
    }

    /// A column, or the time, by its name and its numbers.
    pub fn course(&self, column: Option<usize>) -> (String, &[f64]) {
        match column {
            Some(column) => (self.label(column).to_owned(), self.numbers(column)),
            None => (self.along_time(), &self.clock.values),
        }
    }

    /// The unit in which a column differs from row to row.
    pub fn step_unit(&self, column: usize) -> Unit {
        self.case().columns[column].unit.difference()
    }

    /// The unit of the time; one where it is the number of the row.
    pub fn clock_unit(&self) -> Unit {
        (self.clock.column).map_or_else(Unit::one, |column| self.step_unit(column))
    }

    /// A number in the unit of a column.
    pub fn figure(&self, column: usize, x: f64) -> String {
        amount(x, &self.unit(column))
    }

    /// A column less a number, as a formula that binds like a name.
    pub fn less(&self, column: usize, x: f64) -> String {
        if x == 0.0 {
            return self.label(column).to_owned();
        }
        format!("({})", self.beyond(column, x))
    }

    /// How far a column is beyond a number, as a formula.
    pub fn beyond(&self, column: usize, x: f64) -> String {
        let sign = if x < 0.0 { '+' } else { '-' };
        let size = self.figure(column, x.abs());
        format!("{} {sign} {size}", self.label(column))
    }

    /// The time less a number, as a formula; rows are counted from one.
    pub fn time_less(&self, x: f64) -> String {
        match self.clock.column {
            Some(column) => self.less(column, x),
            None => format!("(row - {})", x + 1.0),
        }
    }

    /// What follows a column by a law, in its unit.
    pub fn by(&self, column: usize, text: impl Into<String>, law: impl Fn(f64) -> f64) -> Modifier {
        Modifier::new(map(self.numbers(column), law), text, self.step_unit(column))
    }

    /// A column as it is.
    pub fn own(&self, column: usize) -> Modifier {
        self.by(column, self.label(column), |x| x)
    }

    /// A column less its middle.
    pub fn centred(&self, column: usize) -> Modifier {
        let middle = middle(self.numbers(column));
        self.by(column, self.less(column, middle), |x| x - middle)
    }

    /// The time less its middle.
    pub fn centred_time(&self) -> Modifier {
        let t = &self.clock.values;
        Modifier::new(centred(t), self.time_less(middle(t)), self.clock_unit())
    }

    /// The product of two columns less their middles.
    pub fn centred_product(&self, x: usize, z: usize) -> Modifier {
        self.centred(x).times(&self.centred(z))
    }

    /// The difference of two columns of one dimension, in the unit of the first.
    pub fn apart(&self, one: usize, other: usize) -> Modifier {
        let of = |column: usize| &self.case().columns[column].unit;
        let conversion = of(other).conversion_to(of(one));
        let in_unit = |x: f64| conversion.as_ref().map_or(x, |to| to.apply(x));
        let others = self.numbers(other).iter().map(|x| in_unit(*x));
        let values = self.numbers(one).iter().zip(others).map(|(x, y)| x - y);
        let text = format!("({} - {})", self.label(one), self.label(other));
        Modifier::new(values.collect(), text, self.step_unit(one))
    }

    /// The rate of change of a column.
    pub fn rate(&self, column: usize) -> Modifier {
        Modifier::new(
            rate(&self.clock.values, self.numbers(column)),
            format!("d{}/dt", self.label(column)),
            self.step_unit(column).quotient(&self.clock_unit()),
        )
    }

    /// The unit of a column as text; nothing for a number.
    pub fn unit(&self, column: usize) -> String {
        self.case().columns[column].unit.after_number()
    }

    /// Seconds in a unit of the clock, where it is a time.
    pub fn seconds(&self) -> Option<f64> {
        let column = &self.case().columns[self.clock.column?];
        let second = UnitTable::default().parse("s").ok()?;
        let unit = column.unit.difference();
        Some(unit.conversion_to(&second)?.apply(1.0))
    }

    /// Whether the distance in time of the rows is recorded; their order alone says nothing of lags.
    pub fn is_timed(&self) -> bool {
        let role = self.clock.column.map(|at| self.case().columns[at].role);
        role == Some(Role::Time)
    }

    /// Whether what is observed is a constant that the model should give in every row.
    pub fn is_implicit(&self, response: usize) -> bool {
        let observed = self.case().responses[response].observed;
        matches!(observed, Observed::Constant(_))
    }

    /// Parameters that are added to the model as they stand.
    pub fn constant_terms(&self, response: usize) -> Vec<usize> {
        constant_terms(self.design, self.fit, response)
    }

    /// Whether the readings hardly vary, so that what acts on the output and what acts on the scale are one.
    pub fn is_steady(&self) -> bool {
        !self.has_signal()
    }

    /// The offset, and the scale where it is something else.
    pub fn offset_and_scale(&self) -> Vec<Node> {
        let scale = self.has_signal().then_some(Node::Gain);
        [Node::Output].into_iter().chain(scale).collect()
    }

    /// Whether the signal of any response varies so much that its scale is something else than an offset. A constant that the
    /// model should give has inputs that vary.
    pub fn has_signal(&self) -> bool {
        const LEAST: f64 = 0.01;
        let varies = |signal: &[f64]| {
            let (least, most) = range(signal);
            most - least > LEAST * largest(signal)
        };
        let mut responses = 0..self.signal.len();
        responses.any(|at| self.is_implicit(at) || varies(&self.signal[at]))
    }
}

/// Whether numbers are not all the same.
pub fn varies(numbers: &[f64]) -> bool {
    let Some(first) = numbers.first() else {
        return false;
    };
    let size = largest(numbers);
    numbers.iter().any(|x| (x - first).abs() > 1e-9 * size)
}

/// The model less its constant terms: those in which a parameter alone is added.
pub fn signal(design: &Design<'_>, fit: &Fit, response: usize) -> Vec<f64> {
    let mut signal = fit.linear.values[response].clone();
    for parameter in constant_terms(design, fit, response) {
        for (row, value) in signal.iter_mut().enumerate() {
            *value -= fit.unknowns[design.unknown_of(parameter, row)];
        }
    }
    signal
}

/// The model less what it gives where nothing is applied; `None` where it has no value there, or gives nothing else than the model.
pub fn applied(design: &Design<'_>, fit: &Fit, response: usize) -> Option<Vec<f64>> {
    let case = design.case;
    let first = case.parameters.len();
    let stimuli = stimuli_of(case, response);
    let without = |row: usize| {
        let mut symbols = design.symbols(row, &fit.unknowns);
        stimuli
            .iter()
            .for_each(|column| symbols[first + column] = 0.0);
        case.equations.value(response, &symbols)
    };
    let values = &fit.linear.values[response];
    let all: Vec<f64> = (values.iter().enumerate())
        .map(|(row, value)| value - without(row))
        .collect();
    let is_another = all.iter().zip(values).any(|(own, value)| own != value);
    let is_there = is_another && !stimuli.is_empty() && all.iter().all(|own| own.is_finite());
    is_there.then_some(all)
}

/// The stimuli that the equation of a response takes in.
pub fn stimuli_of(case: &Case, response: usize) -> Vec<usize> {
    let (used, first) = (case.equations.uses(response), case.parameters.len());
    let stimuli = case.with_role(Role::Stimulus);
    stimuli.filter(|c| used.contains(&(first + c))).collect()
}

/// Parameters that are added as they stand. Values of specimens, one for each label, are no zero where nothing else varies:
/// they are what is measured, and a scale multiplies them.
fn constant_terms(design: &Design<'_>, fit: &Fit, response: usize) -> Vec<usize> {
    let slopes = &fit.linear.slopes[response];
    let parameters = &design.case.parameters;
    let constant = |parameter: &usize| slopes.column(*parameter).iter().all(|slope| *slope == 1.0);
    let constants: Vec<usize> = (0..parameters.len()).filter(constant).collect();
    let used = design.case.equations.uses(response);
    let is_specimens = |parameter: &usize| parameters[*parameter].per.is_some();
    match used.iter().all(|symbol| constants.contains(symbol)) {
        true => (constants.into_iter())
            .filter(|parameter| !is_specimens(parameter))
            .collect(),
        false => constants,
    }
}
