//! Words and figures on sheets.

/// The same in English and Chinese.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Said(pub &'static str, pub &'static str);

impl Said {
    pub(super) fn of(self, chinese: bool) -> &'static str {
        if chinese { self.1 } else { self.0 }
    }
}

/// A number in significant digits, without a power of ten unless it is very small or large.
pub(super) fn plain(x: f64, digits: usize) -> String {
    if x == 0.0 {
        return "0".into();
    }
    if x.is_infinite() {
        return "∞".into();
    }
    let scientific = format!("{x:.*e}", digits - 1);
    let Some((mantissa, ten)) = scientific.split_once('e') else {
        return scientific;
    };
    let ten: i32 = ten.parse().unwrap_or(0);
    let places = digits as i32 - 1 - ten;
    if !(-6..=7).contains(&ten) {
        return format!("{mantissa}E{ten:+03}");
    }
    if places >= 0 {
        format!("{x:.*}", places as usize)
    } else {
        let zeros = libm::exp10(f64::from(-places));
        format!("{:.0}", libm::round(x / zeros) * zeros)
    }
}

/// A figure as it was typed: no more digits than it has.
pub(super) fn typed(x: f64) -> String {
    let text = format!("{x}");
    if text.len() > 12 {
        plain(x, 6)
    } else if x != 0.0 && x.abs() < 1e-6 {
        format!("{x:E}")
    } else {
        text
    }
}
