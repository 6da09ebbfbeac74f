//! Readings and their sums: what a class draws first.

use gumption_core::special::{normal_pdf, normal_two_sided_quantile, student_t_upper_quantile};
use gumption_fault::say;
use gumption_format::document::{Axis, ColumnKind, Layer, Marks, Panel, Table, Tone};
use gumption_format::machine::Number;

use super::{Class, Drawn, P, SEEN, curve, ends, mean, outline, pairs};

pub(super) fn divisor(class: &Class<'_>) -> Drawn {
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
                Layer::new(truth, Tone::Quiet, Marks::Level(1.0)),
                Layer::new("n", Tone::Contrast, Marks::Points(by_n)),
                Layer::new("n − 1", Tone::Main, Marks::Points(by_less)),
            ],
        },
        figures,
    }
}

pub(super) fn coverage(class: &Class<'_>) -> Drawn {
    let size = class.n as f64;
    let experiments = class.readings(class.n);
    let t = student_t_upper_quantile(0.5 * (1.0 - P), size - 1.0);
    let interval = |k: f64, [m, s]: [f64; 2]| [m - k * s / size.sqrt(), m + k * s / size.sqrt()];
    let covers = |k: f64, one: &[f64; 2]| {
        let [low, high] = interval(k, *one);
        low <= 0.0 && 0.0 <= high
    };
    let (mut hits, mut misses) = (Vec::new(), Vec::new());
    for (at, one) in experiments.iter().take(SEEN).enumerate() {
        let [low, high] = interval(t, *one);
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
        words: say!("A hundred times n = {n} readings are taken of a quantity whose value is 0, and the interval x̄ ± k s/√n is drawn. The promise of 95 % is about the procedure: about five in a hundred miss. With few readings s is itself uncertain, and only the k of t keeps the promise.").in_language(class.language),
        table,
        panel: Panel {
            title: class.pick("Intervals x̄ ± t s/√n", "区间 x̄ ± t s/√n"),
            x: Axis::linear(class.pick("experiment", "试验序号"), ""),
            y: Axis::linear("x", ""),
            layers: vec![
                Layer::new(class.pick("true value", "真值"), Tone::Quiet, Marks::Level(0.0)),
                Layer::new(class.pick("covers it", "包含真值"), Tone::Main, Marks::Whiskers(hits)),
                Layer::new(class.pick("misses it", "未包含真值"), Tone::Contrast, Marks::Whiskers(misses)),
            ],
        },
        figures,
    }
}

pub(super) fn rectangles(class: &Class<'_>) -> Drawn {
    let n = class.n;
    let terms = vec!["0"; n].join(", ");
    let samples = class.samples(&format!(
        "title = \"Sum\"\n[measurand.y]\nmodel = \"sum(x)\"\nunit = \"1\"\n[input]\nx = {{ values = [{terms}], half_width = 1 }}\n"
    ));
    let sums = samples.into_iter().next().unwrap_or_default();
    let u = (n as f64 / 3.0).sqrt();
    let reach = [-(n as f64), n as f64];
    let [low, high] = ends(&sums);
    let k = 0.5 * (high - low) / u;
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
        words: say!("The sum of n = {n} quantities, each anywhere between −1 and 1, drawn 10 000 times. Two make a triangle; a few look normal already (central limit theorem), and k for 95 % comes near 1.96. Where one rectangle outweighs all others it does not: k is 1.65 for it alone.").in_language(class.language),
        table,
        panel: Panel {
            title: class.pick("Distribution of the sum", "和的分布"),
            x: Axis::linear("y", ""),
            y: Axis::linear(class.pick("density", "概率密度"), ""),
            layers: vec![
                Layer::new(class.pick("drawn", "抽样"), Tone::Main, outline(&sums, reach)),
                Layer::new(class.pick("normal, same u", "正态，u 相同"), Tone::Contrast, curve(|x| normal_pdf(x / u) / u, reach)),
            ],
        },
        figures: vec![Number(u), Number(k)],
    }
}

pub(super) fn shared(class: &Class<'_>) -> Drawn {
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
        words: say!("Two weights are compared with the same standard (u = 2 mg), each by a comparison of its own (u = 1 mg). What the standard is wrong by is in both: r = {r:.2}. Their sum is less certain than squares say, their difference far more.").in_language(class.language),
        table,
        panel: Panel {
            title: class.pick("Errors of both weights", "两个砝码的误差"),
            x: Axis::linear("a", "mg"),
            y: Axis::linear("b", "mg"),
            layers: vec![Layer::new(class.pick("drawn", "抽样"), Tone::Main, Marks::Points(seen))],
        },
        figures,
    }
}
