//! The rows of a series in a CSV file, and of any table that replaces values of a budget.

use std::ops::Range;

use toml::Spanned;
use toml::de::DeValue;

use super::cell::Entry;
use super::check::Origin;
use super::faults::{CSV, SERIES};
use super::series::LABEL;
use gumption_core::quantity::{Conversion, Unit, UnitTable};
use gumption_fault::{Fault, Rejection, say};
use gumption_format::csv::{
    Heading, OVERLOAD, Row, RowFields, Sheet, mend_of_number, overload, text_of, two_decimal_signs,
};
use gumption_format::toml::{Raw, Stated};
use gumption_lanes::twice::TENS;

/// The columns of a table whose rows replace values of a budget.
#[derive(Debug)]
pub(super) struct Columns {
    /// Their names without their units.
    pub names: Vec<Stated<String>>,
    units: Vec<HeadUnit>,
}

/// What the head of a column says of the numbers below it.
#[derive(Debug)]
enum HeadUnit {
    /// They are in the unit that the budget states.
    OfBudget,
    /// They are amounts in this unit.
    Amounts(String),
    /// They are readings, which a budget has as numbers in the unit of their input.
    Readings(Conversion),
}

/// A table: names of columns, and fields as a budget writes them.
#[derive(Debug)]
pub(super) struct Points {
    /// The columns.
    pub columns: Columns,
    rows: Vec<Vec<Written>>,
    /// Where the budget names the file.
    place: Range<usize>,
}

/// A field.
#[derive(Debug)]
pub(super) enum Written {
    /// A number or a list as TOML writes it.
    Value(String),
    /// A text, or a number with its unit.
    Text(String),
}

impl Columns {
    /// Those of a table; `place` says where each is named, `names_one` whether the budget has something of that name,
    /// which then has no unit behind it: `pH_s` is no pH in seconds; `of_readings` the unit in which it has the readings that a
    /// column of that name sets.
    ///
    /// # Errors
    /// Units in the headers that are not known, or are none of the readings, in places of the table.
    pub fn of(
        sheet: &Sheet<'_>,
        place: impl Fn(usize) -> Range<usize>,
        names_one: impl Fn(&str) -> bool,
        of_readings: impl Fn(&str) -> Option<Unit>,
    ) -> Result<Columns, Vec<Fault>> {
        let known = UnitTable::default();
        let mut columns = Columns {
            names: Vec::new(),
            units: Vec::new(),
        };
        let mut faults = Vec::new();
        for at in 0..sheet.header().len() {
            let heading = sheet.heading(at, |name| match names_one(name) {
                true => Heading::plain(name),
                false => Heading::read(name, &known),
            });
            let here = || sheet.place(sheet.header(), at);
            let own = of_readings(&heading.name);
            columns.units.push(match (&heading.unit, own) {
                (Ok(None), _) => HeadUnit::OfBudget,
                (Ok(Some(unit)), None) => HeadUnit::Amounts(unit.symbol.clone()),
                (Ok(Some(unit)), Some(own)) => match unit.conversion_to(&own) {
                    Some(conversion) => HeadUnit::Readings(conversion),
                    None => {
                        faults.push(no_unit_of_readings(&heading.name, unit, &own, here()));
                        HeadUnit::OfBudget
                    }
                },
                (Err(error), _) => {
                    faults.push(heading.unknown_unit(error, &here()));
                    HeadUnit::OfBudget
                }
            });
            columns.names.push(Stated {
                value: heading.name,
                span: place(at),
                key: place(at),
            });
        }
        match faults.is_empty() {
            true => Ok(columns),
            false => Err(faults),
        }
    }

    /// The fields of a row.
    pub fn written(&self, row: &Row, sheet: &Sheet<'_>) -> Vec<Written> {
        let columns = self.units.iter().zip(&self.names).zip(row.fields());
        columns
            .map(|((unit, name), field)| match name.value == LABEL {
                // `10,5 V` as a name stays as it is.
                true if field.parse::<f64>().is_err() => Written::Text(field.to_owned()),
                _ => written(field, unit, sheet),
            })
            .collect()
    }
}

impl Points {
    /// Reads the file that a series names; its faults are told in its own lines.
    pub fn read(
        named: &Stated<String>,
        origin: Origin<'_>,
        names_one: impl Fn(&str) -> bool,
        of_readings: impl Fn(&str) -> Option<Unit>,
        faults: &mut Vec<Fault>,
    ) -> Option<Points> {
        let path = origin.directory.join(&named.value);
        let shown = path.display().to_string();
        let files = origin.files;
        let found = text_of(files.files, &path, &shown).and_then(|text| {
            Points::of(&text, named, &names_one, &of_readings)
                .map_err(|faults| Rejection::new(&shown, &text, faults))
        });
        found
            .map_err(|rejection| {
                let message = say!("{} cannot be used as it is", named.value);
                faults.push(
                    Fault::new(CSV, named.span.clone(), message)
                        .label(say!("has faults itself"))
                        .help(say!("its faults are listed after those of this file")),
                );
                files.refused(rejection);
            })
            .ok()
    }

    fn of(
        text: &str,
        named: &Stated<String>,
        names_one: &dyn Fn(&str) -> bool,
        of_readings: &dyn Fn(&str) -> Option<Unit>,
    ) -> Result<Points, Vec<Fault>> {
        let sheet = Sheet::new(text).map_err(|fault| vec![*fault])?;
        let sheet = sheet.above_units(&UnitTable::default());
        let columns = Columns::of(&sheet, |_| named.span.clone(), names_one, of_readings)?;
        let mut rows = Vec::new();
        let is_value = |at: usize| columns.names[at].value != LABEL;
        let mut faults: Vec<Fault> = two_decimal_signs(&sheet, is_value).into_iter().collect();
        let visited = sheet.visit(|row| {
            rows.push(columns.written(row, &sheet));
            faults.extend(row.fields().enumerate().filter_map(|(at, field)| {
                let (name, place) = (&columns.names[at].value, sheet.place(row, at));
                is_value(at).then(|| overload(name, row.line, field, place))?
            }));
        });
        faults.extend(visited.err().unwrap_or_default());
        if !faults.is_empty() {
            return Err(faults);
        }
        Ok(Points {
            columns,
            rows,
            place: named.span.clone(),
        })
    }

    /// The cells of each row.
    pub fn rows(&self) -> impl Iterator<Item = Vec<(Stated<Entry>, Raw<'_>)>> {
        self.rows.iter().map(|row| {
            let here = |_| self.place.clone();
            row.iter().map(|field| field.cell(&here)).collect()
        })
    }
}

impl Written {
    /// The text, as it stands in a budget.
    pub fn text(&self) -> &str {
        match self {
            Written::Value(text) | Written::Text(text) => text,
        }
    }

    /// The cell; `place` says where a part of the text stands.
    pub fn cell(&self, place: &impl Fn(Range<usize>) -> Range<usize>) -> (Stated<Entry>, Raw<'_>) {
        let text = self.text();
        let (cell, raw) = match self {
            Written::Text(_) => (Entry::Text(text.into()), DeValue::String(text.into())),
            Written::Value(_) => match DeValue::parse(text).map(Spanned::into_inner) {
                Ok(value @ DeValue::Array(_)) => (Entry::List, value),
                Ok(value @ (DeValue::Integer(_) | DeValue::Float(_))) => {
                    (Entry::Number(text.parse().unwrap_or(f64::NAN)), value)
                }
                _ => (Entry::Text(text.into()), DeValue::String(text.into())),
            },
        };
        let whole = place(0..text.len());
        let stated = Stated {
            value: cell,
            span: whole.clone(),
            key: whole.clone(),
        };
        (stated, Spanned::new(whole, moved(raw, place)))
    }
}

/// A value of which every part stands somewhere else.
fn moved<'p>(value: DeValue<'p>, place: &impl Fn(Range<usize>) -> Range<usize>) -> DeValue<'p> {
    let DeValue::Array(list) = value else {
        return value;
    };
    let items = list.into_iter().map(|item| {
        let there = place(item.span());
        Spanned::new(there, moved(item.into_inner(), place))
    });
    DeValue::Array(items.collect())
}

/// A field as a budget writes it: a number with the unit of its column, where that states one.
fn written(field: &str, unit: &HeadUnit, sheet: &Sheet) -> Written {
    let comma = sheet.has_decimal_commas() && field.matches(',').count() == 1;
    let plain = match comma {
        true => field.replace(',', "."),
        false => field.to_owned(),
    };
    let number = plain
        .parse::<f64>()
        .ok()
        .filter(|number| number.is_finite());
    match (number, unit) {
        (Some(_), HeadUnit::Amounts(unit)) => Written::Text(format!("{plain} {unit}")),
        (Some(number), HeadUnit::Readings(conversion)) => {
            Written::Value(format!("{:?}", conversion.apply(number)))
        }
        // TOML has no +1, .5 and 5.: the shortest form of the number then.
        (Some(number), HeadUnit::OfBudget)
            if !is_toml_number(&plain) && DeValue::parse(&plain).is_err() =>
        {
            Written::Value(format!("{number:?}"))
        }
        (Some(_), HeadUnit::OfBudget) => Written::Value(plain),
        (None, _) if field.starts_with('[') => Written::Value(match unit {
            HeadUnit::OfBudget => field.to_owned(),
            HeadUnit::Amounts(unit) => each_number(field, &|number| format!("\"{number} {unit}\"")),
            HeadUnit::Readings(conversion) => each_number(field, &|number| {
                let converted = number.parse().map(|number| conversion.apply(number));
                // What is no decimal number is refused as a text.
                converted.map_or(format!("\"{number}\""), |number| format!("{number:?}"))
            }),
        }),
        // `0,1 %` beside `0,1`.
        (None, _) if comma && is_amount(&plain) && mend_of_number(field).is_none() => {
            Written::Text(plain)
        }
        (None, _) => Written::Text(field.to_owned()),
    }
}

/// A list in which every number is written anew, also of the lists in it.
fn each_number(list: &str, write: &dyn Fn(&str) -> String) -> String {
    let Ok(parsed) = DeValue::parse(list) else {
        return list.to_owned();
    };
    let (mut text, mut end) = (String::new(), 0);
    for place in places_of_numbers(&parsed) {
        text.push_str(&list[end..place.start]);
        text.push_str(&write(&list[place.clone()].replace('_', "")));
        end = place.end;
    }
    text + &list[end..]
}

fn places_of_numbers(value: &Raw<'_>) -> Vec<Range<usize>> {
    match value.get_ref() {
        DeValue::Array(list) => list.iter().flat_map(places_of_numbers).collect(),
        DeValue::Integer(_) | DeValue::Float(_) => vec![value.span()],
        _ => Vec::new(),
    }
}

fn no_unit_of_readings(name: &str, unit: &Unit, own: &Unit, here: Range<usize>) -> Fault {
    let message = say!(
        "{name} is in {}, which is no unit like {}",
        unit.symbol,
        own.symbol
    );
    Fault::new(SERIES, here, message)
        .label(say!("expected {} or a unit like it", own.symbol))
        .help(say!("readings are converted to the unit of their input"))
}

/// Whether a text is a number and a unit behind a blank.
fn is_amount(text: &str) -> bool {
    let parts = text.split_once(' ');
    parts.is_some_and(|(number, unit)| number.parse::<f64>().is_ok() && !unit.trim().contains(' '))
}

/// The number that a field puts into a budget, where there is no doubt what it is: decimal digits, perhaps with a fraction
/// and an exponent, neither minus zero nor a whole number beyond what doubles count.
pub(super) fn plain_number(field: &str) -> Option<f64> {
    let (number, length) = leading_number(field)?;
    (length == field.len()).then_some(number)
}

/// As [`plain_number`], of the next field of a row.
#[inline]
pub(super) fn next_number(fields: &mut RowFields<'_>) -> Option<f64> {
    fields
        .read(leading_number)
        .or_else(|| plain_number(fields.next()?))
}

/// The number at the beginning of a text, and how long it is.
#[inline]
fn leading_number(text: &str) -> Option<(f64, usize)> {
    /// Digits that every double and every whole number of TOML keeps.
    const DIGITS: usize = 15;
    let (decimal, rest) = Decimal::leading(text.as_bytes())?;
    let length = text.len() - rest.len();
    if decimal.is_whole && length > DIGITS {
        return None;
    }
    let number = match decimal.exact() {
        // Whether it is settled is told by its digits, so that nobody waits for the division.
        Some(number) => (decimal.digits != 0 || !decimal.negative).then_some(number),
        None => text[..length].parse().ok().filter(|one| is_settled(*one)),
    };
    Some((number?, length))
}

/// Whether there is no doubt what a number puts into a budget: no overload of an instrument either.
pub(super) fn is_settled(number: f64) -> bool {
    number.abs() < OVERLOAD && (number != 0.0 || number.is_sign_positive())
}

/// Whether TOML is sure to read a text as the decimal number that it is.
fn is_toml_number(text: &str) -> bool {
    Decimal::leading(text.as_bytes()).is_some_and(|(_, rest)| rest.is_empty())
}

/// A decimal number as TOML writes it: digits, then perhaps a fraction and an exponent.
struct Decimal {
    negative: bool,
    /// Its digits as a whole number, which wraps where they are too many, and how many there are.
    digits: u64,
    count: usize,
    /// The power of ten that goes with it.
    exponent: i64,
    /// Whether it has neither fraction nor exponent.
    is_whole: bool,
}

impl Decimal {
    /// The one at the beginning of a text, and what follows it.
    #[inline]
    fn leading(text: &[u8]) -> Option<(Decimal, &[u8])> {
        let unsigned = text.strip_prefix(b"-").unwrap_or(text);
        if let [b'0', b'0'..=b'9', ..] = unsigned {
            return None;
        }
        let (digits, rest) = digits(unsigned, 0)?;
        let mut decimal = Decimal {
            negative: unsigned.len() < text.len(),
            digits,
            count: unsigned.len() - rest.len(),
            exponent: 0,
            is_whole: !matches!(rest, [b'.' | b'e' | b'E', ..]),
        };
        let rest = match rest {
            [b'.', fraction @ ..] => {
                let (digits, rest) = self::digits(fraction, digits)?;
                let count = fraction.len() - rest.len();
                decimal.digits = digits;
                decimal.count += count;
                decimal.exponent = -(count as i64);
                rest
            }
            rest => rest,
        };
        let (sign, exponent) = match rest {
            [b'e' | b'E', b'-', exponent @ ..] => (-1, exponent),
            [b'e' | b'E', b'+', exponent @ ..] | [b'e' | b'E', exponent @ ..] => (1, exponent),
            rest => return Some((decimal, rest)),
        };
        let (power, rest) = self::digits(exponent, 0)?;
        // What is this long is out of the range of doubles.
        let power = i64::from(u16::try_from(power).unwrap_or(u16::MAX));
        decimal.exponent += sign * power;
        Some((decimal, rest))
    }

    /// The nearest double, where digits and power of ten are doubles themselves, so that one rounding gives it (Clinger 1990).
    #[inline]
    fn exact(&self) -> Option<f64> {
        /// Digits that 64 bits hold.
        const HELD: usize = 19;
        let fits = self.count <= HELD && self.digits < 1 << f64::MANTISSA_DIGITS;
        let digits = fits.then_some(self.digits as f64)?;
        let power = TENS.get(self.exponent.unsigned_abs() as usize)?;
        let size = match self.exponent < 0 {
            true => digits / power,
            false => digits * power,
        };
        Some(if self.negative { -size } else { size })
    }
}

/// The whole number that goes on with the digits at the beginning of a text, of which there must be some; the rest.
#[inline]
fn digits(text: &[u8], before: u64) -> Option<(u64, &[u8])> {
    let mut number = before;
    let mut rest = text;
    while let [digit @ b'0'..=b'9', more @ ..] = rest {
        number = number
            .wrapping_mul(10)
            .wrapping_add(u64::from(digit - b'0'));
        rest = more;
    }
    (rest.len() < text.len()).then_some((number, rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A unit in the head holds for the members of a list as well: readings are converted, other numbers are amounts.
    #[test]
    fn lists_have_the_unit_of_their_head() {
        let table = "label;V.readings [mV];X.limits [mm]\na;[1_010, 1.5e3, 0x10];[-1, 2.5]\n";
        let sheet = Sheet::new(table).expect("a table");
        let volt = UnitTable::default().parse("V").expect("a unit");
        let of_readings = |name: &str| (name == "V.readings").then(|| volt.clone());
        let columns = Columns::of(&sheet, |_| 0..0, |_| false, of_readings).expect("columns");
        let mut found = Vec::new();
        let visited = sheet.visit(|row| found.extend(columns.written(row, &sheet)));
        visited.expect("rows");
        let texts: Vec<&str> = found.iter().map(Written::text).collect();
        assert_eq!(
            texts,
            ["a", r#"[1.01, 1.5, "0x10"]"#, r#"["-1 mm", "2.5 mm"]"#]
        );
    }

    #[test]
    fn values_are_no_overloads_and_have_one_decimal_sign() {
        let named = Stated {
            value: "s.csv".to_owned(),
            span: 0..0,
            key: 0..0,
        };
        let refused = |text: &str| {
            let found = Points::of(text, &named, &|_| false, &|_| None);
            let places = |faults: Vec<Fault>| faults.into_iter().map(|fault| fault.span);
            let refused = found.err().map(places).into_iter().flatten();
            refused
                .map(|place| text[place].to_owned())
                .collect::<Vec<_>>()
        };
        assert_eq!(refused("label,V\n9.9e37,9.91E+37\nb,1\n"), ["9.91E+37"]);
        assert_eq!(refused("label;V;R\n1.1;1.500;100,5\n"), ["R"]);
        assert_eq!(refused("label;V;R\n1.1;1;100,5\n").len(), 0);
    }

    #[test]
    fn amounts_may_have_decimal_commas_as_numbers_have() {
        let text = "label;V;V.u\n10,5 V;1,5;0,1 %\n";
        let sheet = Sheet::new(text).expect("names");
        let columns = Columns::of(&sheet, |_| 0..0, |_| false, |_| None).expect("columns");
        let row = sheet.rows().next().expect("a row").expect("fields");
        let written = columns.written(&row, &sheet);
        let texts: Vec<&str> = written.iter().map(Written::text).collect();
        assert_eq!(texts, ["10,5 V", "1.5", "0.1 %"]);
    }

    #[test]
    fn units_may_stand_below_the_names() {
        let text = "label,R,R.u,pH_s\n,kΩ,[Ω],\na,1.5,20,4\n";
        let sheet = Sheet::new(text).expect("names");
        let sheet = sheet.above_units(&UnitTable::default());
        let is_input = |name: &str| ["R", "pH_s"].contains(&name);
        let columns = Columns::of(&sheet, |_| 0..0, is_input, |_| None).expect("columns");
        let rows: Vec<_> = sheet.rows().map(|row| row.expect("fields")).collect();
        let written = columns.written(&rows[0], &sheet);
        let texts: Vec<&str> = written.iter().map(Written::text).collect();
        assert_eq!((rows.len(), rows[0].line), (1, 3));
        assert_eq!(texts, ["a", "1.5 kΩ", "20 Ω", "4"]);
    }

    #[test]
    fn plain_numbers_are_read_as_by_the_standard_library() {
        let plain = [
            "0",
            "1",
            "-1.5",
            "0.1",
            "123456789012345",
            "9.8e37",
            "4.9e-324",
            "1e22",
            "1e23",
            "1e-22",
            "9007199254740993.0",
            "9007199254740992.0",
            "12345678901234567890.5",
            "0.30000000000000004",
            "1E+5",
            "6.02e0023",
            "123456789012345678901234567890.0",
            "0.000000000000000000000000000001",
            "1e-400",
        ];
        for text in plain {
            let expected: f64 = text.parse().expect("a number");
            assert_eq!(
                plain_number(text).map(f64::to_bits),
                Some(expected.to_bits()),
                "{text}"
            );
        }
        let others = [
            "",
            "-",
            "-0",
            "-0.0",
            "+1",
            ".5",
            "5.",
            "01",
            "1e",
            "1e+",
            "1_000",
            "1,5",
            " 1",
            "1.5e3x",
            "inf",
            "nan",
            "0x1",
            "1234567890123456",
            "1e400",
            "1.7976931348623157e308",
            "-9.91E+37",
            "1e99999999999999999999",
            "1.5.2",
        ];
        for text in others {
            assert_eq!(plain_number(text), None, "{text}");
        }
        // Every length of digits, and every power.
        for length in 1..25 {
            for power in -30..30 {
                let digits = &"1928374650918273645019283"[..length];
                let text = format!("{digits}.5e{power}");
                let number = text.parse().ok().filter(|number: &f64| is_settled(*number));
                assert_eq!(plain_number(&text), number, "{text}");
            }
        }
    }
}
