//! How cells look.

use rust_xlsxwriter::{Color, Format, FormatAlign, FormatBorder};

/// The looks of cells.
pub(super) struct Looks {
    pub title: Format,
    pub section: Format,
    pub head: Format,
    pub words: Format,
    /// Words that run over several lines.
    pub wrapped: Format,
    pub emphasis: Format,
    pub small: Format,
    pub given: Format,
    pub number: Format,
    /// The first row below a line across.
    pub ruled: Format,
}

impl Looks {
    pub(super) fn new() -> Looks {
        let plain = || Format::new().set_align(FormatAlign::Top);
        Looks {
            title: plain().set_bold().set_font_size(14),
            section: plain().set_bold().set_font_size(12),
            head: plain()
                .set_bold()
                .set_text_wrap()
                .set_border_bottom(FormatBorder::Thin),
            words: plain(),
            wrapped: plain().set_text_wrap(),
            emphasis: plain()
                .set_text_wrap()
                .set_bold()
                .set_border_left(FormatBorder::Thick),
            small: plain()
                .set_text_wrap()
                .set_font_size(9)
                .set_font_color(Color::RGB(0x0050_5050)),
            given: plain().set_background_color(Color::RGB(0x00FF_F2CC)),
            number: plain(),
            ruled: plain().set_border_top(FormatBorder::Thin),
        }
    }
}
