//! For each rule that a sheet can show, a sheet that is against it.

use super::sheet::{Sheet, known, line, noted, replaced, right, row, with};

/// One sheet for each rule that a sheet can show.
pub(super) fn against() -> Vec<(u8, Sheet)> {
    let root3 = libm::sqrt(3.0);
    let t = |sheet: &mut Sheet| {
        sheet.notes[1] = "k from the t-distribution at ν_eff for a coverage probability of 95 %";
        sheet.lines[1].used = 0.1;
        sheet.lines[1].known = "standard deviation s = 0.100 g of 10 readings; mean of 5 reported";
    };
    vec![
        (1, replaced("u_c = 0.02808", "u_c = 0.03008")),
        (2, replaced("U = 0.056", "U = 0.066")),
        (3, replaced("|0.008944|9", "|0.009944|9")),
        (4, row(3, |line| line.divisor = 1.0)),
        (5, replaced("38.1 %", "48.1 %")),
        (6, row(3, |line| line.c = 1.5)),
        (6, row(3, |line| line.c = -1.0)),
        (7, replaced("m = 100.003 g", "m = 100.103 g")),
        (8, with(|sheet| sheet.linear = true)),
        (
            9,
            with(|sheet| {
                sheet.replaced = vec![
                    ("u_c = 0.02808", "u_c = 0.02983"),
                    ("U = 0.056", "U = 0.060"),
                ]
            }),
        ),
        (10, with(|sheet| sheet.power = 2)),
        (11, row(0, |line| line.divisor = root3)),
        (12, row(3, |line| line.divisor = 2.0)),
        (13, row(3, |line| line.divisor = 1.0)),
        (14, row(2, |line| line.used = 0.01)),
        (
            15,
            row(0, |line| {
                line.known = "certificate M-12: U = 0.0400 g and k = 3"
            }),
        ),
        (
            16,
            row(0, |line| line.known = "certificate M-12: U = 0.0400 g"),
        ),
        (17, row(0, |line| line.distribution = "rectangular")),
        (
            18,
            known(
                "drift of the standard; limits ±0.0300 g",
                0.03,
                libm::sqrt(6.0),
                "triangular",
            ),
        ),
        (
            19,
            known(
                "drift of the standard between -0.0100 g and +0.0300 g",
                0.03,
                root3,
                "rectangular",
            ),
        ),
        (
            20,
            known(
                "drift with the cycling of the room; amplitude 0.0300 g",
                0.03,
                root3,
                "rectangular",
            ),
        ),
        (21, row(1, |line| line.divisor = 1.0)),
        (
            22,
            row(
                1,
                |line| line.known = "pooled standard deviation s_p = 0.0200 g of 6 series of 10 readings; mean of 5 reported",
            ),
        ),
        (
            24,
            row(1, |line| {
                (line.known, line.nu) = (
                    "standard deviation s = 0.0200 g of 6 readings; mean of 5 reported",
                    "5",
                )
            }),
        ),
        (25, row(1, |line| line.used = 0.02 * libm::sqrt(0.9))),
        (
            26,
            row(1, |line| {
                (line.known, line.used, line.divisor, line.nu) = (
                    "range method: range R = 0.0500 g of 5 readings, a single reading is reported",
                    0.05,
                    2.53,
                    "3.6",
                )
            }),
        ),
        (
            27,
            row(1, |line| {
                (line.known, line.used, line.divisor, line.nu) = (
                    "all 10 readings were equal; digital step 0.0200 g",
                    0.0,
                    1.0,
                    "inf",
                )
            }),
        ),
        (30, row(1, |line| line.nu = "inf")),
        (
            31,
            row(
                2,
                |line| line.known = "digital step of the indication 0.010 g; already contained in the repeatability and not counted",
            ),
        ),
        (
            32,
            row(
                3,
                |line| line.known = "drift of the standard; limits ±0.0300 g; already contained in the certificate and not counted",
            ),
        ),
        (
            33,
            row(
                3,
                |line| line.known = "drift of the standard; limits ±0.0300 g; already contained in the certificate and not counted",
            ),
        ),
        (
            34,
            known(
                "drift of the standard; limits ±0.0300 g",
                0.03,
                root3,
                "rectangular",
            )
            .without(2),
        ),
        (35, right().without(1)),
        (
            36,
            known(
                "eccentric load; limits ±0.0300 g",
                0.03,
                root3,
                "rectangular",
            ),
        ),
        (
            37,
            with(|sheet| sheet.title = "Calibration of a gauge block"),
        ),
        (
            38,
            with(|sheet| sheet.more = "The deviation of the standard is not corrected."),
        ),
        (
            39,
            with(|sheet| {
                (sheet.lines[1].used, sheet.lines[1].known) = (
                    0.2,
                    "standard deviation s = 0.200 g of 5 readings; mean of 5 reported",
                )
            }),
        ),
        (40, with(|sheet| sheet.more = "ν_eff = 4")),
        (
            41,
            with(|sheet| {
                t(sheet);
                sheet.k = 2.11;
                sheet.more = "ν_eff = 17";
            }),
        ),
        (
            42,
            with(|sheet| {
                sheet.notes.push("Correlation: r(m_S, dd) = 0.5");
                sheet.r = Some((0, 3, 0.5));
                sheet.more = "ν_eff = 2099";
            }),
        ),
        (
            43,
            known(
                "drift of the standard; limits ±0.3000 g",
                0.3,
                root3,
                "rectangular",
            ),
        ),
        (
            44,
            with(|sheet| {
                t(sheet);
                sheet.k = 2.17;
                sheet.more = "ν_eff = 16";
            }),
        ),
        (45, with(|sheet| sheet.notes[1] = "Coverage factor k = 2")),
        (46, row(3, |line| line.used = 3e-5)),
        (
            47,
            row(3, |line| {
                (line.estimate, line.known, line.used) = (
                    "10.0 g",
                    "drift of the standard; limits ±3.00 % of the reading",
                    0.03,
                )
            }),
        ),
        (48, angle(60.0)),
        (49, replaced("u_i(y) / g", "u_i(y) / %")),
        (
            50,
            row(3, |line| {
                (line.estimate, line.known, line.used) = (
                    "30.0 g",
                    "drift; limits ±0.100 % of full scale, full scale 100 g",
                    0.03,
                )
            }),
        ),
        (51, angle(0.0)),
        (
            54,
            with(|sheet| {
                sheet.notes[0] = "Model: m = (m_S + dm + dr) / dd";
                sheet.lines[3].estimate = "0.05 g";
                sheet.y = "2000.053 g";
            }),
        ),
        (
            55,
            with(|sheet| {
                sheet.lines[0].estimate = "0.0005 g";
                sheet.y = "0.003 g";
            }),
        ),
        (
            56,
            with(|sheet| {
                sheet.lines[0].known = "certificate no. K-12: U = 0.0400 g and k = 2";
                sheet.lines[3].known =
                    "drift of the standard, certificate no. K-12: U = 0.0600 g and k = 2";
                sheet.lines[3].used = 0.06;
                sheet.lines[3].divisor = 2.0;
            }),
        ),
        (
            57,
            with(|sheet| {
                sheet.notes.push("r(m_S, dm) = 0.9");
                sheet.notes.push("r(dm, dd) = 0.9");
                sheet.notes.push("r(m_S, dd) = -0.9");
            }),
        ),
        (58, difference(1.0, Some(1.0))),
        (59, difference(0.6, None)),
        (
            60,
            with(|sheet| sheet.notes[0] = "Model: m = m_S + dm + dr"),
        ),
        (
            61,
            with(|sheet| {
                sheet.lines[0].known =
                    "slope of the line; certificate M-12: U = 0.0400 g and k = 2";
                sheet.lines[3].known = "intercept of the line, drift; limits ±0.0300 g";
            }),
        ),
        (63, replaced("U = 0.056", "U = 0.0562")),
        (
            64,
            with(|sheet| {
                sheet.lines[0].used = 0.15;
                sheet.lines[0].known = "certificate M-12: U = 0.150 g and k = 2";
                sheet.replaced = vec![("U = 0.16", "U = 0.2"), ("100.003", "100.0")];
            }),
        ),
        (65, replaced("m = 100.003 g", "m = 100.0026 g")),
        (66, replaced("U = 0.056 g", "U = 0.05 g")),
        (
            67,
            with(|sheet| {
                sheet.lines[3].used = 0.02904;
                sheet.lines[3].known = "drift of the standard; limits ±0.02904 g";
                sheet.replaced = vec![("U = 0.055", "U = 0.056")];
            }),
        ),
        (68, replaced("U = 0.056", "U = ±0.056")),
        (69, replaced("U = 0.056 g", "U = 0.056 %")),
        (70, with(|sheet| sheet.more = "CMC: 0.10 g")),
        (71, with(|sheet| sheet.more = "CMC: 0.056 g")),
        (
            73,
            with(|sheet| sheet.more = "The weight conforms to class M1."),
        ),
        (
            74,
            with(|sheet| {
                sheet.more =
                    "The weight conforms: tolerance 0.10 g, simple acceptance as decision rule."
            }),
        ),
        (
            75,
            row(0, |line| {
                (line.known, line.used) = ("certificate M-12: U = 0.4000 g and k = 2", 0.4)
            }),
        ),
        (
            76,
            with(|sheet| {
                sheet.lines[3].used = 0.002;
                sheet.lines[3].known = "drift of the standard; limits ±0.0020 g";
                sheet.lines[2].used = 0.0005;
                sheet.lines[2].known = "digital step of the indication 0.0010 g";
            }),
        ),
        (77, replaced("U = 0.056", "U = 0.028")),
        (
            78,
            with(|sheet| {
                sheet.notes[0] = "Model: m = 3 * m_S * (1 + dm + dr + dd)";
                sheet.lines[0].estimate = "0.0010 g";
                sheet.y = "0.003 g";
            }),
        ),
        (29, noted("One outlier was removed from the 11 readings")),
        (72, noted("CMC of the laboratory: 0.050 g (k = 3)")),
        (84, noted("Comparison of 2025: E_n = 1.4")),
        (
            23,
            row(
                1,
                |line| line.known = "pooled s from 4 series of 6 readings: 0.0010, 0.0012, 0.0011 and 0.0230; s_p = 0.0120 g; mean of 4 readings",
            ),
        ),
        (
            28,
            noted(
                "Readings: 100.001, 100.003, 100.004, 100.006, 100.007, 100.009, 100.010, 100.012, 100.013, 100.015",
            ),
        ),
        (
            52,
            with(|sheet| {
                sheet.notes[0] = "Model: m = m_S + dm + dr + 40*dd*dd";
                sheet.lines[3].c = 0.0;
            }),
        ),
        (
            53,
            noted("Monte Carlo, 10^6 trials: 95 % interval [99.871, 100.135] g"),
        ),
        (62, noted("Fit of the drift: χ²/ν = 2.4 with ν = 12")),
        (
            62,
            noted("Drift line: chi^2/dof = 3.1 (6 degrees of freedom)"),
        ),
        (
            79,
            noted("Standard: calibrated range 200 g to 2000 g, used at 100 g"),
        ),
        (
            79,
            row(
                0,
                |line| {
                    line.known =
                        "certificate M-12: U = 0.0400 g and k = 2; calibrated range 200 g to 5 kg"
                },
            ),
        ),
        (
            83,
            noted("编制日期：2021年3月14日；规程修订日期：2024年6月1日"),
        ),
        (
            83,
            noted("Budget prepared on 2021-05-01; method revised on 2024年2月1日"),
        ),
        (85, noted("Check standard: s = 0.031 g, predicted 0.012 g")),
        (
            86,
            with(|sheet| {
                let line = &mut sheet.lines[3];
                (line.estimate, line.known) = ("20 K", "temperature; limits ±0.0300 K");
                sheet.replaced = vec![("|0.01732|1|", "|0.01732 K|1|")];
            }),
        ),
        (
            80,
            with(|sheet| {
                sheet.notes.push("Standard: valid until 2025-01-31");
                sheet.more = "Measured on 2026-02-03";
            }),
        ),
        (
            81,
            row(3, |line| {
                (line.known, line.used) = ("drift of the standard; limits ±0.0370 g", 0.073)
            }),
        ),
    ]
}

impl Sheet {
    fn without(mut self, place: usize) -> Sheet {
        self.lines.remove(place);
        self.notes[0] = if place == 1 {
            "Model: m = m_S + dr + dd"
        } else {
            "Model: m = m_S + dm + dd"
        };
        self.y = if place == 1 { "100.001 g" } else { "100.003 g" };
        self
    }
}

/// An angle in degrees with the coefficient of degrees taken for that of radians; at 0° it is zero.
fn angle(at: f64) -> Sheet {
    with(|sheet| {
        sheet.notes[0] = "Model: m = m_S * cos(dd) + dm + dr";
        let c = if at == 0.0 { 0.0 } else { -86.6025 };
        sheet.lines[3] = line(
            [
                "dd",
                if at == 0.0 { "0 °" } else { "60 °" },
                "drift of the angle; limits ±0.0300 °",
                "inf",
                "rectangular",
            ],
            [0.03, libm::sqrt(3.0), c],
        );
        sheet.lines[0].c = if at == 0.0 { 1.0 } else { 0.5 };
        sheet.y = if at == 0.0 { "100.003 g" } else { "50.002 g" };
    })
}

/// The drift in a difference with the standard, correlated; what the laboratory took into account.
fn difference(stated: f64, used: Option<f64>) -> Sheet {
    with(|sheet| {
        sheet.notes[0] = "Model: m = m_S + dm + dr - dd";
        sheet.lines[3].c = -1.0;
        sheet.notes.push(if stated == 1.0 {
            "r(m_S, dd) = 1"
        } else {
            "r(m_S, dd) = 0.6"
        });
        sheet.r = used.map(|r| (0, 3, r));
    })
}
