//! Codes of the faults in experiment files.

use gumption_fault::codes;

codes! {
    NO_PROCEDURE = "C0101", "a procedure is not in the library", "内置库中没有该测量程序",
        "`procedure` names a procedure of the library. A file without it states its own `equations`.";
}
