//! The picture of a verification: obtained against published, and how far apart in tolerances.

use gumption_format::document::{Axis, Layer, Marks, Panel, Plot, Tone};
use gumption_gum::propagate::Comparison;
use gumption_verify::{Row, Verification};

use crate::language::Language;

/// A figure in one of the layers.
struct Figure {
    published: f64,
    obtained: f64,
    /// (obtained − published)/tolerance.
    deviation: f64,
    kind: Kind,
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Agrees,
    Differs,
    Shown,
}

/// Every figure of the examples; nothing where there is none.
pub(super) fn figures(verification: &Verification, l: Language) -> Option<Plot> {
    let examples = verification.examples.iter();
    let figures = examples.flat_map(|example| example.figures());
    let figures: Vec<Figure> = figures.filter_map(|(row, one)| figure(row, one)).collect();
    (!figures.is_empty()).then(|| Plot {
        id: "verification".to_owned(),
        panels: vec![against(&figures, l), deviations(&figures, l)],
    })
}

fn figure(row: &Row, comparison: &Comparison) -> Option<Figure> {
    let difference = comparison.difference()?;
    Some(Figure {
        published: comparison.claimed.value,
        obtained: comparison.obtained?,
        deviation: difference / comparison.claimed.tolerance,
        kind: match (row.gates(comparison), comparison.agrees()) {
            (false, _) => Kind::Shown,
            (true, true) => Kind::Agrees,
            (true, false) => Kind::Differs,
        },
    })
}

/// A layer for each kind that there is, those that matter most above the others.
fn layers(
    kinds: &[Kind],
    figures: &[Figure],
    l: Language,
    place: impl Fn(usize, &Figure) -> [f64; 2],
) -> Vec<Layer> {
    let layers = kinds.iter().map(|kind| {
        let (name, tone) = match kind {
            Kind::Shown => (l.pick("not gating", "不作判据"), Tone::Quiet),
            Kind::Agrees => (l.pick("agrees", "一致"), Tone::Main),
            Kind::Differs => (l.pick("DIFFERS", "不一致"), Tone::Contrast),
        };
        let own = figures
            .iter()
            .enumerate()
            .filter(|(_, one)| one.kind == *kind);
        let points: Vec<[f64; 2]> = own.map(|(at, one)| place(at, one)).collect();
        (!points.is_empty()).then(|| Layer::new(name, tone, Marks::data(points)))
    });
    layers.flatten().collect()
}

/// Magnitudes, since figures of all units and sizes stand beside each other.
fn against(figures: &[Figure], l: Language) -> Panel {
    let sizes = figures.iter().map(|one| one.published.abs());
    let sizes = sizes.filter(|size| *size > 0.0 && size.is_finite());
    let [low, high] = sizes.fold([f64::INFINITY, 0.0], |[low, high], size| {
        [low.min(size), size.max(high)]
    });
    let name = l.pick("equal", "相等");
    let equal = Marks::Line(vec![[low, low], [high, high]]);
    let mut all = vec![Layer::new(name, Tone::Quiet, equal)];
    let kinds = [Kind::Shown, Kind::Agrees, Kind::Differs];
    all.extend(layers(&kinds, figures, l, |_, one| {
        [one.published.abs(), one.obtained.abs()]
    }));
    Panel {
        title: l
            .pick("Figures obtained against published", "计算值与发表值")
            .to_owned(),
        x: Axis::logarithmic(l.pick("|published|", "|发表值|"), ""),
        y: Axis::logarithmic(l.pick("|obtained|", "|计算值|"), ""),
        layers: all,
    }
}

/// Of the figures on which a verdict depends: others may be so far off that nothing else could be seen.
fn deviations(figures: &[Figure], l: Language) -> Panel {
    let all_shown = figures.iter().all(|one| one.kind == Kind::Shown);
    let kinds: &[Kind] = match all_shown {
        true => &[Kind::Shown],
        false => &[Kind::Agrees, Kind::Differs],
    };
    let name = l.pick("tolerance", "允差");
    let mut all = vec![
        Layer::new(name, Tone::Quiet, Marks::Level(1.0)),
        Layer::new("", Tone::Quiet, Marks::Level(-1.0)),
    ];
    all.extend(layers(kinds, figures, l, |at, one| {
        [(at + 1) as f64, one.deviation]
    }));
    Panel {
        title: l
            .pick("Deviations in units of the tolerance", "以允差为单位的偏差")
            .to_owned(),
        x: Axis::linear(l.pick("no. of the figure", "数值序号"), ""),
        y: Axis::linear(
            l.pick(
                "(obtained − published) / tolerance",
                "（计算值 − 发表值）/ 允差",
            ),
            "",
        ),
        layers: all,
    }
}
