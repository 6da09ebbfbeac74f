//! What makes a readable recording doubtful.

use std::collections::{HashMap, HashSet};

use super::{Column, Data, Labels, Recording};
use gumption_fault::nearest;

/// What is to be looked at. Roles that the recording lacks are passed over.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Checks<'a> {
    /// The role that is the time.
    pub time: Option<&'a str>,
    /// The roles that instruments have measured: these may saturate.
    pub outputs: &'a [&'a str],
    /// The least and the greatest value that the instrument of an output can give, in the unit of the
    /// column.
    pub ranges: &'a [(&'a str, [f64; 2])],
    /// The roles with labels that tell dwells apart: the time may jump between dwells, and dwells come back
    /// where all of these labels do.
    pub dwells: &'a [&'a str],
    /// A role with labels, and those that it should have, in any order.
    pub expected: Option<(&'a str, &'a [&'a str])>,
    /// The fewest rows that make sense.
    pub fewest: usize,
}

/// Something doubtful in a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// What it is.
    pub problem: Problem,
    /// The header of the column, if it is one column's.
    pub column: Option<String>,
    /// The first line where it is seen; 0 where it is no line's.
    pub line: usize,
    /// In how many rows it is seen.
    pub count: usize,
}

/// The kinds of findings. Values are in the units of their columns.
#[derive(Debug, Clone, PartialEq)]
pub enum Problem {
    /// A field without a number: empty, NaN, an overload of the instrument.
    Missing,
    /// No number in the whole column.
    Empty,
    /// Numbers have decimal commas.
    DecimalComma,
    /// The unit is gram, which instruments write for the acceleration of free fall too.
    Gram,
    /// Samples of a dwell far from all its others.
    Spike {
        /// The one that is farthest.
        value: f64,
        /// The median of the dwell.
        usual: f64,
    },
    /// A field without a label.
    Unlabelled,
    /// The time goes backwards.
    TimeBackwards {
        /// The time of the row before.
        from: f64,
        /// The time of the row.
        to: f64,
    },
    /// Successive rows have the same time.
    TimeRepeated {
        /// That time.
        time: f64,
    },
    /// Intervals more than one and a half times the median one: rows were lost.
    TimeGap {
        /// The longest interval.
        longest: f64,
        /// The median interval.
        usual: f64,
    },
    /// An output stays at its extreme as only a limit makes it.
    Saturated {
        /// The limit.
        limit: f64,
    },
    /// All values of an output are equal.
    Constant {
        /// That value.
        value: f64,
    },
    /// Each of many rows counts as a point, and nothing says that it is an average.
    EachRow,
    /// There are too few rows.
    TooFew {
        /// How many there should be.
        needed: usize,
    },
    /// A label, or labels that tell dwells apart together, come back after others.
    LabelAgain {
        /// The label, or the labels.
        label: String,
    },
    /// What is averaged as one dwell holds several values of a stimulus.
    Merged {
        /// Stretches of one value each in the first of them.
        stretches: usize,
    },
    /// Points are averaged over a label, and it has more or fewer of them than others.
    Uneven {
        /// The label.
        label: String,
        /// How many points most labels have.
        usual: usize,
    },
    /// An expected label does not occur.
    LabelAbsent {
        /// The label.
        label: String,
    },
    /// A label occurs that is not expected.
    LabelUnknown {
        /// The label.
        label: String,
        /// The expected one that may be meant.
        near: Option<String>,
    },
}

/// How grave a finding is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The recording may be used; the reader should know.
    Note,
    /// Results may be wrong.
    Warning,
    /// Nothing should be computed from it.
    Error,
}

impl Finding {
    /// How grave it is.
    pub fn severity(&self) -> Severity {
        match &self.problem {
            Problem::Empty
            | Problem::TimeBackwards { .. }
            | Problem::TooFew { .. }
            | Problem::LabelAbsent { .. }
            | Problem::LabelUnknown { .. } => Severity::Error,
            // Samples of minutes, taken for points, would give figures in earnest after a long search.
            Problem::EachRow if self.count > 1000 => Severity::Error,
            Problem::LabelAgain { .. } | Problem::DecimalComma | Problem::Gram => Severity::Note,
            _ => Severity::Warning,
        }
    }
}

/// Everything doubtful, the gravest first.
pub fn check(recording: &Recording, checks: &Checks) -> Vec<Finding> {
    let mut findings = Vec::new();
    if recording.rows() < checks.fewest {
        let needed = checks.fewest;
        findings.push(Finding {
            problem: Problem::TooFew { needed },
            column: None,
            line: 0,
            count: recording.rows(),
        });
    }
    let stretches = Stretches::of(recording, checks.dwells);
    for column in &recording.columns {
        let look = Look { recording, column };
        match &column.data {
            Data::Numbers(values) => {
                findings.extend(look.missing(values));
                findings.extend(look.gram(values));
                if checks.time == Some(column.role.as_str()) {
                    findings.extend(look.time(values, &stretches));
                }
                if checks.outputs.contains(&column.role.as_str()) {
                    let ranges = checks.ranges.iter();
                    let mut range = ranges
                        .filter(|(role, _)| *role == column.role)
                        .map(|(_, range)| *range);
                    findings.extend(look.output(values, range.next_back()));
                }
            }
            Data::Labels(labels) => {
                findings.extend(look.unlabelled(labels));
                if let Some((_, expected)) =
                    checks.expected.filter(|(role, _)| *role == column.role)
                {
                    findings.extend(look.expected(labels, expected));
                }
            }
        }
    }
    findings.extend(stretches.that_come_back(recording));
    findings.extend(decimal_commas(recording));
    findings.sort_by_key(|finding| std::cmp::Reverse(finding.severity()));
    findings
}

/// One finding for all columns with decimal commas.
fn decimal_commas(recording: &Recording) -> Option<Finding> {
    let columns = recording.columns.iter();
    let headers: Vec<&str> = columns
        .filter(|column| column.decimal_comma)
        .map(|column| column.header.as_str())
        .collect();
    (!headers.is_empty()).then(|| Finding {
        problem: Problem::DecimalComma,
        column: Some(headers.join("\", \"")),
        line: recording.line(0),
        count: recording.rows(),
    })
}

/// A column under inspection.
struct Look<'a> {
    recording: &'a Recording,
    column: &'a Column,
}

impl Look<'_> {
    fn finding(&self, problem: Problem, first: usize, count: usize) -> Finding {
        Finding {
            problem,
            column: Some(self.column.header.clone()),
            line: self.recording.line(first),
            count,
        }
    }

    fn missing(&self, values: &[f64]) -> Option<Finding> {
        let first = values.iter().position(|value| value.is_nan())?;
        let count = values.iter().filter(|value| value.is_nan()).count();
        let problem = if count == values.len() {
            Problem::Empty
        } else {
            Problem::Missing
        };
        Some(self.finding(problem, first, count))
    }

    fn gram(&self, values: &[f64]) -> Option<Finding> {
        let unit = self.column.unit.as_ref()?;
        let is_gram = ["g", "mg", "µg"].contains(&unit.symbol.as_str());
        is_gram.then(|| self.finding(Problem::Gram, 0, values.len()))
    }

    fn time(&self, values: &[f64], stretches: &Stretches) -> Vec<Finding> {
        let present: Vec<(usize, f64)> = values
            .iter()
            .copied()
            .enumerate()
            .filter(|(_, time)| !time.is_nan())
            .collect();
        let steps = || {
            present
                .windows(2)
                .map(|pair| (pair[1].0, pair[0].1, pair[1].1))
        };
        let backwards: Vec<_> = steps().filter(|(_, from, to)| to < from).collect();
        let repeated: Vec<_> = steps().filter(|(_, from, to)| to == from).collect();
        let mut intervals: Vec<f64> = steps().map(|(_, from, to)| to - from).collect();
        intervals.sort_by(f64::total_cmp);
        let usual = intervals.get(intervals.len() / 2).copied().unwrap_or(0.0);
        let gaps: Vec<_> = steps()
            .filter(|(row, from, to)| to - from > 1.5 * usual && !stretches.begins_at(*row))
            .collect();
        let longest = gaps.iter().map(|(_, from, to)| to - from);
        let longest = longest.fold(0.0, f64::max);
        // Where many intervals are long, the rows are not meant to be equally spaced.
        let rare = gaps.len() * 20 <= intervals.len() && usual > 0.0;
        let gap = Problem::TimeGap { longest, usual };
        let seen = |all: &[(usize, f64, f64)], problem: &dyn Fn(f64, f64) -> Problem| {
            let (row, from, to) = *all.first()?;
            Some(self.finding(problem(from, to), row, all.len()))
        };
        [
            seen(&backwards, &|from, to| Problem::TimeBackwards { from, to }),
            seen(&repeated, &|time, _| Problem::TimeRepeated { time }),
            seen(&gaps, &|_, _| gap.clone()).filter(|_| rare),
        ]
        .into_iter()
        .flatten()
        .collect()
    }

    fn output(&self, values: &[f64], range: Option<[f64; 2]>) -> Vec<Finding> {
        let present: Vec<(usize, f64)> = values
            .iter()
            .copied()
            .enumerate()
            .filter(|(_, value)| !value.is_nan())
            .collect();
        let extreme = |better: fn(f64, f64) -> f64| present.iter().map(|p| p.1).reduce(better);
        let (Some(low), Some(high)) = (extreme(f64::min), extreme(f64::max)) else {
            return Vec::new();
        };
        if low == high && present.len() > 1 {
            let value = low;
            return vec![self.finding(Problem::Constant { value }, 0, present.len())];
        }
        if let Some([least, greatest]) = range {
            let beyond = |limit: f64, at: &dyn Fn(f64) -> bool| {
                let first = present.iter().find(|(_, value)| at(*value))?.0;
                let count = present.iter().filter(|(_, value)| at(*value)).count();
                Some(self.finding(Problem::Saturated { limit }, first, count))
            };
            let low = beyond(least, &|value| value <= least);
            let high = beyond(greatest, &|value| value >= greatest);
            return low.into_iter().chain(high).collect();
        }
        let pile = Pile::new(&present, [low, high]);
        [low, high]
            .into_iter()
            .filter(|limit| pile.is_limit(*limit))
            .filter_map(|limit| {
                let first = present.iter().find(|(_, value)| *value == limit)?.0;
                let count = present.iter().filter(|(_, value)| *value == limit).count();
                Some(self.finding(Problem::Saturated { limit }, first, count))
            })
            .collect()
    }

    fn unlabelled(&self, labels: &Labels) -> Option<Finding> {
        let missing = |row: &usize| labels.text(*row).is_empty();
        let rows = labels.of_row.len();
        let first = (0..rows).find(missing)?;
        let count = (0..rows).filter(missing).count();
        Some(self.finding(Problem::Unlabelled, first, count))
    }

    fn expected(&self, labels: &Labels, expected: &[&str]) -> Vec<Finding> {
        let present: HashSet<&str> = labels.levels.iter().map(String::as_str).collect();
        let absent = expected
            .iter()
            .filter(|label| !present.contains(*label))
            .map(|label| Finding {
                line: 0,
                ..self.finding(
                    Problem::LabelAbsent {
                        label: (*label).to_owned(),
                    },
                    0,
                    0,
                )
            });
        let unknown = (0_u32..).zip(&labels.levels).filter_map(|(level, label)| {
            if label.is_empty() || expected.contains(&label.as_str()) {
                return None;
            }
            let at = |other: &&u32| **other == level;
            let first = labels.of_row.iter().position(|other| *other == level)?;
            let near = nearest(label, expected.iter().copied()).map(str::to_owned);
            let problem = Problem::LabelUnknown {
                label: label.clone(),
                near,
            };
            Some(self.finding(problem, first, labels.of_row.iter().filter(at).count()))
        });
        absent.chain(unknown).collect()
    }
}

/// Stretches of rows with the same labels.
struct Stretches {
    /// The headers of the columns.
    headers: String,
    /// Where each stretch begins.
    begins: Vec<usize>,
    /// The labels of each stretch; empty where one is missing.
    labels: Vec<String>,
}

impl Stretches {
    fn of(recording: &Recording, roles: &[&str]) -> Stretches {
        let columns: Vec<(&Column, &Labels)> = recording
            .columns
            .iter()
            .filter(|column| roles.contains(&column.role.as_str()))
            .filter_map(|column| match &column.data {
                Data::Labels(labels) => Some((column, labels)),
                Data::Numbers(_) => None,
            })
            .collect();
        let headers: Vec<&str> = columns.iter().map(|(c, _)| c.header.as_str()).collect();
        let mut stretches = Stretches {
            headers: headers.join("\", \""),
            begins: Vec::new(),
            labels: Vec::new(),
        };
        if columns.is_empty() {
            return stretches;
        }
        let level = |row: usize| columns.iter().map(move |(_, labels)| labels.of_row[row]);
        for row in 0..recording.rows() {
            if row == 0 || !level(row - 1).eq(level(row)) {
                let texts: Vec<&str> = columns.iter().map(|(_, l)| l.text(row)).collect();
                let complete = texts.iter().all(|text| !text.is_empty());
                let label = texts.join(", ");
                stretches.begins.push(row);
                stretches
                    .labels
                    .push(if complete { label } else { String::new() });
            }
        }
        stretches
    }

    fn begins_at(&self, row: usize) -> bool {
        self.begins.binary_search(&row).is_ok()
    }

    fn that_come_back(&self, recording: &Recording) -> Vec<Finding> {
        let mut seen: Vec<(&str, Vec<usize>)> = Vec::new();
        let mut places: HashMap<&str, usize> = HashMap::new();
        for (label, row) in self.labels.iter().zip(&self.begins) {
            let place = *places.entry(label).or_insert(seen.len());
            match seen.get_mut(place) {
                Some((_, rows)) => rows.push(*row),
                None => seen.push((label, vec![*row])),
            }
        }
        let again = |(label, rows): (&str, Vec<usize>)| match rows.as_slice() {
            [_, again, ..] if !label.is_empty() => Some(Finding {
                problem: Problem::LabelAgain {
                    label: label.to_owned(),
                },
                column: Some(self.headers.clone()),
                line: recording.line(*again),
                count: rows.len(),
            }),
            _ => None,
        };
        seen.into_iter().filter_map(again).collect()
    }
}

/// How values repeat: at the two extremes, and elsewhere.
struct Pile {
    /// Length of the longest stretch of equal values, and how often a value occurs at most.
    elsewhere: (usize, usize),
    extremes: [(f64, usize, usize); 2],
    total: usize,
}

impl Pile {
    fn new(present: &[(usize, f64)], extremes: [f64; 2]) -> Pile {
        let mut occurs: HashMap<u64, usize> = HashMap::new();
        let mut stretch: HashMap<u64, usize> = HashMap::new();
        // Adding zero makes one zero of the two.
        let key = |value: f64| (value + 0.0).to_bits();
        for equal in present.chunk_by(|a, b| a.1 == b.1) {
            let bits = key(equal[0].1);
            *occurs.entry(bits).or_default() += equal.len();
            let longest = stretch.entry(bits).or_default();
            *longest = equal.len().max(*longest);
        }
        let at = |value: f64| {
            let bits = key(value);
            (
                value,
                stretch.get(&bits).copied().unwrap_or(0),
                occurs.get(&bits).copied().unwrap_or(0),
            )
        };
        let extremes = extremes.map(at);
        let others = |counts: &HashMap<u64, usize>| {
            let ends = extremes.map(|(value, ..)| key(value));
            let inner = counts.iter().filter(|(bits, _)| !ends.contains(bits));
            inner.map(|(_, count)| *count).max().unwrap_or(0)
        };
        Pile {
            elsewhere: (others(&stretch), others(&occurs)),
            extremes,
            total: present.len(),
        }
    }

    /// Whether an extreme is a limit: values stay there much longer than elsewhere, or it alone repeats
    /// among readings that are all different.
    fn is_limit(&self, value: f64) -> bool {
        let (stretch, occurs) = self.elsewhere;
        self.extremes.iter().any(|(extreme, longest, count)| {
            let stays = stretch > 0 && *longest > 5 * stretch;
            let alone = occurs == 1 && *count >= 3 && self.total >= 10;
            *extreme == value && (stays || alone)
        })
    }
}
