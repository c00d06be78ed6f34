//! The table of a run's quantities: a quantity is one row here, and `summary.json`, the rows of studies, SI, the
//! labels of the viewer and the documentation follow.

use peristalsis_configuration::{Configuration, ScheduledParameter as Parameter, Units, word};
use peristalsis_observe::Reading::{
    Measured, Optional, OptionalMeasured, Real, Text, Truth, Whole,
};
use peristalsis_observe::{Quantity, Reading};

use super::Summary;
use crate::{REVISION, VERSION};

/// A quantity of a run and where it is written.
#[derive(Debug)]
pub(super) struct RunQuantity {
    pub(super) source: Source,
    /// Key in `summary.json`, after a dot where it stands in an object of its own; empty where it is only in rows.
    pub(super) key: &'static str,
    /// Whether rows of studies have it.
    pub(super) in_rows: bool,
    /// Words or symbol at an axis, without the unit; empty where the name serves.
    pub(super) label: &'static str,
    /// Whether rows of earlier programs lack it.
    pub(super) is_later: bool,
}

/// The origin of a quantity's value.
#[derive(Debug)]
pub(super) enum Source {
    /// The configuration, which decides it alone.
    Setting(Quantity<Configuration>),
    /// The outcome.
    Result(Quantity<Summary>),
}

const fn setting(
    name: &'static str,
    unit: &'static str,
    text: &'static str,
    reading: Reading<Configuration>,
) -> RunQuantity {
    let quantity = Quantity::new(name, unit, text, reading);
    RunQuantity::new(name, Source::Setting(quantity))
}

const fn result(
    name: &'static str,
    unit: &'static str,
    text: &'static str,
    reading: Reading<Summary>,
) -> RunQuantity {
    let quantity = Quantity::new(name, unit, text, reading);
    RunQuantity::new(name, Source::Result(quantity))
}

impl RunQuantity {
    /// Written under its name both in `summary.json` and in rows.
    const fn new(name: &'static str, source: Source) -> Self {
        Self {
            source,
            key: name,
            in_rows: true,
            label: "",
            is_later: false,
        }
    }

    /// Written in `summary.json` under another key.
    const fn at(self, key: &'static str) -> Self {
        Self { key, ..self }
    }

    /// Left out of `summary.json`, beside which the configuration stands.
    const fn only_in_rows(self) -> Self {
        Self { key: "", ..self }
    }

    /// Left out of the rows of studies.
    const fn only_in_summary(self) -> Self {
        Self {
            in_rows: false,
            ..self
        }
    }

    /// Added since rows were first published.
    const fn later(self) -> Self {
        Self {
            is_later: true,
            ..self
        }
    }

    /// With words or a symbol for axes.
    const fn labelled(self, label: &'static str) -> Self {
        Self { label, ..self }
    }
}

/// All quantities, in the order of the columns of rows.
#[rustfmt::skip]
pub(super) const QUANTITIES: &[RunQuantity] = &[
    setting("seed", "1", "seed of the random numbers", Whole(|c| c.run.seed)),
    setting("initial_state", "", "how the grains stood at t = 0", Text(|c| word(c.initial.state))).only_in_rows(),
    result("status", "", "complete; settled: ended early, after its transition; of a run, not of a row: interrupted, or diverged", Text(|s| word(s.status))),
    setting("width", "d", "w = 2 (a - b); missing under stress control", Optional(|c| c.drive.own(Parameter::Width))).only_in_rows().labelled("width w"),
    setting("force_amplitude", "m d/t^2", "f^P; missing under strain control", Optional(|c| c.drive.own(Parameter::ForceAmplitude))).only_in_rows().labelled("force amplitude f"),
    setting("strain_rate", "1/t", "c/lambda", Real(|c| c.drive.strain_rate)).only_in_rows().labelled("strain rate ε̇"),
    setting("volume_fraction", "1", "rho = N/(6 a^2 L), grain volumes averaged", Real(Configuration::volume_fraction)).only_in_rows().labelled("volume fraction ρ"),
    result("number_density", "1", "n = N d*^3/(pi a^2 L), d* the largest diameter", Real(|s| s.configuration.number_density())).only_in_rows().labelled("number density n"),
    setting("grains", "1", "N", Whole(|c| c.grains.number)).labelled("grains"),
    setting("radius", "d", "a, to the centres of the wall spheres", Real(|c| c.tube.radius)).only_in_rows().labelled("radius a"),
    setting("wavelength", "d", "lambda", Real(|c| c.tube.wavelength)).only_in_rows().labelled("wavelength λ"),
    setting("waves", "1", "waves in the tube", Whole(|c| c.tube.waves.into())).only_in_rows().labelled("waves"),
    setting("arrangement", "", "how the wall spheres stand", Text(|c| word(c.tube.arrangement))).only_in_rows(),
    setting("spheres_per_ring", "1", "wall spheres in a ring", Whole(|c| c.tube.spheres_per_ring.into())).only_in_rows().labelled("wall spheres per ring"),
    setting("rings_per_wave", "1", "rings in a wavelength", Whole(|c| c.tube.rings_per_wave.into())).only_in_rows().labelled("rings per wave"),
    result("time", "t", "time reached", Real(|s| s.time)).labelled("time reached"),
    result("periods", "1", "wavelengths that the wave has run", Real(|s| s.periods)).labelled("periods run"),
    result("transition_time", "t", "time of the transition, tau; missing where there was none", Optional(|s| s.transition_time)).labelled("transition time τ"),
    result("censored", "", "whether the run ended before a transition", Truth(|s| s.transition_time.is_none())),
    result("watched", "t", "time up to which a transition is found, 2.5 periods before the end of the last whole one that has a J/Jmax: where a run without one is censored; missing where no transition can be told", Optional(|s| s.watched)).labelled("time watched").later(),
    setting("transition_threshold", "1", "J/Jmax whose crossing counts as the transition", Real(|c| c.observe.transition_threshold)).labelled("threshold of J/Jmax"),
    result("transition_time_10", "t", "time of the transition with the threshold 0.1; missing where there was none", Optional(|s| s.transition_times[0])).only_in_rows().labelled("transition time τ at J/Jmax = 0.1"),
    result("transition_time_20", "t", "time of the transition with the threshold 0.2; missing where there was none", Optional(|s| s.transition_times[1])).only_in_rows().labelled("transition time τ at J/Jmax = 0.2"),
    result("transition_time_30", "t", "time of the transition with the threshold 0.3; missing where there was none", Optional(|s| s.transition_times[2])).only_in_rows().labelled("transition time τ at J/Jmax = 0.3"),
    result("transition_time_40", "t", "time of the transition with the threshold 0.4; missing where there was none", Optional(|s| s.transition_times[3])).only_in_rows().labelled("transition time τ at J/Jmax = 0.4"),
    result("transition_time_50", "t", "time of the transition with the threshold 0.5; missing where there was none", Optional(|s| s.transition_times[4])).only_in_rows().labelled("transition time τ at J/Jmax = 0.5"),
    result("transition_time_60", "t", "time of the transition with the threshold 0.6; missing where there was none", Optional(|s| s.transition_times[5])).only_in_rows().labelled("transition time τ at J/Jmax = 0.6"),
    result("transition_time_70", "t", "time of the transition with the threshold 0.7; missing where there was none", Optional(|s| s.transition_times[6])).only_in_rows().labelled("transition time τ at J/Jmax = 0.7"),
    result("transition_time_80", "t", "time of the transition with the threshold 0.8; missing where there was none", Optional(|s| s.transition_times[7])).only_in_rows().labelled("transition time τ at J/Jmax = 0.8"),
    result("transition_time_90", "t", "time of the transition with the threshold 0.9; missing where there was none", Optional(|s| s.transition_times[8])).only_in_rows().labelled("transition time τ at J/Jmax = 0.9"),
    result("flow_rate_ratio", "1", "late mean of J/Jmax of the grains inside. If the wave changes its speed, or no grain is inside for a while, it is the late mean of J over the late mean of Jmax", Measured(|s| s.flow_rate_ratio)).labelled("J/Jmax, late mean"),
    result("flow_rate_ratio_drift", "1", "late J/Jmax, mean of its second half less that of its first", Real(Summary::flow_rate_ratio_drift)).labelled("drift of J/Jmax"),
    result("flow_rate_ratio_variance", "1", "variance of the late averages of J/Jmax over a period each", Real(Summary::flow_rate_ratio_variance)).labelled("variance of J/Jmax"),
    result("flow_rate_ratio_raw", "1", "late mean of J/Jmax of all grains", Real(|s| s.flow_rate_ratio_raw)).labelled("J/Jmax of all grains"),
    result("flow_rate", "1/t", "late mean of J", Real(Summary::flow_rate)).labelled("flow rate J"),
    result("newtonian_flow_rate_ratio", "1", "J/Jmax of a Newtonian fluid in this tube, phi = b/a", Optional(|s| s.newtonian.map(|fluid| fluid.0))).labelled("J/Jmax of a Newtonian fluid"),
    result("newtonian_flow_rate_ratio_clear_bore", "1", "the same for the clear bore, phi = b/(a - d_w/2)", Optional(|s| s.newtonian.and_then(|fluid| fluid.1))).labelled("J/Jmax of a Newtonian fluid, clear bore"),
    result("escaped", "1", "grains outside the tube at the end", Whole(|s| s.escaped)).labelled("escaped grains"),
    result("escaped_most", "1", "most grains outside the tube at any sample", Whole(|s| s.escaped_most)).labelled("most escaped grains"),
    result("largest_overlap", "d", "largest overlap of a grain's contact at any step", Real(|s| s.largest_overlap)).labelled("largest overlap"),
    result("energy_residual", "1", "|what the energy ledger misses|/(integral of |power of wall and drive| + |work of the body force|)", Real(|s| s.energy_residual)).labelled("energy unaccounted, part"),
    result("granular_temperature", "m d^2/t^2", "late mean of the granular temperature about the mean of the velocities, escaped grains too", Real(|s| s.mean(|sample| sample.granular_temperature))).labelled("granular temperature"),
    result("contacts", "1", "late mean number of contacts of a grain, escaped ones too", Real(|s| s.mean(|sample| sample.contacts))).labelled("contacts of a grain Z"),
    result("wall_power", "m d^2/t^3", "late mean power that wall or drive put into the whole tube", Real(Summary::wall_power)).labelled("power of the wall"),
    result("dissipated_power", "m d^2/t^3", "late mean power lost", Real(|s| s.mean(|sample| sample.dissipated_power))).labelled("dissipated power"),
    result("bottleneck", "d", "late mean of the smallest bottleneck", Real(|s| s.mean(|sample| sample.bottleneck))).labelled("bottleneck w"),
    setting("time_step", "t", "length of a step", Real(|c| c.run.time_step)).labelled("time step"),
    result("steps", "1", "steps done", Whole(|s| s.steps)).labelled("steps"),
    result("body_force", "d/t^2", "force over mass on the grains along the wave, gravity's part with it; negative is back pressure", Real(|s| s.configuration.axial_body_force())).at("pumping.body_force").labelled("body force g"),
    result("pressure_rise", "m/(d t^2)", "pressure rise over a wavelength that the body force stands for, with the mean mass of the distribution of sizes", Real(|s| s.pumping.map_or(0.0, |pumping| pumping.pressure_rise))).at("pumping.pressure_rise").labelled("pressure rise"),
    result("wall_power_error", "m d^2/t^3", "standard error of wall_power", Real(|s| s.late.measured(|sample| sample.wall_power).1)),
    result("useful_power", "m d^2/t^3", "late mean power of the flow against the body force, grains inside", OptionalMeasured(|s| s.pumping.map(|pumping| pumping.useful_power))).at("pumping.useful_power").labelled("useful power"),
    result("pumping_efficiency", "1", "useful power over wall power", OptionalMeasured(|s| s.pumping.map(|pumping| pumping.efficiency))).at("pumping.efficiency").labelled("pumping efficiency"),
    result("wall_normal_force", "m d/t^2", "late mean axial force of the wall on the grains of a wavelength (of an open tube: all grains over the waves) along the normals of contacts", Measured(|s| s.whole.normal_force)).labelled("normal force of the wall"),
    result("wall_tangential_force", "m d/t^2", "the same by friction", Measured(|s| s.whole.tangential_force)).labelled("force of the wall by friction"),
    result("narrow_normal_force", "m d/t^2", "part of wall_normal_force where the tube is narrower than its mean", Measured(|s| s.narrow.normal_force)).labelled("normal force of the wall, narrow part"),
    result("narrow_tangential_force", "m d/t^2", "part of wall_tangential_force there", Measured(|s| s.narrow.tangential_force)).labelled("force of the wall by friction, narrow part"),
    result("narrow_axial_velocity", "d/t", "late mean axial velocity there, laboratory frame: of the mass, not of the number of grains", Measured(|s| s.narrow.axial_velocity)).labelled("axial velocity, narrow part"),
    result("narrow_wall_velocity", "d/t", "late mean axial velocity of the wall's spheres there; 0 for a prescribed wall", Measured(|s| s.narrow.wall_velocity)).labelled("axial velocity of the wall, narrow part"),
    result("front_normal_force", "m d/t^2", "part of wall_normal_force in the front of the wave: in the bins of the profile from that of its narrowest place on (the last of equally narrow ones), up to that of the widest one ahead: without it, or with the first of several that are equally wide", Measured(|s| s.front.normal_force)).labelled("normal force of the wall, front of the wave"),
    result("front_tangential_force", "m d/t^2", "part of wall_tangential_force in the front of the wave", Measured(|s| s.front.tangential_force)).labelled("force of the wall by friction, front of the wave"),
    result("wall_pressure", "m/(d t^2)", "late mean pressure on the wall (of an open tube between its ends), on the area through the centres of its spheres, each bin of the profile alike", Real(|s| s.wall_pressure)).labelled("pressure on the wall"),
    result("wall_pressure_largest", "m/(d t^2)", "largest late mean pressure on the wall over the positions in the wave frame", Real(|s| s.wall_pressure_largest)).labelled("largest pressure on the wall"),
    result("contact_force_99", "m d/t^2", "late mean of the normal force that 99 % of the grains' contacts do not exceed", OptionalMeasured(|s| s.contact_force.map(|force| force.high))).labelled("99 % contact force").later(),
    result("contact_force_largest", "m d/t^2", "largest normal force at a contact of a grain, at the late moments that were looked at", Optional(|s| s.contact_force.map(|force| force.largest))).labelled("largest contact force").later(),
    result("contact_force_moments", "1", "late moments at which the contact forces were looked at", Optional(|s| s.contact_force.map(|force| force.moments as f64))).only_in_summary(),
    result("wall_torque", "m d^2/t^2", "wall_power over 2 pi f, f the frequency of the wave: torque of a shaft that makes one wave a turn; missing for a static wave", OptionalMeasured(|s| s.wall_torque)).labelled("torque of the wall").later(),
    result("wear_power", "m d^2/t^3", "late mean power that grains lose where they slide on the wall, in the whole tube; missing without friction", OptionalMeasured(|s| s.wear.map(|it| it.power))).labelled("power of wear").later(),
    result("wall_wear", "m/t^3", "the same per area of the wall", OptionalMeasured(|s| s.wear.map(|it| it.power_per_area))).labelled("wear of the wall").later(),
    result("axial_mixing", "1", "late mean of Lacey's index of the halves that began in front and behind: 0 apart, 1 at random; missing in an open tube", OptionalMeasured(|s| s.mixed.axial)).labelled("axial mixing").later(),
    result("radial_mixing", "1", "the same of the halves that began near the axis and near the wall", OptionalMeasured(|s| s.mixed.radial)).labelled("radial mixing").later(),
    result("axial_mixing_time", "t", "end of the first period in which axial mixing has come to 1/2; missing where it has not", Optional(|s| s.mixed.axial_time)).labelled("axial mixing time").later(),
    result("radial_mixing_time", "t", "the same of radial mixing", Optional(|s| s.mixed.radial_time)).labelled("radial mixing time").later(),
    result("radial_segregation", "1", "late mean correlation of diameter and radial place: positive where large grains are outside; missing for one size", OptionalMeasured(|s| s.segregated.radial)).labelled("radial segregation").later(),
    result("height_segregation", "1", "late mean correlation of diameter and height: positive where large grains are on top; missing without gravity across", OptionalMeasured(|s| s.segregated.height)).labelled("segregation by height").later(),
    result("belly_segregation", "1", "late mean correlation of diameter and the tube's radius: positive where large grains are in the bellies", OptionalMeasured(|s| s.segregated.belly)).labelled("segregation by position in the wave").later(),
    result("residence_time", "t", "late mean time of a grain through the tube, N/J; missing where the flow is not along the wave, and in an open tube", OptionalMeasured(|s| s.residence_time)).labelled("residence time"),
    result("axial_dispersion", "d^2/t", "half the late rate at which the variance of axial displacements grows from period to period", Measured(|s| s.axial_dispersion)).labelled("axial dispersion"),
    result("late_periods", "1", "length of the late part, in periods of drive.strain_rate; with a static wave in groups of observe.samples_per_period samples", Real(Summary::late_periods)).labelled("late periods"),
    result("throat_density", "1/d", "late mean of the grains per length of tube in about a fifth of the wavelength where it is narrowest", Real(|s| s.throat.density)).at("throat.density").labelled("grains per length, throat"),
    result("throat_axial_velocity", "d/t", "mean over the grains there of the velocity of their bins along the wave", Real(|s| s.throat.axial_velocity)).at("throat.axial_velocity").labelled("axial velocity, throat"),
    result("throat_granular_temperature", "m d^2/t^2", "granular temperature of the bins there, mean over the grains, each about the mean velocity of its bin: the smaller, the fewer grains a bin has", Real(|s| s.throat.granular_temperature)).at("throat.granular_temperature").labelled("granular temperature, throat"),
    result("belly_density", "1/d", "the same where the tube is widest", Real(|s| s.belly.density)).at("belly.density").labelled("grains per length, belly"),
    result("belly_axial_velocity", "d/t", "the same where the tube is widest", Real(|s| s.belly.axial_velocity)).at("belly.axial_velocity").labelled("axial velocity, belly"),
    result("belly_granular_temperature", "m d^2/t^2", "the same where the tube is widest", Real(|s| s.belly.granular_temperature)).at("belly.granular_temperature").labelled("granular temperature, belly"),
    result("back_flow", "1/t", "late mean of -J where J < 0, each J the mean over the interval of a sample: the rate of flow against the wave", Measured(|s| s.back_flow())).labelled("back flow").later(),
    result("pressed", "1", "part of the late samples at which a grain overlaps another or the wall by more than 0.1 d", Real(Summary::pressed)).labelled("part of the samples with a large overlap").later(),
    result("discharge_rate", "m/t", "late mean mass that leaves an open tube through its outlet", OptionalMeasured(|s| s.discharge.map(|it| it.rate))).at("open.discharge_rate").labelled("discharge rate").later(),
    result("return_rate", "m/t", "late mean mass that leaves an open tube through its inlet, against the flow", OptionalMeasured(|s| s.discharge.map(|it| it.return_rate))).at("open.return_rate").labelled("return rate").later(),
    result("hold_up", "m", "late mean mass of the grains between the ends of an open tube", OptionalMeasured(|s| s.discharge.map(|it| it.hold_up))).at("open.hold_up").labelled("hold-up").later(),
    result("discharged", "m", "mass that has left an open tube through its outlet since the start", Optional(|s| s.discharge.map(|it| it.discharged))).at("open.discharged").labelled("mass discharged").later(),
    result("leaked", "m", "mass of the grains that have gone through the wall of an open tube, and past one of its ends, since the start", Optional(|s| s.discharge.map(|it| it.leaked))).at("open.leaked").labelled("mass leaked").later(),
    result("transits", "1", "grains that have gone all the way from the inlet to the outlet in the run", Optional(|s| s.discharge.map(|it| it.passed as f64))).at("open.transits").only_in_summary(),
    result("transit_time", "t", "mean time from the inlet to the outlet of the grains that have gone all the way in the run: too short where the run is not many times longer", OptionalMeasured(|s| s.discharge.map(|it| it.transit_time))).at("open.transit_time").labelled("transit time").later(),
    result("transit_time_variance", "t^2", "variance of that time", Optional(|s| s.discharge.map(|it| it.transit_time_variance))).at("open.transit_time_variance").labelled("variance of the transit time").later(),
    result("refill_efficiency", "1", "volume of the grains discharged in a period over the clear volume of a wavelength (with segments the mean over a period); missing for a static wave", OptionalMeasured(|s| s.discharge?.refill_efficiency)).at("open.refill_efficiency").labelled("refill efficiency").later(),
    result("discharge_rate_si", "kg/s", "discharge_rate in SI; missing without the table units", OptionalMeasured(|s| s.measured_in_si(s.discharge?.rate, Units::mass_flow))).at("si.discharge_rate_kg_per_s").labelled("discharge rate, SI").later(),
    result("mass_flow_rate", "m/t", "late mean mass that flows along the wave, sum m v_z over L, grains inside", Measured(Summary::mass_flow_rate)).labelled("mass flow rate").later(),
    result("mass_flow_rate_si", "kg/s", "mass_flow_rate in SI; missing without the table units", OptionalMeasured(|s| s.mass_flow_rate_in_si())).at("si.mass_flow_rate_kg_per_s").labelled("mass flow rate, SI").later(),
    result("wall_power_si", "W", "wall_power in SI; missing without the table units", Optional(|s| s.in_si(s.wall_power(), Units::power))).at("si.wall_power_w").labelled("power of the wall, SI"),
    result("useful_power_si", "W", "useful_power in SI; missing without the table units", Optional(|s| s.in_si(s.pumping?.useful_power.0, Units::power))).at("si.useful_power_w").labelled("useful power, SI"),
    result("pressure_rise_si", "Pa", "pressure_rise in SI; missing without the table units", Optional(|s| s.in_si(s.pumping.map_or(0.0, |it| it.pressure_rise), Units::pressure))).at("si.pressure_rise_pa").labelled("pressure rise, SI"),
    result("wall_pressure_si", "Pa", "wall_pressure in SI; missing without the table units", Optional(|s| s.in_si(s.wall_pressure, Units::pressure))).at("si.wall_pressure_pa").labelled("pressure on the wall, SI"),
    result("wall_pressure_largest_si", "Pa", "wall_pressure_largest in SI; missing without the table units", Optional(|s| s.in_si(s.wall_pressure_largest, Units::pressure))).at("si.wall_pressure_largest_pa").labelled("largest pressure on the wall, SI"),
    result("contact_force_99_si", "N", "contact_force_99 in SI; missing without the table units", Optional(|s| s.in_si(s.contact_force?.high.0, Units::force))).at("si.contact_force_99_n").labelled("99 % contact force, SI").later(),
    result("contact_force_largest_si", "N", "contact_force_largest in SI; missing without the table units", Optional(|s| s.in_si(s.contact_force?.largest, Units::force))).at("si.contact_force_largest_n").labelled("largest contact force, SI").later(),
    result("wall_torque_si", "N m", "wall_torque in SI; missing without the table units", Optional(|s| s.in_si(s.wall_torque?.0, Units::energy))).at("si.wall_torque_n_m").labelled("torque of the wall, SI").later(),
    result("wear_power_si", "W", "wear_power in SI; missing without the table units", Optional(|s| s.in_si(s.wear?.power.0, Units::power))).at("si.wear_power_w").labelled("power of wear, SI").later(),
    result("wall_wear_si", "W/m^2", "wall_wear in SI; missing without the table units", Optional(|s| s.in_si(s.in_si(s.wear?.power_per_area.0, Units::pressure)?, Units::velocity))).at("si.wall_wear_w_per_m2").labelled("wear of the wall, SI").later(),
    result("return_rate_si", "kg/s", "return_rate in SI", OptionalMeasured(|s| s.measured_in_si(s.discharge?.return_rate, Units::mass_flow))).at("si.return_rate_kg_per_s").only_in_summary(),
    result("hold_up_si", "kg", "hold_up in SI", OptionalMeasured(|s| s.measured_in_si(s.discharge?.hold_up, Units::mass))).at("si.hold_up_kg").only_in_summary(),
    result("transition_time_si", "s", "transition_time in SI", Optional(|s| s.in_si(s.transition_time?, Units::time))).at("si.transition_time_s").only_in_summary(),
    result("residence_time_si", "s", "residence_time in SI", Optional(|s| s.in_si(s.residence_time?.0, Units::time))).at("si.residence_time_s").only_in_summary(),
    result("axial_dispersion_si", "m^2/s", "axial_dispersion in SI", Optional(|s| s.in_si(s.in_si(s.axial_dispersion.0, Units::length)?, Units::velocity))).at("si.axial_dispersion_m2_per_s").only_in_summary(),
    result("time_si", "s", "time in SI", Optional(|s| s.in_si(s.time, Units::time))).at("si.time_s").only_in_summary(),
    setting("wall_spheres", "1", "spheres of the wall", Whole(|c| c.tube.wall_spheres())).only_in_summary(),
    result("grain_steps_per_second", "1/s", "grains times steps over the seconds that engine and observables took", Real(Summary::grain_steps_per_second)).only_in_summary(),
    result("seconds", "s", "seconds that engine and observables took", Real(|s| s.seconds)).only_in_summary(),
    result("version", "", "version of the program", Text(|_| VERSION.to_owned())),
    result("revision", "", "revision of its source", Text(|_| REVISION.to_owned())),
];
