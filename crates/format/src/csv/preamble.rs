//! What loggers write above the names of the columns: the instrument, its serial number, settings.

/// The number of the line that names the columns where the first one does not, counted from 1: from it on all lines have as many
/// fields, two at least, which the first line has not; it holds no number, and the next one does.
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
    let others = lines.iter().rposition(|(_, line)| count(line) != width)?;
    let [(names, head), (_, row), ..] = lines.get(others + 1..)? else {
        return None;
    };
    let is_number = |field: &str| field.trim().replace(',', ".").parse::<f64>().is_ok();
    let has_number = |line: &str| line.split(separator).any(is_number);
    let is_below = width >= 2 && count(lines[0].1) != width;
    (is_below && !has_number(head) && has_number(row)).then_some(names + 1)
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
