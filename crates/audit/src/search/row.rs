//! Slips that the figures of a row show.

use crate::calculate::{Case, Line};
use crate::claim::Row;
use crate::printed::Printed;
use crate::slips::{Act, Change, Group};

/// What the figures of a row say.
#[derive(Debug, Clone)]
pub struct Options {
    /// The smallest sets of slips that give them: the empty one where the row is right.
    pub sets: Vec<Vec<Act>>,
    /// Further slips that they leave room for.
    room: Vec<(&'static str, Change)>,
    /// The printed contribution.
    pub contribution: Option<f64>,
    /// The figure that nothing explains.
    pub broken: Option<Broken>,
}

/// A figure of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Broken {
    /// Standard uncertainty.
    U,
    /// Sensitivity coefficient.
    C,
    /// Contribution.
    Contribution,
    /// Degrees of freedom.
    Dof,
}

impl Options {
    /// Whether a slip may act here without any printed figure that denies it.
    pub fn leaves_room_for(&self, act: &Act) -> bool {
        self.room
            .iter()
            .any(|(id, change)| *id == act.slip.id && *change == act.change)
    }
}

/// Degrees of freedom from here on are as good as infinitely many: spreadsheets write `1E+99`.
const AS_INFINITE: f64 = 1e5;

/// Slips of one row.
pub fn options(case: &Case<'_>, i: usize, acts: &[Act]) -> Options {
    let row = &case.claimed.rows[i];
    let own: Vec<Act> = acts
        .iter()
        .filter(|act| act.row == Some(i))
        .copied()
        .collect();
    let right = case.right.lines[i];
    let fits = |set: &[Act]| {
        mismatch(row, &changed(right, set)).is_none()
            && set.iter().all(|act| is_supported(row, act))
    };
    let of = |group: Group| {
        own.iter()
            .filter(move |act| act.group() == group)
            .map(Some)
            .chain([None])
    };
    let mut sets: Vec<Vec<Act>> = Vec::new();
    if fits(&[]) {
        sets.push(Vec::new());
    } else {
        for u in of(Group::U) {
            for c in of(Group::C) {
                for (dof, typed) in of(Group::Dof)
                    .flat_map(|dof| of(Group::Contribution).map(move |typed| (dof, typed)))
                {
                    let set: Vec<Act> = [u, c, dof, typed].into_iter().flatten().copied().collect();
                    if !set.is_empty() && fits(&set) {
                        sets.push(set);
                    }
                }
            }
        }
        let fewest = sets.iter().map(Vec::len).min().unwrap_or(0);
        sets.retain(|set| set.len() == fewest);
        sets.sort_by_key(|set| set.iter().map(|act| surprise(case, act)).sum::<u32>());
    }
    let base = sets.first().cloned().unwrap_or_default();
    let broken = sets.is_empty().then(|| mismatch(row, &right)).flatten();
    let room = own.iter().filter(|act| {
        let set: Vec<Act> = base
            .iter()
            .filter(|other| act.goes_with(other))
            .copied()
            .chain([**act])
            .collect();
        broken.is_none() && set.len() == base.len() + 1 && fits(&set)
            || matches!(act.change, Change::Counted(_))
            // The column of coefficients says what they are, not that they were used.
            || broken.is_none() && row.contribution.is_none() && act.group() == Group::C
    });
    let contribution = row.contribution.as_ref().map(|c| c.value.abs());
    Options {
        room: room.map(|act| (act.slip.id, act.change)).collect(),
        contribution,
        broken,
        sets,
    }
}

fn changed(mut line: Line, set: &[Act]) -> Line {
    for act in set {
        match act.change {
            Change::U(u) => line.u = u,
            Change::Scaled(factor) => line.u *= factor,
            Change::C(c) => line.c = c,
            Change::Dof(dof) => line.dof = dof,
            Change::Counted(counted) => line.counted = counted,
            Change::Typed(contribution) => line.typed = Some(contribution),
            _ => {}
        }
    }
    line
}

/// The first figure of a row that a line does not give.
fn mismatch(row: &Row, line: &Line) -> Option<Broken> {
    let slack = row
        .divisor
        .as_ref()
        .map_or(0.0, |d| d.relative_half().min(0.01));
    let near = |figure: &Printed, x: f64, slack: f64| {
        figure.is_met_within(
            x.abs(),
            figure.half_of_digits() + slack * figure.value.abs(),
        )
    };
    let counted = row.not_counted.is_none();
    if let Some(u) = row.u.as_ref().filter(|u| counted || u.value != 0.0) {
        // What the laboratory computed from its rounded ± and divisor.
        let by_columns = row
            .used
            .as_ref()
            .zip(row.divisor.as_ref())
            .map(|(used, divisor)| used.value / divisor.value);
        let rounded = row.used.as_ref().map_or(0.0, Printed::relative_half);
        let by_columns = by_columns.filter(|x| {
            near(u, *x, 0.0) && (x - line.u).abs() <= (slack + rounded.min(0.02)) * line.u
        });
        if !near(u, line.u, slack) && by_columns.is_none() {
            return Some(Broken::U);
        }
    }
    // The derivative is exact; sheets round theirs.
    let sensitivity = |c: &Printed| {
        Printed {
            value: c.value.abs(),
            ..c.clone()
        }
        .is_met_within(line.c.abs(), c.half + 1e-3 * line.c.abs())
    };
    if row.c.as_ref().is_some_and(|c| !sensitivity(c)) {
        return Some(Broken::C);
    }
    if let Some(contribution) = row
        .contribution
        .as_ref()
        .filter(|c| counted || c.value != 0.0)
    {
        let contribution = Printed {
            value: contribution.value.abs(),
            ..contribution.clone()
        };
        let c = row.c.as_ref().map_or(line.c, |c| c.value);
        let by_columns = row
            .u
            .as_ref()
            .map(|u| c * u.value * line.to_y)
            .filter(|_| line.typed.is_none());
        // A coefficient is shown with fewer digits than it was multiplied with.
        let shown = row.c.as_ref().map_or(0.0, Printed::coarseness);
        let met = near(&contribution, line.contribution(), slack + shown)
            || by_columns.is_some_and(|x| near(&contribution, x, shown));
        if !met {
            return Some(Broken::Contribution);
        }
    }
    let dof = row.dof.as_ref().filter(|_| counted);
    let freedom = |dof: &Printed| {
        dof.value >= AS_INFINITE && line.dof >= AS_INFINITE || dof.is_met_by(line.dof)
    };
    dof.is_some_and(|dof| !freedom(dof)).then_some(Broken::Dof)
}

/// Whether the ± column denies a slip: what was used is the figure with its digits exchanged, or it is not.
fn is_supported(row: &Row, act: &Act) -> bool {
    let (Some(used), Some(stated)) = (&row.used, row.stated.figure()) else {
        return true;
    };
    let same = used.is_met_by(stated.value) && !used.text.is_empty();
    match (act.slip.id, act.change) {
        ("input-transposed", Change::Scaled(factor)) => {
            row.u.is_none()
                || used.is_met_by(stated.value * factor)
                || used.is_met_by(stated.value * factor / 2.0)
                || !same
        }
        _ => true,
    }
}

/// How much less usual a slip is than others that give the same figures: a factor of ten counts more than once, what
/// fits anything counts most.
pub fn surprise(case: &Case<'_>, act: &Act) -> u32 {
    let of_kind = match act.slip.id {
        "veff-wrong" | "c-wrong" | "hard-coded" => 6,
        "prefix" | "percent-ppm" | "U-unit" => 4,
        "input-transposed" | "digits-transposed" => 5,
        "range-C" | "intermediates-rounded" => 3,
        "cert-k-2" | "triangle" | "counted-twice" => 2,
        _ => 1,
    };
    of_kind + 2 * u32::from(contradicted(case, act))
}

/// Whether the laboratory's own column of divisors shows another divisor than the slip would have.
fn contradicted(case: &Case<'_>, act: &Act) -> bool {
    let Some(row) = act.row.map(|row| &case.claimed.rows[row]) else {
        return false;
    };
    let (Some(divisor), Some(used), Change::U(u)) = (&row.divisor, &row.used, act.change) else {
        return false;
    };
    let by_columns = used.value / divisor.value;
    (by_columns - u).abs() > 0.02 * u.abs()
}
