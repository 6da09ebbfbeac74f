//! The plots: their data in columns, and a chart of the spreadsheet's own for each panel.

use rust_xlsxwriter::{
    Chart, ChartFont, ChartFormat, ChartLine, ChartLineDashType, ChartMarker, ChartMarkerType,
    ChartSeries, ChartSolidFill, ChartType, Workbook, Worksheet, XlsxError,
};

use super::looks::Looks;
use super::names::Names;
use super::report::cut;
use gumption_fault::language::Language;
use gumption_format::document::{Axis, Bar, Document, Layer, Marks, Panel, Scale, Tone};

/// Rows of a chart on its sheet.
const HEIGHT: u32 = 18;

/// One sheet for each plot.
pub(super) fn plots(
    document: &Document,
    workbook: &mut Workbook,
    looks: &Looks,
    names: &mut Names,
) -> Result<(), XlsxError> {
    for plot in document.plots() {
        let title = plot.panels.first().map_or("", |panel| &panel.title);
        let name = names.like(title);
        let sheet = workbook.add_worksheet();
        sheet.set_name(&name)?;
        let mut data = Data {
            name: &name,
            sheet,
            looks,
            column: 0,
            language: document.language,
        };
        let mut charts = Vec::new();
        for panel in &plot.panels {
            charts.push(chart(panel, &mut data)?);
            data.column += 1;
        }
        let beside = data.column;
        for (chart, at) in charts.iter().zip(0u32..) {
            sheet.insert_chart(HEIGHT * at, beside, chart)?;
        }
    }
    Ok(())
}

/// Columns of a layer, each with its head.
fn columns(layer: &Layer, panel: &Panel) -> Vec<(String, Vec<Option<f64>>)> {
    let [across, up] = panel.limits();
    let values = |limits: [f64; 2], axis: &Axis| {
        limits.map(|place| match axis.scale {
            Scale::Linear => place,
            Scale::Logarithmic => libm::exp10(place),
        })
    };
    // Without the margin, which would stretch the axes of the spreadsheet.
    let tight = |[low, high]: [f64; 2]| {
        let margin = 0.05 / 1.1 * (high - low);
        [low + margin, high - margin]
    };
    let ends = values(tight(across), &panel.x);
    let heights = values(tight(up), &panel.y);
    let x = panel.x.label();
    let some = |numbers: Vec<f64>| -> Vec<Option<f64>> {
        numbers
            .into_iter()
            .map(|x| Some(x).filter(|x| x.is_finite()))
            .collect()
    };
    let name = |what: &str| match what {
        "" => layer.name.clone(),
        what => format!("{} {what}", layer.name),
    };
    match &layer.marks {
        Marks::Points(points) | Marks::Line(points) => vec![
            (x, some(points.iter().map(|[x, _]| *x).collect())),
            (name(""), some(points.iter().map(|[_, y]| *y).collect())),
        ],
        Marks::Band(band) | Marks::Whiskers(band) => vec![
            (x, some(band.iter().map(|[x, ..]| *x).collect())),
            (
                name("−"),
                some(band.iter().map(|[_, low, _]| *low).collect()),
            ),
            (
                name("+"),
                some(band.iter().map(|[.., high]| *high).collect()),
            ),
        ],
        Marks::Upright(at) => vec![(x, some(vec![*at; 2])), (name(""), some(heights.to_vec()))],
        // Bars have a chart of their own kind.
        Marks::Bars(_) => Vec::new(),
        Marks::Level(y) => vec![(x, some(ends.to_vec())), (name(""), some(vec![*y; 2]))],
    }
}

/// The numbers behind charts, in columns of their sheet.
struct Data<'a> {
    /// Of the sheet.
    name: &'a str,
    sheet: &'a mut Worksheet,
    looks: &'a Looks,
    /// The next one that is free.
    column: u16,
    /// Of the document.
    language: Language,
}

/// Where the numbers of a layer stand: those across in the first column, others in those behind it.
struct Written {
    first: u16,
    rows: u32,
}

impl Data<'_> {
    fn head(&mut self, text: &str) -> Result<(), XlsxError> {
        self.sheet
            .write_string_with_format(0, self.column, cut(text), &self.looks.head)?;
        Ok(())
    }

    /// Columns of a layer; places without a number are empty cells.
    fn curves(&mut self, columns: &[(String, Vec<Option<f64>>)]) -> Result<Written, XlsxError> {
        let first = self.column;
        for (head, numbers) in columns {
            self.head(head)?;
            self.sheet.set_column_width(self.column, 16)?;
            for (number, row) in numbers.iter().zip(1u32..) {
                if let Some(number) = number {
                    self.sheet.write_number(row, self.column, *number)?;
                }
            }
            self.column += 1;
        }
        let longest = columns.first().map_or(0, |(_, numbers)| numbers.len());
        Ok(written(first, longest))
    }

    /// The names of bars, and numbers of each.
    fn bars<const N: usize>(
        &mut self,
        heads: [&str; N],
        bars: &[Bar],
        numbers: impl Fn(&Bar) -> [f64; N],
    ) -> Result<Written, XlsxError> {
        let first = self.column;
        for head in std::iter::once("").chain(heads) {
            self.head(head)?;
            self.column += 1;
        }
        for (bar, row) in bars.iter().zip(1u32..) {
            self.sheet.write_string(row, first, cut(&bar.name))?;
            for (number, at) in numbers(bar).into_iter().zip(first + 1..) {
                if number.is_finite() {
                    self.sheet.write_number(row, at, number)?;
                }
            }
        }
        Ok(written(first, bars.len()))
    }

    /// A series of the numbers in the column `at`.
    fn series<'c>(
        &self,
        chart: &'c mut Chart,
        Written { first, rows }: &Written,
        at: u16,
    ) -> &'c mut ChartSeries {
        chart
            .add_series()
            .set_categories((self.name, 1, *first, *rows, *first))
            .set_values((self.name, 1, at, *rows, at))
    }
}

fn written(first: u16, rows: usize) -> Written {
    let rows = u32::try_from(rows).unwrap_or(0);
    Written { first, rows }
}

fn chart(panel: &Panel, data: &mut Data<'_>) -> Result<Chart, XlsxError> {
    let is_bars = |layer: &Layer| matches!(layer.marks, Marks::Bars(_));
    let bars = panel.layers.iter().filter(|layer| is_bars(layer)).count();
    let mut chart = Chart::new(match bars {
        0 => ChartType::Scatter,
        1 => ChartType::BarStacked,
        _ => ChartType::Bar,
    });
    let (mut series, mut unnamed) = (0, Vec::new());
    for layer in &panel.layers {
        match &layer.marks {
            Marks::Bars(own) if bars == 1 => stretches(&mut chart, layer, own, data)?,
            Marks::Bars(own) => lengths(&mut chart, layer, own, data)?,
            _ => {
                let drawn = curves(&mut chart, layer, &columns(layer, panel), data)?;
                // Help for the eye has no name, and what has two edges is named once.
                let named = usize::from(!layer.name.is_empty());
                unnamed.extend((series..series + drawn).skip(named));
                series += drawn;
            }
        }
    }
    let mut font = ChartFont::new();
    font.set_size(11);
    chart
        .title()
        .set_name(said(&panel.title).as_str())
        .set_font(&font);
    if bars > 0 {
        // The first bar on top.
        chart.y_axis().set_reverse();
        axis(chart.x_axis(), &panel.x);
    } else {
        axis(chart.x_axis(), &panel.x);
        axis(chart.y_axis(), &panel.y);
    }
    if bars == 1 {
        chart.legend().set_hidden();
    } else {
        chart
            .legend()
            .set_position(rust_xlsxwriter::ChartLegendPosition::Bottom)
            .delete_entries(&unnamed);
    }
    chart.set_width(720).set_height(20 * HEIGHT - 10);
    Ok(chart)
}

/// Points, lines and bands; how many series they are.
fn curves(
    chart: &mut Chart,
    layer: &Layer,
    columns: &[(String, Vec<Option<f64>>)],
    data: &mut Data<'_>,
) -> Result<usize, XlsxError> {
    let written = data.curves(columns)?;
    if written.rows == 0 {
        return Ok(0);
    }
    let series = columns.get(1..).unwrap_or_default();
    for ((head, _), at) in series.iter().zip(written.first + 1..) {
        let series = data.series(chart, &written, at);
        series.set_name(said(head).as_str());
        draw(series, layer);
    }
    Ok(series.len())
}

/// Bars from 0 beside those of other layers.
fn lengths(
    chart: &mut Chart,
    layer: &Layer,
    bars: &[Bar],
    data: &mut Data<'_>,
) -> Result<(), XlsxError> {
    let written = data.bars([&layer.name], bars, |bar| [bar.to])?;
    if written.rows > 0 {
        data.series(chart, &written, written.first + 1)
            .set_name(said(&layer.name).as_str())
            .set_gap(40)
            .set_format(&mut filled(colour(layer.tone)));
    }
    Ok(())
}

fn filled(colour: u32) -> ChartFormat {
    let mut format = ChartFormat::new();
    format.set_solid_fill(ChartSolidFill::new().set_color(colour));
    format
}

/// Bars from one number to another: the first part of each is not seen.
fn stretches(
    chart: &mut Chart,
    layer: &Layer,
    bars: &[Bar],
    data: &mut Data<'_>,
) -> Result<(), XlsxError> {
    let of_ends = data
        .language
        .pick(["from", "to", "start"], ["自", "至", "起点"]);
    let [from, to, start] = of_ends;
    let heads = [from, to, start, &layer.name];
    let written = data.bars(heads, bars, |bar| {
        let (low, high) = (bar.from.min(bar.to), bar.from.max(bar.to));
        [bar.from, bar.to, low, high - low]
    })?;
    if written.rows == 0 {
        return Ok(());
    }
    let mut unseen = ChartFormat::new();
    unseen.set_no_fill().set_no_line();
    let mut seen = filled(colour(layer.tone));
    for (at, format) in [(3, &mut unseen), (4, &mut seen)] {
        data.series(chart, &written, written.first + at)
            .set_gap(40)
            .set_format(format);
    }
    Ok(())
}

/// Words of a chart. Those that begin as a formula does would be one.
fn said(text: &str) -> String {
    let formula = text.starts_with('=');
    cut(&if formula {
        format!(" {text}")
    } else {
        text.to_string()
    })
}

fn axis(axis: &mut rust_xlsxwriter::ChartAxis, of: &Axis) {
    axis.set_name(said(&of.label()).as_str());
    if of.scale == Scale::Logarithmic {
        axis.set_log_base(10);
    }
}

fn colour(tone: Tone) -> u32 {
    match tone {
        Tone::Main => 0x0000_72B2,
        Tone::Contrast => 0x00D5_5E00,
        Tone::Quiet => 0x0044_4444,
    }
}

/// Points without lines, lines without points; told apart by shape and dashes too.
fn draw(series: &mut ChartSeries, layer: &Layer) {
    let colour = colour(layer.tone);
    let (shape, dashes) = match layer.tone {
        Tone::Main => (ChartMarkerType::Circle, ChartLineDashType::Solid),
        Tone::Contrast => (ChartMarkerType::Diamond, ChartLineDashType::Dash),
        Tone::Quiet => (ChartMarkerType::Circle, ChartLineDashType::RoundDot),
    };
    let mut marker = ChartMarker::new();
    let mut format = ChartFormat::new();
    match layer.marks {
        Marks::Points(_) => {
            marker.set_type(shape).set_size(5);
            marker.set_format(&mut filled(colour));
            format.set_no_line();
        }
        _ => {
            marker.set_none();
            let mut line = ChartLine::new();
            line.set_color(colour).set_width(1.5).set_dash_type(dashes);
            format.set_line(&line);
        }
    }
    series.set_marker(&marker).set_format(&mut format);
}
