//! What the device lives through at an instant: where it points, how it turns, how warm it is.
//!
//! Frames: the laboratory has x east, y north, z up. Angles are radians inside the simulator, times
//! seconds, specific force multiples of g, rates degrees per second.

/// Rate of the Earth's rotation, degrees per second (15.041 07 degrees per hour).
pub(super) const EARTH_RATE: f64 = 15.041_07 / 3600.0;
/// Latitude of the laboratory, radians (31.2° N).
pub(super) const LATITUDE: f64 = 31.2 * std::f64::consts::PI / 180.0;
/// Field of the Earth in the laboratory, gauss: east, north, up.
pub(super) const FIELD: Vector = [0.02, 0.33, -0.36];

pub(super) type Vector = [f64; 3];
pub(super) type Matrix = [[f64; 3]; 3];

/// Where the table or head stands and how it turns.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Pose {
    /// Head angle, or azimuth.
    pub outer: f64,
    /// Elevation; zero where there is no second axis.
    pub inner: f64,
    /// Rate of the table about the vertical, degrees per second.
    pub rate: f64,
    /// Table angle.
    pub table: f64,
    /// Which mount: its number, or its angle in eighths of a turn on a dividing head.
    pub mount: usize,
}

/// What the sensor is exposed to in its own frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Input {
    /// Specific force, multiples of g.
    pub force: Vector,
    /// Rate of rotation, degrees per second, without that of the Earth.
    pub rate: Vector,
    /// Rotation from the laboratory to the sensor.
    pub attitude: Matrix,
}

/// Surroundings at an instant, as they are and not as instruments show them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Surroundings {
    /// Seconds since the power was switched on.
    pub time: f64,
    /// Number of the run, from 0.
    pub run: usize,
    /// Temperature of the fixture, °C from 23 °C.
    pub fixture: f64,
    /// Supply voltage from nominal, V.
    pub supply: f64,
    /// Vibration, rms, multiples of g.
    pub vibration: f64,
}

/// Everything that an effect may react to.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct World {
    pub around: Surroundings,
    /// The pose that was commanded.
    pub pose: Pose,
    pub input: Input,
}

pub(super) fn apply(m: &Matrix, v: &Vector) -> Vector {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

pub(super) fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let column = |j: usize| apply(a, &[b[0][j], b[1][j], b[2][j]]);
    let [x, y, z] = [column(0), column(1), column(2)];
    [0, 1, 2].map(|i| [x[i], y[i], z[i]])
}

/// Coordinates in a frame that is turned by an angle about z.
pub(super) fn about_z(angle: f64) -> Matrix {
    let (s, c) = (libm::sin(angle), libm::cos(angle));
    [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]
}

/// Coordinates in a frame that is turned by an angle about y.
pub(super) fn about_y(angle: f64) -> Matrix {
    let (s, c) = (libm::sin(angle), libm::cos(angle));
    [[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]]
}

/// Coordinates in a frame that is turned by an angle about x.
pub(super) fn about_x(angle: f64) -> Matrix {
    let (s, c) = (libm::sin(angle), libm::cos(angle));
    [[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotations_keep_lengths_and_compose() {
        let v = [0.3, -1.2, 2.0];
        let m = product(&about_x(0.4), &product(&about_y(-1.1), &about_z(2.3)));
        let w = apply(&m, &v);
        let length = |v: &Vector| v.iter().map(|x| x * x).sum::<f64>();
        assert!((length(&v) - length(&w)).abs() < 1e-14);
        assert_eq!(
            apply(&about_z(0.2), &apply(&about_z(0.3), &v)).map(|x| (x * 1e12).round()),
            apply(&about_z(0.5), &v).map(|x| (x * 1e12).round())
        );
    }
}

/// What the instruments of the room show, averaged over a row of the recording.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Shown {
    /// Thermometer on the fixture, °C.
    pub temperature: f64,
    /// Relative humidity, %.
    pub humidity: f64,
    /// Barometer, hPa.
    pub pressure: f64,
    /// Voltmeter at the supply, V.
    pub supply: f64,
    /// Vibration monitor, multiples of g, rms.
    pub vibration: f64,
}

/// One row of a recording.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Row {
    /// Mean time of the readings, seconds since power-on.
    pub time: f64,
    pub run: usize,
    pub direction: f64,
    /// The pose as the protocol states it.
    pub pose: Pose,
    pub shown: Shown,
    /// Mean readings of the axes, in units of the input.
    pub output: Vector,
}
