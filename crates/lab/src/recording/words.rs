//! What findings say, in both languages.

use gumption_fault::Said;

use super::checks::{Finding, Problem};

impl Finding {
    /// [`message`](Self::message) in the language of its reader.
    pub fn said(&self) -> Said {
        Said::pair(self.message(), self.message_zh())
    }

    /// [`advice`](Self::advice) in the language of its reader.
    pub fn mend(&self) -> Said {
        Said::pair(self.advice(), self.advice_zh())
    }

    /// One sentence without a final stop.
    pub fn message(&self) -> String {
        let column = self.column.as_deref().unwrap_or_default();
        let (count, line) = (self.count, self.line);
        let rows = if count == 1 {
            "1 row"
        } else {
            &format!("{count} rows")
        };
        let lines = if count == 1 {
            format!("line {line}")
        } else {
            format!("from line {line} on")
        };
        match &self.problem {
            Problem::Missing => format!("\"{column}\" has no number in {rows}, {lines}"),
            Problem::Empty => format!("\"{column}\" has no number at all"),
            Problem::DecimalComma => {
                format!("the commas in the numbers of \"{column}\" were read as decimal signs")
            }
            Problem::Gram => format!("\"{column}\" is in gram"),
            Problem::Spike { value, usual } => format!(
                "\"{column}\" is {} where its dwell is about {}, line {line} (in {rows})",
                short(*value),
                short(*usual)
            ),
            Problem::Unlabelled => format!("\"{column}\" has no label in {rows}, {lines}"),
            Problem::TimeBackwards { from, to } => {
                format!(
                    "the time \"{column}\" goes back from {} to {} in line {line} (in {rows})",
                    short(*from),
                    short(*to)
                )
            }
            Problem::TimeRepeated { time } => {
                format!(
                    "the time \"{column}\" stays at {} in line {line} (in {rows})",
                    short(*time)
                )
            }
            Problem::TimeGap { longest, usual } => format!(
                "the time \"{column}\" jumps by up to {} where {} is usual, first in line {line} (in {rows})",
                short(*longest),
                short(*usual)
            ),
            Problem::Saturated { limit } => {
                format!("\"{column}\" is stuck at {limit} in {rows}, {lines}: it looks saturated")
            }
            Problem::Constant { value } => format!("\"{column}\" is {value} in all {rows}"),
            Problem::EachRow => format!("each of the {count} rows counts as a point by itself"),
            Problem::TooFew { needed } => {
                format!("the recording has {rows}, at least {needed} are needed")
            }
            Problem::LabelAgain { label } => {
                format!(
                    "\"{label}\" in \"{column}\" comes back in line {line}: {count} separate stretches"
                )
            }
            Problem::LabelAbsent { label } => format!("\"{column}\" never is \"{label}\""),
            Problem::LabelUnknown { label, .. } => {
                format!("\"{column}\" is \"{label}\" in {rows}, {lines}, which is not expected")
            }
            Problem::Merged { stretches } => format!(
                "\"{column}\" changes within one dwell, from line {line} on: {stretches} stretches of one value each are averaged{}",
                match count {
                    1 => String::new(),
                    dwells => format!(" (so in {dwells} dwells)"),
                }
            ),
            Problem::Uneven { label, usual } => format!(
                "\"{label}\" has {} where most others have {usual}, and its average stands for them",
                if count == 1 {
                    "1 point".to_owned()
                } else {
                    format!("{count} points")
                }
            ),
        }
    }

    /// [`message`](Self::message) in Chinese.
    pub fn message_zh(&self) -> String {
        let column = self.column.as_deref().unwrap_or_default();
        let column = column.replace("\", \"", "”、“");
        let (count, line) = (self.count, self.line);
        let lines = if count == 1 {
            format!("第 {line} 行")
        } else {
            format!("自第 {line} 行起共 {count} 行")
        };
        match &self.problem {
            Problem::Missing => format!("“{column}”{lines}没有数值"),
            Problem::Empty => format!("“{column}”整列没有数值"),
            Problem::DecimalComma => format!("“{column}”中的逗号按小数点读取"),
            Problem::Gram => format!("“{column}”的单位是克"),
            Problem::Spike { value, usual } => format!(
                "“{column}”第 {line} 行为 {}，而所在驻留段约为 {}（共 {count} 行）",
                short(*value),
                short(*usual)
            ),
            Problem::Unlabelled => format!("“{column}”{lines}没有标签"),
            Problem::TimeBackwards { from, to } => {
                format!(
                    "时间列“{column}”在第 {line} 行由 {} 倒退到 {}（共 {count} 行）",
                    short(*from),
                    short(*to)
                )
            }
            Problem::TimeRepeated { time } => {
                format!(
                    "时间列“{column}”在第 {line} 行停留在 {}（共 {count} 行）",
                    short(*time)
                )
            }
            Problem::TimeGap { longest, usual } => format!(
                "时间列“{column}”有间断，最长 {}，通常间隔 {}，首见于第 {line} 行（共 {count} 行）",
                short(*longest),
                short(*usual)
            ),
            Problem::Saturated { limit } => {
                format!("“{column}”{lines}停在 {limit}，疑似饱和")
            }
            Problem::Constant { value } => format!("“{column}”全部 {count} 行均为 {value}"),
            Problem::EachRow => format!("{count} 行各作为一个独立的点"),
            Problem::TooFew { needed } => format!("记录只有 {count} 行，至少需要 {needed} 行"),
            Problem::LabelAgain { label } => {
                format!("“{column}”中的“{label}”在第 {line} 行再次出现，共 {count} 段")
            }
            Problem::LabelAbsent { label } => format!("“{column}”中没有“{label}”"),
            Problem::LabelUnknown { label, .. } => {
                format!("“{column}”{lines}为“{label}”，不在预期之列")
            }
            Problem::Merged { stretches } => format!(
                "“{column}”自第 {line} 行起在一个驻留段内有变化：{stretches} 段各为一个设定值，被一并平均{}",
                match count {
                    1 => String::new(),
                    dwells => format!("（共 {dwells} 个驻留段如此）"),
                }
            ),
            Problem::Uneven { label, usual } => {
                format!("“{label}”有 {count} 个点，其余多为 {usual} 个，其平均值由这些点求得")
            }
        }
    }

    /// What to do about it, in the imperative.
    pub fn advice(&self) -> String {
        match &self.problem {
            Problem::Missing => "these values are left out; find out why they are missing".into(),
            Problem::Empty => "check that the column was recorded, or leave it out".into(),
            Problem::DecimalComma => "if they separate thousands, remove them".into(),
            Problem::Gram => "if the acceleration of free fall is meant, write [gn], or state unit = \"gn\" for the column".into(),
            Problem::Spike { .. } => "such samples shift the mean of the dwell; find out what happened, and leave them out if they are no readings".into(),
            Problem::Unlabelled => "label these rows, or leave them out: they belong to no dwell".into(),
            Problem::TimeBackwards { .. } => {
                "sort the rows, or split the file where the clock was set or a new run begins".into()
            }
            Problem::TimeRepeated { .. } => {
                "check for rows recorded twice, or record the time with more digits".into()
            }
            Problem::TimeGap { .. } => "find out whether rows were lost".into(),
            Problem::Saturated { .. } => {
                "leave out the rows at the limit, or record again in a larger range: the mean at a limit is biased".into()
            }
            Problem::Constant { .. } => {
                "check that the output is connected; if its noise is below the resolution, state the resolution".into()
            }
            Problem::EachRow => "if they are samples, say what tells dwells apart: `dwells`, `steps` or `still`; if each is an average, write average = \"none\"".into(),
            Problem::TooFew { .. } => "record longer, or at more points".into(),
            Problem::LabelAgain { .. } => "each stretch is a dwell of its own; rename it if it is not the same".into(),
            Problem::LabelAbsent { .. } => "record it, or take it off the list".into(),
            Problem::LabelUnknown { near, .. } => match near {
                Some(near) => format!("did you mean \"{near}\"?"),
                None => "correct the label, or add it to the list".into(),
            },
            Problem::Merged { .. } => "name it in `steps`, too: steps = [\"ax\", \"ay\"]; or name the column that tells the dwells apart in `dwells`".into(),
            Problem::Uneven { .. } => "what the average shall cancel remains in it; record the missing point, or check the labels".into(),
        }
    }

    /// [`advice`](Self::advice) in Chinese.
    pub fn advice_zh(&self) -> String {
        match &self.problem {
            Problem::Missing => "这些值未使用，请查明缺失原因".into(),
            Problem::Empty => "请确认该列已记录，或不使用该列".into(),
            Problem::DecimalComma => "若为千位分隔符请去掉".into(),
            Problem::Gram => "若指重力加速度，请写 [gn]，或为该列给出 unit = \"gn\"".into(),
            Problem::Spike { .. } => {
                "这类采样会使驻留段平均值偏移；请查明原因，若非真实读数请剔除".into()
            }
            Problem::Unlabelled => "请补上标签或删去这些行：它们不属于任何驻留段".into(),
            Problem::TimeBackwards { .. } => {
                "请按时间排序，或在时钟重置、新一轮测量处拆分文件".into()
            }
            Problem::TimeRepeated { .. } => "请检查是否有重复记录的行，或以更多位数记录时间".into(),
            Problem::TimeGap { .. } => "请查明是否丢失数据行".into(),
            Problem::Saturated { .. } => {
                "请剔除停在极限处的行，或换大量程重新测量：极限处的平均值有偏".into()
            }
            Problem::Constant { .. } => "请检查输出是否接通；若噪声低于分辨力，请给出分辨力".into(),
            Problem::EachRow => "若为采样，请用 dwells、steps 或 still 指明驻留段；若每行即平均值，请写 average = \"none\"".into(),
            Problem::TooFew { .. } => "请延长记录或增加测量点".into(),
            Problem::LabelAgain { .. } => "每段各为一个驻留段；若非同一位置请改名".into(),
            Problem::LabelAbsent { .. } => "请补测该位置，或将其从清单中去掉".into(),
            Problem::LabelUnknown { near, .. } => match near {
                Some(near) => format!("是否应为“{near}”？"),
                None => "请更正标签，或将其加入清单".into(),
            },
            Problem::Merged { .. } => {
                "请将其一并列入 steps，如 steps = [\"ax\", \"ay\"]；或在 dwells 中给出区分驻留段的列".into()
            }
            Problem::Uneven { .. } => {
                "本应由平均抵消的影响会残留其中；请补测缺少的点或核对标签".into()
            }
        }
    }
}

/// A number without the digits that come of differences.
fn short(x: f64) -> String {
    let rounded = format!("{x:.8e}").parse::<f64>().unwrap_or(x);
    rounded.to_string()
}
