//! Pictures of calibrations and plans: what is left of the readings, and what makes coefficients uncertain.

use gumption_fault::say;
use gumption_format::document::{Axis, Bar, Layer, Marks, Panel, Plot, Tone};
use gumption_lab::calibrate::{Calibration, Campaign, Figures};

use super::causes::cause_name;
use crate::language::Language;
use crate::symbol;

/// Coefficients that have bars.
const MOST_COEFFICIENTS: usize = 6;
/// Bars that a reader takes in.
const MOST_BARS: usize = 12;

/// The residuals of each response in the order of its readings, with their standard deviation.
pub(super) fn residuals(campaign: &Campaign, found: &Calibration, l: Language) -> Vec<Plot> {
    let declared = campaign.experiment.equations.responses();
    let responses = found.responses.iter().zip(declared).enumerate();
    // Where nothing is left over, what is left is rounding.
    let seen = responses.filter(|(_, (one, _))| one.dof > 0.0);
    let plots = seen.map(|(index, (one, quantity))| {
        let own = found.residuals.iter();
        let own = own.filter(|residual| residual.response == index);
        let points = own
            .zip(1u32..)
            .map(|(residual, number)| [f64::from(number), residual.observed - residual.fitted]);
        let points: Vec<[f64; 2]> = points.collect();
        let last = points.len() as f64;
        let mut layers = Vec::new();
        // Of readings with weights s is that of one of unit weight.
        if one.rms > 0.0 {
            let band = vec![[1.0, -one.rms, one.rms], [last, -one.rms, one.rms]];
            let name = l.pick("± RMS residual", "± 残差均方根");
            layers.push(Layer::new(name, Tone::Quiet, Marks::Band(band)));
        }
        layers.push(Layer::new("", Tone::Quiet, Marks::Level(0.0)));
        let name = l.pick("residuals", "残差");
        layers.push(Layer::new(name, Tone::Main, Marks::data(points)));
        let panel = Panel {
            title: say!("Residuals of {}", one.response).in_language(l),
            x: Axis::linear(l.pick("reading", "读数序号"), ""),
            y: Axis::linear(one.response.as_str(), symbol(&quantity.unit)),
            layers,
        };
        Plot::new(&format!("residuals_{}", one.response), vec![panel])
    });
    plots.collect()
}

/// What makes each of the first coefficients uncertain.
pub(super) fn contributions(figures: &Figures, l: Language) -> Vec<Plot> {
    let coefficients = figures.coefficients.iter().enumerate();
    let plots = coefficients
        .take(MOST_COEFFICIENTS)
        .filter_map(|(at, one)| {
            let bar = |name: String, to: f64| Bar {
                name,
                from: 0.0,
                to,
            };
            let budget = figures.budget(at);
            let causes = budget.iter().take(MOST_BARS);
            let mut bars: Vec<Bar> = causes
                .map(|part| bar(cause_name(part.cause, l), part.u))
                .collect();
            if bars.len() < 2 || !one.u.is_finite() {
                return None;
            }
            bars.push(bar(format!("u({})", one.name), one.u));
            let panel = Panel {
                title: say!("What makes {} uncertain", one.name).in_language(l),
                x: Axis::linear("u", symbol(&one.unit.difference())),
                y: Axis::linear("", ""),
                layers: vec![Layer::new("", Tone::Main, Marks::Bars(bars))],
            };
            Some(Plot::new(&format!("causes_{}", one.name), vec![panel]))
        });
    plots.collect()
}
