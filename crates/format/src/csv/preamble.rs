//! What loggers write above the names of the columns: the instrument, its serial number, settings.

/// The number of the line that names the columns where the first one does not, counted from 1: from it on all lines have as many
/// fields, two at least, which the first line has not, or leaves empty at its end, as spreadsheets fill up a title; it holds no
/// number, and the next one does.
pub(super) fn names_below(text: &str) -> Option<usize> {
    /// Lines that are looked at.
    const MOST: usize = 200;
    let is_row = |(_, line): &(usize, &str)| !line.trim().is_empty() && !line.starts_with('#');
    let lines: Vec<(usize, &str)> = text.lines().enumerate().filter(is_row).take(MOST).collect();
    // A separator within quotes separates nothing.
    if lines.iter().any(|(_, line)| line.contains('"')) {
        return None;
    }
    [';', '\t', ',']
        .into_iter()
        .find_map(|separator| names_by(separator, &lines))
}

fn names_by(separator: char, lines: &[(usize, &str)]) -> Option<usize> {
    let count = |line: &str| line.split(separator).count();
    let width = count(lines.last()?.1);
    let ends_filled = |line: &str| {
        line.rsplit(separator)
            .next()
            .is_some_and(|f| !f.trim().is_empty())
    };
    let is_whole = |line: &str| count(line) == width && ends_filled(line);
    let is_number = |field: &str| field.trim().replace(',', ".").parse::<f64>().is_ok();
    let has_number = |line: &str| line.split(separator).any(is_number);
    let is_head = |(_, line): &(usize, &str)| is_whole(line) && !has_number(line);
    let at = lines
        .iter()
        .position(is_head)
        .filter(|_| !is_whole(lines[0].1))?;
    let [(names, _), (_, row), ..] = lines.get(at..)? else {
        return None;
    };
    let is_table = lines[at..].iter().all(|(_, line)| count(line) == width);
    (width >= 2 && is_table && has_number(row)).then_some(names + 1)
}

#[cfg(test)]
mod tests {
    use super::super::sheet::Sheet;
    use super::*;

    #[test]
    fn lines_above_the_names_are_told_from_them() {
        let rows = "omega [deg/s];U [mV]\n-100;-200,1\n0;0,5\n";
        assert_eq!(
            names_below(&format!("Device: X\nSerial: 12\n\n{rows}")),
            Some(4)
        );
        let commas = "Device, X, 2\na [s],b [V]\n1,2\n3,4\n";
        assert_eq!(names_below(commas), Some(2));
        // As a spreadsheet saves a title.
        assert_eq!(
            names_below(&format!("Logger 12;\nSerial;\n;\n{rows}")),
            Some(4)
        );
        let wide = "Logger;12;\na;b;c\n1;2;3\n4;5;\n";
        assert_eq!(names_below(wide), Some(2));
        // Names in the first line, also above a line of units, and where a decimal comma makes two fields of one.
        for table in [
            rows,
            "a,b\ns,V\n1,2\n3,4\n",
            "a,b\n1,2,5\n2,3,5\n",
            "a\n1\n2\n",
            "",
        ] {
            assert_eq!(names_below(table), None, "{table}");
        }
        let fault = Sheet::new(&format!("# logger\nDevice: X\n{rows}")).expect_err("a fault");
        assert_eq!(
            fault.message.to_string(),
            "the names of the columns stand in line 3, not in the first line"
        );
    }
}
