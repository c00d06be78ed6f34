//! Speed of the reference kernels, in grain-steps a second.
//!
//! Each case is packed and run for a while before it is timed, so that its grains flow as they do in a run.

use criterion::{BatchSize, Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use peristalsis_engine::initial::{InitialState, Packing, pack};
use peristalsis_engine::wall::{
    DriveAngle, ElasticParameters, ElasticWall, Keep, NetForce, PrescribedWall,
};
use peristalsis_engine::{Integrator, Parameters, Simulation, Wall};
use peristalsis_physics::contact::{
    ContactModel, CundallStrack, DissipationForm, LinearSpringDashpot, Normal, Sliding,
    ViscoelasticHertz,
};
use peristalsis_physics::wall::{Lattice, Schedule, Waveform};

const TIME_STEP: f64 = 0.05;

/// Frictionless grains in the prescribed wall: a = 1.5, lambda = 10.
struct Frictionless {
    spheres_per_ring: u32,
    rings_per_wave: u32,
    waves: u32,
    volume_fraction: f64,
    width: f64,
    strain_rate: f64,
    state: InitialState,
}

impl Frictionless {
    /// The first case of the frictionless model: fine lattice, L = 100, w = 2.5.
    fn fine(state: InitialState) -> Self {
        Self {
            spheres_per_ring: 24,
            rings_per_wave: 26,
            waves: 10,
            volume_fraction: 0.15,
            width: 2.5,
            strain_rate: 0.1,
            state,
        }
    }

    fn coarse(volume_fraction: f64, waves: u32) -> Self {
        Self {
            spheres_per_ring: 12,
            rings_per_wave: 14,
            waves,
            volume_fraction,
            width: 2.75,
            strain_rate: 0.05,
            state: InitialState::Rest,
        }
    }

    fn simulation(&self) -> Simulation {
        let lattice = Lattice {
            spheres_per_ring: self.spheres_per_ring,
            rings_per_wave: self.rings_per_wave,
            waves: self.waves,
            wavelength: 10.0,
            sphere_diameter: 1.0,
        };
        let wall = Wall::Prescribed(PrescribedWall::new(
            lattice,
            1.5,
            Waveform::Sine,
            -1.0,
            Schedule::constant(1.5 - 0.5 * self.width),
            Schedule::constant(self.strain_rate),
        ));
        let contact = ContactModel {
            normal: Normal::Linear(LinearSpringDashpot {
                normal_stiffness: 1.0,
                normal_damping: 5.48e-3,
            }),
            friction: None,
        };
        let speed = match self.state {
            InitialState::Rest => 0.0,
            InitialState::Jammed => -self.strain_rate * lattice.wavelength,
        };
        let packing = Packing {
            // rho = N/(6 a^2 L)
            number: (self.volume_fraction * 6.0 * 2.25 * lattice.length()).round() as usize,
            diameter_min: 1.0,
            diameter_max: 1.0,
            state: self.state,
            axial_velocity: speed,
            seed: 1,
        };
        assemble(&packing, wall, contact)
    }
}

/// Frictional grains in the elastic wall, n = 0.71, two waves of length 20.
fn frictional() -> Simulation {
    let lattice = Lattice {
        spheres_per_ring: 22,
        rings_per_wave: 23,
        waves: 2,
        wavelength: 20.0,
        sphere_diameter: 1.0,
    };
    let wall = Wall::Elastic(ElasticWall::new(ElasticParameters {
        lattice,
        mean_radius: 3.5,
        sphere_mass: 0.1,
        spring_stiffness: 0.018,
        natural_length: 0.7,
        spring_damping: 0.0,
        drag: 0.0,
        contact_range: 3.0,
        keep: Keep {
            balance: true,
            radial: 0.0,
            azimuthal: 0.1,
            axial: 0.01,
            net_force: NetForce::Removed,
        },
        force_amplitude: Schedule::constant(0.004),
        frequency: Schedule::constant(4.01e-3),
        heading: 1.0,
        waveform: Waveform::Sine,
        angle: DriveAngle::Reference,
    }));
    let contact = ContactModel {
        normal: Normal::Hertz(ViscoelasticHertz {
            young_modulus: 1.0,
            poisson_ratio: 0.5,
            dissipation_time: 0.1,
            dissipation_form: DissipationForm::Viscoelastic,
        }),
        friction: Some(CundallStrack {
            tangential_stiffness: 1.0,
            tangential_damping: 0.1,
            static_friction: 0.5,
            kinetic_friction: 0.4,
            sliding: Sliding::Spring,
        }),
    };
    let packing = Packing {
        number: 1093,
        diameter_min: 0.8,
        diameter_max: 1.0,
        state: InitialState::Jammed,
        axial_velocity: 4.01e-3 * 20.0,
        seed: 1,
    };
    assemble(&packing, wall, contact)
}

fn assemble(packing: &Packing, wall: Wall, contact: ContactModel) -> Simulation {
    let (bodies, _) = pack(packing, &wall, contact.normal).expect("the grains of each case fit");
    let parameters = Parameters {
        contact,
        integrator: Integrator::Verlet,
        time_step: TIME_STEP,
        skin: 0.3,
        kernel: peristalsis_engine::Kernel::default(),
    };
    Simulation::new(bodies, wall, parameters)
}

/// Times `steps` steps of a simulation that has run for `time` before.
fn case(criterion: &mut Criterion, name: &str, mut simulation: Simulation, time: f64, steps: u64) {
    let advance = |simulation: &mut Simulation, steps| {
        simulation
            .advance(steps)
            .expect("the steps are short enough");
    };
    advance(&mut simulation, (time / TIME_STEP).round() as u64);
    let grains = simulation.bodies().grains as u64;
    let mut group = criterion.benchmark_group("reference");
    group.throughput(Throughput::Elements(grains * steps));
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    group.bench_function(name, |bencher| {
        // Every sample starts from the same state; the copy is not timed.
        bencher.iter_batched_ref(
            || simulation.clone(),
            |simulation| advance(simulation, steps),
            BatchSize::LargeInput,
        );
    });
    group.finish();
}

fn reference(criterion: &mut Criterion) {
    let fine = |state| Frictionless::fine(state).simulation();
    case(
        criterion,
        "fine, unjammed",
        fine(InitialState::Rest),
        20.0,
        2000,
    );
    case(
        criterion,
        "fine, jammed",
        fine(InitialState::Jammed),
        100.0,
        2000,
    );
    let dense = Frictionless::coarse(0.3, 10).simulation();
    case(criterion, "coarse, volume fraction 0.3", dense, 100.0, 2000);
    case(
        criterion,
        "frictional, elastic wall",
        frictional(),
        100.0,
        200,
    );
    // 5,000 waves, 101,250 grains.
    let large = Frictionless::coarse(0.15, 5000).simulation();
    case(criterion, "coarse, 101250 grains", large, 10.0, 20);
}

criterion_group!(benches, reference);
criterion_main!(benches);
