//! Which rows and columns of a workbook in Open XML are hidden, which the reader of spreadsheets does not tell.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{Cursor, Read};

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use zip::ZipArchive;

/// What is hidden on a sheet, counted from 0.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Hidden {
    pub rows: BTreeSet<usize>,
    pub columns: BTreeSet<usize>,
}

/// By name of sheet; nothing for other workbooks.
pub(super) fn hidden(bytes: &[u8]) -> BTreeMap<String, Hidden> {
    let Ok(mut archive) = ZipArchive::new(Cursor::new(bytes)) else {
        return BTreeMap::new();
    };
    let mut part = |name: &str| -> String {
        let mut text = Vec::new();
        let read = archive
            .by_name(name)
            .ok()
            .map(|mut file| file.read_to_end(&mut text));
        read.map_or_else(String::new, |_| String::from_utf8_lossy(&text).into_owned())
    };
    let mut targets = BTreeMap::new();
    elements(&part("xl/_rels/workbook.xml.rels"), |element| {
        if let (Some(id), Some(target)) = (attribute(element, "Id"), attribute(element, "Target")) {
            targets.insert(id, target);
        }
    });
    let mut sheets = Vec::new();
    elements(&part("xl/workbook.xml"), |element| {
        if element.local_name().as_ref() == "sheet"
            && let (Some(name), Some(id)) = (attribute(element, "name"), attribute(element, "r:id"))
        {
            sheets.push((name, id));
        }
    });
    let of_sheet = |(name, id): (String, String)| {
        let target = targets.get(&id)?.trim_start_matches("/xl/").to_string();
        Some((name, of_part(&part(&format!("xl/{target}")))))
    };
    sheets.into_iter().filter_map(of_sheet).collect()
}

fn of_part(xml: &str) -> Hidden {
    let mut hidden = Hidden::default();
    elements(xml, |element| {
        let is_hidden = attribute(element, "hidden")
            .is_some_and(|value| matches!(value.as_str(), "1" | "true"));
        let number = |key: &str| attribute(element, key)?.parse::<usize>().ok();
        match element.local_name().as_ref() {
            "row" if is_hidden => hidden
                .rows
                .extend(number("r").and_then(|row| row.checked_sub(1))),
            "col" if is_hidden => {
                if let (Some(first), Some(last)) = (number("min"), number("max")) {
                    // Columns behind the last that a sheet can have are none.
                    hidden
                        .columns
                        .extend(first.saturating_sub(1)..last.min(16_384));
                }
            }
            _ => {}
        }
    });
    hidden
}

/// Every element of a document, as far as it is one.
fn elements(xml: &str, mut each: impl FnMut(&BytesStart<'_>)) {
    let mut reader = Reader::from_str(xml);
    while let Ok(event) = reader.read_event() {
        match event {
            Event::Start(element) | Event::Empty(element) => each(&element),
            Event::Eof => break,
            _ => {}
        }
    }
}

pub(super) fn attribute(element: &BytesStart<'_>, key: &str) -> Option<String> {
    let found = element.try_get_attribute(key).ok()??;
    Some(found.value.into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_and_columns_are_told() {
        let xml = r#"<worksheet><cols><col min="3" max="4" hidden="1"/><col min="6" max="6"/></cols>
            <sheetData><row r="1"/><row r="5" hidden="1"></row></sheetData></worksheet>"#;
        let found = of_part(xml);
        assert_eq!(found.columns, BTreeSet::from([2, 3]));
        assert_eq!(found.rows, BTreeSet::from([4]));
        assert!(hidden(b"no workbook").is_empty());
    }
}
