//! The pictures of a fleet, as data.

use gumption_core::special::normal_pdf;
use gumption_fault::say;
use gumption_fleet::{DAYS_OF_A_YEAR, Deviations, Drift, Measurand};
use gumption_format::document::{Axis, Bar, Layer, Marks, Panel, Plot, Tone};

use super::Shown;
use crate::symbol;

/// Groups with bars in one picture.
const MOST_BARS: usize = 24;

impl Shown<'_> {
    /// Every row with its U, where there are few, else each group from the smallest to the largest beside what U claims.
    pub fn estimates_plot(self, one: &Measurand) -> Option<Plot> {
        let panel = match one.points.is_empty() {
            false => self.rows(one),
            true => self.ranges(one)?,
        };
        Some(plot("estimates", one, panel))
    }

    fn rows(self, one: &Measurand) -> Panel {
        let l = self.l;
        let place = |at: usize| (at + 1) as f64;
        let points = one.points.iter().enumerate();
        let estimates = points.clone().map(|(at, (_, x, _))| [place(at), *x]);
        let whiskers = points.filter(|(_, (_, _, u))| u.is_finite());
        let whiskers = whiskers.map(|(at, (_, x, u))| [place(at), x - u, x + u]);
        let mut layers = vec![
            Layer::new("±U", Tone::Quiet, Marks::Whiskers(whiskers.collect())),
            Layer::new(
                l.pick("estimate", "估计值"),
                Tone::Main,
                Marks::Points(estimates.collect()),
            ),
        ];
        // The mean of each group, as far as its rows go.
        let mut first = true;
        for (group, found) in one.groups.iter().enumerate() {
            let mut places = one.points.iter().enumerate();
            let begin = places.position(|(_, point)| point.0 == group);
            let (Some(begin), Some(consistency)) = (begin, &found.consistency) else {
                continue;
            };
            let count = one.points.iter().filter(|point| point.0 == group).count();
            let ends = [place(begin) - 0.4, place(begin + count - 1) + 0.4];
            let name = if first {
                l.pick("weighted mean of the group", "组加权平均值")
            } else {
                ""
            };
            first = false;
            let line = ends.map(|x| [x, consistency.mean]);
            layers.push(Layer::new(name, Tone::Contrast, Marks::Line(line.to_vec())));
        }
        Panel {
            title: say!("Estimates of {}, group by group", one.name).in_language(l),
            x: Axis::linear(
                l.pick("row, in the order of the groups", "行（按组排列）"),
                "",
            ),
            y: Axis::linear(one.name.as_str(), symbol(&one.unit)),
            layers,
        }
    }

    fn ranges(self, one: &Measurand) -> Option<Panel> {
        let l = self.l;
        let groups = || {
            let all = one.groups.iter().enumerate();
            all.filter(|(_, group)| group.values > 0).take(MOST_BARS)
        };
        let bars = |ends: &dyn Fn(&gumption_fleet::GroupResult) -> [f64; 2]| {
            let bar = |(at, group): (usize, &gumption_fleet::GroupResult)| {
                let [from, to] = ends(group);
                Bar {
                    name: self.group(at),
                    from,
                    to,
                }
            };
            Marks::Bars(groups().map(bar).collect())
        };
        groups().next()?;
        let observed = bars(&|group| group.range);
        let claimed = bars(&|group| [group.mean - group.expanded, group.mean + group.expanded]);
        Some(Panel {
            title: say!("Estimates of {} by group", one.name).in_language(l),
            x: Axis::linear(one.name.as_str(), symbol(&one.unit)),
            y: Axis::linear("", ""),
            layers: vec![
                Layer::new(
                    l.pick("smallest to largest", "最小值至最大值"),
                    Tone::Main,
                    observed,
                ),
                Layer::new(l.pick("mean ± U", "平均值 ± U"), Tone::Quiet, claimed),
            ],
        })
    }

    /// Deviations from the others beside the standard normal distribution.
    pub fn deviations_plot(self, one: &Measurand) -> Option<Plot> {
        /// Fewer make no shape.
        const FEWEST: usize = 10;
        /// Points of the curve.
        const POINTS: i32 = 100;
        let l = self.l;
        let counts = &one.deviations.counts;
        let all: usize = counts.iter().sum();
        if all < FEWEST {
            return None;
        }
        let end = Deviations::START + Deviations::WIDTH * Deviations::BINS as f64;
        let mut steps = Vec::new();
        for (bin, count) in counts.iter().enumerate() {
            let left = Deviations::START + bin as f64 * Deviations::WIDTH;
            let density = *count as f64 / all as f64 / Deviations::WIDTH;
            steps.push([left, 0.0, density]);
            steps.push([left + Deviations::WIDTH, 0.0, density]);
        }
        let curve = (0..=POINTS).map(|at| {
            let x =
                Deviations::START + (end - Deviations::START) * f64::from(at) / f64::from(POINTS);
            [x, normal_pdf(x)]
        });
        let panel = Panel {
            title: say!("Deviation from the others of the group, in its standard uncertainty")
                .in_language(l),
            x: Axis::linear("(x − X)/u(x − X)", ""),
            y: Axis::linear(l.pick("density", "概率密度"), ""),
            layers: vec![
                Layer::new(
                    l.pick("rows (beyond ±5 at the ends)", "各行（超出 ±5 者计入两端）"),
                    Tone::Main,
                    Marks::Band(steps),
                ),
                Layer::new(
                    l.pick("standard normal", "标准正态分布"),
                    Tone::Contrast,
                    Marks::Line(curve.collect()),
                ),
            ],
        };
        Some(plot("deviations", one, panel))
    }

    /// How often which input has the largest share.
    pub fn components_plot(self, one: &Measurand) -> Option<Plot> {
        let l = self.l;
        let groups = one.groups.iter().enumerate();
        let groups = groups.filter(|(_, group)| group.values > 0).take(MOST_BARS);
        let groups: Vec<_> = groups.collect();
        let names = one.groups.first()?.components.iter().map(|one| &one.name);
        let dominated = |at: usize| -> usize {
            one.groups
                .iter()
                .map(|group| group.components[at].dominates)
                .sum()
        };
        let mut order: Vec<(usize, &String)> = names.enumerate().collect();
        order.retain(|(at, _)| dominated(*at) > 0);
        order.sort_by_key(|(at, _)| std::cmp::Reverse(dominated(*at)));
        let tones = [Tone::Main, Tone::Contrast, Tone::Quiet];
        let layers = order.iter().zip(tones).map(|((at, name), tone)| {
            let bar = |(group, found): &(usize, &gumption_fleet::GroupResult)| Bar {
                name: self.group(*group),
                from: 0.0,
                to: 100.0 * found.components[*at].dominates as f64 / found.values as f64,
            };
            Layer::new(
                name.as_str(),
                tone,
                Marks::Bars(groups.iter().map(bar).collect()),
            )
        });
        let layers: Vec<Layer> = layers.collect();
        (!layers.is_empty()).then(|| {
            let panel = Panel {
                title: say!("Largest share of u²({})", one.name).in_language(l),
                x: Axis::linear(l.pick("rows", "行数"), "%"),
                y: Axis::linear("", ""),
                layers,
            };
            plot("components", one, panel)
        })
    }

    /// The courses of the devices whose drift is least probable.
    pub fn drift_plot(self, one: &Measurand, drift: &Drift) -> Option<Plot> {
        /// The year of day 0.
        const EPOCH: f64 = 1970.0;
        let l = self.l;
        let year = |days: f64| EPOCH + days / DAYS_OF_A_YEAR;
        let whiskers =
            |point: &[f64; 3]| [year(point[0]), point[1] - point[2], point[1] + point[2]];
        let all = drift.courses.iter();
        // Those of all of them would hide the lines.
        let first = drift.courses.first()?;
        let whiskers = first.points.iter().map(whiskers);
        let words = l.pick("±U of the first", "第一条的 ±U");
        let whiskers = Marks::Whiskers(whiskers.collect());
        let mut layers = vec![Layer::new(words, Tone::Quiet, whiskers)];
        let mut told = [false; 2];
        for course in all {
            let line = course.points.iter().map(|point| [year(point[0]), point[1]]);
            let (tone, words) = match course.is_named {
                true => (
                    Tone::Contrast,
                    l.pick(
                        "drift that chance does not explain",
                        "不能由偶然性解释的漂移",
                    ),
                ),
                false => (Tone::Main, l.pick("other devices", "其他器件")),
            };
            let seen = std::mem::replace(&mut told[usize::from(course.is_named)], true);
            let name = if seen { "" } else { words };
            layers.push(Layer::new(name, tone, Marks::Line(line.collect())));
        }
        let panel = Panel {
            title: say!(
                "{} of a device, less its weighted mean: the {} least probable courses",
                one.name,
                drift.courses.len()
            )
            .in_language(l),
            x: Axis::linear(l.pick("date", "日期"), "a"),
            y: Axis::linear(format!("Δ{}", one.name), symbol(&one.unit)),
            layers,
        };
        Some(plot("drift", one, panel))
    }
}

fn plot(kind: &str, one: &Measurand, panel: Panel) -> Plot {
    Plot::new(&format!("{kind}_{}", one.name), vec![panel])
}
