#![allow(missing_docs, clippy::print_stdout, clippy::unwrap_used)]
use peristalsis_engine::initial::{InitialState, Packing, pack};
use peristalsis_engine::wall::*;
use peristalsis_engine::{Integrator, Parameters, Simulation, Wall};
use peristalsis_physics::contact::*;
use peristalsis_physics::wall::*;
fn main() {
    let a: Vec<f64> = std::env::args()
        .skip(1)
        .map(|s| s.parse().unwrap())
        .collect();
    let (fp, eps, waves, periods, seed, jam, mu, kw) =
        (a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7]);
    let lattice = Lattice {
        spheres_per_ring: 22,
        rings_per_wave: 23,
        waves: waves as u32,
        wavelength: 20.0,
        sphere_diameter: 1.0,
    };
    let wall = Wall::Elastic(ElasticWall::new(ElasticParameters {
        lattice,
        mean_radius: 3.5,
        sphere_mass: 0.1,
        spring_stiffness: kw,
        natural_length: a[8],
        spring_damping: 0.0,
        drag: 0.0,
        contact_range: 3.0,
        keep: Keep {
            balance: true,
            radial: 0.0,
            azimuthal: a[9],
            axial: 0.01,
            net_force: NetForce::Removed,
        },
        force_amplitude: Schedule::constant(fp),
        frequency: Schedule::constant(eps),
        heading: 1.0,
        waveform: Waveform::Sine,
        angle: DriveAngle::Reference,
    }));
    let number = (0.71 * std::f64::consts::PI * 3.5 * 3.5 * lattice.length()).round() as usize;
    let normal = Normal::Hertz(ViscoelasticHertz {
        young_modulus: 1.0,
        poisson_ratio: 0.5,
        dissipation_time: 0.1,
        dissipation_form: DissipationForm::Viscoelastic,
    });
    let t0 = std::time::Instant::now();
    let packing = Packing {
        number,
        diameter_min: 0.8,
        diameter_max: 1.0,
        state: if jam > 0.0 {
            InitialState::Jammed
        } else {
            InitialState::Rest
        },
        axial_velocity: if jam > 0.0 { eps * 20.0 } else { 0.0 },
        seed: seed as u64,
    };
    let (bodies, report) = pack(&packing, &wall, normal).unwrap();
    println!("N {number} {report:?} {:?}", t0.elapsed());
    let friction = (mu > 0.0).then_some(CundallStrack {
        tangential_stiffness: 1.0,
        tangential_damping: 0.1,
        static_friction: mu,
        kinetic_friction: 0.8 * mu,
        sliding: Sliding::Spring,
    });
    let spp = (1.0 / (eps * 0.05)).ceil() as u64;
    let mut sim = Simulation::new(
        bodies,
        wall,
        Parameters {
            contact: ContactModel { normal, friction },
            integrator: Integrator::Verlet,
            time_step: 1.0 / (eps * spp as f64),
            skin: 0.3,
        },
    );
    let t0 = std::time::Instant::now();
    let z = |s: &Simulation| {
        (0..number)
            .map(|i| s.bodies().unfolded(i, lattice.length()))
            .sum::<f64>()
    };
    let mut last = z(&sim);
    for p in 0..periods as usize {
        sim.advance(spp).unwrap();
        let now = z(&sim);
        let j = (now - last) / (number as f64 * 20.0);
        let b = sim.bodies();
        let r: Vec<f64> = b.position[number..]
            .iter()
            .map(|p| p.x.hypot(p.y))
            .collect();
        let rmax = r.iter().copied().fold(0.0, f64::max);
        let rmin = r.iter().copied().fold(9.0, f64::min);
        let Wall::Elastic(w) = sim.wall() else {
            panic!()
        };
        let dmax = (0..w.lattice().spheres())
            .map(|s| w.displacement(b, s))
            .fold([0.0_f64; 3], |m, v| {
                [
                    m[0].max(v.x.abs()),
                    m[1].max(v.y.abs()),
                    m[2].max(v.z.abs()),
                ]
            });
        let gout = b.position[..number]
            .iter()
            .filter(|p| p.x.hypot(p.y) > rmax + 0.5)
            .count();
        println!(
            "{p} J/J* {j:.4} R {rmin:.2} {rmax:.2} out {gout} {dmax:.2?} res {:.1e} slid {:.2} overlap {:.2} {:.0}s {:.2}M/s",
            sim.energy_residual(),
            sim.ledger().sliding_dissipated,
            sim.ledger().largest_overlap,
            t0.elapsed().as_secs_f64(),
            number as f64 * sim.step() as f64 / t0.elapsed().as_secs_f64() / 1e6
        );
        last = now;
    }
}
