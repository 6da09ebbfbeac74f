//! Statements that are those of a Monte Carlo calculation: the rows of a sheet do not give them.

use crate::claim::{Claimed, Coverage, OF_MONTE_CARLO};

use super::footer::{self, Whole};
use super::words::has;

/// Names of the method.
pub const MONTE_CARLO: [&str; 5] = ["monte carlo", "monte-carlo", "mcm", "蒙特卡洛", "蒙特卡罗"];

/// Sets k and U aside where the sheet says that they are of Monte Carlo: what is left is held against the calculation.
pub(super) fn set_aside(claimed: &mut Claimed) {
    if !claimed.words.lines().any(states_simulation) {
        return;
    }
    let footer = &mut claimed.footer;
    let figures = [footer.k.take(), footer.expanded.take()];
    claimed.coverage = Coverage::Unstated;
    for read in &mut claimed.understood {
        let of_figure = figures.iter().flatten().any(|figure| figure.at == read.at);
        if of_figure || read.role == "rule for k" {
            read.role = OF_MONTE_CARLO;
        }
    }
}

/// `Reported is the Monte Carlo result`, `U from Monte Carlo`, `报告采用蒙特卡洛法的结果`.
fn states_simulation(line: &str) -> bool {
    const REPORTED: [&str; 4] = ["reported is the", "states the", "uses the", "报告采用"];
    const ORIGIN: [&str; 3] = ["from", "from the", "由"];
    let lower = line.to_lowercase();
    let behind = |words: &[&str]| {
        let mut pairs = words
            .iter()
            .flat_map(|word| MONTE_CARLO.map(|name| (*word, name)));
        pairs.any(|(word, name)| {
            let phrase = [format!("{word} {name}"), format!("{word}{name}")];
            has(&lower, &phrase.each_ref().map(String::as_str))
        })
    };
    let is_of_statement = matches!(
        footer::label(line, ""),
        Some(Whole::Expanded | Whole::Factor)
    );
    behind(&REPORTED) || is_of_statement && behind(&ORIGIN)
}
