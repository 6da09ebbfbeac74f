//! What the columns of a recording may be, by how their numbers behave and by their names.

use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

use gumption_core::quantity::UnitTable;
use gumption_core::statistics::range;
use gumption_format::csv::{self, Column, Data, Labels};

use crate::experiment::entries::RoleWord;

pub(super) fn roles(columns: &[Column]) -> Vec<RoleWord> {
    let measured = measured_time(columns);
    let of_column = |(at, column)| match measured == Some(at) {
        true => None,
        false => by_itself(column, columns),
    };
    let mut roles: Vec<Option<RoleWord>> = columns.iter().enumerate().map(of_column).collect();
    let open: Vec<usize> = (0..columns.len())
        .filter(|at| roles[*at].is_none())
        .collect();
    // What is set takes few values, what is read many; of several that are read the last that is no condition is the output, and with it
    // those that differ by their axis.
    let last = |is: &dyn Fn(&Column) -> bool| {
        let mut read = open.iter().rev().filter(|at| !is_nominal(&columns[**at]));
        read.find(|at| is(&columns[**at]))
    };
    let output = last(&|column| !is_set(column) && !is_condition(column))
        .or_else(|| last(&|column| !is_condition(column)))
        .or_else(|| last(&|_| true))
        .or(open.last())
        .copied();
    for at in &open {
        if output.is_some_and(|output| *at == output || is_kin(&columns[*at], &columns[output])) {
            roles[*at] = Some(RoleWord::Output);
        }
    }
    let best_of = |rest: &[usize]| {
        let candidates = rest.iter().map(|at| &columns[*at]);
        let best = output.and_then(|output| followed(&columns[output], candidates));
        best.map(|place| rest[place])
    };
    let mut rest: Vec<usize> = open.into_iter().filter(|at| roles[*at].is_none()).collect();
    // Beside a reference that is read, and that the output follows as well, what was to be set tells nothing.
    rest.sort_by_key(|at| is_nominal(&columns[*at]));
    if best_of(&rest).is_some_and(|best| !is_nominal(&columns[best])) {
        rest.retain(|at| !is_nominal(&columns[*at]));
    }
    let are_conditions = rest.iter().all(|at| is_condition(&columns[*at]));
    let are_read = rest.iter().all(|at| !is_set(&columns[*at]));
    // A temperature is a condition, unless it is set, or nothing else is there, and the output follows it best of all. What is read
    // while something else is set is one, too, unless the output follows it.
    let best = best_of(&rest);
    for at in rest {
        let column = &columns[at];
        let is_followed = best.is_some_and(|best| best == at || is_kin(column, &columns[best]));
        let is_stimulus = match is_condition(column) {
            true => best == Some(at) && (are_conditions || is_set(column)),
            false => are_read || is_followed || is_set(column),
        };
        roles[at] = Some(match is_stimulus {
            true if in_turns(column).is_some() => RoleWord::Angle,
            true => RoleWord::Stimulus,
            false => RoleWord::Covariate,
        });
    }
    let roles = roles
        .into_iter()
        .map(|role| role.unwrap_or(RoleWord::Ignore));
    in_time(roles.collect())
}

/// The last column where it is a time and all others are set or conditions: how long a body fell or swung was measured.
fn measured_time(columns: &[Column]) -> Option<usize> {
    let (last, others) = columns.split_last()?;
    let is_read = |column: &&Column| {
        let is_number = matches!(column.data, Data::Numbers(_));
        is_number
            && !is_set(column)
            && !is_condition(column)
            && !is_clock(column)
            && !counts(column)
    };
    let is_measured = matches!(last.data, Data::Numbers(_)) && is_clock(last) && !is_set(last);
    let something_set = others
        .iter()
        .any(|column| is_set(column) && !is_condition(column));
    (is_measured && something_set && !others.iter().any(|column| is_read(&column)))
        .then_some(columns.len() - 1)
}

/// Whether it counts the rows: whole numbers without a unit, one more in each row.
fn counts(column: &Column) -> bool {
    let Data::Numbers(numbers) = &column.data else {
        return false;
    };
    column.unit.is_none()
        && numbers.len() > 1
        && numbers.windows(2).all(|pair| pair[1] - pair[0] == 1.0)
        && numbers[0].fract() == 0.0
}

/// Of times one is the time; where there is none, a number of the row says which was first.
fn in_time(mut roles: Vec<RoleWord>) -> Vec<RoleWord> {
    let is_time = |role: &RoleWord| *role == RoleWord::Time;
    let first = roles.iter().position(is_time);
    let is_order = |role: &RoleWord| *role == RoleWord::Order;
    let order = roles.iter().position(is_order).filter(|_| first.is_none());
    for (at, role) in roles.iter_mut().enumerate() {
        *role = match *role {
            RoleWord::Time if first != Some(at) => RoleWord::Covariate,
            RoleWord::Order if order != Some(at) => RoleWord::Ignore,
            role => role,
        };
    }
    roles
}

/// The place of the column that an output follows best, along a straight line or around a turn; of equal ones the first.
pub(super) fn followed<'r>(
    output: &Column,
    among: impl Iterator<Item = &'r Column>,
) -> Option<usize> {
    // In hundredths: what noise makes of equal ones does not decide.
    let strength = |column: &Column| match (&column.data, &output.data) {
        (Data::Numbers(x), Data::Numbers(y)) => {
            let turned = in_turns(column).map_or(0.0, |angles| of_turns(&angles, y));
            (100.0 * determination(x, y).max(turned)).round() as i64
        }
        _ => -1,
    };
    let strengths: Vec<i64> = among.map(strength).collect();
    let best = strengths.iter().max()?;
    strengths.iter().position(|strength| strength == best)
}

/// Whether an output goes around with an angle rather than along it: a tumbled accelerometer, and no potentiometer.
pub(super) fn goes_around(output: &Column, angle: &Column) -> bool {
    let (Data::Numbers(x), Data::Numbers(y)) = (&angle.data, &output.data) else {
        return false;
    };
    in_turns(angle).is_some_and(|angles| of_turns(&angles, y) > determination(x, y))
}

/// The numbers of a column in radian, where it is an angle that passes half a turn.
fn in_turns(column: &Column) -> Option<Vec<f64>> {
    let Data::Numbers(numbers) = &column.data else {
        return None;
    };
    let factor = TAU / column.unit.as_ref()?.full_turn()?;
    let angles: Vec<f64> = numbers.iter().map(|x| factor * x).collect();
    let (least, most) = range(angles.iter().copied().filter(|x| x.is_finite()));
    (most - least > PI).then_some(angles)
}

/// R² of a straight line through the rows in which both are numbers.
pub(super) fn determination(x: &[f64], y: &[f64]) -> f64 {
    let [x, y] = centred([x.to_vec(), y.to_vec()]);
    let (xx, yy) = (product(&x, &x), product(&y, &y));
    match xx > 0.0 && yy > 0.0 {
        true => product(&x, &y).powi(2) / (xx * yy),
        false => 0.0,
    }
}

/// R² of y = a + b sin φ + c cos φ.
fn of_turns(angles: &[f64], y: &[f64]) -> f64 {
    let of = |function: fn(f64) -> f64| angles.iter().map(|angle| function(*angle)).collect();
    let [s, c, y] = centred([of(libm::sin), of(libm::cos), y.to_vec()]);
    let (ss, cc, sc) = (product(&s, &s), product(&c, &c), product(&s, &c));
    let (sy, cy, yy) = (product(&s, &y), product(&c, &y), product(&y, &y));
    let determinant = ss * cc - sc * sc;
    // Angles of which the sine tells the cosine leave one of the two open.
    match determinant > 1e-9 * ss * cc && yy > 0.0 {
        true => (sy * (sy * cc - cy * sc) + cy * (cy * ss - sy * sc)) / (determinant * yy),
        false => 0.0,
    }
}

/// The rows in which all are numbers, less the mean of each.
fn centred<const N: usize>(columns: [Vec<f64>; N]) -> [Vec<f64>; N] {
    let is_whole = |row: &usize| columns.iter().all(|column| column[*row].is_finite());
    let rows: Vec<usize> = (0..columns[0].len()).filter(is_whole).collect();
    columns.each_ref().map(|column| {
        let mean = rows.iter().map(|row| column[*row]).sum::<f64>() / rows.len() as f64;
        rows.iter().map(|row| column[*row] - mean).collect()
    })
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The role of a column that shows it without the others.
fn by_itself(column: &Column, columns: &[Column]) -> Option<RoleWord> {
    let numbers = match &column.data {
        Data::Labels(labels) => return Some(of_labels(column, labels)),
        Data::Numbers(numbers) => numbers,
    };
    let known: Vec<f64> = numbers.iter().copied().filter(|x| x.is_finite()).collect();
    if known.is_empty() {
        return Some(RoleWord::Ignore);
    }
    if is_clock(column) {
        // Of several runs one after the other it is told by none.
        return Some(match known.is_sorted() {
            true => RoleWord::Time,
            false => RoleWord::Ignore,
        });
    }
    // Something else is set: what counts along is the number of the row, whatever its name. The number of a run is none
    // of what is set, nor is what stays.
    let is_varied =
        |other: &Column| is_set(other) && !is_constant(other) && by_name(other).is_none();
    if counts(column) && columns.iter().any(is_varied) {
        return Some(RoleWord::Order);
    }
    let is_numbering = column.unit.is_none() && known.iter().all(|x| x.fract() == 0.0);
    if let Some(role) = by_name(column).filter(|_| is_numbering) {
        let rises = known.is_sorted_by(|a, b| a < b);
        return Some(match role {
            RoleWord::Order if !rises => RoleWord::Ignore,
            role => role,
        });
    }
    if is_scatter(column, columns) {
        return Some(RoleWord::Ignore);
    }
    if is_numbering && numbers_repeats(&known, column, columns) {
        return Some(RoleWord::Run);
    }
    (is_constant(column) && known.len() > 1).then_some(RoleWord::Covariate)
}

/// Whether it counts how often something was gone through: it rises by one, and another column has the same values in each of its
/// stretches.
fn numbers_repeats(known: &[f64], column: &Column, columns: &[Column]) -> bool {
    let stretches: Vec<std::ops::Range<usize>> = known
        .chunk_by(|a, b| a == b)
        .scan(0, |end, stretch| {
            let begin = *end;
            *end += stretch.len();
            Some(begin..*end)
        })
        .collect();
    let counts = stretches
        .windows(2)
        .all(|pair| known[pair[1].start] == known[pair[0].start] + 1.0);
    let comes_back = |other: &Column| {
        let values = |rows: &std::ops::Range<usize>| -> BTreeSet<u64> {
            match &other.data {
                Data::Numbers(numbers) => {
                    numbers[rows.clone()].iter().map(|x| x.to_bits()).collect()
                }
                Data::Labels(labels) => labels.of_row[rows.clone()]
                    .iter()
                    .map(|x| u64::from(*x))
                    .collect(),
            }
        };
        let first = values(&stretches[0]);
        first.len() > 1 && stretches.iter().all(|rows| values(rows) == first)
    };
    let whole = match &column.data {
        Data::Numbers(numbers) => numbers.len() == known.len(),
        Data::Labels(_) => false,
    };
    whole && stretches.len() > 1 && counts && columns.iter().any(comes_back)
}

/// Whether all its numbers are one.
fn is_constant(column: &Column) -> bool {
    let Data::Numbers(numbers) = &column.data else {
        return false;
    };
    let mut known = numbers.iter().filter(|x| x.is_finite());
    let first = known.next();
    known.all(|x| Some(x) == first)
}

/// Whether it is a standard deviation, or the u of another column: `u_T` beside `T`, `u` beside what is in its unit, while `U_ref`
/// is a voltage.
fn is_scatter(column: &Column, columns: &[Column]) -> bool {
    let name = column.name.to_lowercase();
    let named = [
        "sd",
        "std",
        "stdev",
        "uncertainty",
        "标准差",
        "标准偏差",
        "不确定度",
    ];
    let is_like = |other: &Column| other.name != column.name && other.unit == column.unit;
    if column.name == "u" && column.unit.is_some() && columns.iter().any(is_like) {
        return true;
    }
    let of = column
        .name
        .strip_prefix("u_")
        .or_else(|| column.name.strip_prefix("s_"));
    named.iter().any(|start| name.starts_with(start))
        || of.is_some_and(|of| columns.iter().any(|other| other.name == of))
}

/// What is numbered or labelled, by its name.
fn by_name(column: &Column) -> Option<RoleWord> {
    let name = column.name.to_lowercase();
    let known = match name.as_str() {
        "position" | "pos" | "pose" | "point" | "位置" | "测点" | "点号" => {
            RoleWord::Position
        }
        "direction" | "dir" | "方向" | "行程" => RoleWord::Direction,
        "axis" | "轴" => RoleWord::Axis,
        "run" | "series" | "mount" | "cycle" | "repeat" | "rep" | "replicate" | "运行" | "序列"
        | "循环" | "循环次数" | "次数" | "测量次数" | "组" | "组号" | "轮次" => {
            RoleWord::Run
        }
        "unit" | "instrument" | "operator" | "device" | "lot" | "lab" | "probe" | "serial"
        | "serial no" | "s/n" | "sn" | "仪器" | "人员" | "操作者" | "出厂编号" => {
            RoleWord::Factor
        }
        "no" | "no." | "nr" | "nr." | "index" | "row" | "序号" | "编号" => RoleWord::Order,
        "n" | "n_samples" | "samples" => RoleWord::Ignore,
        _ => return None,
    };
    Some(known)
}

fn of_labels(column: &Column, labels: &Labels) -> RoleWord {
    if labels.levels.iter().all(String::is_empty) {
        return RoleWord::Ignore;
    }
    let times = labels.levels.iter().filter(|text| !text.is_empty());
    if times.clone().count() > 1 && times.clone().all(|text| csv::time(text).is_some()) {
        let of_rows = labels
            .of_row
            .iter()
            .map(|level| &labels.levels[*level as usize]);
        return match of_rows.filter_map(|text| csv::time(text)).is_sorted() {
            true => RoleWord::Time,
            false => RoleWord::Ignore,
        };
    }
    if labels.levels.len() == labels.of_row.len() {
        return RoleWord::Ignore;
    }
    // What numbers the rows has another value in each.
    if let Some(role) = by_name(column).filter(|role| *role != RoleWord::Order) {
        return role;
    }
    if labels.levels.iter().all(|label| is_way(label)) {
        return RoleWord::Direction;
    }
    // One word throughout tells no rows apart.
    if labels.levels.len() == 1 {
        return RoleWord::Ignore;
    }
    // What was repeated as a whole comes once each.
    match stretches(&labels.of_row) == labels.levels.len() {
        true => RoleWord::Run,
        false => RoleWord::Factor,
    }
}

/// Whether a label says from where a point was reached.
fn is_way(label: &str) -> bool {
    const WAYS: [&str; 20] = [
        "up",
        "down",
        "increasing",
        "decreasing",
        "rising",
        "falling",
        "loading",
        "unloading",
        "cw",
        "ccw",
        "升",
        "降",
        "升压",
        "降压",
        "升温",
        "降温",
        "进程",
        "回程",
        "加载",
        "卸载",
    ];
    WAYS.contains(&label.to_lowercase().as_str())
}

/// Whether it says when, by its name and by its unit where it has one: a period is in seconds, too.
fn is_clock(column: &Column) -> bool {
    let name = column.name.to_lowercase();
    let is_named = name == "t"
        || ["t_", "time", "when", "时间", "时刻"]
            .iter()
            .any(|start| name.starts_with(start));
    // A unit that stands for the name.
    const UNITS: [&str; 12] = [
        "sec", "seconds", "min", "minutes", "hours", "days", "weeks", "years", "秒", "分钟",
        "小时", "天数",
    ];
    let is_unit = UNITS.contains(&name.as_str());
    let second = UnitTable::default().parse("s");
    let (Some(unit), Ok(second)) = (&column.unit, second) else {
        return is_named || is_unit;
    };
    is_named && unit.conversion_to(&second).is_some()
}

/// Whether its numbers come back: each at least twice, on average.
fn is_set(column: &Column) -> bool {
    let Data::Numbers(numbers) = &column.data else {
        return false;
    };
    let different: BTreeSet<u64> = numbers.iter().map(|x| x.to_bits()).collect();
    2 * different.len() <= numbers.len()
}

/// Whether it is called what was to be set, which nothing reads.
fn is_nominal(column: &Column) -> bool {
    const WORDS: [&str; 8] = [
        "setpoint",
        "set point",
        "set_point",
        "nominal",
        "target",
        "sollwert",
        "设定",
        "标称",
    ];
    let name = column.name.to_lowercase();
    WORDS.iter().any(|word| name.contains(word))
}

/// Whether it is a condition by its unit, name or numbers: a temperature, a pressure, a humidity; the air of an inhabited place.
fn is_condition(column: &Column) -> bool {
    const WORDS: [&str; 8] = [
        "temp", "press", "humid", "supply", "温度", "气压", "压力", "湿度",
    ];
    /// Pressures of the air in Pa, from a town at 4 000 m to the highest at sea level.
    const AIR: std::ops::RangeInclusive<f64> = 6.0e4..=1.085e5;
    let units = UnitTable::default();
    let name = column.name.to_lowercase();
    let factor = |unit: &str| {
        let own = column.unit.as_ref()?.difference();
        Some(own.conversion_to(&units.parse(unit).ok()?)?.factor)
    };
    let is_air = || match (&column.data, factor("Pa")) {
        (Data::Numbers(numbers), Some(factor)) => {
            numbers.iter().all(|p| AIR.contains(&(p * factor)))
        }
        _ => false,
    };
    let is_named = WORDS.iter().any(|word| name.contains(word));
    // Relative humidity by its symbol, perhaps with a place: "RH", "rh_lab".
    let is_humidity = name.split(|c: char| !c.is_alphanumeric()).next() == Some("rh");
    is_named || is_humidity || factor("K").is_some() || is_air()
}

/// Whether two columns are the same but for their axis, as `ax` and `ay`.
pub(super) fn is_kin(one: &Column, other: &Column) -> bool {
    let stem = |column: &Column| -> String {
        let is_axis = |c: char| matches!(c, 'x' | 'y' | 'z' | 'X' | 'Y' | 'Z') || c.is_numeric();
        column.name.chars().filter(|c| !is_axis(*c)).collect()
    };
    one.unit == other.unit && !stem(one).is_empty() && stem(one) == stem(other)
}

/// How many stretches of equal values there are.
pub(super) fn stretches<T: PartialEq>(values: &[T]) -> usize {
    let changes = values
        .iter()
        .zip(values.iter().skip(1))
        .filter(|(a, b)| a != b);
    changes.count() + usize::from(!values.is_empty())
}
