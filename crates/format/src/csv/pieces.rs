//! A table in pieces of whole rows, so that its length does not matter.

use std::io::Read;

use ::csv::{ByteRecord, ReaderBuilder};
use memchr::{memchr, memchr_iter, memrchr};

use super::encoding::{Encoding, NoText, Wide, decode, gbk, with_line_feeds};
use super::faults::{NOT_UTF8, ROW_LENGTH, UNREADABLE};
use super::sheet::separator_of;
use gumption_fault::{Fault, say};

/// Bytes of a piece: far more than a row, and little beside the memory of a computer.
const PIECE: usize = 1 << 20;

/// Bytes of the longest row.
const LONGEST_ROW: usize = 1 << 24;

/// The pieces of a table, the first of which begins with the line of names.
#[derive(Debug)]
pub struct Pieces<R> {
    source: R,
    /// Read, and in no piece yet.
    rest: Vec<u8>,
    ended: bool,
    /// Makes UTF-8 of UTF-16, where the table was saved so.
    wide: Option<Wide>,
    /// How it was saved, as soon as a piece tells.
    encoding: Option<Encoding>,
    /// What separates the columns.
    separator: Option<u8>,
    /// Of the beginning of `rest`.
    line: usize,
    read: u64,
}

/// Some rows of a table.
#[derive(Debug)]
pub struct Piece {
    /// Their text.
    pub text: String,
    /// The line of the table with which it begins, the first being 1.
    pub line: usize,
}

impl<R: Read> Pieces<R> {
    /// Nothing is read yet.
    pub fn new(source: R) -> Pieces<R> {
        Pieces {
            source,
            rest: Vec::new(),
            ended: false,
            wide: None,
            encoding: None,
            separator: None,
            line: 1,
            read: 0,
        }
    }

    /// How many bytes were read so far.
    pub fn bytes_read(&self) -> u64 {
        self.read
    }

    fn piece(&mut self) -> Result<Option<Piece>, Box<Fault>> {
        let end = loop {
            if !self.ended {
                self.fill()?;
            }
            match self.whole_rows() {
                0 if !self.ended => {}
                end => break end,
            }
            if self.rest.len() > LONGEST_ROW {
                let line = self.line;
                let message = say!("line {line} does not end: a quote is open");
                return Err(Box::new(Fault::new(ROW_LENGTH, 0..0, message)));
            }
        };
        if end == 0 {
            return Ok(None);
        }
        let text = self.text(end)?;
        let line = self.line;
        self.line += memchr_iter(b'\n', text.as_bytes()).count();
        self.rest.drain(..end);
        Ok(Some(Piece { text, line }))
    }

    /// Reads as much as a piece has, beyond what is there.
    fn fill(&mut self) -> Result<(), Box<Fault>> {
        let read = (&mut self.source)
            .take(PIECE as u64)
            .read_to_end(&mut self.rest)
            .map_err(|error| {
                let message = say!("the table cannot be read further: {error}");
                Box::new(Fault::new(UNREADABLE, 0..0, message))
            })?;
        let is_first = self.read == 0;
        self.read += read as u64;
        self.ended = read < PIECE;
        if is_first {
            self.wide = Wide::of(&mut self.rest);
        }
        match &mut self.wide {
            Some(wide) => {
                let new = self.rest.len() - read.min(self.rest.len());
                let narrow = wide.narrow(&self.rest[new..], self.ended);
                let narrow = narrow.ok_or_else(|| undecodable(self.line))?;
                self.rest.truncate(new);
                self.rest.extend_from_slice(narrow.as_bytes());
                Ok(())
            }
            None => Ok(()),
        }
    }

    /// Where the last row begins, which may be incomplete; the end, if nothing follows.
    fn whole_rows(&mut self) -> usize {
        if self.ended {
            return self.rest.len();
        }
        // Without quotes every line is a row.
        let last = memrchr(b'\n', &self.rest).filter(|_| memchr(b'"', &self.rest).is_none());
        if let Some(last) = last {
            return last + 1;
        }
        let first = || separator_of(&String::from_utf8_lossy(&self.rest));
        let separator = *self.separator.get_or_insert_with(first);
        let mut reader = ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .comment(Some(b'#'))
            .delimiter(separator)
            .from_reader(self.rest.as_slice());
        let mut record = ByteRecord::new();
        let mut last = 0;
        loop {
            let start = reader.position().byte() as usize;
            match reader.read_byte_record(&mut record) {
                Ok(true) => last = start,
                _ => return last,
            }
        }
    }

    /// The bytes up to here as text.
    fn text(&mut self, end: usize) -> Result<String, Box<Fault>> {
        let bytes = &self.rest[..end];
        let refuse = |message, help| Err(Box::new(Fault::new(NOT_UTF8, 0..0, message).help(help)));
        if let Some(other) = NoText::of(bytes).filter(|_| self.line == 1) {
            let help = match other {
                NoText::Parquet => say!(
                    "it is Parquet: at the command line its name ends in .parquet, and the program has it built in; in Python read it with `pandas.read_parquet` or `pyarrow.parquet.read_table`, and give what comes"
                ),
                NoText::Workbook => other.mend(),
            };
            return refuse(say!("the table is no CSV"), help);
        }
        let undecodable = |line: usize| undecodable(self.line + line - 1);
        if self.encoding == Some(Encoding::Gbk) {
            return gbk(bytes)
                .map(with_line_feeds)
                .ok_or_else(|| undecodable(1));
        }
        let decoded = decode(bytes).map_err(|error| undecodable(error.line))?;
        match (self.encoding, decoded.encoding) {
            // What is cut at lines is no UTF-16 any more.
            (_, Encoding::Utf16) | (Some(Encoding::Utf8), Encoding::Gbk) => Err(undecodable(1)),
            (_, found) => {
                // Plain ASCII tells nothing.
                self.encoding = (!bytes.is_ascii()).then_some(found).or(self.encoding);
                Ok(decoded.text)
            }
        }
    }
}

/// What is no text from this line on.
fn undecodable(line: usize) -> Box<Fault> {
    let message = say!("the table is neither UTF-8, UTF-16 nor GBK in line {line}");
    Box::new(Fault::new(NOT_UTF8, 0..0, message).help(say!("save it as CSV in UTF-8")))
}

impl<R: Read> Iterator for Pieces<R> {
    type Item = Result<Piece, Box<Fault>>;

    fn next(&mut self) -> Option<Self::Item> {
        let piece = self.piece();
        // After a fault nothing can be found any more.
        if piece.is_err() {
            (self.ended, self.rest) = (true, Vec::new());
        }
        piece.transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::csv::{BadRow, Sheet};

    /// All rows of a table, with their lines, read in pieces.
    fn rows(bytes: &[u8]) -> Vec<(usize, Vec<String>)> {
        let pieces: Vec<Piece> = Pieces::new(bytes).map(Result::unwrap).collect();
        let first = Sheet::new(&pieces[0].text).unwrap();
        let below = |piece: &Piece| {
            let sheet = match piece.line {
                1 => first.clone(),
                line => first.below(&piece.text, line),
            };
            let row = |row: Result<crate::csv::Row, Box<BadRow>>| {
                let row = row.unwrap();
                (row.line, row.fields().map(str::to_owned).collect())
            };
            sheet.rows().map(row).collect::<Vec<_>>()
        };
        pieces.iter().flat_map(below).collect()
    }

    #[test]
    fn pieces_are_cut_between_rows() {
        let mut table = String::from("name;note\n");
        let note = "\"a;b\nc \"\"d\"\"\"";
        let count = 3 * PIECE / 16;
        for number in 0..count {
            table += &format!("{number};{note}\n");
        }
        assert!(table.len() > 3 * PIECE);
        let found = rows(table.as_bytes());
        assert_eq!(found.len(), count);
        for (number, (line, fields)) in found.iter().enumerate() {
            // A row has two lines.
            assert_eq!(*line, 2 + 2 * number);
            assert_eq!(*fields, [number.to_string(), "a;b\nc \"d\"".into()]);
        }
    }

    #[test]
    fn the_encoding_may_show_late() {
        let mut table = b"x,label\n".to_vec();
        while table.len() < 2 * PIECE {
            table.extend_from_slice(b"1,a\n");
        }
        let gbk = [b"2,".as_slice(), &[0xb5, 0xe7, 0xd1, 0xb9], b"\n"].concat();
        table.extend_from_slice(&gbk);
        let found = rows(&table);
        assert_eq!(found.last().unwrap().1, ["2", "电压"]);
        table.extend_from_slice(b"3,\xff\n");
        let last = Pieces::new(table.as_slice()).last().unwrap();
        assert_eq!(last.unwrap_err().code, NOT_UTF8);
    }

    #[test]
    fn text_in_utf_16_is_read_in_pieces() {
        let mut table = String::from("x,label\r\n");
        // A character of two units lies on the border of two pieces, a unit on another.
        while table.len() < 3 * PIECE {
            table.push_str("1,电压𝛀\r\n");
        }
        let expected = rows(table.as_bytes());
        let units = table.encode_utf16().collect::<Vec<_>>();
        let bytes = |order: fn(u16) -> [u8; 2], mark: &[u8]| {
            let units = units.iter().flat_map(|unit| order(*unit));
            mark.iter().copied().chain(units).collect::<Vec<u8>>()
        };
        assert_eq!(rows(&bytes(u16::to_le_bytes, &[0xff, 0xfe])), expected);
        assert_eq!(rows(&bytes(u16::to_be_bytes, &[0xfe, 0xff])), expected);
        let mut torn = bytes(u16::to_le_bytes, &[0xff, 0xfe]);
        torn.extend([0x00, 0xd8]);
        let last = Pieces::new(torn.as_slice()).last().unwrap();
        assert_eq!(last.unwrap_err().code, NOT_UTF8);
    }

    #[test]
    fn a_quote_that_is_left_open_is_a_fault() {
        let open = b"x\n\""
            .iter()
            .copied()
            .chain(std::iter::repeat_n(b'1', 2 * LONGEST_ROW));
        let open: Vec<u8> = open.collect();
        let last = Pieces::new(open.as_slice()).last().unwrap();
        assert_eq!(last.unwrap_err().code, ROW_LENGTH);
        assert!(Pieces::new(b"".as_slice()).next().is_none());
    }
}
