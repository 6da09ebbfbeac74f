//! Generated sheets in coarse figures: what is called sound is printed as it is claimed.

use super::{answer, first, is_printed_as_claimed, is_sound};
use crate::read::Mapping;
use crate::{Verdict, audit, read, sheet};

/// Numbers of a linear congruential generator (Knuth, MMIX), each in [0, 1).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        const A: u64 = 6_364_136_223_846_793_005;
        const C: u64 = 1_442_695_040_888_963_407;
        self.0 = self.0.wrapping_mul(A).wrapping_add(C);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn of<T: Copy>(&mut self, all: &[T]) -> T {
        all[(self.next() * all.len() as f64) as usize]
    }
}

/// A number in significant digits, and its value as it is printed.
fn printed(x: f64, digits: i32) -> (String, f64) {
    let places = digits - 1 - x.log10().floor() as i32;
    let text = format!("{x:.*}", places.max(0) as usize);
    let value = text.parse().unwrap();
    (text, value)
}

/// How a generated laboratory works.
#[derive(Clone, Copy, PartialEq)]
struct Hand {
    /// Digits of contributions.
    digits: i32,
    /// Whether it adds the contributions as it prints them.
    adds_printed: bool,
    /// Whether it multiplies u_c as it prints it.
    multiplies_printed: bool,
    /// Whether it divides limits by 2.
    divides_by_two: bool,
}

fn sheet_of(numbers: &mut Numbers, hand: Hand) -> String {
    let mut text = String::from("Source,Half-width,Distribution,Divisor,c,u_i(y)\n");
    let mut squares = 0.0;
    for name in ["Reference", "Accuracy", "Setting", "Temperature", "Ageing"] {
        if numbers.next() < 0.25 {
            continue;
        }
        let lead = 1.0 + (numbers.next() * 98.0).floor() / 10.0;
        let (a, value) = printed(lead * numbers.of(&[1e-3, 1e-3, 1e-2]), numbers.of(&[1, 2]));
        let (divisor, by) = match hand.divides_by_two {
            true => ("2", 2.0),
            false => ("√3", 3.0_f64.sqrt()),
        };
        let (shown, rounded) = printed(value / by, hand.digits);
        let part = if hand.adds_printed {
            rounded
        } else {
            value / by
        };
        squares += part * part;
        text += &format!("{name},{a},rectangular,{divisor},1,{shown}\n");
    }
    let u_c = squares.max(1e-8).sqrt();
    let (shown, rounded) = printed(u_c, 3.min(hand.digits + 1));
    let u = if hand.multiplies_printed {
        rounded
    } else {
        u_c
    };
    text + &format!("u_c,,,,,{shown}\nU (k = 2),,,,,{}\n", printed(2.0 * u, 2).0)
}

/// Of every sheet that is called sound, U as recomputed is printed like the claimed one; a sheet that was computed from
/// unrounded figures is sound; one with limits by 2 is not.
#[test]
fn what_is_sound_is_printed_as_it_is_claimed() {
    let mut numbers = Numbers(20_261_124);
    let (mut sound, mut others) = (0, 0);
    for _ in 0..500 {
        let hand = Hand {
            digits: numbers.of(&[1, 2, 3]),
            adds_printed: numbers.of(&[true, false]),
            multiplies_printed: numbers.of(&[true, false]),
            divides_by_two: numbers.next() < 0.3,
        };
        let text = sheet_of(&mut numbers, hand);
        let grids = sheet::grids("sheet.csv", text.as_bytes()).unwrap();
        for claimed in read::budgets(&grids, &Mapping::default()) {
            let audited = audit(&claimed);
            let is_sound = audited.verdict == Verdict::Sound;
            assert!(!is_sound || is_printed_as_claimed(&audited), "{text}");
            let right = !hand.adds_printed && !hand.multiplies_printed && !hand.divides_by_two;
            assert!(is_sound || !right, "{text}");
            assert!(!is_sound || !hand.divides_by_two, "{text}");
            sound += usize::from(is_sound);
            others += usize::from(!is_sound);
        }
    }
    assert!(sound > 100 && others > 100, "{sound} {others}");
}

/// `0.002 / 2` and `0.002 / √3` are both printed as 0.001: the divisor says which it is.
#[test]
fn a_divisor_tells_what_digits_hide() {
    let sheet = "Source,Value,Unit,Half-width,Distribution,Divisor,ci,u_i(y)\n\
        Reference voltage,10.0,V,0.001,rectangular,2,1,0.0005\n\
        DMM accuracy,0,V,0.002,rectangular,2,1,0.001\n\
        Repeatability,0,V,0.0003,normal,1,1,0.0003\n\
        V_x,10.0003,V,,,,uc,0.00116\n,,,,,,U (k=2),0.0023\n";
    let both = "half-width-by-2@Reference voltage+half-width-by-2@DMM accuracy";
    assert_eq!(
        answer("sheet.csv", sheet),
        (Verdict::WithEffect, vec![both.to_string()])
    );
}

/// A sum of contributions as they are printed is a slip where U changes, and none where it does not.
#[test]
fn rounding_on_the_way_is_named_where_u_changes() {
    let sheet = |c: &str, u_c: &str, expanded: &str| {
        format!(
            "Source,Half-width,Distribution,Divisor,c,u_i(y)\nA,0.0026,rectangular,√3,1,{c}\nB,0.0010,rectangular,√3,1,0.0006\n\
             u_c,,,,,{u_c}\nU (k = 2),,,,,{expanded}\n"
        )
    };
    let rounded = vec!["intermediates-rounded".to_string()];
    assert_eq!(
        answer("sheet.csv", &sheet("0.002", "0.0021", "0.0042")),
        (Verdict::WithEffect, rounded)
    );
    assert_eq!(
        answer("sheet.csv", &sheet("0.0015", "0.0016", "0.0032")).0,
        Verdict::Sound
    );
}

/// u_c = √(700² + 1400² + 2887² + 500²) = 3322 µV; 2·3322 = 6644 µV is 6640 to three digits, which is one more than is reported.
#[test]
fn the_zeros_of_a_long_whole_number_are_no_digits() {
    let sheet = |expanded: &str| {
        format!(
            "DC voltage 100 V\nComponent,Limits / µV,Distribution,Divisor,u / µV\n\"Calibrator, certificate U (k=2)\",1400,normal,2,700\n\
             Calibrator drift,2425,rectangular,√3,1400\nResolution of DMM,5000,rectangular,√3,2887\n\
             Repeatability (std. dev. of mean),500,normal,1,500\nu_c,,,,3322\nU (k=2),,,,{expanded}\n"
        )
    };
    for expanded in ["6640", "6644"] {
        assert_eq!(first("sheet.csv", &sheet(expanded)), "too-many-digits");
    }
    is_sound("sheet.csv", &sheet("6600"));
    assert_eq!(answer("sheet.csv", &sheet("6740")).0, Verdict::Unexplained);
}
