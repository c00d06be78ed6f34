use super::*;
use crate::summary::mean;

fn samples(value: impl Fn(f64) -> Sample) -> Vec<Sample> {
    (0..40_u32)
        .map(|step| value(0.5 * f64::from(step)))
        .collect()
}

fn steady(late: &[Sample]) -> Late {
    Late::in_blocks(late, 1)
}

/// A newcomer: an open tube of three periods was told over three quarters of a stroke, a third less than it discharges.
#[test]
fn late_means_of_a_pulsing_tube_are_over_a_whole_period_at_least() {
    let segments = "grains.number=5 tube.waves=1 drive.waveform=segments drive.width=2";
    for (periods, expected) in [(2.0, 20), (7.0, 20), (8.0, 40), (0.5, 3)] {
        let length = format!("run.periods={periods}");
        let settings: Vec<&str> = segments.split(' ').chain([&*length]).collect();
        let configuration = Configuration::from_preset("frictionless", &settings).unwrap();
        let mut run = crate::Run::new(configuration.clone()).unwrap();
        while !run.is_complete() {
            run.advance().unwrap();
        }
        let late = Late::of(&configuration, run.recorder(), run.late_fraction());
        assert_eq!(late.len(), expected, "{periods}");
    }
}

/// Three samples a period, of which the second has a flow of 6 more; mean flows of 12 and 14 in turn.
#[test]
fn the_pulse_of_a_wave_is_no_noise() {
    let all = samples(|time| {
        let sample = (2.0 * time) as u32;
        let (period, phase) = (sample / 3, sample % 3);
        Sample {
            flow_rate: f64::from(10 + 2 * (period % 2) + if phase == 1 { 6 } else { 0 }),
            ..Sample::default()
        }
    });
    let whole = &all[..39];
    let flow = |sample: &Sample| sample.flow_rate;
    // The sample of a ninth period is left out.
    let late = Late::in_blocks(&whole[whole.len() - 25..], 3);
    assert_eq!(late.samples, whole[whole.len() - 24..]);
    let (mean, error) = late.measured(flow);
    assert!((mean - 13.0).abs() < 1e-12);
    assert!((error - (8.0_f64 / (7.0 * 8.0)).sqrt()).abs() < 1e-12);
    let of_samples = error_of(late.iter().map(flow));
    assert!(of_samples > 1.2 * error, "{of_samples} {error}");
    // Halves of nine periods have four and five.
    let late = Late::in_blocks(&whole[whole.len() - 27..], 3);
    let flows: Vec<f64> = late.iter().map(flow).collect();
    let (first, second) = late.halves(&flows);
    assert_eq!((first.len(), second.len()), (12, 15));
    // The error of few periods is that of their averages: 12, 14 and 12, of one it is not known.
    let late = Late::in_blocks(&whole[whole.len() - 11..], 3);
    let (mean, error) = late.measured(flow);
    assert_eq!(late.len(), 9);
    assert!((mean - 38.0 / 3.0).abs() < 1e-12 && (error - 2.0 / 3.0).abs() < 1e-12);
    for number in [5, 2] {
        let late = Late::in_blocks(&whole[whole.len() - number..], 3);
        assert_eq!(late.len(), number.min(3));
        assert!(late.measured(flow).1.is_nan());
    }
}

/// A checker: of 32 periods the rates came from the last three, as the origin at the start of the late part was left out.
#[test]
fn dispersion_counts_from_the_start_of_the_late_part() {
    let settings = ["tube.waves=1", "drive.width=2.9", "run.periods=32"];
    let configuration = Configuration::from_preset("frictionless", &settings).unwrap();
    let mut run = crate::Run::new(configuration).unwrap();
    while !run.is_complete() {
        run.advance().unwrap();
    }
    let (samples, late) = (run.recorder().samples(), run.recorder().late(0.25));
    let found = axial_dispersion(samples, late, run.recorder().dispersion());
    let rates = run
        .recorder()
        .dispersion()
        .rates_from(samples[24 * 20 - 1].time);
    assert_eq!((late.len(), rates.len()), (8 * 20, 7));
    assert_eq!(found.0, mean(&rates));
    assert!(found.1.is_finite());
}

#[test]
fn only_waves_that_pass_ends_or_close_in_turn_pulse() {
    let pulses = |preset: &str, settings: &[&str]| {
        pulses(&Configuration::from_preset(preset, settings).unwrap())
    };
    assert!(!pulses("frictionless", &[]));
    assert!(!pulses("silo", &[]));
    assert!(pulses("soft-robot", &[]));
    let open = "tube.ends=open";
    assert!(pulses("frictionless", &[open]));
    let schedule = "drive.schedule={form=\"steps\",parameter=\"strain_rate\",at=[1],values=[0.01]}";
    assert!(!pulses("frictionless", &[open, schedule]));
}

#[test]
fn only_a_pump_that_pumps_has_an_efficiency() {
    let settings = ["drive.body_force=-0.001"];
    let configuration = Configuration::from_preset("frictionless", &settings).unwrap();
    let pumping = |useful_power: f64, wall_power: f64| {
        let late = samples(|_| Sample {
            body_power: -useful_power,
            wall_power,
            ..Sample::default()
        });
        let length = configuration.tube.length();
        Pumping::of(&configuration, length, &steady(&late)).unwrap()
    };
    let pumped = pumping(0.2, 0.8);
    assert!((pumped.efficiency.0 - 0.25).abs() < 1e-12);
    assert!(pumped.efficiency.1.abs() < 1e-12);
    // Of an assisting force, of grains driven back, of a wall that stands still or takes power out.
    for (useful_power, wall_power) in [(-0.2, 0.8), (0.2, 0.0), (0.2, -0.8), (-0.2, -0.8)] {
        let none = pumping(useful_power, wall_power);
        assert!(none.efficiency.0.is_nan() && none.efficiency.1.is_nan());
        assert!((none.useful_power.0 - useful_power).abs() < 1e-12);
    }
}

/// Two waves a time, of which each takes the work 2 pi 0.75.
#[test]
fn the_torque_is_the_work_of_a_wave_over_a_turn() {
    let all = samples(|time| Sample {
        time: time + 0.5,
        period: 2.0 * (time + 0.5),
        wall_power: 2.0 * TAU * 0.75,
        ..Sample::default()
    });
    for late in [&all[..], &all[30..]] {
        let (torque, error) = wall_torque(&all, &steady(late)).unwrap();
        assert!((torque - 0.75).abs() < 1e-12 && error.abs() < 1e-12);
    }
    let still = samples(|time| Sample {
        time,
        ..Sample::default()
    });
    assert_eq!(wall_torque(&still, &steady(&still[20..])), None);
}

/// A wave of one wavelength a time, then of next to none, with 10 grains in a tube of 2 wavelengths.
#[test]
fn the_flow_of_a_wave_that_changes_its_speed_is_over_the_mean() {
    let of = |slow: f64, changes: bool| {
        let all = samples(|time| {
            let (cycles, inside) = (time.min(10.0) + slow * (time - 10.0).max(0.0), 10.0);
            let frequency = if time > 10.0 { slow } else { 1.0 };
            let flow_rate = 2.0;
            Sample {
                time,
                period: cycles,
                inside,
                flow_rate,
                flow_rate_raw: flow_rate,
                flow_rate_ratio: 2.0 * flow_rate / (inside * frequency),
                flow_rate_ratio_raw: 2.0 * flow_rate / (inside * frequency),
                ..Sample::default()
            }
        });
        flow_rate_ratios(&all, &all, 2.0, changes).map(|ratios| mean(&ratios))
    };
    // It runs at the speed 1 for 10 of the 19.5 t.
    let expected = |slow: f64| 2.0 * 2.0 / 10.0 / ((10.0 + slow * 9.5) / 19.5);
    for slow in [1e-3, 1e-6] {
        let found = of(slow, true);
        assert!(
            found.iter().all(|one| (one - expected(slow)).abs() < 1e-9),
            "{found:?}"
        );
        assert!(of(slow, false)[0] > 100.0);
    }
    // Samples without a ratio are not skipped: J over the mean of Jmax, also without a schedule.
    let all = samples(|time| Sample {
        time,
        period: time,
        inside: 10.0,
        flow_rate: 2.0,
        flow_rate_ratio: if time > 15.0 { f64::NAN } else { 0.9 },
        ..Sample::default()
    });
    let [inside, _] = flow_rate_ratios(&all, &all, 2.0, false);
    assert!((mean(&inside) - 0.4).abs() < 1e-12);
}

#[test]
fn grains_leave_as_fast_as_they_come() {
    // 20 grains, J alternating between 3 and 5: 20/4; N - T J alternates by 5 about 0.
    let late = samples(|time| Sample {
        inside: 20.0,
        flow_rate: if ((2.0 * time) as u32).is_multiple_of(2) {
            3.0
        } else {
            5.0
        },
        ..Sample::default()
    });
    let (time, error) = residence_time(&steady(&late)).unwrap();
    assert!((time - 5.0).abs() < 1e-12);
    assert!((0.0..0.3).contains(&error));
    let back = samples(|_| Sample {
        inside: 20.0,
        flow_rate: -1.0,
        ..Sample::default()
    });
    assert_eq!(residence_time(&steady(&back)), None);
}
