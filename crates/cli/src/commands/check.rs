//! `peristalsis check`

use std::process::ExitCode;

use peristalsis_analysis::number::bytes;
use peristalsis_configuration::{HOUR, Kernel};
use peristalsis_engine::{SPHERES_OF_A_THREAD, processors};
use peristalsis_run::{Estimate, estimate, warnings};

use crate::arguments::CheckArguments;
use crate::commands::trajectory::request;
use crate::commands::{counted, packing, print_report, rounded, significant};
use crate::failure::Failure;
use crate::progress::seconds;
use crate::sources::{configuration, locate};
use crate::stop::Stop;

pub(crate) fn check(arguments: &CheckArguments) -> Result<ExitCode, Failure> {
    let _stop = Stop::watch()?;
    let configuration = configuration(&arguments.configuration)?;
    let request = request(&arguments.frames)?;
    let estimate = packing(&configuration, &warnings(&configuration), || {
        estimate(&configuration, request.as_ref())
    })
    .map_err(|error| locate(error, &arguments.configuration))?;
    print_report(arguments.json, || &estimate, || in_words(&estimate))
}

pub(super) fn in_words(estimate: &Estimate) -> String {
    let warnings = estimate.warnings.iter();
    let warnings = warnings.map(|warning| format!("warning: {}: {}", warning.key, warning.message));
    let lines = [tube(estimate), units(estimate), cost(estimate)];
    let lines: Vec<String> = lines.into_iter().flatten().chain(warnings).collect();
    lines.join("\n") + "\n"
}

/// Grains, wall and time, and what a Newtonian fluid would do.
fn tube(estimate: &Estimate) -> Vec<String> {
    let waiting = match estimate.waiting_grains {
        None | Some(0) => String::new(),
        Some(waiting) => {
            format!(
                "; {waiting} of them wait outside, and so do those without a place between outlet and inlet"
            )
        }
    };
    let scatter = estimate
        .volume_fraction_scatter
        .map_or_else(String::new, |scatter| {
            format!(" ± {scatter:.4} by the sizes that are drawn")
        });
    let wall = match estimate.wall_spheres {
        0 => "smooth".to_owned(),
        spheres => format!("{spheres} spheres"),
    };
    let mut lines = vec![
        format!(
            "grains            {} (volume fraction {:.4}{scatter}, number density {:.4}){waiting}",
            estimate.grains, estimate.volume_fraction, estimate.number_density
        ),
        format!(
            "wall              {wall} along {} d",
            rounded(estimate.length)
        ),
    ];
    if let Some(openings) = estimate.clear_openings {
        let [throat, belly] = openings.map(|opening| significant(opening, 4));
        let in_mm = estimate.si.as_ref().map(|si| {
            let [throat, belly] =
                openings.map(|opening| significant(1e3 * si.unit_length_m * opening, 4));
            format!(" ({throat} and {belly} mm)")
        });
        let in_mm = in_mm.unwrap_or_default();
        lines.push(format!(
            "clear opening     {throat} d at the throats, {belly} d in the bellies{in_mm}"
        ));
    }
    lines.extend([
        time(estimate),
        format!(
            "steps             {} of {} t; a usual contact lasts about {} t, {} steps",
            estimate.steps,
            significant(estimate.time_step, 4),
            significant(estimate.contact_time, 3),
            significant(estimate.steps_per_contact, 3)
        ),
    ]);
    if let Some(restitution) = estimate.restitution {
        let speed = estimate
            .period
            .map_or("any speed", |_| "the speed of the wave");
        lines.push(format!(
            "restitution       {} of two grains that meet at {speed}",
            significant(restitution, 3)
        ));
    }
    if let Some(ratio) = estimate.newtonian_flow_rate_ratio {
        let in_bore = estimate.newtonian_flow_rate_ratio_clear_bore;
        let in_bore = in_bore.map(|ratio| format!(", {ratio:.4} in its clear bore"));
        lines.push(format!(
            "Newtonian fluid   J/Jmax = {ratio:.4} in this tube{}, without load",
            in_bore.unwrap_or_default()
        ));
    }
    lines
}

/// How long the run is.
fn time(estimate: &Estimate) -> String {
    let duration = rounded(estimate.duration);
    let (Some(period), Some(periods)) = (estimate.period, estimate.periods) else {
        return format!("time              {duration} t, the wave stands still");
    };
    let [periods, period] = [periods, period].map(rounded);
    let periods = counted(periods, "period");
    let led = estimate.wavelengths.map(|wavelengths| {
        format!(
            " as drive.strain_rate has them; led by drive.schedule, the wave runs {} wavelengths",
            rounded(wavelengths)
        )
    });
    let led = led.unwrap_or_default();
    format!("time              {duration} t: {periods} of {period} t{led}")
}

/// The units and the drive in SI, where the configuration has units.
fn units(estimate: &Estimate) -> Vec<String> {
    let Some(si) = &estimate.si else {
        return Vec::new();
    };
    let (mut wave, mut flow) = (String::new(), String::new());
    if estimate.period.is_some() {
        let [frequency, speed] =
            [si.wave_frequency_hz, si.wave_speed_m_per_s].map(|it| significant(it, 4));
        wave = format!("; a wave of {frequency} Hz, {speed} m/s");
        let largest = significant(HOUR * si.largest_mass_flow_rate_kg_per_s, 4);
        flow = format!("; {largest} kg/h if all grains go with the wave");
    }
    if si.fastest_wave_frequency_hz != si.wave_frequency_hz {
        let frequency = significant(si.fastest_wave_frequency_hz, 4);
        wave += &format!(", by the schedule up to {frequency} Hz");
    }
    let mut lines = vec![
        format!(
            "in SI             d = {} m, m = {} kg, t = {} s{wave}",
            significant(si.unit_length_m, 4),
            significant(si.unit_mass_kg, 4),
            significant(si.unit_time_s, 4)
        ),
        format!(
            "                  {} s in steps of {} s{flow}; unit of pressure {} Pa, of power {} W",
            significant(si.duration_s, 4),
            significant(si.time_step_s, 3),
            significant(si.unit_pressure_pa, 4),
            significant(si.unit_power_w, 4)
        ),
    ];
    if si.gravity_m_per_s2 != [0.0; 3] {
        let [x, y, z] = si.gravity_m_per_s2.map(|it| significant(it, 4));
        lines.push(format!("                  gravity [{x}, {y}, {z}] m/s^2"));
    }
    if si.body_force_m_per_s2 != 0.0 {
        let force = significant(si.body_force_m_per_s2, 4);
        lines.push(match estimate.period {
            Some(_) => format!(
                "                  body force {force} m/s^2 along the wave, weight included: a pressure rise of {} Pa over a wavelength",
                significant(si.pressure_rise_pa, 4)
            ),
            None => format!(
                "                  body force {force} m/s^2 along the tube, weight included"
            ),
        });
    }
    lines
}

/// What the run takes: time, kernel, threads, memory, disk.
fn cost(estimate: &Estimate) -> Vec<String> {
    let [expected, packing] = [estimate.expected_seconds, estimate.packing_seconds].map(seconds);
    let is_reference = estimate.kernel == Kernel::Reference;
    let kernel = match estimate.reference_only {
        Some(what) => format!("reference, for it alone computes {what}"),
        None if is_reference => "reference".to_owned(),
        None => "fast".to_owned(),
    };
    let why = match estimate.reference_only.is_some() || is_reference {
        true => "the reference kernel takes no more".to_owned(),
        false => format!(
            "one for each {SPHERES_OF_A_THREAD} of {} moving spheres, at least one, on {}",
            estimate.moving_spheres,
            counted(processors(), "processor")
        ),
    };
    let mut lines = vec![
        format!("expected time     {expected}, after {packing} of packing"),
        format!("kernel            {kernel}"),
        format!("threads           {}: {why}", estimate.threads),
        format!(
            "memory            at most some {}",
            bytes(estimate.memory_bytes)
        ),
    ];
    if let Some(trajectory) = &estimate.trajectory {
        for (format, size) in &trajectory.bytes {
            let (name, size) = (format.file_name(), bytes(*size as f64));
            let frames = counted(trajectory.frames, "frame");
            let every = format!("one every {}", counted(trajectory.interval_steps, "step"));
            lines.push(format!(
                "trajectory        {name} of {frames}, {every}: about {size}"
            ));
        }
    }
    lines
}
