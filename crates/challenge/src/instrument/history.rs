//! Forms that remember where they came from, on a fine grid of moments.

use rand::RngExt;

use crate::random::Random;

/// What follows a drive behind a time constant, exactly for a drive that stands between the moments; it starts relaxed.
pub(super) fn lagged(drive: &[f64], hours: &[f64], lag: f64) -> Vec<f64> {
    let mut value = drive.first().copied().unwrap_or(0.0);
    let mut last = hours.first().copied().unwrap_or(0.0);
    let step = |(x, hour): (&f64, &f64)| {
        value += (x - value) * -libm::expm1(-(hour - last) / lag);
        last = *hour;
        value
    };
    drive.iter().zip(hours).map(step).collect()
}

/// What is lacking of a drive that is reached behind several time constants with shares of their own.
pub(super) fn lacking(drive: &[f64], hours: &[f64], parts: &[(f64, f64)]) -> Vec<f64> {
    let mut sum = vec![0.0; drive.len()];
    for (share, lag) in parts {
        for ((sum, now), x) in sum.iter_mut().zip(lagged(drive, hours, *lag)).zip(drive) {
            *sum += share * (now - x);
        }
    }
    sum
}

/// The play operator: stays until pushed. What it lags behind the drive.
pub(super) fn play(drive: &[f64], half_width: f64) -> Vec<f64> {
    let mut state = drive.first().copied().unwrap_or(0.0);
    let follow = |x: &f64| {
        state = state.max(x - half_width).min(x + half_width);
        state - x
    };
    drive.iter().map(follow).collect()
}

/// Prandtl and Ishlinskii: plays of growing width in parallel.
pub(super) fn plays(drive: &[f64], widest: f64) -> Vec<f64> {
    const LOOPS: usize = 6;
    let mut sum = vec![0.0; drive.len()];
    for k in 1..=LOOPS {
        for (sum, x) in sum
            .iter_mut()
            .zip(play(drive, widest * k as f64 / LOOPS as f64))
        {
            *sum += x / LOOPS as f64;
        }
    }
    sum
}

/// Preisach: relays that switch up and down at places of their own. The mean of their states.
pub(super) fn relays(drive: &[f64], random: &mut Random) -> Vec<f64> {
    const RELAYS: usize = 60;
    let (low, high) = drive
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
            (l.min(*x), h.max(*x))
        });
    let mut sum = vec![0.0; drive.len()];
    for _ in 0..RELAYS {
        let middle = random.random_range(low..high);
        let half = 0.35 * (high - low) * random.random::<f64>();
        let mut state = -1.0;
        for (sum, x) in sum.iter_mut().zip(drive) {
            if *x > middle + half {
                state = 1.0;
            } else if *x < middle - half {
                state = -1.0;
            }
            *sum += state / RELAYS as f64;
        }
    }
    sum
}

/// Bouc and Wen: dz = dx·(1 − |z|·(β sign(dx z) + γ)), over a reach of the drive.
pub(super) fn bouc_wen(drive: &[f64], reach: f64) -> Vec<f64> {
    let mut z = 0.0_f64;
    let mut last = drive.first().copied().unwrap_or(0.0);
    let step = |x: &f64| {
        // Small steps, since a stimulus may jump.
        let parts = 20;
        let dx = (x - last) / reach / f64::from(parts);
        for _ in 0..parts {
            z += dx - dx.abs() * z.abs() * 0.5 * z.signum() - 0.5 * dx * z.abs();
        }
        last = *x;
        z
    };
    drive.iter().map(step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Stream, source};

    #[test]
    fn a_step_is_followed_exponentially() {
        let hours: Vec<f64> = (0..50).map(|k| f64::from(k) * 0.1).collect();
        let drive: Vec<f64> = (0..50).map(|k| if k == 0 { 0.0 } else { 1.0 }).collect();
        let out = lagged(&drive, &hours, 0.7);
        assert!((out[20] - (1.0 - libm::exp(-2.0 / 0.7))).abs() < 1e-12);
    }

    #[test]
    fn loops_differ_between_the_ways_up_and_down() {
        let up = (0..=40).map(|k| f64::from(k) / 40.0);
        let drive: Vec<f64> = up.clone().chain(up.rev()).collect();
        let random = &mut source(1, Stream::Effect, 0);
        for series in [
            play(&drive, 0.1),
            plays(&drive, 0.3),
            relays(&drive, random),
            bouc_wen(&drive, 0.4),
        ] {
            let (up, down) = (series[20], series[61]);
            assert!((up - down).abs() > 0.02, "{up} {down}");
        }
    }
}
