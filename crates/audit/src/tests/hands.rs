//! Sheets as laboratories write them: heads, words and closing lines of many hands, in English and Chinese.

use super::{answer, first, is_sound, understood};
use crate::Verdict;

/// `5720A` is an instrument and no current, and the standard deviation of the mean is divided no more.
#[test]
fn designations_are_no_figures() {
    let sheet = "UNCERTAINTY WORKSHEET,,,,,,,,,\n\
        Uncertainty Contributor,Magnitude,Units,Type,Distribution,Divisor,Std. Unc. (µV),Sens. Coeff.,Unc. Contribution (µV),DOF\n\
        \"Fluke 5720A output, cal report 1143 (k=2)\",44,µV,B,Normal,1,44,1,44,∞\n\
        \"5720A drift, 90 day spec (limits)\",28,µV,B,Rectangular,1.732,16.166,1,16.166,∞\n\
        \"UUT resolution, 10 µV digit\",10,µV,B,Rectangular,3.464,2.887,1,2.887,∞\n\
        \"Repeatability, std. dev. of the mean of 10\",12.6,µV,A,Normal,1,12.6,1,12.6,9\n\
        ,,,,,,Combined Std. Uncertainty,,48.63,µV\n\
        ,,,,,,Coverage Factor,,2,\n\
        ,,,,,,Expanded Uncertainty,,97,µV\n";
    let slip = first("sheet.csv", sheet);
    assert!(slip.starts_with("cert-undivided@Fluke"), "{slip}");
}

/// `不确定度分量` names the rows where no figures stand below it.
#[test]
fn a_column_of_names_is_one_whatever_its_head() {
    let balance = "测量不确定度评定报告\n\
        序号,标准不确定度分量,不确定度来源,类别,标准不确定度值 u(xi),ci,|ci|·u(xi) (mg)\n\
        1,u(m1),测量重复性（n=10，s=0.12 mg，单次测量）,A,0.12 mg,1,0.12\n\
        2,u(m2),天平分度值 d=0.1 mg，均匀分布,B,0.029 mg,1,0.029\n\
        3,u(m3),偏载误差 0.3 mg（半宽），均匀分布,B,0.17 mg,1,0.17\n\
        4,u(ms),砝码允差 MPE ±0.5 mg，均匀分布,B,0.50 mg,-1,0.50\n\
        uc(E) = 0.54 mg\n\
        取包含因子 k=2，则 U = k·uc = 1.1 mg\n";
    assert_eq!(first("sheet.csv", balance), "root3-missing@u(ms)");
    let thermocouple = "热电偶校准不确定度评定（1000℃）\n\
        不确定度分量,来源,区间半宽/扩展不确定度,分布,包含因子k,标准不确定度/℃,灵敏系数,分量/℃\n\
        u1,标准热电偶证书(U=0.6℃ k=2),0.6,正态,2,0.30,1,0.30\n\
        u2,标准热电偶年稳定性,0.5,均匀,√3,0.29,1,0.29\n\
        u3,炉温不均匀,0.25,均匀,√3,0.14,1,0.14\n\
        u5,测量重复性(6次平均) s=0.25℃,0.25,正态,1,0.25,1,0.25\n\
        合成标准不确定度,,,,,,,0.51\n\
        扩展不确定度(k=2),,,,,,,1.0\n";
    let (verdict, slips) = answer("sheet.csv", thermocouple);
    assert_eq!(
        (verdict, slips[0].as_str()),
        (Verdict::WithEffect, "s-not-mean@u5")
    );
}

/// A head of two lines, of which the upper one alone says what the last column is.
#[test]
fn words_stand_above_units() {
    is_sound(
        "sheet.csv",
        "数字压力计测量结果不确定度评定（0.6 MPa点）\n\
         不确定度分量,,误差限或U,,包含因子,标准不确定度,灵敏系数,|ci|u(xi)\n\
         符号,来源,数值,单位,k,u(xi)/kPa,ci,/kPa\n\
         u1,标准器：0.05级活塞压力计（证书U，k=2）,0.30,kPa,2,0.15,-1,0.15\n\
         u2,被检表分辨力 0.1 kPa,0.05,kPa,√3,0.029,1,0.029\n\
         u3,重复性：s=0.08 kPa（10次），取2次平均,0.08,kPa,√2,0.057,1,0.057\n\
         u4,温度影响 ±0.2 kPa,0.20,kPa,√3,0.115,1,0.115\n\
         合成标准不确定度,,,,,,,0.20\n\
         扩展不确定度 U（k=2）,,,,,,,0.40\n",
    );
}

/// Lines that lead to a standard uncertainty, and labels that hold the condition of their figure.
#[test]
fn arrows_lead_to_standard_uncertainties() {
    let sheet = "Pressure gauge, budget for 6 bar\n\n\
        u1: reference gauge certificate U = 0.006 bar (k=2)   -> 0.003 bar\n\
        u2: resolution of UUT 0.01 bar (digital step)         -> 0.0029 bar\n\
        u3: repeatability s = 0.004 bar, 3 readings, mean reported -> 0.004 bar\n\
        u4: hysteresis, full width 0.012 bar, rectangular     -> 0.0035 bar\n\n\
        combined: 0.0068 bar\n\
        expanded (k=2): 0.014 bar\n";
    assert_eq!(first("sheet.txt", sheet), "s-not-mean@u3");
}

/// A figure in words that is of something else (a temperature beside a length) is not what was used.
#[test]
fn figures_of_other_quantities_are_left_where_they_are() {
    let micrometer = "Micrometer calibration budget (25 mm)\n\
        Source,Value,Unit,Type,Dist,Divisor,u (µm)\n\
        Gauge block certificate (k=2),0.20,µm,B,normal,2,0.100\n\
        Temperature difference ±0.5 °C (11.5 µm/m/K over 25 mm),0.144,µm,B,rect,1.732,0.083\n\
        Resolution 1 µm (half),0.50,µm,B,rect,1.732,0.289\n\
        Repeatability (n=5) std of mean,0.24,µm,A,normal,1,0.240\n\
        Flatness of faces ±0.3,0.30,µm,B,rect,1.732,0.173\n\
        Combined uncertainty,,,,,,0.885\n\
        Expanded uncertainty k=2,,,,,,1.8\n";
    assert_eq!(first("sheet.csv", micrometer), "linear-sum");
    is_sound(
        "sheet.csv",
        "Scope amplitude 5 Vpp\n\
         Uncertainty source,Symbol,Uncertainty,Distribution,Factor,u\n\
         Calibrator 9500B spec 1yr 99% (mV),U_cal,12.5,Normal 99%,2.58,4.84\n\
         \"Scope resolution 8 bit, 1 LSB = 40 mV (±)\",δ_res,20,Rectangular,1.73,11.56\n\
         Repeatability,s,3.0,Normal,1,3.0\n\
         Combined,,,,,12.9\n\
         k,,,,,2\n\
         U (mV),,,,,26\n",
    );
}

/// Relative figures, and the closing lines that name them.
#[test]
fn relative_figures_close_a_budget() {
    let pump = "## Infusion pump, flow 5 mL/h\n\n\
        | Source | Evaluation | Stated | Distribution | Divisor | Relative standard uncertainty / % |\n\
        |---|---|---|---|---|---|\n\
        | Repeatability of flow (n = 6, mean reported), s | A | 0.90 % | normal | 1 | 0.90 |\n\
        | Balance, U = 0.20 %, k = 2 | B | 0.20 % | normal | 2 | 0.10 |\n\
        | Density of water, limits | B | 0.10 % | rectangular | 1.73 | 0.058 |\n\
        | Evaporation, limits | B | 0.60 % | rectangular | 1.73 | 0.35 |\n\n\
        Combined relative standard uncertainty: 0.97 %\n\
        Expanded relative uncertainty (k = 2): 1.9 %\n";
    let slip = first("sheet.md", pump);
    assert!(slip.starts_with("s-not-mean@Repeatability"), "{slip}");
}

/// Names of budgets told line by line, in Chinese.
#[test]
fn lines_in_chinese_are_rows() {
    let sheet = "直流电阻器校准不确定度评定\n\
        测量模型：R_x = R_s + ΔR\n\
        R_s：标准电阻证书给出 U = 0.8 mΩ，k = 2\n\
        ΔR：10次测量的标准偏差 s = 0.6 mΩ，取平均值\n\
        合成标准不确定度 u_c = 0.82 mΩ\n\
        扩展不确定度 U = 1.6 mΩ（k = 2）\n";
    assert_eq!(first("sheet.txt", sheet), "cert-undivided@R_s");
}

/// German and French heads, closing lines and distributions.
#[test]
fn neighbours_write_budgets_too() {
    is_sound(
        "sheet.csv",
        "Messunsicherheitsbudget Messschieber;;;;;;;\n\
         Größe;Schätzwert;Halbbreite;Verteilung;Teiler;Standardunsicherheit;Sensitivitätskoeffizient;Unsicherheitsbeitrag\n\
         l_N;50,0001 mm;0,0002 mm;Normal;2;0,0001 mm;1;0,0001 mm\n\
         dl_A;0 mm;0,005 mm;Rechteck;√3;0,0029 mm;1;0,0029 mm\n\
         dl_M;0 mm;0,010 mm;Rechteck;√3;0,0058 mm;1;0,0058 mm\n\
         kombinierte Standardunsicherheit;;;;;;;0,0065 mm\n\
         erweiterte Messunsicherheit (k = 2);;;;;;;0,013 mm\n",
    );
    let french = "Bilan d'incertitude - thermocouple type K à 500 °C;;;;;;\n\
         Source d'incertitude;Demi-étendue (°C);Loi;Diviseur;Incertitude-type (°C);Coefficient de sensibilité;Contribution (°C)\n\
         Étalon de référence;0,50;normale;2;0,25;1;0,25\n\
         Homogénéité du four;0,60;uniforme;√3;0,346;1;0,346\n\
         Dérive;0,30;uniforme;√3;0,173;1;0,173\n\
         Incertitude-type composée;;;;;;0,461\n\
         Incertitude élargie (k = 2);;;;;;UUU\n";
    is_sound("sheet.csv", &french.replace("UUU", "0,92"));
    assert_eq!(
        first("sheet.csv", &french.replace("UUU", "0,46")),
        "k-forgotten"
    );
}

/// `c_i | U_i` without any other column of u, as in M3003: the last is the contribution; names without a head; `Std. uncertainty`
/// beside a column that nothing makes use of.
#[test]
fn columns_are_what_stands_beside_them() {
    let m3003 = "Symbol,Source,Value,Units,Probability Distribution,Divisor,ci,Ui (µm),Vi or Veff\n\
         LS,Calibration of standard,0.06,µm,normal,2,1,0.030,infinity\n\
         LD,Drift since calibration,0.05,µm,rectangular,1.7321,1,0.0289,infinity\n\
         dT,Temperature,0.5,°C,rectangular,1.7321,0.35 µm/°C,0.101,infinity\n\
         LV,Comparator,0.04,µm,normal,1,1,0.040,15\n\
         uc,Combined standard uncertainty,,,normal,,,0.116,>500\n\
         U,Expanded uncertainty,,,normal (k=2),,,0.23,>500\n";
    is_sound("sheet.csv", m3003);
    is_sound(
        "sheet.csv",
        "Tape measure;;;;\n;Half-width (mm);Distribution;Divisor;u (mm)\nScale;0,5;normal;2;0,25\nReading;0,5;rectangular;1,73;0,29\n\
         Temperature;0,7;rectangular;1,73;0,40\nCombined standard uncertainty;;;;0,56\nExpanded uncertainty (k = 2);;;;1,1\n",
    );
    is_sound(
        "sheet.csv",
        "Conductivity meter,,,,\nUncertainty source,Std uncertainty,Relative,Unit,dof\nCRM,5.0,0.35%,µS/cm,inf\n\
         Resolution,0.29,0.02%,µS/cm,inf\nRepeatability,2.1,0.15%,µS/cm,5\n\
         Combined standard uncertainty,5.4,0.38%,µS/cm,\nExpanded uncertainty (k=2),11,0.8%,µS/cm,\n",
    );
}

/// `c_i | u_i` where the ± and the divisor give u without the coefficient: u is that of the input.
#[test]
fn a_bare_u_may_be_that_of_the_input() {
    is_sound(
        "sheet.csv",
        "Source,±,Distribution,Divisor,c,u\nHead,4.0 mm,rectangular,√3,0.0098 kPa/mm,2.31 mm\nGauge,0.20 kPa,normal,2,1,0.10 kPa\n\
         Temperature,0.6 K,rectangular,√3,0.15 kPa/K,0.346 K\nu_c,,,,,0.115 kPa\nU (k = 2),,,,,0.23 kPa\n",
    );
}

/// DKD-R 6-1: full widths 2a, divided by 2√3; `s/√4` says that a figure is that of the mean.
#[test]
fn full_widths_have_their_divisor() {
    is_sound(
        "sheet.csv",
        r#"DKD-R 6-1 Druckmessgerät 10 bar;;;;;;
Größe;Schätzwert;Variationsbreite 2a;Verteilung;Teiler;Unsicherheit u;Sensitivität;Unsicherheitsbeitrag
p_Normal;10,000 bar;;normal;2;0,0005 bar;1;0,0005 bar
p_Anzeige;10,002 bar;0,001 bar;Rechteck;3,464;0,00029 bar;1;0,00029 bar
f_Nullpunkt;0 bar;0,002 bar;Rechteck;3,464;0,00058 bar;1;0,00058 bar
f_Wiederhol;0 bar;0,001 bar;Rechteck;3,464;0,00029 bar;1;0,00029 bar
f_Hysterese;0 bar;0,003 bar;Rechteck;3,464;0,00087 bar;1;0,00087 bar
dp;0,002 bar;;;;;;0,00123 bar
U = 0,0025 bar (k = 2)
"#,
    );
    is_sound(
        "sheet.csv",
        "Symbol,Source of Uncertainty,Value ±,Probability Distribution,Divisor,ci,ui(y) °C,νi\n\
         R,Reference thermometer calibration,0.30,Normal,2,1,0.150,∞\nD,Drift of reference,0.20,Rectangular,1.7321,1,0.115,∞\n\
         S,Repeatability (mean of 4; s/√4),0.06,Normal,1,1,0.060,3\n\
         uc,Combined standard uncertainty,,Normal,,,0.199,>300\nU,Expanded uncertainty,,Normal (k=2),,,0.40,>300\n",
    );
}

/// Two budgets beside each other, each with its own closing lines.
#[test]
fn tables_stand_side_by_side() {
    let sheet = "Multimeter 1 V,,,,,,Multimeter 10 V,,,,\n\
         Source,± (µV),Distribution,Divisor,u (µV),,Source,± (µV),Distribution,Divisor,u (µV)\n\
         Calibrator,12,normal,2,6.00,,Calibrator,80,normal,2,40.0\n\
         Resolution,0.5,rectangular,√3,0.289,,Resolution,5,rectangular,√3,2.89\n\
         Stability,4,rectangular,√3,2.31,,Stability,30,rectangular,√3,17.3\n\
         u_c,,,,6.44,,u_c,,,,43.7\n\
         U (k=2),,,,13,,U (k=2),,,,44\n";
    let claims = understood("sheet.csv", sheet);
    let verdicts: Vec<Verdict> = claims
        .iter()
        .map(|claimed| crate::audit(claimed).verdict)
        .collect();
    assert_eq!(verdicts, [Verdict::Sound, Verdict::WithEffect]);
}

/// Notes between the rows, a row of the sum without a figure, `u(c)`; inputs as columns with the closing figures in the first.
#[test]
fn closing_lines_are_no_rows() {
    is_sound(
        "sheet.csv",
        "Micrometer 25 mm budget,,,,,,\n\
         Symbol,Source,Half-width,Unit,Distribution,Divisor,u_i (µm)\n\
         L1,Gauge blocks,0.30,µm,normal,2,0.15\n\
         ,The gauge blocks were calibrated on 2025-11-02; U with k=2.,,,,,\n\
         L2,Flatness and parallelism of faces,0.90,µm,rectangular,√3,0.52\n\
         ,,,,,,\n\
         L3,Thermal expansion,0.35,µm,rectangular,√3,0.20\n\
         Sum,,,,,,\n\
         u(c),,,µm,,,0.58\n\
         U (k=2),,,µm,,,1.2\n",
    );
    is_sound(
        "sheet.csv",
        "\"Flow meter, gravimetric standard\",,,,\n\
         ,Mass,Time,Density,Repeatability\n\
         Symbol,m,t,rho,q_rep\n\
         Limits or U in %,0.02,0.006,0.02,0.03\n\
         Distribution,normal,rectangular,normal,normal\n\
         Divisor,2,√3,2,1\n\
         u in %,0.010,0.0035,0.010,0.030\n\
         c,1,-1,-1,1\n\
         Contribution in %,0.010,0.0035,0.010,0.030\n\
         ,,,,\n\
         u_c,0.033 %,,,\n\
         k,2,,,\n\
         U,0.067 %,,,\n",
    );
    let total = "Calibration of a 1 kg weight,,,,,,\n\
         Quantity,Estimate,Uncertainty,Prob. distr.,Divisor,Sens. coeff.,Contribution [mg]\n\
         \"Standard m_S (cert. U = 5 mg, k = 2)\",1000.000 g,5 mg,normal,1,1,5.0\n\
         Drift dm_D,0 mg,2 mg,rectangular,1.73,1,1.15\n\
         Weighing difference dm,12 mg,2.5 mg,normal,1,1,2.5\n\
         Sum u(m_X),,,,,,5.71\n\
         U = k*u (k=2),,,,,,11\n";
    assert!(first("sheet.csv", total).starts_with("cert-undivided@"));
}

/// ν_eff that was found from u_c as it is printed, and u_c from more digits of u than are printed.
#[test]
fn what_digits_leave_open_is_no_slip() {
    is_sound(
        "sheet.md",
        "# pH meter\n\n\
         | No. | Component | Limits | Distribution | Divisor | u(x_i) | c_i | c_i·u(x_i) | ν_i |\n\
         |---|---|---|---|---|---|---|---|---|\n\
         | 1 | Buffer solution, certificate U = 0.010, k = 2 | 0.010 | normal | 2 | 0.0050 | 1 | 0.0050 | infinity |\n\
         | 2 | Display resolution 0.01 | 0.005 | rectangular | 1.732 | 0.0029 | 1 | 0.0029 | infinity |\n\
         | 3 | Temperature compensation | 0.008 | rectangular | 1.732 | 0.0046 | 1 | 0.0046 | infinity |\n\
         | 4 | Repeatability, n = 6, mean | 0.0041 | normal | 1 | 0.0041 | 1 | 0.0041 | 5 |\n\n\
         u_c = 0.0084, ν_eff = 88, k = 2, U = 0.017\n",
    );
    let bare = |u_c: &str| {
        format!(
            "Weight of 10 kg\nm_X = m_S + dm_D + dm + dm_C + dB\nk = 2\n\
             Symbol,u(x_i) / g,c_i,u_i(y) / g\nm_S,0.0225,1,0.0225\ndm_D,0.00866,1,0.00866\ndm,0.0144,1,0.0144\n\
             dm_C,0.00577,1,0.00577\ndB,0.00577,1,0.00577\nu_c,,,{u_c}\n"
        )
    };
    // 0.0292437 of the printed figures, 0.0292618 of those behind them.
    is_sound("sheet.csv", &bare("0.0293"));
    let (verdict, _) = answer("sheet.csv", &bare("0.0296"));
    assert_ne!(verdict, Verdict::Sound);
}

/// ISO 376: relative half-widths W, divisors, w and its squares; √6 for the resolution at zero and under load.
#[test]
fn force_budgets_are_relative() {
    is_sound(
        "sheet.csv",
        r#"Force transducer 10 kN ISO 376,,,,
Source,Relative half width in %,Divisor,w in %,w²
Calibration force,0.02,2,0.010,0.00010
Reproducibility,0.03,3.464,0.0087,0.000075
Repeatability,0.012,3.464,0.0035,0.000012
Resolution,0.01,2.449,0.0041,0.0000167
Creep,0.015,1.732,0.0087,0.000075
Sum,,,,0.000279
w_c in %,,,0.0167,
W (k=2) in %,,,0.033,
"#,
    );
    is_sound(
        "sheet.csv",
        r#"Force transducer 10 kN ISO 376
Source;W in %;Divisor;w in %;w²
Calibration force;0,02;2;0,010;0,00010
Reproducibility;0,03;3,464;0,0087;0,000075
Repeatability;0,012;3,464;0,0035;0,000012
Zero;0,01;1,732;0,0058;0,000033
Creep;0,015;1,732;0,0087;0,000075
;;;Σ w²;0,000295
;;;w_c;0,0172
;;;W;0,034
"#,
    );
    is_sound(
        "sheet.md",
        r#"# Calibration of a force-proving instrument, 50 kN

| | Relative half width (%) | Divisor | Relative standard uncertainty w (%) | w² (%²) |
|---|---|---|---|---|
| Reference force | 0.010 | 2 | 0.0050 | 2.5E-5 |
| Rotation | 0.025 | 1.73 | 0.0144 | 2.1E-4 |
| Repeatability | 0.010 | 1.73 | 0.0058 | 3.3E-5 |
| Interpolation | 0.008 | 2.45 | 0.0033 | 1.1E-5 |

w_c = 0.0167 %
W = 0.033 % (k = 2)
"#,
    );
}

/// M3003, K2: a rounding of a difference is triangular, and the sheet says so.
#[test]
fn a_difference_of_indications_has_a_triangle() {
    let sound = r#"M3003 K2 Calibration of a weight of nominal value 10 kg,,,,,,,
Symbol,Source of uncertainty,Value ± mg,Probability distribution,Divisor,ci,ui(Wx) mg,vi or veff
Ws,Calibration of standard weight,30.0,Normal,2.0,1.0,15.0,∞
Ds,Drift since last calibration,30.0,Rectangular,√3,1.0,17.3,∞
δC,Comparator linearity,3.0,Rectangular,√3,1.0,1.73,∞
Ab,Effect of air buoyancy,10.0,Rectangular,√3,1.0,5.77,∞
δIdx,Digital rounding error,10.0,Triangular,√6,1.0,4.08,∞
Wr,Repeatability,8.70,Normal,√3,1.0,5.02,4
u(Wx),Combined uncertainty,,Normal,,,24.6,>500
U,Expanded uncertainty,,Normal (k = 2),,,49,>500
"#;
    is_sound("sheet.csv", sound);
    let slip = sound
        .replace("√3,1.0,17.3", "1,1.0,30.0")
        .replace(",24.6,", ",34.7,")
        .replace(",49,", ",69,");
    assert_eq!(first("sheet.csv", &slip), "root3-missing@Ds");
}

/// `Contribution %` of a relative budget, `u_rel`, and k looked up at 95.45 %.
#[test]
fn relative_contributions_are_no_shares() {
    is_sound(
        "sheet.csv",
        r#"Torque wrench 100 N·m (relative),,,,,
Source,Value %,Distribution,Divisor,ci,Contribution %
Reference transducer U (k=2),0.30,Normal,2,1,0.150
Resolution,0.10,Rectangular,1.732,1,0.058
Reproducibility,0.25,Rectangular,1.732,1,0.144
Drive interface,0.20,U-shaped,1.414,1,0.141
Repeatability,0.12,Normal,1,1,0.120
Combined,,,,,0.285
Expanded (k=2),,,,,0.57
"#,
    );
    is_sound(
        "sheet.csv",
        r#"Gas flow meter; relative standard uncertainties
Component,u_rel (%),c,c·u_rel (%),dof
Reference flow,0.10,1,0.10,60
Temperature,0.035,1,0.035,50
Pressure,0.020,-1,0.020,50
Repeatability,0.060,1,0.060,4
Combined,,,0.123,
Veff,,,,46
k (95.45 %),,,2.06,
U,,,0.25,
"#,
    );
    is_sound(
        "sheet.csv",
        r#"Nordtest TR 537: ammonium in water,,,
Uncertainty component,Value,Relative u(x) %,Comments
Reproducibility within laboratory u(Rw),,1.67,from control sample
Bias component RMSbias,,2.26,CRM and PT
u(Cref),,1.52,
Combined standard uncertainty uc,,3.20,
Expanded uncertainty U = 2·uc,,6.4,
"#,
    );
}

/// `u(E)` closes a German table; half a step of height in millimetres is not the pressure that comes of it; a concentration is
/// called c_Cd.
#[test]
fn names_and_figures_of_other_things() {
    let balance = r#"Balance 200 g,,,,
Influence,Halbbreite / mg,Verteilung,Teiler,u / mg
Rundung (Leer),0.05,Rechteck,√3,0.029
Rundung (Last),0.05,Rechteck,√3,0.029
Wiederholbarkeit,0.08,Normal,1,0.080
Außermittige Belastung,0.10,Rechteck,√3,0.058
Prüfgewicht U (k=2),0.10,Normal,2,0.050
u(E),,,,0.118
U(E) k=2,,,,0.24
"#;
    is_sound("sheet.csv", balance);
    let linear = balance
        .replace("0.118", "0.246")
        .replace(",0.24\n", ",0.49\n");
    assert_eq!(first("sheet.csv", &linear), "linear-sum");
    is_sound(
        "sheet.csv",
        r#"压力变送器校准不确定度（1 MPa）
符号;不确定度来源;半宽;单位;分布;k;u/kPa;c;u_i/kPa
p_s;标准器证书 U=0.20 kPa k=2;0,20;kPa;正态;2;0,10;1;0,10
δ_I;电流表最大允许误差 ±1,6 µA;1,6;µA;均匀;√3;0,92;0,0625 kPa/µA;0,058
δ_h;高度差 ±5 mm;0,05;kPa;均匀;√3;0,029;1;0,029
δ_r;重复性 s;0,06;kPa;正态;1;0,06;1;0,06
u_c;;;;;;;;0,134
U;k=2;;;;;;;0,27
"#,
    );
    is_sound(
        "sheet.md",
        r#"# Purity of a cadmium standard (Eurachem A1), c_Cd = 1000·m·P/V

| Quantity | Value x | u(x) | u(x)/x |
|---|---|---|---|
| Purity P | 0.9999 | 0.000058 | 0.000058 |
| Mass m (mg) | 100.28 | 0.05 | 0.0005 |
| Volume V (mL) | 100.0 | 0.07 | 0.0007 |

c_Cd = 1002.7 mg/L, u_c = 0.9 mg/L, U = 1.8 mg/L (k = 2)
"#,
    );
}

/// Quantities called A, B and C stand below heads, and are none.
#[test]
fn letters_in_the_first_column_turn_no_table() {
    is_sound(
        "sheet.csv",
        "Source,Half-width,Distribution,Divisor,u\nA,0.30,rectangular,√3,0.17\nB,0.40,rectangular,√3,0.23\nC,0.02,rectangular,√3,0.01\n\
         u_c,,,,0.29\nU (k = 2),,,,0.58\n",
    );
}
