//! Plots as data: what is drawn over what, with quantities and units. How they look is the renderer's.

/// A figure of one or several panels, one below the other.
#[derive(Debug, Clone, PartialEq)]
pub struct Plot {
    /// Name by which the plot is known, fit for a file.
    pub id: String,
    /// What it shows.
    pub panels: Vec<Panel>,
}

/// One pair of axes with what is drawn in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// What it shows.
    pub title: String,
    /// Across.
    pub x: Axis,
    /// Upwards.
    pub y: Axis,
    /// What is drawn, the first below the others.
    pub layers: Vec<Layer>,
}

/// A quantity along an edge.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Axis {
    /// The quantity.
    pub quantity: String,
    /// Its unit as printed; empty for one.
    pub unit: String,
    /// How values become places.
    pub scale: Scale,
}

/// How values become places along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Equal differences are equal lengths.
    Linear,
    /// Equal ratios are equal lengths.
    Logarithmic,
}

/// Marks of one kind.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// What they stand for.
    pub name: String,
    /// How much they stand out.
    pub tone: Tone,
    /// The data.
    pub marks: Marks,
}

/// How much a layer stands out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tone {
    /// What the plot is about.
    Main,
    /// What it is to be told apart from.
    Contrast,
    /// Help for the eye.
    Quiet,
}

/// Data of a layer, in the units of the axes.
#[derive(Debug, Clone, PartialEq)]
pub enum Marks {
    /// Single points x, y.
    Points(Vec<[f64; 2]>),
    /// A line through points x, y.
    Line(Vec<[f64; 2]>),
    /// A band: x, lower y, upper y.
    Band(Vec<[f64; 3]>),
    /// A line across at one y.
    Level(f64),
    /// A line upright at one x.
    Upright(f64),
    /// Upright lines with ends: x, lower y, upper y.
    Whiskers(Vec<[f64; 3]>),
    /// Bars along x, one below the other from the top, in a panel of their own. The bars of several layers lie beside
    /// each other by their order; those begin at 0, and one without an end is absent.
    Bars(Vec<Bar>),
}

/// A bar with its name.
#[derive(Debug, Clone, PartialEq)]
pub struct Bar {
    /// What it is.
    pub name: String,
    /// Where it begins.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
}

impl Plot {
    /// What is neither letter nor digit of an id is an underscore.
    pub fn new(id: &str, panels: Vec<Panel>) -> Self {
        let plain = |c: char| if c.is_alphanumeric() { c } else { '_' };
        Plot {
            id: id.chars().map(plain).collect(),
            panels,
        }
    }
}

impl Layer {
    /// What marks stand for, and how much they stand out.
    pub fn new(name: impl Into<String>, tone: Tone, marks: Marks) -> Self {
        Layer {
            name: name.into(),
            tone,
            marks,
        }
    }
}

impl Axis {
    /// A linear axis.
    pub fn linear(quantity: impl Into<String>, unit: impl Into<String>) -> Self {
        Axis::scaled(quantity, unit, Scale::Linear)
    }

    /// A logarithmic axis.
    pub fn logarithmic(quantity: impl Into<String>, unit: impl Into<String>) -> Self {
        Axis::scaled(quantity, unit, Scale::Logarithmic)
    }

    fn scaled(quantity: impl Into<String>, unit: impl Into<String>, scale: Scale) -> Self {
        Axis {
            quantity: quantity.into(),
            unit: unit.into(),
            scale,
        }
    }

    /// `quantity / unit`; a compound unit in parentheses (ISO 80000-1, 7.1.4), nothing for dimension one.
    pub fn label(&self) -> String {
        match self.unit.as_str() {
            "" => self.quantity.clone(),
            unit if unit.contains(['/', '·', ' ']) => format!("{} / ({unit})", self.quantity),
            unit => format!("{} / {unit}", self.quantity),
        }
    }

    /// Place of a value, where it has one on this axis.
    pub fn place(&self, value: f64) -> Option<f64> {
        let place = match self.scale {
            Scale::Linear => value,
            Scale::Logarithmic => libm::log10(value),
        };
        place.is_finite().then_some(place)
    }
}

/// Points of data that are drawn one by one.
const MOST_POINTS: usize = 4000;
/// Stretches across of which the ends are drawn where there are more: a printed panel has no more places side by side.
const STRETCHES: usize = 1000;

impl Marks {
    /// Points of data. Of very many the lowest and the highest of each stretch across stand for the others: no file
    /// grows with the recording, and no reading that lies apart is lost.
    pub fn data(points: Vec<[f64; 2]>) -> Self {
        if points.len() <= MOST_POINTS {
            return Marks::Points(points);
        }
        let places = points.iter().map(|[x, _]| *x).filter(|x| x.is_finite());
        let [from, to] = places.fold([f64::INFINITY, f64::NEG_INFINITY], |[from, to], x| {
            [from.min(x), to.max(x)]
        });
        let mut ends: Vec<Option<[[f64; 2]; 2]>> = vec![None; STRETCHES];
        for point in points {
            let share = (point[0] - from) / (to - from) * STRETCHES as f64;
            // Without any extent all stand in the first; a point without a place has none.
            let stretch = if to > from { share } else { 0.0 };
            let last = STRETCHES - 1;
            if let Some(end) = ends
                .get_mut((stretch as usize).min(last))
                .filter(|_| point[0].is_finite())
            {
                let [low, high] = end.unwrap_or([point; 2]);
                *end = Some([
                    if point[1] < low[1] { point } else { low },
                    if point[1] > high[1] { point } else { high },
                ]);
            }
        }
        let drawn = ends
            .into_iter()
            .flatten()
            .flat_map(|[low, high]| std::iter::once(low).chain((low != high).then_some(high)));
        Marks::Points(drawn.collect())
    }

    /// Whether it is a band of columns that begin at 0.
    fn stands_on_zero(&self) -> bool {
        matches!(self, Marks::Band(band) if !band.is_empty() && band.iter().all(|[_, low, _]| *low == 0.0))
    }

    /// Every point x, y that must be inside the panel; x is absent or y is absent where the marks have none of their own.
    pub fn extent(&self) -> Vec<(Option<f64>, Option<f64>)> {
        match self {
            Marks::Points(points) | Marks::Line(points) => {
                points.iter().map(|[x, y]| (Some(*x), Some(*y))).collect()
            }
            Marks::Band(band) | Marks::Whiskers(band) => band
                .iter()
                .flat_map(|[x, low, high]| [(Some(*x), Some(*low)), (Some(*x), Some(*high))])
                .collect(),
            Marks::Level(y) => vec![(None, Some(*y))],
            Marks::Upright(x) => vec![(Some(*x), None)],
            Marks::Bars(bars) => bars
                .iter()
                .flat_map(|bar| [(Some(bar.from), None), (Some(bar.to), None)])
                .collect(),
        }
    }
}

impl Panel {
    /// The bars, where that is what the panel shows.
    pub fn bars(&self) -> impl Iterator<Item = &Bar> {
        self.groups().into_iter().flatten().map(|(_, bar)| bar)
    }

    /// The bars that lie beside each other and bear the name of the first, each with its layer.
    pub fn groups(&self) -> Vec<Vec<(&Layer, &Bar)>> {
        let mut groups: Vec<Vec<(&Layer, &Bar)>> = Vec::new();
        for layer in &self.layers {
            if let Marks::Bars(bars) = &layer.marks {
                groups.resize_with(groups.len().max(bars.len()), Vec::new);
                for (group, bar) in groups.iter_mut().zip(bars) {
                    group.push((layer, bar));
                }
            }
        }
        groups
    }

    /// Ends of both axes in places (logarithms on a logarithmic axis), a little more than the data take up; columns stand on
    /// the axis, with nothing below.
    pub fn limits(&self) -> [[f64; 2]; 2] {
        let extent = || self.layers.iter().flat_map(|layer| layer.marks.extent());
        let [low, high] = limits(extent().filter_map(|(_, y)| self.y.place(y?)));
        let is_below = extent().any(|(_, y)| y.is_some_and(|y| y < 0.0));
        let mut marks = self.layers.iter().map(|layer| &layer.marks);
        let zero = self.y.place(0.0).filter(|_| !is_below);
        let low = zero
            .filter(|_| marks.any(Marks::stands_on_zero))
            .unwrap_or(low);
        [
            limits(extent().filter_map(|(x, _)| self.x.place(x?))),
            [low, high],
        ]
    }
}

fn limits(places: impl Iterator<Item = f64>) -> [f64; 2] {
    let [low, high] = places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
        [low.min(x), high.max(x)]
    });
    let margin = match (low.is_finite(), high > low) {
        (false, _) => return [0.0, 1.0],
        (true, true) => 0.05 * (high - low),
        (true, false) => 0.5 * high.abs().max(1.0),
    };
    [low - margin, high + margin]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_very_many_points_none_that_lies_apart_is_lost() {
        let mut points: Vec<[f64; 2]> = (0..100_000)
            .map(|k| [f64::from(k), libm::sin(f64::from(k))])
            .collect();
        points[54_321][1] = 7.0;
        points[99_999][1] = f64::NAN;
        let Marks::Points(drawn) = Marks::data(points) else {
            panic!("points");
        };
        assert!(drawn.len() <= 2 * STRETCHES && drawn.len() > STRETCHES);
        assert!(drawn.contains(&[54_321.0, 7.0]));
        assert_eq!(drawn[0][0].min(drawn[1][0]) as usize / 100, 0);
        let few = vec![[1.0, 2.0], [f64::NAN, 0.0]];
        assert!(matches!(Marks::data(few), Marks::Points(all) if all.len() == 2));
    }

    #[test]
    fn columns_stand_on_the_axis() {
        let layer = |marks| Layer {
            name: String::new(),
            tone: Tone::Main,
            marks,
        };
        let panel = |low: f64, line: f64| Panel {
            title: "p".into(),
            x: Axis::linear("x", ""),
            y: Axis::linear("y", ""),
            layers: vec![
                layer(Marks::Band(vec![[0.0, low, 0.4], [1.0, low, 0.5]])),
                layer(Marks::Line(vec![[0.0, line], [1.0, 0.4]])),
            ],
        };
        let lowest = |low, line| panel(low, line).limits()[1][0];
        assert_eq!(lowest(0.0, 0.1), 0.0);
        assert!(lowest(0.0, -0.1) < -0.1 && lowest(0.1, 0.2) < 0.1);
    }
}
