//! Codes of the faults in a table.

use gumption_fault::codes;

codes! {
    UNREADABLE = "R0101", "a table cannot be read", "数据表无法读取",
        "The CSV file does not exist, is a folder or may not be read. Its path starts from the folder of the file that names it.";
    NOT_UTF8 = "R0102", "a table is in no known encoding", "数据表的编码无法识别",
        "Tables are CSV files in UTF-8, in UTF-16 with its mark, or in GBK. Programs that save a workbook (`.xlsx`) or text in another code page can export CSV in UTF-8 as well.";
    NO_HEADER = "R0103", "a table has no names of columns", "数据表没有列名",
        "The first line that is not empty and does not begin with `#` names the columns, with their units.\n\n    time [s],U [mV],T [°C]\n    0.00,12.034,22.91";
    NO_ROWS = "R0104", "a table has no rows", "数据表没有数据行",
        "There is nothing below the line of names.";
    SAME_NAME = "R0105", "two columns have the same name", "两列同名",
        "A column is asked for by its name, which must be its own. With its unit, or without: a name that two columns share without their units is to be written with the unit.";
    NO_COLUMN = "R0106", "a column is not in the table", "数据表中没有该列",
        "The columns are named in the first line. A column may be asked for by the whole text there, or by its name without the unit.";
    ROW_LENGTH = "R0107", "a row has more or fewer fields than the first line", "数据行的字段数与首行不一致",
        "A recorder that was stopped while it wrote leaves half a line; a decimal comma makes two fields out of one number. No row is padded or cut silently.";
    NOT_A_NUMBER = "R0108", "a field is not a number", "字段不是数值",
        "Numbers have a decimal point and no thousands separators: `1013.25`, `-2.5e-3`; where columns are separated by semicolons or tabs, a decimal comma is read too. In a recording, a missing value is an empty field, `NaN`, or 9.9E37 and more, which instruments write for a range that was exceeded; in a budget, every row has its number. Times are numbers in a unit such as s or h, or of the form `2026-03-01T09:00:01.25`, `01.03.2026 09:00:01` (with points the day goes first) or `09:00:01.25`; `3/1/2026` leaves open which is the month, `01.03.26` which is the year. All fields of a column are written alike, and all columns with the same decimal sign.";
    UNIT = "R0109", "the unit of a column is not known", "列的单位无法识别",
        "The unit stands in the header: `U [mV]`, `U (mV)`, `U（mV）`, `U/mV` or, for common units, `U_mV`. Square brackets hold nothing else.";
    NO_UNIT = "R0110", "the unit of a column is missing", "列缺少单位",
        "The quantity has a dimension, so its numbers need a unit, in the header (`U [mV]`) or in the file that names the column. No unit is ever assumed. An ending `_g` is not taken for a unit: gram and the acceleration of free fall (`gn`) are both written so.";
    UNIT_CLASH = "R0111", "the unit of a column does not fit", "列的单位不符",
        "The unit in the header is of another dimension than the quantity, or is another than the one stated for the column. A budget converts readings into the unit of their input.";
    TOO_LARGE = "R0112", "a table is too large", "数据表过大",
        "A table that a budget or an experiment names is kept in memory as a whole: its text, and each column that is asked for as numbers with all their decimals. What that takes is known from the length of the file and the number of its lines, and looked at before it is taken. `gumption batch` reads a table row by row.";
}

#[cfg(test)]
mod tests {
    #[test]
    fn codes_ascend() {
        assert!(super::CODES.windows(2).all(|pair| pair[0].id < pair[1].id));
    }
}
