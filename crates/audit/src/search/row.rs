//! Slips that the figures of a row show.

use crate::calculate::{Case, Line};
use crate::claim::{RoundingStated, Row, Stated};
use crate::printed::Printed;
use crate::slips::{Act, Change, Group};

use super::chance;
use super::check::Broken;

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
    /// The probability that a figure which has nothing to do with slips would be explained, too.
    pub accident: f64,
}

impl Options {
    /// Whether a slip may act here without any printed figure that denies it.
    pub fn leaves_room_for(&self, act: &Act) -> bool {
        self.room
            .iter()
            .any(|(id, change)| *id == act.slip.id && *change == act.change)
    }
}

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
        let line = changed(right, set);
        mismatch(row, &line).is_none()
            && follows_columns(row, &line)
            && set.iter().all(|act| is_supported(row, act))
    };
    let of = |group: Group| {
        own.iter()
            .filter(move |act| act.group() == group)
            .map(Some)
            .chain([None])
    };
    let mut sets: Vec<Vec<Act>> = Vec::new();
    let unknown = row.is_absent && (row.stated == Stated::Nothing || case.unknown_slopes[i]);
    if unknown {
        // Nothing is known of it but that the model has it.
        let is_missing = |act: &&Act| matches!(act.change, Change::Counted(_));
        sets.push(own.iter().filter(is_missing).copied().collect());
    } else if fits(&[]) {
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
    let broken = sets.is_empty().then(|| mismatch(row, &right)).flatten();
    if sets.is_empty() && broken.is_none() {
        // The printed figures follow, and nothing known makes what the divisor says of them.
        sets.push(Vec::new());
    }
    let base = sets.first().cloned().unwrap_or_default();
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
    // Where the sheet has no contributions, u is what was summed, times the coefficient that it states.
    let summed = || {
        let c = row.c.as_ref().map_or(right.c, |c| c.value);
        let follows = (c.abs() - right.c.abs()).abs() <= 0.01 * right.c.abs();
        let stated = row.c.is_some() || (right.c * right.to_y).abs() == 1.0;
        let u = row.u.as_ref().filter(|_| stated && follows)?;
        Some((c * right.to_y * u.value).abs())
    };
    let contribution = row.contribution.as_ref().map(|c| c.value.abs());
    let contribution = contribution.or_else(summed);
    let explained = sets.first().is_some_and(|set| !set.is_empty());
    let is_old = [&row.u, &row.contribution].into_iter().flatten();
    // A formula that gives another figure than its cell holds is no accident.
    let is_shown = is_old
        .into_iter()
        .any(|figure| case.claimed.is_stale(figure));
    let accident = if explained && !is_shown {
        accident(row, right, &own)
    } else {
        0.0
    };
    Options {
        accident,
        room: room.map(|act| (act.slip.id, act.change)).collect(),
        contribution,
        broken,
        sets,
    }
}

/// The probability that the first figure of a row that departs would be explained if it had nothing to do with slips.
/// Where the ± and the divisor of the laboratory give the same figure, or where it is the ± itself, it has.
fn accident(row: &Row, right: Line, own: &[Act]) -> f64 {
    let worked = row.used.as_ref().zip(row.divisor.as_ref());
    let worked = worked.map(|(used, divisor)| used.value / divisor.value);
    let lines = |group: Group| {
        let acts = own.iter().filter(move |act| act.group() == group);
        acts.map(|act| changed(right, &[*act]))
    };
    let slack = |figure: &Printed| figure.half_of_digits() + 0.01 * figure.value;
    // A nought is no coarse figure.
    let is_nothing = |figure: &Option<Printed>| figure.as_ref().is_some_and(|f| f.value == 0.0);
    if is_nothing(&row.u) || is_nothing(&row.contribution) {
        return 0.0;
    }
    match (mismatch(row, &right), &row.u, &row.contribution) {
        (Some(Broken::U), Some(u), _) => {
            let is_worked = worked.is_some_and(|x| u.is_met_within(x, slack(u)));
            if is_worked || row.used.as_ref().is_some_and(|used| is_copied(used, u)) {
                return 0.0;
            }
            chance::of_row(u, lines(Group::U).map(|line| line.u))
        }
        (Some(Broken::Contribution), _, Some(figure)) => {
            let figure = positive(figure);
            let c = row.c.as_ref().map_or(right.c, |c| c.value) * right.to_y;
            if row.u.is_none()
                && worked.is_some_and(|x| figure.is_met_within((c * x).abs(), slack(&figure)))
            {
                return 0.0;
            }
            let all = lines(Group::U).chain(lines(Group::C));
            let all = all.chain(lines(Group::Contribution));
            chance::of_row(&figure, all.map(|line| line.contribution().abs()))
        }
        _ => 0.0,
    }
}

fn changed(mut line: Line, set: &[Act]) -> Line {
    for act in set {
        act.change.apply(&mut line);
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
        // A bare 0 is nothing at all; 0.00 is what was rounded.
        let half = if figure.value == 0.0 && figure.half >= 0.5 {
            0.0
        } else {
            figure.half_of_digits()
        };
        figure.is_met_within(x.abs(), half + slack * figure.value.abs())
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
        let slack = slack + open_by_readings(row);
        if !near(u, line.u, slack) && by_columns.is_none() {
            return Some(Broken::U);
        }
    }
    // A coefficient of one whole digit is no rounded one: 1 is not 0.5002.
    let open = |c: &Printed| {
        if c.half >= 0.5 && c.digits < 2 {
            0.0
        } else {
            c.half
        }
    };
    // The derivative is exact; sheets round theirs.
    let sensitivity =
        |c: &Printed| positive(c).is_met_within(line.c.abs(), open(c) + 1e-3 * line.c.abs());
    if row.c.as_ref().is_some_and(|c| !sensitivity(c)) {
        return Some(Broken::C);
    }
    if let Some(contribution) = row
        .contribution
        .as_ref()
        .filter(|c| counted || c.value != 0.0)
    {
        let contribution = positive(contribution);
        let c = row.c.as_ref().map_or(line.c, |c| c.value);
        let by_columns = row
            .u
            .as_ref()
            .map(|u| c * u.value * line.to_y)
            .filter(|_| line.typed.is_none());
        // A coefficient is shown with fewer digits than it was multiplied with, and so is a standard uncertainty of which no
        // more is stated.
        let of_u = match &row.stated {
            Stated::Standard { u, .. } => u.openness(),
            _ => open_by_readings(row),
        };
        let shown = of_u + row.c.as_ref().map_or(0.0, Printed::coarseness);
        let met = near(&contribution, line.contribution(), slack + shown)
            || by_columns.is_some_and(|x| near(&contribution, x, shown));
        if !met {
            return Some(Broken::Contribution);
        }
    }
    let dof = row.dof.as_ref().filter(|_| counted);
    let freedom = |dof: &Printed| {
        dof.value.is_infinite() && line.dof.is_infinite() || dof.is_met_by(line.dof)
    };
    dof.is_some_and(|dof| !freedom(dof)).then_some(Broken::Dof)
}

/// Whether the standard uncertainty is the figure that was used.
fn is_copied(used: &Printed, u: &Printed) -> bool {
    used.value == u.value && used.unit == u.unit
}

/// Whether a slip is that the ± of a row was taken as it stands, which is what the row prints.
pub(super) fn is_copy(case: &Case<'_>, act: &Act) -> bool {
    let row = act
        .row
        .map(|i| (&case.claimed.rows[i], case.right.lines[i]));
    row.is_some_and(|(row, right)| {
        let u = row.u.as_ref();
        let copied = u
            .zip(row.used.as_ref())
            .filter(|(u, used)| is_copied(used, u));
        let made = changed(right, &[*act]).u;
        copied.is_some_and(|(u, _)| made != right.u && (made - u.value).abs() <= 1e-9 * made)
    })
}

/// What the digits of a standard deviation or of a range leave open: unlike limits and certificates, readings give more digits
/// than are printed.
fn open_by_readings(row: &Row) -> f64 {
    match &row.stated {
        Stated::Deviation { s: figure, .. } | Stated::Range { range: figure, .. } => {
            figure.coarseness()
        }
        _ => 0.0,
    }
}

/// Whether the ± and the divisor of the laboratory, where they give the figure that it prints, give that of a line, too. Few
/// digits leave room for both: `0.002 / 2` and `0.002 / √3` are printed as `0.001`, and the divisor says which of them it is.
fn follows_columns(row: &Row, line: &Line) -> bool {
    let Some((used, divisor)) = row.used.as_ref().zip(row.divisor.as_ref()) else {
        return true;
    };
    // The ± itself is what u is if nothing was divided: of `0.1`, divisor 2 and `0.1` the digits do not say it, nor deny it.
    if row.u.as_ref().is_some_and(|u| is_copied(used, u)) {
        return true;
    }
    // A percentage of something is in the unit of the row as the part that it is.
    let to_unit = match crate::units::fraction(&used.unit) {
        Some(_) => row.relative_factor(),
        None => 1.0,
    };
    let worked = to_unit * used.value / divisor.value;
    // What is stated is exact where it is the figure that was used, once or as its half.
    let copied = row.stated.figure().is_some_and(|stated| {
        let ratio = stated.value / used.value;
        [0.5, 1.0, 2.0].iter().any(|x| (ratio - x).abs() < 1e-9)
    });
    let of_used = if copied { 0.0 } else { used.relative_half() };
    // A whole number is no rounded root.
    let of_divisor = if divisor.half >= 0.5 {
        0.0
    } else {
        divisor.relative_half()
    };
    let open = of_used + of_divisor + 1e-3;
    let printed = |figure: &Printed, x: f64| figure.is_met_within(x.abs(), figure.half_of_digits());
    let c = row.c.as_ref().map_or(line.c, |c| c.value) * line.to_y;
    let gives = match (&row.u, &row.contribution) {
        (Some(u), _) => printed(u, worked),
        (None, Some(figure)) => printed(&positive(figure), c * worked),
        (None, None) => false,
    };
    !gives || worked == line.u || (worked - line.u).abs() <= open * line.u
}

fn positive(figure: &Printed) -> Printed {
    Printed {
        value: figure.value.abs(),
        ..figure.clone()
    }
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
        // Without a rule for rounding there is none to break.
        "rounded-down" if case.claimed.rounding == RoundingStated::Unstated => 4,
        "input-transposed" | "digits-transposed" => 5,
        "range-C" | "intermediates-rounded" => 3,
        "cert-k-2" | "triangle" | "counted-twice" => 2,
        // Degrees of freedom from here on are not few (rule 39).
        "k2-low-dof" if case.right.figures(&[], None).nu_eff >= 50.0 => 3,
        _ => 1,
    };
    of_kind + unnatural(case, act) + 2 * u32::from(contradicted(case, act))
}

/// What is stated as ± is halved by mistake, what is stated as a width is doubled; the other way round is odd.
fn unnatural(case: &Case<'_>, act: &Act) -> u32 {
    let stated = act.row.map(|row| &case.claimed.rows[row].stated);
    u32::from(matches!(
        (act.slip.id, stated),
        ("full-width", Some(Stated::Limits { .. }))
            | (
                "half-again",
                Some(Stated::FullWidth { .. } | Stated::Step { .. })
            )
    ))
}

/// Whether the laboratory's own columns of ±, divisor and coefficient show other figures than the slip would have.
fn contradicted(case: &Case<'_>, act: &Act) -> bool {
    let Some(row) = act.row else {
        return false;
    };
    let line = changed(case.right.lines[row], &[*act]);
    let row = &case.claimed.rows[row];
    let worked = row.used.as_ref().zip(row.divisor.as_ref());
    let by_columns = worked.map(|(used, divisor)| used.value / divisor.value);
    let apart = |a: f64, b: f64| (a.abs() - b.abs()).abs() > 0.02 * b.abs();
    // What stands as u and is the ± itself denies the divisor beside it.
    let is_copy = is_copy(case, act);
    by_columns.is_some_and(|u| apart(u, line.u) && !is_copy)
        || row.c.as_ref().is_some_and(|c| apart(c.value, line.c))
}
