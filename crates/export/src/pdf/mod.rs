//! A document as PDF/A-2u: pages of A4 with the fonts embedded, laid out from the blocks.

mod blocks;
mod flow;
mod fonts;
mod formula;
mod picture;
mod table;
mod text;

use krilla::SerializeSettings;
use krilla::color::rgb;
use krilla::configure::{Archival, ConfigurationBuilder};
use krilla::geom::{Path, PathBuilder, Point};
use krilla::metadata::{DateTime, Metadata};
use krilla::num::NormalizedF32;
use krilla::page::PageSettings;
use krilla::paint::{Fill, Stroke, StrokeDash};
use krilla::surface::Surface;
use krilla::text::{GlyphId, KrillaGlyph};

use gumption_core::calendar::Day;
use gumption_fault::language::Language;
use gumption_fault::say;
use gumption_format::document::{Block, Document};
use gumption_format::render::{Format, Page, Unfit};

use flow::{Colour, Flow, GREY, Op, PAGE, Pen, Step};
use fonts::{Fonts, Style};
use text::Letter;

/// The format.
pub const FORMAT: Format = Format {
    name: "pdf",
    about: "Write pages of A4 as PDF/A, with the fonts of the system embedded",
    ending: "pdf",
    media_type: "application/pdf",
    render,
};

fn render(document: &Document, _: &Page) -> Result<Vec<u8>, Unfit> {
    let fonts = Fonts::of_the_system().ok_or_else(|| {
        Unfit(say!(
            "no font for PDF was found: install DejaVu Sans, Noto Sans or Liberation Sans (apt install fonts-dejavu), or name a folder with one in GUMPTION_FONTS"
        ))
    })?;
    let mut flow = Flow::new(&fonts);
    blocks::lay(&mut flow, document);
    numbers(&mut flow, document.language);
    if flow.missing.0.iter().any(|c| text::is_chinese(*c)) {
        return Err(Unfit(say!(
            "no font with Chinese characters was found: install Noto Sans CJK (apt install fonts-noto-cjk), or name a folder with one in GUMPTION_FONTS"
        )));
    }
    written(document, &flow).map_err(|error| {
        let error = error.to_string();
        Unfit(say!("the pages cannot be written: {error}"))
    })
}

/// The number of each page, and of all.
fn numbers(flow: &mut Flow<'_>, language: Language) {
    let all = flow.pages.len();
    for at in 0..all {
        let n = at + 1;
        let words = language.pick(format!("{n} / {all}"), format!("第 {n} 页，共 {all} 页"));
        let letters = flow.plain(&words, Style::Regular, 8.0);
        let x = (PAGE[0] - text::width(&letters)) / 2.0;
        flow.pages[at].push(Op::Letters {
            at: [x, PAGE[1] - 30.0],
            letters,
            colour: GREY,
        });
    }
}

/// What went wrong while the file was put together.
struct Failure(String);

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

fn written(document: &Document, flow: &Flow<'_>) -> Result<Vec<u8>, Failure> {
    let told = |error: &dyn std::fmt::Debug| Failure(format!("{error:?}"));
    let configuration = ConfigurationBuilder::new()
        .with_archival_validator(Archival::A2_U)
        .finish()
        .map_err(|error| told(&error))?;
    let settings = SerializeSettings {
        configuration,
        ..SerializeSettings::default()
    };
    let mut pdf = krilla::Document::new_with(settings);
    let title = document.blocks().iter().find_map(|block| match block {
        Block::Title(title) => Some(title.clone()),
        _ => None,
    });
    pdf.set_metadata(
        Metadata::new()
            .title(title.unwrap_or_else(|| "gumption".into()))
            .language(document.language.pick("en", "zh-Hans").into())
            .creation_date(date(document))
            .creator(concat!("gumption ", env!("CARGO_PKG_VERSION")).into()),
    );
    for ops in &flow.pages {
        let settings = PageSettings::from_wh(PAGE[0], PAGE[1]);
        let settings = settings.ok_or_else(|| Failure("the size of the page".into()))?;
        let mut page = pdf.start_page_with(settings);
        let mut surface = page.surface();
        for op in ops {
            draw(&mut surface, flow.fonts, op);
        }
        surface.finish();
        page.finish();
    }
    pdf.finish().map_err(|error| told(&error))
}

/// The day on which a certificate is issued, else one that is always the same: no clock is read, so that the same document
/// gives the same bytes.
fn date(document: &Document) -> DateTime {
    const SOME_DAY: Day = Day {
        year: 2000,
        month: 1,
        day: 1,
    };
    let certificate = document.certificate.as_ref();
    let given = certificate.and_then(|one| one.administration.as_ref());
    let issued = given.and_then(|given| given.issued.as_deref());
    let day = issued.and_then(Day::read).unwrap_or(SOME_DAY);
    // Of four and of two digits.
    DateTime::new(day.year as u16)
        .month(day.month as u8)
        .day(day.day as u8)
        .hour(0)
        .minute(0)
        .second(0)
        .utc_offset_hour(0)
        .utc_offset_minute(0)
}

fn draw(surface: &mut Surface<'_>, fonts: &Fonts, op: &Op) {
    match op {
        Op::Letters {
            at,
            letters,
            colour,
        } => {
            surface.set_stroke(None);
            surface.set_fill(Some(fill(*colour, 1.0)));
            let mut x = at[0];
            let alike =
                |a: &Letter, b: &Letter| (a.face, a.size, a.rise) == (b.face, b.size, b.rise);
            for run in letters.chunk_by(alike) {
                let first = run[0];
                let start = Point::from_xy(x, at[1] - first.rise);
                let (glyphs, words) = glyphs(run);
                let font = fonts.faces[first.face].font.clone();
                surface.draw_glyphs(start, &glyphs, font, &words, first.size, false);
                x += run.iter().map(Letter::width).sum::<f32>();
            }
        }
        Op::Path {
            parts,
            fill: inside,
            stroke,
        } => {
            let Some(path) = path(parts) else {
                return;
            };
            surface.set_fill(inside.map(|(colour, opacity)| fill(colour, opacity)));
            surface.set_stroke(stroke.as_ref().map(pen));
            surface.draw_path(&path);
        }
    }
}

/// Glyphs with the text that they stand for.
fn glyphs(run: &[Letter]) -> (Vec<KrillaGlyph>, String) {
    let mut words = String::new();
    let glyphs = run.iter().map(|letter| {
        let start = words.len();
        words.push(match letter.character {
            '\u{ad}' => '-',
            other => other,
        });
        let glyph = GlyphId::new(letter.glyph);
        KrillaGlyph::new(
            glyph,
            letter.advance,
            0.0,
            0.0,
            0.0,
            start..words.len(),
            None,
        )
    });
    (glyphs.collect(), words)
}

fn fill([r, g, b]: Colour, opacity: f32) -> Fill {
    Fill {
        paint: rgb::Color::new(r, g, b).into(),
        opacity: NormalizedF32::new(opacity).unwrap_or(NormalizedF32::ONE),
        ..Fill::default()
    }
}

fn pen(pen: &Pen) -> Stroke {
    let [r, g, b] = pen.colour;
    let dash = (!pen.dashes.is_empty()).then(|| StrokeDash {
        array: pen.dashes.clone(),
        offset: 0.0,
    });
    Stroke {
        paint: rgb::Color::new(r, g, b).into(),
        width: pen.width,
        dash,
        ..Stroke::default()
    }
}

fn path(parts: &[Step]) -> Option<Path> {
    let mut builder = PathBuilder::new();
    for part in parts {
        match *part {
            Step::Move([x, y]) => builder.move_to(x, y),
            Step::Line([x, y]) => builder.line_to(x, y),
            Step::Curve([a, b], [c, d], [x, y]) => builder.cubic_to(a, b, c, d, x, y),
            Step::Close => builder.close(),
        }
    }
    builder.finish()
}
