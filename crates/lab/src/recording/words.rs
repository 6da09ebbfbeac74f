//! What findings say, and what to do about them.

use gumption_core::quantity::to_digits;
use gumption_fault::{Said, say};

use super::checks::{Finding, Problem};

impl Finding {
    /// One sentence without a final stop.
    pub fn said(&self) -> Said {
        let column = self.column.as_deref().unwrap_or_default();
        let column = Said::pair(column.to_owned(), column.replace("\", \"", "”、“"));
        let (count, line) = (self.count, self.line);
        let rows = match count {
            1 => say!("1 row"),
            _ => say!("{count} rows"),
        };
        let place = match count {
            1 => say!("in 1 row, line {line}"),
            _ => say!("in {count} rows, from line {line} on"),
        };
        match &self.problem {
            Problem::Missing => say!("\"{column}\" has no number {place}"),
            Problem::Empty => say!("\"{column}\" has no number at all"),
            Problem::DecimalComma => {
                say!("the commas in the numbers of \"{column}\" were read as decimal signs")
            }
            Problem::Gram => say!("\"{column}\" is in gram"),
            Problem::Spike { value, usual } => say!(
                "\"{column}\" is {value} where its dwell is about {usual}, line {line} (in {rows})",
                value = short(*value),
                usual = short(*usual)
            ),
            Problem::Unlabelled => say!("\"{column}\" has no label {place}"),
            Problem::TimeBackwards { from, to } => say!(
                "the time \"{column}\" goes back from {from} to {to} in line {line} (in {rows})",
                from = short(*from),
                to = short(*to)
            ),
            Problem::TimeRepeated { time } => say!(
                "the time \"{column}\" stays at {time} in line {line} (in {rows})",
                time = short(*time)
            ),
            Problem::TimeGap { longest, usual } => say!(
                "the time \"{column}\" jumps by up to {longest} where {usual} is usual, first in line {line} (in {rows})",
                longest = short(*longest),
                usual = short(*usual)
            ),
            Problem::Saturated { limit } => {
                say!("\"{column}\" is stuck at {limit} {place}: it looks saturated")
            }
            Problem::Constant { value } => say!("\"{column}\" is {value} in all {rows}"),
            Problem::EachRow => say!("each of the {count} rows counts as a point by itself"),
            Problem::TooFew { needed } => {
                say!("the recording has {rows}, at least {needed} are needed")
            }
            Problem::LabelAgain { label } => say!(
                "\"{label}\" in \"{column}\" comes back in line {line}: {count} separate stretches"
            ),
            Problem::LabelAbsent { label } => say!("\"{column}\" never is \"{label}\""),
            Problem::LabelUnknown { label, .. } => {
                say!("\"{column}\" is \"{label}\" {place}, which is not expected")
            }
            Problem::Merged { stretches } => {
                let dwells = match count {
                    1 => Said::default(),
                    dwells => say!(" (so in {dwells} dwells)"),
                };
                say!(
                    "\"{column}\" changes within one dwell, from line {line} on: {stretches} stretches of one value each are averaged{dwells}"
                )
            }
            Problem::Uneven { label, usual } => {
                let points = match count {
                    1 => say!("1 point"),
                    _ => say!("{count} points"),
                };
                say!(
                    "\"{label}\" has {points} where most others have {usual}, and its average stands for them"
                )
            }
        }
    }

    /// What to do about it, in the imperative.
    pub fn mend(&self) -> Said {
        match &self.problem {
            Problem::Missing => {
                say!("these values are left out; find out why they are missing")
            }
            Problem::Empty => say!("check that the column was recorded, or leave it out"),
            Problem::DecimalComma => say!("if they separate thousands, remove them"),
            Problem::Gram => say!(
                "if the acceleration of free fall is meant, write [gn], or state unit = \"gn\" for the column"
            ),
            Problem::Spike { .. } => say!(
                "such samples shift the mean of the dwell; find out what happened, and leave them out if they are no readings"
            ),
            Problem::Unlabelled => {
                say!("label these rows, or leave them out: they belong to no dwell")
            }
            Problem::TimeBackwards { .. } => {
                say!("sort the rows, or split the file where the clock was set or a new run begins")
            }
            Problem::TimeRepeated { .. } => {
                say!("check for rows recorded twice, or record the time with more digits")
            }
            Problem::TimeGap { .. } => say!("find out whether rows were lost"),
            Problem::Saturated { .. } => say!(
                "leave out the rows at the limit, or record again in a larger range: the mean at a limit is biased"
            ),
            Problem::Constant { .. } => say!(
                "check that the output is connected; if its noise is below the resolution, state the resolution"
            ),
            Problem::EachRow => say!(
                "if they are samples, say what tells dwells apart: `dwells`, `steps` or `still`; if each is an average, write average = \"none\""
            ),
            Problem::TooFew { .. } => say!("record longer, or at more points"),
            Problem::LabelAgain { .. } => {
                say!("each stretch is a dwell of its own; rename it if it is not the same")
            }
            Problem::LabelAbsent { .. } => say!("record it, or take it off the list"),
            Problem::LabelUnknown { near, .. } => match near {
                Some(near) => say!("did you mean \"{near}\"?"),
                None => say!("correct the label, or add it to the list"),
            },
            Problem::Merged { .. } => say!(
                "name it in `steps`, too: steps = [\"ax\", \"ay\"]; or name the column that tells the dwells apart in `dwells`"
            ),
            Problem::Uneven { .. } => say!(
                "what the average shall cancel remains in it; record the missing point, or check the labels"
            ),
        }
    }
}

/// A number without the digits that come of differences.
fn short(x: f64) -> f64 {
    to_digits(x, 9)
}
