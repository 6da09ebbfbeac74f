//! The bytes of a table as text: UTF-8, UTF-16 as spreadsheets save “Unicode text”, or GBK.

use encoding_rs::{Decoder, DecoderResult, GBK, UTF_16BE, UTF_16LE, WINDOWS_1252};
use gumption_fault::{Said, say};

/// How a table was saved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// UTF-8, with or without its mark.
    Utf8,
    /// UTF-16 of either byte order, with its mark or plainly so.
    Utf16,
    /// The code of Chinese systems.
    Gbk,
}

/// Whole lines in the code of Chinese systems; nothing if they are not.
pub(super) fn gbk(bytes: &[u8]) -> Option<String> {
    let text = GBK.decode_without_bom_handling_and_without_replacement(bytes)?;
    Some(text.into_owned())
}

/// A table as text.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Decoded {
    /// Its text, without a mark of the encoding.
    pub text: String,
    /// How it was saved.
    pub encoding: Encoding,
}

/// Bytes that are text in none of the encodings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Undecodable {
    /// The first byte that is no UTF-8, the first of all being 1.
    pub byte: usize,
    /// Its line.
    pub line: usize,
}

/// Reads the bytes of a table.
///
/// GBK has no mark, and nearly every text of another code page is GBK too: `°C` of Western Europe would be one
/// Chinese character. So bytes are GBK where each pair is in the set of 1980, GB/T 2312, and at least half of them
/// are among its frequent characters, as they are in Chinese and in no European text.
///
/// # Errors
/// The bytes are text in none of the encodings.
pub fn decode(bytes: &[u8]) -> Result<Decoded, Undecodable> {
    if let Some((encoding, rest)) = utf16(bytes) {
        let text = encoding.decode_without_bom_handling_and_without_replacement(rest);
        return decoded(
            text.ok_or(Undecodable { byte: 1, line: 1 })?,
            Encoding::Utf16,
        );
    }
    let error = match std::str::from_utf8(bytes) {
        Ok(text) if !text.contains('\0') => {
            return decoded(text.trim_start_matches('\u{feff}').into(), Encoding::Utf8);
        }
        Ok(text) => text.find('\0').unwrap_or(0),
        Err(error) => error.valid_up_to(),
    };
    let gbk = is_chinese(bytes)
        .then(|| GBK.decode_without_bom_handling_and_without_replacement(bytes))
        .flatten();
    match gbk {
        Some(text) => decoded(text, Encoding::Gbk),
        None => Err(Undecodable {
            byte: error + 1,
            line: 1 + bytes[..error].iter().filter(|byte| **byte == b'\n').count(),
        }),
    }
}

/// Text in the code page of Western Europe, for readers that take sheets as they come: no byte contradicts it, since nearly every
/// one is a character there, but its letters beyond ASCII stand alone or in pairs, and none is followed by what would make it the
/// beginning of UTF-8. Words in Cyrillic or Greek letters and damaged UTF-8 are nothing of the kind.
pub fn western(bytes: &[u8]) -> Option<String> {
    let is_letter = |byte: &u8| *byte >= 0xc0 && !matches!(byte, 0xd7 | 0xf7);
    let is_run = bytes.windows(3).any(|three| three.iter().all(is_letter));
    let is_utf8 = |two: &[u8]| is_letter(&two[0]) && (0x80..=0xbf).contains(&two[1]);
    if bytes.contains(&0) || is_run || bytes.windows(2).any(is_utf8) {
        return None;
    }
    let text = WINDOWS_1252.decode_without_bom_handling_and_without_replacement(bytes)?;
    Some(with_line_feeds(text.into_owned()))
}

fn decoded(text: std::borrow::Cow<'_, str>, encoding: Encoding) -> Result<Decoded, Undecodable> {
    let text = with_line_feeds(text.into_owned());
    Ok(Decoded { text, encoding })
}

/// The byte order of UTF-16, and the text behind its mark. Without a mark it is plain where letters of ASCII fill a quarter of
/// the units and no zero stands among the other halves.
fn utf16(bytes: &[u8]) -> Option<(&'static encoding_rs::Encoding, &[u8])> {
    /// Bytes that are looked at.
    const BEGINNING: usize = 4096;
    match bytes {
        [0xff, 0xfe, rest @ ..] => return Some((UTF_16LE, rest)),
        [0xfe, 0xff, rest @ ..] => return Some((UTF_16BE, rest)),
        _ => {}
    }
    let beginning = &bytes[..bytes.len().min(BEGINNING)];
    let zeros = |parity: usize| {
        let half = beginning.iter().skip(parity).step_by(2);
        half.filter(|byte| **byte == 0).count()
    };
    match (zeros(0), zeros(1)) {
        (0, many) if 8 * many >= beginning.len() && many > 0 => Some((UTF_16LE, bytes)),
        (many, 0) if 8 * many >= beginning.len() && many > 0 => Some((UTF_16BE, bytes)),
        _ => None,
    }
}

/// Text in UTF-16 that comes in parts, as UTF-8.
pub(super) struct Wide(Decoder);

impl std::fmt::Debug for Wide {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.0.encoding().name())
    }
}

impl Wide {
    /// Of a text that begins with these bytes, from which the mark is taken; nothing if it is in another encoding.
    pub(super) fn of(beginning: &mut Vec<u8>) -> Option<Wide> {
        let (encoding, rest) = utf16(beginning)?;
        let mark = beginning.len() - rest.len();
        beginning.drain(..mark);
        Some(Wide(encoding.new_decoder_without_bom_handling()))
    }

    /// The next part as UTF-8; nothing where it is no text.
    pub(super) fn narrow(&mut self, part: &[u8], is_last: bool) -> Option<String> {
        let most = self
            .0
            .max_utf8_buffer_length_without_replacement(part.len());
        let mut text = String::with_capacity(most?);
        let decoded = self
            .0
            .decode_to_string_without_replacement(part, &mut text, is_last);
        matches!(decoded, (DecoderResult::InputEmpty, _)).then_some(text)
    }
}

/// Files with tables that are no text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NoText {
    Parquet,
    /// A workbook, or another archive.
    Workbook,
}

impl NoText {
    /// By the first bytes.
    pub(super) fn of(bytes: &[u8]) -> Option<NoText> {
        match bytes {
            [b'P', b'A', b'R', b'1', ..] => Some(NoText::Parquet),
            [b'P', b'K', 3, 4, ..] | [0xd0, 0xcf, 0x11, 0xe0, ..] => Some(NoText::Workbook),
            _ => None,
        }
    }

    /// How to make a table of text of it.
    pub(super) fn mend(self) -> Said {
        match self {
            NoText::Parquet => say!("it is Parquet: save it as CSV in UTF-8"),
            NoText::Workbook => {
                say!("it is a workbook or another archive: save the sheet as CSV in UTF-8")
            }
        }
    }
}

/// Whether bytes are text in UTF-16.
pub(crate) fn is_utf16(bytes: &[u8]) -> bool {
    utf16(bytes).is_some()
}

/// A text whose lines end as old Macs ended them, with a carriage return alone, with line feeds: every place stays where it is.
#[must_use]
pub(crate) fn with_line_feeds(text: String) -> String {
    match text.contains('\r') && !text.contains('\n') {
        true => text.replace('\r', "\n"),
        false => text,
    }
}

/// Whether all bytes beyond ASCII are pairs of GB/T 2312, half of them signs (rows 1 to 9) or characters of its
/// first level (rows 16 to 55). Signs that are in no row of it, such as `µ`, `²` and `⁻`, are four bytes of GB 18030,
/// two of which are digits: no text of another code page has digits between the bytes 81 to 84 and others beyond ASCII.
fn is_chinese(bytes: &[u8]) -> bool {
    let (mut characters, mut frequent) = (0, 0);
    let mut rest = bytes;
    while let Some(at) = rest.iter().position(|byte| *byte >= 0x80 || *byte == 0) {
        let (length, is_frequent) = match &rest[at..] {
            [0x81..=0x84, b'0'..=b'9', 0x81..=0xfe, b'0'..=b'9', ..] => (4, true),
            [lead @ 0xa1..=0xf7, 0xa1..=0xfe, ..] => (2, matches!(lead, 0xa1..=0xa9 | 0xb0..=0xd7)),
            _ => return false,
        };
        characters += 1;
        frequent += usize::from(is_frequent);
        rest = &rest[at + length..];
    }
    characters > 0 && 2 * frequent >= characters
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> Option<(String, Encoding)> {
        let decoded = decode(bytes).ok()?;
        Some((decoded.text, decoded.encoding))
    }

    #[test]
    fn what_spreadsheets_save() {
        let text = "电压 [mV]\n1.5\n";
        let known = |encoding| Some((text.to_owned(), encoding));
        assert_eq!(read(text.as_bytes()), known(Encoding::Utf8));
        let marked = format!("\u{feff}{text}");
        assert_eq!(read(marked.as_bytes()), known(Encoding::Utf8));
        let little: Vec<u8> = marked.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = marked.encode_utf16().flat_map(u16::to_be_bytes).collect();
        assert_eq!(read(&little), known(Encoding::Utf16));
        assert_eq!(read(&big), known(Encoding::Utf16));
        assert_eq!(read(&little[2..]), known(Encoding::Utf16));
        assert_eq!(read(&big[2..]), known(Encoding::Utf16));
        let old_mac = text.replace('\n', "\r");
        assert_eq!(read(old_mac.as_bytes()), known(Encoding::Utf8));
        let (gbk, _, _) = GBK.encode(text);
        assert_eq!(read(&gbk), known(Encoding::Gbk));
        let (signs, _, _) = GBK.encode("T [℃],R [Ω],±\n");
        assert_eq!(read(&signs).map(|read| read.1), Some(Encoding::Gbk));
        // Signs that GB/T 2312 does not have, alone and beside characters.
        for text in ["V [µV]\n1\n", "加速度 [m/s²],5.0×10⁻⁶\n"] {
            let (wide, _, _) = encoding_rs::GB18030.encode(text);
            assert_eq!(read(&wide), Some((text.to_owned(), Encoding::Gbk)));
        }
    }

    #[test]
    fn western_text_is_told_from_others() {
        for text in ["Größe [µm]; ±0,5 °C\n", "Tension à vide\n", "plain\n"] {
            let (bytes, _, _) = WINDOWS_1252.encode(text);
            assert_eq!(western(&bytes).as_deref(), Some(text));
        }
        let (cyrillic, _, _) = encoding_rs::WINDOWS_1251.encode("Величина;1\n");
        assert_eq!(western(&cyrillic), None);
        let mut damaged = "T [°C];µ\n".as_bytes().to_vec();
        damaged.push(0xb5);
        assert_eq!(western(&damaged), None);
        assert_eq!(western(b"a\0b"), None);
    }

    #[test]
    fn code_pages_of_europe_are_refused() {
        let latin = |text: &str| -> Vec<u8> { text.chars().map(|c| c as u8).collect() };
        for text in [
            "T [°C]\n1\n",
            "Größe [µm]\n1\n",
            "Tension à vide\n",
            "a\n±1\n",
        ] {
            assert!(decode(&latin(text)).is_err(), "{text}");
        }
        let error = decode(&latin("a,b\n1,2 °C\n")).expect_err("Latin-1");
        assert_eq!((error.byte, error.line), (9, 2));
        assert_eq!(NoText::of(b"PAR1\x15\x04"), Some(NoText::Parquet));
        assert_eq!(NoText::of(b"PK\x03\x04"), Some(NoText::Workbook));
        assert_eq!(NoText::of(b"PARAMETER,1\n"), None);
        // Zeros in both halves of the units.
        assert!(decode(b"a\0,\0b\0\n\0\0\0").is_err());
        assert!(decode(&[0xff, 0xfe, 0x00, 0xd8]).is_err());
    }
}
