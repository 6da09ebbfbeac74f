//! What reports print beside their tables, and what follows from it.

use super::{answer, first, is_sound, understood};

use crate::{Verdict, audit};

/// GUM H.2: |Z| with r(V, I) = -0.355, which is printed as -0.36: from that u_c is 0.2367.
#[test]
fn a_printed_correlation_is_rounded() {
    let text = |r: &str| {
        format!(
            "quantity  estimate   unit  u           distribution  ν  c       c·u\nV         4.9990     V     0.00321     t (A)         4  50.86   0.1633\n\
             I         0.0196610  A     0.00000947  t (A)         4  -12932  -0.1225\nZ         254.26     Ω                               4          0.2363\n\n\
             U = 0.47 Ω (k = 2)\nr(V, I) = {r}\n"
        )
    };
    is_sound("report.txt", &text("-0.355"));
    is_sound("report.txt", &text("-0.36"));
    let (verdict, _) = answer("report.txt", &text("-0.30"));
    assert_ne!(verdict, Verdict::Sound);
}

/// Of ten coefficients of 1 three are missing: what is printed does not fit together, and no slip is named for it.
#[test]
fn impossible_correlations_explain_nothing() {
    let text = |list: &str| {
        format!(
            "Symbol  u / Ω  c  u_i / Ω\nR1      0.100  1  0.100\nR2      0.100  1  0.100\nR3      0.100  1  0.100\n\n\
             {list}\nu_c = 0.300 Ω\nU = 0.60 Ω (k = 2)\n"
        )
    };
    is_sound("report.txt", &text("r(R1, R2, R3) = 1.00"));
    assert_eq!(first("report.txt", &text("r(R1, R2) = 0.10")), "linear-sum");
    let missing = text("r(R1, R2) = 1.00\nr(R1, R3) = 1.00");
    assert_eq!(
        answer("report.txt", &missing),
        (Verdict::Unexplained, Vec::new())
    );
}

/// Parts have the coefficient of their quantity, which holds the conversion from mm to µm.
#[test]
fn parts_have_the_coefficient_of_the_whole() {
    is_sound(
        "report.txt",
        "E = L_m - L_0 * (1 + alpha * (t - 20 '°C'))\n\n\
         quantity           estimate   unit      u        distribution  ν   c        c·u\n\
         L_0                400.00021  mm        0.00022  normal (B)    ∞   -1000    -0.22\n\
         L_m                400.00180  mm        0.00035                15  1000     0.35\n\
         \x20 repeatability               mm        0.00034  t (B)         14           0.34\n\
         \x20 resolution                  mm        0.00008  uniform (B)   ∞            0.08\n\
         alpha              11.5       µm/(m·K)  0.577    uniform (B)   ∞   -0.1400  -0.0808\n\
         t                  20.35      °C        0.0611   normal (B)    ∞   -4.600   -0.281\n\
         E                  -0.02      µm        0.51                   65           0.51\n\n\
         U = 1.0 µm (k = 2)\n",
    );
}

/// What is known of a part is not what is known of the whole, whose u is the root of the sum of squares.
#[test]
fn a_step_of_a_part_is_not_that_of_the_whole() {
    is_sound(
        "report.txt",
        "quantity      estimate  unit  u        distribution  c  c·u\n\
         x             10.0      mm    0.0050                 1  0.0050\n\
         \x20 resolution           mm    0.0029   uniform (B)      0.0029\n\
         \x20 gain                 mm    0.0041   normal (B)       0.0041\n\
         y             0.0       mm    0.0020   normal (B)    1  0.0020\n\n\
         x: the resolution of the display is 0.01 mm\nu_c = 0.0054 mm\nU = 0.011 mm (k = 2)\n",
    );
}

#[test]
fn a_voltage_may_be_called_u() {
    is_sound(
        "report.txt",
        "Uncertainty budget of U\nquantity  estimate   unit  u        distribution  c  c·u\n\
         V         10.000097  V     0.00012  normal (B)    1  0.00012\n\
         d         0.0        V     0.00005  normal (B)    1  0.00005\n\
         U         10.000097  V     0.00013                   0.00013\n\n\
         estimate              U = 10.000097 V\ncoverage factor       k = 2\nexpanded uncertainty  U = 0.00026 V\n",
    );
}

/// Two results, each of which is an input of the other's table or of a third: what is stated of them is no certificate.
#[test]
fn the_statement_of_a_result_is_no_note_to_an_input() {
    let table = |name: &str, y: &str, u: &str| {
        format!(
            "Uncertainty budget of {name}\nquantity  estimate  unit  u      distribution  c      c·u\n\
             {name}         {y}      V     {u}  normal (B)    1.000  {u}\n\
             {name}         {y}      V     {u}                       {u}\n\n"
        )
    };
    let text = [
        &table("a", "1.870", "0.465"),
        "expanded uncertainty  U = 0.91 V\ncoverage factor  k = 1.96\n\n\n",
        &table("b", "2.157", "0.136"),
        "expanded uncertainty  U = 0.27 V\ncoverage factor  k = 1.96\n\nStatement for the certificate\n\
         ┃ a = (1.87 ± 0.91) V. The number after ± is the expanded uncertainty U = 0.91 V, with k = 1.96.\n\
         ┃ b = (2.16 ± 0.27) V. The number after ± is the expanded uncertainty U = 0.27 V, with k = 1.96.\n",
    ]
    .concat();
    let claims = understood("report.txt", &text);
    assert_eq!(claims.len(), 2);
    for claimed in &claims {
        assert_eq!(
            audit(claimed).verdict,
            Verdict::Sound,
            "{}",
            claimed.measurand
        );
        assert!(
            claimed
                .understood
                .iter()
                .all(|line| line.role != "note to a row")
        );
    }
}

/// A scale factor of voltages by a resistance of 1 kΩ: coefficients of 1 mA/V are printed as 1.
#[test]
fn coefficients_of_one_have_units_where_the_result_has_that_of_u() {
    is_sound(
        "report.txt",
        "quantity  estimate  unit  u       distribution  c        c·u\n\
         E1        0.1000    V     0.0012  uniform (B)   1.000    0.0012\n\
         E2        0.2000    V     0.0011  uniform (B)   -1.000   -0.0011\n\
         R         1000      Ω     2.0     normal (B)    -0.0001  -0.0002\n\
         I         0.1000    mA                                   0.0016\n\n\
         I = 0.1000 mA\nu_c = 0.00164 mA\nU = 0.0033 mA (k = 2)\n",
    );
}

/// A limit of repeatability, divided by 2.8 and by the root of two readings.
#[test]
fn words_may_work_u_out() {
    is_sound(
        "report.txt",
        "Source,Symbol,Estimate,u,c,u_i\n\
         \"Repeatability of the mean of two: 0.2 % / 2.8 / √2\",f,1.000,0.000505,1,0.000505\n\
         Balance,m,0,0.000200,1,0.000200\nCombined,,,,,0.000543\nExpanded (k = 2),,,,,0.0011\n",
    );
}

/// The index of a quantity of another file is no name of the model.
#[test]
fn an_index_is_no_name() {
    let text = "m = W1 + d\n\nquantity        estimate  unit  u       distribution  c  c·u\n\
                standards[W1].d  1.270     mg    0.0490  t (B)         1  0.0490\n\
                d                4.310     mg    0.0164  t (B)         1  0.0164\n\n\
                u_c = 0.0517 mg\nU = 0.10 mg (k = 2)\n";
    let claims = understood("report.txt", text);
    assert_eq!(claims[0].rows[0].label(), "standards[W1].d");
}

/// 1.96 times 0.1195 is 0.2342, and 0.1195 is printed as 0.120: U = 0.23 is no rounding down.
#[test]
fn u_follows_from_the_digits_behind_what_is_printed() {
    let text = |u: &str| {
        format!(
            "quantity  estimate  u      distribution  c  c·u\nb         1.757     0.120  normal (B)    1  0.120\n\n\
             u_c = 0.120\nk = 1.96\nU = {u}\nRounded to nearest.\n"
        )
    };
    is_sound("report.txt", &text("0.23"));
    is_sound("report.txt", &text("0.24"));
    assert_ne!(answer("report.txt", &text("0.22")).0, Verdict::Sound);
}

/// In front of the bracket stands a letter of several bytes.
#[test]
fn a_bracket_behind_chinese_is_no_function() {
    is_sound(
        "report.txt",
        "quantity  estimate  u      distribution  c  c·u\nR         1.757     0.120  normal (B)    1  0.120\n\n\
         测量的输出量分布（3 个输入量(R\nu_c = 0.120\nk = 2\nU = 0.24\n",
    );
}

/// Which row dominates, the statement says of the whole.
#[test]
fn a_sentence_with_u_c_is_about_no_row() {
    let text = "输入量  估计值  单位  u       分布     c  c·u\nV_S     100.0   V     0.0010  正态     1  0.0010\n\
                V_X     100.1   V     0.0289  均匀     1  0.0289\n\n合成标准不确定度  u_c = 0.0289 V\n包含因子  k = 1.65\n扩展不确定度  U = 0.048 V\n\n\
                u_c = 0.0289 V 乘以包含因子 k = 1.65 得到；V_X 占优势，被测量的分布按矩形分布处理，±0.02 V\n";
    let claims = understood("report.txt", text);
    assert_eq!(audit(&claims[0]).verdict, Verdict::Sound);
}

/// A title of subtotals is none, and the table below it no block of the budget.
#[test]
fn a_title_of_subtotals_is_no_sum() {
    let text = "quantity  estimate  u        distribution  c  c·u\na         1.757     0.000345  normal (B)    1  0.000345\n\
                b         0.125     0.00183   normal (B)    1  0.00183\ny         1.882     0.00186                    0.00186\n\n\
                U = 0.0037 (k = 2)\n\nSubtotals by group\ngroup            standard uncertainty  %\n\
                (without group)  0.000345              3.4\nothers           0.00183               96.6\n";
    let claims = understood("report.txt", text);
    assert_eq!(claims[0].rows.len(), 2);
    assert_eq!(audit(&claims[0]).verdict, Verdict::Sound);
}

/// A blank line parts a title from its table in Markdown; correlated rows do not show which one is their result.
#[test]
fn a_title_names_the_result_of_its_table() {
    let text = "## Uncertainty budget of Z\n\n| quantity | estimate | unit | u | distribution | c | c·u |\n\
                | :--- | ---: | :--- | ---: | :--- | ---: | ---: |\n| V | 4.9990 | V | 0.00321 | t (A) | 50.86 | 0.1633 |\n\
                | I | 0.019661 | A | 0.00000947 | t (A) | -12932 | -0.1225 |\n| Z | 254.26 | Ω | 0.2363 |  |  | 0.2363 |\n\n\
                U = 0.47 Ω (k = 2)\nr(V, I) = -0.355\n";
    assert_eq!(answer("report.md", text), (Verdict::Sound, Vec::new()));
}

/// What a report holds against one another is no budget: two methods, or a claim and what was obtained.
#[test]
fn a_comparison_of_results_is_no_budget() {
    let text = "| quantity | estimate | unit | u | distribution | c | c·u |\n| :--- | ---: | :--- | ---: | :--- | ---: | ---: |\n\
                | a | 4.999 | V | 0.0032 | normal (B) | 1 | 0.0032 |\n| b | 0.001 | V | 0.0011 | normal (B) | 1 | 0.0011 |\n\
                | y | 5.000 | V | 0.0034 |  |  | 0.0034 |\n\nU = 0.0068 V (k = 2)\n\n|  | GUM | Monte Carlo |\n| :--- | ---: | ---: |\n\
                | estimate | 5.0000 | 5.0001 |\n| standard uncertainty | 0.0034 | 0.0035 |\n| coverage factor k | 2.00 | 1.95 |\n\
                | 95 % interval, symmetric | [4.993, 5.007] | [4.993, 5.007] |\n\n|  | claimed |  | obtained |  |\n| :--- | ---: | :--- | ---: | :--- |\n\
                | estimate | 5.000 | GUM | 5.0000 | agrees within 0.0005 |\n| standard uncertainty | 0.0033 | GUM | 0.0034 | agrees within 0.0001 |\n\
                | expanded uncertainty U | 0.007 | GUM | 0.0068 | agrees within 0.0005 |\n| coverage factor k | 2.00 | GUM | 2.00 | agrees within 0.005 |\n";
    assert_eq!(answer("report.md", text), (Verdict::Sound, Vec::new()));
}

/// `from t` names a distribution, and `from their sum` does not.
#[test]
fn a_word_begins_no_other_one() {
    is_sound(
        "report.txt",
        "quantity  estimate  u      distribution  c  c·u\na         1.757     0.120  normal (B)    1  0.120\n\n\
         The figures are derived from their sum; k = 2 gives U.\nu_c = 0.120\nk = 2\nU = 0.24\n",
    );
}

/// Rows that share a source are correlated, by how much is not said: that terms were added explains nothing.
#[test]
fn shared_sources_correlate_rows() {
    let text = "quantity  estimate  unit  u      distribution  c     c·u\nR1        1000.0    Ω     0.100  normal (B)    1.00  0.100\n\
                R2        1000.0    Ω     0.100  normal (B)    1.00  0.100\n---------------------------------------------\n\
                Shared sources (already contained in the inputs above)\nstandard            Ω     0.100  normal (B)    2.00  0.200\n\
                R         2000.0    Ω     0.200                      0.200\n\nu_c = 0.200 Ω\nU = 0.40 Ω (k = 2)\n";
    assert_eq!(
        answer("report.txt", text),
        (Verdict::Unexplained, Vec::new())
    );
}

/// A scale factor K has no coverage factor of 1, and what stands behind a number is no voltage V.
#[test]
fn letters_of_units_and_factors_may_be_names() {
    is_sound(
        "report.txt",
        "## Uncertainty budget of K\n\n| quantity | estimate | u | distribution | c | c·u |\n| :--- | ---: | ---: | :--- | ---: | ---: |\n\
         | fit | 1.00000 | 0.000122 | normal (B) | 1 | 0.000122 |\n| d | 0.00000 | 0.000100 | normal (B) | 1 | 0.000100 |\n\
         | K | 1.00000 | 0.000158 |  |  | 0.000158 |\n\n- **estimate**: K = 1.00000\n- **coverage factor**: k = 2\n- **expanded uncertainty**: U = 0.00032\n",
    );
    is_sound(
        "report.txt",
        "quantity  estimate   unit  u        distribution  c  c·u\nV         10.000097  V     0.00012  normal (B)    1  0.00012\n\
         d         0.0        V     0.00005  normal (B)    1  0.00005\n\nrepeatability (within groups): s_r = 0.0000849 V, n = 5\n\
         u_c = 0.00013 V\nU = 0.00026 V (k = 2)\n",
    );
}

/// What stands in front of `times` is a ratio, and behind an analysis of variance s is no simple part of u.
#[test]
fn ratios_and_analyses_are_no_deviations() {
    let text = |remark: &str| {
        format!(
            "quantity  estimate   unit  u        distribution  c  c·u\nVx        10.000097  V     0.00012  t (A)         1  0.00012\n\
             d         0.0        V     0.00005  normal (B)    1  0.00005\n\n{remark}\nu_c = 0.00013 V\nU = 0.00026 V (k = 2)\n"
        )
    };
    is_sound(
        "report.txt",
        &text("Vx 的自由度为 6（重复性 7 次），标准差为 u 的 1.22 倍"),
    );
    is_sound(
        "report.txt",
        &text("Vx: the standard deviation of 7 readings is 1.22 times u"),
    );
    is_sound(
        "report.txt",
        &text("Vx: analysis of variance of 50 readings in 10 groups, critical value 2.12 at 5 %"),
    );
}

/// The head of a table of steps of the calculation says nothing of its inputs.
#[test]
fn a_head_that_names_inputs_is_no_note() {
    let text = "component,distribution,half-width,divisor,u,c,c·u\nlen,normal,0.1,1,0.1,1,0.1\nTx,normal,0.4,1,0.4,1,0.4\n\
                u_c,,,,,,0.4123\nU (k = 2),,,,,,0.82\n\nThe model step by step\nstep,at the estimates,len + u/100,len - u/100,Tx + u/100,Tx - u/100\n\
                len*Tx,0.2,0.201,0.199,0.204,0.196\n";
    assert_eq!(answer("report.csv", text), (Verdict::Sound, Vec::new()));
}

/// Where words say that u is what was stated, the shape of a distribution leaves nothing to divide.
#[test]
fn u_as_stated_is_not_divided() {
    let text = "component,distribution,\"half-width, or U, s, u\",divisor,u,c,c·u,remark\n\
                len,normal,0.1,1,0.1,1,0.1,u as stated\ndtheta,rectangular,0.4,1,0.4,1,0.4,u as stated\n\
                u_c,,,,,,0.4123,\nU (k = 2),,,,,,0.82,\n";
    assert_eq!(answer("report.csv", text), (Verdict::Sound, Vec::new()));
}
