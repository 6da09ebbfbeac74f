//! The same file gives the same bits with every instruction set and every number of threads.

/// As `gumption_lanes::level::name` writes them; those that this processor does not have are passed over and
/// give the best one's result, which is the same anyway.
const INSTRUCTION_SETS: [&str; 5] = ["SSE2", "SSE4.2", "AVX2", "AVX-512", "NEON"];

/// Enough for counting in stretches and for resolving from what was kept.
const TRIALS: &str = "600000";

fn evaluation(file: &str, instruction_set: &str, threads: &str) -> String {
    let output = crate::common::program()
        .args([
            "eval",
            file,
            "--json",
            "--trials",
            TRIALS,
            "--threads",
            threads,
        ])
        .env("GUMPTION_INSTRUCTION_SET", instruction_set)
        .output()
        .expect("the program runs");
    assert!(output.status.success(), "{file}");
    String::from_utf8(output.stdout).expect("JSON is UTF-8")
}

#[test]
fn results_do_not_depend_on_threads_or_instructions() {
    for file in [
        "budgets/length/gauge-block-gum-s1-9-5.toml",
        "budgets/statistics/comparison-loss-gum-s1-9-4-x010-r00.toml",
    ] {
        let expected = evaluation(file, "", "1");
        for threads in ["2", "3", "8"] {
            assert_eq!(
                evaluation(file, "", threads),
                expected,
                "{file}: {threads} threads"
            );
        }
        for set in INSTRUCTION_SETS {
            assert_eq!(evaluation(file, set, "2"), expected, "{file}: {set}");
        }
    }
}
