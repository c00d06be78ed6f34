//! Values that hold where no preset, file or override says otherwise, and the largest sizes that are accepted.

/// k of the linear contact law \[m t^-2\].
pub const NORMAL_STIFFNESS: f64 = 1.0;
/// eta of the linear contact law \[m t^-1\]; restitution 0.988 for two unit grains.
pub const NORMAL_DAMPING: f64 = 5.48e-3;
/// Y of the Hertz law \[m d^-1 t^-2\].
pub const YOUNG_MODULUS: f64 = 1.0;
/// nu of the Hertz law.
pub const POISSON_RATIO: f64 = 0.5;
/// A of the Hertz law \[t\].
pub const DISSIPATION_TIME: f64 = 0.1;
/// k_t \[m t^-2\].
pub const TANGENTIAL_STIFFNESS: f64 = 1.0;
/// eta_t \[m t^-1\].
pub const TANGENTIAL_DAMPING: f64 = 0.1;
/// Diameter of a grain and of a wall sphere \[d\].
pub const DIAMETER: f64 = 1.0;

/// Mass of a sphere of the elastic wall \[m\].
pub const WALL_SPHERE_MASS: f64 = 0.1;
/// k_w \[m t^-2\].
pub const WALL_SPRING_STIFFNESS: f64 = 0.018;
/// Natural length of a wall spring over the mean distance of lattice neighbours.
pub const WALL_NATURAL_LENGTH_RATIO: f64 = 0.7;
/// Reference distance beyond which wall spheres repel on contact \[d\].
pub const WALL_CONTACT_RANGE: f64 = 3.0;
/// Stiffness of the azimuthal tether of a wall sphere \[m t^-2\].
pub const KEEP_AZIMUTHAL: f64 = 0.1;
/// Stiffness of the axial tether of a wall sphere \[m t^-2\].
pub const KEEP_AXIAL: f64 = 0.01;

/// Longest time step \[t\].
pub const TIME_STEP: f64 = 0.05;
/// Skin of the neighbour search over the largest grain diameter.
pub const NEIGHBOUR_SKIN_RATIO: f64 = 0.3;
/// Seed of the random numbers.
pub const SEED: u64 = 1;
/// Samples in one wave period.
pub const SAMPLES_PER_PERIOD: u32 = 20;
/// Samples in a run without a period (a static wave).
pub const SAMPLES_OF_A_STATIC_RUN: u64 = 200;
/// Bins of a profile over one wavelength.
pub const PROFILE_BINS: u32 = 50;
/// Part of the run, at its end, that the late means are taken over.
pub const LATE_FRACTION: f64 = 0.25;
/// J/Jmax that the period average crosses at a transition.
pub const TRANSITION_THRESHOLD: f64 = 0.5;

/// Largest number of grains.
pub const MOST_GRAINS: u64 = 100_000_000;
/// Largest number of wall spheres.
pub const MOST_WALL_SPHERES: u64 = 1_000_000_000;
/// Largest number of samples in a run.
pub const MOST_SAMPLES: u64 = 100_000_000;
/// Largest number of time steps in a run.
pub const MOST_STEPS: u64 = 1_000_000_000_000;
