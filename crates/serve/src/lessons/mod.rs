//! Lessons that run: samples drawn by the engine from budgets of a few lines, and what they show.

mod models;
mod readings;

use gumption_fault::language::Language;
use gumption_format::document::{Block, Document, Marks, Panel, Plot, Table};
use gumption_format::files::Files;
use gumption_format::machine::{Machine, Number, record};
use gumption_gum::budget::{self, MonteCarloSettings};
use gumption_gum::propagate::{self, MonteCarloChoice, Options, Progress};
use gumption_report::grouped;

/// Experiments of a lesson: rates of 95 % are then known to 0.2 % (one standard uncertainty).
const EXPERIMENTS: u64 = 10_000;

/// Experiments that are drawn one by one.
const SEEN: usize = 100;

/// Most readings of an experiment.
const MOST_READINGS: usize = 30;

/// Probability of the intervals.
const P: f64 = 0.95;

/// Classes of a histogram.
const CLASSES: usize = 60;

/// What a lesson is about.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lesson {
    /// Its name.
    pub name: &'static str,
    /// What it is called, in English and in Chinese.
    pub title: [&'static str; 2],
    /// What its slider counts, where it has one.
    pub counts: Option<Count>,
    /// Its document, from the number of readings and samples of a budget.
    draw: fn(&Class<'_>) -> Drawn,
}

/// What a slider counts: its symbol, and how many there are at a step of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Count {
    symbol: &'static str,
    at: fn(usize) -> usize,
}

/// Readings, or terms.
const READINGS: Count = Count {
    symbol: "n",
    at: |n| n,
};

/// All lessons, in the order of a course.
pub(crate) const LESSONS: [Lesson; 8] = [
    Lesson {
        name: "histogram",
        title: ["Trial by trial", "逐次抽样"],
        counts: Some(models::TRIALS),
        draw: models::histogram,
    },
    Lesson {
        name: "divisor",
        title: ["Why n − 1", "为什么除以 n − 1"],
        counts: Some(READINGS),
        draw: readings::divisor,
    },
    Lesson {
        name: "coverage",
        title: ["What an interval covers", "区间包含什么"],
        counts: Some(READINGS),
        draw: readings::coverage,
    },
    Lesson {
        name: "rectangles",
        title: ["Sums of rectangles", "均匀分布之和"],
        counts: Some(READINGS),
        draw: readings::rectangles,
    },
    Lesson {
        name: "box",
        title: ["A box of resistors", "电阻箱"],
        counts: Some(READINGS),
        draw: models::resistors,
    },
    Lesson {
        name: "shared",
        title: ["One standard for two", "共用一个标准"],
        counts: None,
        draw: readings::shared,
    },
    Lesson {
        name: "square",
        title: ["A square at zero", "零点处的平方"],
        counts: Some(READINGS),
        draw: models::square,
    },
    Lesson {
        name: "tumble",
        title: ["Four positions and a level error", "四位置与水平误差"],
        counts: Some(READINGS),
        draw: models::tumble,
    },
];

/// What a lesson is drawn from.
struct Class<'a> {
    n: usize,
    seed: u64,
    language: Language,
    progress: &'a Progress,
}

/// What a lesson shows.
struct Drawn {
    words: String,
    table: Table,
    panel: Panel,
    figures: Vec<Number>,
}

record! {
    /// A lesson.
    LessonJson {
        /// Its name.
        lesson: &'static str,
        /// Number of readings, or of terms.
        n: usize,
        /// Seed of the samples.
        seed: u64,
        /// The figures of its table, row by row.
        figures: Vec<Number>,
    }
}

impl Machine for LessonJson {
    const KIND: &'static str = "lesson";
    const VERSION: u32 = 1;
}

/// How many there are at a step of the slider of a lesson, as `n = 7`; nothing where it has none.
pub(crate) fn counted(name: &str, step: usize) -> Option<String> {
    let lesson = LESSONS.iter().find(|lesson| lesson.name == name)?;
    let Count { symbol, at } = lesson.counts?;
    let count = at(step.clamp(2, MOST_READINGS));
    Some(format!("{symbol} = {}", grouped(count as u64)))
}

/// The document of a lesson with n readings; nothing of one that there is not.
pub(crate) fn lesson(
    name: &str,
    n: usize,
    seed: u64,
    language: Language,
    progress: &Progress,
) -> Option<Document> {
    let lesson = LESSONS.iter().find(|lesson| lesson.name == name)?;
    let n = n.clamp(2, MOST_READINGS);
    let drawn = (lesson.draw)(&Class {
        n,
        seed,
        language,
        progress,
    });
    let form = LessonJson {
        lesson: lesson.name,
        n,
        seed,
        figures: drawn.figures,
    };
    let [english, chinese] = lesson.title;
    let blocks = vec![
        Block::Title(language.pick(english, chinese).to_owned()),
        Block::Paragraph(drawn.words),
        Block::Plot(Plot {
            id: lesson.name.to_owned(),
            panels: vec![drawn.panel],
        }),
        Block::Table(drawn.table),
    ];
    Some(Document::new(&form, language, blocks))
}

impl Class<'_> {
    /// Samples of the measurands of a budget, a list for each.
    fn samples(&self, text: &str) -> Vec<Vec<f64>> {
        let files: &[(&str, &[u8])] = &[("lesson.toml", text.as_bytes())];
        let loaded = budget::load_from(Files::Library(files), "lesson.toml".as_ref(), None);
        let rows = loaded.map(|loaded| loaded.rows).unwrap_or_default();
        let Some(row) = rows.first() else {
            return Vec::new();
        };
        let settings = MonteCarloSettings {
            seed: self.seed,
            ..row.budget.monte_carlo.clone()
        };
        let options = Options {
            monte_carlo: MonteCarloChoice::With(settings),
            progress: self.progress.clone(),
            ..Options::default()
        };
        propagate::samples(&row.budget, EXPERIMENTS, &options)
    }

    /// Means and standard deviations of n readings of a quantity whose value is 0, with a standard deviation of 1.
    fn readings(&self, n: usize) -> Vec<[f64; 2]> {
        let zeros = vec!["0"; n].join(", ");
        let samples = self.samples(&format!(
            "title = \"Readings\"\n[measurand]\nm = {{ model = \"mean(x)\", unit = \"1\" }}\n\
             s = {{ model = \"sd(x)\", unit = \"1\" }}\n[input]\nx = {{ values = [{zeros}], u = 1 }}\n"
        ));
        pairs(&samples)
    }

    fn pick(&self, english: &str, chinese: &str) -> String {
        self.language.pick(english, chinese).to_owned()
    }
}

/// Two measurands, sample by sample.
fn pairs(samples: &[Vec<f64>]) -> Vec<[f64; 2]> {
    match samples {
        [first, second, ..] => first.iter().zip(second).map(|(a, b)| [*a, *b]).collect(),
        _ => Vec::new(),
    }
}

/// How many samples fall into each class between two ends, as the outline of their density.
fn outline(samples: &[f64], [low, high]: [f64; 2]) -> Marks {
    let width = (high - low) / CLASSES as f64;
    let mut counts = [0.0; CLASSES];
    for sample in samples {
        let at = (sample - low) / width;
        if (0.0..=CLASSES as f64).contains(&at) {
            counts[(at as usize).min(CLASSES - 1)] += 1.0;
        }
    }
    let steps = counts.iter().enumerate().flat_map(|(at, count)| {
        let left = low + at as f64 * width;
        let height = count / (samples.len().max(1) as f64 * width);
        [[left, height], [left + width, height]]
    });
    Marks::Line(steps.collect())
}

/// A density between two ends.
fn curve(density: impl Fn(f64) -> f64, [low, high]: [f64; 2]) -> Marks {
    let points = (0..=4 * CLASSES).map(|at| {
        let x = low + (high - low) * at as f64 / (4 * CLASSES) as f64;
        [x, density(x)]
    });
    Marks::Line(points.collect())
}

/// The ends of the interval that leaves the same part of the samples on both sides.
fn ends(samples: &[f64]) -> [f64; 2] {
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    [0.5 * (1.0 - P), 0.5 * (1.0 + P)].map(|p| {
        let at = (p * sorted.len() as f64) as usize;
        sorted.get(at).copied().unwrap_or(f64::NAN)
    })
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), x| (sum + x, count + 1.0));
    sum / count
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figures(name: &str, n: usize, seed: u64) -> Vec<f64> {
        let progress = Progress::default();
        let document = lesson(name, n, seed, Language::English, &progress).expect("a lesson");
        let figures = document.machine.value()["figures"]
            .as_array()
            .expect("figures")
            .clone();
        figures
            .iter()
            .map(|x| x.as_f64().expect("a number"))
            .collect()
    }

    /// Against closed forms, within four standard uncertainties of 10 000 experiments.
    #[test]
    fn samples_show_what_the_words_say() {
        for row in figures("divisor", 6, 3).chunks(3) {
            let (n, variance) = (row[0], row[2]);
            assert!(
                (variance - 1.0).abs() < 4.0 * (2.0 / (n - 1.0)).sqrt() / 100.0,
                "{row:?}"
            );
            assert!((row[1] - (n - 1.0) / n).abs() < 0.06, "{row:?}");
        }
        let covered = figures("coverage", 4, 5);
        assert!((covered[2] - 95.0).abs() < 0.9, "{covered:?}");
        // P(|t₃| ≤ 1.96) = 85.5 %.
        assert!((covered[5] - 85.5).abs() < 1.5, "{covered:?}");
        // Of two, a triangle: k = √6 (1 − √0.05).
        let k = figures("rectangles", 2, 7)[1];
        assert!(
            (k - 6.0_f64.sqrt() * (1.0 - 0.05_f64.sqrt())).abs() < 0.04,
            "{k}"
        );
        // The first of 10 000 trials of a product: u = 0.2 √(1 + 1/3), and u itself to 1/√(2M).
        for n in [20, 30] {
            let drawn = figures("histogram", n, 4);
            let trials = drawn[0];
            let u = 0.2 * (4.0_f64 / 3.0).sqrt();
            assert!(
                (drawn[1] - 1.0).abs() < 4.0 * u / trials.sqrt(),
                "{drawn:?}"
            );
            assert!(
                (drawn[2] / u - 1.0).abs() < 0.03 + 4.0 / (2.0 * trials).sqrt(),
                "{drawn:?}"
            );
        }
        assert_eq!(figures("histogram", 30, 4)[0], 10_000.0);
        // Of ten resistors: worst case, 1.96 √(n/3), and the half-width drawn.
        let series = figures("box", 10, 2);
        assert_eq!(series[0], 10.0);
        let wanted = 1.96 * (10.0_f64 / 3.0).sqrt();
        assert!((series[1] - wanted).abs() < 1e-2, "{series:?}");
        assert!((series[2] / wanted - 1.0).abs() < 0.04, "{series:?}");
        // At zero (n = 5): mean 1, standard deviation √2, of chi-square with one degree of freedom.
        let square = figures("square", 5, 6);
        assert_eq!(square[..4], [0.0, 0.0, 1.0, 2.0_f64.sqrt()]);
        assert!((square[4] - 1.0).abs() < 0.06, "{square:?}");
        // Its fourth moment is 60: u(s)/s = √(14/4/M) = 1.9 %.
        assert!(
            (square[5] / 2.0_f64.sqrt() - 1.0).abs() < 0.08,
            "{square:?}"
        );
        // Ten milliradians: −ε²/2 = −50 parts in a million, in no first-order budget; the bias of four positions does not see them.
        let tumble = figures("tumble", 10, 8);
        assert!((tumble[0] / 10e-3 - 1.0).abs() < 0.03, "{tumble:?}");
        assert!((tumble[1] / 1e-5 - 1.0).abs() < 0.03, "{tumble:?}");
        assert!(
            (tumble[2] + 5e-5).abs() < 4.0 * 7.1e-5 / 100.0,
            "{tumble:?}"
        );
        let shared = figures("shared", 2, 9);
        assert!((shared[0] - 0.8).abs() < 0.02, "{shared:?}");
        assert!((shared[1] / shared[2] - 1.0).abs() < 0.03, "{shared:?}");
        assert!((shared[4] / shared[5] - 1.0).abs() < 0.03, "{shared:?}");
    }

    #[test]
    fn a_seed_gives_the_same_samples_again() {
        assert_eq!(figures("coverage", 5, 1), figures("coverage", 5, 1));
        assert_ne!(figures("coverage", 5, 1), figures("coverage", 5, 2));
        let progress = Progress::default();
        assert!(lesson("none", 5, 1, Language::English, &progress).is_none());
    }
}
