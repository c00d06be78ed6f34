//! The results of a run, in words.

use peristalsis_analysis::CONFIRMATION_PERIODS;
use peristalsis_analysis::number::{known_error, rounded, with_error};
use peristalsis_configuration::{HOUR, Units};
use peristalsis_reproduce::report::plain_text;
use peristalsis_run::{Discharge, Pumping, Run, Summary};

use crate::commands::{counted, significant};
use crate::progress::seconds;

/// How far a run came: in periods, or in time where the wave stands still.
pub(super) fn how_far(run: &Run, summary: &Summary) -> String {
    let extent = run.configuration().run;
    match extent.periods {
        Some(periods) => format!(
            "after {} of {}",
            tenths(summary.time * run.configuration().drive.strain_rate),
            counted(periods, "period")
        ),
        None => format!("at t = {:.1} of {}", summary.time, extent.duration),
    }
}

pub(super) fn in_words(run: &Run, summary: &Summary) -> String {
    let mut text = transition(run, summary) + "\n";
    text += &flow(run, summary);
    text += &against_a_load(summary);
    text += &in_si(run, summary);
    text += &wear(summary);
    text += &mixing(run, summary);
    text += &segregation(run, summary);
    if let Some(discharge) = &summary.discharge {
        text += &through(discharge, summary);
    }
    text += &format!(
        "\n{}, {} escaped; largest overlap {:.2} d; energy residual {:.1e}\n{} in {}: {:.2} million grain-steps/s\n",
        counted(run.configuration().grains.number, "grain"),
        summary.escaped,
        summary.largest_overlap,
        summary.energy_residual,
        counted(summary.steps, "step"),
        seconds(summary.seconds),
        summary.grain_steps_per_second() / 1e6
    );
    for diagnosis in &summary.wall_diagnosis {
        text += &format!("the wall: {diagnosis}\n");
    }
    text
}

/// When the flow passed from one kind to the other.
fn transition(run: &Run, summary: &Summary) -> String {
    let configuration = run.configuration();
    let threshold = configuration.observe.transition_threshold;
    let periods = |time: f64| tenths(time * configuration.drive.strain_rate);
    match summary.transition_time {
        // The mean of a period is the first that there is.
        Some(time) if time * configuration.drive.strain_rate < 1.0 => format!(
            "transition in the first period, interpolated to t = {time:.1}: J/Jmax crosses {threshold}"
        ),
        Some(time) => format!(
            "transition at t = {time:.1} ({} periods): J/Jmax crosses {threshold}",
            periods(time)
        ),
        None if configuration.drive.period().is_none() => "the wave stands still".to_owned(),
        None if is_too_short(summary) => format!(
            "too short for a transition: {} periods, and it takes {CONFIRMATION_PERIODS} whole ones to be sure",
            periods(summary.time)
        ),
        None if !has_three_averages(run) => format!(
            "no transition can be told: J/Jmax is never known for {CONFIRMATION_PERIODS} periods in a row"
        ),
        None => format!("no transition within {} periods", periods(summary.time)),
    }
}

/// Whether there is an average of J/Jmax in so many periods in a row as tell of a transition.
fn has_three_averages(run: &Run) -> bool {
    let averages = run.recorder().averages();
    let mut in_a_row = averages.windows(CONFIRMATION_PERIODS as usize);
    in_a_row.any(|some| some.iter().all(|average| average.is_finite()))
}

/// Whether a run has fewer periods than tell of a transition.
pub(super) fn is_too_short(summary: &Summary) -> bool {
    summary.periods_of_drive() + 1e-6 < f64::from(CONFIRMATION_PERIODS)
}

/// The late flow beside that of a Newtonian fluid, and whether it still changes.
fn flow(run: &Run, summary: &Summary) -> String {
    let configuration = run.configuration();
    let late = rounded(100.0 * summary.late_part(run.recorder().samples().len()), 3);
    let (ratio, error) = summary.flow_rate_ratio;
    let said = measured(summary.flow_rate_ratio);
    let mut flow = match known_error(ratio, error) {
        Some(_) => format!("J/Jmax = {said} within this run, mean of its last {late} %"),
        None if error.is_finite() => {
            format!("J/Jmax = {said} throughout its last {late} %")
        }
        None if ratio.is_finite() => {
            format!("J/Jmax = {said}, mean of its last {late} % (too short for an error)")
        }
        None if summary.flow_rate().is_nan() => "no sample was taken".to_owned(),
        None => {
            let flow = significant(summary.flow_rate() + 0.0, 4);
            let why = match configuration.drive.period() {
                None => "the wave stands",
                Some(_) => "the wave stood or no grain was inside",
            };
            format!("J = {flow} t^-1, mean of its last {late} %; {why}, so J/Jmax is not defined")
        }
    };
    if let Some((newtonian, clear_bore)) = summary.newtonian {
        // The load of a fluid counts against its viscosity, which grains do not have.
        let is_loaded = summary.pumping.is_some();
        let load = if is_loaded { " without load" } else { "" };
        let newtonian = number(newtonian);
        // Whoever has a real tube knows its clear bore, not where spheres stand for its wall.
        let clear_bore = clear_bore.filter(|_| configuration.units.is_some());
        let clear_bore = clear_bore.map(|it| format!("; in the clear bore {}", number(it)));
        let clear_bore = clear_bore.unwrap_or_default();
        flow += &format!(" (a Newtonian fluid{load}: {newtonian}{clear_bore})");
    }
    if summary.is_still_changing() {
        flow += &format!(
            "\nit still changes: by {} from the first half of this time to the second",
            significant(summary.flow_rate_ratio_drift(), 2)
        );
    }
    flow
}

/// Useful power and efficiency, where grains are pumped against a load.
fn against_a_load(summary: &Summary) -> String {
    // Weight that carries grains through an open tube is no load.
    let falls = |pumping: &&Pumping| summary.discharge.is_some() && pumping.pressure_rise <= 0.0;
    let Some(pumping) = summary.pumping.as_ref().filter(|it| !falls(it)) else {
        return String::new();
    };
    let exact = |value: f64| (value, f64::NAN);
    let (rise, power) = (exact(pumping.pressure_rise), exact(pumping.useful_power.0));
    let rise = told(summary, rise, Units::pressure, ["Pa", "m/(d t^2)"]);
    let power = told(summary, power, Units::power, ["W", "m d^2/t^3"]);
    let efficiency = efficiency(pumping);
    format!(
        "\nagainst a pressure rise of {rise} over a wavelength: useful power {power}, {efficiency}"
    )
}

/// Mass flow, power, pressure and contact forces, where the configuration has units.
fn in_si(run: &Run, summary: &Summary) -> String {
    let (Some((mass_flow, error)), Some(power), Some(pressure), Some(largest)) = (
        summary.mass_flow_rate_in_si(),
        summary.in_si(summary.wall_power(), Units::power),
        summary.in_si(summary.wall_pressure, Units::pressure),
        summary.in_si(summary.wall_pressure_largest, Units::pressure),
    ) else {
        return String::new();
    };
    // Before the first sample nothing is known.
    if !power.is_finite() {
        return String::new();
    }
    let torque = summary.wall_torque.map(|(torque, _)| torque);
    let torque = torque.and_then(|torque| summary.in_si(torque, Units::energy));
    let torque = torque.map(|it| {
        format!(
            " (torque {} N m of a shaft that turns once for each wave)",
            number(it)
        )
    });
    let mut text = format!(
        "\nin SI: {} kg/h{}, wall power {} W{}, pressure on the wall {} Pa (at most {} averaged over 1/{} of a wavelength)",
        measured((HOUR * mass_flow, HOUR * error)),
        summary.discharge.map_or("", |_| " along the tube"),
        number(power),
        torque.unwrap_or_default(),
        number(pressure),
        number(largest),
        run.configuration().observe.profile_bins
    );
    let force = |value: f64| summary.in_si(value, Units::force).map(number);
    if let Some((high, largest, moments)) = summary.contact_force()
        && let (Some(high), Some(largest)) = (force(high), force(largest))
    {
        text += &format!(
            "\n       99 % of the contacts bear less than {high} N, the largest bears {largest} N (at {})",
            counted(moments, "moment")
        );
    }
    text
}

/// Power lost to sliding at the wall, where grains slide there.
fn wear(summary: &Summary) -> String {
    let Some(wear) = summary.wear.filter(|wear| wear.power.0 > 0.0) else {
        return String::new();
    };
    let power = told(summary, wear.power, Units::power, ["W", "m d^2/t^3"]);
    let unit = |units: &Units| units.pressure() * units.velocity();
    let per_area = told(summary, wear.power_per_area, unit, ["W/m^2", "m/t^3"]);
    let (power_lost, error) = wear.power;
    let doubt = match known_error(power_lost, error) {
        Some(_) => "",
        None => " (too short for an error)",
    };
    format!("\nwear: sliding on the wall takes {power}, {per_area} of wall{doubt}")
}

/// What tells a discharge from a mass flow.
pub(crate) const DISCHARGE: &str = "discharge";
pub(crate) const MASS_FLOW: &str = "mass flow";

/// Mass that an open tube discharges, of another that flows along the wave, with its error and its unit; `None` of a periodic
/// tube without units in SI, where J/Jmax says as much.
pub(crate) fn mass_flow(summary: &Summary) -> Option<((f64, f64), &'static str)> {
    let discharged = summary.discharge.map(|it| it.rate);
    let own = discharged.unwrap_or_else(|| summary.mass_flow_rate());
    let per_hour = summary.measured_in_si(own, |units| HOUR * units.mass_flow());
    let in_si = per_hour.map(|rate| (rate, "kg/h"));
    in_si.or_else(|| Some((discharged?, "m/t")))
}

/// A number with its error, if one is known; with the minus of a keyboard, as all numbers in a terminal.
pub(crate) fn measured((value, error): (f64, f64)) -> String {
    plain_text(&with_error(value + 0.0, error)).replace('−', "-")
}

/// A number without an error.
fn number(value: f64) -> String {
    measured((value, f64::NAN))
}

/// A number with its error in SI, or else in the units of the run.
fn told(
    summary: &Summary,
    pair: (f64, f64),
    unit: fn(&Units) -> f64,
    [si, own]: [&str; 2],
) -> String {
    match summary.measured_in_si(pair, unit) {
        Some(pair) => format!("{} {si}", measured(pair)),
        None => format!("{} {own}", measured(pair)),
    }
}

/// How far the grains are mixed, once a period has passed.
fn mixing(run: &Run, summary: &Summary) -> String {
    let mixed = summary.mixed;
    let since = |time: f64| {
        let rate = run.configuration().drive.strain_rate;
        match rate > 0.0 {
            true => format!("half after {} periods", tenths(time * rate)),
            false => format!("half after t = {time:.1}"),
        }
    };
    let ways = [
        (mixed.axial, mixed.axial_time, "along the tube"),
        (mixed.radial, mixed.radial_time, "across it"),
    ];
    let found = ways.map(|(late, time, way)| match (late, time.map(since)) {
        (Some(late), Some(half)) => Some(format!("{} ({half}) {way}", measured(late))),
        (Some(late), None) => Some(format!("{} {way}", measured(late))),
        (None, half) => Some(format!("{} {way}", half?)),
    });
    match found.into_iter().flatten().collect::<Vec<_>>().as_slice() {
        [] => String::new(),
        found => format!("\nmixing, 0 apart to 1 at random: {}", found.join(", ")),
    }
}

/// Where large grains gather, if not by chance.
fn segregation(run: &Run, summary: &Summary) -> String {
    let late = run.recorder().late(run.late_fraction());
    // Of an open tube those that are in it count.
    let inside = late.iter().map(|sample| sample.inside).sum::<f64>() / late.len() as f64;
    let by_chance = 2.0 / (inside - 1.0).sqrt();
    let sizes = summary.segregated;
    let places = [
        (sizes.radial, ["near the wall", "near the axis"]),
        (sizes.height, ["on top", "below"]),
        (sizes.belly, ["in the bellies", "in the throats"]),
    ];
    let gathered = places.into_iter().filter_map(|(found, [above, below])| {
        let (correlation, error) = found?;
        let place = if correlation > 0.0 { above } else { below };
        let size = measured((correlation.abs(), error));
        (correlation.abs() > by_chance).then(|| format!("{place} ({size})"))
    });
    match gathered.collect::<Vec<_>>().as_slice() {
        [] => String::new(),
        gathered => format!(
            "\nlarge grains gather, by correlation: {}",
            gathered.join(", ")
        ),
    }
}

/// The discharge of an open tube.
fn through(discharge: &Discharge, summary: &Summary) -> String {
    let flow = |rate| {
        let per_hour = |units: &Units| HOUR * units.mass_flow();
        told(summary, rate, per_hour, ["kg/h", "m/t"])
    };
    let rate = flow(discharge.rate);
    let hold_up = told(summary, discharge.hold_up, Units::mass, ["kg", "m"]);
    let mut text = format!("\nthe outlet discharges {rate}; the tube holds {hold_up}");
    if discharge.return_rate.0 > 0.0 {
        let back = flow(discharge.return_rate);
        text.push_str(&format!("; {back} go back through the inlet"));
    }
    if let Some(part) = discharge.refill_efficiency {
        let part = measured(part);
        text.push_str(&format!(
            "; a stroke is filled with grains to {part} of its volume"
        ));
    }
    if discharge.passed > 1 {
        let (grains, time) = (
            counted(discharge.passed, "grain"),
            measured(discharge.transit_time),
        );
        let spread = significant(discharge.transit_time_variance.sqrt(), 3);
        text.push_str(&format!("\n{grains} went from the inlet to the outlet, in {time} t on average (standard deviation {spread} t)"));
        if discharge.transit_time.0 > SOON * summary.time {
            text.push_str("; slower ones are still inside");
        }
    }
    text
}

/// Part of a run from which on a mean transit time lacks the slow grains.
const SOON: f64 = 0.1;

/// Periods to a tenth, fewer than one to two digits.
fn tenths(periods: f64) -> String {
    match periods.abs() < 1.0 && periods != 0.0 {
        true => significant(periods, 2),
        false => format!("{periods:.1}"),
    }
}

/// The efficiency, or why there is none.
fn efficiency(pumping: &Pumping) -> String {
    let (efficiency, _) = pumping.efficiency;
    if efficiency.is_nan() {
        let reason = match pumping.useful_power.0 {
            power if power.is_nan() => "nothing was measured",
            power if power > 0.0 => "the wall gives no power: stored energy is spent",
            _ => "the grains do not go against the body force",
        };
        return format!("efficiency – ({reason})");
    }
    let mut text = format!("efficiency {}", measured(pumping.efficiency));
    if efficiency > 1.0 {
        text.push_str(" (above 1: stored energy is spent; run longer)");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_efficiency_is_said_where_there_is_one() {
        let said = |useful_power: f64, efficiency: f64| {
            super::efficiency(&Pumping {
                pressure_rise: 0.1,
                useful_power: (useful_power, 0.0),
                efficiency: (efficiency, 0.01),
            })
        };
        assert_eq!(said(1.0, 0.25), "efficiency 0.250 ± 0.010");
        assert!(said(1.0, 1.5).contains("stored energy is spent; run longer"));
        assert!(said(1.0, f64::NAN).starts_with("efficiency – (the wall"));
        assert!(said(-1.0, f64::NAN).starts_with("efficiency – (the grains"));
        assert!(said(f64::NAN, f64::NAN).starts_with("efficiency – (nothing was measured"));
    }
}
