//! `peristalsis check`

use std::process::ExitCode;

use peristalsis_configuration::Kernel;
use peristalsis_engine::{SPHERES_OF_A_THREAD, processors};
use peristalsis_run::{Estimate, estimate};

use crate::arguments::CheckArguments;
use crate::commands::trajectory::{request, size};
use crate::commands::{counted, packing, print_report, rounded, significant};
use crate::failure::Failure;
use crate::progress::seconds;
use crate::sources::{configuration, locate};
use crate::stop::Stop;

pub(crate) fn check(arguments: &CheckArguments) -> Result<ExitCode, Failure> {
    let _stop = Stop::watch()?;
    let configuration = configuration(&arguments.configuration)?;
    let request = request(&arguments.frames);
    let estimate = packing(&configuration, || {
        estimate(&configuration, request.as_ref())
    })
    .map_err(|error| locate(error, &arguments.configuration))?;
    print_report(arguments.json, || &estimate, || in_words(&estimate))
}

pub(super) fn in_words(estimate: &Estimate) -> String {
    let duration = estimate.duration;
    let mut lines = vec![
        format!(
            "grains            {} (volume fraction {:.4}, number density {:.4} d^-3){}",
            estimate.grains,
            estimate.volume_fraction,
            estimate.number_density,
            match estimate.waiting_grains {
                None | Some(0) => String::new(),
                Some(waiting) => format!(", of which {waiting} and those between the ends wait"),
            }
        ),
        format!(
            "wall              {} along {} d",
            match estimate.wall_spheres {
                0 => "smooth".to_owned(),
                spheres => format!("{spheres} spheres"),
            },
            rounded(estimate.length)
        ),
        match (estimate.period, estimate.periods) {
            (Some(period), Some(periods)) => {
                let [duration, periods, period] = [duration, periods, period].map(rounded);
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
            _ => format!(
                "time              {} t, the wave stands still",
                rounded(duration)
            ),
        },
        format!(
            "steps             {} of {} t; a contact lasts about {} t, {} steps",
            estimate.steps,
            significant(estimate.time_step, 4),
            significant(estimate.contact_time, 3),
            significant(estimate.steps_per_contact, 3)
        ),
        format!(
            "restitution       {} of two grains that meet at the speed of the wave",
            significant(estimate.restitution, 3)
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
        let line =
            format!("clear opening     {throat} d at the throats, {belly} d in the bellies{in_mm}");
        lines.insert(2, line);
    }
    if let Some(ratio) = estimate.newtonian_flow_rate_ratio {
        let in_bore = estimate.newtonian_flow_rate_ratio_clear_bore;
        let in_bore = in_bore.map(|ratio| format!(", {ratio:.4} in its clear bore"));
        lines.push(format!(
            "Newtonian fluid   J/Jmax = {ratio:.4} in this tube{}, without load",
            in_bore.unwrap_or_default()
        ));
    }
    if let Some(si) = &estimate.si {
        let (mut wave, mut flow) = (String::new(), String::new());
        if estimate.period.is_some() {
            let [frequency, speed] =
                [si.wave_frequency_hz, si.wave_speed_m_per_s].map(|it| significant(it, 4));
            wave = format!("; a wave of {frequency} Hz, {speed} m/s");
            let largest = significant(si.largest_mass_flow_rate_kg_per_s, 4);
            flow = format!("; at most {largest} kg/s");
        }
        if si.fastest_wave_frequency_hz != si.wave_frequency_hz {
            let frequency = significant(si.fastest_wave_frequency_hz, 4);
            wave += &format!(", by the schedule up to {frequency} Hz");
        }
        lines.push(format!(
            "in SI             d = {} m, m = {} kg, t = {} s{wave}",
            significant(si.unit_length_m, 4),
            significant(si.unit_mass_kg, 4),
            significant(si.unit_time_s, 4)
        ));
        lines.push(format!(
            "                  {} s in steps of {} s{flow}; unit of pressure {} Pa, of power {} W",
            significant(si.duration_s, 4),
            significant(si.time_step_s, 3),
            significant(si.unit_pressure_pa, 4),
            significant(si.unit_power_w, 4)
        ));
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
    }
    let [expected, packing] = [estimate.expected_seconds, estimate.packing_seconds].map(seconds);
    lines.push(format!(
        "expected time     {expected}, after {packing} of packing"
    ));
    let kernel = match estimate.reference_only {
        Some(what) => format!("reference, for it alone computes {what}"),
        None => match estimate.kernel {
            Kernel::Fast => "fast".to_owned(),
            Kernel::Reference => "reference".to_owned(),
        },
    };
    lines.push(format!("kernel            {kernel}"));
    let why = if estimate.reference_only.is_some() || estimate.kernel == Kernel::Reference {
        "the reference kernel takes no more".to_owned()
    } else {
        format!(
            "one for each {SPHERES_OF_A_THREAD} of {} moving spheres, at least one, on {}",
            estimate.moving_spheres,
            counted(processors(), "processor")
        )
    };
    lines.push(format!("threads           {}: {why}", estimate.threads));
    lines.push(format!(
        "memory            at most some {}",
        size(estimate.memory_bytes as u64)
    ));
    if let Some(trajectory) = &estimate.trajectory {
        for (format, bytes) in &trajectory.bytes {
            let (name, size) = (format.file_name(), size(*bytes));
            let frames = counted(trajectory.frames, "frame");
            let every = format!("one every {}", counted(trajectory.interval_steps, "step"));
            lines.push(format!(
                "trajectory        {name} of {frames}, {every}: about {size}"
            ));
        }
    }
    for warning in &estimate.warnings {
        lines.push(format!("warning: {}: {}", warning.key, warning.message));
    }
    lines.join("\n") + "\n"
}
