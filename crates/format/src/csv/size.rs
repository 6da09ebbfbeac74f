//! What a table takes of the machine, told before it is taken.

use gumption_fault::{Fault, Said, say};

use super::faults::TOO_LARGE;
use crate::files::MOST_BYTES;

/// The columns of a table take no more memory than this: half of what a machine of a laboratory has.
const MOST_MEMORY: u64 = 8 << 30;

/// Bytes of a row that each column keeps: a number, and its decimals in twice the precision.
const FIELD: u64 = 8 + 16;

/// Bytes of a row that stay whatever is asked for: the number of its line.
const LINE: u64 = 8;

/// # Errors
/// The file has more bytes than are read.
pub(super) fn fits_as_text(name: &str, bytes: u64) -> Result<(), Box<Fault>> {
    if bytes <= MOST_BYTES {
        return Ok(());
    }
    let (size, most) = (bytes.div_ceil(1 << 20), MOST_BYTES >> 20);
    Err(too_large(say!(
        "{name} has {size} MiB; a table that is kept as a whole has {most} MiB at most"
    )))
}

/// # Errors
/// So many columns of a table of this text take more memory than they may. Its lines are counted, which takes none.
pub(super) fn fits_as_columns(name: &str, text: &str, columns: usize) -> Result<(), Box<Fault>> {
    let rows = memchr::memchr_iter(b'\n', text.as_bytes()).count() as u64;
    let bytes = taken(rows, columns as u64);
    if bytes <= MOST_MEMORY {
        return Ok(());
    }
    let (taken, most) = (bytes.div_ceil(1 << 30), MOST_MEMORY >> 30);
    Err(too_large(say!(
        "{columns} columns of the {rows} rows of {name} take {taken} GiB of memory; at most {most} GiB are taken"
    )))
}

/// Bytes of so many columns of so many rows. Lists that grow have room for up to twice of what they hold.
fn taken(rows: u64, columns: u64) -> u64 {
    2 * rows * (LINE + columns * FIELD)
}

fn too_large(message: Said) -> Box<Fault> {
    let help = say!(
        "leave out the rows that tell nothing new, or average them in blocks; `gumption batch` takes a table of any length row by row"
    );
    Box::new(Fault::new(TOO_LARGE, 0..0, message).help(help))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ten_million_readings_fit_and_a_gibibyte_of_single_digits_does_not() {
        assert!(taken(10_000_000, 1) <= MOST_MEMORY);
        assert!(taken(10_000_000, 8) <= MOST_MEMORY);
        assert!(taken(MOST_BYTES / 2, 1) > MOST_MEMORY);
        assert!(fits_as_columns("a.csv", "x\n1\n2\n", 1).is_ok());
    }

    #[test]
    fn the_length_of_a_file_is_looked_at_before_it_is_read() {
        assert!(fits_as_text("a.csv", MOST_BYTES).is_ok());
        let fault = fits_as_text("a.csv", MOST_BYTES + 1).unwrap_err();
        assert_eq!(fault.code, TOO_LARGE);
        assert!(
            fault.message.to_string().contains("1025 MiB"),
            "{}",
            fault.message
        );
    }
}
