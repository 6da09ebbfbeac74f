//! The pictures of a document: files of the package, and where they stand in the text.

use gumption_format::document::Plot;
use gumption_format::render::drawing::Drawing;

use super::emf::emf;
use super::parts::WIDTH;
use crate::archive::Member;
use crate::xml::{Element, element};

const DRAWING: &str = "http://schemas.openxmlformats.org/drawingml/2006";

/// The pictures so far.
#[derive(Default)]
pub(super) struct Pictures {
    files: Vec<Vec<u8>>,
}

/// The relation by which the text names a picture; styles and footer have the first two.
fn relation(number: usize) -> String {
    format!("rId{}", number + 2)
}

/// Where a picture stands beside the main part.
fn target(number: usize) -> String {
    format!("media/picture{number}.emf")
}

impl Pictures {
    /// The relations of the text to them: names and files.
    pub fn relations(&self) -> impl Iterator<Item = [String; 2]> {
        (1..=self.files.len()).map(|number| [relation(number), target(number)])
    }

    /// Them as files of the package.
    pub fn members(self) -> impl Iterator<Item = Member> {
        let numbered = self.files.into_iter().zip(1..);
        numbered.map(|(file, number)| (format!("word/{}", target(number)), file))
    }

    /// A paragraph for each panel of a plot.
    pub fn of(&mut self, plot: &Plot) -> Vec<Element> {
        let panels = Drawing::of_panels(plot).into_iter();
        panels.map(|drawing| self.paragraph(&drawing)).collect()
    }

    fn paragraph(&mut self, drawing: &Drawing) -> Element {
        self.files.push(emf(drawing));
        let number = self.files.len();
        /// English metric units of a twentieth of a point.
        const UNITS: f64 = 635.0;
        /// Most of the height of a page, in twentieths of a point.
        const HEIGHT: f64 = 12_500.0;
        let [width, height] = drawing.size;
        let scale = (f64::from(WIDTH) / width).min(HEIGHT / height) * UNITS;
        let size = [width, height].map(|side| format!("{:.0}", side * scale));
        let extent = |name: &'static str| {
            let [width, height] = size.clone();
            element(name).attribute("cx", width).attribute("cy", height)
        };
        let named = |name: &'static str| {
            element(name)
                .attribute("id", number.to_string())
                .attribute("name", format!("Picture {number}"))
                .attribute("descr", drawing.title.as_str())
        };
        let file = element("a:blip").attribute("r:embed", relation(number));
        let stretched = element("a:stretch").with(element("a:fillRect"));
        let origin = element("a:off").attribute("x", "0").attribute("y", "0");
        let shape = element("pic:spPr")
            .with(element("a:xfrm").with(origin).with(extent("a:ext")))
            .with(
                element("a:prstGeom")
                    .attribute("prst", "rect")
                    .with(element("a:avLst")),
            );
        let picture = element("pic:pic")
            .attribute("xmlns:pic", format!("{DRAWING}/picture"))
            .with(
                element("pic:nvPicPr")
                    .with(named("pic:cNvPr"))
                    .with(element("pic:cNvPicPr")),
            )
            .with(element("pic:blipFill").with(file).with(stretched))
            .with(shape);
        let graphic = element("a:graphic")
            .attribute("xmlns:a", format!("{DRAWING}/main"))
            .with(
                element("a:graphicData")
                    .attribute("uri", format!("{DRAWING}/picture"))
                    .with(picture),
            );
        let mut inline =
            element("wp:inline").attribute("xmlns:wp", format!("{DRAWING}/wordprocessingDrawing"));
        for side in ["distT", "distB", "distL", "distR"] {
            inline = inline.attribute(side, "0");
        }
        let inline = inline
            .with(extent("wp:extent"))
            .with(named("wp:docPr"))
            .with(graphic);
        let run = element("w:r").with(element("w:drawing").with(inline));
        element("w:p").with(run)
    }
}
