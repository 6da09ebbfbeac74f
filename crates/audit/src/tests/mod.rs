//! Sheets from text to verdict.

mod chinese;
mod columns;
mod contained;
mod coverage;
mod digits;
mod forms;
mod further;
mod hands;
mod labels;
mod laboratories;
mod layouts;
mod limits;
mod named_figures;
mod others;
mod points;
mod reported;
mod reports;
mod several;
mod side_by_side;
mod stated;
mod statements;
mod strangers;
mod unjudged;
mod workbooks;
mod written_out;

use crate::claim::Claimed;
use crate::read::Mapping;
use crate::{Audit, Verdict, audit, budget_files, read, sheet};
use gumption_fault::language::Language;

/// The budgets of a file as they are understood.
fn understood(name: &str, text: &str) -> Vec<Claimed> {
    let grids = sheet::grids(name, text.as_bytes()).unwrap();
    read::budgets(&grids, &Mapping::default())
}

/// The budget file that a sheet is imported as.
fn imported(sheet: &str) -> String {
    let files = budget_files(
        "sheet.csv",
        sheet.as_bytes(),
        &Mapping::default(),
        Language::English,
    );
    files.unwrap().remove(0)
}

/// Whether the only budget of a file is called sound.
fn is_sound(name: &str, text: &str) {
    assert_eq!(answer(name, text), (Verdict::Sound, Vec::new()), "{text}");
}

/// Verdict and candidates of a text.
fn answer(name: &str, text: &str) -> (Verdict, Vec<String>) {
    let claims = understood(name, text);
    assert_eq!(claims.len(), 1, "{text}");
    let audited = audit(&claims[0]);
    assert!(
        audited.verdict != Verdict::Sound || is_printed_as_claimed(&audited),
        "{text}"
    );
    let found = &audited.found;
    let sets = found.explanations.iter().filter(|e| !e.acts.is_empty());
    let ids = sets.map(|e| {
        e.acts
            .iter()
            .map(|act| act.id(&found.case))
            .collect::<Vec<_>>()
            .join("+")
    });
    (audited.verdict, ids.collect())
}

/// Whether the recomputed U, rounded to nearest or up, is what is claimed: within what rows leave open that state no more
/// than printed digits.
fn is_printed_as_claimed(audited: &Audit<'_>) -> bool {
    let found = &audited.found;
    let Some(claimed) = &found.case.claimed.footer.expanded else {
        return true;
    };
    let open = found.open * found.right.expanded / found.right.u_c;
    let above = claimed.value - found.right.expanded;
    let half = claimed.half_that_decides();
    let tolerance = 1e-6 * (half + claimed.value);
    (-half - open - tolerance..2.0 * half + open + tolerance).contains(&above)
}

fn first(name: &str, text: &str) -> String {
    let (verdict, sets) = answer(name, text);
    assert!(
        matches!(verdict, Verdict::WithEffect | Verdict::WithoutEffect),
        "{verdict:?} {text}"
    );
    sets[0].clone()
}

/// A comparison of masses in the form of M3003: rows, then the figures of the whole.
fn m3003(rows: [&str; 3], whole: &str) -> String {
    format!(
        "Mass comparison\nModel: m = m_S + dm + dT\nCoverage factor k = 2\n\
         Symbol,Source of uncertainty,Value ±,Probability distribution,Divisor,c_i,u_i(y) / g,ν_i\n{}\n{whole}\n",
        rows.join("\n")
    )
}

const CERTIFICATE: &str = "m_S,\"certificate M-12: U = 0.040 g, k = 2\",0.040,normal,2,1,0.0200,∞";
const READINGS: &str = "dm,\"standard deviation s = 0.020 g of 10 readings, mean of 5 reported\",0.020,normal,√5,1,0.00894,9";
const LIMITS: &str = "dT,\"limits ±0.030 g, nothing else known\",0.030,rectangular,√3,1,0.0173,∞";
const WHOLE: &str =
    "u_c,Combined standard uncertainty,,,,,0.0279,\nU,Expanded uncertainty,,,,,0.056,";

#[test]
fn a_sound_sheet_is_sound() {
    let sheet = m3003([CERTIFICATE, READINGS, LIMITS], WHOLE);
    assert_eq!(answer("sheet.csv", &sheet), (Verdict::Sound, Vec::new()));
}

/// Each slip is put into the figures by hand, and found by its name.
#[test]
fn slips_in_rows_are_named() {
    let undivided = "m_S,\"certificate M-12: U = 0.040 g, k = 2\",0.040,normal,1,1,0.0400,∞";
    let by_root3 = "m_S,\"certificate M-12: U = 0.040 g, k = 2\",0.040,normal,√3,1,0.0231,∞";
    let single = "dm,\"standard deviation s = 0.020 g of 10 readings, mean of 5 reported\",0.020,normal,1,1,0.0200,9";
    let study = "dm,\"standard deviation s = 0.020 g of 10 readings, mean of 5 reported\",0.020,normal,√10,1,0.00632,9";
    let by_two = "dT,\"limits ±0.030 g, nothing else known\",0.030,rectangular,2,1,0.0150,∞";
    let missing = "dT,\"limits ±0.030 g, nothing else known\",0.030,rectangular,1,1,0.0300,∞";
    let triangle = "dT,\"limits ±0.030 g, nothing else known\",0.030,triangular,2.449,1,0.0122,∞";
    for (rows, u_c, expanded, id) in [
        (
            [undivided, READINGS, LIMITS],
            "0.0445",
            "0.089",
            "cert-undivided@m_S",
        ),
        (
            [by_root3, READINGS, LIMITS],
            "0.0302",
            "0.060",
            "cert-by-root3@m_S",
        ),
        (
            [CERTIFICATE, single, LIMITS],
            "0.0332",
            "0.066",
            "s-not-mean@dm",
        ),
        (
            [CERTIFICATE, study, LIMITS],
            "0.0272",
            "0.054",
            "s-wrong-m@dm",
        ),
        (
            [CERTIFICATE, READINGS, by_two],
            "0.0266",
            "0.053",
            "half-width-by-2@dT",
        ),
        (
            [CERTIFICATE, READINGS, missing],
            "0.0371",
            "0.074",
            "root3-missing@dT",
        ),
        (
            [CERTIFICATE, READINGS, triangle],
            "0.0251",
            "0.050",
            "triangle@dT",
        ),
    ] {
        let whole = format!(
            "u_c,Combined standard uncertainty,,,,,{u_c},\nU,Expanded uncertainty,,,,,{expanded},"
        );
        assert_eq!(first("sheet.csv", &m3003(rows, &whole)), id);
    }
}

#[test]
fn slips_of_the_whole_are_named() {
    let rows = [CERTIFICATE, READINGS, LIMITS];
    for (u_c, expanded, id) in [
        ("0.0463", "0.093", "linear-sum"),
        ("0.000780", "0.0016", "squares-not-rooted"),
        ("0.0265", "0.053", "row-dropped@dm"),
        ("0.0279", "0.11", "k-twice"),
        ("0.0279", "0.028", "k-forgotten"),
        ("0.0279", "0.0558", "too-many-digits"),
    ] {
        let whole = format!(
            "u_c,Combined standard uncertainty,,,,,{u_c},\nU,Expanded uncertainty,,,,,{expanded},"
        );
        assert_eq!(first("sheet.csv", &m3003(rows, &whole)), id);
    }
}

/// A figure that nothing gives has no name, and the place where it sits is said.
#[test]
fn what_nothing_gives_is_unexplained() {
    let whole = "u_c,Combined standard uncertainty,,,,,0.0313,\nU,Expanded uncertainty,,,,,0.063,";
    let (verdict, sets) = answer("sheet.csv", &m3003([CERTIFICATE, READINGS, LIMITS], whole));
    assert_eq!((verdict, sets), (Verdict::Unexplained, Vec::new()));
}

/// A Chinese sheet with semicolons and decimal commas, the symbols in front of the sources.
#[test]
fn a_chinese_sheet_is_read() {
    let sheet = "数字压力表示值误差测量结果的不确定度评定\n测量模型：δ = p_x − p_s\n\
        序号;不确定度来源;输入量估计值;评定方法;概率分布;区间半宽 a;包含因子 k;标准不确定度 u(x_i) / kPa;灵敏系数 c_i;标准不确定度分量 |c_i|u(x_i) / kPa\n\
        1;p_x 重复性，10次测量标准偏差 s = 0,012 kPa，取单次测量结果;100,02;A;正态;0,012;1;0,012;1;0,0120\n\
        2;p_s 标准器最大允许误差 ±0,05 kPa;100,00;B;均匀;0,05;2;0,025;-1;0,0250\n\
        合成标准不确定度 u_c / kPa;;;;;;;;;0,0277\n扩展不确定度 U（k=2）/ kPa;;;;;;;;;0,055\n包含因子取 k=2\n";
    assert_eq!(first("sheet.csv", sheet), "half-width-by-2@p_s");
}

/// A summary states what is known and the claim: the search is over all rows at once.
#[test]
fn a_summary_is_searched() {
    let sheet = |u_c: &str, expanded: &str| {
        format!(
            "| Quantity | Estimate | ± | What is known | c |\n|---|---|---|---|---|\n\
             | V_S | 10.0000 V | 0.0030 V | certificate, expanded uncertainty, k = 2 | 1 |\n\
             | dV_r | 0 V | 0.0010 V | digital step of the indication | 1 |\n\
             | dV_s | 0 V | 0.0042 V | s of 10 readings, mean of 5 reported | 1 |\n\
             | dV_t | 0 V | 0.0025 V | limits, nothing else known | 1 |\n\n\
             u_c = {u_c} V\n\nk = 2\n\nU = {expanded} V\n"
        )
    };
    assert_eq!(
        answer("sheet.md", &sheet("0.002819", "0.0056")).0,
        Verdict::Sound
    );
    assert_eq!(
        first("sheet.md", &sheet("0.003833", "0.0077")),
        "cert-undivided@V_S"
    );
    assert_eq!(
        first("sheet.md", &sheet("0.004696", "0.0094")),
        "s-not-mean@dV_s"
    );
}

const TOLD: &str = "Mass comparison\nModel: m = m_S + dm + dT\nCoverage factor: k = 2\n";

/// Sentences in the place of a table.
#[test]
fn a_budget_told_in_sentences_is_searched() {
    let told = format!(
        "{TOLD}m_S = 100.00 g: standard, certificate M-12, U = 0.040 g, k = 2\n\
         dm = 0.01 g: standard deviation s = 0.020 g of 10 readings, mean of 5 reported\n\
         dT = 0 g: limits ±0.030 g, nothing else known\n"
    );
    let sound = format!("{told}u_c = 0.02793 g\nU = 0.056 g\n");
    assert_eq!(answer("told.txt", &sound).0, Verdict::Sound);
    let undivided = format!("{told}u_c = 0.04450 g\nU = 0.089 g\n");
    assert_eq!(first("told.txt", &undivided), "cert-undivided@m_S");
}

/// What is known stands in one table, its evaluation in another; or rows and columns are exchanged.
#[test]
fn tables_apart_and_turned_are_read() {
    let apart = format!(
        "{TOLD}\nSymbol,Estimate,What is known\nm_S,100.00 g,\"certificate M-12, U = 0.040 g, k = 2\"\n\
         dm,0.01 g,\"s = 0.020 g of 10 readings, mean of 5 reported\"\ndT,0 g,\"limits ±0.030 g, nothing else known\"\n\n\
         Symbol,u(x_i) / g,c_i,u_i(y) / g\nm_S,0.0400,1,0.0400\ndm,0.00894,1,0.00894\ndT,0.0173,1,0.0173\n\n\
         u_c = 0.0445 g\nU = 0.089 g\n"
    );
    assert_eq!(first("apart.csv", &apart), "cert-undivided@m_S");
    let turned = format!(
        "{TOLD}\nSymbol\tm_S\tdm\tdT\n\
         What is known\tcertificate M-12, U = 0.040 g, k = 2\ts = 0.020 g of 10 readings, mean of 5 reported\tlimits ±0.030 g\n\
         Value ±\t0.040\t0.020\t0.030\nDivisor\t1\t√5\t√3\nu(x_i)\t0.0400\t0.00894\t0.0173\nc_i\t1\t1\t1\n\n\
         u_c = 0.0445 g\nU = 0.089 g\n"
    );
    assert_eq!(first("turned.tsv", &turned), "cert-undivided@m_S");
}

/// A note knows the certificate of a quantity of the model that the table leaves out.
#[test]
fn a_missing_reference_is_named() {
    let sheet = |rows: &str, u_c: &str, expanded: &str| {
        format!(
            "{TOLD}\nSymbol,u(x_i) / g,c_i,u_i(y) / g\n{rows}dm,0.00894,1,0.00894\ndT,0.0173,1,0.0173\n\n\
             u_c = {u_c} g\nU = {expanded} g\n\n\"m_S: certificate M-12, U = 0.040 g, k = 2\"\n\
             \"dm: s = 0.020 g of 10 readings, mean of 5 reported\"\n\"dT: limits ±0.030 g, nothing else known\"\n"
        )
    };
    let whole = sheet("m_S,0.0200,1,0.0200\n", "0.0279", "0.056");
    assert_eq!(answer("whole.csv", &whole).0, Verdict::Sound);
    assert_eq!(
        first("part.csv", &sheet("", "0.0195", "0.039")),
        "ref-missing@m_S"
    );
}

/// JJF 2003-2022, annex A.1: u_c = 2.12e-4 and U = 4.3e-4, rounded up.
#[test]
fn the_annex_of_jjf_2003_is_sound() {
    let sheet = "符号,不确定度来源,半宽,分布,除数,标准不确定度 u(x_i),不确定度分量 u_i(y)\n\
        u_1,\"转台校准证书 U = 2e-4, k = 2\",2e-4,正态,2,1.0e-4,1.0e-4\n\
        u_2,\"数据采集，极限 ±2.4414e-4\",2.4414e-4,均匀,1.732,1.41e-4,1.41e-4\n\
        u_3,标准不确定度 1.22e-4,1.22e-4,正态,1,1.22e-4,1.22e-4\n\
        u_c,合成标准不确定度,,,,,2.12e-4\nU,扩展不确定度 (k=2),,,,,4.3e-4\n";
    assert_eq!(answer("annex.csv", sheet).0, Verdict::Sound);
}

/// A thousand rows in well under a second, also in a debug build.
#[test]
fn a_thousand_rows() {
    let mut sheet = String::from("Symbol,Source,Value ±,Distribution,Divisor,c_i,u_i(y)\n");
    for i in 0..1000 {
        sheet.push_str(&format!(
            "x_{i},limits ±0.030,0.030,rectangular,√3,1,0.01732\n"
        ));
    }
    sheet.push_str(
        "u_c,Combined standard uncertainty,,,,,0.5477\nU,Expanded uncertainty (k = 2),,,,,1.1\n",
    );
    let start = std::time::Instant::now();
    assert_eq!(answer("large.csv", &sheet).0, Verdict::Sound);
    assert!(start.elapsed().as_secs_f64() < 5.0, "{:?}", start.elapsed());
}
