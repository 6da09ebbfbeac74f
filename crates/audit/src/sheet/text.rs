//! Texts: separated values, Markdown tables, plain text.

use std::collections::BTreeMap;
use std::ops::Range;

use gumption_fault::say;
use gumption_format::csv::western;

use super::latex::plain;
use super::ruled::{has_rules, is_wide, widened};
use super::{Cell, Grid, Unreadable};

/// UTF-8, UTF-16 with its mark, GBK, or the code page of Western Europe.
pub(crate) fn decoded(bytes: &[u8]) -> Result<String, Unreadable> {
    match gumption_format::csv::decode(bytes) {
        Ok(decoded) => Ok(decoded.text),
        Err(at) => western(bytes).ok_or_else(|| {
            let line = at.line;
            Unreadable(say!(
                "line {line}: text in none of UTF-8, UTF-16, GBK and Windows-1252; save it as UTF-8"
            ))
        }),
    }
}

/// The separator is the one that most lines have in equal number; a text without any is one column.
pub(super) fn guessed(text: &str) -> Grid {
    if text.lines().filter(|line| is_markdown(line)).count() >= 2 {
        return markdown(text);
    }
    if has_rules(text) && !text.contains(['|', '\t']) {
        return aligned(&widened(text));
    }
    // Strokes between the cells, without any at the edges.
    if text
        .lines()
        .filter(|line| line.matches('|').count() >= 3)
        .count()
        >= 3
    {
        return separated(text, '|');
    }
    // The way of parting lines that gives most of them one number of columns; a comma may be inside numbers and sentences,
    // so that others come first where they do as well.
    let widths = |part: &dyn Fn(&str) -> usize| {
        let mut widths: Vec<usize> = text.lines().map(part).filter(|n| *n >= 3).collect();
        widths.sort_unstable();
        widths
            .chunk_by(|a, b| a == b)
            .map(|same| same.len())
            .max()
            .unwrap_or(0)
    };
    let separators = ['\t', ';', '|', ','];
    let mut best = (widths(&|line| aligned_fields(line).len()), None);
    for separator in separators.into_iter().rev() {
        if separator == ',' && !has_quoted_fields(text) && is_punctuation(text) {
            continue;
        }
        let count = widths(&|line| fields(line, separator).len());
        if count > 1 && count >= best.0 {
            best = (count, Some(separator));
        }
    }
    if let Some(table) = full_width(text, best.0) {
        return table;
    }
    match best.1.or_else(|| of_pairs(text)) {
        Some(separator) => separated(text, separator),
        None => aligned(text),
    }
}

/// What parts the lines of a list of names with their figures: two fields in most lines, and figures in most of the second.
fn of_pairs(text: &str) -> Option<char> {
    const FEWEST: usize = 3;
    let lines = || text.lines().filter(|line| !line.trim().is_empty());
    let parts = |separator: &char| {
        let pairs = lines().filter_map(|line| match fields(line, *separator).as_slice() {
            [_, figure] => Some(Cell::new(figure).figure().is_some()),
            _ => None,
        });
        let pairs: Vec<bool> = pairs.collect();
        let figures = pairs.iter().filter(|is_figure| **is_figure).count();
        figures >= FEWEST && 2 * figures > pairs.len() && 2 * pairs.len() > lines().count()
    };
    ['\t', ';', ','].into_iter().find(parts)
}

/// Separated values as an input method for Chinese writes them, with `，` or `；` between the fields and `“”` about them:
/// most lines that have the mark have five fields or more of one number. Sentences have fewer, and of many numbers.
fn full_width(text: &str, best: usize) -> Option<Grid> {
    const FIELDS: usize = 5;
    let plain = text.replace(['“', '”', '＂'], "\"");
    let of = |separator: char| {
        let counts = plain
            .lines()
            .filter(|line| line.contains(separator))
            .map(|line| fields(line, separator).len());
        let mut counts: Vec<usize> = counts.collect();
        counts.sort_unstable();
        let same = counts
            .chunk_by(|a, b| a == b)
            .filter(|same| same[0] >= FIELDS);
        let same = same.map(<[usize]>::len).max().unwrap_or(0);
        let is_table = same >= 3 && same > best && 2 * same > counts.len();
        is_table.then(|| separated(&plain, separator))
    };
    of('；').or_else(|| of('，'))
}

/// Whether several lines have a field in quotes with a comma in it: nothing but separated values has.
fn has_quoted_fields(text: &str) -> bool {
    let is_quoted = |line: &&str| {
        let mut quoted = line.split('"').skip(1).step_by(2);
        line.contains(",\"") && quoted.any(|field| field.contains(','))
    };
    text.lines().filter(is_quoted).count() >= 2
}

/// The lines that have as many commas as most lines with three fields or more: a title and a statement have commas of their own.
fn usual_lines(text: &str) -> impl Iterator<Item = &str> {
    let count = |line: &str| fields(line, ',').len();
    let mut counts: Vec<usize> = text.lines().map(count).filter(|n| *n >= 3).collect();
    counts.sort_unstable();
    let usual = counts.chunk_by(|a, b| a == b).max_by_key(|same| same.len());
    let usual = usual.map_or(0, |same| same[0]);
    text.lines().filter(move |line| count(line) == usual)
}

/// Whether commas are those of sentences and numbers, and part no fields: some have a blank behind them and some have
/// none, or all stand between digits.
fn is_punctuation(text: &str) -> bool {
    let (mut all, mut blank, mut inside) = (0_usize, 0_usize, 0_usize);
    for line in usual_lines(text) {
        let mut quoted = false;
        let mut before = ' ';
        let mut chars = line.chars().peekable();
        while let Some(c) = chars.next() {
            quoted ^= c == '"';
            if c == ',' && !quoted {
                let next = chars.peek().copied().unwrap_or(',');
                all += 1;
                blank += usize::from(next == ' ');
                inside += usize::from(before.is_ascii_digit() && next.is_ascii_digit());
            }
            before = c;
        }
    }
    let mixed = 10 * blank > all && blank < all;
    mixed || all > 0 && inside + blank == all && blank < all
}

fn is_markdown(line: &str) -> bool {
    let line = line.trim();
    line.starts_with('|') && line.matches('|').count() >= 3
}

/// Separated values; a quoted field may hold separators, doubled quotes and line breaks.
pub(super) fn separated(text: &str, separator: char) -> Grid {
    let mut rows: Vec<Vec<String>> = Vec::new();
    let mut open = String::new();
    let mut quotes = 0;
    for line in text.lines() {
        if !open.is_empty() {
            open.push('\n');
        }
        open.push_str(line);
        quotes += line.matches('"').count();
        if quotes.is_multiple_of(2) {
            // What stands below a table of strokes is parted by blanks.
            let parted = if separator == '|' && !open.contains('|') {
                aligned_fields(&open)
                    .into_iter()
                    .map(str::to_string)
                    .collect()
            } else {
                fields(&open, separator)
            };
            rows.push(parted);
            open.clear();
        }
    }
    if !open.is_empty() {
        rows.extend(
            open.lines()
                .map(|line| line.split(separator).map(str::to_string).collect()),
        );
    }
    let width = usual_width(&rows);
    let cells = rows.into_iter().map(|fields| {
        let fields = with_sentences(fields, separator, width);
        let cells = fields.iter();
        cells
            .map(|field| Cell::new(&field.replace('\n', " ")))
            .collect()
    });
    Grid {
        rows: cells.collect(),
        ..Grid::default()
    }
}

/// How many fields most lines of a table have.
fn usual_width(rows: &[Vec<String>]) -> usize {
    let count = |width: usize| rows.iter().filter(|fields| fields.len() == width).count();
    let widths = rows.iter().map(Vec::len).filter(|width| *width >= 3);
    widths.max_by_key(|width| count(*width)).unwrap_or(0)
}

/// The fields of a line; of one that has more than the others, what begins with a blank goes on with the sentence in front of it, whose
/// comma nobody put in quotes.
fn with_sentences(fields: Vec<String>, separator: char, width: usize) -> Vec<String> {
    let mut surplus = fields.len().saturating_sub(width);
    let mut out: Vec<String> = Vec::new();
    for field in fields {
        match out.last_mut() {
            Some(last)
                if separator == ','
                    && surplus > 0
                    && width > 0
                    && field.starts_with(' ')
                    && !field.trim().is_empty() =>
            {
                last.push(separator);
                last.push_str(&field);
                surplus -= 1;
            }
            _ => out.push(field),
        }
    }
    out
}

fn fields(line: &str, separator: char) -> Vec<String> {
    let mut fields = vec![String::new()];
    let (mut quoted, mut chars) = (false, line.chars().peekable());
    while let Some(c) = chars.next() {
        let empty = fields.last().is_some_and(|f| f.trim().is_empty());
        match c {
            '"' if quoted && chars.peek() == Some(&'"') => {
                chars.next();
                push(&mut fields, '"');
            }
            '"' if quoted || empty => quoted = !quoted,
            c if c == separator && !quoted => fields.push(String::new()),
            c => push(&mut fields, c),
        }
    }
    fields
}

fn push(fields: &mut [String], c: char) {
    if let Some(last) = fields.last_mut() {
        last.push(c);
    }
}

/// Markdown: tables row by row, other lines as rows of one cell without their marks.
pub(super) fn markdown(text: &str) -> Grid {
    const BLANKS: [&str; 4] = ["&nbsp;", "&emsp;", "&ensp;", "&thinsp;"];
    let text = BLANKS
        .iter()
        .fold(text.to_owned(), |text, blank| text.replace(blank, " "));
    let mut rows: Vec<Vec<Cell>> = Vec::new();
    let mut origins = BTreeMap::new();
    for (number, line) in text.lines().enumerate() {
        let line = line.trim();
        // The rule below a head is a line of the file and no row.
        let row = rows.len();
        let in_file = |column| ((row, column), (number, column));
        if !is_markdown(line) {
            let plain = line
                .trim_start_matches(['#', '>', ' '])
                .trim_start_matches("- ")
                .trim_start_matches("* ");
            rows.push(vec![Cell::new(&unmarked(plain))]);
            origins.extend([in_file(0)]);
            continue;
        }
        let inner = line.trim_start_matches('|');
        let inner = inner.strip_suffix('|').unwrap_or(inner);
        let rule = inner.chars().all(|c| "-:| ".contains(c)) && inner.contains("--");
        if !rule {
            let hidden = inner.replace("\\|", "\u{1}");
            let cells = hidden.split('|');
            let cells = cells.map(|field| Cell::new(&unmarked(&field.replace('\u{1}', "|"))));
            let cells: Vec<Cell> = cells.collect();
            origins.extend((0..cells.len()).map(in_file));
            rows.push(cells);
        }
    }
    Grid {
        rows,
        origins,
        ..Grid::default()
    }
}

fn unmarked(text: &str) -> String {
    let text = text.replace("**", "").replace('`', "");
    plain(&text.replace("<br>", " "))
}

/// Plain text whose columns are apart by two blanks or more.
fn aligned(text: &str) -> Grid {
    // A line of separated values without any separator may be quoted all the same.
    let bare = |line: &str| -> String {
        let quoted = line
            .trim()
            .strip_prefix('"')
            .and_then(|l| l.strip_suffix('"'));
        quoted.map_or(line.to_string(), |inner| inner.replace("\"\"", "\""))
    };
    let mut head: Vec<Span> = Vec::new();
    let row = |line: &str| -> Vec<Cell> {
        let line = bare(line);
        let spans = spans(&line);
        let fields = aligned_fields(&line).into_iter().map(Cell::new);
        let columns = under(&spans, &head);
        if spans.is_empty() || columns.is_none() && spans.len() >= head.len() {
            head = spans;
        }
        let Some(columns) = columns else {
            return fields.collect();
        };
        let mut cells = Vec::new();
        for (column, cell) in columns.into_iter().zip(fields) {
            cells.resize_with(column, || Cell::new(""));
            cells.push(cell);
        }
        cells
    };
    Grid {
        rows: text.lines().map(row).collect(),
        ..Grid::default()
    }
}

/// Where a field begins and ends: by letters, and by the columns of a terminal that they take.
#[derive(Clone)]
struct Span([Range<usize>; 2]);

fn spans(line: &str) -> Vec<Span> {
    let size = |text: &str| {
        let wide = text.chars().filter(|c| is_wide(*c)).count();
        let letters = text.chars().count();
        [letters, letters + wide]
    };
    let fields = aligned_fields(line).into_iter();
    let places = fields.map(|field| {
        let front = size(&line[..field.as_ptr() as usize - line.as_ptr() as usize]);
        let own = size(field);
        Span([0, 1].map(|how| front[how]..front[how] + own[how]))
    });
    places.collect()
}

/// Under which fields of the head of its block the fields of a line stand, where each stands under one: a cell may be empty.
fn under(spans: &[Span], head: &[Span]) -> Option<Vec<usize>> {
    if spans.len() < 2 || head.len() < 2 {
        return None;
    }
    // A long name may reach below the next head, of which the cell is empty.
    let begins = |how: usize| -> Option<Vec<usize>> {
        let is_head = |span: &Span, head: &Span| span.0[how].start == head.0[how].start;
        let column = |span: &Span| head.iter().position(|head| is_head(span, head));
        spans.iter().map(column).collect()
    };
    let below = |how: usize| -> Option<Vec<usize>> {
        let mut columns: Vec<usize> = Vec::new();
        for span in spans {
            let column = column_of(&span.0[how], head.iter().map(|head| &head.0[how]))?;
            // What stands behind the last head has columns of its own.
            let free = columns.last().map_or(0, |last| last + 1);
            columns.push(match column == head.len() {
                true => column.max(free),
                false => column,
            });
        }
        columns.is_sorted_by(|a, b| a < b).then_some(columns)
    };
    let has_gaps = spans.len() < head.len();
    let begins = [0, 1].into_iter().filter(|_| has_gaps).find_map(begins);
    // By letters and by columns of a terminal fields may stand under different heads: at the edges of the right ones.
    let edges = |how: usize, columns: &[usize]| {
        let mut fields = spans.iter().zip(columns);
        let is_at_edge = |(span, column): (&Span, &usize)| {
            let (own, head) = (&span.0[how], head.get(*column).map(|head| &head.0[how]));
            head.is_some_and(|head| own.start == head.start || own.end == head.end)
        };
        fields.by_ref().filter(|field| is_at_edge(*field)).count()
    };
    let below = [1, 0]
        .into_iter()
        .filter_map(|how| Some((how, below(how)?)));
    let below = below.max_by_key(|(how, columns)| edges(*how, columns));
    begins.or(below.map(|(_, columns)| columns))
}

/// The place of the only head above a field, or their number where it stands behind all of them.
fn column_of<'h>(
    field: &Range<usize>,
    heads: impl Iterator<Item = &'h Range<usize>> + Clone,
) -> Option<usize> {
    let is_above =
        |(_, head): &(usize, &Range<usize>)| head.start < field.end && field.start < head.end;
    let mut above = heads.clone().enumerate().filter(is_above);
    match (above.next(), above.next()) {
        (Some((column, _)), None) => Some(column),
        (None, _) if heads.clone().all(|head| head.end <= field.start) => Some(heads.count()),
        _ => None,
    }
}

fn aligned_fields(line: &str) -> Vec<&str> {
    line.split("  ")
        .map(str::trim)
        .filter(|part| !part.is_empty())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_separator_is_found() {
        let texts = |grid: &Grid, row: usize| -> Vec<String> {
            grid.rows[row].iter().map(|c| c.text.clone()).collect()
        };
        let commas = guessed("Title\nX,u,c\na,0.1,1\nb,\"0,2\",1\n");
        assert_eq!(texts(&commas, 3), ["b", "0,2", "1"]);
        let semicolons = guessed("X;u;c\na;0,1;1\nb;0,2;1\n");
        assert_eq!(texts(&semicolons, 1), ["a", "0,1", "1"]);
        let table = guessed("# Budget\n\n| X | u |\n|---|---|\n| a | 0.1 |\n");
        assert_eq!(texts(&table, 3), ["a", "0.1"]);
        let spaced = guessed("X      u     c\nlength l   0.1   1\n");
        assert_eq!(texts(&spaced, 1), ["length l", "0.1", "1"]);
        // Numbers end where their heads end, and cells are empty.
        let gaps = guessed(
            "Source      Shape         u      c     u_i\nV                       0.012  1.000   0.012\n  readings  t         0.010          0.010\nR           normal    0.003  2.000   0.006  #\n",
        );
        assert_eq!(texts(&gaps, 1), ["V", "", "0.012", "1.000", "0.012"]);
        assert_eq!(texts(&gaps, 2), ["readings", "t", "0.010", "", "0.010"]);
        assert_eq!(texts(&gaps, 3)[5], "#");
        // Chinese letters take two columns, by which a program aligns.
        let wide = guessed(
            "输入量   估计值  单位        u  概率分布   ν  灵敏系数 c   c·u  占比 %\n\
             a        4655.0           4.46  t (A)     14       1.000  4.46   -31.0\n\
             b       -0.4499        0.00506  t (A)     14        1200  6.08   131.0\n",
        );
        for (row, c) in [(1, "1.000"), (2, "1200")] {
            assert_eq!(texts(&wide, row)[2], "");
            assert_eq!(texts(&wide, row)[6], c);
        }
    }
}
