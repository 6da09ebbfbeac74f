//! Words and columns of rows turned into what is known, and their figures into one unit.

use crate::claim::{Claimed, Relative, Row, Stated, Unplaced};
use crate::printed::Printed;
use crate::read::amounts::with_shares_made;
use crate::read::family::FULL_SCALE;
use crate::read::kind::{self, Evidence};
use crate::read::quotients::quotients;
use crate::read::remarks;
use crate::read::series;
use crate::read::words::{self, has};
use crate::units;

use super::contained::{not_counted, smaller_are_not_counted};
use super::raw::Raw;
use super::relative::settle_by_amount;

/// Turns words and columns of each row into what is known of it, and its figures into one unit.
pub fn interpret(raw: &[Raw], full: bool, claimed: &mut Claimed) {
    let mean_of = claimed.reported_mean_of;
    let (y_unit, title) = (claimed.unit.clone(), claimed.title.clone());
    for (raw, row) in raw.iter().zip(&mut claimed.rows) {
        let figures = [&row.used, &row.u, &row.value];
        let units = figures.into_iter().flatten().map(|figure| &figure.unit);
        let own = units.chain([&row.unit]).find(|unit| !unit.is_empty());
        let words = with_shares_made(&remarks::stating(&row.words));
        let words = own.map_or(words.clone(), |unit| words::of_unit(&words, unit));
        let evidence = Evidence {
            words: &words,
            title: &title,
            columns: &raw.columns_text,
            used: row.used.as_ref(),
            used_head: &raw.used_head,
            u: row.u.as_ref(),
            divisor: row.divisor.as_ref().map(|d| d.value),
            divisor_is_factor: raw.divisor_is_factor,
            readings: raw.readings,
            full: full && !raw.stated_apart,
            mean_of,
        };
        (row.stated, row.relative) = kind::stated(&evidence);
        let is_made = |u: &Printed| raw.is_root || row.is_worked_out(u);
        if let Some(u) = row.u.clone().filter(is_made) {
            (row.stated, row.relative) = (Stated::Standard { u, dof: None }, Relative::No);
        }
        // A plain number in a column that calls u relative is a ratio.
        if let Some(u) = row
            .u
            .as_mut()
            .filter(|u| raw.has_relative_u && u.unit.is_empty())
        {
            u.unit = "1".into();
        }
        row.unread_used = row.unread_used.take().filter(|cell| row.is_unread(cell));
        row.not_counted = row.not_counted.take().or_else(|| not_counted(&row.words));
    }
    smaller_are_not_counted(&mut claimed.rows);
    let columns = raw.iter().map(|raw| raw.columns_text.as_str());
    series::settle(columns.zip(&mut claimed.rows), &claimed.words);
    for row in &mut claimed.rows {
        if let Some(amount) = named_whole(&row.words) {
            row.take_part_of(&amount);
        }
    }
    if let Some(whole) = whole_of_shares(claimed) {
        for row in &mut claimed.rows {
            row.take_share_of(&whole);
        }
    }
    let nominal = nominal(claimed);
    let (range, amounts) = (range(claimed), amounts(claimed));
    for row in &mut claimed.rows {
        let own = match has(&row.words.to_lowercase(), &ranges()) {
            true => range.as_ref(),
            false => amounts.iter().find(|amount| row.shows(amount, 1.0)),
        };
        if let Some(whole) = own.or(nominal.as_ref()) {
            row.take_part_of(whole);
        }
        row.leave_what_is_of_another_unit();
        row.convert_to_one_unit(&y_unit);
        row.convert_contribution(&y_unit);
    }
    add_absent(claimed);
    settle_by_amount(claimed);
    for figure in [
        &mut claimed.footer.u_c,
        &mut claimed.footer.expanded,
        &mut claimed.cmc,
    ]
    .into_iter()
    .flatten()
    {
        if let Some(factor) = units::factor(&figure.unit, &y_unit)
            .filter(|_| !figure.unit.is_empty() && !y_unit.is_empty())
        {
            *figure = figure.clone().scaled(factor);
        }
    }
}

/// The amount of which a row says that its percentage is a part: `20 ppm of 10 V`, `0.05 %×2.5 MPa`, `10 V 的 20 ppm`.
fn named_whole(words: &str) -> Option<Printed> {
    const OF: &[&str] = &[
        "% of", "%of", "‰ of", "ppm of", "ppb of", "% von", "%×", "% ×", "‰×", "ppm×", "ppm ×",
    ];
    let behind = words::figure_after(words, OF);
    let amount = behind.or_else(|| {
        let (front, share) = words.split_once('的')?;
        let share = words::figures_with_units(share).next()?;
        units::fraction(&share.unit)?;
        words::figures_with_units(front).last()
    })?;
    units::fraction(&amount.unit).is_none().then_some(amount)
}

/// What percentages without an estimate are of: the result, or an amount that the title or a line names, of which the laboratory's
/// own u shows in one row at least that it took it, if need be with a wrong power of ten.
fn nominal(claimed: &Claimed) -> Option<Printed> {
    let amounts = amounts(claimed);
    let is_taken = |amount: &&Printed| {
        let mut rows = claimed.rows.iter();
        rows.any(|row| row.shows(amount, 1.0))
    };
    // A range is another whole than the value.
    let is_missed = |amount: &&Printed| {
        let of_value = |row: &&Row| !has(&row.words.to_lowercase(), &ranges());
        let mut rows = claimed.rows.iter().filter(of_value);
        rows.any(|row| units::MISSED.iter().any(|ratio| row.shows(amount, *ratio)))
    };
    let found = amounts
        .iter()
        .find(is_taken)
        .or_else(|| amounts.iter().find(is_missed));
    found.cloned()
}

/// What amounts in a budget in percent are parts of, `0.1 mg/L` at 50 mg/L: of what is named, what the laboratory's own u shows.
fn whole_of_shares(claimed: &Claimed) -> Option<Printed> {
    let is_taken = |row: &Row, amount: &Printed| {
        let made = row.made().zip(row.share_of(amount));
        made.zip(row.stated.standard())
            .is_some_and(|((u, share), (stated, _))| {
                u.is_met_within(stated * share, u.half_of_digits() + 0.01 * u.value)
            })
    };
    let mut amounts = amounts(claimed).into_iter();
    amounts.find(|amount| claimed.rows.iter().any(|row| is_taken(row, amount)))
}

/// The result, and the amounts that the title and the lines name.
fn amounts(claimed: &Claimed) -> Vec<Printed> {
    let texts = [&claimed.title, &claimed.words].into_iter();
    let named = texts.flat_map(|text| words::figures_with_units(text));
    claimed.footer.y.iter().cloned().chain(named).collect()
}

/// The range that the title or a line names: `full scale 500 L/min`.
fn range(claimed: &Claimed) -> Option<Printed> {
    let lines = claimed.words.lines();
    let mut texts = [claimed.title.as_str()].into_iter().chain(lines);
    texts.find_map(|text| words::figure_after(text, &ranges()))
}

/// Words for what a percentage may be of that is not the value.
fn ranges() -> Vec<&'static str> {
    [&["range"], FULL_SCALE, &["span"]].concat()
}

/// What a note knows of a quantity that no row has, unless a row has its figure.
fn add_absent(claimed: &mut Claimed) {
    let known = |row: &Row| {
        let figure = row.stated.figure().map(|figure| figure.value);
        claimed
            .rows
            .iter()
            .filter(|other| matches!(other.stated, Stated::Certificate { .. }))
            .any(|other| other.stated.figure().map(|f| f.value) == figure)
    };
    let absent: Vec<Row> = std::mem::take(&mut claimed.absent)
        .into_iter()
        .filter(|row| !known(row))
        .collect();
    let y_unit = claimed.unit.clone();
    for mut row in absent {
        row.convert_to_one_unit(&y_unit);
        row.is_absent = true;
        claimed.rows.push(row);
    }
}

/// Whether a text has a figure in it.
fn states(text: &str, figure: &Printed) -> bool {
    words::figures_with_units(text).any(|own| own.value == figure.value)
}

impl Row {
    /// The standard uncertainty that the laboratory has, or the contribution where it is the same figure.
    fn made(&self) -> Option<Printed> {
        let is_one = |c: &Printed| c.value.abs() == 1.0 && units::parse(&c.unit).is_none();
        let contribution = || {
            let part = self.contribution.clone();
            part.filter(|_| self.c.as_ref().is_none_or(is_one))
        };
        let figure = self.u.clone().or_else(contribution)?;
        let value = figure.value.abs();
        Some(Printed { value, ..figure })
    }

    /// Whether what its column of limits says gave nothing: u is what the laboratory has for it, or there is none.
    fn is_unread(&self, cell: &Unplaced) -> bool {
        let has_figure = cell.text.contains(|c: char| c.is_ascii_digit());
        match (&self.stated, &self.u) {
            (Stated::Nothing, _) => has_figure || self.contribution.is_none(),
            (Stated::Standard { u, .. }, Some(own)) => {
                has_figure && u == own && !states(&cell.text, u)
            }
            _ => false,
        }
    }

    /// Whether its words divide a figure until u comes out: `0.2 % / 2.8 / √2`.
    fn is_worked_out(&self, u: &Printed) -> bool {
        let value = self.value.as_ref().map_or(1.0, |value| value.value.abs());
        let is_u = |x: f64| u.is_met_within(x, u.half_of_digits());
        quotients(&self.words).any(|quotient| match units::fraction(&quotient.unit) {
            Some(fraction) => is_u(quotient.value) || is_u(quotient.value * fraction * value),
            None => is_u(quotient.value * units::factor(&quotient.unit, &u.unit).unwrap_or(1.0)),
        })
    }

    /// What a unit of a percentage without an estimate is in the unit of u, where it is of this amount.
    fn part_of(&self, amount: &Printed) -> Option<f64> {
        let u = self.made().filter(|u| units::fraction(&u.unit).is_none())?;
        match self.relative {
            Relative::OfValue(fraction) if self.value.is_none() => {
                let factor = units::factor(&amount.unit, &u.unit)?;
                Some(fraction * factor * amount.value.abs())
            }
            _ => None,
        }
    }

    /// Whether u shows that the percentage of the row is of this amount, if need be times a wrong power of ten.
    fn shows(&self, amount: &Printed, ratio: f64) -> bool {
        let made = self.made().zip(self.part_of(amount));
        let made = made.zip(self.stated.standard());
        made.is_some_and(|((u, part), (stated, _))| {
            u.is_met_within(stated * part * ratio, u.half_of_digits() + 0.01 * u.value)
        })
    }

    /// What a unit of an amount that is stated without an estimate is in the unit of u, where u is the share of this amount.
    fn share_of(&self, amount: &Printed) -> Option<f64> {
        let fraction = units::fraction(&self.made()?.unit)?;
        let unit = self.stated.figure().map(|figure| figure.unit.as_str())?;
        let is_amount = !unit.is_empty() && units::fraction(unit).is_none() && self.value.is_none();
        let factor = units::factor(unit, &amount.unit)?;
        (is_amount && amount.value != 0.0).then(|| factor / (fraction * amount.value.abs()))
    }

    fn take_share_of(&mut self, amount: &Printed) {
        if let Some((share, u)) = self.share_of(amount).zip(self.made()) {
            for figure in self.stated.figures_mut() {
                *figure = figure.clone().scaled(share);
                figure.unit.clone_from(&u.unit);
            }
        }
    }

    fn take_part_of(&mut self, amount: &Printed) {
        let part = self.part_of(amount);
        if let (Relative::OfValue(fraction), Some(part)) = (self.relative, part) {
            self.relative = Relative::OfFullScale(fraction, part / fraction);
        }
    }

    /// u as it stands, where its words have no more than a figure in a unit from which nothing leads to that of u:
    /// `temperature ±3 °C` beside u in kPa.
    fn leave_what_is_of_another_unit(&mut self) {
        let Some((u, figure)) = self.u.clone().zip(self.stated.figure()) else {
            return;
        };
        let is_known = |unit: &str| units::parse(unit).is_some();
        let is_ratio = units::fraction(&figure.unit).is_some();
        let leads = is_ratio || units::factor(&figure.unit, &u.unit).is_some();
        if is_known(&figure.unit) && is_known(&u.unit) && !leads {
            self.stated = Stated::Standard { u, dof: None };
        }
    }

    /// Whether a percentage is of an estimate that is a number, as the laboratory's own u shows: `0.2 ppm` of a ratio of 1.00002 is
    /// 2E-07 there, and not 0.2.
    fn is_part_of_number(&self) -> bool {
        let (Relative::OfValue(fraction), Some(value), Some(u)) =
            (self.relative, &self.value, &self.u)
        else {
            return false;
        };
        let are_bare = value.unit.is_empty() && u.unit.is_empty();
        let distance = |x: f64| libm::log(x / u.value).abs();
        self.stated.standard().is_some_and(|(stated, _)| {
            are_bare && distance(stated * fraction * value.value.abs()) < distance(stated)
        })
    }

    /// The contribution in the unit of the result: cells of one column may each have their own.
    fn convert_contribution(&mut self, y_unit: &str) {
        let Some(figure) = &mut self.contribution else {
            return;
        };
        if let Some(factor) = units::factor(&figure.unit, y_unit).filter(|factor| *factor != 1.0) {
            *figure = figure.clone().scaled(factor);
            figure.unit = y_unit.to_owned();
        }
    }

    /// Figures of ± and of what is stated in the unit of u, where all units are known.
    fn convert_to_one_unit(&mut self, y_unit: &str) {
        let stated_unit = self
            .stated
            .figure()
            .map(|f| f.unit.clone())
            .unwrap_or_default();
        let unit_of =
            |figure: &Option<Printed>| figure.as_ref().map(|f| f.unit.clone()).unwrap_or_default();
        let (mut u, used, value) = (unit_of(&self.u), unit_of(&self.used), unit_of(&self.value));
        if matches!(self.relative, Relative::OfFullScale(..)) {
            u = unit_of(&self.made());
        }
        let relative_y = units::fraction(y_unit).is_some();
        let fraction = units::fraction(&stated_unit).is_some();
        let candidates = if fraction && !relative_y {
            [&u, &value, &self.unit, &used]
        } else {
            [&u, &used, &self.unit, &value]
        };
        let of_number = self.is_part_of_number();
        let known = candidates
            .into_iter()
            .find(|unit| !unit.is_empty() && (!of_number || units::fraction(unit).is_none()))
            .cloned();
        // Nothing but the percentage has a unit: it is of the value, which has none.
        let bare = known.is_none() && fraction && !relative_y && self.relative != Relative::No;
        let target = match known {
            Some(unit) => unit,
            None if bare => String::new(),
            None => stated_unit.clone(),
        };
        let of_value = matches!(self.relative, Relative::OfValue(_));
        if units::fraction(&target).is_some() {
            if of_value {
                self.relative = Relative::No;
            }
        } else if of_value && self.value.is_none() {
            // A percentage of a value that the sheet does not state: what was used of it is all there is.
            self.relative = Relative::No;
            let used = self.used.clone();
            let used = used.filter(|used| units::fraction(&used.unit).is_none());
            if let Some(used) = used.or_else(|| {
                self.u
                    .clone()
                    .zip(self.divisor.as_ref())
                    .map(|(u, d)| u.scaled(d.value))
            }) {
                self.stated.replace_figure(used);
            } else if let Some(u) = self.u.clone() {
                self.stated = Stated::Standard { u, dof: None };
            }
        }
        let convert = |figure: &mut Printed| {
            let factor = units::factor(&figure.unit, &target)
                .filter(|_| !figure.unit.is_empty() && !target.is_empty());
            // A percentage of a value is converted by the value.
            if let Some(factor) = factor.filter(|_| {
                units::fraction(&figure.unit).is_none() || units::fraction(&target).is_some()
            }) {
                *figure = figure.clone().scaled(factor);
            }
        };
        for figure in self.stated.figures_mut() {
            if figure.unit.is_empty() {
                figure.unit.clone_from(&used);
            }
            convert(figure);
        }
        if let Some(used) = &mut self.used {
            convert(used);
        }
        self.unit = target;
    }
}

impl Stated {
    fn replace_figure(&mut self, figure: Printed) {
        if let [own] = self.figures_mut().as_mut_slice() {
            **own = figure;
        }
    }

    fn figures_mut(&mut self) -> Vec<&mut Printed> {
        match self {
            Stated::Nothing => Vec::new(),
            Stated::Certificate { expanded: x, .. }
            | Stated::Limits { half_width: x, .. }
            | Stated::FullWidth { width: x, .. }
            | Stated::Step { step: x }
            | Stated::Deviation { s: x, .. }
            | Stated::Range { range: x, .. }
            | Stated::Standard { u: x, .. } => vec![x],
            Stated::Unequal { plus, minus } => vec![plus, minus],
        }
    }
}
