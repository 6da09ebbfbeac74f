//! The catalogue of omitted physics: names and prose as data, regressors by a grammar.
//!
//! An effect is a *node* of the model (the output, its gain, a parameter, a column) times a *modifier*
//! (a covariate, a power, a lag, a law of time, levels of a factor …). The regressor of an effect is the
//! slope of the model by the node times the modifier, row by row, averaged over the blocks.
//!
//! | chapter | holds |
//! |---|---|
//! | `effects.toml` | all effects: names, prose, formulas, properties, and the files with their forms |
//! | `effect` | an entry of it, with its identifier |
//! | `modifiers` | what a disturbance may follow, computed row by row |
//! | `building` | what the forms are built of: cells, words, grids of time constants |
//! | `absorbed` | what the parameters take away from a regressor |
//! | `sharp` | grids of time constants and knees, with the best value exactly |
//! | `fitted` | the fitted model: slopes of the nodes, and which columns can be what |
//! | `order` | whether the order of the rows says something |
//! | `response`, `powers`, `limits`, `history`, `ringing`, `slewing` | what a stimulus does otherwise than declared |
//! | `course`, `earlier` | how columns move between the rows, and what lags behind; what they were a time before |
//! | `delays` | an output that follows what a column was or will be |
//! | `inputs` | the same for what an axis takes in, where the model forms it from several columns |
//! | `axes` | the same where the model holds a constant against several columns, and between outputs |
//! | `norm` | models that are the length of a vector of readings |
//! | `zero`, `parameters` | errors of what the model takes as exact, changes of a parameter |
//! | `conditions`, `time`, `levels`, `rows` | conditions, laws of time, factors, single rows |
//! | `excursions` | what deviates about one value of a column |
//! | `exponentials` | what grows or dies away along a column |
//! | `deviations` | the same where the model is of errors, and no scale bounds its changes |
//! | `heating`, `waves` | power of the signal, what repeats |
//! | `readout`, `bits` | rounding and slips, readings that stand still, weights of the bits of a converter |
//! | `angles`, `fields` | errors of angles; what stays in the laboratory while the sensor turns |
//! | `finer` | what is tried beside the grids once something was found: values between theirs |
//! | `sets` | several terms of one kind, where one alone explains nothing |
//! | `by_label` | and sizes that differ from one label to another |
//! | `generics` | competitors without a name |
//! | `user` | explanations of the user's own |

mod absorbed;
mod angles;
mod axes;
mod bits;
mod building;
mod by_label;
mod conditions;
pub(super) mod course;
mod delays;
pub(super) mod deviations;
mod earlier;
mod effect;
mod excursions;
mod exponentials;
mod fields;
mod finer;
mod fitted;
pub(super) mod generics;
mod heating;
mod history;
mod inputs;
mod levels;
mod limits;
pub(super) mod modifiers;
pub(super) mod norm;
mod order;
mod parameters;
mod powers;
pub(super) mod readout;
mod response;
mod ringing;
mod rows;
mod sets;
mod sharp;
mod slewing;
mod time;
mod user;
mod waves;
mod zero;

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

pub use by_label::{closer_by_label, may_split, under_one_label};
pub use effect::{Effect, EffectId, Kind, Pattern, Text, Usual, effects};
pub use finer::{Finer, Forms};
pub use fitted::{FittedModel, Node, applied, signal, stimuli_of};

use super::case::Case;
use super::evidence;
use super::parallel::side_by_side;
use gumption_core::quantity::{Unit, to_digits};

/// What the placeholders of an effect's texts stand for.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Words {
    /// The column or quantity that the disturbance follows.
    pub x: String,
    /// A second one.
    pub z: String,
    /// The output.
    pub y: String,
    /// The quantity that is disturbed.
    pub p: String,
}

impl Words {
    /// A text with the placeholders replaced.
    pub fn fill(&self, text: &str) -> String {
        text.replace("{x}", &self.x)
            .replace("{z}", &self.z)
            .replace("{y}", &self.y)
            .replace("{p}", &self.p)
    }
}

/// A candidate: an effect of the catalogue on quantities of this case, in all of its variants.
#[derive(Debug, Clone)]
pub struct Cell {
    /// The effect.
    pub effect: &'static Effect,
    /// What its texts speak of.
    pub words: Words,
    /// Where it acts: node and what it follows.
    pub place: evidence::Place,
    /// Values of its shape parameters, axes, times.
    pub variants: Vec<Variation>,
    /// A size that would not surprise, in the units of the columns.
    pub typical: Option<f64>,
    /// A sentence of the user's own.
    pub description: Option<String>,
    /// Odds beforehand, over those of a usual effect.
    pub odds: f64,
}

impl Cell {
    /// Whether it is the same effect on the same quantities, in another design; each harmonic of an angle is a cell of its own.
    pub fn is(&self, other: &Cell) -> bool {
        self.effect.id == other.effect.id && self.words == other.words
    }

    /// Whether it makes all rows scatter, without a course.
    pub fn is_scatter(&self) -> bool {
        let mut spectra = self.variants.iter().map(|one| one.spectrum.as_ref());
        spectra.any(|spectrum| spectrum.is_some_and(Vec::is_empty))
    }

    /// An effect of the catalogue, without a size or a sentence of the user's own.
    fn new(id: EffectId, words: Words, place: evidence::Place, variants: Vec<Variation>) -> Cell {
        Cell {
            effect: id.entry(),
            words,
            place,
            variants,
            typical: None,
            description: None,
            odds: 1.0,
        }
    }
}

/// One variant of a candidate.
#[derive(Debug, Clone)]
pub struct Variation {
    /// What distinguishes it: `τ = 0.5 h`, `from run 3 on`.
    pub label: String,
    /// Its terms, one for each coefficient.
    pub terms: Vec<Term>,
    /// For competitors without a name: variances of the coefficients relative to one another.
    pub spectrum: Option<Vec<f64>>,
    /// A continuous parameter that the grid of variants steps through.
    pub shape: Option<ShapeParameter>,
    /// How likely it is beforehand, relative to the other variants of its candidate.
    pub weight: f64,
    /// The labels under which alone it acts, or under each of which its size is another, in the words of the label; `None` where it
    /// is the same in all rows.
    pub of_labels: Option<String>,
    /// Whether its terms were chosen one by one, so that each of them says something by itself: the steps of a staircase.
    pub is_set: bool,
}

/// A parameter of a variant that may take any value.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapeParameter {
    /// `τ`, `t₀` …
    pub symbol: &'static str,
    /// Its value.
    pub value: f64,
    /// Its unit as text.
    pub unit: String,
    /// Where the size of the effect says the same, as that of a delay is the delay: the size that the form is made for.
    pub size: Option<f64>,
    /// Where along its column the form stands, for one that has a place beside its width.
    pub about: Option<f64>,
}

/// What a disturbance follows.
#[derive(Debug, Clone, PartialEq)]
pub struct Modifier {
    /// Row by row; what disturbs several quantities alike is kept once.
    pub values: Arc<[f64]>,
    /// As a formula, in which columns stand for numbers in their own units.
    pub text: String,
    /// Its unit: a size has that of the node divided by this.
    pub unit: Unit,
}

impl Modifier {
    /// In a unit.
    pub fn new(values: Vec<f64>, text: impl Into<String>, unit: Unit) -> Modifier {
        Modifier {
            values: values.into(),
            text: text.into(),
            unit,
        }
    }

    /// A number.
    pub fn number(values: Vec<f64>, text: impl Into<String>) -> Modifier {
        Modifier::new(values, text, Unit::one())
    }

    /// For a search that shows no formula.
    pub fn unnamed(values: Vec<f64>) -> Modifier {
        Modifier::number(values, "")
    }

    /// With the other sign; its text binds like a name.
    fn negated(&self) -> Modifier {
        let values = modifiers::map(&self.values, |x| -x);
        Modifier::new(values, format!("-{}", self.text), self.unit.clone())
    }

    fn times(&self, other: &Modifier) -> Modifier {
        Modifier::new(
            modifiers::map2(&self.values, &other.values, |x, z| x * z),
            format!("{}*{}", self.text, other.text),
            self.unit.product(&other.unit),
        )
    }

    fn square(&self) -> Modifier {
        self.power(2)
    }

    fn cube(&self) -> Modifier {
        self.power(3)
    }

    /// A whole power, from the first on.
    fn power(&self, exponent: i32) -> Modifier {
        let unit = (1..exponent).fold(self.unit.clone(), |unit, _| unit.product(&self.unit));
        Modifier::new(
            modifiers::map(&self.values, |x| x.powi(exponent)),
            format!("{}^{exponent}", self.text),
            unit,
        )
    }
}

/// A disturbance of one node.
#[derive(Debug, Clone)]
pub struct Term {
    /// The quantity that is disturbed.
    pub node: Node,
    /// The only response on which it acts; `None` for all.
    pub response: Option<usize>,
    /// What it follows, as the search takes it.
    pub modifier: Modifier,
    /// The same effect as it stands in the improved model, where the search takes another form, which
    /// differs from it by what the parameters absorb.
    written: Option<Modifier>,
    /// The disturbance in the improved model, with `{}` for its size, where it is not in proportion to that.
    exact: Option<String>,
    /// Whether it has the coefficient of the term before it: one disturbance, which reaches the responses
    /// in different ways.
    pub tied: bool,
}

impl Term {
    /// A disturbance of all responses alike, with a coefficient of its own.
    pub fn new(node: Node, modifier: Modifier) -> Term {
        Term {
            node,
            response: None,
            modifier,
            written: None,
            exact: None,
            tied: false,
        }
    }

    /// With a formula of its size, `{}`, in the improved model: small ones are in proportion to what it follows.
    #[must_use]
    pub fn exactly(mut self, formula: String) -> Term {
        self.exact = Some(formula);
        self
    }

    /// The disturbance by a parameter, where that is not a factor of it.
    pub fn exact(&self, parameter: &str) -> Option<String> {
        let formula = self.exact.as_ref()?;
        Some(formula.replace("{}", parameter))
    }

    /// With another form in the improved model.
    #[must_use]
    pub fn written_as(mut self, modifier: Modifier) -> Term {
        self.written = Some(modifier);
        self
    }

    /// What it follows, as it stands in the improved model.
    pub fn written(&self) -> &Modifier {
        self.written.as_ref().unwrap_or(&self.modifier)
    }

    /// The unit of its size: that of the node, for each unit of what it follows.
    pub fn unit_of_size(&self, case: &Case) -> Unit {
        let node = match self.node {
            Node::Output => case.responses[self.response.unwrap_or(0)].unit.clone(),
            Node::Gain | Node::Reading => Unit::one(),
            Node::Parameter(parameter) => case.parameters[parameter].unit.clone(),
            Node::Column(column) => case.columns[column].unit.clone(),
        };
        node.quotient(&self.written().unit)
    }

    /// On one response only.
    #[must_use]
    pub fn on(mut self, response: usize) -> Term {
        self.response = Some(response);
        self
    }
}

/// Gives all terms the coefficient of the first.
fn tied(mut terms: Vec<Term>) -> Vec<Term> {
    for term in terms.iter_mut().skip(1) {
        term.tied = true;
    }
    terms
}

impl Variation {
    /// A variant with one coefficient.
    pub fn one(label: impl Into<String>, term: Term) -> Variation {
        Variation::of(label, vec![term])
    }

    /// A variant with several coefficients.
    pub fn of(label: impl Into<String>, terms: Vec<Term>) -> Variation {
        let label: String = label.into();
        Variation {
            // A figure without unit has nothing behind it.
            label: label.trim_end().to_owned(),
            terms,
            spectrum: None,
            shape: None,
            weight: 1.0,
            of_labels: None,
            is_set: false,
        }
    }

    /// With the value of a shape parameter.
    #[must_use]
    pub fn shaped(mut self, symbol: &'static str, value: f64, unit: &str) -> Variation {
        self.shape = Some(ShapeParameter {
            symbol,
            value,
            unit: unit.to_owned(),
            size: None,
            about: None,
        });
        self
    }

    /// For a shape at a place of its column.
    #[must_use]
    pub fn about(mut self, place: f64) -> Variation {
        if let Some(shape) = &mut self.shape {
            shape.about = Some(place);
        }
        self
    }

    /// For a size that says the same as its shape.
    #[must_use]
    pub fn sized(mut self, size: f64) -> Variation {
        if let Some(shape) = &mut self.shape {
            shape.size = Some(size);
        }
        self
    }

    /// The label for a reader: a time constant is the best of some that were tried, and has three digits. A
    /// knee may need more, where the range is far from zero, and so may a period, where there are many.
    pub fn short_label(&self) -> String {
        let many = |shape: &&ShapeParameter| matches!(shape.symbol, "x₀" | "P");
        let Some(shape) = self.shape.as_ref().filter(|shape| !many(shape)) else {
            return self.label.clone();
        };
        let exact = modifiers::figure(shape.value);
        let short = modifiers::figure(to_digits(shape.value, 3));
        let words = self.label.split(' ');
        let words = words.map(|word| if word == exact { &short } else { word });
        words.collect::<Vec<&str>>().join(" ")
    }

    /// Its terms, each with the number of its coefficient.
    pub fn numbered(&self) -> impl Iterator<Item = (usize, &Term)> {
        self.terms.iter().scan(0, |count, term| {
            *count += usize::from(!term.tied || *count == 0);
            Some((*count - 1, term))
        })
    }

    /// Number of coefficients.
    pub fn coefficients(&self) -> usize {
        self.terms.iter().filter(|term| !term.tied).count()
    }

    /// Observations × coefficients: derivatives of the outputs by the coefficients.
    pub fn columns(&self, fitted: &FittedModel<'_>) -> DMatrix<f64> {
        let mut columns: Vec<DVector<f64>> = Vec::new();
        for term in &self.terms {
            let column = fitted.column(term);
            match columns.last_mut() {
                Some(last) if term.tied => *last += column,
                _ => columns.push(column),
            }
        }
        if columns.is_empty() {
            return DMatrix::zeros(fitted.design.observations(), 0);
        }
        DMatrix::from_columns(&columns)
    }
}

/// What makes the candidates of one kind each.
const CHAPTERS: [fn(&FittedModel<'_>) -> Vec<Cell>; 17] = [
    response::cells,
    inputs::cells,
    |fitted| Vec::from_iter(axes::crossed(fitted)),
    fields::cells,
    conditions::cells,
    zero::cells,
    time::cells,
    waves::cells,
    levels::cells,
    parameters::cells,
    angles::cells,
    rows::cells,
    readout::cells,
    bits::cells,
    conditions::stems,
    heating::cells,
    user::cells,
];

/// All candidates of the catalogue that this case can have, without those that the user excludes.
pub fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let chapters = side_by_side(CHAPTERS.len(), |at| CHAPTERS[at](fitted));
    let mut cells: Vec<Cell> = chapters.into_iter().flatten().collect();
    if let Some(norm) = norm::Norm::of(fitted) {
        norm.spread(fitted, &mut cells);
    }
    let settings = &fitted.design.case.settings;
    cells.retain(|cell| !cell.variants.is_empty() && settings.admits(cell.effect));
    let mut cells = distinct(cells);
    fitted.finer.prune(&mut cells);
    by_label::split(fitted, &mut cells);
    cells.extend(generics::cells(fitted));
    cells.extend(inputs::unnamed(fitted));
    cells
}

/// Without cells that do the same to every row as one before them: the nonlinearity "in head" and "in mount"
/// of a model of head + mount.
fn distinct(cells: Vec<Cell>) -> Vec<Cell> {
    let terms = |cell: &Cell| -> Vec<(Node, Option<usize>, Arc<[f64]>)> {
        let all = cell.variants.iter().flat_map(|variation| &variation.terms);
        all.map(|term| (term.node, term.response, term.modifier.values.clone()))
            .collect()
    };
    let mut kept: Vec<Cell> = Vec::new();
    for cell in cells {
        let mut alike = kept
            .iter()
            .filter(|other| other.effect.id == cell.effect.id);
        if !alike.any(|other| terms(other) == terms(&cell)) {
            kept.push(cell);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_tried_is_said_with_three_digits() {
        let of = |label: &str| Variation::of(label, Vec::new()).shaped("τ", 2641.4, "s");
        assert_eq!(of("τ = 2641.4 s").short_label(), "τ = 2640 s");
        assert_eq!(of("ay, τ = 2641.4 s").short_label(), "ay, τ = 2640 s");
        let plain = Variation::of("row 26414", Vec::new());
        assert_eq!(plain.short_label(), "row 26414");
    }
}
