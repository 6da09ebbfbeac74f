//! What stays in the laboratory while the sensor turns: the rotation of the Earth, a magnetic field, and
//! the axis of a table that leans.
//!
//! The case has three columns with the direction of the axis of turning in the sensor (components of a unit
//! vector, one for each output) and the angle of turning. How a mount is turned about the axis is not
//! recorded: across the axis a field has two unknown components in each mount.

use super::angles::{angles, radians};
use super::building::{on_output, plain};
use super::fitted::{FittedModel, varies};
use super::modifiers::{flag, largest, map2};
use super::{Cell, EffectId, Modifier, Term, Variation, tied};
use crate::diagnose::case::Role;

type Vector = nalgebra::Vector3<f64>;

/// What a field along the axis follows.
const ALONG: &str = "component along the axis";

/// Cells of sensors that turn about directions of their own.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let Some(directions) = directions(fitted) else {
        return Vec::new();
    };
    angles(fitted)
        .into_iter()
        .filter(|angle| !fitted.in_model(*angle))
        .flat_map(|angle| Turning::new(fitted, directions, angle).cells())
        .collect()
}

/// Three columns that are a unit vector in every row, for three outputs.
fn directions(fitted: &FittedModel<'_>) -> Option<[usize; 3]> {
    if fitted.case().responses.len() != 3 {
        return None;
    }
    let candidates: Vec<usize> = fitted
        .numeric()
        .into_iter()
        .filter(|c| fitted.case().columns[*c].role == Role::Stimulus)
        .collect();
    let is_unit = |triple: &[usize]| {
        (0..fitted.rows()).all(|row| {
            let squares = triple.iter().map(|c| fitted.numbers(*c)[row].powi(2));
            (squares.sum::<f64>() - 1.0).abs() < 1e-3
        })
    };
    let triple = candidates.windows(3).find(|triple| is_unit(triple))?;
    Some([triple[0], triple[1], triple[2]])
}

struct Turning<'g> {
    fitted: &'g FittedModel<'g>,
    angle: usize,
    psi: Vec<f64>,
    /// Direction of the axis in each row.
    axis: Vec<Vector>,
    /// Different directions.
    mounts: Vec<Vector>,
}

impl<'g> Turning<'g> {
    fn new(fitted: &'g FittedModel<'_>, directions: [usize; 3], angle: usize) -> Turning<'g> {
        let axis: Vec<Vector> = (0..fitted.rows())
            .map(|row| directions.map(|c| fitted.numbers(c)[row]).into())
            .collect();
        let mut mounts: Vec<Vector> = Vec::new();
        for direction in &axis {
            if !mounts.iter().any(|mount| same(mount, direction)) {
                mounts.push(*direction);
            }
        }
        Turning {
            fitted,
            angle,
            psi: radians(fitted, angle),
            axis,
            mounts,
        }
    }

    fn cells(&self) -> Vec<Cell> {
        /// A field in more mounts than this has too many components.
        const MOUNTS: usize = 12;
        if self.mounts.len() > MOUNTS {
            return Vec::new();
        }
        let both = [("", 1.0), ("angle counted clockwise", -1.0)];
        let across = both.map(|(label, sense)| {
            // Along the axis, and across it, all outputs sense it alike.
            let along = self.tied(|a, row| self.axis[row][a], ALONG);
            Variation::of(label, [along, self.common(sense, |_| 1.0)].concat())
        });
        let responses = &self.fitted.case().responses;
        let each: Vec<Vec<Term>> = (0..responses.len()).map(|a| self.alone(a)).collect();
        let alone = responses.iter().zip(&each);
        let alone = alone.map(|(one, terms)| Variation::of(&one.name, terms.clone()));
        let all = Variation::of("each with a sensitivity of its own", each.concat());
        let rate = self.rate();
        let leans =
            both.map(|(label, sense)| Variation::of(label, self.common(sense, |row| rate[row])));
        let fields = across.into_iter().chain(alone).chain([all]).collect();
        let (fitted, name) = (self.fitted, self.fitted.label(self.angle));
        vec![
            plain(fitted, EffectId::LaboratoryField, name, fields),
            plain(fitted, EffectId::AxisWobble, name, leans.into()),
        ]
    }

    /// The signals along the axis of turning: the rate of a gyroscope.
    fn rate(&self) -> Vec<f64> {
        let signal = |row: usize| Vector::from_fn(|a, _| self.fitted.signal(a)[row]);
        let axes = self.axis.iter().enumerate();
        axes.map(|(row, axis)| signal(row).dot(axis)).collect()
    }

    /// A field across the axis that all outputs sense alike, times something.
    fn common(&self, sense: f64, times: impl Fn(usize) -> f64) -> Vec<Term> {
        let name = self.fitted.label(self.angle);
        let mut all = Vec::new();
        for (number, mount) in self.mounts.iter().enumerate() {
            let first = perpendicular(mount);
            let second = mount.cross(&first);
            for (part, turned) in [("cos", 0.0), ("sin", -std::f64::consts::FRAC_PI_2)] {
                // Seen from the sensor, what stays in the laboratory turns back.
                let component = |a: usize, row: usize| {
                    if !same(&self.axis[row], mount) {
                        return 0.0;
                    }
                    let angle = sense * self.psi[row] + turned;
                    times(row) * (libm::cos(angle) * first[a] - libm::sin(angle) * second[a])
                };
                let text = format!("{part}({name}) across the axis, mount {}", number + 1);
                all.extend(self.tied(component, &text));
            }
        }
        all
    }

    fn tied(&self, component: impl Fn(usize, usize) -> f64, text: &str) -> Vec<Term> {
        let terms = (0..3).map(|a| {
            let modifier = (0..self.fitted.rows()).map(|row| component(a, row));
            on_output(Modifier::number(modifier.collect(), text)).on(a)
        });
        let terms = terms.filter(|term| largest(&term.modifier.values) > 1e-9);
        tied(terms.collect())
    }

    /// A field that one output senses.
    fn alone(&self, a: usize) -> Vec<Term> {
        let name = self.fitted.label(self.angle);
        let mut terms = Vec::new();
        let own: Vec<f64> = self.axis.iter().map(|axis| axis[a]).collect();
        if varies(&own) {
            terms.push(on_output(Modifier::number(own, ALONG)).on(a));
        }
        for (number, mount) in self.mounts.iter().enumerate() {
            if mount[a].abs() > 0.99 {
                continue;
            }
            let inside = self.axis.iter().map(|axis| flag(same(axis, mount)));
            let inside: Vec<f64> = inside.collect();
            for (part, wave) in [("cos", libm::cos as fn(f64) -> f64), ("sin", libm::sin)] {
                let modifier = map2(&inside, &self.psi, |inside, psi| inside * wave(psi));
                let text = format!("{part}({name}), mount {}", number + 1);
                terms.push(on_output(Modifier::number(modifier, text)).on(a));
            }
        }
        terms
    }
}

fn same(x: &Vector, z: &Vector) -> bool {
    (x - z).amax() < 1e-3
}

/// A unit vector at right angles to another.
fn perpendicular(axis: &Vector) -> Vector {
    let mut other = Vector::zeros();
    other[axis.iamin()] = 1.0;
    axis.cross(&other).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_frame_of_a_mount_is_at_right_angles() {
        for axis in [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.48, 0.6, 0.64]].map(Vector::from) {
            let first = perpendicular(&axis);
            let second = axis.cross(&first);
            assert!(axis.dot(&first).abs() < 1e-12 && axis.dot(&second).abs() < 1e-12);
            assert!((first.norm() - 1.0).abs() < 1e-12 && (second.norm() - 1.0).abs() < 1e-12);
        }
    }
}
