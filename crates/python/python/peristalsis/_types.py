"""Types of keywords and of summaries. Made by scripts/python_types.py from schemas and the table of quantities."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, SupportsIndex, TypedDict

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    #: Names of the presets.
    _Preset = Literal["frictionless", "frictionless-source", "frictionless-fine", "frictional", "sand-pump", "soft-robot", "silo", "oesophagus"]


class Keywords(TypedDict, total=False):
    """Keywords of a configuration: the last word of a key, or the whole of it with ``_`` for its dots.

    Examples
    --------
    >>> import peristalsis
    >>> keywords: peristalsis.Keywords = {"width": 2.6, "initial_state": "jammed"}
    >>> peristalsis.Configuration("frictionless", **keywords)["initial.state"]
    'jammed'
    """

    acceleration: Sequence[float] | npt.NDArray[Any]
    """units.acceleration. Gravity [x, y, z] in SI, instead of body.gravity: [0, -9.81, 0] is a horizontal tube on
    Earth. (Unit: m s^-2.)"""
    amplitude: float
    """drive.amplitude. Amplitude b of the radius R = a + b g((c t + z)/lambda), g the waveform, at most a; strain
    control. (Unit: d.)"""
    angle: Literal["reference", "current"]
    """drive.angle. Angle that fixes the radial direction of the force on a wall sphere; stress control."""
    angles: Sequence[float] | npt.NDArray[Any]
    """tube.angles. Angle of each wall sphere about the axis, from x towards y; under arrangement = "file". (Unit:
    rad.)"""
    arrangement: Literal["staggered", "aligned", "random", "disordered", "file", "smooth"]
    """tube.arrangement. How the wall spheres stand."""
    arrangement_seed: SupportsIndex
    """tube.arrangement_seed. Seed of a random or disordered arrangement. (A pure number.)"""
    axial: float
    """wall.keep.axial. Stiffness of the axial tether of a wall sphere to its place. (Unit: m t^-2.)"""
    axial_velocity: float
    """initial.axial_velocity. Velocity of every grain along the wave at t = 0. Default: 0 from rest, the wave's
    speed at t = 0 from jammed. (Unit: d t^-1.)"""
    azimuthal: float
    """wall.keep.azimuthal. Stiffness of the azimuthal tether of a wall sphere to its place. (Unit: m t^-2.)"""
    balance: bool
    """wall.keep.balance. Whether a constant force on each wall sphere balances the springs in the straight tube."""
    body_force: float
    """drive.body_force. Body force g on the grains, force over mass along the wave. Negative is back pressure,
    against which the wave has to pump. body.gravity adds to it. Both together stand for a pressure rise over a
    wavelength of N m (-g) lambda/(L pi a^2). (Unit: d t^-2.)"""
    body_gravity: Sequence[float] | npt.NDArray[Any]
    cohesion_range: float
    """contact.cohesion_range. Gap between surfaces at which linear cohesion ends; 0: it acts between spheres that
    overlap. (Unit: d.)"""
    contact_cohesion_force: float
    """contact.cohesion_force. Linear cohesion: the force f_c that parts two grains of diameter 1; for others 4 R_ij
    f_c, R_ij the reduced radius. 0: none. (Unit: m d t^-2.)"""
    contact_cohesion_range: float
    contact_dissipation_form: Literal["printed", "viscoelastic"]
    contact_dissipation_time: float
    contact_kinetic_friction: float
    contact_law: Literal["linear", "hertz"]
    contact_normal_damping: float
    contact_normal_stiffness: float
    contact_poisson_ratio: float
    contact_pull_off: Literal["displacement", "force"]
    contact_range: float
    """wall.contact_range. Wall spheres whose places in the straight tube are farther apart than this repel on
    contact, so that opposite sides of a throat do not pass through each other; stress control. (Unit: d.)"""
    contact_restitution: float
    contact_restitution_speed: float
    contact_rolling_damping: float
    contact_rolling_friction: float
    contact_rolling_stiffness: float
    contact_sliding: Literal["spring", "balance", "literal"]
    contact_static_friction: float
    contact_surface_energy: float
    """contact.surface_energy. Surface energy gamma of JKR cohesion, half the work of adhesion: the force that parts
    two spheres is 3 pi gamma R_ij, R_ij the reduced radius. Needs the Hertz law. 0: none. Softer grains than the
    real ones stick in faster impacts: gamma/Y^(2/5) kept as it is keeps the speed up to which they stick, gamma
    alone the pull-off force. (Unit: m t^-2.)"""
    contact_tangential_damping: float
    contact_tangential_stiffness: float
    contact_young_modulus: float
    """contact.young_modulus. Young's modulus Y of the Hertz law, f_n = 2 Y sqrt(R)/(3 (1 - nu^2)) (xi^(3/2) - B
    sqrt(xi) v_n); B is 3 A/2, or A where dissipation_form is "printed". (Unit: m d^-1 t^-2.)"""
    control: Literal["strain", "stress"]
    """drive.control. Whether the radius of the wall is prescribed (strain) or the radial force on its spheres
    (stress)."""
    density: float
    """units.density. Density of the grains' material. The unit of mass is m = pi density d^3/6. (Unit: kg m^-3.)"""
    diameter_max: float
    """grains.diameter_max. Largest grain diameter, not below diameter_min. Of a table its largest. (Unit: d.)"""
    diameter_median: float
    """grains.diameter_median. Median of lognormal diameters. Default: the geometric mean of diameter_min and
    diameter_max. (Unit: d.)"""
    diameter_min: float
    """grains.diameter_min. Smallest grain diameter. The mass of a grain is its diameter cubed. Of a table its
    least. (Unit: d.)"""
    diameter_spread: float
    """grains.diameter_spread. Standard deviation of ln d of lognormal diameters. (A pure number.)"""
    diameters: Sequence[float] | npt.NDArray[Any]
    """grains.diameters. Diameters under sizes = "table". (Unit: d.)"""
    direction: Literal["forward", "backward"]
    """drive.direction. Which way the wave runs: forward is towards -z under strain control and towards +z under
    stress control, as the source writes them. Flow rates are positive along the wave in either case."""
    dissipation_form: Literal["printed", "viscoelastic"]
    """contact.dissipation_form. Factor of the damping of the Hertz law: 1 as printed, 3/2 for the standard
    viscoelastic sphere."""
    dissipation_time: float
    """contact.dissipation_time. Dissipation time A of the Hertz law. (Unit: t.)"""
    drag: float
    """wall.drag. Drag coefficient of a wall sphere against the laboratory, force -drag v; stress control. (Unit: m
    t^-1.)"""
    drive_amplitude: float
    drive_angle: Literal["reference", "current"]
    drive_body_force: float
    drive_control: Literal["strain", "stress"]
    drive_direction: Literal["forward", "backward"]
    drive_duty: float
    drive_edge: float
    drive_fall: float
    drive_force_amplitude: float
    drive_order: Sequence[int] | npt.NDArray[Any]
    drive_phases: Sequence[float] | npt.NDArray[Any]
    drive_radii: Sequence[float] | npt.NDArray[Any]
    drive_ramp_periods: float
    drive_rise: float
    drive_schedule: Literal["sudden", "ramp"] | Mapping[str, Any] | Sequence[Mapping[str, Any]]
    drive_segments: SupportsIndex
    drive_strain_rate: float
    drive_table: str
    drive_wave_speed: float
    drive_waveform: Literal["sine", "bolus", "roller", "table", "segments"]
    drive_width: float
    duration: float
    """run.duration. Length of the run in time, rounded up to whole samples; the only choice for a static wave.
    (Unit: t.)"""
    duty: float
    """drive.duty. Part of the period for which a segment is closed; duty + rise + fall is at most 1; waveform =
    "segments". (Unit: periods.)"""
    edge: float
    """drive.edge. Length over which one segment goes over into the next, in lengths of a segment; waveform =
    "segments". (A pure number.)"""
    ends: Literal["periodic", "open"]
    """tube.ends. How the tube ends."""
    fall: float
    """drive.fall. Part of the period in which a segment opens; waveform = "segments". (Unit: periods.)"""
    force_amplitude: float
    """drive.force_amplitude. Amplitude f^P of the radial force on each wall sphere; stress control. (Unit: m d
    t^-2.)"""
    fractions: Sequence[float] | npt.NDArray[Any]
    """grains.fractions. Part of the grains, by number, of each of the diameters; they need not add up to 1. (A pure
    number.)"""
    grain_diameter: float
    """units.grain_diameter. The unit of length d: diameter of a grain whose diameter is 1 in the other tables.
    (Unit: m.)"""
    grains_diameter_max: float
    grains_diameter_median: float
    grains_diameter_min: float
    grains_diameter_spread: float
    grains_diameters: Sequence[float] | npt.NDArray[Any]
    grains_file: str
    """grains.file. Table of the diameters under sizes = "table", instead of diameters and fractions: CSV with the
    columns diameter and fraction (by number), one size per line. Its path is relative to the configuration file,
    with --set to where the program runs."""
    grains_fractions: Sequence[float] | npt.NDArray[Any]
    grains_large_fraction: float
    grains_large_volume_fraction: float
    grains_number: SupportsIndex
    grains_number_density: float
    grains_sizes: Literal["uniform", "lognormal", "two", "table"]
    grains_volume_fraction: float
    gravity: Sequence[float] | npt.NDArray[Any]
    """body.gravity. Gravity [x, y, z] on the grains. z is the tube's axis, whichever way the wave runs; x and y lie
    across it: [0, -0.001, 0] is a horizontal tube, [0, 0, -0.001] an upright one. The wall has no weight.
    drive.body_force adds to it; units.acceleration gives it in SI. (Unit: d t^-2.)"""
    head: float
    """inlet.head. Length of the tube before the outlet that the inlet keeps filled: grains are put in at its far
    end, as soon as there is place. Default: the whole tube. (Unit: d.)"""
    initial_axial_velocity: float
    initial_state: Literal["rest", "settled", "jammed", "placed"]
    initial_temperature: float
    inlet_feed_rate: float
    """inlet.feed_rate. Grains put in per time, as far as there is place for them. Default: as many as find a place
    each time that the wave has run one d, or every 2 t where it stands. (Unit: t^-1.)"""
    inlet_head: float
    inlet_length: float
    inlet_velocity: float
    inlet_waiting: SupportsIndex
    integrator: Literal["verlet", "adams_bashforth"]
    """run.integrator. How the equations of motion are stepped."""
    kernel: Literal["fast", "reference"]
    """run.kernel. Which kernel computes the forces."""
    kinetic_friction: float
    """contact.kinetic_friction. Kinetic friction mu_k, not above static_friction. If only static_friction is given,
    equal to it. (A pure number.)"""
    large_fraction: float
    """grains.large_fraction. Part of the grains, by number, that have diameter_max under sizes = "two"; the others
    have diameter_min. (A pure number.)"""
    large_volume_fraction: float
    """grains.large_volume_fraction. Part of the volume of all grains that the grains of diameter_max have, instead
    of large_fraction. (A pure number.)"""
    late_fraction: float
    """observe.late_fraction. Part of the run, at its end, over which late means and profiles are taken. (A pure
    number.)"""
    law: Literal["linear", "hertz"]
    """contact.law. Normal contact law. It takes the keys that name it; friction goes with every law."""
    length: float
    """inlet.length. Length of the stretch in which grains are put in, at the end of the head that is farther from
    the outlet. Default: 3 largest diameters. (Unit: d.)"""
    material: Literal["glass", "sand", "steel", "pmma", "tablet"]
    """units.material. What the grains are made of: stands for units.density, contact.static_friction and
    kinetic_friction, the restitution (contact.restitution), and under contact.law = "hertz" for
    contact.poisson_ratio and units.young_modulus. They replace the values of a preset, except a Young's modulus.
    Values that the same file gives, or a later setting, replace them. Grains as hard as the material take long:
    give a smaller modulus."""
    natural_length: float
    """wall.natural_length. Natural length l of these springs; stress control. Default: 0.7 of the mean distance of
    lattice neighbours. An unstretched network buckles: keep it below the distance of neighbours. (Unit: d.)"""
    neighbour_skin: float
    """run.neighbour_skin. How much farther the neighbour search looks than contacts reach. It changes speed and
    rounding, not the physics. Default: 0.3 of the largest grain diameter. (Unit: d.)"""
    net_force: Literal["free", "removed", "removed_per_ring"]
    """wall.keep.net_force. What is done with the mean force on the wall at each step."""
    normal_damping: float
    """contact.normal_damping. Damping eta of the linear law. (Unit: m t^-1.)"""
    normal_stiffness: float
    """contact.normal_stiffness. Stiffness k of the linear law, f_n = k xi - eta v_n. (Unit: m t^-2.)"""
    number: SupportsIndex
    """grains.number. Number of grains N in the whole tube. (A pure number.)"""
    number_density: float
    """grains.number_density. Number density n = N d*^3/(pi a^2 L), d* the largest grain diameter; N is rounded to
    the nearest whole number. (A pure number.)"""
    observe_late_fraction: float
    observe_profile_bins: SupportsIndex
    observe_samples_per_period: SupportsIndex
    observe_transition_threshold: float
    order: Sequence[int] | npt.NDArray[Any]
    """drive.order. The segments in the order in which they close, counted from 1 along the wave, each once;
    waveform = "segments". Default: one after the other along the wave. (A pure number.)"""
    periods: float
    """run.periods. Length of the run in periods of drive.strain_rate, rounded up to whole samples. Where a schedule
    changes the strain rate, the wave runs more or fewer wavelengths (column period). (Unit: periods.)"""
    phases: Sequence[float] | npt.NDArray[Any]
    """drive.phases. Phases of the points of waveform = "table" in cycles, ascending from 0 on; 3 to 128 of them. (A
    pure number.)"""
    places: Sequence[float] | npt.NDArray[Any]
    """tube.places. Place z of each wall sphere along the tube, from 0 to below L; under arrangement = "file".
    (Unit: d.)"""
    poisson_ratio: float
    """contact.poisson_ratio. Poisson's ratio nu of the Hertz law. (A pure number.)"""
    profile_bins: SupportsIndex
    """observe.profile_bins. Bins of the profiles over one wavelength. The largest pressure on the wall is the
    largest of any bin: it grows with the number of bins. (A pure number.)"""
    pull_off: Literal["displacement", "force"]
    """contact.pull_off. Where the neck of a JKR contact breaks."""
    radial: float
    """wall.keep.radial. Stiffness of the radial tether of a wall sphere to its place. (Unit: m t^-2.)"""
    radii: Sequence[float] | npt.NDArray[Any]
    """drive.radii. Radius at each phase. Only the shape counts: the largest becomes tube.radius, the least half of
    drive.width. (A pure number.)"""
    radius: float
    """tube.radius. Radius a of the tube, to the centres of the wall spheres: the mean one of a sine, the largest of
    other waveforms. The wall's surface, also of a smooth wall, lies half of wall.sphere_diameter inside it. (Unit:
    d.)"""
    ramp_periods: float
    """drive.ramp_periods. Length of the ramp of schedule = "ramp", in wave periods. (Unit: periods.)"""
    restitution: float
    """contact.restitution. Restitution e of two grains of the mean diameter that meet head-on. Give it instead of
    normal_damping (linear law) or dissipation_time (Hertz law), which then follow. Linear law: e = exp(-pi
    beta/sqrt(k/m_ij - beta^2)), beta = eta/(2 m_ij), at any speed. Hertz law: by integration of an impact at
    restitution_speed; e falls with the speed. Cohesion is left out of it: with cohesion impacts give back less, and
    slow grains stick. (A pure number.)"""
    restitution_speed: float
    """contact.restitution_speed. Relative speed at which restitution holds under the Hertz law. Default: the speed
    of the wave. Give it in a study of several strain rates, or each has its own material. A static wave needs it.
    (Unit: d t^-1.)"""
    rings_per_wave: SupportsIndex
    """tube.rings_per_wave. Rings in a wavelength. Staggered rings under strain control need an even number; under
    stress control an odd number needs an even number of waves. Random and disordered walls have as many spheres as
    so many rings would have; a wall from a file does not use it. A smooth wall has none: there the key is left out,
    and results show 0. (A pure number.)"""
    rise: float
    """drive.rise. Part of the period in which a segment closes; waveform = "segments". (Unit: periods.)"""
    rolling_damping: float
    """contact.rolling_damping. Damping eta_r of rolling. Without effect while rolling_friction is 0. (Unit: m
    t^-1.)"""
    rolling_friction: float
    """contact.rolling_friction. Rolling friction mu_r: the couple that resists rolling is at most mu_r f_n R_ij,
    R_ij the reduced radius. On a plane a sphere rolls where the slope is steeper than mu_r. 0: rolling is free.
    Needs friction. (A pure number.)"""
    rolling_stiffness: float
    """contact.rolling_stiffness. Stiffness k_r of the rolling spring, which takes a couple k_r R_ij^2 for each
    radian. Without effect while rolling_friction is 0. (Unit: m t^-2.)"""
    run_duration: float
    run_integrator: Literal["verlet", "adams_bashforth"]
    run_kernel: Literal["fast", "reference"]
    run_neighbour_skin: float
    run_periods: float
    run_seed: SupportsIndex | np.random.Generator
    run_time_step: float
    samples_per_period: SupportsIndex
    """observe.samples_per_period. Samples of the time series in one period of the wave; with a static wave, 200 in
    the whole run. Beyond 262,144 samples every two neighbours become one, so that memory is bounded. (A pure
    number.)"""
    schedule: Literal["sudden", "ramp"] | Mapping[str, Any] | Sequence[Mapping[str, Any]]
    """drive.schedule. How parameters of the drive follow time. "sudden": constant from t = 0. "ramp": the amplitude
    grows from nothing within ramp_periods. Or a table such as { form = "ramp", parameter = "width", from = 3.0, to
    = 2.6, end = 100 } or { form = "steps", parameter = "width", at = [0, 100], values = [2.9, 2.7] }; with form =
    "course" straight lines lead from value to value. Or a list of such tables, one for each parameter."""
    seed: SupportsIndex | np.random.Generator
    """run.seed. Seed of the random numbers of the grains: their places, diameters, initial temperature and choice
    of place at an inlet. (A pure number.)"""
    segments: SupportsIndex
    """drive.segments. Number n of segments in a wavelength; waveform = "segments". (A pure number.)"""
    sizes: Literal["uniform", "lognormal", "two", "table"]
    """grains.sizes. How diameters are distributed, by number, from diameter_min to diameter_max."""
    sliding: Literal["spring", "balance", "literal"]
    """contact.sliding. How the tangential displacement changes while a contact slides. Without effect while both
    frictions are 0."""
    sphere_diameter: float
    """wall.sphere_diameter. Diameter d_w of a wall sphere. The surface of the wall lies d_w/2 inside the tube's
    radius, so that the clear opening of the bottleneck is w - d_w. Under arrangement = "smooth" it is the same
    offset, and may be 0. (Unit: d.)"""
    sphere_mass: float
    """wall.sphere_mass. Mass of a wall sphere; stress control. (Unit: m.)"""
    spheres_per_ring: SupportsIndex
    """tube.spheres_per_ring. Wall spheres in a ring. A smooth wall has none: there the key is left out, and results
    show 0. (A pure number.)"""
    spring_damping: float
    """wall.spring_damping. Damping of each spring along its length; stress control. (Unit: m t^-1.)"""
    spring_stiffness: float
    """wall.spring_stiffness. Stiffness k_w of the spring between lattice neighbours; stress control. (Unit: m
    t^-2.)"""
    state: Literal["rest", "settled", "jammed", "placed"]
    """initial.state. How the grains stand at t = 0: spread over the tube at rest, settled under gravity, or
    gathered in the bellies and moving with the wave. Only a program can place them otherwise."""
    static_friction: float
    """contact.static_friction. Static friction mu_s: a contact sticks while |f_t| < mu_s f_n. If only
    kinetic_friction is given, equal to it; with both 0 grains are frictionless and do not rotate. (A pure
    number.)"""
    stiffness: float
    """units.stiffness. Stiffness of a contact in SI. With contact.normal_stiffness it fixes the unit of time,
    sqrt(m/k) for k = 1. (Unit: N m^-1.)"""
    strain_rate: float
    """drive.strain_rate. Strain rate c/lambda, one over the wave's period; 0 is a static wave and needs
    run.duration. (Unit: t^-1.)"""
    table: str
    """drive.table. Table of waveform = "table" instead of phases and radii: CSV with the columns phase (cycles) and
    radius, one point per line. Its path is relative to the configuration file, with --set to where the program
    runs."""
    tangential_damping: float
    """contact.tangential_damping. Tangential damping eta_t. Without effect while both frictions are 0. (Unit: m
    t^-1.)"""
    tangential_stiffness: float
    """contact.tangential_stiffness. Tangential stiffness k_t, f_t = -k_t u - eta_t v_t below the Coulomb limit.
    Without effect while both frictions are 0. (Unit: m t^-2.)"""
    temperature: float
    """initial.temperature. Granular temperature at t = 0: besides the velocity along the wave every component of a
    grain's velocity is drawn from a normal distribution of variance temperature/mass. (Unit: m d^2 t^-2.)"""
    time_step: float
    """run.time_step. Largest time step allowed. The step is chosen so that a whole number of steps lies between two
    samples. (Unit: t.)"""
    transition_threshold: float
    """observe.transition_threshold. J/Jmax that the average over a period crosses at a transition. From rest
    (J/Jmax = 0) it is crossed upward, or downward if it is below 0; from jammed (J/Jmax = 1) downward, or upward if
    it is above 1. (A pure number.)"""
    tube_angles: Sequence[float] | npt.NDArray[Any]
    tube_arrangement: Literal["staggered", "aligned", "random", "disordered", "file", "smooth"]
    tube_arrangement_seed: SupportsIndex
    tube_ends: Literal["periodic", "open"]
    tube_file: str
    """tube.file. Table of the wall spheres under arrangement = "file", instead of angles and places: CSV with the
    columns angle (rad) and place (d), one sphere per line. Its path is relative to the configuration file, with
    --set to where the program runs."""
    tube_places: Sequence[float] | npt.NDArray[Any]
    tube_radius: float
    tube_rings_per_wave: SupportsIndex
    tube_spheres_per_ring: SupportsIndex
    tube_wavelength: float
    tube_waves: SupportsIndex
    units_acceleration: Sequence[float] | npt.NDArray[Any]
    units_cohesion_force: float
    """units.cohesion_force. The force that parts two grains of diameter 1 under linear cohesion, instead of
    contact.cohesion_force. (Unit: N.)"""
    units_density: float
    units_feed_rate: float
    """units.feed_rate. Mass that the inlet of an open tube takes in an hour, instead of inlet.feed_rate. (Unit: kg
    h^-1.)"""
    units_grain_diameter: float
    units_material: Literal["glass", "sand", "steel", "pmma", "tablet"]
    units_stiffness: float
    units_surface_energy: float
    """units.surface_energy. Surface energy gamma of JKR cohesion, half the work of adhesion, instead of
    contact.surface_energy. Dry glass has some 0.05; grains that are softer in the computation than in reality cling
    more. (Unit: J m^-2.)"""
    units_wave_frequency: float
    units_young_modulus: float
    """units.young_modulus. Young's modulus in SI. With contact.young_modulus it fixes the unit of time, sqrt(m/(Y
    d)) for Y = 1. (Unit: Pa.)"""
    velocity: float
    """inlet.velocity. Velocity towards the outlet with which grains are put in. (Unit: d t^-1.)"""
    volume_fraction: float
    """grains.volume_fraction. Volume fraction rho = N d^3/(6 a^2 L) of grains in a straight tube of radius a and
    length L, d^3 averaged over the diameters; N is rounded to the nearest whole number. (A pure number.)"""
    waiting: SupportsIndex
    """inlet.waiting. How many of the grains wait outside at t = 0. Those that are packed into the gap of 4
    diameters between the ends wait as well. (A pure number.)"""
    wall_contact_range: float
    wall_drag: float
    wall_keep_axial: float
    wall_keep_azimuthal: float
    wall_keep_balance: bool
    wall_keep_net_force: Literal["free", "removed", "removed_per_ring"]
    wall_keep_radial: float
    wall_natural_length: float
    wall_sphere_diameter: float
    wall_sphere_mass: float
    wall_spring_damping: float
    wall_spring_stiffness: float
    wave_frequency: float
    """units.wave_frequency. Frequency of the wave, c/lambda. Give it instead of drive.strain_rate or
    drive.wave_speed: with those the wave in SI gets faster when stiffness or young_modulus grows. (Unit: Hz.)"""
    wave_speed: float
    """drive.wave_speed. Speed c of the wave; 0 is a static wave and needs run.duration. (Unit: d t^-1.)"""
    waveform: Literal["sine", "bolus", "roller", "table", "segments"]
    """drive.waveform. Shape of the wave."""
    wavelength: float
    """tube.wavelength. Wavelength lambda. (Unit: d.)"""
    waves: SupportsIndex
    """tube.waves. Number of waves in the tube; its length is L = waves * wavelength. (A pure number.)"""
    width: float
    """drive.width. Width of the bottleneck w = 2 (a - b) between the centres of wall spheres, at most 2 a; strain
    control. (Unit: d.)"""


class PackingReport(TypedDict):
    """How the packing came out."""

    inserted: int
    """Grains that random insertion placed without overlap; the others were grown into place."""
    iterations: int
    """Iterations of the relaxation; 0 where insertion placed all."""
    mean_overlap: float
    """Mean overlap of the contacts left [d]."""
    largest_overlap: float
    """Largest overlap [d]."""
    stored_energy: float
    """Elastic energy stored [m d^2/t^2]."""


class ThresholdTime(TypedDict):
    """The transition as another threshold sees it."""

    threshold: float
    """J/Jmax whose crossing counts."""
    time: float | None
    """tau [t]; `None` where there was no transition."""


class TrajectoryReport(TypedDict):
    """The part of a trajectory that was written."""

    files: list[str]
    """The files that readers open; bytes of a name that are not Unicode are replaced by marks."""
    frames: int
    """Frames."""
    interval_steps: int
    """Steps between two frames."""
    bytes: int
    """Bytes of all files."""


class WarningEntry(TypedDict):
    """A doubt about a run that can be computed but may not mean what was intended."""

    key: str
    """The key to look at."""
    message: str
    """The consequence to expect."""


class PumpingSummary(TypedDict):
    """What a summary says under ``pumping``."""

    body_force: float
    """force over mass on the grains along the wave, gravity's part with it; negative is back pressure [d/t^2]"""
    pressure_rise: float
    """pressure rise over a wavelength that the body force stands for, with the mean mass of the distribution of
    sizes [m/(d t^2)]"""
    useful_power: float | None
    """late mean power of the flow against the body force, grains inside [m d^2/t^3]"""
    useful_power_error: float | None
    """its standard error [m d^2/t^3]"""
    efficiency: float | None
    """useful power over wall power"""
    efficiency_error: float | None
    """its standard error"""


class ThroatSummary(TypedDict):
    """What a summary says under ``throat``."""

    density: float
    """late mean of the grains per length of tube in about a fifth of the wavelength where it is narrowest [1/d]"""
    axial_velocity: float
    """mean over the grains there of the velocity of their bins along the wave [d/t]"""
    granular_temperature: float
    """granular temperature of the bins there, mean over the grains, each about the mean velocity of its bin: the
    smaller, the fewer grains a bin has [m d^2/t^2]"""


class BellySummary(TypedDict):
    """What a summary says under ``belly``."""

    density: float
    """the same where the tube is widest [1/d]"""
    axial_velocity: float
    """the same where the tube is widest [d/t]"""
    granular_temperature: float
    """the same where the tube is widest [m d^2/t^2]"""


class OpenSummary(TypedDict):
    """What a summary says under ``open``."""

    discharge_rate: float | None
    """late mean mass that leaves an open tube through its outlet [m/t]"""
    discharge_rate_error: float | None
    """its standard error [m/t]"""
    return_rate: float | None
    """late mean mass that leaves an open tube through its inlet, against the flow [m/t]"""
    return_rate_error: float | None
    """its standard error [m/t]"""
    hold_up: float | None
    """late mean mass of the grains between the ends of an open tube [m]"""
    hold_up_error: float | None
    """its standard error [m]"""
    discharged: float | None
    """mass that has left an open tube through its outlet since the start [m]"""
    leaked: float | None
    """mass of the grains that have gone through the wall of an open tube, and past one of its ends, since the start
    [m]"""
    transits: float | None
    """grains that have gone all the way from the inlet to the outlet in the run"""
    transit_time: float | None
    """mean time from the inlet to the outlet of the grains that have gone all the way in the run: too short where
    the run is not many times longer [t]"""
    transit_time_error: float | None
    """its standard error [t]"""
    transit_time_variance: float | None
    """variance of that time [t^2]"""
    refill_efficiency: float | None
    """volume of the grains discharged in a period over the clear volume of a wavelength (with segments the mean
    over a period); missing for a static wave"""
    refill_efficiency_error: float | None
    """its standard error"""


class SiSummary(TypedDict):
    """What a summary says under ``si``."""

    discharge_rate_kg_per_s: float | None
    """discharge_rate in SI; missing without the table units [kg/s]"""
    discharge_rate_kg_per_s_error: float | None
    """its standard error [kg/s]"""
    mass_flow_rate_kg_per_s: float | None
    """mass_flow_rate in SI; missing without the table units [kg/s]"""
    mass_flow_rate_kg_per_s_error: float | None
    """its standard error [kg/s]"""
    wall_power_w: float | None
    """wall_power in SI; missing without the table units [W]"""
    useful_power_w: float | None
    """useful_power in SI; missing without the table units [W]"""
    pressure_rise_pa: float | None
    """pressure_rise in SI; missing without the table units [Pa]"""
    wall_pressure_pa: float | None
    """wall_pressure in SI; missing without the table units [Pa]"""
    wall_pressure_largest_pa: float | None
    """wall_pressure_largest in SI; missing without the table units [Pa]"""
    contact_force_99_n: float | None
    """contact_force_99 in SI; missing without the table units [N]"""
    contact_force_largest_n: float | None
    """contact_force_largest in SI; missing without the table units [N]"""
    wall_torque_n_m: float | None
    """wall_torque in SI; missing without the table units [N m]"""
    wear_power_w: float | None
    """wear_power in SI; missing without the table units [W]"""
    wall_wear_w_per_m2: float | None
    """wall_wear in SI; missing without the table units [W/m^2]"""
    return_rate_kg_per_s: float | None
    """return_rate in SI [kg/s]"""
    return_rate_kg_per_s_error: float | None
    """its standard error [kg/s]"""
    hold_up_kg: float | None
    """hold_up in SI [kg]"""
    hold_up_kg_error: float | None
    """its standard error [kg]"""
    transition_time_s: float | None
    """transition_time in SI [s]"""
    residence_time_s: float | None
    """residence_time in SI [s]"""
    axial_dispersion_m2_per_s: float | None
    """axial_dispersion in SI [m^2/s]"""
    time_s: float | None
    """time in SI [s]"""


class _Rare(TypedDict, total=False):
    """What not every summary has."""

    trajectory: TrajectoryReport
    """The trajectory that was written; only where there is one."""


class Summary(_Rare):
    """The outcome of a run, as ``summary.json`` has it. Numbers that are not known are NaN.

    Examples
    --------
    >>> import peristalsis
    >>> summary: peristalsis.Summary = peristalsis.Simulation.preset("frictionless", waves=2).summary()
    >>> summary["grains"], summary["packing"]["inserted"]
    (41, 25)
    """

    seed: int
    """seed of the random numbers"""
    status: Literal["complete", "settled", "running", "diverged"]
    """complete; settled: ended early, after its transition; of a run, not of a row: interrupted, or diverged"""
    grains: int
    """N"""
    time: float
    """time reached [t]"""
    periods: float
    """wavelengths that the wave has run"""
    transition_time: float | None
    """time of the transition, tau; missing where there was none [t]"""
    censored: bool
    """whether the run ended before a transition"""
    watched: float | None
    """time up to which a transition is found, 2.5 periods before the end of the last whole one that has a J/Jmax:
    where a run without one is censored; missing where no transition can be told [t]"""
    transition_threshold: float
    """J/Jmax whose crossing counts as the transition"""
    flow_rate_ratio: float
    """late mean of J/Jmax of the grains inside. If the wave changes its speed, or no grain is inside for a while,
    it is the late mean of J over the late mean of Jmax"""
    flow_rate_ratio_error: float
    """its standard error"""
    flow_rate_ratio_drift: float
    """late J/Jmax, mean of its second half less that of its first"""
    flow_rate_ratio_variance: float
    """variance of the late averages of J/Jmax over a period each"""
    flow_rate_ratio_raw: float
    """late mean of J/Jmax of all grains"""
    flow_rate: float
    """late mean of J [1/t]"""
    newtonian_flow_rate_ratio: float | None
    """J/Jmax of a Newtonian fluid in this tube, phi = b/a"""
    newtonian_flow_rate_ratio_clear_bore: float | None
    """the same for the clear bore, phi = b/(a - d_w/2)"""
    escaped: int
    """grains outside the tube at the end"""
    escaped_most: int
    """most grains outside the tube at any sample"""
    largest_overlap: float
    """largest overlap of a grain's contact at any step [d]"""
    energy_residual: float
    """|what the energy ledger misses|/(integral of |power of wall and drive| + |work of the body force|)"""
    granular_temperature: float
    """late mean of the granular temperature about the mean of the velocities, escaped grains too [m d^2/t^2]"""
    contacts: float
    """late mean number of contacts of a grain, escaped ones too"""
    wall_power: float
    """late mean power that wall or drive put into the whole tube [m d^2/t^3]"""
    dissipated_power: float
    """late mean power lost [m d^2/t^3]"""
    bottleneck: float
    """late mean of the smallest bottleneck [d]"""
    time_step: float
    """length of a step [t]"""
    steps: int
    """steps done"""
    wall_power_error: float
    """standard error of wall_power [m d^2/t^3]"""
    wall_normal_force: float
    """late mean axial force of the wall on the grains of a wavelength (of an open tube: all grains over the waves)
    along the normals of contacts [m d/t^2]"""
    wall_normal_force_error: float
    """its standard error [m d/t^2]"""
    wall_tangential_force: float
    """the same by friction [m d/t^2]"""
    wall_tangential_force_error: float
    """its standard error [m d/t^2]"""
    narrow_normal_force: float
    """part of wall_normal_force where the tube is narrower than its mean [m d/t^2]"""
    narrow_normal_force_error: float
    """its standard error [m d/t^2]"""
    narrow_tangential_force: float
    """part of wall_tangential_force there [m d/t^2]"""
    narrow_tangential_force_error: float
    """its standard error [m d/t^2]"""
    narrow_axial_velocity: float
    """late mean axial velocity there, laboratory frame: of the mass, not of the number of grains [d/t]"""
    narrow_axial_velocity_error: float
    """its standard error [d/t]"""
    narrow_wall_velocity: float
    """late mean axial velocity of the wall's spheres there; 0 for a prescribed wall [d/t]"""
    narrow_wall_velocity_error: float
    """its standard error [d/t]"""
    front_normal_force: float
    """part of wall_normal_force in the front of the wave: in the bins of the profile from that of its narrowest
    place on (the last of equally narrow ones), up to that of the widest one ahead: without it, or with the first of
    several that are equally wide [m d/t^2]"""
    front_normal_force_error: float
    """its standard error [m d/t^2]"""
    front_tangential_force: float
    """part of wall_tangential_force in the front of the wave [m d/t^2]"""
    front_tangential_force_error: float
    """its standard error [m d/t^2]"""
    wall_pressure: float
    """late mean pressure on the wall (of an open tube between its ends), on the area through the centres of its
    spheres, each bin of the profile alike [m/(d t^2)]"""
    wall_pressure_largest: float
    """largest late mean pressure on the wall over the positions in the wave frame [m/(d t^2)]"""
    contact_force_99: float | None
    """late mean of the normal force that 99 % of the grains' contacts do not exceed [m d/t^2]"""
    contact_force_99_error: float | None
    """its standard error [m d/t^2]"""
    contact_force_largest: float | None
    """largest normal force at a contact of a grain, at the late moments that were looked at [m d/t^2]"""
    contact_force_moments: float | None
    """late moments at which the contact forces were looked at"""
    wall_torque: float | None
    """wall_power over 2 pi f, f the frequency of the wave: torque of a shaft that makes one wave a turn; missing
    for a static wave [m d^2/t^2]"""
    wall_torque_error: float | None
    """its standard error [m d^2/t^2]"""
    wear_power: float | None
    """late mean power that grains lose where they slide on the wall, in the whole tube; missing without friction [m
    d^2/t^3]"""
    wear_power_error: float | None
    """its standard error [m d^2/t^3]"""
    wall_wear: float | None
    """the same per area of the wall [m/t^3]"""
    wall_wear_error: float | None
    """its standard error [m/t^3]"""
    axial_mixing: float | None
    """late mean of Lacey's index of the halves that began in front and behind: 0 apart, 1 at random; missing in an
    open tube"""
    axial_mixing_error: float | None
    """its standard error"""
    radial_mixing: float | None
    """the same of the halves that began near the axis and near the wall"""
    radial_mixing_error: float | None
    """its standard error"""
    axial_mixing_time: float | None
    """end of the first period in which axial mixing has come to 1/2; missing where it has not [t]"""
    radial_mixing_time: float | None
    """the same of radial mixing [t]"""
    radial_segregation: float | None
    """late mean correlation of diameter and radial place: positive where large grains are outside; missing for one
    size"""
    radial_segregation_error: float | None
    """its standard error"""
    height_segregation: float | None
    """late mean correlation of diameter and height: positive where large grains are on top; missing without gravity
    across"""
    height_segregation_error: float | None
    """its standard error"""
    belly_segregation: float | None
    """late mean correlation of diameter and the tube's radius: positive where large grains are in the bellies"""
    belly_segregation_error: float | None
    """its standard error"""
    residence_time: float | None
    """late mean time of a grain through the tube, N/J; missing where the flow is not along the wave, and in an open
    tube [t]"""
    residence_time_error: float | None
    """its standard error [t]"""
    axial_dispersion: float
    """half the late rate at which the variance of axial displacements grows from period to period [d^2/t]"""
    axial_dispersion_error: float
    """its standard error [d^2/t]"""
    late_periods: float
    """length of the late part, in periods of drive.strain_rate; with a static wave in groups of
    observe.samples_per_period samples"""
    back_flow: float
    """late mean of -J where J < 0, each J the mean over the interval of a sample: the rate of flow against the wave
    [1/t]"""
    back_flow_error: float
    """its standard error [1/t]"""
    pressed: float
    """part of the late samples at which a grain overlaps another or the wall by more than 0.1 d"""
    mass_flow_rate: float
    """late mean mass that flows along the wave, sum m v_z over L, grains inside [m/t]"""
    mass_flow_rate_error: float
    """its standard error [m/t]"""
    wall_spheres: int
    """spheres of the wall"""
    grain_steps_per_second: float
    """grains times steps over the seconds that engine and observables took [1/s]"""
    seconds: float
    """seconds that engine and observables took [s]"""
    version: str
    """version of the program"""
    revision: str
    """revision of its source"""
    pumping: PumpingSummary | None
    """Pumping against a body force; `None` without one."""
    throat: ThroatSummary
    """About a fifth of the wavelength, where the tube is narrowest."""
    belly: BellySummary
    """About a fifth of the wavelength, where it is widest."""
    open: OpenSummary | None
    """What passes through an open tube; `None` of a periodic one."""
    si: SiSummary | None
    """Quantities in SI; `None` without the table `units`."""
    transition_times: list[ThresholdTime]
    """The transition as other thresholds see it."""
    packing: PackingReport
    """How the grains were placed."""
    message: str | None
    """Why the run diverged, where it did."""
    wall_diagnosis: list[str]
    """Faults of an elastic wall: when, where, and the likely cause."""
    warnings: list[WarningEntry]
    """What looks doubtful."""


class RunSummary(Summary):
    """A summary with the configuration that was given to `peristalsis.run`.

    Examples
    --------
    >>> import peristalsis
    >>> summary: peristalsis.RunSummary = peristalsis.run({"preset": "frictionless", "waves": 2, "periods": 1})
    >>> summary["config"]["periods"]
    1
    """

    config: dict[str, Any]
    """The configuration as it was given."""
