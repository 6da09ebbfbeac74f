//! Models: where the trials lead, where worst case and first order part from them.

use gumption_core::special::{normal_pdf, normal_two_sided_quantile};
use gumption_core::statistics::mean_and_deviation;
use gumption_fault::say;
use gumption_format::document::{Axis, ColumnKind, Layer, Marks, Panel, Table, Tone};
use gumption_format::machine::Number;
use gumption_report::grouped;

use super::{Class, Count, Drawn, P, SEEN, curve, ends, outline};

/// Equal steps of the slider multiply the trials alike: the last of them, STEP³⁰, is all 10 000.
const STEP: f64 = 1.359_356_39;

/// Trials at a step of the slider.
pub(super) const TRIALS: Count = Count {
    symbol: "M",
    at: |step| STEP.powi(step as i32).round() as usize,
};

/// The first trials of a product; the slider adds to those that are there, from two to all.
pub(super) fn histogram(class: &Class<'_>) -> Drawn {
    let samples = class.samples(
        "title = \"Product\"\n[measurand.y]\nmodel = \"a * b\"\nunit = \"1\"\n\
         [input]\na = { value = 1, u = 0.2 }\nb = { value = 1, half_width = 0.2 }\n",
    );
    let all = samples.into_iter().next().unwrap_or_default();
    let drawn = &all[..(TRIALS.at)(class.n).min(all.len())];
    let trials = grouped(drawn.len() as u64);
    // u² = u²(a) + u²(b): at the estimates both coefficients are 1.
    let u = 0.2 * (4.0_f64 / 3.0).sqrt();
    let reach = [1.0 - 4.0 * u, 1.0 + 4.0 * u];
    let mut table = Table::new([
        (
            class.language.pick("trials", "试验次数"),
            ColumnKind::Numbers,
        ),
        (class.language.pick("mean", "平均值"), ColumnKind::Numbers),
        ("s", ColumnKind::Numbers),
        (
            class.language.pick("95 % interval", "95 % 区间"),
            ColumnKind::Numbers,
        ),
    ]);
    let beside = (drawn.len() < all.len()).then_some(all.as_slice());
    for samples in [Some(drawn), beside].into_iter().flatten() {
        let ((centre, s), [low, high]) = (mean_and_deviation(samples), ends(samples));
        table.push(vec![
            grouped(samples.len() as u64).into(),
            format!("{centre:.3}").into(),
            format!("{s:.3}").into(),
            format!("[{low:.3}, {high:.3}]").into(),
        ]);
    }
    let rug = drawn.iter().take(10 * SEEN).map(|x| [*x, 0.0]);
    let (centre, s) = mean_and_deviation(drawn);
    Drawn {
        words: say!("Monte Carlo does what a laboratory cannot: it repeats the measurement. Each trial draws a value of a (normal, u = 0.2) and one of b (anywhere within ±0.2), and multiplies them. The slider adds trials to those that are there, from 2 to 10 000; now there are {trials}. A few say little, hundreds show the shape, and only thousands the ends of an interval: u is known to one part in √(2 M) after M trials.").in_language(class.language),
        table,
        panel: Panel {
            title: class.pick("Trials so far", "已作的试验"),
            x: Axis::linear("y", ""),
            y: Axis::linear(class.pick("density", "概率密度"), ""),
            layers: vec![
                Layer::new(class.pick("trials", "试验"), Tone::Quiet, Marks::Points(rug.collect())),
                Layer::new(class.pick("histogram", "直方图"), Tone::Main, outline(drawn, reach)),
                Layer::new(
                    class.pick("GUM", "GUM 法"),
                    Tone::Contrast,
                    curve(|x| normal_pdf((x - 1.0) / u) / u, reach),
                ),
            ],
        },
        figures: vec![Number(drawn.len() as f64), Number(centre), Number(s)],
    }
}

/// Resistors in series, each within a tolerance: the worst case, the law of propagation, and what is drawn.
pub(super) fn resistors(class: &Class<'_>) -> Drawn {
    let k = normal_two_sided_quantile(P);
    let mut table = Table::new([
        ("n", ColumnKind::Numbers),
        (
            class.language.pick("worst case / Ω", "最坏情况 / Ω"),
            ColumnKind::Numbers,
        ),
        (
            class.language.pick("U, GUM / Ω", "GUM 法的 U / Ω"),
            ColumnKind::Numbers,
        ),
        (
            class.language.pick("95 % drawn / Ω", "抽样的 95 % / Ω"),
            ColumnKind::Numbers,
        ),
        (
            class.language.pick("largest / Ω", "最大 / Ω"),
            ColumnKind::Numbers,
        ),
    ]);
    let (mut worst, mut gum, mut seen, mut figures) = (vec![], vec![], vec![], vec![]);
    for n in 1..=class.n {
        let zeros = vec!["0"; n].join(", ");
        let samples = class.samples(&format!(
            "title = \"Box\"\n[measurand.R]\nmodel = \"sum(x)\"\nunit = \"ohm\"\n[input]\nx = {{ values = [{zeros}], unit = \"ohm\", half_width = 1 }}\n"
        ));
        let errors = samples.into_iter().next().unwrap_or_default();
        let [low, high] = ends(&errors);
        let half = 0.5 * (high - low);
        let expanded = k * (n as f64 / 3.0).sqrt();
        let largest = errors.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let at = n as f64;
        worst.push([at, at]);
        gum.push([at, expanded]);
        seen.push([at, half]);
        table.push(vec![
            n.to_string().into(),
            n.to_string().into(),
            format!("{expanded:.2}").into(),
            format!("{half:.2}").into(),
            format!("{largest:.2}").into(),
        ]);
        figures = vec![Number(at), Number(expanded), Number(half)];
    }
    Drawn {
        words: class.pick(
            "A box holds up to n resistors of 1 kΩ in series, each within ±1 Ω. In the worst case all are off by 1 Ω to the same side, and limits add: n Ω. Errors that know nothing of each other seldom agree: their squares add, and U grows as √n. Of 10 000 boxes drawn, 95 % lie within the U of the GUM, and none comes near the worst case as n grows. If all were of one batch and off alike, the worst case would be right: that is a correlation, and belongs into the budget.",
            "电阻箱由至多 n 个 1 kΩ 电阻串联而成，每个的误差在 ±1 Ω 以内。最坏情况下全部偏向同一侧，各限直接相加：n Ω。互不相关的误差很少一致：其平方相加，U 按 √n 增大。抽取 10 000 个电阻箱，95 % 在 GUM 法的 U 以内；n 增大时没有一个接近最坏情况。若全部出自同一批且偏差相同，最坏情况才成立：那是相关性，应写入评定。",
        ),
        table,
        panel: Panel {
            title: class.pick("Half-width of the sum", "总和的半宽"),
            x: Axis::linear("n", ""),
            y: Axis::linear(class.pick("half-width", "半宽"), "Ω"),
            layers: vec![
                Layer::new(class.pick("worst case", "最坏情况"), Tone::Contrast, Marks::Line(worst)),
                Layer::new(class.pick("U by the GUM", "GUM 法的 U"), Tone::Main, Marks::Line(gum)),
                Layer::new(class.pick("95 % drawn", "抽样的 95 %"), Tone::Main, Marks::Points(seen)),
            ],
        },
        figures,
    }
}

/// The square of a quantity: at zero its slope, and with it the first order, says nothing.
pub(super) fn square(class: &Class<'_>) -> Drawn {
    // In units of u(a): zero where the slider begins.
    let a = (class.n as f64 - 5.0) / 5.0;
    let samples = class.samples(&format!(
        "title = \"Square\"\n[measurand.y]\nmodel = \"a^2\"\nunit = \"1\"\n[input]\na = {{ value = {a}, u = 1 }}\n"
    ));
    let drawn = samples.into_iter().next().unwrap_or_default();
    let [first, second] = [2.0 * a.abs(), (4.0 * a * a + 2.0).sqrt()];
    let ((centre, s), [low, high]) = (mean_and_deviation(&drawn), ends(&drawn));
    let k = normal_two_sided_quantile(P);
    let mut table = Table::new([
        ("", ColumnKind::Names),
        ("y", ColumnKind::Numbers),
        ("u", ColumnKind::Numbers),
        (
            class.language.pick("95 % interval", "95 % 区间"),
            ColumnKind::Numbers,
        ),
    ]);
    let mut row = |what: String, y: f64, u: f64, [low, high]: [f64; 2]| {
        table.push(vec![
            what.into(),
            format!("{y:.2}").into(),
            format!("{u:.2}").into(),
            format!("[{low:.2}, {high:.2}]").into(),
        ]);
    };
    for (what, y, u) in [
        (class.pick("GUM, first order", "GUM 法，一阶"), a * a, first),
        (
            class.pick("GUM, second order", "GUM 法，二阶"),
            a * a + 1.0,
            second,
        ),
    ] {
        row(what, y, u, [y - k * u, y + k * u]);
    }
    row(class.pick("drawn", "抽样"), centre, s, [low, high]);
    let reach = [-4.0, (a.abs() + 3.0).powi(2)];
    let mut layers = vec![Layer::new(
        class.pick("drawn", "抽样"),
        Tone::Main,
        outline(&drawn, reach),
    )];
    if first > 0.0 {
        let gum = curve(|x| normal_pdf((x - a * a) / first) / first, reach);
        layers.push(Layer::new(
            class.pick("GUM, first order", "GUM 法，一阶"),
            Tone::Contrast,
            gum,
        ));
    }
    Drawn {
        words: say!("y = a² with u(a) = 1 at a = {a:.1} (the slider moves a; 5 is zero). At zero the slope is zero, and the law of propagation gives u(y) = 0: it looks at the slope alone. But a is not exactly zero, and its square is never below: y is 1 on average, and lies between 0 and 5. The second order finds mean and u, and not that the interval cannot begin below zero. From a about three times u(a) on, the first order is good enough.").in_language(class.language),
        table,
        panel: Panel {
            title: class.pick("Distribution of a²", "a² 的分布"),
            x: Axis::linear("y", ""),
            y: Axis::linear(class.pick("density", "概率密度"), ""),
            layers,
        },
        figures: [a * a, first, a * a + 1.0, second, centre, s].map(Number).to_vec(),
    }
}

/// An accelerometer turned through four positions on a support that is not level.
pub(super) fn tumble(class: &Class<'_>) -> Drawn {
    /// Scatter of a reading, in units of g.
    const SCATTER: f64 = 2e-5;
    let level = class.n as f64;
    let samples = class.samples(&format!(
        "title = \"Tumble\"\n[measurand]\nlevel = {{ model = \"eps\", unit = \"rad\" }}\n\
         one = {{ model = \"sin(eps) + r2\", unit = \"1\" }}\n\
         four = {{ model = \"(cos(eps) + r1 + sin(eps) + r2 - cos(eps) + r3 - sin(eps) + r4) / 4\", unit = \"1\" }}\n\
         scale = {{ model = \"(cos(eps) + r1 + cos(eps) - r3) / 2\", unit = \"1\" }}\n\
         [input]\neps = {{ value = 0, unit = \"mrad\", u = {level} }}\n\
         r1 = {{ value = 0, u = {SCATTER} }}\nr2 = {{ value = 0, u = {SCATTER} }}\n\
         r3 = {{ value = 0, u = {SCATTER} }}\nr4 = {{ value = 0, u = {SCATTER} }}\n"
    ));
    let [levels, one, four, scale] = match samples.as_slice() {
        [a, b, c, d] => [a.clone(), b.clone(), c.clone(), d.clone()],
        _ => Default::default(),
    };
    let error: Vec<f64> = scale.iter().map(|k| k - 1.0).collect();
    let first_of_one = (1e-6 * level * level + SCATTER * SCATTER).sqrt();
    let mut table = Table::new([
        ("10⁻⁶", ColumnKind::Names),
        (
            class.language.pick("u, first order", "u，一阶"),
            ColumnKind::Numbers,
        ),
        (
            class.language.pick("s drawn", "抽样的 s"),
            ColumnKind::Numbers,
        ),
        (
            class.language.pick("mean error", "平均误差"),
            ColumnKind::Numbers,
        ),
    ]);
    let rows = [
        (
            class.pick("bias, one position", "零偏，单位置"),
            first_of_one,
            &one,
        ),
        (
            class.pick("bias, mean of four", "零偏，四位置平均"),
            0.5 * SCATTER,
            &four,
        ),
        (
            class.pick("scale factor", "标度因数"),
            SCATTER / 2.0_f64.sqrt(),
            &error,
        ),
    ];
    for (what, first, drawn) in rows {
        let (centre, s) = mean_and_deviation(drawn);
        // Without a sign of nothing.
        let millionths = |x: f64| format!("{:.1}", (1e7 * x).round() / 10.0 + 0.0);
        table.push(vec![
            what.into(),
            millionths(first).into(),
            millionths(s).into(),
            millionths(centre).into(),
        ]);
    }
    let points = levels.iter().zip(&error).take(10 * SEEN);
    let points: Vec<[f64; 2]> = points
        .map(|(eps, error)| [1e3 * eps, 1e6 * error])
        .collect();
    Drawn {
        words: say!("An accelerometer is turned to 0°, 90°, 180° and 270° on a support whose level is known to u = {level:.0} mrad (the slider). In one horizontal reading the level error is in the bias to its full size; in the mean of all four it cancels. In the scale factor, (E₀ − E₁₈₀)/2, it acts by its cosine: always too small, by ε²/2 on average. A first-order budget has nothing of that, since the slope of the cosine at zero is zero: it is a correction, not a scatter.").in_language(class.language),
        table,
        panel: Panel {
            title: class.pick("Error of the scale factor against the level error", "标度因数的误差随水平误差的变化"),
            x: Axis::linear(class.pick("level error", "水平误差"), "mrad"),
            y: Axis::linear(class.pick("error of the scale factor", "标度因数误差"), "10⁻⁶"),
            layers: vec![
                Layer::new(class.pick("first order", "一阶"), Tone::Contrast, Marks::Level(0.0)),
                Layer::new(class.pick("drawn", "抽样"), Tone::Main, Marks::Points(points)),
            ],
        },
        figures: vec![
            Number(mean_and_deviation(&one).1),
            Number(mean_and_deviation(&four).1),
            Number(mean_and_deviation(&error).0),
        ],
    }
}
