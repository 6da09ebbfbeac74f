//! The rows of a series, in the budget or in a CSV file, and of any table that replaces values of a budget.

use std::ops::Range;

use toml::Spanned;
use toml::de::DeValue;

use super::cell::Entry;
use super::check::Origin;
use super::faults::{CSV, SERIES};
use super::plain_number::is_toml_number;
use super::series::{Ground, HeadUnit, LABEL, WrittenRow};
use super::tables::SeriesTable;
use gumption_fault::{Fault, Rejection, say};
use gumption_format::csv::{
    Heading, Row, Sheet, mend_of_number, overload, summary_of_rows, text_of, two_decimal_signs,
};
use gumption_format::toml::{Raw, Stated, number};

/// The columns of a table whose rows replace values of a budget.
#[derive(Debug)]
pub(super) struct Columns {
    /// Their names without their units.
    pub names: Vec<Stated<String>>,
    units: Vec<HeadUnit>,
}

/// A table: names of columns, and fields as a budget writes them.
#[derive(Debug)]
pub(super) struct Points {
    /// The columns.
    pub columns: Columns,
    rows: Vec<PointRow>,
}

/// A row, and where the budget has it.
#[derive(Debug)]
struct PointRow {
    place: Range<usize>,
    fields: Vec<(Written, FieldPlace)>,
}

/// Where the budget has a field.
#[derive(Debug)]
enum FieldPlace {
    /// Its text stands there as it is, from here on.
    From(usize),
    /// What stands there becomes it.
    Within(Range<usize>),
}

impl FieldPlace {
    /// The place of a part of the text.
    fn of(&self, part: Range<usize>) -> Range<usize> {
        match self {
            FieldPlace::From(start) => start + part.start..start + part.end,
            FieldPlace::Within(place) => place.clone(),
        }
    }
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
    /// Those of a table; `place` says where each is named, `ground` what the budget says of heads.
    ///
    /// # Errors
    /// Units in the headers that are not known, or are none of what the column sets, in places of the table.
    pub fn of(
        sheet: &Sheet<'_>,
        place: impl Fn(usize) -> Range<usize>,
        ground: &Ground<'_, '_>,
    ) -> Result<Columns, Vec<Fault>> {
        let headings = sheet.headings(|name| ground.heading(name)).enumerate();
        let heads = headings.map(|(at, heading)| (heading, sheet.name_place(at), place(at)));
        Columns::under(heads, ground)
    }

    /// Those that the budget states.
    fn stated(columns: &[Stated<String>], ground: &Ground<'_, '_>) -> Result<Columns, Vec<Fault>> {
        let heads = columns.iter().map(|column| {
            // Without brackets it is a path, whatever its end: `claim.figures.t_s`.
            let heading = match column.value.trim_end().ends_with([']', '］']) {
                true => ground.heading(&column.value),
                false => Heading::plain(&column.value),
            };
            let quote = 1;
            let inside = column.span.start + quote..column.span.end - quote;
            (heading, inside, column.span.clone())
        });
        Columns::under(heads, ground)
    }

    /// Those under heads, each with its place in its text and in the budget.
    fn under(
        heads: impl Iterator<Item = (Heading, Range<usize>, Range<usize>)>,
        ground: &Ground<'_, '_>,
    ) -> Result<Columns, Vec<Fault>> {
        let mut columns = Columns {
            names: Vec::new(),
            units: Vec::new(),
        };
        let mut faults = Vec::new();
        for (heading, here, place) in heads {
            match ground.unit(&heading, here) {
                Ok(unit) => columns.units.push(unit),
                Err(fault) => faults.push(*fault),
            }
            columns.names.push(Stated {
                value: heading.name,
                span: place.clone(),
                key: place,
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

    /// A row that the budget, of this text, states.
    fn row_of_budget(&self, row: &Stated<Vec<Stated<Entry>>>, text: &str) -> PointRow {
        // A row with too many fields is refused as a whole.
        let units = self
            .units
            .iter()
            .chain(std::iter::repeat(&HeadUnit::OfBudget));
        let fields = row.value.iter().zip(units).map(|(cell, unit)| {
            let stated = text.get(cell.span.clone()).unwrap_or_default();
            let written = unit.over(stated);
            let place = match written == stated {
                true => FieldPlace::From(cell.span.start),
                false => FieldPlace::Within(cell.span.clone()),
            };
            (Written::Value(written), place)
        });
        PointRow {
            place: row.span.clone(),
            fields: fields.collect(),
        }
    }
}

impl Points {
    /// Those of a series; `text` is that of the budget.
    pub fn of_series(
        stated: &Stated<SeriesTable>,
        ground: &Ground<'_, '_>,
        (text, origin): (&str, Origin<'_>),
        faults: &mut Vec<Fault>,
    ) -> Option<Points> {
        let table = &stated.value;
        match (&table.file, &table.columns, &table.rows) {
            (Some(named), None, None) => Points::read(named, origin, ground, faults),
            (None, Some(columns), Some(rows)) => {
                let columns = Columns::stated(&columns.value, ground);
                let columns = columns.map_err(|found| faults.extend(found)).ok()?;
                let rows = rows.value.iter();
                let rows = rows.map(|row| columns.row_of_budget(row, text)).collect();
                Some(Points { columns, rows })
            }
            (Some(_), ..) => {
                let message = say!("the rows of the series are stated twice");
                faults.push(
                    Fault::new(SERIES, stated.span.clone(), message)
                        .label(say!("in a file and here"))
                        .help(say!(
                            "the first line of `file` names the columns: leave out `columns` and `rows`"
                        )),
                );
                None
            }
            _ => {
                if !table.refused {
                    faults.push(incomplete(stated));
                }
                None
            }
        }
    }

    /// Reads the file that a series names; its faults are told in its own lines.
    fn read(
        named: &Stated<String>,
        origin: Origin<'_>,
        ground: &Ground<'_, '_>,
        faults: &mut Vec<Fault>,
    ) -> Option<Points> {
        let path = origin.directory.join(&named.value);
        let shown = path.display().to_string();
        let files = origin.files;
        let found = text_of(files.files, &path, &shown).and_then(|text| {
            Points::of(&text, named, ground).map_err(|faults| Rejection::new(&shown, &text, faults))
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
        ground: &Ground<'_, '_>,
    ) -> Result<Points, Vec<Fault>> {
        let sheet = Sheet::new(text).map_err(|fault| vec![*fault])?;
        let sheet = sheet.above_units(ground.units());
        let columns = Columns::of(&sheet, |_| named.span.clone(), ground)?;
        let mut rows = Vec::new();
        let is_value = |at: usize| columns.names[at].value != LABEL;
        let mut faults: Vec<Fault> = two_decimal_signs(&sheet, is_value).into_iter().collect();
        faults.extend(summary_of_rows(&sheet, is_value));
        let visited = sheet.visit(|row| {
            let fields = columns.written(row, &sheet).into_iter();
            rows.push(PointRow {
                place: named.span.clone(),
                fields: fields
                    .map(|field| (field, FieldPlace::Within(named.span.clone())))
                    .collect(),
            });
            faults.extend(row.fields().enumerate().filter_map(|(at, field)| {
                let (name, place) = (&columns.names[at].value, sheet.place(row, at));
                is_value(at).then(|| overload(name, row.line, field, place))?
            }));
        });
        faults.extend(visited.err().unwrap_or_default());
        match faults.is_empty() {
            true => Ok(Points { columns, rows }),
            false => Err(faults),
        }
    }

    /// Where the budget has each row, and its cells.
    pub fn rows(&self) -> impl Iterator<Item = WrittenRow<'_>> {
        self.rows.iter().map(|row| {
            let fields = row.fields.iter();
            let cells = fields.map(|(field, place)| field.cell(&|part| place.of(part)));
            (row.place.clone(), cells.collect())
        })
    }
}

fn incomplete(stated: &Stated<SeriesTable>) -> Fault {
    let missing = if stated.value.columns.is_none() {
        "columns"
    } else {
        "rows"
    };
    Fault::new(
        SERIES,
        stated.span.clone(),
        say!("the series has no `{missing}`"),
    )
    .label(say!("`{missing}` is missing"))
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
                Ok(DeValue::String(text)) => (Entry::Text(text.to_string()), DeValue::String(text)),
                Ok(value) if let Some(number) = number(&value) => (Entry::Number(number), value),
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
    match (plain.parse::<f64>().ok(), unit) {
        (Some(number), _) if !number.is_finite() => match is_infinity(&plain) {
            // As of degrees of freedom.
            true => Written::Value(plain),
            false => Written::Text(plain),
        },
        (Some(_), HeadUnit::Amounts(unit)) => Written::Text(format!("{plain} {unit}")),
        (Some(number), HeadUnit::Listed(conversion)) => {
            Written::Value(format!("{:?}", conversion.apply(number)))
        }
        // TOML has no +1, .5 and 5.: the shortest form of the number then.
        (Some(number), HeadUnit::OfBudget)
            if !is_toml_number(&plain) && DeValue::parse(&plain).is_err() =>
        {
            Written::Value(format!("{number:?}"))
        }
        // Whole numbers of TOML have 64 bits.
        (Some(_), HeadUnit::OfBudget) if is_long_whole(&plain) => {
            Written::Value(format!("{plain}.0"))
        }
        (Some(_), HeadUnit::OfBudget) => Written::Value(plain),
        (None, _) if field.starts_with('[') => Written::Value(unit.over(field)),
        // `0,1 %` beside `0,1`.
        (None, _) if comma && is_amount(&plain) && mend_of_number(field).is_none() => {
            Written::Text(plain)
        }
        (None, _) => Written::Text(field.to_owned()),
    }
}

/// Whether a text is a whole number that does not fit into 64 bits.
fn is_long_whole(text: &str) -> bool {
    let digits = text.strip_prefix(['+', '-']).unwrap_or(text);
    let is_whole = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
    is_whole && text.parse::<i64>().is_err()
}

/// Whether a text is the infinity of TOML.
fn is_infinity(text: &str) -> bool {
    text.strip_prefix(['+', '-']).unwrap_or(text) == "inf"
}

/// Whether a text is a number and a unit behind a blank.
fn is_amount(text: &str) -> bool {
    let parts = text.split_once(' ');
    parts.is_some_and(|(number, unit)| number.parse::<f64>().is_ok() && !unit.trim().contains(' '))
}

#[cfg(test)]
mod tests {
    use super::*;
    use toml::de::DeTable;

    fn budget(text: &str) -> DeTable<'_> {
        DeTable::parse(text).expect("TOML").into_inner()
    }

    /// A unit in the head holds for the members of a list as well: readings are converted, other numbers are amounts.
    #[test]
    fn lists_have_the_unit_of_their_head() {
        let table = "label;V.readings [mV];X.limits [mm]\na;[1_010, 1.5e3, 0x10];[-1, 2.5]\n";
        let sheet = Sheet::new(table).expect("a table");
        let budget = budget("[input]\nV = { unit = \"V\" }\nX = { unit = \"m\" }");
        let columns = Columns::of(&sheet, |_| 0..0, &Ground::of(&budget)).expect("columns");
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
    fn an_infinity_is_that_of_toml() {
        let sheet = Sheet::new("X,X.dof\ninf,inf\n1e400,-inf\n").expect("a table");
        let budget = budget("[input]\nX = {}");
        let columns = Columns::of(&sheet, |_| 0..0, &Ground::of(&budget)).expect("columns");
        let mut found = Vec::new();
        let visited = sheet.visit(|row| found.extend(columns.written(row, &sheet)));
        visited.expect("rows");
        let is_value = |field: &Written| matches!(field, Written::Value(_));
        let values: Vec<bool> = found.iter().map(is_value).collect();
        assert_eq!(values, [true, true, false, true]);
    }

    #[test]
    fn values_are_no_overloads_and_have_one_decimal_sign() {
        let named = Stated {
            value: "s.csv".to_owned(),
            span: 0..0,
            key: 0..0,
        };
        let refused = |text: &str| {
            let found = Points::of(text, &named, &Ground::of(&budget("")));
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
        let columns = Columns::of(&sheet, |_| 0..0, &Ground::of(&budget(""))).expect("columns");
        let row = sheet.rows().next().expect("a row").expect("fields");
        let written = columns.written(&row, &sheet);
        let texts: Vec<&str> = written.iter().map(Written::text).collect();
        assert_eq!(texts, ["10,5 V", "1.5", "0.1 %"]);
    }

    #[test]
    fn units_may_stand_below_the_names() {
        let text = "label,R,R.u,pH_s\n,kΩ,[Ω],\na,1.5,20,4\n";
        let sheet = Sheet::new(text).expect("names");
        let budget = budget("[input]\nR = {}\npH_s = {}");
        let ground = Ground::of(&budget);
        let sheet = sheet.above_units(ground.units());
        let columns = Columns::of(&sheet, |_| 0..0, &ground).expect("columns");
        let rows: Vec<_> = sheet.rows().map(|row| row.expect("fields")).collect();
        let written = columns.written(&rows[0], &sheet);
        let texts: Vec<&str> = written.iter().map(Written::text).collect();
        assert_eq!((rows.len(), rows[0].line), (1, 3));
        assert_eq!(texts, ["a", "1.5 kΩ", "20 Ω", "4"]);
    }
}
