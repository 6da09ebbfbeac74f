//! Tables of a batch as Apache Parquet, written by other programs (tests/data/parquet/make.py) and read by them.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use gumption::csv::{Cells, Columns, Sheet};
use gumption::render::parquet::Rows;

use crate::common::{self, Folder, root};

const BUDGET: &str = r#"
[measurand.I]
model = "V / R * (1 + drift)"
unit = "mA"
[input.V]
unit = "V"
components = [{ name = "repeatability", readings = [1, 1.1] }]
[input.R]
value = 100
unit = "ohm"
u = 0.1
[input.drift]
value = 0
u = 0.001
"#;

const KEPT: &str = "type,serial,date,time,good";

fn data(name: &str) -> PathBuf {
    root().join("tests/data/parquet").join(name)
}

/// A folder with the budget in it.
fn folder(name: &str) -> Folder {
    let folder = common::folder(name);
    folder.put("budget.toml", BUDGET);
    folder
}

fn batch(folder: &Path, table: &Path, more: &[&str]) -> Output {
    let mut program = crate::common::program();
    let program = program.current_dir(folder).args(["batch", "budget.toml"]);
    let run = program.arg(table).args(["--lang", "en"]).args(more);
    run.output().expect("the program runs")
}

/// The columns of a file, all of its pieces one behind the other, as texts.
fn texts(path: &Path) -> Vec<(String, Vec<String>)> {
    let rows = Rows::open(path, 7).expect("a table");
    let mut all: Vec<(String, Vec<String>)> = Vec::new();
    for piece in rows {
        let piece: Columns<'_> = piece.expect("rows");
        let head = piece.head();
        let names = Sheet::new(&head).expect("heads").header().clone();
        for (at, name) in names.fields().enumerate() {
            let cells = (0..piece.rows()).map(|row| piece.cells(at).text(row).into_owned());
            match all.get_mut(at) {
                Some((_, texts)) => texts.extend(cells),
                None => all.push((name.to_owned(), cells.collect())),
            }
        }
    }
    all
}

/// The columns of comma-separated values, as texts.
fn columns(csv: &str) -> Vec<(String, Vec<String>)> {
    let sheet = Sheet::new(csv).expect("a table");
    let names = sheet.header().fields().map(str::to_owned);
    let mut all: Vec<(String, Vec<String>)> = names.map(|name| (name, Vec::new())).collect();
    for row in sheet.rows() {
        let row = row.expect("a row");
        for ((_, texts), field) in all.iter_mut().zip(row.fields()) {
            texts.push(field.to_owned());
        }
    }
    all
}

#[test]
fn tables_of_other_programs_give_the_bits_of_csv() {
    let folder = folder("in");
    let more = ["--shares", "--contributions", "--keep", KEPT];
    let expected = batch(&folder, &data("devices.csv"), &more);
    let text = String::from_utf8(expected.stdout).expect("text");
    assert_eq!(expected.status.code(), Some(1), "some rows are faulty");
    assert!(
        text.lines().count() > 20 && text.contains("电阻0"),
        "{text}"
    );
    for name in ["pyarrow", "nanoseconds", "polars", "duckdb"] {
        let found = batch(&folder, &data(&format!("{name}.parquet")), &more);
        assert_eq!(String::from_utf8_lossy(&found.stdout), text, "{name}");
        assert_eq!(found.status, expected.status, "{name}");
    }
}

#[test]
fn results_hold_the_bits_of_csv() {
    let folder = folder("out");
    let ways: [&[&str]; 2] = [
        &["--shares", "--keep", KEPT],
        &["--monte-carlo", "--trials", "1000"],
    ];
    // Of the second, columns that set nothing are left out.
    let few = "V.repeatability.readings,R [kohm],R.u\n\"[1.0, 1.2]\",0.1,0.001\n\"[1.0, 1.3]\",,0.001\n\"[2.0, 1.3]\",0.2,0.001\n";
    std::fs::write(folder.join("few.csv"), few).expect("a file");
    for (more, table) in ways
        .into_iter()
        .zip([data("pyarrow.parquet"), folder.join("few.csv")])
    {
        let printed = batch(&folder, &table, more);
        let expected = columns(std::str::from_utf8(&printed.stdout).expect("text"));
        let written = batch(
            &folder,
            &table,
            &[more, &["--force", "-o", "out.parquet"]].concat(),
        );
        assert_eq!(written.status, printed.status);
        assert_eq!(written.stderr, printed.stderr);
        let found = texts(&folder.join("out.parquet"));
        assert_eq!(found.len(), expected.len());
        for ((name, found), (head, expected)) in found.iter().zip(&expected) {
            assert_eq!(name, head);
            for (row, (one, other)) in found.iter().zip(expected).enumerate() {
                let number = |text: &str| text.parse::<f64>().map(f64::to_bits);
                let same = one == other
                    || matches!((number(one), number(other)), (Ok(a), Ok(b)) if a == b);
                assert!(same, "{name} of row {row}: {one} and {other}");
            }
            assert_eq!(found.len(), expected.len(), "{name}");
        }
        by_pyarrow(&folder.join("out.parquet"), &printed.stdout);
    }
}

/// The results as another program reads them, where it is at hand.
fn by_pyarrow(path: &Path, csv: &[u8]) {
    const SCRIPT: &str = "
import csv, sys
try:
    from pyarrow import parquet
except ImportError:
    sys.exit(77)
table = parquet.read_table(sys.argv[1])
head, *rows = csv.reader(open(sys.argv[2], newline=''))
assert table.column_names == head
for at, name in enumerate(head):
    column = table[name].to_pylist()
    assert len(column) == len(rows)
    for one, row in zip(column, rows):
        text = row[at]
        assert (text == '') if one is None else (text == one if isinstance(one, str) else float(text) == one), (name, one, text)
";
    let expected = path.with_extension("csv");
    std::fs::write(&expected, csv).expect("a file");
    let own = root().join("target/python/bin/python");
    let python = if own.exists() {
        own
    } else {
        PathBuf::from("python3")
    };
    let run = Command::new(python)
        .args(["-c", SCRIPT])
        .arg(path)
        .arg(&expected)
        .output();
    match run {
        Ok(run) if run.status.code() == Some(77) => eprintln!("skipped: there is no pyarrow"),
        Ok(run) => assert!(
            run.status.success(),
            "{}",
            String::from_utf8_lossy(&run.stderr)
        ),
        Err(_) => eprintln!("skipped: there is no Python"),
    }
}

#[test]
fn many_rows_are_several_row_groups() {
    let folder = folder("many");
    let rows = 300_000;
    let mut table = String::from("R,R.u\n");
    for row in 0..rows {
        table += &format!("{}.5,0.{}\n", 100 + row % 977, 1 + row % 89);
    }
    std::fs::write(folder.join("many.csv"), table).expect("a file");
    let many = Path::new("many.csv");
    let csv = batch(&folder, many, &["-o", "one.csv"]);
    let parquet = batch(&folder, many, &["-o", "one.parquet"]);
    assert!(csv.status.success() && parquet.status.success());
    let expected = std::fs::read_to_string(folder.join("one.csv")).expect("results");
    let expected = columns(&expected);
    let found = texts(&folder.join("one.parquet"));
    assert_eq!(found.len(), expected.len());
    for ((name, found), (_, expected)) in found.iter().zip(&expected) {
        let numbers = |all: &[String]| {
            all.iter()
                .map(|one| one.parse::<f64>().map_or(0, f64::to_bits))
                .collect::<Vec<u64>>()
        };
        assert_eq!(found.len(), rows, "{name}");
        assert!(numbers(found) == numbers(expected), "{name}");
    }
    // And as a table of devices again: what has come through is what went in.
    let again = batch(
        &folder,
        Path::new("one.parquet"),
        &["--keep", "I [mA],label"],
    );
    assert_eq!(
        again.status.code(),
        Some(2),
        "u(I) is no place of the budget"
    );
}

#[test]
fn what_is_no_table_is_refused() {
    let folder = folder("none");
    let said = |name: &str| {
        let found = batch(&folder, &data(name), &[]);
        (
            found.status.code(),
            String::from_utf8_lossy(&found.stderr).into_owned(),
        )
    };
    let (code, why) = said("structure.parquet");
    assert!(code == Some(2) && why.contains("is a structure"), "{why}");
    let empty = batch(&folder, &data("empty.parquet"), &["--keep", KEPT]);
    assert_eq!(
        empty.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&empty.stderr)
    );
    let heads = std::fs::read_to_string(data("devices.csv")).expect("a table");
    let heads = heads.lines().next().expect("heads").to_owned() + "\n";
    std::fs::write(folder.join("heads.csv"), heads).expect("a file");
    let expected = batch(&folder, Path::new("heads.csv"), &["--keep", KEPT]);
    assert_eq!(empty.stdout, expected.stdout);
    std::fs::write(folder.join("text.parquet"), "R,R.u\n1,2\n").expect("a file");
    let found = batch(&folder, Path::new("text.parquet"), &[]);
    let why = String::from_utf8_lossy(&found.stderr);
    assert!(
        found.status.code() == Some(2) && why.contains("cannot be read as Parquet"),
        "{why}"
    );
}

/// Every damage ends in a fault, or in a table; never in a panic.
#[test]
fn damaged_files_are_no_end() {
    let whole = std::fs::read(data("pyarrow.parquet")).expect("a file");
    let folder = folder("damaged");
    let place = folder.join("damaged.parquet");
    let mut refused = 0;
    for at in (0..whole.len()).step_by(3) {
        let mut damaged = whole.clone();
        damaged[at] ^= 0x55;
        if at % 2 == 0 {
            damaged.truncate(at);
        }
        std::fs::write(&place, &damaged).expect("a file");
        let rows = Rows::open(&place, 7).map(|rows| {
            rows.map(|piece| piece.map(|one| one.rows()))
                .collect::<Result<Vec<_>, _>>()
        });
        refused += u32::from(!matches!(rows, Ok(Ok(_))));
    }
    assert!(refused > 100, "{refused}");
    let numbers = Rows::open(&data("pyarrow.parquet"), 1000)
        .expect("a table")
        .next();
    let numbers = numbers.expect("rows").expect("rows");
    assert!(matches!(numbers.cells(2), Cells::Numbers(all) if all.len() == 5));
}
