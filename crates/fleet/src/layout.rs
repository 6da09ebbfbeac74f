//! What the columns of a table of results hold, by their names.

use std::iter::once;
use std::ops::Range;

use gumption_core::quantity::{Conversion, Unit, UnitTable};
use gumption_fault::{Fault, nearest, say};
use gumption_format::csv::faults::{NO_COLUMN, NO_UNIT, SAME_NAME, UNIT, UNIT_CLASH};
use gumption_format::csv::{Heading, Sheet};

use crate::faults::{NO_MEASURAND, NO_REFERENCE};
use crate::wanted::Wanted;

/// U in tables of engines, which do not tell it from u.
const EXPANDED: &str = "expanded";

/// Words before brackets that hold a name, and no unit.
const OF_NAMES: [&str; 15] = [
    "u",
    "U",
    EXPANDED,
    "nu",
    "k",
    "lower",
    "upper",
    "verdict",
    "p_c",
    "share",
    "contribution",
    "decision_threshold",
    "detection_limit",
    "best",
    "u_best",
];

/// Where everything stands.
#[derive(Debug)]
pub(crate) struct Layout {
    pub measurands: Vec<MeasurandColumns>,
    /// The name of a device.
    pub device: Option<usize>,
    pub date: Option<usize>,
    pub by: Vec<usize>,
    pub verdicts: Vec<(String, usize)>,
    pub findings: Option<usize>,
    pub error: Option<usize>,
}

impl Layout {
    /// The columns of numbers.
    pub fn numbers(&self) -> impl Iterator<Item = usize> {
        self.measurands.iter().flat_map(|one| {
            let shares = one.shares.iter().map(|(_, at)| *at);
            let stated = once(&one.stated).chain(&one.reference);
            stated.flat_map(StatedColumns::numbers).chain(shares)
        })
    }
}

/// The columns of a measurand.
#[derive(Debug)]
pub(crate) struct MeasurandColumns {
    pub stated: StatedColumns,
    /// The inputs whose shares of u² are given.
    pub shares: Vec<(String, usize)>,
    pub reference: Option<StatedColumns>,
}

/// The columns of a quantity with its uncertainty.
#[derive(Debug)]
pub(crate) struct StatedColumns {
    pub name: String,
    pub unit: Unit,
    pub value: NumberColumn,
    pub u: Option<NumberColumn>,
    pub dof: Option<usize>,
    pub k: Option<usize>,
    pub expanded: Option<NumberColumn>,
}

impl StatedColumns {
    fn numbers(&self) -> impl Iterator<Item = usize> {
        let spreads = [self.u, self.expanded].into_iter().flatten();
        let spreads = spreads.map(|column| column.at);
        once(self.value.at)
            .chain(spreads)
            .chain(self.dof)
            .chain(self.k)
    }
}

/// A column of numbers, and how they come into the unit of the measurand.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NumberColumn {
    pub at: usize,
    pub into: Option<Conversion>,
}

impl NumberColumn {
    /// Its number, in the unit of the measurand.
    pub fn converted(self, number: f64) -> f64 {
        self.into.map_or(number, |into| into.apply(number))
    }
}

/// The head of a column.
struct Head<'a> {
    text: &'a str,
    /// Without the unit, mostly in square brackets: `u(I)`.
    name: &'a str,
    has_unit: bool,
    place: Range<usize>,
}

struct Heads<'a> {
    all: Vec<Head<'a>>,
    units: UnitTable,
}

/// Finds the columns of a table of results.
///
/// # Errors
/// Everything that is missing or ambiguous.
pub(crate) fn layout(sheet: &Sheet<'_>, wanted: &Wanted) -> Result<Layout, Vec<Fault>> {
    let heads = Heads::of(sheet);
    let mut faults = Vec::new();
    let mut one = |name: &str| heads.find(name).map_err(|fault| faults.push(*fault)).ok();
    let by = wanted.by.iter().filter_map(|name| one(name)).collect();
    let date = wanted.date.as_deref().and_then(&mut one);
    let device = match wanted.device.as_deref() {
        Some(name) => one(name),
        None => heads.optional("label"),
    };
    let mut measurands = Vec::new();
    let references = || wanted.references.iter().map(|one| reference_of(one).1);
    let own = heads.stated().into_iter();
    for name in own.filter(|name| references().all(|reference| reference != *name)) {
        match heads.measurand(name) {
            Ok(found) => measurands.extend(found),
            Err(fault) => faults.push(*fault),
        }
    }
    // Which measurand is meant cannot be told where none is understood.
    let told = wanted
        .references
        .iter()
        .filter(|_| !measurands.is_empty() || faults.is_empty());
    for reference in told.collect::<Vec<_>>() {
        if let Err(fault) = heads.refer(reference, &mut measurands) {
            faults.push(*fault);
        }
    }
    if measurands.is_empty() && faults.is_empty() {
        faults.push(
            Fault::new(
                NO_MEASURAND,
                heads.whole(),
                say!("no column has estimates with their uncertainty"),
            )
            .label(say!("the columns"))
            .help(say!(
                "name them as `gumption batch` does: y [unit], u(y) [unit], k(y), U(y) [unit]"
            )),
        );
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    Ok(Layout {
        measurands,
        device,
        date,
        by,
        verdicts: heads.calls("verdict").collect(),
        findings: heads.optional("findings"),
        error: heads.optional("error"),
    })
}

impl<'a> Heads<'a> {
    fn of(sheet: &'a Sheet<'_>) -> Heads<'a> {
        let fields = sheet.header().fields().enumerate();
        let units = UnitTable::default();
        let head = |(at, text): (usize, &'a str)| {
            let bracketed = text
                .strip_suffix(']')
                .and_then(|text| text.rsplit_once('['));
            let (name, unit) = match bracketed {
                Some((name, _)) if !name.trim().is_empty() => (name.trim(), true),
                _ => match name_before_unit(text, &units) {
                    Some(name) => (name, true),
                    None => (text, false),
                },
            };
            Head {
                text,
                name,
                has_unit: unit,
                place: sheet.name_place(at),
            }
        };
        let all = fields.map(head).collect();
        Heads { all, units }
    }

    fn whole(&self) -> Range<usize> {
        let place = |head: Option<&Head<'_>>| head.map_or(0..0, |head| head.place.clone());
        place(self.all.first()).start..place(self.all.last()).end
    }

    /// The only column of this name, with or without its unit.
    fn optional(&self, name: &str) -> Option<usize> {
        let whole = self.all.iter().position(|head| head.text == name);
        whole.or_else(|| self.all.iter().position(|head| head.name == name))
    }

    /// A column that is asked for.
    fn find(&self, name: &str) -> Result<usize, Box<Fault>> {
        let named = self.all.iter().enumerate();
        let named = named.filter(|(_, head)| head.name == name || head.text == name);
        match named.map(|(at, _)| at).collect::<Vec<_>>()[..] {
            [at] => Ok(at),
            [one, other, ..] => Err(Box::new(self.twice(one, other))),
            [] => {
                let message = say!("there is no column \"{name}\" in the table");
                let fault = Fault::new(NO_COLUMN, self.whole(), message).label(say!("the columns"));
                let names = self.all.iter().map(|head| head.name);
                Err(Box::new(match nearest(name, names) {
                    Some(near) => fault.help(say!("did you mean \"{near}\"?")),
                    None => fault.help(say!(
                        "`gumption batch --keep {name}` (in Python, `keep=[\"{name}\"]`) carries a column of the table of devices through to the results"
                    )),
                }))
            }
        }
    }

    fn twice(&self, one: usize, other: usize) -> Fault {
        let name = self.all[one].name;
        let message = say!("two columns are called \"{name}\"");
        Fault::new(SAME_NAME, self.all[other].place.clone(), message)
            .label(say!("the second one"))
            .related(self.all[one].place.clone(), say!("the first one"))
            .help(say!("give each column a name of its own"))
    }

    /// The quantities of which an uncertainty is given, in the order of the columns.
    fn stated(&self) -> Vec<&'a str> {
        let mut names: Vec<&str> = Vec::new();
        for head in &self.all {
            let words = ["u", "U", EXPANDED].iter();
            let inside = words.copied().find_map(|word| call(head.name, word));
            names.extend(inside.filter(|name| !names.contains(name)));
        }
        names
    }

    /// What stands in brackets behind a word, and where: `verdict(y)`.
    fn calls(&self, word: &str) -> impl Iterator<Item = (String, usize)> {
        let all = self.all.iter().enumerate();
        all.filter_map(move |(at, head)| Some((call(head.name, word)?.to_owned(), at)))
    }

    fn measurand(&self, name: &str) -> Result<Option<MeasurandColumns>, Box<Fault>> {
        // An uncertainty of something that is not in the table is a column of the user's own.
        if self.optional(name).is_none() {
            return Ok(None);
        }
        let stated = self.quantity(name)?;
        let uncertainties = [
            stated.u.is_some(),
            stated.k.is_some(),
            stated.expanded.is_some(),
        ];
        if uncertainties.iter().filter(|given| **given).count() < 2 {
            let place = self.all[stated.value.at].place.clone();
            let message = say!("of the uncertainty of {name} there is too little");
            return Err(Box::new(
                Fault::new(NO_MEASURAND, place, message)
                    .label(say!("its estimates"))
                    .help(say!(
                        "two of u({name}), k({name}) and U({name}) are needed: add a column; or, if {name} is what others are held against, write `--reference {name}` (in Python, `reference=\"{name}\"`)"
                    )),
            ));
        }
        let of_name = format!("{name}, ");
        let shares = self.calls("share");
        let shares =
            shares.filter_map(|(both, at)| Some((both.strip_prefix(&of_name)?.to_owned(), at)));
        Ok(Some(MeasurandColumns {
            stated,
            shares: shares.collect(),
            reference: None,
        }))
    }

    fn quantity(&self, name: &str) -> Result<StatedColumns, Box<Fault>> {
        let at = self.find(name)?;
        let unit = self.unit(at)?.unwrap_or_else(Unit::one);
        let deviation = unit.difference();
        let number = |letter: &str| {
            let at = self.optional(&format!("{letter}({name})"));
            at.map(|at| self.spread(at, &deviation)).transpose()
        };
        let plain = |letter: &str| self.optional(&format!("{letter}({name})"));
        Ok(StatedColumns {
            name: name.to_owned(),
            value: NumberColumn { at, into: None },
            u: number("u")?,
            dof: plain("nu"),
            k: plain("k"),
            expanded: number("U")?.map_or_else(|| number(EXPANDED), |given| Ok(Some(given)))?,
            unit,
        })
    }

    fn unit(&self, at: usize) -> Result<Option<Unit>, Box<Fault>> {
        let head = &self.all[at];
        if !head.has_unit {
            return Ok(None);
        }
        let heading = Heading::read(head.text, &self.units);
        heading.unit.map_err(|error| {
            let start = head.place.start;
            let span = start + error.span.start..start + error.span.end;
            Box::new(Fault::new(UNIT, span, error.message).label(say!("no unit")))
        })
    }

    /// A column of values that are needed in this unit.
    fn number(&self, at: usize, unit: &Unit) -> Result<NumberColumn, Box<Fault>> {
        self.converted(at, unit, Unit::clone)
    }

    /// A column of uncertainties that are needed in this unit: one that is headed °C is a difference, as on every certificate of
    /// a thermometer, and no temperature.
    fn spread(&self, at: usize, unit: &Unit) -> Result<NumberColumn, Box<Fault>> {
        self.converted(at, unit, Unit::difference)
    }

    fn converted(
        &self,
        at: usize,
        unit: &Unit,
        meant: impl Fn(&Unit) -> Unit,
    ) -> Result<NumberColumn, Box<Fault>> {
        let head = &self.all[at];
        let (text, symbol) = (head.text, &unit.symbol);
        let fault = |code, message| {
            let help = say!("write {} [{symbol}]", head.name);
            Box::new(Fault::new(code, head.place.clone(), message).help(help))
        };
        let found = match self.unit(at)? {
            Some(found) => meant(&found),
            None if unit.is_one() => Unit::one(),
            None => return Err(fault(NO_UNIT, say!("\"{text}\" has no unit"))),
        };
        let conversion = found.conversion_to(unit);
        let Some(conversion) = conversion else {
            let message = say!("\"{text}\" is not in a unit of the dimension of {symbol}");
            return Err(fault(UNIT_CLASH, message));
        };
        Ok(NumberColumn {
            at,
            into: Some(conversion).filter(|conversion| !conversion.is_identity()),
        })
    }

    /// Gives a measurand its reference: `X`, or `y=X`.
    fn refer(
        &self,
        reference: &str,
        measurands: &mut [MeasurandColumns],
    ) -> Result<(), Box<Fault>> {
        let (owner, name) = reference_of(reference);
        let at = self.find(name)?;
        let refused = |message, help| {
            let place = self.all[at].place.clone();
            let fault = Fault::new(NO_REFERENCE, place, message);
            Box::new(fault.label(say!("the reference")).help(help))
        };
        let names = measurands.iter().map(|one| one.stated.name.clone());
        let names = names.collect::<Vec<_>>().join(", ");
        let owner = match (owner, measurands) {
            (None, [only]) => Some(only),
            (None, _) => None,
            (Some(owner), all) => all.iter_mut().find(|one| one.stated.name == owner),
        };
        let Some(owner) = owner else {
            return Err(refused(
                say!("of which measurand {name} is the reference is not clear"),
                say!(
                    "write --reference MEASURAND={name} (in Python, `reference=\"MEASURAND={name}\"`), with one of {names}"
                ),
            ));
        };
        let mut stated = self.quantity(name)?;
        let unit = owner.stated.unit.clone();
        stated.value = self.number(at, &unit)?;
        let spreads = [&mut stated.u, &mut stated.expanded];
        for column in spreads.into_iter().flatten() {
            *column = self.spread(column.at, &unit.difference())?;
        }
        stated.unit = unit;
        let is_known = stated.expanded.is_some() || (stated.u.is_some() && stated.k.is_some());
        if !is_known {
            return Err(refused(
                say!("the reference {name} has no expanded uncertainty"),
                say!("add a column U({name}), 0 where the value is exact"),
            ));
        }
        owner.reference = Some(stated);
        Ok(())
    }
}

/// The measurand of `y=X`, where it is stated, and the name of its reference.
fn reference_of(stated: &str) -> (Option<&str>, &str) {
    match stated.split_once('=') {
        Some((owner, name)) => (Some(owner), name),
        None => (None, stated),
    }
}

/// The name of a head whose unit stands in other brackets or behind a solidus, as tables of devices have it, too: `y (mm)`, `u(y)/℃`.
fn name_before_unit<'h>(text: &'h str, units: &UnitTable) -> Option<&'h str> {
    let is_written = text.ends_with([')', '）', '］']) || text.contains(['/', '／']);
    if !is_written || OF_NAMES.iter().any(|word| call(text, word).is_some()) {
        return None;
    }
    let heading = Heading::read(text, units);
    heading.unit.ok().flatten()?;
    text.get(..heading.name.len())
        .filter(|name| *name == heading.name)
}

/// What stands in brackets behind a word: `u(I)`; not of `u(I) (mA)`, whose last bracket closes another.
fn call<'h>(head: &'h str, word: &str) -> Option<&'h str> {
    let inside = head.strip_prefix(word)?.strip_prefix('(')?;
    let inside = inside.strip_suffix(')')?;
    let closes = |depth: &mut i32, c: char| {
        *depth += i32::from(c == '(') - i32::from(c == ')');
        Some(*depth < 0)
    };
    let closed_before = inside.chars().scan(0, closes).any(|closed| closed);
    (!closed_before).then_some(inside)
}
