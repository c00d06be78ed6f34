//! From a configuration to the parts of a simulation.

use glam::DVec3;
use peristalsis_configuration::{
    Configuration, Control, InitialState, ScheduledParameter, WaveformName,
};
use peristalsis_engine::initial::{Packing, PackingReport, diameters, pack_unless, settle};
use peristalsis_engine::wall::{ElasticParameters, ElasticWall, PrescribedWall, Scattered};
use peristalsis_engine::{Bodies, OpenEnds, Parameters, Simulation, Touching, Wall};
use peristalsis_observe::TubeShape;
use peristalsis_physics::newtonian::NewtonianPeristalsis;
use peristalsis_physics::wall::{Arrangement, Lattice, Schedule};

use crate::RunError;
use crate::memory::check_memory;

/// Volume fraction above which packing is not even tried: neighbours would be nearer than half a diameter, and the pairs
/// to relax more than fit in memory.
const LARGEST_VOLUME_FRACTION: f64 = 10.0;

/// Packs the grains and makes the simulation of a configuration, at time 0; `stop` is asked often meanwhile whether to stop.
///
/// # Errors
/// [`RunError::TooManyGrains`] or [`RunError::Engine`] where the grains do not fit, [`RunError::NoMemory`] where there is
/// no room for them; [`RunError::Engine`] where it was asked to stop, too.
pub(crate) fn assemble(
    configuration: &Configuration,
    stop: &dyn Fn() -> bool,
) -> Result<(Simulation, PackingReport), RunError> {
    if configuration.initial.state == InitialState::Placed {
        return Err(RunError::NotPlaced);
    }
    check_number(configuration)?;
    check_memory(configuration)?;
    let wall = walls(configuration);
    let packing = packing(configuration, wall.heading());
    let (bodies, report) = pack_unless(&packing, &wall, configuration.contact.normal, stop)?;
    let parameters = parameters(configuration);
    let (simulation, report) = match configuration.initial.state {
        InitialState::Settled => settle(bodies, wall, parameters, report, stop)?,
        _ => (Simulation::new(bodies, wall, parameters), report),
    };
    let waiting = waiting(&packing, configuration);
    Ok((opened(simulation, configuration, &waiting)?, report))
}

/// How the grains are packed in a tube whose wave heads that way along z.
fn packing(configuration: &Configuration, heading: f64) -> Packing {
    Packing {
        number: packed_grains(configuration),
        sizes: configuration.grains.distribution(),
        state: configuration.initial.state,
        axial_velocity: heading * configuration.initial.axial_velocity,
        temperature: configuration.initial.temperature,
        seed: configuration.run.seed,
    }
}

/// Grains that are in the tube, or between its ends, when it is made.
fn packed_grains(configuration: &Configuration) -> usize {
    let waiting = configuration.inlet.map_or(0, |inlet| inlet.waiting);
    (configuration.grains.number - waiting) as usize
}

/// Diameters of the grains that wait outside, drawn after those of the packed ones \[d\].
fn waiting(packing: &Packing, configuration: &Configuration) -> Vec<f64> {
    diameters(packing, configuration.grains.number as usize).split_off(packing.number)
}

/// The simulation with its ends open, where they are, and with the grains of these diameters that wait.
fn opened(
    simulation: Simulation,
    configuration: &Configuration,
    waiting: &[f64],
) -> Result<Simulation, RunError> {
    let Some(inlet) = configuration.inlet else {
        return Ok(simulation);
    };
    let ends = OpenEnds {
        heading: configuration.heading(),
        inlet,
        seed: configuration.run.seed,
        looks_per_feeding: configuration.looks_per_feeding(),
    };
    Ok(simulation.open(ends, waiting)?)
}

/// Refuses so many grains that packing them is not tried.
pub(crate) fn check_number(configuration: &Configuration) -> Result<(), RunError> {
    let volume_fraction = configuration.volume_fraction();
    if volume_fraction > LARGEST_VOLUME_FRACTION {
        return Err(RunError::TooManyGrains {
            grains: configuration.grains.number,
            volume_fraction,
            limit: LARGEST_VOLUME_FRACTION,
        });
    }
    Ok(())
}

/// Grains where a caller puts them, one entry each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlacedGrains {
    /// Centres; z is taken into \[0, L) \[d\].
    pub positions: Vec<DVec3>,
    /// Velocities \[d/t\].
    pub velocities: Vec<DVec3>,
    /// Diameters \[d\].
    pub diameters: Vec<f64>,
}

/// The simulation of a configuration with grains where they are put, in their order, at time 0. Those that wait outside an
/// open tube have the diameters that they would have behind packed grains.
///
/// # Errors
/// [`RunError::Placement`] for a grain that is not a sphere in the tube, or that overlaps another or the wall by more than
/// half of the smaller diameter.
pub(crate) fn place(
    configuration: &Configuration,
    grains: PlacedGrains,
) -> Result<Simulation, RunError> {
    let refused = |reason: String| Err(RunError::Placement { reason });
    let PlacedGrains {
        positions,
        velocities,
        diameters,
    } = grains;
    let number = packed_grains(configuration);
    if [positions.len(), velocities.len(), diameters.len()] != [number; 3] {
        return refused(format!(
            "{number} grains are to be placed, and there are {} positions, {} velocities and {} diameters",
            positions.len(),
            velocities.len(),
            diameters.len()
        ));
    }
    let is_sphere = |grain: &usize| {
        let (position, velocity) = (positions[*grain], velocities[*grain]);
        position.is_finite() && velocity.is_finite() && diameters[*grain] > 0.0
    };
    if let Some(grain) = (0..number).find(|grain| !is_sphere(grain)) {
        return refused(format!(
            "grain {grain} has position {}, velocity {} and diameter {}, not all of them possible",
            positions[grain], velocities[grain], diameters[grain]
        ));
    }
    check_memory(configuration)?;
    let wall = walls(configuration);
    let mut bodies = Bodies::grains_at_rest(positions, diameters);
    bodies.velocity = velocities;
    wall.append_spheres(&mut bodies);
    let simulation = Simulation::new(bodies, wall, parameters(configuration));
    check_places(&simulation, configuration.tube.arrangement.has_spheres())?;
    let waiting = waiting(
        &packing(configuration, configuration.heading()),
        configuration,
    );
    opened(simulation, configuration, &waiting)
}

/// Refuses grains outside the tube, and those that share most of their place with another sphere; a smooth wall has none.
fn check_places(simulation: &Simulation, wall_has_spheres: bool) -> Result<(), RunError> {
    let refused = |reason: String| Err(RunError::Placement { reason });
    let (bodies, shape) = (simulation.bodies(), TubeShape::of(simulation));
    for (grain, position) in bodies.position[..bodies.grains].iter().enumerate() {
        let (radius, from_axis) = (
            shape.radius(position.z),
            libm::hypot(position.x, position.y),
        );
        if from_axis > radius {
            return refused(format!(
                "grain {grain} at {position} is outside the tube: it is {from_axis:.4} d from the axis, where the radius is \
                 {radius:.4} d"
            ));
        }
    }
    for Touching {
        first,
        second,
        overlap,
        ..
    } in simulation.touching()
    {
        let diameter = |sphere: usize| bodies.diameter.get(sphere).copied();
        let of_wall = match wall_has_spheres {
            true => simulation.wall().sphere_diameter(),
            false => f64::INFINITY,
        };
        let [one, other] = [first, second].map(|sphere| diameter(sphere).unwrap_or(of_wall));
        if first < bodies.grains && overlap > 0.5 * one.min(other) {
            let partner = match second < bodies.grains {
                true => format!("grain {second}"),
                false => "the wall".to_owned(),
            };
            return refused(format!(
                "grain {first} and {partner} overlap by {overlap:.4} d, more than half of a diameter"
            ));
        }
    }
    let same = |pair: &[(usize, DVec3)]| pair[0].1 == pair[1].1;
    let mut places: Vec<(usize, DVec3)> = bodies.position[..bodies.grains]
        .iter()
        .copied()
        .enumerate()
        .collect();
    places.sort_by(|one, other| {
        let key = |it: &(usize, DVec3)| it.1.to_array();
        key(one)
            .partial_cmp(&key(other))
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    match places.windows(2).find(|pair| same(pair)) {
        Some(pair) => refused(format!(
            "grains {} and {} are at the same place",
            pair[0].0, pair[1].0
        )),
        None => Ok(()),
    }
}

/// How the engine computes a configuration.
pub(crate) fn parameters(configuration: &Configuration) -> Parameters {
    Parameters {
        contact: configuration.contact,
        integrator: configuration.run.integrator,
        time_step: configuration.run.time_step,
        skin: configuration.run.neighbour_skin,
        kernel: configuration.run.kernel,
        body_force: DVec3::from_array(configuration.body.gravity)
            + configuration.heading() * configuration.drive.body_force * DVec3::Z,
    }
}

/// The wall of a configuration, at time 0.
pub fn walls(configuration: &Configuration) -> Wall {
    let Configuration {
        tube, drive, wall, ..
    } = configuration;
    let lattice = Lattice {
        spheres_per_ring: tube.spheres_per_ring,
        rings_per_wave: tube.rings_per_wave,
        waves: tube.waves,
        wavelength: tube.wavelength,
        sphere_diameter: wall.sphere_diameter,
        staggered: tube.arrangement != Arrangement::Aligned,
    };
    let heading = configuration.heading();
    let schedule = |parameter, constant| schedule(configuration, parameter, constant);
    let frequency = frequency(configuration);
    match drive.control {
        Control::Strain { width } => {
            let widths = schedule(ScheduledParameter::Width, width);
            let amplitude = widths.map(|width| tube.radius - 0.5 * width);
            let (radius, contraction) = (tube.radius, drive.contraction());
            let wall =
                PrescribedWall::new(lattice, radius, contraction, heading, amplitude, frequency);
            Wall::Prescribed(match tube.arrangement {
                Arrangement::Staggered | Arrangement::Aligned => wall,
                Arrangement::Random => {
                    wall.with(Scattered::random(&lattice, tube.arrangement_seed))
                }
                Arrangement::Disordered => wall.with(Scattered::disordered(
                    &lattice,
                    radius,
                    tube.arrangement_seed,
                )),
                Arrangement::Smooth => wall.smooth(),
                Arrangement::File => {
                    let angles = tube.angles.iter().copied();
                    let places = tube.places.iter().copied();
                    wall.with(Scattered::at(&lattice, angles.zip(places).collect()))
                }
            })
        }
        Control::Stress {
            force_amplitude,
            angle,
        } => Wall::Elastic(ElasticWall::new(ElasticParameters {
            lattice,
            mean_radius: tube.radius,
            network: wall.elastic.unwrap_or_default(),
            force_amplitude: schedule(ScheduledParameter::ForceAmplitude, force_amplitude),
            frequency,
            heading,
            // Segments are under strain control.
            waveform: drive.waveform.travelling().unwrap_or_default(),
            angle,
        })),
    }
}

/// c/lambda in time \[1/t\].
pub(crate) fn frequency(configuration: &Configuration) -> Schedule {
    let own = configuration.drive.strain_rate;
    schedule(configuration, ScheduledParameter::StrainRate, own)
}

/// A drive parameter in time: as scheduled, or constant.
fn schedule(
    configuration: &Configuration,
    parameter: ScheduledParameter,
    constant: f64,
) -> Schedule {
    let Some(scheduled) = configuration.drive.schedule(parameter) else {
        return Schedule::constant(constant);
    };
    // Schedules are in periods of the drive's own strain rate.
    let period = configuration.drive.period().unwrap_or(1.0);
    let knots = scheduled.knots().into_iter();
    let knots = knots.map(|(periods, value)| (periods * period, value));
    Schedule::through(knots.collect())
        .expect("a validated schedule has finite knots in order of time")
}

/// Wavelengths that the wave runs, where a schedule changes its rate; `None` elsewhere. `run.periods` counts periods of
/// drive.strain_rate, and then says another number.
pub fn scheduled_wavelengths(configuration: &Configuration) -> Option<f64> {
    configuration
        .drive
        .schedule(ScheduledParameter::StrainRate)?;
    Some(frequency(configuration).integral(configuration.run.duration))
}

/// The Newtonian fluid in a strain-controlled tube of the same amplitude: (phi = b/a, phi = b/(a - d_w/2)), J/Jmax without
/// pressure rise, whatever the body force, for the load of a fluid counts against a viscosity, which grains do not have; the
/// second is missing where the clear bore closes. `None` under stress control, where the width follows a schedule, for a
/// static wave and for waveforms other than the sine.
pub(crate) fn newtonian_reference(configuration: &Configuration) -> Option<(f64, Option<f64>)> {
    let drive = &configuration.drive;
    let changes = drive.schedule(ScheduledParameter::Width).is_some();
    if changes || drive.waveform != WaveformName::Sine || drive.period().is_none() {
        return None;
    }
    let amplitude = configuration.amplitude()?;
    let ratio = |radius: f64| {
        NewtonianPeristalsis::free_pumping(amplitude / radius).map(|fluid| fluid.flow_rate_ratio())
    };
    let radius = configuration.tube.radius;
    let bore = radius - 0.5 * configuration.wall.sphere_diameter;
    let clear = if bore > 0.0 { ratio(bore) } else { None };
    ratio(radius).map(|here| (here, clear))
}
