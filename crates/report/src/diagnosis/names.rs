//! Names of effects, in a language.

use crate::language::Language;
use crate::number::percent;
use gumption_core::letters::is_chinese;
use gumption_fault::say;
use gumption_lab::diagnose::case::Case;
use gumption_lab::diagnose::catalogue::{Cell, Node, Variation, Words};
use gumption_lab::diagnose::evidence::{Alternative, Slot};
use gumption_lab::diagnose::{Diagnosis, Outlook};

use super::labels::{formula_in, spoken};

/// Names of the candidates of a diagnosis or a plan.
#[derive(Clone, Copy)]
pub(super) struct Names<'a> {
    cells: &'a [Cell],
    /// Language of the names.
    pub(super) l: Language,
}

impl<'a> Names<'a> {
    /// Of a diagnosis.
    pub(super) fn of_diagnosis(diagnosis: &'a Diagnosis, l: Language) -> Names<'a> {
        Names {
            cells: &diagnosis.cells,
            l,
        }
    }

    /// Of a plan.
    pub(super) fn of_outlook(outlook: &'a Outlook, l: Language) -> Names<'a> {
        Names {
            cells: &outlook.cells,
            l,
        }
    }

    /// The candidate itself.
    pub(super) fn cell(self, cell: usize) -> &'a Cell {
        &self.cells[cell]
    }

    /// The same in English.
    pub(super) fn in_english(self) -> Names<'a> {
        Names {
            l: Language::English,
            ..self
        }
    }

    /// What distinguishes a variant, as the catalogue writes it.
    pub(super) fn label(self, (cell, variation): (usize, usize)) -> &'a str {
        &self.cell(cell).variants[variation].label
    }

    /// The name of a candidate with its columns in it.
    pub(super) fn plain(self, cell: usize) -> String {
        let cell = self.cell(cell);
        self.filled(cell, cell.effect.name.of(self.l))
    }

    /// The name, and what distinguishes a candidate of which all variants have one label, or begin with one: the harmonic of an
    /// angle, a stretch of rows.
    pub(super) fn full(self, cell: usize) -> String {
        let variants = self.cell(cell).variants.as_slice();
        let head = |one: &Variation| one.label.split(", ").next().unwrap_or_default().to_owned();
        match variants {
            [_] => self.variant((cell, 0)),
            [first, others @ ..] if others.iter().all(|one| head(one) == head(first)) => {
                self.with_label(cell, &head(first))
            }
            _ => self.plain(cell),
        }
    }

    /// The name, and what distinguishes the variant.
    pub(super) fn variant(self, (cell, variation): (usize, usize)) -> String {
        self.with_label(cell, &self.cell(cell).variants[variation].short_label())
    }

    fn with_label(self, cell: usize, label: &str) -> String {
        let (name, label) = (self.plain(cell), spoken(label, self.l));
        match label.is_empty() {
            true => name,
            false => self.l.with_aside(&name, &label),
        }
    }

    /// What an effect is, in the user's own words where there are any.
    pub(super) fn prose(self, cell: usize) -> String {
        let cell = self.cell(cell);
        let own = cell.description.clone();
        own.unwrap_or_else(|| self.filled(cell, cell.effect.prose.of(self.l)))
    }

    /// A text of the catalogue with the words of a candidate in it: blanks stand about names of columns, and not about Chinese words.
    fn filled(self, cell: &Cell, text: &str) -> String {
        let filled = self.words(cell).fill(text);
        match self.l {
            Language::English => filled,
            Language::Chinese => closed_up(&filled),
        }
    }

    /// What the texts of a candidate speak of: offset, scale and signal have words, columns and parameters keep their
    /// names.
    fn words(self, cell: &Cell) -> Words {
        let mut words = cell.words.clone();
        words.p = quantity(&words.p, self.l);
        if words.x == "row" {
            words.x = self.l.pick("row", "行号").to_owned();
        }
        if let Some(of) = words.x.strip_prefix("signal(") {
            words.x = say!("signal({of}").in_language(self.l);
        }
        words
    }

    /// What a slot may be: what does it alone, most probable first, and then in one text what does it together.
    pub(super) fn slot(self, diagnosis: &Diagnosis, slot: &Slot) -> Vec<String> {
        self.several(diagnosis, &slot.named.iter().collect::<Vec<_>>())
    }

    /// The same of some of its names.
    pub(super) fn several(self, diagnosis: &Diagnosis, names: &[&Alternative]) -> Vec<String> {
        let told = |one: &&Alternative| self.told(diagnosis, one) + &self.open(diagnosis, one);
        let (together, alone): (Vec<_>, Vec<_>) = names.iter().partition(|one| one.jointly);
        let together: Vec<String> = together.iter().map(told).collect();
        let list = alone.iter().map(told).chain(self.together(&together));
        list.collect()
    }

    /// Names of which several do together what another one does alone, in a sentence.
    fn together(self, names: &[String]) -> Option<String> {
        /// Names in a sentence: what is further down is told below it.
        const MOST: usize = 4;
        let others = names.len();
        let list = names.join(self.l.list_comma());
        let text = match others {
            0 => return None,
            1 => say!("{list} together with another of them"),
            2..=MOST => say!("several of these together: {list}"),
            _ => say!("several of {others} others together, listed below"),
        };
        Some(text.in_language(self.l))
    }

    /// The name of an alternative in a sentence; of bad rows, jumps and the like with their place, of what acts under some labels
    /// with these.
    pub(super) fn told(self, diagnosis: &Diagnosis, one: &Alternative) -> String {
        let Some(best) = one.variants.first() else {
            return self.full(one.candidate);
        };
        let (cell, variation) = diagnosis.atoms[best.atom];
        if self.cell(cell).effect.has_place() {
            return self.variant((cell, variation));
        }
        let name = self.full(one.candidate);
        match &self.cell(cell).variants[variation].of_labels {
            Some(labels) => self.l.with_aside(&name, &spoken(labels, self.l)),
            None => name,
        }
    }

    /// What a name leaves open: its order, and whether it acts on the output or on the scale.
    pub(super) fn open(self, diagnosis: &Diagnosis, one: &Alternative) -> String {
        let same = match diagnosis.same_on_scale(one) {
            Some(_) => say!(" (or of the scale: the readings hardly vary)").in_language(self.l),
            None => String::new(),
        };
        self.orders(diagnosis, one) + &same
    }

    /// That the order of a cause is open, where it is: what else than the name may hold.
    fn orders(self, diagnosis: &Diagnosis, one: &Alternative) -> String {
        let others = diagnosis.other_orders(one).into_iter();
        let others =
            others.map(|(cell, share)| format!("{} {} %", self.plain(cell), percent(share)));
        let others: Vec<String> = others.collect();
        if others.is_empty() {
            return String::new();
        }
        let others = others.join(self.l.comma());
        say!(" (its order is open: {others})").in_language(self.l)
    }

    /// The formula of an explanation, without the lag where its best variant has none.
    pub(super) fn formula(self, case: &Case, diagnosis: &Diagnosis, one: &Alternative) -> String {
        let cell = self.cell(one.candidate);
        let fill = |text: &str| self.words(cell).fill(&formula_in(text, self.l));
        let declared = &cell.effect.formula;
        let first = diagnosis.terms(one).first().map(|term| term.node);
        let general = &match first {
            Some(Node::Parameter(slope)) if cell.place.node == "scale" => {
                by_slope(declared, &case.parameters[slope].name)
            }
            Some(Node::Output) if cell.place.node == cell.words.x => on_output(declared),
            _ => declared.clone(),
        };
        let without_lag = || {
            let (before, rest) = general.split_once("lag(")?;
            let (within, after) = rest.split_once(", τ)")?;
            Some(fill(&format!("{before}({within}){after}")))
        };
        match diagnosis.lags(one) {
            true => fill(general),
            false => without_lag().unwrap_or_else(|| fill(general)),
        }
    }
}

/// A formula of a column, where its effect is on the output.
fn on_output(formula: &str) -> String {
    let part = formula.strip_prefix("{x} → {x} + ");
    part.map_or_else(
        || formula.to_owned(),
        |part| format!("{{y}} = model + {part}"),
    )
}

/// A formula of the scale, where its effect is on the slope by a parameter.
fn by_slope(formula: &str, parameter: &str) -> String {
    let slope = format!("∂model/∂{parameter}");
    let relative = formula.strip_suffix(')');
    let relative = relative.and_then(|formula| formula.split_once("model·(1 + "));
    match relative {
        Some((before, change)) => format!("{before}model + {change}·{slope}"),
        None => formula.replace("signal", &slope),
    }
}

/// A text without single blanks between Chinese characters.
fn closed_up(text: &str) -> String {
    let is_chinese = |c: Option<&char>| c.is_some_and(|c| is_chinese(*c));
    let letters: Vec<char> = text.chars().collect();
    let stays = |at: &usize| {
        let before = at.checked_sub(1).and_then(|before| letters.get(before));
        letters[*at] != ' ' || !(is_chinese(before) && is_chinese(letters.get(at + 1)))
    };
    let kept = (0..letters.len()).filter(stays);
    kept.map(|at| letters[at]).collect()
}

/// A quantity of the model: offset and scale, of one output or of all, have words, others their names.
pub(super) fn quantity(node: &str, l: Language) -> String {
    if let Some((part, output)) = node.split_once(" of ") {
        let part = quantity(part, l);
        return say!("{part} of {output}").in_language(l);
    }
    match node {
        "offset" => l.pick("offset", "零位"),
        "scale" => l.pick("scale", "标度"),
        other => other,
    }
    .to_owned()
}

/// What was fitted: a parameter by its name, or the error that all values of a column share.
pub(super) fn unknown(name: &str, l: Language) -> String {
    match name.strip_prefix("common error of ") {
        Some(column) => l.pick(name.to_owned(), format!("{column} 的共同误差")),
        None => name.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_effect_on_a_slope_is_no_part_of_a_signal() {
        let relative = by_slope("{y} = model·(1 + β·lag({x} − mean, τ))", "k");
        assert_eq!(relative, "{y} = model + β·lag({x} − mean, τ)·∂model/∂k");
        let drift = by_slope("{y} = model + β·signal·t", "k");
        assert_eq!(drift, "{y} = model + β·∂model/∂k·t");
        let creep = on_output("{x} → {x} + β·(lag({x}, τ) − {x})");
        assert_eq!(creep, "{y} = model + β·(lag({x}, τ) − {x})");
    }

    #[test]
    fn blanks_stand_about_names_of_columns_alone() {
        assert_eq!(closed_up("零位 上随 x 平滑变化"), "零位上随 x 平滑变化");
        assert_eq!(closed_up("沿 行号 的波动"), "沿行号的波动");
    }
}
