//! Sheets in the words and columns of laboratories that had not been read before, and what they had in common.

use super::{answer, first, is_sound};
use crate::{Verdict, audit, claims, read, rules, sheet};

/// `U = k x u(e) = 2 x 0.00121 MPa = 0.0024 MPa`: an x between blanks multiplies.
#[test]
fn an_x_multiplies() {
    let sheet = |u: &str| {
        format!(
            "quantity;estimate;standard uncertainty;probability distribution;sensitivity coefficient;uncertainty contribution\n\
             Xi;xi;u(xi);;ci;ui(y)\npS;10,0012 MPa;0,00045 MPa;normal;-1;-0,00045 MPa\npI;10,003 MPa;0,00058 MPa;normal;1;0,00058 MPa\n\
             dpR;0 MPa;0,00029 MPa;rectangular;1;0,00029 MPa\ndpH;0 MPa;0,00087 MPa;rectangular;1;0,00087 MPa\n\
             dpZ;0 MPa;0,0003 MPa;rectangular;1;0,0003 MPa\ne;0,0018 MPa;;;;0,00121 MPa\n\
             Expanded uncertainty: U = k x u(e) = 2 x 0,00121 MPa = {u} MPa\n"
        )
    };
    is_sound("sheet.csv", &sheet("0,0024"));
    assert_eq!(first("sheet.csv", &sheet("0,0042")), "digits-transposed");
}

/// A Chinese report tells its components one by one, each with the calculation of its u.
#[test]
fn components_end_in_their_standard_uncertainties() {
    let report = |standard: &str, u_c: &str, expanded: &str| {
        format!(
            "不确定度评定报告\n被校对象：数字温度计，校准点 100 ℃\n测量模型：Δt = t − t_s\n\
             A类评定：对被校温度计在100 ℃点独立重复测量10次，单次测量标准偏差 s = 0.032 ℃，实际校准取2次测量的平均值，则 u(t) = 0.032/√2 = 0.023 ℃。\n\
             B类评定：\n(1) 被校温度计分辨力 0.01 ℃，u = 0.29×0.01 = 0.0029 ℃；\n\
             (2) 标准铂电阻温度计校准证书给出 U = 0.012 ℃，k = 2，u = {standard} ℃；\n\
             (3) 恒温槽均匀性 ±0.02 ℃，按均匀分布，u = 0.02/√3 = 0.0115 ℃；\n\
             (4) 恒温槽波动度 ±0.01 ℃，反正弦分布，u = 0.01/√2 = 0.0071 ℃。\n\
             合成标准不确定度：u_c = {u_c} ℃\n扩展不确定度：U = {expanded} ℃ (k=2)\n"
        )
    };
    is_sound("report.txt", &report("0.006", "0.0272", "0.054"));
    let undivided = first("report.txt", &report("0.012", "0.0291", "0.058"));
    assert!(undivided.starts_with("cert-undivided@"), "{undivided}");
}

/// Rows 1.1 and 1.2 are what row 1 is made of; so are u_11 and u_12 of u_1.
#[test]
fn parts_of_a_row_are_not_counted_beside_it() {
    let sheet = |names: [&str; 4]| {
        let [whole, first, second, other] = names;
        format!(
            "序号,标准不确定度分量,不确定度来源,标准不确定度值 u(x_i),c_i = ∂f/∂x_i,c_i·u(x_i),自由度\n\
             {whole},示值,0.38 mg,1,0.38 mg,\n{first},重复性,0.24 mg,,,9\n{second},分辨力,0.29 mg,,,∞\n\
             {other},标准砝码,0.29 mg,-1,0.29 mg,∞\nu_c = 0.48 mg\n\"U = 0.96 mg，k=2\"\n"
        )
    };
    is_sound(
        "sheet.csv",
        &sheet(["1,u(m)", "1.1,u(m_1)", "1.2,u(m_2)", "2,u(m_s)"]),
    );
    is_sound("sheet.csv", &sheet([",u_1", ",u_11", ",u_12", ",u_2"]));
}

/// What is neither divided nor said to be expanded, is a standard uncertainty.
#[test]
fn an_undivided_figure_of_no_certificate_is_one() {
    let sheet = "Torque wrench at 100 N·m\nContribution,Symbol,Half-interval / %,Distribution,Standard uncertainty w / %\n\
        Reference standard,W_md/2,0.25,normal,0.25\nResolution,w_r,0.05,rectangular,0.029\nRepeatability,w_re,0.21,normal,0.21\n\
        Reproducibility,w_rep,0.15,rectangular,0.087\n\
        Relative combined standard uncertainty w = 0.34 %\nRelative expanded uncertainty W = 0.68 % (k = 2)\n";
    is_sound("sheet.csv", sheet);
    let mean = "Symbol,Source,Value ± (µV/V),Probability distribution,Divisor,ci,ui(y) (µV/V),vi\n\
        Vcal,Calibration of standard (k=2),3.0,Normal,2.0,1,1.5,∞\nVdrift,Drift,4.0,Rectangular,1.732,1,2.31,∞\n\
        Vrep,\"Repeatability (10 readings, mean)\",1.2,Normal,1,1,1.2,9\n\
        uc,Combined standard uncertainty,,,,,3.00,\nU,Expanded uncertainty,,Normal (k=2),,,6.0,\n";
    is_sound("sheet.csv", mean);
}

/// The estimate and the ± each have a column of units behind them.
#[test]
fn a_unit_belongs_to_the_figure_in_front_of_it() {
    let sheet = "Xi,xi,unit,U or a,unit of a,dist,k,u(xi),ci,ci.u(xi) [mOhm]\nR_S,1000.004,Ohm,5,mOhm,N,2,2.5,1,2.5\n\
        dR_D,0,Ohm,8,mOhm,R,1.73,4.62,1,4.62\ndR_T,0,K,0.5,K,R,1.73,0.289,5,1.45\nR_X,1000.004,Ohm,,,,,,,5.45\nU,,,,,,2,,,11\n";
    is_sound("sheet.csv", sheet);
}

/// Coefficients, standard uncertainties as they are printed, and no contributions.
#[test]
fn coefficients_multiply_what_is_printed() {
    let sheet = |head: &str| {
        format!(
            "Symbol,Source,c,{head}\nm_S,\"certificate, U = 0.040 mg, k = 2\",1,0.020\n\
             dm,\"s = 0.020 mg of 10 readings, mean of 5 reported\",2,0.0089\ndT,limits ±0.030 mg,-3,0.0173\nu_c,,,0.0584\nU,k = 2,,0.12\n"
        )
    };
    is_sound("sheet.csv", &sheet("u(x_i) / mg"));
    // A bare u behind the coefficient is what u_c says of it.
    is_sound("sheet.csv", &sheet("u_i / mg"));
}

/// The unit of a hardness stands behind a slash; a power of ten in the place of one.
#[test]
fn heads_have_strange_units() {
    let hardness = "Rockwell hardness\nItem,Calculation,u / HRC,ν\nCRM certificate U = 0.30 HRC (k=2),0.30/2,0.15,∞\n\
        Repeatability 5 readings s = 0.22 HRC,0.22/√5,0.098,4\nDrift of CRM ±0.1 HRC,0.1/√3,0.058,∞\n\
        Resolution 0.1 HRC,0.1/(2√3),0.029,∞\nCombined,,0.191,\nEffective degrees of freedom,,56,\nk (95.45 %),,2.04,\nU,,0.39,\n";
    is_sound("sheet.csv", hardness);
    let current = |u: &str| {
        format!(
            "直流电流源校准\n不确定度分量,来源,类型,数值,分布,除数,标准不确定度(×10⁻⁶),灵敏系数\n\
             u1,标准电阻检定证书 U_rel=2×10⁻⁶ k=2,B,2×10⁻⁶,正态,2,{u},1\n\
             u2,数字多用表误差限 8×10⁻⁶,B,8×10⁻⁶,均匀,√3,4.6,1\nu3,重复性,A,1.5×10⁻⁶,正态,1,1.5,1\n\
             合成标准相对不确定度 u_crel=4.9×10⁻⁶\n相对扩展不确定度 U_rel=1.5×10⁻⁵ (k=3)\n"
        )
    };
    is_sound("sheet.csv", &current("1.0"));
}

/// The zeros of a whole number are none behind the power of ten of its column.
#[test]
fn powers_of_ten_keep_the_digits() {
    let sheet =
        "Uncertainty source,Type,Standard uncertainty (x 10^-6),Sensitivity,Contribution (x 10^-6)
Tank volume,B,60,1,60
        Temperature,B,25,1,25
Pressure,B,22,1,22
Density,B,35,1,35
Repeatability,A,40,1,40
        Combined standard uncertainty,,,,87
Expanded uncertainty (k = 2),,,,170
";
    is_sound("sheet.csv", sheet);
}

/// No head says in which unit contributions are: that of their rows is it, and U may be in another.
#[test]
fn the_unit_of_rows_is_that_of_their_contributions() {
    let sheet = |expanded: &str| {
        format!(
            "Symbol,Source,± a,Unit,Distribution,Divisor,c_i,u_i(y)\nV_S,\"certificate: U = 0.0030 V, k = 2\",0.0030,V,normal,2,1,0.00150\n\
             dV_t,limits ±0.0025 V,0.0025,V,rectangular,√3,1,0.00144\ndV_d,limits ±0.0042 V,0.0042,V,rectangular,√3,-1,0.00242\n\
             u_c,Combined standard uncertainty,,,,,,0.00319\nU,Expanded uncertainty,,,k = 2,,,{expanded}\n"
        )
    };
    is_sound("sheet.csv", &sheet("6.4 mV"));
    assert_eq!(first("sheet.csv", &sheet("0.0064 mV")), "U-unit");
}

/// A coefficient of 100 Ω, where contributions are in mΩ.
#[test]
fn coefficients_have_units_of_their_own() {
    let sheet = |u: &str, u_c: &str, expanded: &str| {
        format!(
            "标准电阻校准\n测量模型：R_x = R_s · r\n输入量,估计值,不确定度来源,U 或 a,k,u(x_i),c_i,u_i(y)/mΩ\n\
             R_s,100.0012 Ω,\"证书 U=3.0 mΩ, k=2\",3.0 mΩ,{u},1.00,{}\n\
             r,1.000021,电桥 MPE ±8×10⁻⁶,8×10⁻⁶,√3,4.6×10⁻⁶,100 Ω,0.46\n\
             合成标准不确定度 u_c = {u_c} mΩ\n\"扩展不确定度 U = {expanded} mΩ，k = 2\"\n",
            u.rsplit(',')
                .next()
                .unwrap_or_default()
                .trim_end_matches(" mΩ")
        )
    };
    is_sound("sheet.csv", &sheet("2,1.50 mΩ", "1.57", "3.1"));
    assert_eq!(
        first("sheet.csv", &sheet("1,3.00 mΩ", "3.04", "6.1")),
        "cert-undivided@R_s"
    );
}

/// No table and no list: the sentences of a summary.
#[test]
fn running_text_is_read() {
    let text = |u_c: &str, expanded: &str| {
        format!(
            "Summary of the uncertainty of the calibration of a 500 g weight.\n\n\
             The standard weight has U = 0.75 mg (k = 2) on its certificate. Drift of the standard is within ±0.20 mg.\n\
             The comparator scatter is s = 0.30 mg from 6 readings, and the mean of 3 is reported.\n\
             Buoyancy is within limits of ±0.15 mg.\n\
             The combined standard uncertainty is {u_c} mg and the expanded uncertainty is {expanded} mg (k = 2).\n"
        )
    };
    is_sound("told.txt", &text("0.438", "0.88"));
    let single = first("told.txt", &text("0.5015", "1.0"));
    assert!(single.starts_with("s-not-mean@"), "{single}");
}

/// Contributions in percent of a ratio: the hundred is in the coefficients.
#[test]
fn coefficients_may_have_the_hundred_of_percent() {
    let sheet = "Model: Y = X1*X2*X3\nQuantity,Estimate,u(x_i),c_i,u_i(y) / %\nX1,1,0.0025,100,0.250\nX2,1,0.0057,100,0.570\n\
        X3,1,0.0082,100,0.820\nu_c,,,,1.029\nU (k = 2),,,,2.1\n";
    is_sound("sheet.csv", sheet);
}

/// A coefficient that is the conversion between the units of a row, and one whose unit is not written.
#[test]
fn coefficients_may_convert() {
    let micrometres = "Symbol,Source,± a,Unit,Distribution,Divisor,u,c_i,u_i(y) / µm\n\
        L_0,\"certificate: U = 0.00045 mm, k = 2\",0.00045,mm,normal,2,0.000225,-1000,0.225\n\
        L_r,limits ±0.00050 mm,0.00050,mm,rectangular,√3,0.000289,1000,0.289\n\
        f,limits ±0.10 µm,0.10,µm,rectangular,√3,0.0577,1,0.0577\nu_c,,,,,,,,0.371\nU (k = 2),,,,,,,,0.74\n";
    is_sound("sheet.csv", micrometres);
    let volts = "Symbol,Source,± a,Unit,Distribution,Divisor,u,c_i,u_i(y) / (mA/g)\n\
        E_1,limits ±0.011 V,0.011,V,rectangular,√3,0.00635,1,0.00635\nE_2,limits ±0.011 V,0.011,V,rectangular,√3,0.00635,-1,0.00635\n\
        R,limits ±60 Ω,60,Ω,rectangular,√3,34.6,-0.0004,0.01386\nu_c,0.0165,mA/g\nU (k = 2),0.033,mA/g\n";
    is_sound("sheet.csv", volts);
}

/// A relative budget whose heads differ by the size of a letter alone: U of the sources, u of their quotients.
#[test]
fn a_capital_letter_is_an_expanded_uncertainty() {
    let sheet = |expanded: &str| {
        format!(
            "Flow calibration\nNo.,Source,Urel (%),k,urel (%)\n1,Weighing,0.05,2,0.025\n2,Timer,0.02,√3,0.012\n\
             3,Density,0.03,2,0.015\n4,Repeatability,,,0.021\n,Combined,,,0.038\n,Expanded U_rel (k=2),,,{expanded}\n"
        )
    };
    is_sound("sheet.csv", &sheet("0.076"));
    assert_eq!(first("sheet.csv", &sheet("0.038")), "k-forgotten");
}

/// `测量结果的分布` is a column of distributions, and a range whose u is R/(C√n) is that of a mean.
#[test]
fn heads_end_in_the_distribution() {
    is_sound(
        "sheet.csv",
        "力传感器\n标准不确定度分量,不确定度来源,测量结果的分布,标准不确定度值,单位,灵敏系数\n\
         u1,\"力标准机 (Urel=0.02%, k=2)\",正态,0.010,%,1\nu2,\"重复性(3次, 极差法 R=0.03%, C=1.69)\",正态,0.010,%,1\n\
         u3,方位误差 ±0.03%,反正弦,0.021,%,1\nu4,分辨力 0.01%,均匀,0.0029,%,1\nuc,,,0.026,%,\nU,k=2,,0.052,%,\n",
    );
}

/// A column that is called no more than `Uncertainty`, beside no other: its figures are what makes u_c come true.
#[test]
fn a_column_of_uncertainties_is_what_its_sum_says() {
    let sheet = |[source, head, c, u_c, expanded]: [&str; 5], figures: [&str; 2]| {
        let [combined, stated] = figures;
        format!(
            "Length of a gauge (mm)\n{source},{head},{c}\nrepeatability,0.012,1\nreference standard,0.030,1\n\
             resolution,0.0058,-1\ntemperature,0.010,2.5\n{u_c},{combined}\n{expanded},{stated}\n"
        )
    };
    let english = [
        "Source",
        "Uncertainty",
        "Sensitivity",
        "Combined standard uncertainty",
        "Expanded uncertainty (k=2)",
    ];
    let chinese = [
        "不确定度来源",
        "不确定度",
        "灵敏系数",
        "合成标准不确定度",
        "扩展不确定度 (k=2)",
    ];
    for words in [english, chinese] {
        is_sound("sheet.csv", &sheet(words, ["0.0413", "0.083"]));
        let dropped = sheet(words, ["0.0328", "0.066"]);
        assert_eq!(first("sheet.csv", &dropped), "row-dropped@temperature");
    }
    for head in ["Source,Uncertainty", "来源,不确定度/kPa"] {
        let list = |u_c: &str, expanded: &str| {
            format!(
                "{head}\nreference,0.30\nbath,0.20\nresolution,0.02\nu_c,{u_c}\nU (k=2),{expanded}\n"
            )
        };
        is_sound("sheet.csv", &list("0.361", "0.72"));
        assert_eq!(first("sheet.csv", &list("0.52", "1.0")), "linear-sum");
    }
    // Limits of which the sum has the standard uncertainties stay limits.
    let limits = "Source,Uncertainty\ntemperature limits ±0.30 K,0.30\nbath limits ±0.20 K,0.20\nu_c,0.208\nU (k=2),0.42\n";
    is_sound("sheet.csv", limits);
    // A figure that its row says is expanded was not divided.
    let certificate = "Source,Uncertainty\n\"certificate, k = 2\",0.30\nrepeatability of the mean,0.20\nu_c,0.361\nU (k=2),0.72\n";
    assert_eq!(
        first("sheet.csv", certificate),
        "cert-undivided@certificate, k = 2"
    );
}

/// `Repeatability of 5 (mean)`: five readings, and no s of 5 nm.
#[test]
fn how_many_readings_there_were_is_no_deviation() {
    is_sound(
        "sheet.csv",
        "Gauge block 100 mm\nComponent,x_i ±,unit,PDF,divisor,u(x_i),c_i,u_i(y) / nm\n\
         \"Reference block certificate, U, k=2\",40,nm,normal,2,20,1,20\nComparator,15,nm,rectangular,1.732,8.66,1,8.66\n\
         Repeatability of 5 (mean),9,nm,normal,1,9,1,9\nCombined standard uncertainty,,,,,,,23.6\nU = 2·u_c,,,,,,,47\n",
    );
}

/// A row in ppm of a figure in µV follows its divisor, and `99 %` says as much as k.
#[test]
fn questions_that_rows_answer_are_not_asked() {
    let of = |source: &str| {
        format!(
            "DC voltage 10 V\nComponent,Value ±,Unit,Distribution,Divisor,u (µV)\n{source},4.5,ppm,normal,2.58,17.44\n\
             Drift,3,ppm,rectangular,1.732,17.32\nResolution,0.5,µV,rectangular,1.732,0.2887\nu_c,,,,,24.58\nU (k=2),,,,,49\n"
        )
    };
    let asked = |source: &str| -> Vec<u8> {
        let grids = sheet::grids("sheet.csv", of(source).as_bytes()).unwrap();
        let claims = read::budgets(&grids, &read::Mapping::default());
        let found = audit(&claims[0]).found;
        let all = rules::findings(&found).into_iter();
        all.map(|one| one.rule)
            .filter(|rule| [4, 16].contains(rule))
            .collect()
    };
    assert_eq!(asked("Calibrator"), [16]);
    assert!(asked("Calibrator, 99 %").is_empty());
}

/// Components of a quantity stand below it without an estimate and a coefficient of their own.
#[test]
fn components_below_their_quantity_are_in_it() {
    let sheet = |parts: &str| {
        format!(
            "quantity,estimate,unit,u,c,c·u\nV,1.00011,V,0.0000218,100,0.00218\n{parts}I,10.002,mA,0.00029,-10,-0.0029\nR,99.99,Ω,0.00363,,0.00363\n\
             U = 0.0073 Ω (k = 2)\n"
        )
    };
    let parts = "repeatability,,V,0.0000086,,0.00086\ncalibration,,V,0.0000200,,0.00200\n";
    is_sound("sheet.csv", &sheet(parts));
    is_sound("sheet.csv", &sheet(""));
    let (verdict, _) = answer(
        "sheet.csv",
        &sheet(&parts.replace("0.0000200", "0.0000300")),
    );
    assert_ne!(verdict, Verdict::Sound);
}

/// Files with words and figures that hold no sheet say what they are.
#[test]
fn what_is_no_sheet_is_refused() {
    for (name, text, why) in [
        ("r.json", "{\n  \"u\": 0.1\n}\n", "JSON"),
        (
            "c.xml",
            "<?xml version=\"1.0\"?>\n<dcc:digitalCalibrationCertificate>",
            "dcc = \"c.xml\"",
        ),
        ("b.toml", "[input]\n", "`gumption eval b.toml`"),
        ("p.pdf", "%PDF-1.7\n", "PDF"),
        ("d.docx", "PK\u{3}\u{4}", "word processor"),
    ] {
        let error = claims(name, text.as_bytes(), &read::Mapping::default()).unwrap_err();
        assert!(error.0.to_string().contains(why), "{name}");
    }
}

/// Of what a percentage is a part stands in its row, or in the title, also where u is off by a power of ten.
#[test]
fn a_share_of_a_named_amount_is_converted() {
    let sheet = |title: &str, source: &str, [u, u_c, expanded]: [&str; 3]| {
        format!(
            "{title}\nSource,±,Distribution,Divisor,u (µV)\n{source},20 ppm,rectangular,1.732,{u}\nResolution,5 µV,rectangular,1.732,2.89\n\
             Repeatability,4 µV,normal,1,4\nu_c,,,,{u_c}\nU (k=2),,,,{expanded}\n"
        )
    };
    let (right, wrong) = (["115.5", "115.6", "231"], ["11.55", "12.56", "25"]);
    for (title, source) in [
        ("DC voltage", "\"Calibrator, 20 ppm of 10 V\""),
        ("直流电压", "\"标准源，10 V 的 20 ppm\""),
        ("DC voltage at 10 V", "Calibrator"),
    ] {
        let (verdict, slips) = answer("sheet.csv", &sheet(title, source, right));
        assert_eq!(
            (verdict, slips[0].as_str()),
            (Verdict::WithoutEffect, "too-many-digits")
        );
        let (verdict, slips) = answer("sheet.csv", &sheet(title, source, wrong));
        assert_eq!(verdict, Verdict::WithEffect, "{source}");
        assert!(
            slips.iter().any(|slip| slip.starts_with("percent-ppm@")),
            "{slips:?}"
        );
    }
    // Of a range that nobody states, nothing is known.
    let of_range = sheet("DC voltage at 10 V", "\"Calibrator, of range\"", wrong);
    is_sound("sheet.csv", &of_range);
}

/// `±(3.5×10⁻⁶ of reading + 2.5 µV)`: no term of a sum is the figure, the ± column is.
#[test]
fn a_term_of_a_sum_is_no_figure() {
    let sheet = |u_c: &str, expanded: &str| {
        format!(
            "符号,来源,分布,区间半宽 a,k,标准不确定度 u_i,灵敏系数,u_i(y)\n\
             u1,标准源最大允许误差 ±(3.5×10⁻⁶读数+2.5 µV),均匀,37.5 µV,√3,21.7 µV,-1,21.7 µV\n\
             u2,被检表分辨力 10 µV,均匀,5 µV,√3,2.9 µV,1,2.9 µV\n\
             u3,\"测量重复性 s=12 µV，n=10，取平均值\",正态,—,—,3.8 µV,1,3.8 µV\n\
             合成标准不确定度 u_c = {u_c} µV\n扩展不确定度 U = {expanded} µV (k=2)\n"
        )
    };
    is_sound("sheet.csv", &sheet("22.2", "44"));
    assert_eq!(first("sheet.csv", &sheet("28.4", "57")), "linear-sum");
}

/// A unit of ratios that says of what it is one; the amount stands in the title, and contributions show that it was taken.
#[test]
fn a_unit_may_say_of_what_it_is_a_part() {
    let sheet = |divisor: &str, drift: &str, whole: [&str; 2]| {
        format!(
            "Calibration of a gauge at 10 bar\n\
             Symbol,Source of uncertainty,Value (±),Unit,Probability distribution,Divisor,ci,ui (bar),vi\n\
             CR,\"Reference gauge, certificate U at k = 2\",0.0032,bar,Normal,2,1,0.0016,∞\n\
             DR,Drift of the reference since its calibration,0.02,% of reading,Rectangular,{divisor},1,{drift},∞\n\
             RES,\"Resolution, half of 0.01 bar\",0.005,bar,Rectangular,√3,1,0.00289,∞\n\
             uc(P),Combined standard uncertainty,,,Normal,,,{},\nU,Expanded uncertainty,,,Normal (k = 2),,,{},\n",
            whole[0], whole[1]
        )
    };
    is_sound("sheet.csv", &sheet("√3", "0.00115", ["0.0035", "0.0070"]));
    let halved = sheet("2", "0.001", ["0.00345", "0.0069"]);
    assert_eq!(first("sheet.csv", &halved), "half-width-by-2@DR");
}

/// Of a percentage the ± and the divisor give the part, where they are held against a coarse figure.
#[test]
fn coarse_figures_of_parts_are_held_against_parts() {
    let sheet = "Volumetric flow of 120 L/min\nSource,Input uncertainty,Type,Divisor,Std. uncertainty (L/min)\n\
        \"Reference meter (cert. U, k=2)\",0.05 %,B,2,0.03\nTemperature correction,±0.02 %,B,√3,0.0139\n\
        Counter resolution ±0.05 L/min,±0.05 L/min,B,√3,0.0289\nRepeatability (mean),0.03 %,A,1,0.036\n\
        Combined,,,,0.0568\nExpanded (k=2),,,,0.11\n";
    is_sound("sheet.csv", sheet);
}

/// `Expanded uncertainty | k = | 2 | 0.6`, with k below the coefficients: no row of an input.
#[test]
fn the_factor_of_the_whole_may_stand_below_the_coefficients() {
    let sheet = |u_c: &str, expanded: &str| {
        format!(
            "i,Source,Xi ± (%),PDF,Factor,ci,ui(y) %\n1,\"Reference, U (k = 2)\",0.5,normal,2,1,0.25\n\
             2,Reference drift,0.2,rectangular,√3,1,0.115\n3,\"Repeatability, s of mean of 3\",0.08,normal,1,1,0.08\n\
             ,Combined uncertainty,,,,,{u_c}\n,Expanded uncertainty,,,k =,2,{expanded}\n"
        )
    };
    is_sound("sheet.csv", &sheet("0.287", "0.57"));
    let dropped = first("sheet.csv", &sheet("0.275", "0.55"));
    assert!(dropped.starts_with("row-dropped@"), "{dropped}");
}

/// Where the sheet states no rule for k, it may have been looked up for either probability.
#[test]
fn a_factor_is_looked_up_for_the_probability_that_fits() {
    let sheet = |k: &str, expanded: &str| {
        format!(
            "Quantity,Standard uncertainty,Probability distribution,Degrees of freedom,Sensitivity coefficient,Uncertainty contribution\n\
             \"t_S (certificate: U = 0.012 °C, k = 2)\",0.0060 °C,normal,∞,1,0.0060 °C\n\
             δt_D (drift ±0.010 °C),0.0058 °C,rectangular,∞,1,0.0058 °C\n\
             δt_B (bath gradient ±0.006 °C),0.0035 °C,rectangular,∞,1,0.0035 °C\n\
             \"t_X (mean of 4 readings, s = 0.021 °C)\",0.0105 °C,normal,3,-1,-0.0105 °C\n\
             Correction,,,9,,0.0138 °C\n\n\
             \"Expanded uncertainty U = {expanded} °C, k = {k}, coverage probability 95.45 %\"\n"
        )
    };
    is_sound("sheet.csv", &sheet("2.32", "0.032"));
    assert_eq!(first("sheet.csv", &sheet("3.31", "0.046")), "k-of-typeA");
}

/// The label of U may say how it is rounded.
#[test]
fn a_label_may_have_the_rule_for_rounding() {
    let sheet = |expanded: &str| {
        format!(
            "Contribution,Limits / U,Unit,Dist.,Div.,ci,u(y) / mg\n\"Reference weight (certificate, k=2)\",0.15,mg,N,2,1,0.075\n\
             Drift of the reference,0.1,mg,R,√3,1,0.0577\n\"Repeatability, mean of 3 cycles, s = 0.104 mg\",0.06,mg,N,1,1,0.06\n\
             uc,,,,,,0.1121\n\"U (k=2), rounded up to the last digit\",,,,,,{expanded}\n"
        )
    };
    is_sound("sheet.csv", &sheet("0.23"));
    assert_eq!(first("sheet.csv", &sheet("0.22")), "rounded-down");
    assert_eq!(answer("sheet.csv", &sheet("0.22")).0, Verdict::WithEffect);
}

/// Deliveries of a pipette are readings, as are weighings and indentations.
#[test]
fn readings_have_names_of_their_own() {
    let sheet = |what: &str, u: &str, whole: [&str; 2]| {
        format!(
            "Influence,Value,Unit,Type,Distribution,Std. uncertainty u(x),Sensitivity coefficient c,c·u(x) in µL\n\
             \"Balance (certificate U = 0.12 mg, k = 2)\",0.12,mg,B,normal,0.06,1.003 µL/mg,0.0602\n\
             \"Repeatability: s = 0.9 µL, 10 {what}, mean reported\",0.9,µL,A,normal,{u},1,{u}\n\
             Temperature of the pipette ±0.5 °C,0.5,°C,B,rectangular,0.289,0.24 µL/°C,0.0693\n\
             Combined standard uncertainty u_c,,,,,,,{}\nExpanded uncertainty U (k = 2),,,,,,,{}\n",
            whole[0], whole[1]
        )
    };
    for what in ["deliveries", "weighings", "replicates"] {
        is_sound("sheet.csv", &sheet(what, "0.2846", ["0.299", "0.60"]));
        let single = first("sheet.csv", &sheet(what, "0.9", ["0.905", "1.8"]));
        assert!(single.starts_with("s-not-mean@"), "{single}");
    }
}

/// `Value` is what was divided where the divisor gives u in one row of two, of which the other has a slip.
#[test]
fn a_value_that_gives_u_was_divided() {
    let sheet = |u: &str, whole: [&str; 2]| {
        format!(
            "Source,Value,Unit,Distribution,Divisor,u\nCertificate (k=2),0.05,mm,normal,2,0.025\n\
             Drift,0.02,mm,rectangular,1.732,{u}\nCombined standard uncertainty,,,,,{}\nExpanded uncertainty (k=2),,,,,{}\n",
            whole[0], whole[1]
        )
    };
    is_sound("sheet.csv", &sheet("0.0115", ["0.0275", "0.055"]));
    let undivided = first("sheet.csv", &sheet("0.0200", ["0.0320", "0.064"]));
    assert!(undivided.starts_with("root3-missing@"), "{undivided}");
}

/// What is said of `V.repeatability` is said of a component of V, and not of V.
#[test]
fn a_component_is_not_its_quantity() {
    let report = "Model: R = V / I\n\n\
        quantity;estimate;unit;u;distribution;ν;c;c·u;%\nV;1.00015;V;6.76×10^-5;;3.6;100.0;0.00676;25.5\n\
        repeatability;;V;6.45×10^-5;t (A);3;;0.00645;23.3\ncalibration;;V;2.00×10^-5;normal (B);∞;;0.00200;2.2\n\
        I;10.0000;mA;0.00115;uniform (B);∞;-10.00;-0.0115;74.5\nR;100.015;Ω;0.0134;;55.4;;0.0134;100.0\n\n\
        coverage factor;k = 2.00\nexpanded uncertainty;U = 0.027 Ω\n\n\
        component;type;how u was found\nV.repeatability;A;s/√n, s = 0.0001290994, n = 4\nV.calibration;B;U/k = 4×10^-5/2\n";
    is_sound("report.csv", report);
}

/// Contributions that leave out a coefficient which the column has.
#[test]
fn a_coefficient_of_the_column_may_be_unused() {
    let sheet = |part: &str, whole: [&str; 2]| {
        format!(
            "Source d'incertitude;Valeur;Unité;Loi;Diviseur;Coefficient de sensibilité;Contribution (µm)\n\
             Cales étalons (certificat, k=2);0,4;µm;normale;2;1;0,20\nRésolution (quantification 10 µm);5;µm;rectangulaire;1,732;1;2,89\n\
             Répétabilité (écart-type);3,2;µm;normale;1;1;3,20\nÉcart de température ±1 °C;1;°C;rectangulaire;1,732;1,7;{part}\n\
             Incertitude-type composée;;;;;;{}\nIncertitude élargie (k = 2);;;;;;{}\n",
            whole[0], whole[1]
        )
    };
    is_sound("sheet.csv", &sheet("0,98", ["4,43", "8,9"]));
    let unused = first("sheet.csv", &sheet("0,58", ["4,35", "8,7"]));
    assert!(unused.starts_with("c-one@"), "{unused}");
}

/// `u / kPa | u / %`: a second column of u that is relative is no contribution.
#[test]
fn the_same_uncertainty_in_percent_is_derived() {
    let sheet = "Pressure 2.5 MPa\nSource,Limits,Unit,Distribution,Divisor,u / kPa,u / %\n\
        Standard gauge accuracy,0.05,%,rectangular,√3,0.722,0.0289\nDrift per year,0.5,kPa,rectangular,√3,0.289,0.0115\n\
        \"Repeatability s (n=5), mean\",0.4,kPa,normal,√5,0.179,0.0072\nu_c,,,,,0.798,0.0319\nU (k=2),,,,,1.6,0.064\n";
    is_sound("sheet.csv", sheet);
}

/// A table without degrees of freedom cannot give the ν_eff that stands below it; one that says type B can.
#[test]
fn degrees_of_freedom_that_no_row_tells_are_taken_as_they_stand() {
    let sheet = |evaluation: &str, u_c: &str, nu: &str, k: &str, expanded: &str| {
        format!(
            "Quantity,Type,Estimate,Unit,u(x),c\nV,{evaluation},1.00015,V,0.000068,10\nR,{evaluation},100.02,ohm,0.0058,-0.1\n\n\
             combined standard uncertainty,{u_c},mA\neffective degrees of freedom,{nu}\nk (95 %),{k},\nexpanded uncertainty,{expanded},mA\n"
        )
    };
    is_sound("sheet.csv", &sheet("", "0.00089", "10.8", "2.23", "0.0020"));
    let wrong = sheet("", "0.00089", "10.8", "2.57", "0.0023");
    assert_ne!(answer("sheet.csv", &wrong).0, Verdict::Sound);
    let impossible = sheet("", "0.00089", "0.8", "12.71", "0.011");
    assert_ne!(answer("sheet.csv", &impossible).0, Verdict::Sound);
    let b = sheet("B", "0.00089", "10.8", "2.23", "0.0020");
    assert_eq!(first("sheet.csv", &b), "veff-wrong");
}

/// A relative u_c below rows with units is what it comes to, and is called by what it is of.
#[test]
fn a_relative_sum_is_called_by_its_result() {
    let sheet = "Concentration c = m·P/V\nQuantity,Value x,Unit,u(x)\nm,100.28,mg,0.05\nP,0.9999,,0.000058\nV,0.1,L,0.00007\nc,1002.7,mg/L,\n\
                 Combined relative standard uncertainty,0.00086\n\"U(c), k=2\",1.7,mg/L\n";
    is_sound("relative.csv", sheet);
    let claims =
        claims("relative.csv", sheet.as_bytes(), &read::Mapping::default()).expect("a sheet");
    let u_c = claims[0].footer.u_c.as_ref().expect("u_c");
    assert_eq!(u_c.as_read(), "0.00086·c");
    assert!((u_c.read().value - 0.862).abs() < 0.001);
}

/// Ppm of a ratio are a number where the column of u holds one, although nothing but the ppm has a unit.
#[test]
fn parts_of_a_ratio_are_numbers() {
    let sheet = |u: &str, expanded: &str| {
        format!(
            "Quantity,Estimate,Stated uncertainty,Distribution,Divisor,u(xi),ci,ui(y)\nR_S,100.0005 Ω,2 ppm,normal k=2,2,100 µΩ,1,100 µΩ\n\
             bridge ratio r,1.0000023,0.9 ppm,rectangular,√3,{u},100 Ω,52 µΩ\nrepeatability,0,15 µΩ,normal,1,15 µΩ,1,15 µΩ\n\
             R_X,100.0007 Ω,,,,,,{expanded}\n"
        )
    };
    is_sound("ratio.csv", &sheet("5.2E-07", "114 µΩ"));
    let undivided = sheet("9.0E-07", "135 µΩ").replace("52 µΩ", "90 µΩ");
    assert!(first("ratio.csv", &undivided).starts_with("root3-missing@"));
}

/// Sections of a report with their numbers, each of which ends in its standard uncertainty.
#[test]
fn sections_end_in_their_standard_uncertainties() {
    let report = |standard: &str, u_c: &str, expanded: &str| {
        format!(
            "电子天平示值误差测量结果的不确定度评定\n1.2 被测对象：220 g/0.1 mg 电子天平，测量点 200 g\n2 测量模型  ΔE = P - m\n\
             3.1 天平重复性引入的标准不确定度 u(P1)：在 200 g 点重复测量 10 次，单次实验标准差 s = 0.12 mg，则 u(P1) = s = 0.12 mg\n\
             3.2 天平分辨力引入的标准不确定度 u(P2)：实际分度值 d = 0.1 mg，均匀分布，u(P2) = 0.1/(2√3) = 0.029 mg\n\
             3.3 标准砝码引入的标准不确定度 u(m)：E2 等级 200 g 砝码最大允许误差 ±0.30 mg，均匀分布，u(m) = {standard} mg\n\
             4 合成标准不确定度  u_c = {u_c} mg\n5 扩展不确定度  取 k = 2，U = k·u_c = {expanded} mg\n"
        )
    };
    is_sound("report.txt", &report("0.30/√3 = 0.173", "0.21", "0.43"));
    let halved = first("report.txt", &report("0.30/2 = 0.150", "0.19", "0.39"));
    assert!(halved.starts_with("half-width-by-2@"), "{halved}");
}

/// Glassware is made to its nominal capacity: a triangle in the column of distributions has its reason, other limits need one.
#[test]
fn triangles_of_glassware_have_their_reason() {
    let sheet = |name: &str| {
        format!(
            "来源,半宽/%,分布,包含因子,相对标准不确定度/%\n标准物质定值,1.2,正态,2,0.60\n{name},0.8,三角,√6,0.33\n重复性,0.95,正态,1,0.95\n\
             合成相对标准不确定度 urel/%,,,,1.17\n相对扩展不确定度 Urel/%（k=2）,,,,2.3\n"
        )
    };
    is_sound("sheet.csv", &sheet("移液管容量允差"));
    assert!(first("sheet.csv", &sheet("温度计允差")).starts_with("triangle@"));
}

/// `(23 ± 1) °C` says of a row in µV/V what it comes from, and not how large it is.
#[test]
fn a_unit_behind_a_bracket_is_that_of_its_figures() {
    is_sound(
        "sheet.csv",
        "数字多用表直流电压10 V校准\n不确定度来源,半宽 (µV/V),概率分布,除数,标准不确定度 (µV/V)\n标准源校准证书 k=2,4.0,正态,2,2.00\n\
         温度系数 (23±1) ℃,0.8,均匀,1.732,0.46\n测量重复性 平均值的标准差,1.6,正态,1,1.60\n合成标准不确定度,,,,2.60\n扩展不确定度 U (k=2),,,,5.2\n",
    );
}

/// `Repeatability, mean of 10` beside the divisor 1: nothing says that the figure is that of single readings.
#[test]
fn a_mean_of_many_is_not_divided_again() {
    let sheet = |words: &str| {
        format!(
            "Thermometer\nSource,Value ± / °C,Distribution,Divisor,u / °C\nReference (certificate k = 2),0.010,normal,2,0.0050\n\
             Bath,0.008,rectangular,√3,0.0046\n{words},0.0027,normal,1,0.0027\nu_c,,,,0.0073\nU (k = 2),,,,0.015\n"
        )
    };
    is_sound("sheet.csv", &sheet("Repeatability; mean of 10"));
    assert_eq!(
        first(
            "sheet.csv",
            &sheet("Repeatability; s of 10 readings; mean of 10")
        ),
        "s-not-mean@Repeatability; s of 10 readings; mean of 10"
    );
    assert_eq!(
        first(
            "sheet.csv",
            &sheet("Wiederholbarkeit (s von 10 Messungen; Mittelwert)")
        ),
        "s-not-mean@Wiederholbarkeit (s von 10 Messungen; Mittelwert)"
    );
}

/// Contributions that were computed from more digits of u than a sheet prints, where it states no more than u.
#[test]
fn printed_standard_uncertainties_have_further_digits() {
    let sheet = |c: &str| {
        format!(
            "Titration\nQuantity,Estimate,Unit,Standard uncertainty,Sensitivity coefficient,Contribution\nm,0.38880,g,0.000122,0.2608,{c}\n\
             V,14.890,mL,0.0142,0.006809,9.68E-05\nrep,1.0000,1,0.00100,0.1014,0.000101\nu_c,,,,,0.000143\nU (k = 2),,,,,0.00029\n"
        )
    };
    is_sound("sheet.csv", &sheet("3.19E-05"));
    assert_ne!(
        answer("sheet.csv", &sheet("3.39E-05")),
        (Verdict::Sound, Vec::new())
    );
}

/// A report that holds its own figures against those of a source states its own.
#[test]
fn figures_that_are_called_claimed_are_those_of_a_source() {
    is_sound(
        "report.md",
        "| Source | ± / mm | Distribution | Divisor | u / mm |\n|---|---|---|---|---|\n| standard, k = 2 | 0.010 | normal | 2 | 0.0050 |\n\
         | drift | 0.008 | rectangular | √3 | 0.0046 |\n\n- u_c = 0.0068 mm\n- U = 0.014 mm (k = 2)\n\n\
         |  | claimed |  | obtained |\n|---|---|---|---|\n| expanded uncertainty U | 0.02 | GUM | 0.0136 |\n",
    );
}

/// What a bracket says of a Chinese name is a remark: the row keeps its whole name.
#[test]
fn a_chinese_name_is_whole_with_its_bracket() {
    assert_eq!(
        first(
            "sheet.csv",
            "来源,半宽/mV,分布,除数,u/mV\n标准器,0.4,正态,2,0.200\n温度影响(实验室),0.31,均匀,2,0.155\nu_c,,,,0.253\nU (k=2),,,,0.51\n",
        ),
        "half-width-by-2@温度影响(实验室)"
    );
}

/// `accuracy (1 year)` is no accuracy of 1.
#[test]
fn a_period_is_no_limit() {
    is_sound(
        "sheet.csv",
        "Calibration of a 1 V source at 1 V\nComponent,Limits / U,Unit,Distribution,Divisor,c,u_i (µV)\nDMM accuracy (1 year); 99 %,18,ppm,normal,2.58,1,6.98\n\
         Thermal EMF,2,µV,rectangular,1.732,1,1.15\nuc,,,,,,7.07\n\"U, k=2\",,,,,,14\n",
    );
}

/// A step of 0.1 µmol/mol in a budget in percent is a part of the 50 µmol/mol of the title, as the sheet's own u shows.
#[test]
fn amounts_in_a_budget_in_percent_are_parts_of_what_is_named() {
    let sheet = |u: &str, u_c: &str| {
        format!(
            "## 一氧化碳检测报警器示值误差不确定度评定（50 µmol/mol 点）\n\n| 来源 | 已知信息 | 类别 | 相对标准不确定度 u_rel / % |\n|---|---|---|---|\n\
             | 标准气体(有证标准物质) | U_rel=1.0 %，k=2 | B | 0.50 |\n| 分辨力 | 0.1 µmol/mol | B | {u} |\n\
             \n合成相对标准不确定度 u_crel = {u_c} %\n\n相对扩展不确定度 U_rel = 1.0 %，k = 2\n"
        )
    };
    is_sound("sheet.md", &sheet("0.058", "0.50"));
    assert_ne!(
        answer("sheet.md", &sheet("0.31", "0.59")),
        (Verdict::Sound, Vec::new())
    );
}

/// A table as it is copied from a page, its columns one blank apart.
#[test]
fn columns_may_stand_one_blank_apart() {
    let english = |u: &str, u_c: &str, expanded: &str| {
        format!(
            "Uncertainty of DC voltage 100 V\nSource Value ± Distribution Divisor u (µV/V)\n\
             Reference multimeter (certificate, k = 2) 12 µV/V normal 2 {u}\nReference drift, 1 year 8 µV/V rectangular 1.732 4.62\n\
             Resolution 1 µV/V rectangular 1.732 0.58\nRepeatability, std. dev. of the mean 2.2 µV/V normal 1 2.20\n\
             Combined standard uncertainty {u_c}\nExpanded uncertainty (k = 2) {expanded}\n"
        )
    };
    is_sound("page.txt", &english("6.00", "7.91", "16"));
    assert_eq!(
        first("page.txt", &english("12.00", "13.06", "26")),
        "cert-undivided@Reference multimeter (certificate, k = 2)"
    );
    is_sound(
        "page.txt",
        "表1 标准不确定度分量汇总表\n不确定度来源 半宽 分布 包含因子 标准不确定度 灵敏系数 分量\n标准砝码 0.5 mg 均匀 √3 0.29 mg 1 0.29 mg\n\
         天平分辨力 0.05 mg 均匀 √3 0.029 mg 1 0.029 mg\n测量重复性 0.12 mg 正态 1 0.12 mg 1 0.12 mg\n合成标准不确定度 u_c = 0.32 mg\n\
         扩展不确定度 U = 0.63 mg (k = 2)\n",
    );
}
