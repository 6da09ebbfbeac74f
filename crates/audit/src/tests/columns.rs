//! What columns and lines hold of which words say it otherwise than their cells, or say it twice.

use super::{answer, first, is_sound, understood};

use crate::{Verdict, audit, rules};

/// U is three times u_c, and the sheet says k = 2.
#[test]
fn u_is_another_multiple_than_its_k() {
    let list = |expanded: &str| {
        format!(
            "来源,标准不确定度/mV\n校准源,1.204\n分辨力,0.289\n重复性,0.553\n合成标准不确定度,1.356\n\"扩展不确定度 U={expanded} mV，k=2\",\n"
        )
    };
    is_sound("sheet.csv", &list("2.7"));
    assert_eq!(first("sheet.csv", &list("4.1")), "k-other");
    let sentence = |expanded: &str| {
        format!(
            "Quantity     Estimate    Standard uncertainty   Sensitivity   Contribution\n\
             t_ref        800.1 °C    1.6 °C                 1.0           1.6 °C\n\
             dt_hom       0.0 °C      1.5 °C                 1.0           1.5 °C\n\
             dt_comp      0.0 °C      1.8 °C                 1.0           1.8 °C\n\
             t_x          800.1 °C                                         2.84 °C\n\n\
             Expanded uncertainty U = {expanded} °C\n\
             The reported expanded uncertainty is the standard uncertainty multiplied by the\n\
             coverage factor k = 2.\n"
        )
    };
    is_sound("sheet.txt", &sentence("5.7"));
    assert_eq!(first("sheet.txt", &sentence("8.5")), "k-other");
}

/// Heads that span several columns say less than what stands below them: `半宽 (g)` below `标准不确定度评定` is no standard
/// uncertainty.
#[test]
fn words_below_spanning_heads_count() {
    let sheet = |expanded: &str| {
        format!(
            "序号,来源,,标准不确定度评定,,,,合成,\n,符号,名称,半宽 (g),分布,k,u(xi)/g,ci,|ci|u(xi)/g\n\
             1,m_S,标准砝码,0.045,正态,2,0.0225,1,0.0225\n2,dm_D,漂移,0.015,矩形,1.73,0.0087,1,0.0087\n\
             3,dm_C,偏心,0.01,矩形,1.73,0.0058,1,0.0058\n\n合成标准不确定度 u_c,,0.0248\n扩展不确定度 U (k=2),,{expanded}\n"
        )
    };
    is_sound("sheet.csv", &sheet("0.050"));
    assert_eq!(first("sheet.csv", &sheet("0.025")), "k-forgotten");
}

/// `s/√3` has its count, and `u as stated` says what a figure of a certificate is that was not divided.
#[test]
fn notes_say_how_u_was_found() {
    let sheet = "component,type,distribution,\"half-width, or U, s, u\",divisor,unit,u,c,c·u,ν\n\
        W,B,normal,0.03,2,g,0.015,1,0.015,∞\nd_2,B,normal,0.02,1,g,0.02,1,0.02,∞\n\
        dW,A,t,0.005022947,1,g,0.005022947,1,0.005022947,9\n\ncombined standard uncertainty u,0.0255,g\ncoverage factor k,2\n\
        expanded uncertainty U,0.051,g\n\nd_2,from its certificate ; u as stated\ndW,\"s/√3, pooled s = 0.0087\"\n";
    is_sound("sheet.csv", sheet);
    is_sound("sheet.csv", &sheet.replace("s/√3", "s/√n"));
}

/// A table of QUAM:2012 with u and u/x side by side: the second is no contribution and no share, and closes the table.
#[test]
fn relative_uncertainties_stand_beside_absolute_ones() {
    let english = |c: &str, expanded: &str| {
        format!(
            "Quantity,Value,Unit,Standard uncertainty,Relative standard uncertainty\nMass m,0.10028,g,0.00005,0.00050\n\
             Purity P,0.9999,,0.000058,0.000058\nVolume V,100.0,mL,0.07,0.00070\n{c}\nExpanded uncertainty (k=2),,mg/L,{expanded},\n"
        )
    };
    is_sound(
        "sheet.csv",
        &english("Concentration c,1002.7,mg/L,0.86,0.00086", "1.7"),
    );
    assert_eq!(
        first(
            "sheet.csv",
            &english("Concentration c,1002.7,mg/L,1.26,0.00126", "2.5")
        ),
        "linear-sum"
    );
    let chinese = |c: &str, expanded: &str| {
        format!(
            "输入量,估计值,单位,标准不确定度,相对标准不确定度/%\n质量 m,0.10028,g,0.00005,0.050\n纯度 P,0.9999,,0.000058,0.0058\n\
             体积 V,100.0,mL,0.07,0.070\n浓度 c,1002.7,mg/L,,{c}\n扩展不确定度 U (k=2),,mg/L,{expanded},\n"
        )
    };
    is_sound("sheet.csv", &chinese("0.086", "1.7"));
    assert_eq!(first("sheet.csv", &chinese("0.126", "2.5")), "linear-sum");
}

/// `Contribution %` beside u and c holds c·u where they give it.
#[test]
fn contributions_in_percent_are_no_shares() {
    let sheet = |timing: &str, u_c: &str| {
        format!(
            "No.,Source of uncertainty,Input value,Semi-range,Units,Distribution,Divisor,Standard uncertainty,Sensitivity coeff.,Contribution %\n\
             1,Weighing,60,0.020,kg,Normal,2,0.010,1.6667,0.0167\n2,Density,998.2,0.05,kg/m3,Rectangular,1.732,0.0289,0.10018,0.0029\n\
             3,Timing,72,0.05,s,Rectangular,1.732,0.0289,1.3889,{timing}\n4,Buoyancy,1.001,0.00005,1,Rectangular,1.732,0.0000289,99.9,0.0029\n\
             ,Combined standard uncertainty,,,,,,,,{u_c}\n"
        )
    };
    is_sound("sheet.csv", &sheet("0.0401", "0.0436"));
    let slip = first("sheet.csv", &sheet("0.0289", "0.0336"));
    assert!(slip.starts_with("c-one@Timing"), "{slip}");
}

/// Weighing takes the difference of two indications: √2 times the uncertainty of one (OIML R 111-1, C.6.4.3).
#[test]
fn a_resolution_may_count_twice() {
    let sheet = |d: &str, u_c: &str| {
        format!(
            "Symbol,Description,Stated,Unit,u,Sensitivity,Contribution (mg)\ndw,\"s of 6 cycles, mean reported\",0.021,mg,0.00857,1,0.00857\n\
             mr,\"Reference weight, certificate k=2\",0.100,mg,0.0500,1,0.0500\nd,Readability of the comparator 0.10 mg,0.10,mg,{d},1,{d}\n\
             uc,,,,,,{u_c}\n"
        )
    };
    is_sound("sheet.csv", &sheet("0.0408", "0.0651"));
    is_sound("sheet.csv", &sheet("0.0289", "0.0584"));
    let slip = first("sheet.csv", &sheet("0.0577", "0.0768"));
    assert_eq!(slip, "full-width@d");
}

/// The part of a division to which an indication is estimated, and an influence in a unit of its own.
#[test]
fn words_state_more_than_was_used() {
    let sheet = |u: &str, u_c: &str| {
        format!(
            "不确定度来源,符号,类别,数值 a,分布,k,u(xi) /kPa\n重复性（6次读数，单次s）,u1,A,6.1,正态,1,6.1\n\
             估读误差：分度值 20 kPa 的 1/10,u3,B,2.0,均匀,1.732,{u}\n温度变化 ±3 ℃ 的影响,u4,B,1.2,均匀,1.732,0.693\n\
             合成标准不确定度 uc,,,,,,{u_c}\n"
        )
    };
    is_sound("sheet.csv", &sheet("1.155", "6.25"));
    let slip = first("sheet.csv", &sheet("1.000", "6.22"));
    assert_eq!(slip, "half-width-by-2@u3");
}

/// `U/k = 0.8/2` states a k, and so does a column of distributions.
#[test]
fn a_factor_stands_below_a_stroke_or_in_a_column() {
    let asked = |text: &str| {
        let claims = understood("sheet.md", text);
        let audited = audit(&claims[0]);
        assert_eq!(audited.verdict, Verdict::Sound, "{text}");
        rules::findings(&audited.found)
            .iter()
            .any(|finding| finding.rule == 16)
    };
    let noted = |note: &str| {
        format!(
            "{note}\n\n| Quantity | Estimate | u | c | contribution |\n|---|---|---|---|---|\n| G_x | 1415.2 µS/cm | 0.35 | 1 | 0.35 |\n\
             | G_s | 1413.0 µS/cm | 0.40 | -1 | 0.40 |\n\nu_c = 0.53 µS/cm\n"
        )
    };
    assert!(!asked(&noted(
        "u(G_s) = U/k = 0.8/2 = 0.4 µS/cm (certificate CRM-22)"
    )));
    assert!(!asked(&noted(
        "u(G_s) = U/k = 0.8/2 = 0.4 µS/cm (certificate CRM-22, U = 0.8 µS/cm, k = 2)"
    )));
    assert!(asked(&noted("G_s: certificate CRM-22, U = 0.8 µS/cm")));
    let column = "| Source | Distribution | Value (µW/W) | Divisor | u_i (µW/W) |\n|---|---|---|---|---|\n\
         | Reference standard RD-22, certificate | expanded, k = 2 | 80 | 2 | 40.0 |\n| Drift of the reference | rectangular | 40 | 1.732 | 23.1 |\n\
         | Combined standard uncertainty | | | | 46.2 |\n";
    assert!(!asked(column));
}

/// A report of this kind of program has other tables than the budget: parameters of a fit, comparisons, results beside.
#[test]
fn other_tables_of_a_report_are_no_budgets() {
    let report = "Straight line\n\nLeast-squares fit line\n    y = B1 * x\n\n  parameter  estimate  u (fit)\n  B1           2.0744   0.0165\n\n\
         Uncertainty budget of B1\n  quantity  estimate  unit       u  distribution   ν      c     c·u      %\n  \
         B1           2.074        0.0165  t (A)         10  1.000  0.0165  100.0\n  B1           2.074        0.0165                10         0.0165  100.0\n\n  \
         combined standard uncertainty  u_c = 0.0165\n  effective degrees of freedom   ν_eff = 10\n  \
         coverage factor                k = 2.23 (t-distribution, ν = 10, p = 95 %)\n  expanded uncertainty           U = 0.037\n\n\
         Where the standard uncertainties come from\n  component  type  how u was found\n  B1         A     least squares, n = 11, s = 3.56753\n\n\
         Comparison with the claim\n                claimed             obtained\n  B1: |c|·u     0.0165  GUM      0.01653  agrees within 0.0005\n";
    is_sound("report.txt", report);
}

/// k that is stated with its reason holds: of a rectangle, and of a trapezoid (EA-4/02, S9 and S10).
#[test]
fn a_factor_holds_for_the_reason_that_is_stated() {
    let sheet = |factor: &str, expanded: &str| {
        format!(
            "quantity  estimate  unit        u  distribution  c       c·u\nV_S       100.000  V     0.00100  normal        1.000  0.00100\n\
             dV_X        0.000  V      0.0289  uniform       1.000   0.0289\ndV_S       0.0000  V     0.00635  uniform       1.000  0.00635\n\n\
             combined standard uncertainty  u_c = 0.0296 V\ncoverage factor                {factor}\nexpanded uncertainty           U = {expanded} V\n"
        )
    };
    is_sound(
        "sheet.txt",
        &sheet(
            "k = 1.65 (rectangular distribution, dominated by dV_X, p = 95 %)",
            "0.049",
        ),
    );
    is_sound(
        "sheet.txt",
        &sheet(
            "k = 1.83 (trapezoidal distribution, dominated by dV_X and dV_S, p = 95 %)",
            "0.054",
        ),
    );
}

/// Blocks of type A and B in Markdown, the first with a single source.
#[test]
fn a_block_may_have_a_single_source() {
    let sheet = |step: &str, u_c: &str| {
        format!(
            "# 水表示值误差不确定度\n\nA 类评定\n\n| 来源 | 标准不确定度/% |\n|---|---|\n| 重复性（s=0.14 %，n=3 平均） | 0.081 |\n\n\
             B 类评定\n\n| 来源 | 标准不确定度/% |\n|---|---|\n| 标准装置 U=0.2 %，k=2 | 0.100 |\n| 分辨力 0.1 % | {step} |\n\
             | 水温变化 ±0.1 % | 0.058 |\n\n合成标准不确定度 uc = {u_c} %\n"
        )
    };
    is_sound("sheet.md", &sheet("0.029", "0.144"));
    let slip = first("sheet.md", &sheet("0.058", "0.153"));
    assert!(slip.starts_with("full-width@"), "{slip}");
}

/// What is known stands in a column called specification, and of a part of an amount the unit is that of the part.
#[test]
fn specifications_are_remarks() {
    let sheet = |step: &str, u_c: &str| {
        format!(
            "Contribution,Type,Specification,Value in MΩ,Divisor,u in MΩ\nHigh-value standard,B,0.5 % of 100 MΩ (limits),0.5,1.732,0.289\n\
             Voltage coefficient,B,0.1 %,0.1,1.732,0.0577\nResolution,B,digit 0.1 MΩ,{step},1.732,{}\n\
             Repeatability,A,\"s of 10, single reading\",0.12,1,0.120\nCombined,,,,,{u_c}\n",
            if step == "0.05" { "0.0289" } else { "0.0577" }
        )
    };
    is_sound("sheet.csv", &sheet("0.05", "0.319"));
    assert_eq!(
        first("sheet.csv", &sheet("0.1", "0.323")),
        "full-width@Resolution"
    );
    let weighed = "Source,Relative standard uncertainty (%),Remark\nStandard,0.05,\"certificate U = 0.10 %, k = 2\"\n\
        Weighing,0.012,±0.1 mg/5 g\nRepeatability,0.09,\"s = 0.22 %, mean of 6 readings\"\nCombined,0.104,\n";
    is_sound("sheet.csv", weighed);
}

/// A cell without a format shows 1 for 1.000: beside figures with decimals it is no figure of one digit.
#[test]
fn a_whole_figure_has_the_decimals_of_its_column() {
    let sheet = |u: &str, u_c: &str| {
        format!(
            "Source,Half-width,Distribution,Divisor,u\nStandard,2.0,rectangular,1.732,{u}\nReading,2.0,rectangular,1.732,1.155\n\
             Temperature,1.2,rectangular,1.732,0.693\nRepeatability,6.1,normal,1,6.1\nCombined standard uncertainty,,,,{u_c}\n"
        )
    };
    is_sound("sheet.csv", &sheet("1.155", "6.35"));
    assert_eq!(
        first("sheet.csv", &sheet("1", "6.33")),
        "half-width-by-2@Standard"
    );
}

/// u of two digits was multiplied by its coefficient before it was rounded.
#[test]
fn a_contribution_follows_within_the_digits_of_u() {
    let sheet = "Symbol,Source,u,c,c·u\nn_g,gross,147,0.003417,0.503\na,centring,0.29,1.414,0.408\nb,base,0.20,1,0.20\nu_c,,,,0.678\n";
    is_sound("sheet.csv", sheet);
    // The contribution has more digits than u, and is not in the middle of what u leaves open.
    let sheet = "quantity,estimate,u,c,c·u\nn_g,2591,50.9,0.03086,1.57\nn_0,41782,204,-0.001543,-0.315\nV,0.5,0.00500,-30.98,-0.155\n\
        epsilon,0.3,0.0150,-51.64,-0.775\nf,0.6,0.115,-25.82,-2.98\nu_c,,,,3.48\n";
    is_sound("sheet.csv", sheet);
}

/// A scale factor K is no coverage factor, and a matrix of correlations no budget.
#[test]
fn a_result_may_be_called_k() {
    let sheet = "Scale factor\nK = K_fit + d_table + d_daq\n\n\
        quantity  estimate         u  distribution  c       c·u\nK_fit      1.00000  0.000122  normal        1.000  0.000122\n\
        d_table    0.00000  0.000100  normal        1.000  0.000100\nd_daq      0.00000  0.000141  uniform       1.000  0.000141\n\n\
        estimate                       K = 1.00000\ncombined standard uncertainty  u_c = 0.000212\n\
        coverage factor                k = 2 (fixed, no probability stated)\nexpanded uncertainty           U = 0.00042\n\n\
        Correlation coefficients  a      b      x0\na                         1.00   -0.90  0.11\nb                         -0.90  1.00   0.20\n\
        x0                        0.11   0.20   1.00\n";
    is_sound("sheet.txt", sheet);
}

/// The second of two results has a single input, and its model stands above the first table.
#[test]
fn a_result_of_one_input_closes_its_table() {
    let sheet = "Y1 = X1\nY2 = X2\n\nBudget of Y1\nquantity  estimate  u     distribution  c      c·u\nX1        1.0       0.50  normal        1.00   0.50\n\
        Y1        1.0       0.50                              0.50\n\nU = 1.0, k = 2\n\n\
        Budget of Y2\nquantity  estimate  u     distribution  c      c·u\nX2        3.0       0.20  normal        1.00   0.20\n\
        Y2        3.0       0.20                              0.20\n\nU = 0.40, k = 2\n";
    let claims = understood("sheet.txt", sheet);
    let verdicts: Vec<Verdict> = claims.iter().map(|claim| audit(claim).verdict).collect();
    assert_eq!(verdicts, [Verdict::Sound, Verdict::Sound]);
}

/// A model in two equations: the first is of a quantity in the second (QUAM:2012, A2).
#[test]
fn intermediate_quantities_are_put_in() {
    let sheet = |c: &str, part: &str, u_c: &str| {
        format!(
            "M = 8*A_C + 5*A_H + 4*A_O + A_K\nc = 1000*m*P/(M*V)\n\nsymbol;estimate;u;c;c·u\nm;0.3888;0.00013;0.26270;0.0000342\n\
             P;1.0;0.00029;0.1021;0.0000296\nA_C;12.0107;0.0046;{c};{part}\nA_H;1.00794;0.00040;-0.0025006;-0.0000010\n\
             A_O;15.9994;0.00017;-0.0020005;-0.0000003\nA_K;39.0983;0.000058;-0.00050013;-0.0000000\nV;18.64;0.013;-0.005479;-0.0000712\n\
             u_c;;;;{u_c}\n"
        )
    };
    is_sound("sheet.csv", &sheet("-0.0040010", "-0.0000184", "0.0000863"));
    assert_eq!(
        first(
            "sheet.csv",
            &sheet("-0.00050013", "-0.0000023", "0.0000844")
        ),
        "c-wrong@A_C"
    );
}

/// A workbook computes U and k with all their digits, and states them rounded.
#[test]
fn a_statement_rounds_what_was_computed() {
    let sheet = |stated: &str| {
        format!(
            "symbol;type;half-width;divisor;unit;u;c;c·u;ν\nm_S;normal, k = 2;0.045;2;g;0.0225;1;0.0225;∞\n\
             dm;pooled standard deviation, mean of 6 cycles;0.12;2.4494897;g;0.0489898;1;0.0489898;30\n\
             u_c;0.0539096\nk;2.0000024\nU;0.1078192\nreported;m_X = ({stated}) g\n"
        )
    };
    is_sound("sheet.csv", &sheet("10000.02 ± 0.11"));
    let (verdict, _) = answer("sheet.csv", &sheet("10000.02 ± 0.14"));
    assert!(verdict != Verdict::Sound);
}

/// Coefficients of results in grams hold the conversion of milligrams, as most rows of the sheet show: 0.002 is twice it.
#[test]
fn coefficients_may_hold_the_conversion_of_units() {
    let sheet = |made: &str, u_c: &str| {
        format!(
            "symbol;estimate;unit;u;c;c·u / g\nd;4.31;mg;0.20;0.001;0.000200\nW;0.32;mg;0.200;0.002;{made}\n\
             b;0;mg;0.0577;0.002;0.000115\nu_c;;;;;{u_c}\n"
        )
    };
    is_sound("sheet.csv", &sheet("0.000400", "0.000462"));
    assert_eq!(
        first("sheet.csv", &sheet("0.000400", "0.000715")),
        "linear-sum"
    );
}

/// The last input of a product may be as uncertain as the others together: the row of the result stands below it.
#[test]
fn a_product_is_closed_by_its_result() {
    let sheet = |u: &str, relative: &str, expanded: &str| {
        format!(
            "Description,Value x,u(x),u(x)/x\n\"Mass fraction, ng/g\",12.3,0.25,0.0203\n\"Volume, mL\",50.0,0.06,0.0012\n\
             \"Mass of sample, g\",0.5021,0.0003,0.0006\nRecovery,0.97,0.02,0.0206\n\"Result, mg/kg\",1.263,{u},{relative}\n\
             \"Expanded uncertainty, k=2\",,{expanded},\n"
        )
    };
    is_sound("sheet.csv", &sheet("0.037", "0.0290", "0.073"));
    assert_eq!(
        first("sheet.csv", &sheet("0.054", "0.0427", "0.11")),
        "linear-sum"
    );
}

/// What is known in a bracket between the symbol of u and its figure.
#[test]
fn brackets_say_what_is_known() {
    let sheet = |u4: &str, u_c: &str, expanded: &str| {
        format!(
            "Pressure transducer calibration, 1 MPa\n\nu1 (reference standard, U = 0.010 kPa, k = 2)          = 0.0050 kPa\n\
             u2 (hysteresis, limits +/- 0.02 kPa)                    = 0.0115 kPa\nu3 (resolution, 0.010 kPa)                              = 0.0029 kPa\n\
             u4 (repeatability, s = 0.012 kPa, mean of 10 readings)  = {u4} kPa\n\nu_c = {u_c} kPa\nU = {expanded} kPa (k = 2)\n"
        )
    };
    is_sound("sheet.txt", &sheet("0.0038", "0.0134", "0.027"));
    assert_eq!(
        first("sheet.txt", &sheet("0.0120", "0.0176", "0.035")),
        "s-not-mean@u4"
    );
}

/// The rule for k stands beside its figure, which a cell shows with a zero more.
#[test]
fn a_rule_may_stand_beside_its_factor() {
    let sheet = |k: &str, expanded: &str| {
        format!(
            "分量,来源,类型,ui,νi\nu1,标准曲线拟合（最小二乘，s=0.0035，n=18）,A,0.021,16\nu2,\"标准溶液 U=0.024 mg/L，k=2\",B,0.012,∞\n\
             u3,重复性 6次测量平均值,A,0.025,5\nuc,,,0.0348,16\nkp,\"p=95%，t分布\",,{k},\nU95,,,{expanded},\n"
        )
    };
    is_sound("sheet.csv", &sheet("2.120", "0.074"));
    assert_eq!(first("sheet.csv", &sheet("2.000", "0.070")), "k2-low-dof");
}

/// Whoever divides s by n means the mean of n: u_c = √((0.05²/10) + 0.01² + (0.005²/3)) mV = 0.0189 mV.
#[test]
fn a_divisor_that_is_the_number_of_readings_means_their_mean() {
    let sheet = "Source,Type,Value,Divisor,u\n\"Repeatability (10 readings, s = 0.050 mV)\",A,0.050 mV,10,0.0050 mV\n\
                 \"Reference standard (certificate U, k = 2)\",B,0.020 mV,2,0.0100 mV\nResolution,B,0.005 mV,1.732,0.0029 mV\n\
                 Combined standard uncertainty,,,,0.0115 mV\nExpanded uncertainty (k = 2),,,,0.023 mV\n";
    assert!(first("sheet.csv", sheet).starts_with("s-over-n"));
    let claims = understood("sheet.csv", sheet);
    let u_c = audit(&claims[0]).found.right.u_c;
    assert!((u_c - 0.018_930).abs() < 1e-5, "{u_c}");
}

/// Findings of a text, by their rules, with their numbers.
fn numbers(text: &str) -> Vec<(u8, String)> {
    let claims = understood("sheet.md", text);
    let findings = rules::findings(&audit(&claims[0]).found);
    let one = |finding: rules::Finding| (finding.rule, finding.numbers);
    findings.into_iter().map(one).collect()
}

/// A distribution has its divisor, in whichever language it is named.
#[test]
fn a_divisor_is_that_of_the_distribution_in_every_language() {
    let wrong = |distribution: &str, divisor: &str| {
        let sheet = format!(
            "Quantity,Value,Unit,Distribution,Divisor,u,c,c*u\nlimits of gauge ±0.6,0.6,mm,{distribution},{divisor},0.346,1,0.346\n\
             repeatability,0.2,mm,normal,1,0.2,1,0.2\ncombined,,,,,,,0.40\nexpanded U (k=2),,,,,,,0.80\n"
        );
        let claims = understood("sheet.csv", &sheet);
        let findings = rules::findings(&audit(&claims[0]).found);
        findings.iter().any(|finding| finding.rule == 13)
    };
    for (triangle, rectangle) in [
        ("triangular", "rectangular"),
        ("Dreieck", "Rechteck"),
        ("dreieckverteilt", "gleichverteilt"),
        ("三角", "均匀"),
    ] {
        assert!(wrong(triangle, "1.732"), "{triangle}");
        assert!(!wrong(rectangle, "1.732"), "{rectangle}");
        assert!(!wrong(triangle, "2.449"), "{triangle}");
    }
    // How wide the top of a trapezoid is, its name does not say.
    assert!(!wrong("trapezoidal", "1.732"));
}

/// A model without a value has no u_c of which a row were a part.
#[test]
fn nothing_is_a_part_of_an_infinite_u_c() {
    let text = include_str!("../../../../docs/examples/four-point-tumble.md");
    let without_end = text.replace("(2 * R * a)", "(0.0 * R * a)");
    assert_ne!(text, without_end);
    for (rule, numbers) in numbers(&without_end) {
        assert!(!numbers.contains("NaN"), "{rule}: {numbers}");
        assert!(![75, 76].contains(&rule), "{rule}: {numbers}");
    }
}

/// The forms of M3003 abbreviate the distributions: √(0.25² + 0.1155² + 0.0577² + 0.09²) = 0.2955 ″, where the half-width of
/// the drift as it stands gives 0.3375 ″.
#[test]
fn letters_stand_for_distributions() {
    let sheet = |[normal, flat]: [&str; 2], drift: &str, whole: &str| {
        format!(
            "Angle calibrator\nSource,Limits ±,Unit,Distr.,Sensitivity,Contribution u_i(y) / ″\n\
             \"Autocollimator, certificate (k=2)\",0.50,″,{normal},1,0.25\nPolygon drift,0.20,″,{flat},1,{drift}\n\
             Resolution,0.10,″,{flat},1,0.058\n\"Repeatability, standard error\",0.09,″,{normal},1,0.09\n{whole}\n"
        )
    };
    let sound =
        "Combined standard uncertainty u_c,,,,,0.295\nExpanded uncertainty U (k = 2),,,,,0.59";
    let undivided =
        "Combined standard uncertainty u_c,,,,,0.338\nExpanded uncertainty U (k = 2),,,,,0.68";
    for letters in [["N", "R"], ["n", "U"], ["gauss", "square"], ["N.", "R."]] {
        is_sound("sheet.csv", &sheet(letters, "0.115", sound));
    }
    let slip = first("sheet.csv", &sheet(["N", "R"], "0.200", undivided));
    assert_eq!(slip, "root3-missing@Polygon drift");
    // What is no distribution is told.
    let claims = understood("sheet.csv", &sheet(["N", "Q"], "0.115", sound));
    let unread: Vec<&str> = claims[0]
        .unplaced
        .iter()
        .map(|cell| cell.text.as_str())
        .collect();
    assert_eq!(unread, ["Q"]);
}

/// The form of the DKD writes u in g and contributions in mg: √(22.5² + 8.66² + 14.4² + 5.8²) mg = 28.7 mg = 0.0287 g, which is
/// 0.0514 g where the amounts are added.
#[test]
fn cells_of_a_column_have_their_own_units() {
    let sheet = |[m_n, drift, reading, air]: [&str; 4], u_c: &str, expanded: &str| {
        format!(
            "Messunsicherheitsbudget Gewichtstück 10 kg\nModellgleichung: m_X = m_N + δm_D + Δm + δm_B\n\n\
             Größe Xi;Schätzwert xi;Standardmessunsicherheit u(xi);Verteilung;Freiheitsgrad νi;Sensitivitätskoeffizient ci;Unsicherheitsbeitrag ui(y)\n\
             m_N;10000,005 g;{m_n};Normal;50;1;22,5 mg\nδm_D;0 g;{drift};Rechteck;∞;1;8,66 mg\n\
             Δm;0,020 g;{reading};Normal;11;1;14,4 mg\nδm_B;0 g;{air};Rechteck;∞;1;5,8 mg\n\
             m_X;10000,025 g;{u_c};;74;;\n\nErgebnis: m_X = 10000,025 g ± {expanded} (k = 2)\n"
        )
    };
    let in_g = ["0,0225 g", "0,00866 g", "0,0144 g", "0,0058 g"];
    let in_mg = ["22,5 mg", "8,66 mg", "14,4 mg", "5,8 mg"];
    for u in [in_g, in_mg] {
        is_sound("sheet.csv", &sheet(u, "0,0287 g", "0,057 g"));
    }
    let added = sheet(in_g, "0,0514 g", "0,10 g").replace(";74;", ";;");
    assert!(first("sheet.csv", &added).starts_with("linear-sum"));
}

/// `Contribution (%)` holds shares in the variance where they total 100: 0.050² is 13.6 % of 0.1358² mg².
#[test]
fn shares_in_percent_total_a_hundred() {
    let sheet = |title: &str, total: &str, u_c: &str, expanded: &str| {
        format!(
            "{title}\nComponent;Value;Distribution;Divisor;Standard uncertainty (mg);Contribution (%)\n\
             Standard (certificate, U k=2);0,10 mg;normal;2;0,050;13,6\nDrift of standard;± 0,06 mg;uniform;√3;0,0346;6,5\n\
             Resolution (d = 0,1 mg);± 0,05 mg;uniform;√3;0,0289;4,5\nEccentricity;± 0,15 mg;uniform;√3;0,0866;40,7\n\
             Repeatability, standard deviation;0,08 mg;normal;1;0,08;34,7\n{total}\
             Combined standard uncertainty;;;;{u_c};\nExpanded uncertainty (k = 2);;;;{expanded};\n"
        )
    };
    for title in ["Uncertainty budget", "Uncertainty budget - balance 200 g"] {
        for total in ["", ";;;;;100\n", ";;;;;\n"] {
            is_sound("sheet.csv", &sheet(title, total, "0,136", "0,27"));
        }
        // The amounts added: 0.050 + 0.0346 + 0.0289 + 0.0866 + 0.08.
        let slip = first("sheet.csv", &sheet(title, "", "0,280", "0,56"));
        assert_eq!(slip, "linear-sum");
    }
}

/// The form of UKAS and NABL: `Std. unc. (µm)` is value / divisor · c, 1 °C/1.732 · 1.15 µm/°C = 0.664 µm. √(0.06² + 0.058² +
/// 0.664² + 2.887² + 1.6²) = 3.368 µm; with c left out 0.577 stands for 0.664, and it is 3.352 µm.
#[test]
fn u_may_have_its_coefficient_in_it() {
    let sheet = |head: &str, made: &str, u_c: &str, nu: &str| {
        format!(
            "Caliper 150 mm\nContributor,Input uncertainty,Unit,Prob. distribution,Divisor,Sens. coeff.,{head},ν\n\
             \"Gauge block calibration (U, k=2)\",0.12,µm,Normal,2,1,0.06,∞\nGauge block drift,0.10,µm,Rectangular,1.732,1,0.058,∞\n\
             Temperature difference ±1 °C,1,°C,Rectangular,1.732,1.15,{made},∞\n\
             Resolution (0.01 mm → ±5 µm),5,µm,Rectangular,1.732,1,2.887,∞\n\
             \"Repeatability, std. dev. of mean, n=10\",1.6,µm,Normal,1,1,1.6,9\n\
             ,,,,,u_c,{u_c},\n,,,,,νeff,{nu},\n,,,,,k,2,\n,,,,,U (µm),6.7,\n"
        )
    };
    for head in ["Std. unc. (µm)", "ui(y) (µm)"] {
        is_sound("sheet.csv", &sheet(head, "0.664", "3.368", "176"));
        // 3.368 without the first row is 3.367, and no explanation of 3.352.
        let (verdict, slips) = answer("sheet.csv", &sheet(head, "0.577", "3.352", "173"));
        assert_eq!(verdict, Verdict::WithoutEffect);
        assert_eq!(slips[0], "c-one@Temperature difference ±1 °C");
        assert!(!slips.iter().any(|slip| slip.starts_with("row-dropped")));
    }
}

/// Three weights of 0.25 mg each that are fully correlated, and 0.10 mg: √(0.75² + 0.1²) = 0.757 mg, where without correlations
/// it is 0.444 mg.
#[test]
fn a_line_may_state_several_correlations() {
    let sheet = |line: &str, u_c: &str, expanded: &str| {
        format!(
            "Three 1 kg weights as a 3 kg standard\n\"Model: m = m1 + m2 + m3 + d\"\n\"{line}\"\n\
             Symbol,Component,Uncertainty (mg),Distribution,Divisor,u (mg),c\nm1,Weight 1 certificate U k=2,0.50,normal,2,0.25,1\n\
             m2,Weight 2 certificate U k=2,0.50,normal,2,0.25,1\nm3,Weight 3 certificate U k=2,0.50,normal,2,0.25,1\n\
             d,Repeatability,0.10,normal,1,0.10,1\n,Combined,,,,{u_c},\n,Expanded k=2,,,,{expanded},\n"
        )
    };
    for line in [
        "r(m1,m2) = r(m1,m3) = r(m2,m3) = 1",
        "r(m1,m2)=1, r(m1,m3)=1, r(m2,m3)=1",
        "r(m1,m2) = 1; r(m1,m3) = 1; r(m2,m3) = 1",
        "r(m1 ; m2) = r(m1 ; m3) = r(m2 ; m3) = 1",
        "m1, m2 and m3 are fully correlated (r = 1)",
    ] {
        is_sound("sheet.csv", &sheet(line, "0.76", "1.5"));
        let slip = first("sheet.csv", &sheet(line, "0.44", "0.89"));
        assert_eq!(slip, "corr-ignored", "{line}");
    }
}

/// A triangle for the capacity of a flask (QUAM:2012, A1), which the title names: √(0.0408² + 0.0485² + 0.02²) = 0.0665 mL.
#[test]
fn a_title_may_name_the_glassware() {
    let sheet = |title: &str| {
        format!(
            "{title}\nComponent,Value ±,Distribution,Divisor,c,u / mL\nCalibration ±0.1 mL,0.1 mL,triangular,√6,1,0.0408\n\
             Temperature ±4 °C,4 °C,rectangular,√3,0.021 mL/°C,0.0485\nRepeatability,0.02 mL,normal,1,1,0.02\nu_c,,,,,0.0665\n\"U, k=2\",,,,,0.13\n"
        )
    };
    is_sound("sheet.csv", &sheet("Volumetric flask 100 mL"));
    assert!(first("sheet.csv", &sheet("Dispenser 100 mL")).starts_with("triangle@"));
}

/// The upper line of a head may end before the lower one: the last column is one of the table all the same.
#[test]
fn the_upper_line_of_a_head_may_be_shorter() {
    let sheet = |part: &str, u_c: &str, expanded: &str| {
        format!(
            "Two heads\nInput quantity,,,Uncertainty\nSymbol,Estimate,Unit,a or U,Distribution,u,c,u_i(L) / µm\n\
             L_S,100.0002,mm,0.00012,\"normal, k=2\",0.00006,1,0.06\nΔt,0.0,K,0.5,rectangular,0.2887,1.15 µm/K,{part}\n\
             d,0.3,µm,0.04,\"normal, s of mean, n = 10\",0.04,1,0.04\nu_c(L),,,,,,,{u_c}\nU (k=2),,,,,,,{expanded}\n"
        )
    };
    is_sound("sheet.csv", &sheet("0.332", "0.34", "0.68"));
    assert_eq!(
        first("sheet.csv", &sheet("0.289", "0.30", "0.60")),
        "c-one@Δt"
    );
}

/// A mark between thousands is the one that a figure with decimals shows.
#[test]
fn thousands_may_have_a_mark() {
    let sheet = |mark: &str, decimals: &str, expanded: &str| {
        let figure = |text: &str| {
            text.replace('.', "#")
                .replace(',', mark)
                .replace('#', decimals)
        };
        format!(
            "Source;Half-width / Ω;Distribution;Divisor;u / Ω\nStandard (k=2);{};normal;2;{}\nDrift;{};rectangular;{};{}\n\
             Repeatability of mean;{};normal;1;{}\nu_c;;;;{}\nU (k=2);;;;{}\n",
            figure("1,200.0"),
            figure("600.0"),
            figure("2,500.0"),
            figure("1.732"),
            figure("1,443.4"),
            figure("800.0"),
            figure("800.0"),
            figure("1,755.9"),
            figure(expanded),
        )
    };
    for (mark, decimals) in [(",", "."), (".", ","), ("'", "."), (" ", ".")] {
        is_sound("sheet.csv", &sheet(mark, decimals, "3,500"));
        let wrong = first("sheet.csv", &sheet(mark, decimals, "5,300"));
        assert_eq!(wrong, "k-other", "{mark}");
    }
}

/// K in the column of units is the kelvin, and no coverage factor.
#[test]
fn the_kelvin_is_no_factor() {
    for c in ["L·α", "c=2 mm/K", "≈2 mm/K"] {
        let sheet = |u_c: &str, expanded: &str| {
            format!(
                "Source;u;Unit;c;u_i / mm\nTemperature;0.100;K;{c};0.200\nStandard;0.200;mm;1;0.200\n\
                 Repeatability of mean;0.050;mm;1;0.050\nu_c;;;;{u_c}\nU (k=2);;;;{expanded}\n"
            )
        };
        is_sound("sheet.csv", &sheet("0.287", "0.57"));
        assert_eq!(
            first("sheet.csv", &sheet("0.206", "0.41")),
            "row-dropped@Temperature"
        );
    }
}

/// A comma with a blank behind it is one of a sentence where the line has more fields than the others.
#[test]
fn commas_of_sentences_need_no_quotes() {
    let sheet = |u: &str, u_c: &str, expanded: &str| {
        format!(
            "Balance 6 kg\nSource,Value / g,Distribution,Divisor,u / g\nCalibration certificate U = 0.8 g k = 2,0.8,normal,2,{u}\n\
             Repeatability, s of mean n = 10,0.21,normal,1,0.2100\nEccentricity ±0.5 g,0.5,rectangular,√3,0.2887\n\
             Resolution 1 g,0.5,rectangular,√3,0.2887\nCombined standard uncertainty,,,,{u_c}\nExpanded uncertainty k = 2,,,,{expanded}\n"
        )
    };
    is_sound("sheet.csv", &sheet("0.4000", "0.6089", "1.2"));
    let undivided = first("sheet.csv", &sheet("0.8000", "0.9224", "1.8"));
    assert!(undivided.starts_with("cert-undivided@"), "{undivided}");
}
