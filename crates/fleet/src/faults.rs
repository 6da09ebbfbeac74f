//! Codes of the faults in a table of results.

use gumption_fault::codes;

codes! {
    NO_MEASURAND = "F0101", "a table of results has no measurand", "结果表中没有被测量",
        "The statistics of a fleet need of each measurand y its estimates, a column `y` or `y [unit]`, and two of its standard uncertainty `u(y)`, its coverage factor `k(y)` and its expanded uncertainty `U(y)`: from two the third follows. `gumption batch` writes all of them.\n\n    label,I [mA],u(I) [mA],k(I),U(I) [mA]\n    a,9.999,0.0031,2,0.0062";
    NOT_A_DATE = "F0102", "a date cannot be read", "日期无法识别",
        "The dates of calibrations are written as `2026-03-01`, as `2026年3月1日`, as `01.03.2026` (with points the day goes first), or with a time behind them. A row may have none; it is left out of the drift then. `3/1/2026` leaves open which is the month.";
    NO_REFERENCE = "F0103", "a reference has no uncertainty", "参考值缺少不确定度",
        "E_n weighs a difference with the expanded uncertainties of both of its sides. Beside the column `X` of a reference stands `U(X)`, or `u(X)` with `k(X)`; 0 for a value that is exact. With several measurands, `--reference y=X` says whose reference it is.";
    SIGN = "F0104", "an uncertainty has a sign", "不确定度带有负号",
        "Standard and expanded uncertainties are not negative, coverage factors and degrees of freedom are greater than zero. An empty field of ν stands for infinitely many.";
    DISAGREE = "F0105", "an expanded uncertainty is not k·u", "扩展不确定度不等于 k·u",
        "Where all of `u(y)`, `k(y)` and `U(y)` are given, U = k·u, within what their last digits are rounded by. A U that was changed while u was not, or a u in another unit, contradicts it. Two of the three are enough.";
}

#[cfg(test)]
mod tests {
    #[test]
    fn codes_ascend() {
        assert!(super::CODES.windows(2).all(|pair| pair[0].id < pair[1].id));
    }
}
