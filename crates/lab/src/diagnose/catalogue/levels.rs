//! Levels of factors: runs, instruments, operators, mounts, directions.

use super::building::{HIGHER, form, kinds, of_the_whole, on_node, pair};
use super::fitted::{FittedModel, Node};
use super::modifiers::{flag, map, map2};
use super::{Cell, EffectId, Modifier, Variation};
use crate::diagnose::case::{Column, Data, Role};
use crate::recording::Labels;

/// A column of labels, with those that occur in its rows.
pub(super) struct Factor<'f> {
    pub(super) index: usize,
    pub(super) column: &'f Column,
    labels: &'f Labels,
    pub(super) levels: Vec<u32>,
}

/// Columns of labels of which two or more occur, and of so many blocks (a part, of a whole) no more than one each.
pub(super) fn factors<'f>(
    fitted: &FittedModel<'f>,
    (part, whole): (usize, usize),
) -> impl Iterator<Item = Factor<'f>> {
    let most = part * fitted.design.blocks.len() / whole;
    let columns = fitted.case().columns.iter().enumerate();
    columns.filter_map(move |(index, column)| {
        let labels = column.labels()?;
        let levels = present(labels);
        let several = (2..=most).contains(&levels.len());
        several.then_some(Factor {
            index,
            column,
            labels,
            levels,
        })
    })
}

/// Those of them under whose labels the instrument or what it is used for may be another: runs, instruments, operators, axes.
pub(super) fn of_instruments<'f>(
    fitted: &FittedModel<'f>,
    share: (usize, usize),
) -> Vec<Factor<'f>> {
    let factors = factors(fitted, share);
    factors.filter(Factor::is_of_instruments).collect()
}

impl Factor<'_> {
    fn is_of_instruments(&self) -> bool {
        matches!(self.column.role, Role::Run | Role::Factor | Role::Axis)
    }

    pub(super) fn text(&self, level: u32) -> &str {
        (self.labels.levels.get(level as usize)).map_or("", String::as_str)
    }

    /// Whether other rows have no other labels.
    pub(super) fn has_all(&self, rows: &Data) -> bool {
        let is_own = |label: &str| self.levels.iter().any(|level| self.text(*level) == label);
        matches!(rows, Data::Labels(labels) if labels.texts().all(is_own))
    }

    /// 1 in the rows of a level.
    pub(super) fn indicator(&self, level: u32) -> Vec<f64> {
        indicator(self.labels, level)
    }

    /// 1 in the rows of a level, as a formula shows it.
    pub(super) fn modifier(&self, level: u32) -> Modifier {
        let text = format!("[{} = {}]", self.column.name, self.text(level));
        Modifier::number(self.indicator(level), text)
    }

    /// Differences to the last level, which add up to nothing over all of them.
    fn contrasts(&self) -> Vec<Modifier> {
        let Some((last, others)) = self.levels.split_last() else {
            return Vec::new();
        };
        let last = self.modifier(*last);
        let contrast = |level: &u32| {
            let own = self.modifier(*level);
            let values = map2(&own.values, &last.values, |own, last| own - last);
            Modifier::number(values, format!("({} - {})", own.text, last.text))
        };
        others.iter().map(contrast).collect()
    }

    /// Differences to the first level: the mean is the model's own.
    pub(super) fn differences(&self) -> Vec<Modifier> {
        let others = self.levels[1..].iter();
        others.map(|level| self.modifier(*level)).collect()
    }

    /// What levels may have where the mean is the model's own.
    fn shifts(&self) -> Vec<Variation> {
        // With two levels a shift of one is a shift between both.
        let alone = match self.levels.len() {
            2 => Vec::new(),
            _ => self.alone(),
        };
        kinds([vec![form("", self.differences())], alone, self.onwards()])
    }

    /// What levels may have where the model has nothing that they have in common.
    fn values(&self) -> Vec<Variation> {
        let each = self.levels.iter().map(|level| self.modifier(*level));
        let each = form("", each.collect());
        kinds([vec![each], self.alone(), self.onwards()])
    }

    /// One level has a value of its own.
    fn alone(&self) -> Vec<Variation> {
        let levels = self.levels.iter();
        let one = |level: &u32| {
            let label = format!("{} {}", self.column.name, self.text(*level));
            form(label, vec![self.modifier(*level)])
        };
        levels.map(one).collect()
    }

    /// All levels from one on.
    fn onwards(&self) -> Vec<Variation> {
        match self.column.role {
            Role::Run if self.levels.len() > 3 => changes(self),
            _ => Vec::new(),
        }
    }
}

/// Cells of the columns of labels.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let mut cells = Vec::new();
    for factor in factors(fitted, (2, 3)) {
        match factor.column.role {
            Role::Direction => cells.push(directions(fitted, &factor)),
            Role::Position if is_place(fitted) => {
                let all = shifts(fitted, &factor).into_iter();
                cells.extend(all.filter(|c| c.effect.id == EffectId::LevelScale));
            }
            Role::Run | Role::Factor | Role::Axis => cells.extend(shifts(fitted, &factor)),
            _ => {}
        }
    }
    cells.extend(interactions(fitted));
    cells
}

/// Whether positions are places where one and the same stimulus acts, as on the pan of a balance or over an
/// aperture, rather than attitudes of an inertial sensor.
pub(super) fn is_place(fitted: &FittedModel<'_>) -> bool {
    let case = fitted.case();
    let stimuli = case.with_role(Role::Stimulus).count();
    let turned = case.with_role(Role::Angle).next().is_some();
    stimuli == 1 && !turned && fitted.has_signal()
}

/// Levels that occur in the rows that are left.
pub(super) fn present(labels: &Labels) -> Vec<u32> {
    let mut levels = labels.of_row.clone();
    levels.sort_unstable();
    levels.dedup();
    levels
}

/// 1 in the rows of a level.
pub(super) fn indicator(labels: &Labels, level: u32) -> Vec<f64> {
    let rows = labels.of_row.iter();
    rows.map(|of| flag(*of == level)).collect()
}

/// Every level has a value of its own; or only one has; or all from one on, in the order of the recording.
fn shifts(fitted: &FittedModel<'_>, factor: &Factor<'_>) -> Vec<Cell> {
    let name = &factor.column.name;
    let ids = [EffectId::LevelShift, EffectId::LevelScale];
    let nodes = fitted.offset_and_scale().into_iter().zip(ids);
    let cells = nodes.map(|(node, id)| {
        let on_node = |forms: Vec<Variation>| on_node(fitted, id, name, node, forms);
        let ones = Modifier::number(vec![1.0; fitted.rows()], "1");
        let in_common = &on_node(vec![form("", vec![ones])]).variants[0];
        let left = fitted.absorbed().leaves_of(&in_common.columns(fitted));
        let mut cell = on_node(match left.iter().all(|left| *left) {
            true => factor.values(),
            false => factor.shifts(),
        });
        if node == Node::Gain && factor.column.role == Role::Run {
            // A run that is written in another unit.
            let single = cell.variants.iter().filter(|form| form.coefficients() == 1);
            let whole = of_the_whole(fitted, single);
            cell.variants.extend(whole);
        }
        cell
    });
    cells.collect()
}

/// Combinations of each two columns: all pairs together are as likely beforehand as one effect of a higher order, however many columns
/// of labels there are.
fn interactions(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let places = is_place(fitted);
    let is_one = |factor: &Factor<'_>| {
        factor.is_of_instruments() || (places && factor.column.role == Role::Position)
    };
    let several: Vec<Factor<'_>> = factors(fitted, (2, 3)).filter(is_one).collect();
    let pairs = several.iter().enumerate();
    let pairs = pairs.flat_map(|(at, other)| several[..at].iter().map(move |one| [one, other]));
    let found: Vec<Vec<Cell>> = pairs.map(|pair| combinations(fitted, pair)).collect();
    let crossed = found.iter().filter(|cells| !cells.is_empty()).count();
    let odds = HIGHER / crossed.max(1) as f64;
    let cells = found.into_iter().flatten();
    cells.map(|cell| Cell { odds, ..cell }).collect()
}

/// Every combination of two labels has a value of its own beside what each label does by itself (their interaction), or only one has:
/// one instrument in one run, what one operator makes of one part.
fn combinations(fitted: &FittedModel<'_>, factors: [&Factor<'_>; 2]) -> Vec<Cell> {
    let [one, other] = factors;
    let labels = one.labels.of_row.iter().zip(&other.labels.of_row);
    let mut pairs: Vec<(u32, u32)> = labels.map(|(a, b)| (*a, *b)).collect();
    pairs.sort_unstable();
    pairs.dedup();
    // Where each label of one occurs with one of the other only, there is nothing to be combined; one reading is a wrong reading.
    let crossed = pairs.len() > one.levels.len().max(other.levels.len());
    if !crossed || 2 * pairs.len() > fitted.design.blocks.len() {
        return Vec::new();
    }
    let modifier = |(a, b): &(u32, u32)| one.modifier(*a).times(&other.modifier(*b));
    let [own, its] = factors.map(Factor::contrasts);
    let products = own.iter().flat_map(|a| its.iter().map(|b| a.times(b)));
    let all = form("", products.collect());
    let single = pairs.iter().map(|pair| {
        let texts = factors.iter().zip([pair.0, pair.1]);
        let texts =
            texts.map(|(factor, level)| format!("{} {}", factor.column.name, factor.text(level)));
        form(
            texts.collect::<Vec<String>>().join(", "),
            vec![modifier(pair)],
        )
    });
    let forms = kinds([vec![all], single.collect()]);
    let ids = [EffectId::CombinationShift, EffectId::CombinationScale];
    let nodes = fitted.offset_and_scale().into_iter().zip(ids);
    let columns = factors.map(|factor| factor.index);
    let cells = nodes.map(|(node, id)| pair(fitted, id, columns, node, forms.clone()));
    cells.collect()
}

/// From one level on, with more than one level on both sides.
fn changes(factor: &Factor<'_>) -> Vec<Variation> {
    let name = &factor.column.name;
    let firsts = &factor.levels[2..factor.levels.len() - 1];
    let since = |first: &u32| {
        let rows = factor.labels.of_row.iter();
        let modifier = rows.map(|of| flag(of >= first)).collect();
        let label = factor.text(*first);
        let since = Modifier::number(modifier, format!("[{name} >= {label}]"));
        form(format!("from {name} {label} on"), vec![since])
    };
    firsts.iter().map(since).collect()
}

fn directions(fitted: &FittedModel<'_>, factor: &Factor<'_>) -> Cell {
    let (name, last) = (&factor.column.name, factor.levels[factor.levels.len() - 1]);
    let modifier = map(&factor.indicator(last), |x| 2.0 * x - 1.0);
    let way = Modifier::number(modifier, format!("direction({name})"));
    let id = EffectId::Hysteresis;
    on_node(fitted, id, name, Node::Output, [form("", vec![way])])
}
