//! Lessons that run: samples drawn by the engine from budgets of a few lines, and what they show.

use gumption_core::special::{normal_pdf, normal_two_sided_quantile, student_t_upper_quantile};
use gumption_fault::language::Language;
use gumption_format::document::{
    Axis, Block, ColumnKind, Document, Layer, Marks, Panel, Plot, Table, Tone,
};
use gumption_format::files::Files;
use gumption_format::machine::{Machine, Number, record};
use gumption_gum::budget::{self, MonteCarloSettings};
use gumption_gum::propagate::{self, MonteCarloChoice, Options, Progress};

/// Experiments of a lesson: rates of 95 % are then known to 0.2 % (one standard uncertainty).
const EXPERIMENTS: u64 = 10_000;

/// Experiments that are drawn one by one.
const SEEN: usize = 100;

/// Most readings of an experiment.
const MOST_READINGS: usize = 30;

/// Classes of a histogram.
const CLASSES: usize = 60;

/// Probability of the intervals.
const P: f64 = 0.95;

/// What a lesson is about.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lesson {
    /// Its name.
    pub name: &'static str,
    /// What it is called, in English and in Chinese.
    pub title: [&'static str; 2],
    /// Whether it has a number of readings, or of terms.
    pub counts: bool,
    /// Its document, from the number of readings and samples of a budget.
    draw: fn(&Class<'_>) -> Drawn,
}

/// All lessons, in the order of a course.
pub(crate) const LESSONS: [Lesson; 4] = [
    Lesson {
        name: "divisor",
        title: ["Why n − 1", "为什么除以 n − 1"],
        counts: true,
        draw: divisor,
    },
    Lesson {
        name: "coverage",
        title: ["What an interval covers", "区间包含什么"],
        counts: true,
        draw: coverage,
    },
    Lesson {
        name: "rectangles",
        title: ["Sums of rectangles", "均匀分布之和"],
        counts: true,
        draw: rectangles,
    },
    Lesson {
        name: "shared",
        title: ["One standard for two", "共用一个标准"],
        counts: false,
        draw: shared,
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

fn pairs(samples: &[Vec<f64>]) -> Vec<[f64; 2]> {
    match samples {
        [first, second, ..] => first.iter().zip(second).map(|(a, b)| [*a, *b]).collect(),
        _ => Vec::new(),
    }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), x| (sum + x, count + 1.0));
    sum / count
}

fn layer(name: String, tone: Tone, marks: Marks) -> Layer {
    Layer { name, tone, marks }
}

fn divisor(class: &Class<'_>) -> Drawn {
    let mut table = Table::new([
        ("n", ColumnKind::Numbers),
        ("Σ(x − x̄)² / n", ColumnKind::Numbers),
        ("Σ(x − x̄)² / (n − 1)", ColumnKind::Numbers),
    ]);
    let (mut by_n, mut by_less, mut figures) = (Vec::new(), Vec::new(), Vec::new());
    for n in 2..=class.n {
        let size = n as f64;
        let variance = mean(class.readings(n).iter().map(|[_, s]| s * s));
        let short = variance * (size - 1.0) / size;
        by_n.push([size, short]);
        by_less.push([size, variance]);
        table.push(vec![
            n.to_string().into(),
            format!("{short:.3}").into(),
            format!("{variance:.3}").into(),
        ]);
        figures.extend([Number(size), Number(short), Number(variance)]);
    }
    let truth = class.pick("true variance", "真实方差");
    Drawn {
        words: class.pick(
            "Readings scatter about their own mean, which lies nearer to them than the true value does. For each n, 10 000 times n readings of variance 1 are drawn: divided by n their squares are too small on average, by (n − 1)/n; divided by n − 1 they are not.",
            "读数围绕它们自己的平均值分散，而平均值总比真值更靠近这些读数。对每个 n，各抽取 10 000 组、每组 n 个方差为 1 的读数：除以 n 时平均偏小，为 (n − 1)/n；除以 n − 1 则没有偏差。",
        ),
        table,
        panel: Panel {
            title: class.pick("Mean of the estimated variance", "方差估计的平均值"),
            x: Axis::linear("n", ""),
            y: Axis::linear("s²", ""),
            layers: vec![
                layer(truth, Tone::Quiet, Marks::Level(1.0)),
                layer("n".into(), Tone::Contrast, Marks::Points(by_n)),
                layer("n − 1".into(), Tone::Main, Marks::Points(by_less)),
            ],
        },
        figures,
    }
}

fn coverage(class: &Class<'_>) -> Drawn {
    let size = class.n as f64;
    let experiments = class.readings(class.n);
    let t = student_t_upper_quantile(0.5 * (1.0 - P), size - 1.0);
    let ends = |k: f64, [m, s]: [f64; 2]| [m - k * s / size.sqrt(), m + k * s / size.sqrt()];
    let covers = |k: f64, one: &[f64; 2]| {
        let [low, high] = ends(k, *one);
        low <= 0.0 && 0.0 <= high
    };
    let (mut hits, mut misses) = (Vec::new(), Vec::new());
    for (at, one) in experiments.iter().take(SEEN).enumerate() {
        let [low, high] = ends(t, *one);
        let list = if covers(t, one) {
            &mut hits
        } else {
            &mut misses
        };
        list.push([at as f64 + 1.0, low, high]);
    }
    let mut table = Table::new([
        ("", ColumnKind::Names),
        ("k", ColumnKind::Numbers),
        (
            class.language.pick("miss among 100", "100 个中未包含"),
            ColumnKind::Numbers,
        ),
        (
            class
                .language
                .pick("cover, of 10 000 / %", "10 000 个中包含 / %"),
            ColumnKind::Numbers,
        ),
        (
            class.language.pick("promised / %", "承诺 / %"),
            ColumnKind::Numbers,
        ),
    ]);
    let mut figures = Vec::new();
    let rules = [
        (format!("t, ν = {}", class.n - 1), t),
        (class.pick("normal", "正态"), normal_two_sided_quantile(P)),
    ];
    for (rule, k) in rules {
        let missed = experiments
            .iter()
            .take(SEEN)
            .filter(|one| !covers(k, one))
            .count();
        let rate = 100.0
            * mean(
                experiments
                    .iter()
                    .map(|one| f64::from(u8::from(covers(k, one)))),
            );
        table.push(vec![
            rule.into(),
            format!("{k:.2}").into(),
            missed.to_string().into(),
            format!("{rate:.1}").into(),
            "95.0".into(),
        ]);
        figures.extend([Number(k), Number(missed as f64), Number(rate)]);
    }
    let n = class.n;
    Drawn {
        words: class.language.pick(
            format!("A hundred times n = {n} readings are taken of a quantity whose value is 0, and the interval x̄ ± k s/√n is drawn. The promise of 95 % is about the procedure: about five in a hundred miss. With few readings s is itself uncertain, and only the k of t keeps the promise."),
            format!("对真值为 0 的量取 n = {n} 个读数，重复一百次，画出区间 x̄ ± k s/√n。95 % 是对这一做法的承诺：一百个中约有五个未包含真值。读数少时 s 本身也不确定，只有 t 分布的 k 才能兑现承诺。"),
        ),
        table,
        panel: Panel {
            title: class.pick("Intervals x̄ ± t s/√n", "区间 x̄ ± t s/√n"),
            x: Axis::linear(class.pick("experiment", "试验序号"), ""),
            y: Axis::linear("x", ""),
            layers: vec![
                layer(class.pick("true value", "真值"), Tone::Quiet, Marks::Level(0.0)),
                layer(class.pick("covers it", "包含真值"), Tone::Main, Marks::Whiskers(hits)),
                layer(class.pick("misses it", "未包含真值"), Tone::Contrast, Marks::Whiskers(misses)),
            ],
        },
        figures,
    }
}

fn rectangles(class: &Class<'_>) -> Drawn {
    let n = class.n;
    let terms = vec!["0"; n].join(", ");
    let samples = class.samples(&format!(
        "title = \"Sum\"\n[measurand.y]\nmodel = \"sum(x)\"\nunit = \"1\"\n[input]\nx = {{ values = [{terms}], half_width = 1 }}\n"
    ));
    let mut sums = samples.into_iter().next().unwrap_or_default();
    sums.sort_by(f64::total_cmp);
    let u = (n as f64 / 3.0).sqrt();
    let reach = n as f64;
    let width = 2.0 * reach / CLASSES as f64;
    let mut counts = [0.0; CLASSES];
    for sum in &sums {
        let at = ((sum + reach) / width) as usize;
        counts[at.min(CLASSES - 1)] += 1.0;
    }
    let density = |count: f64| count / (sums.len().max(1) as f64 * width);
    let steps = counts.iter().enumerate().flat_map(|(at, count)| {
        let (left, height) = (at as f64 * width - reach, density(*count));
        [[left, height], [left + width, height]]
    });
    let curve = (0..=4 * CLASSES).map(|at| {
        let x = at as f64 * width / 4.0 - reach;
        [x, normal_pdf(x / u) / u]
    });
    let tail = |p: f64| {
        sums.get((p * sums.len() as f64) as usize)
            .copied()
            .unwrap_or(f64::NAN)
    };
    let k = 0.5 * (tail(0.975) - tail(0.025)) / u;
    let mut table = Table::new([
        ("n", ColumnKind::Numbers),
        ("u = √(n/3)", ColumnKind::Numbers),
        (
            class.language.pick("k for 95 %, drawn", "95 % 的 k，抽样"),
            ColumnKind::Numbers,
        ),
        (
            class.language.pick("k, normal", "k，正态"),
            ColumnKind::Numbers,
        ),
    ]);
    table.push(vec![
        n.to_string().into(),
        format!("{u:.3}").into(),
        format!("{k:.2}").into(),
        format!("{:.2}", normal_two_sided_quantile(P)).into(),
    ]);
    Drawn {
        words: class.language.pick(
            format!("The sum of n = {n} quantities, each anywhere between −1 and 1, drawn 10 000 times. Two make a triangle; a few look normal already (central limit theorem), and k for 95 % comes near 1.96. Where one rectangle outweighs all others it does not: k is 1.65 for it alone."),
            format!("n = {n} 个量之和，每个量在 −1 与 1 之间均匀分布，抽样 10 000 次。两个之和为三角分布；几个之和已近似正态（中心极限定理），95 % 的 k 接近 1.96。若其中一个远大于其余，则不成立：单个均匀分布的 k 为 1.65。"),
        ),
        table,
        panel: Panel {
            title: class.pick("Distribution of the sum", "和的分布"),
            x: Axis::linear("y", ""),
            y: Axis::linear(class.pick("density", "概率密度"), ""),
            layers: vec![
                layer(class.pick("drawn", "抽样"), Tone::Main, Marks::Line(steps.collect())),
                layer(class.pick("normal, same u", "正态，u 相同"), Tone::Contrast, Marks::Line(curve.collect())),
            ],
        },
        figures: vec![Number(u), Number(k)],
    }
}

fn shared(class: &Class<'_>) -> Drawn {
    let samples = class.samples(
        "title = \"Two weights\"\n[measurand]\na = { model = \"m_a + s\", unit = \"mg\" }\n\
         b = { model = \"m_b + s\", unit = \"mg\" }\n[input]\ns = { value = 0, unit = \"mg\", u = 2 }\n\
         m_a = { value = 0, unit = \"mg\", u = 1 }\nm_b = { value = 0, unit = \"mg\", u = 1 }\n",
    );
    let points = pairs(&samples);
    let spread = |of: fn(&[f64; 2]) -> f64| mean(points.iter().map(|p| of(p) * of(p))).sqrt();
    let (u_a, u_b) = (spread(|p| p[0]), spread(|p| p[1]));
    let r = mean(points.iter().map(|[a, b]| a * b)) / (u_a * u_b);
    let independent = (u_a * u_a + u_b * u_b).sqrt();
    let mut table = Table::new([
        ("", ColumnKind::Names),
        (
            class.language.pick("u drawn / mg", "抽样的 u / mg"),
            ColumnKind::Numbers,
        ),
        (
            class.language.pick("u with r / mg", "计入 r 的 u / mg"),
            ColumnKind::Numbers,
        ),
        (
            class.language.pick("u without r / mg", "不计 r 的 u / mg"),
            ColumnKind::Numbers,
        ),
    ]);
    // GUM 5.2.2: u²(a ± b) = u²(a) + u²(b) ± 2 r u(a) u(b); here r = 4/5.
    let rows: [(&str, f64, f64); 2] = [
        ("a + b", spread(|p| p[0] + p[1]), 18.0_f64.sqrt()),
        ("a − b", spread(|p| p[0] - p[1]), 2.0_f64.sqrt()),
    ];
    let mut figures = vec![Number(r)];
    for (what, drawn, formula) in rows {
        table.push(vec![
            what.into(),
            format!("{drawn:.2}").into(),
            format!("{formula:.2}").into(),
            format!("{independent:.2}").into(),
        ]);
        figures.extend([Number(drawn), Number(formula), Number(independent)]);
    }
    let seen = points.iter().take(10 * SEEN).copied().collect();
    Drawn {
        words: class.language.pick(
            format!("Two weights are compared with the same standard (u = 2 mg), each by a comparison of its own (u = 1 mg). What the standard is wrong by is in both: r = {r:.2}. Their sum is less certain than squares say, their difference far more."),
            format!("两个砝码与同一标准（u = 2 mg）比较，每次比较各有 u = 1 mg。标准的误差同时进入两者：r = {r:.2}。两者之和比平方和所示更不确定，两者之差则确定得多。"),
        ),
        table,
        panel: Panel {
            title: class.pick("Errors of both weights", "两个砝码的误差"),
            x: Axis::linear("a", "mg"),
            y: Axis::linear("b", "mg"),
            layers: vec![layer(class.pick("drawn", "抽样"), Tone::Main, Marks::Points(seen))],
        },
        figures,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figures(name: &str, n: usize, seed: u64) -> Vec<f64> {
        let progress = Progress::default();
        let document = lesson(name, n, seed, Language::English, &progress).expect("a lesson");
        let figures = document.machine["figures"]
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
