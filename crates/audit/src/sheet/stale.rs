//! Formulas of a workbook held against the values that it keeps of them: a sheet that was changed and not computed again,
//! or of which a value was pasted over, says something else than it shows.

use crate::printed::Printed;

use super::{Cell, Grid, functions};

/// Notes in every cell of a workbook that its formula gives another figure than it holds.
pub(crate) fn mark(book: &mut [Grid]) {
    let sheets = 0..book.len();
    let all: Vec<Computed> = sheets
        .flat_map(|sheet| computed_cells(book, sheet))
        .collect();
    let is_exact = are_exact(&all);
    for cell in all.iter().filter(|cell| cell.is_stale(is_exact)) {
        let (sheet, row, column) = cell.at;
        book[sheet].rows[row][column].gives = Some(cell.gives.x);
    }
}

/// A cell with a formula that can be computed here.
struct Computed {
    at: (usize, usize, usize),
    /// The number that it holds, with the digits of its figure.
    held: Printed,
    /// What its formula gives of the cells that it names.
    gives: Value,
}

impl Computed {
    /// Whether it holds something else than its formula gives; of exact cells nothing is open.
    fn is_stale(&self, is_exact: bool) -> bool {
        let Value { x, open } = self.gives;
        let open = if is_exact { 0.0 } else { open };
        !self.held.is_met_within(x, self.held.half + open * x.abs())
    }
}

/// Whether the cells of a workbook hold all digits, as spreadsheets compute them: most formulas whose cells hold many give them.
fn are_exact(all: &[Computed]) -> bool {
    /// More digits than anybody types or rounds to.
    const MANY: usize = 9;
    /// Some units of the last place of a double.
    const LAST: f64 = 1e-13;
    let many = || all.iter().filter(|cell| cell.held.digits > MANY);
    let is_given = |cell: &&Computed| (cell.gives.x / cell.held.value - 1.0).abs() <= LAST;
    2 * many().filter(is_given).count() > many().count()
}

fn computed_cells(book: &[Grid], sheet: usize) -> Vec<Computed> {
    let grid = &book[sheet];
    let computed = |row: usize, column: usize| {
        let cell = grid.cell(row, column);
        let formula = cell.formula.as_ref()?;
        let held = held(cell)?;
        let gives = value(book, sheet, formula)?;
        // A figure in per cent is a hundred times its number.
        let figure = cell.figure()?;
        let scale = match figure.value == 0.0 {
            true => 1.0,
            false => held.x / figure.value,
        };
        let held = Printed {
            value: held.x,
            half: figure.half * scale.abs(),
            ..figure
        };
        let at = (sheet, row, column);
        Some(Computed { at, held, gives })
    };
    let rows = 0..grid.rows.len();
    let places = rows.flat_map(|row| (0..grid.rows[row].len()).map(move |column| (row, column)));
    places
        .filter_map(|(row, column)| computed(row, column))
        .collect()
}

/// What a formula on a sheet of a workbook gives, where it can be computed.
pub(super) fn computed(book: &[Grid], sheet: usize, formula: &str) -> Option<f64> {
    value(book, sheet, formula).map(|value| value.x)
}

/// What a formula gives, and how far, relatively, the digits of the cells that it names leave that open: other programs
/// than spreadsheets write cells rounded, and beside them results that are not.
#[derive(Debug, Clone, Copy)]
struct Value {
    x: f64,
    open: f64,
}

impl Value {
    fn exact(x: f64) -> Value {
        Value { x, open: 0.0 }
    }

    fn with(self, other: Value, x: f64) -> Value {
        let open = self.open + other.open;
        Value { x, open }
    }
}

/// The value of a formula of numbers, cells of its workbook, `+ - * / ^` and the functions of budgets; of others none.
fn value(book: &[Grid], sheet: usize, formula: &str) -> Option<Value> {
    // Functions that came later have this in front of them in the file.
    let text: String = formula
        .replace("_xlfn.", "")
        .chars()
        .filter(|c| !c.is_whitespace() && *c != '$')
        .collect();
    let mut reader = Reader {
        book,
        own: sheet,
        rest: &text,
        depth: 0,
    };
    let value = reader.sum()?;
    (reader.rest.is_empty() && value.x.is_finite()).then_some(value)
}

/// Cells of one sum: a budget has some hundred rows, and a file may name millions in each of a million formulas.
const MOST_SUMMED: usize = 1 << 12;

struct Reader<'t> {
    book: &'t [Grid],
    /// The sheet on which the formula stands.
    own: usize,
    rest: &'t str,
    depth: usize,
}

impl<'t> Reader<'t> {
    fn takes(&mut self, mark: char) -> bool {
        let rest = self.rest.strip_prefix(mark);
        self.rest = rest.unwrap_or(self.rest);
        rest.is_some()
    }

    fn sum(&mut self) -> Option<Value> {
        /// Brackets inside one another: deeper ones are no formula of a budget.
        const DEEPEST: usize = 32;
        self.depth += 1;
        if self.depth > DEEPEST {
            return None;
        }
        let mut sum = self.product()?;
        loop {
            let sign = match () {
                () if self.takes('+') => 1.0,
                () if self.takes('-') => -1.0,
                () => break,
            };
            let term = self.product()?;
            sum = sum.with(term, sum.x + sign * term.x);
        }
        self.depth -= 1;
        Some(sum)
    }

    fn product(&mut self) -> Option<Value> {
        let mut product = self.power()?;
        loop {
            if self.takes('*') {
                let factor = self.power()?;
                product = product.with(factor, product.x * factor.x);
            } else if self.takes('/') {
                let factor = self.power()?;
                product = product.with(factor, product.x / factor.x);
            } else {
                return Some(product);
            }
        }
    }

    fn power(&mut self) -> Option<Value> {
        // A spreadsheet squares `-2^2` with its sign.
        let sign = if self.takes('-') { -1.0 } else { 1.0 };
        let base = self.operand()?;
        let base = Value {
            x: sign * base.x,
            ..base
        };
        if !self.takes('^') {
            return Some(base);
        }
        let exponent = self.operand()?;
        let open = base.open * exponent.x.abs();
        Some(Value {
            x: libm::pow(base.x, exponent.x),
            open,
        })
    }

    fn operand(&mut self) -> Option<Value> {
        if self.takes('(') {
            let inner = self.sum()?;
            return self.takes(')').then_some(inner);
        }
        if self
            .rest
            .starts_with(|c: char| c.is_ascii_digit() || c == '.')
        {
            let end = self.rest.find(|c: char| !(c.is_ascii_digit() || c == '.'));
            return Some(Value::exact(self.word(end).parse().ok()?));
        }
        let sheet = self.sheet()?;
        let is_part = |c: char| c.is_ascii_alphanumeric() || c == '.';
        let end = self.rest.find(|c: char| !is_part(c));
        let name = self.word(end).to_ascii_uppercase();
        if self.takes('(') {
            return self.function(&name);
        }
        self.cell(sheet, &name)
    }

    /// The sheet that is named in front of a cell, `Inputs!B2` or `'Input data'!B2`, or that of the formula; none where it is
    /// not in the workbook.
    fn sheet(&mut self) -> Option<usize> {
        let quoted = self
            .rest
            .strip_prefix('\'')
            .and_then(|rest| rest.split_once("'!"));
        let is_part = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.');
        let plain = self
            .rest
            .split_once('!')
            .filter(|(name, _)| name.chars().all(is_part));
        let Some((name, behind)) = quoted.or(plain) else {
            return Some(self.own);
        };
        self.rest = behind;
        let compact = |name: &str| -> String {
            let letters = name.chars().filter(|c| !c.is_whitespace() && *c != '$');
            letters.flat_map(char::to_lowercase).collect()
        };
        let name = compact(name);
        self.book
            .iter()
            .position(|grid| compact(&grid.name) == name)
    }

    /// The text in front of a place, or all of it, which is then behind the reader.
    fn word(&mut self, end: Option<usize>) -> &'t str {
        let (word, rest) = self.rest.split_at(end.unwrap_or(self.rest.len()));
        self.rest = rest;
        word
    }

    fn function(&mut self, name: &str) -> Option<Value> {
        let all = match self.takes(')') {
            true => Vec::new(),
            false => self.list()?,
        };
        let arguments: Vec<f64> = all.iter().map(|value| value.x).collect();
        let x = functions::value(name, &arguments)?;
        let widest = |of: fn(&Value) -> f64| all.iter().map(of).fold(0.0, f64::max);
        let relative = widest(|value| value.open);
        let open = match name {
            "SQRT" => 0.5 * relative,
            "ABS" => relative,
            // A difference of readings has their digits.
            "STDEV" | "STDEV.S" => 2.0 * widest(|value| value.open * value.x.abs()) / x,
            // What is open may be rounded to the next figure.
            _ if name.starts_with("ROUND") && relative > 0.0 => {
                let places = arguments.last().map_or(0.0, |places| libm::exp10(-places));
                relative + places / x.abs()
            }
            // The widest of the parts is more than a sum can be off by.
            _ => 2.0 * relative,
        };
        Some(Value { x, open })
    }

    /// The arguments of a function: single ones, and ranges of cells.
    fn list(&mut self) -> Option<Vec<Value>> {
        let mut all = Vec::new();
        loop {
            let all_of_it = self.rest;
            let sheet = self.sheet()?;
            let end = self.rest.find([',', ')'])?;
            match self.rest[..end].split_once(':') {
                Some((first, last)) if !first.contains(['(', '+', '*']) => {
                    let (from, to) = (place(first)?, place(last)?);
                    let size = (to.0.checked_sub(from.0)? + 1) * (to.1.checked_sub(from.1)? + 1);
                    if size > MOST_SUMMED {
                        return None;
                    }
                    for row in from.0..=to.0 {
                        let grid = &self.book[sheet];
                        let cells = (from.1..=to.1).map(|column| grid.cell(row, column));
                        if cells.clone().any(Cell::lacks_value) {
                            return None;
                        }
                        all.extend(cells.filter_map(held));
                    }
                    self.rest = &self.rest[end..];
                }
                _ => {
                    self.rest = all_of_it;
                    all.push(self.sum()?);
                }
            }
            if self.takes(')') {
                return Some(all);
            }
            if !self.takes(',') {
                return None;
            }
        }
    }

    fn cell(&self, sheet: usize, name: &str) -> Option<Value> {
        let (row, column) = place(name)?;
        held(self.book[sheet].cell(row, column))
    }
}

/// The number with which formulas go on that name a cell: a text with a unit is none.
fn held(cell: &Cell) -> Option<Value> {
    let figure = cell.figure()?;
    let known = known(&figure);
    match cell.number {
        Some(x) => Some(Value { x, ..known }),
        None => figure.unit.is_empty().then_some(known),
    }
}

fn known(figure: &Printed) -> Value {
    // Whole numbers are exact.
    let open = match figure.half >= 0.5 || figure.value == 0.0 {
        true => 0.0,
        false => figure.relative_half(),
    };
    Value {
        x: figure.value,
        open,
    }
}

/// Row and column, from 0, of `B7`, as far as sheets go: `XFD1048576`.
fn place(name: &str) -> Option<(usize, usize)> {
    const ROWS: usize = 1 << 20;
    let letters = name.bytes().take_while(u8::is_ascii_alphabetic).count();
    let (column, row) = name.split_at(letters);
    let row: usize = row.parse().ok()?;
    let column = (1..=3).contains(&letters).then(|| {
        let place = |letter: u8| usize::from(letter.to_ascii_uppercase() - b'A') + 1;
        let letters = column.bytes();
        letters.fold(0, |column, letter| 26 * column + place(letter))
    })?;
    (1..=ROWS).contains(&row).then(|| (row - 1, column - 1))
}

#[cfg(test)]
mod tests {
    use super::super::shown;
    use super::*;

    #[test]
    fn formulas_of_budgets_have_values() {
        let row = |cells: &[&str]| cells.iter().map(|text| Cell::new(text)).collect();
        let grid = Grid {
            rows: vec![row(&["m", "30", "2"]), row(&["d", "40", "1"])],
            ..Grid::default()
        };
        let inputs = Grid {
            name: "Input data".into(),
            rows: vec![row(&["5"])],
            ..Grid::default()
        };
        let book = [grid, inputs];
        let of = |formula: &str| value(&book, 0, formula).map(|value| value.x);
        assert_eq!(of("'Input data'!A1*B1"), Some(150.0));
        assert_eq!(
            of("SQRT(SUMSQ('Input data'!$A$1:$A$1,B2))"),
            Some(1625f64.sqrt())
        );
        assert_eq!(of("B1/2"), Some(15.0));
        assert_eq!(of("SQRT(SUMSQ(B1:B2))"), Some(50.0));
        assert_eq!(of("SQRT($B$1^2+B2^2)*C1"), Some(100.0));
        assert_eq!(of("SUM(B1,B2,C1:C2)-1"), Some(72.0));
        assert_eq!(of("-2^2"), Some(4.0));
        assert_eq!(of("ROUND(2*SQRT(SUMSQ(B1:B2))/3,1)"), Some(33.3));
        assert_eq!(of("_xlfn.STDEV.S(B1,B2,B1+5)"), Some(5.0));
        assert_eq!(of("MAX(B1:B2)/COUNT(B1:B2)+PI()-PI()"), Some(20.0));
        assert!((of("B1/SQRT(3)").unwrap() - 17.320508).abs() < 1e-6);
        // A format in per cent, or with a unit, changes nothing of the number.
        let formats = Grid {
            rows: vec![vec![
                shown::cell(0.002, Some("0.200%")),
                shown::cell(0.056, Some("0.056 mm")),
                Cell::new("0.3 mm"),
            ]],
            ..Grid::default()
        };
        let of_formats =
            |formula: &str| value(std::slice::from_ref(&formats), 0, formula).map(|value| value.x);
        assert_eq!(of_formats("A1/2"), Some(0.001));
        assert_eq!(of_formats("SUM(A1:C1)"), Some(0.058));
        assert_eq!(of_formats("C1*2"), None);
        for strange in ["A1", "Other!B1", "IF(B1>1,2,3)", "B1+", "\"a\"", "((((B1"] {
            assert_eq!(of(strange), None, "{strange}");
        }
        assert_eq!(of(&"(".repeat(5000)), None);
        // Cells beyond every sheet.
        assert_eq!(of(&format!("{}1", "Z".repeat(40))), None);
        for last in [
            "B9223372036854775809",
            "B18446744073709551615",
            "ZZZ1048576",
        ] {
            assert_eq!(of(&format!("SUM(A1:{last})")), None, "{last}");
        }
    }
}
