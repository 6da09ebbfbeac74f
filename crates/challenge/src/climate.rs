//! The room: an air conditioner that never quite holds, walls that follow slowly, the fixture between
//! them, and the quantities that a laboratory records because it always has.

use std::f64::consts::TAU;

use rand::RngExt;

use super::noise::{Relaxation, Wander};
use super::random::{Random, Stream, log_between, sign, source};
use super::schedule::FURTHER;
use super::world::{Shown, Surroundings};

/// A slow wave of the room: amplitude, period in seconds, phase.
#[derive(Debug, Clone, Copy)]
struct Wave {
    amplitude: f64,
    period: f64,
    phase: f64,
}

fn wander(scatter: f64, memory: f64, random: &mut Random) -> Wander {
    Wander::new(Relaxation { scatter, memory }, random)
}

/// Vibration of the motor in a run, between these, multiples of g.
const MOTOR: [f64; 2] = [0.02, 0.06];

/// Thermal network of two masses: the room warms the fixture, the fixture the thermometer's bulb.
#[derive(Debug)]
pub(super) struct Climate {
    random: Random,
    waves: Vec<Wave>,
    ramp: f64,
    air: Wander,
    fixture: f64,
    bulb: f64,
    fixture_lag: f64,
    bulb_lag: f64,
    moisture: Wander,
    weather: Wander,
    pressure_trend: f64,
    supply: Wander,
    supply_step: (f64, f64),
    traffic: Wander,
    motor: Vec<f64>,
    time: f64,
    run: usize,
}

impl Climate {
    /// The climate of a campaign of so many seconds and runs.
    pub(super) fn new(seed: u64, campaign: u64, duration: f64, runs: usize) -> Climate {
        let mut random = source(seed, Stream::Climate, campaign);
        let r = &mut random;
        // Two or three waves between a fifth of the campaign and all of it: the temperature moves
        // within a run, and not only monotonically.
        let waves: Vec<Wave> = (0..3)
            .map(|k| Wave {
                amplitude: r.random_range(0.3..1.2) / (1.0 + f64::from(k) / 2.0),
                period: duration * r.random_range(0.18..0.9),
                phase: r.random_range(0.0..TAU),
            })
            .collect();
        let ramp = r.random_range(-0.8..0.8) / duration;
        let air = wander(0.15, 900.0, r);
        let moisture = wander(1.5, 3000.0, r);
        let weather = wander(0.4, 5000.0, r);
        let pressure_trend = r.random_range(-2.0..2.0) / duration;
        let supply = wander(0.02, 1200.0, r);
        let supply_step = (duration * r.random_range(0.2..0.8), 0.03 * sign(r));
        let traffic = wander(0.25, 600.0, r);
        let motor = (0..runs)
            .map(|_| log_between(r, MOTOR[0], MOTOR[1]))
            .collect();
        // Fixture and thermometer are those of the device: a fresh campaign finds them as they were.
        let mut masses = source(seed, Stream::Fixture, 0);
        let fixture_lag = masses.random_range(200.0..500.0);
        let bulb_lag = masses.random_range(60.0..300.0);
        let start: f64 = waves.iter().map(|w| w.amplitude * libm::sin(w.phase)).sum();
        Climate {
            waves,
            ramp,
            air,
            fixture: start,
            bulb: start,
            fixture_lag,
            bulb_lag,
            moisture,
            weather,
            pressure_trend,
            supply,
            supply_step,
            traffic,
            motor,
            time: 0.0,
            run: 0,
            random,
        }
    }

    /// Provides for as many runs again, in a further measurement.
    pub(super) fn go_on(&mut self, seed: u64, runs: usize) {
        let mut random = source(seed, Stream::Climate, FURTHER);
        let motor = (0..runs).map(|_| log_between(&mut random, MOTOR[0], MOTOR[1]));
        self.motor.extend(motor);
    }

    /// Lets `dt` seconds pass.
    pub(super) fn advance(&mut self, dt: f64, run: usize) {
        self.run = run;
        for wander in [
            &mut self.air,
            &mut self.moisture,
            &mut self.weather,
            &mut self.supply,
            &mut self.traffic,
        ] {
            wander.advance(dt, &mut self.random);
        }
        self.time += dt;
        let wave = |w: &Wave| w.amplitude * libm::sin(TAU * self.time / w.period + w.phase);
        let room: f64 =
            self.waves.iter().map(wave).sum::<f64>() + self.ramp * self.time + self.air.value;
        self.fixture += (room - self.fixture) * -libm::expm1(-dt / self.fixture_lag);
        self.bulb += (self.fixture - self.bulb) * -libm::expm1(-dt / self.bulb_lag);
    }

    /// The surroundings as they are.
    pub(super) fn around(&self) -> Surroundings {
        Surroundings {
            time: self.time,
            run: self.run,
            fixture: self.fixture,
            supply: self.supply_now(),
            vibration: self.vibration(),
        }
    }

    /// What the instruments show now, without their own noise.
    pub(super) fn shown(&self) -> Shown {
        Shown {
            temperature: 23.0 + self.bulb,
            // Warm air is drier: humidity follows the temperature, and the weather.
            humidity: 45.0 - 2.0 * self.bulb + self.moisture.value,
            pressure: 1009.0 + self.pressure_trend * self.time + self.weather.value,
            supply: 15.0 + self.supply_now(),
            vibration: self.vibration(),
        }
    }

    fn supply_now(&self) -> f64 {
        let (moment, step) = self.supply_step;
        self.supply.value + if self.time > moment { step } else { 0.0 }
    }

    /// The motor's share differs from run to run, traffic outside modulates it.
    fn vibration(&self) -> f64 {
        let motor = self.motor.get(self.run).copied().unwrap_or(0.03);
        motor * libm::exp(self.traffic.value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_thermometer_follows_the_fixture() {
        let mut climate = Climate::new(3, 0, 8000.0, 3);
        climate.waves.clear();
        climate.ramp = 0.0;
        let law = Relaxation {
            scatter: 0.0,
            memory: 1e12,
        };
        climate.air = Wander { law, value: 2.0 };
        climate.fixture = 0.0;
        climate.bulb = 0.0;
        let lag = climate.fixture_lag;
        for _ in 0..200 {
            climate.advance(lag / 200.0, 0);
        }
        // One time constant: 1 − 1/e of a step of 2 °C, within the error of the time step.
        assert!((climate.around().fixture - 2.0 * (1.0 - (-1.0_f64).exp())).abs() < 0.01);
        assert!(climate.bulb < climate.fixture);
        for _ in 0..4000 {
            climate.advance(2.0, 0);
        }
        assert!((climate.shown().temperature - 25.0).abs() < 1e-3);
    }

    #[test]
    fn a_fresh_campaign_has_the_same_fixture_and_other_weather() {
        let [first, fresh] = [0, 1].map(|campaign| Climate::new(3, campaign, 8000.0, 3));
        let lags = |climate: &Climate| [climate.fixture_lag, climate.bulb_lag];
        assert_eq!(lags(&first), lags(&fresh));
        assert_ne!(first.ramp, fresh.ramp);
    }

    #[test]
    fn temperature_moves_within_a_campaign() {
        for seed in 0..20 {
            let mut climate = Climate::new(seed, 0, 6000.0, 3);
            let mut range = [f64::INFINITY, f64::NEG_INFINITY];
            for _ in 0..3000 {
                climate.advance(2.0, 0);
                let t = climate.around().fixture;
                range = [range[0].min(t), range[1].max(t)];
            }
            assert!(range[1] - range[0] > 0.3, "seed {seed}: {range:?}");
        }
    }
}
