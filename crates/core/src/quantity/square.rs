//! Units in one sign, as Chinese keyboards have them: `㎜`, `㎡`, `㎨` (Unicode, block CJK Compatibility).

/// The signs from the first one of each run on, written out as the syntax of units has it; `-` for what is no unit, or leaves
/// open which one.
const RUNS: [(char, &str); 2] = [
    ('㍱', "hPa - au bar - - dm dm² dm³ -"),
    (
        '㎀',
        "pA nA µA mA kA - - - cal kcal pF nF µF µg mg kg Hz kHz MHz GHz THz µL mL dL kL fm nm µm mm cm km \
         mm² cm² m² km² mm³ cm³ m³ km³ (m/s) (m/s²) Pa kPa MPa GPa rad (rad/s) (rad/s²) ps ns µs ms pV nV µV mV kV MV \
         pW nW µW mW kW MW kΩ MΩ - Bq cm³ cd (C/kg) - dB Gy ha - in - - kt lm - - lx - mil mol pH - ppm - sr Sv Wb (V/m) (A/m)",
    ),
];

/// What a sign stands for.
pub(super) fn written_out(sign: char) -> Option<&'static str> {
    RUNS.iter().find_map(|(first, units)| {
        let at = u32::from(sign).checked_sub(u32::from(*first))?;
        let unit = units.split(' ').nth(at as usize)?;
        (unit != "-").then_some(unit)
    })
}

/// What a sign stands for, where that is a single name, to which letters may belong: `㎜Hg`.
pub(super) fn name(sign: char) -> Option<&'static str> {
    written_out(sign).filter(|unit| unit.chars().all(char::is_alphabetic))
}

#[cfg(test)]
mod tests {
    use super::super::UnitTable;
    use super::*;

    /// The compatibility decompositions of Unicode (UnicodeData.txt): the ends of both runs, and signs between.
    #[test]
    fn signs_are_those_of_unicode() {
        for (sign, unit) in [
            ('\u{3371}', Some("hPa")),
            ('\u{3379}', Some("dm³")),
            ('\u{337a}', None),
            ('\u{3380}', Some("pA")),
            ('\u{338f}', Some("kg")),
            ('\u{339c}', Some("mm")),
            ('\u{33a1}', Some("m²")),
            ('\u{33a8}', Some("(m/s²)")),
            ('\u{33af}', Some("(rad/s²)")),
            ('\u{33b7}', Some("mV")),
            ('\u{33c1}', Some("MΩ")),
            ('\u{33c4}', Some("cm³")),
            ('\u{33d6}', Some("mol")),
            ('\u{33df}', Some("(A/m)")),
            ('\u{33e0}', None),
            ('m', None),
        ] {
            assert_eq!(written_out(sign), unit, "{sign}");
        }
    }

    #[test]
    fn every_sign_is_a_unit() {
        let units = UnitTable::default();
        let signs = ('\u{3300}'..='\u{33ff}').filter(|sign| written_out(*sign).is_some());
        for sign in signs {
            let spelt = written_out(sign).map(|text| units.parse(text).expect(text));
            let read = units.parse(&sign.to_string()).ok();
            let parts =
                |unit: Option<super::super::Unit>| unit.map(|unit| (unit.dimension, unit.factor));
            assert_eq!(parts(read), parts(spelt), "{sign}");
        }
    }
}
