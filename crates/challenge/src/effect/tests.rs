//! Each effect against what it must be in closed form.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::*;
use crate::schedule::{Campaign, plan};
use crate::world::{EARTH_RATE, LATITUDE, Surroundings};

fn part(physics: Physics, size: f64) -> Concealed {
    let shape = Shape {
        gains: [1.0; 3],
        phase: 0.0,
        pace: 0.5,
        moment: 0.5,
    };
    Concealed {
        physics,
        size,
        shape,
    }
}

fn process(rig: Rig, physics: Physics, size: f64) -> Box<dyn Process> {
    let dwells = plan(rig, Campaign::Calibration, 1);
    part(physics, size).process(rig, &dwells)
}

/// The world of a tumble at a head angle.
fn tumble(outer: f64) -> World {
    let pose = Pose {
        outer,
        ..Pose::default()
    };
    World {
        pose,
        input: Rig::Tumble.input(&pose),
        ..World::default()
    }
}

/// The world of the rate table in a mount at a rate and table angle.
fn table(mount: usize, rate: f64, table: f64) -> World {
    let pose = Pose {
        mount,
        rate,
        table,
        ..Pose::default()
    };
    World {
        pose,
        input: Rig::RateTable.input(&pose),
        ..World::default()
    }
}

fn output(process: &dyn Process, world: &World) -> Vector {
    let mut output = [0.0; 3];
    process.output(world, &mut output);
    output
}

fn close(a: f64, b: f64, tolerance: f64) {
    assert!(
        (a - b).abs() <= tolerance,
        "{a} is not {b} within {tolerance}"
    );
}

#[test]
fn curves_have_the_power_that_they_are_named_after() {
    let at = |physics, u: f64| {
        let process = process(Rig::Tumble, physics, 1.0);
        output(process.as_ref(), &tumble(libm::asin(u)))[0]
    };
    close(
        at(Physics::SecondOrder, 0.2) / at(Physics::SecondOrder, 0.1),
        4.0,
        0.02,
    );
    close(
        at(Physics::SecondOrder, -0.2),
        at(Physics::SecondOrder, 0.2),
        1e-12,
    );
    close(
        at(Physics::ThirdOrder, 0.2) / at(Physics::ThirdOrder, 0.1),
        8.0,
        0.02,
    );
    close(at(Physics::ThirdOrder, 0.1), 1e-3, 1e-5);
    close(at(Physics::Asymmetry, -0.9), 0.9, 1e-3);
}

#[test]
fn a_pendulum_swings_by_its_load() {
    let cross = process(Rig::Tumble, Physics::CrossProduct, 1e-3);
    let (s, c) = (0.6_f64, 0.8_f64);
    close(
        output(cross.as_ref(), &tumble(s.asin()))[0],
        1e-3 * s * c,
        1e-6,
    );
}

#[test]
fn saturation_lacks_its_size_at_full_scale() {
    let saturation = process(Rig::RateTable, Physics::Saturation, 1e-3);
    let mut reading = [160.0, -160.0, 16.0];
    saturation.readout(&mut reading);
    close(reading[0] / 160.0, 1.0 - 1e-3, 2e-6);
    close(reading[0], -reading[1], 1e-12);
    close(reading[2] / 16.0, 1.0 - 1e-5, 1e-8);
}

#[test]
fn settling_ends_at_rest_and_begins_with_all_of_it() {
    let mut settling = process(Rig::Tumble, Physics::Settling, 1e-3);
    for _ in 0..10 {
        settling.advance(&tumble(0.0), 4.0);
    }
    let up = tumble(FRAC_PI_2);
    close(output(settling.as_ref(), &up)[0], -1e-3, 1e-9);
    // τ₁ = 40·√7.5 s and τ₂ = 4τ₁, with shares 0.65 and 0.35.
    let (time, quick) = (120.0, 40.0 * 7.5_f64.sqrt());
    for _ in 0..60 {
        settling.advance(&up, 2.0);
    }
    let left = 0.65 * (-time / quick).exp() + 0.35 * (-time / (4.0 * quick)).exp();
    close(output(settling.as_ref(), &up)[0], -1e-3 * left, 1e-9);
    for _ in 0..5000 {
        settling.advance(&up, 4.0);
    }
    close(output(settling.as_ref(), &up)[0], 0.0, 1e-9);
}

#[test]
fn a_head_with_play_lags_by_half_of_it_from_either_side() {
    let mut backlash = process(Rig::Tumble, Physics::Backlash, 1e-4);
    let mut reached = |from: f64, to: f64| {
        for step in 0..=20 {
            backlash.advance(&tumble(from + (to - from) * f64::from(step) / 20.0), 1.0);
        }
        let mut pose = tumble(to).pose;
        backlash.pose(&tumble(to), &mut pose);
        pose.outer - to
    };
    reached(-1.0, 0.0);
    close(reached(0.0, 1.0), -1e-4, 1e-12);
    close(reached(2.0, 1.0), 1e-4, 1e-12);
    // A move within the play moves nothing.
    close(reached(1.0, 1.00005), 1e-4 - 5e-5, 1e-12);
}

#[test]
fn hysteresis_closes_its_loop() {
    let mut hysteresis = process(Rig::Tumble, Physics::Hysteresis, 1.0);
    let mut sweep = |from: f64, to: f64| {
        for step in 0..=50 {
            let u = from + (to - from) * f64::from(step) / 50.0;
            hysteresis.advance(&tumble(libm::asin(u)), 1.0);
        }
        output(hysteresis.as_ref(), &tumble(libm::asin(to)))[0]
    };
    sweep(0.0, 1.0);
    let down = sweep(1.0, 0.0);
    sweep(0.0, -1.0);
    let up = sweep(-1.0, 0.0);
    close(up, -down, 1e-9);
    assert!(up.abs() > 0.1);
}

#[test]
fn a_resistor_that_heats_settles_at_the_cube() {
    let mut load = process(Rig::Tumble, Physics::LoadHeating, 1e-4);
    let world = tumble(libm::asin(0.5));
    for _ in 0..1000 {
        load.advance(&world, 4.0);
    }
    close(output(load.as_ref(), &world)[0], 1e-4 * 0.125, 1e-12);
}

#[test]
fn warm_up_fades_and_temperature_ends_where_the_room_is() {
    let mut warm = process(Rig::Tumble, Physics::WarmUp, 1e-3);
    close(output(warm.as_ref(), &tumble(0.0))[0], -1e-3, 1e-12);
    let mut core = process(Rig::Tumble, Physics::TemperatureBias, 1e-3);
    let mut room = tumble(0.0);
    core.advance(&room, 4.0);
    room.around = Surroundings {
        fixture: 2.0,
        ..room.around
    };
    for _ in 0..10_000 {
        warm.advance(&room, 4.0);
        core.advance(&room, 4.0);
    }
    close(output(warm.as_ref(), &room)[0], 0.0, 1e-8);
    close(output(core.as_ref(), &room)[0], 2e-3, 1e-9);
}

#[test]
fn circles_err_once_and_twice_in_a_turn() {
    let error = |physics, angle: f64| {
        let process = process(Rig::Tumble, physics, 1e-4);
        let mut pose = tumble(angle).pose;
        process.pose(&tumble(angle), &mut pose);
        pose.outer - angle
    };
    for k in 0..8 {
        let angle = TAU * f64::from(k) / 8.0 + 0.1;
        close(
            error(Physics::Eccentricity, angle),
            1e-4 * angle.sin(),
            2e-8,
        );
        close(
            error(Physics::Ellipticity, angle),
            1e-4 * (2.0 * angle).sin(),
            4e-8,
        );
    }
}

#[test]
fn the_earth_turns_by_its_vertical_part_and_averages_its_northern_one_out() {
    let earth = process(Rig::RateTable, Physics::EarthRate, 1.0);
    let mut mean = [0.0; 3];
    for k in 0..12 {
        let world = table(0, 40.0, TAU * f64::from(k) / 12.0);
        let mut input = world.input;
        earth.input(&world, &mut input);
        for (sum, (with, without)) in mean.iter_mut().zip(input.rate.iter().zip(world.input.rate)) {
            *sum += (with - without) / 12.0;
        }
    }
    close(mean[2], EARTH_RATE * LATITUDE.sin(), 1e-12);
    close(mean[0], 0.0, 1e-12);
    close(mean[1], 0.0, 1e-12);
}

#[test]
fn a_leaning_axis_turns_across_once_in_a_turn() {
    let wobble = process(Rig::RateTable, Physics::Wobble, 1e-4);
    let across = |angle: f64| {
        let world = table(0, 100.0, angle);
        let mut input = world.input;
        wobble.input(&world, &mut input);
        input.rate
    };
    close(across(0.0)[0], 1e-2, 1e-9);
    close(across(TAU / 2.0)[0], -1e-2, 1e-9);
    close(across(0.3)[2], 100.0, 1e-5);
}

#[test]
fn swapped_labels_change_the_protocol_and_nothing_else() {
    use crate::simulate::{Readings, Setup, simulate};
    let rig = Rig::Remount;
    let setup = Setup {
        rig,
        seed: 2,
        noise: rig.noise(),
    };
    let run =
        |effects: &[Concealed]| simulate(&setup, Campaign::Calibration, effects, Readings::Real);
    let (with, without) = (run(&[part(Physics::SwappedLabel, 1.0)]), run(&[]));
    let differ = with
        .iter()
        .zip(&without)
        .filter(|(a, b)| a.pose != b.pose)
        .count();
    assert_eq!(differ, 2);
    assert!(with.iter().zip(&without).all(|(a, b)| a.output == b.output));
}

#[test]
fn every_effect_shows_on_every_rig_where_it_occurs_and_is_reproducible() {
    use crate::simulate::{Readings, Setup, simulate};
    for rig in Rig::ALL {
        let setup = Setup {
            rig,
            seed: 3,
            noise: rig.noise(),
        };
        let run = |effects: &[Concealed]| {
            simulate(&setup, Campaign::Calibration, effects, Readings::Ideal)
        };
        let without = run(&[]);
        for physics in Physics::ALL.iter().copied().filter(|p| p.occurs(rig)) {
            let effect = part(physics, 1e-3);
            let with = run(&[effect]);
            assert!(with != without, "{physics:?} on {rig:?}");
            assert_eq!(with, run(&[effect]));
            assert!(
                with.iter()
                    .all(|row| row.output.iter().all(|y| y.is_finite()))
            );
        }
    }
}
