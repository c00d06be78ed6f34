//! Whether the threshold of the transition can tell two kinds of flow apart.

use peristalsis_configuration::{Configuration, InitialState};

use super::warning::Warning;
use crate::recorder::THRESHOLDS;
use crate::run::Run;

const KEY: &str = "observe.transition_threshold";
/// Thresholds next to each other that a change of the flow passes at least.
const PASSED: usize = 3;
/// Most periods between two neighbouring thresholds of one change, and between a change and its transition.
const PERIODS: f64 = 10.0;
/// How near to grains at rest or to grains that travel with the wave a threshold can tell no flow from theirs.
const NEAR: f64 = 0.01;
/// No tube on record that its wave alone drives has a J/Jmax below this; the least is -0.11.
const BACK_FLOW: f64 = -0.2;

/// That no flow crosses the threshold, as far as the configuration tells.
pub(super) fn out_of_reach(configuration: &Configuration) -> Option<Warning> {
    let threshold = configuration.observe.transition_threshold;
    let (start, state) = match configuration.initial.state {
        InitialState::Rest | InitialState::Settled | InitialState::Placed => (0.0, "at rest"),
        InitialState::Jammed => (1.0, "jammed"),
    };
    let force = configuration.axial_body_force();
    let reason = if (threshold - start).abs() < NEAR {
        format!("where a run that begins {state} starts, so that the first period decides")
    } else if threshold > 1.0 && force <= 0.0 {
        "above 1, the flow of grains that travel with the wave, which nothing drives beyond it"
            .to_owned()
    } else if (threshold - 1.0).abs() < NEAR && force <= 0.0 {
        "the flow of grains that all travel with the wave, which none that slip a little reach"
            .to_owned()
    } else if (0.0..NEAR).contains(&threshold) && force >= 0.0 {
        "the flow of grains at rest, and the wave carries all a little".to_owned()
    } else if threshold < BACK_FLOW && force >= 0.0 {
        "a back flow that the wave alone does not drive (a body force against it would)".to_owned()
    } else {
        return None;
    };
    let message = format!(
        "J/Jmax = {threshold} is {reason}: take one between the two kinds of flow, such as 0.5"
    );
    Some(Warning { key: KEY, message })
}

/// A change of the flow: the least and the largest of [`THRESHOLDS`] that it passed, and from when to when \[t\].
struct Change {
    values: [f64; 2],
    times: [f64; 2],
}

/// That the flow changed its kind without crossing the threshold, or crossed it while its kind stayed.
pub(super) fn missed(run: &Run) -> Option<Warning> {
    let configuration = run.configuration();
    let period = configuration.drive.period()?;
    let threshold = configuration.observe.transition_threshold;
    let recorder = run.recorder();
    let found = recorder.transition_time();
    let change = change(&recorder.transition_times(), period);
    let is_jammed = configuration.initial.state == InitialState::Jammed;
    let is_beyond = |value: f64| match is_jammed {
        true => value < threshold,
        false => value > threshold,
    };
    let now = recorder.averages().last();
    if found.is_none() && now.is_some_and(|now| is_beyond(*now)) {
        // It is crossing it, and may stay.
        return None;
    }
    let message = match (change, found) {
        (None, Some(time)) if time < period => {
            let ladder = THRESHOLDS.into_iter().zip(recorder.transition_times());
            let is_beyond = |value: f64| is_beyond(value) && (threshold >= 0.0 || is_jammed);
            let soon = |time: Option<f64>| time.is_some_and(|time| time < PERIODS * period);
            let beyond = ladder.filter(|(value, time)| is_beyond(*value) && soon(*time));
            if beyond.count() >= 2 {
                return None;
            }
            format!(
                "the flow crossed {threshold} in its first period, on its way from the initial state, and hardly went on: that \
                 is its start, not a change of its kind; take a threshold farther from the initial state"
            )
        }
        (Some(change), found) => {
            let [least, most] = change.values;
            let [first, last] = change.times;
            let around = first - PERIODS * period..=last + PERIODS * period;
            let (is_within, is_then) = (
                (least..=most).contains(&threshold),
                found.is_some_and(|time| around.contains(&time)),
            );
            if is_within || is_then {
                return None;
            }
            let crossed = match found {
                None => format!("never crossed {threshold}"),
                Some(time) => format!("crossed {threshold} at another time, t = {time:.1}"),
            };
            let middle = 0.5 * (least + most);
            format!(
                "the flow changed between J/Jmax = {least} and {most} from t = {first:.1} to {last:.1}, but {crossed}: take a \
                 threshold between them, such as {middle:.2}"
            )
        }
        _ => return None,
    };
    Some(Warning { key: KEY, message })
}

/// The longest way that the flow went through thresholds next to each other, after its first period.
fn change(times: &[Option<f64>; THRESHOLDS.len()], period: f64) -> Option<Change> {
    let passed = |place: usize| times[place].filter(|time| *time >= period);
    let is_near = |one: usize, other: usize| match (passed(one), passed(other)) {
        (Some(one), Some(other)) => (one - other).abs() <= PERIODS * period,
        _ => false,
    };
    let mut longest = 0..0;
    let mut start = 0;
    for end in 1..=times.len() {
        if end < times.len() && is_near(end - 1, end) {
            continue;
        }
        if end - start > longest.len() && passed(start).is_some() {
            longest = start..end;
        }
        start = end;
    }
    let (first, last) = (longest.start, longest.end.checked_sub(1)?);
    if longest.len() < PASSED {
        return None;
    }
    let mut ends = [passed(first)?, passed(last)?];
    ends.sort_by(f64::total_cmp);
    Some(Change {
        values: [THRESHOLDS[first], THRESHOLDS[last]],
        times: ends,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_is_three_thresholds_in_a_row_within_reach_of_one_another() {
        let found = |times: [f64; 9]| {
            let times = times.map(|time| (time > 0.0).then_some(time));
            change(&times, 1.0).map(|change| (change.values, change.times))
        };
        let slow_then_jammed = [0.5, 3.0, 100.0, 101.0, 102.0, 103.0, 104.0, 0.0, 0.0];
        assert_eq!(found(slow_then_jammed), Some(([0.3, 0.7], [100.0, 104.0])));
        let downward = [30.0, 28.0, 27.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4];
        assert_eq!(found(downward), Some(([0.1, 0.3], [27.0, 30.0])));
        assert_eq!(found([5.0, 6.0, 40.0, 80.0, 0.0, 0.0, 0.0, 0.0, 0.0]), None);
        assert_eq!(found([0.0; 9]), None);
    }
}
