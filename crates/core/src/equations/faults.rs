//! Codes of the faults in measurement equations.

use gumption_fault::codes;

codes! {
    NO_RESPONSE = "Q0101", "the left side of an equation is not observed", "方程左边不是观测量",
        "An equation says what an observed quantity should be: its left side is the name of a column (or of the known quantity that a combination of readings must give), its right side the formula.\n\n    U = K * omega + b      U is read from the recording";
    TWO_EQUATIONS = "Q0102", "a response has two equations", "同一响应量有两个方程",
        "Each observed quantity has one equation. What holds for some rows only is said within it, with `if`, or by quantities that differ from row to row.";
}
