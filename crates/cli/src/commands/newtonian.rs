//! `peristalsis newtonian`

use std::process::ExitCode;

use peristalsis_physics::newtonian::{NewtonianPeristalsis, Trapping};

use crate::arguments::NewtonianArguments;
use crate::commands::{print, print_json};
use crate::failure::Failure;

pub(crate) fn newtonian(arguments: &NewtonianArguments) -> Result<ExitCode, Failure> {
    let (width, radius, pressure) = (arguments.width, arguments.radius, arguments.pressure);
    let fluid = NewtonianPeristalsis::from_width(width, radius, pressure).ok_or_else(|| {
        Failure::usage(
            format!("there is no such tube: width {width}, radius {radius}, pressure {pressure}"),
            "0 <= width <= 2 radius; a finite radius and pressure",
        )
    })?;
    let trapping = fluid.trapping();
    let reflux = fluid.reflux();
    if arguments.json {
        let report = serde_json::json!({
            "amplitude_ratio": fluid.amplitude_ratio(),
            "pressure": fluid.pressure(),
            "flow_rate": fluid.flow_rate(),
            "flow_rate_ratio": fluid.flow_rate_ratio(),
            "zero_flow_pressure": fluid.zero_flow_pressure(),
            "efficiency": fluid.efficiency(),
            "trapped_volume_fraction": trapping.map(|(_, volume)| volume),
            "reflux_volume_fraction": reflux.map(|layer| layer.volume_fraction),
            "reflux_flow_rate": reflux.map(|layer| layer.flow_rate),
        });
        return print_json(&report);
    }
    let trapping = trapping.map_or("none".to_owned(), |(kind, volume)| {
        let kind = match kind {
            Trapping::Bolus => "a bolus on the axis",
            Trapping::Ring => "a ring off the axis",
        };
        format!("{kind}, {:.2} % of the fluid", 100.0 * volume)
    });
    let reflux = reflux.map_or("none".to_owned(), |layer| {
        let (part, flow) = (100.0 * layer.volume_fraction, layer.flow_rate);
        format!(
            "{part:.2} % of the fluid, near the wall, moves back on average: {flow:.4} pi a^2 c"
        )
    });
    let efficiency = fluid.efficiency();
    let efficiency = match efficiency {
        Some(value) => format!("{value:.4}"),
        None if fluid.pressure() == 0.0 => "none: no pressure to pump against".to_owned(),
        None => "none: does not pump".to_owned(),
    };
    let stopping = match fluid.zero_flow_pressure() {
        pressure if pressure.is_finite() => format!("flow stops at {pressure:.5}"),
        _ => "no pressure stops the flow".to_owned(),
    };
    print(&format!(
        "phi = b/a         {:.5}\npressure rise     P = {} ({stopping})\nflow rate         Q = {:.5} pi a^2 c\n\
         J/Jmax            {:.5}\nefficiency        {efficiency}\ntrapping          {trapping}\nreflux            {reflux}\n",
        fluid.amplitude_ratio(),
        fluid.pressure(),
        fluid.flow_rate(),
        fluid.flow_rate_ratio(),
    ))
}
