#![allow(missing_docs, clippy::print_stdout, clippy::unwrap_used)]
use peristalsis_engine::initial::{InitialState, Packing, pack};
use peristalsis_engine::wall::PrescribedWall;
use peristalsis_engine::{Integrator, Parameters, Simulation, Wall};
use peristalsis_physics::contact::*;
use peristalsis_physics::wall::*;
fn main() {
    let a: Vec<f64> = std::env::args()
        .skip(1)
        .map(|s| s.parse().unwrap())
        .collect();
    let (m, rings, w, eps, rho, waves, periods, seed, jam) =
        (a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8]);
    let lattice = Lattice {
        spheres_per_ring: m as u32,
        rings_per_wave: rings as u32,
        waves: waves as u32,
        wavelength: 10.0,
        sphere_diameter: 1.0,
    };
    let wall = Wall::Prescribed(PrescribedWall::new(
        lattice,
        1.5,
        Waveform::Sine,
        -1.0,
        Schedule::constant(1.5 - 0.5 * w),
        Schedule::constant(eps),
    ));
    let number = (rho * 6.0 * 2.25 * lattice.length()).round() as usize;
    let normal = Normal::Linear(LinearSpringDashpot {
        normal_stiffness: 1.0,
        normal_damping: 5.48e-3,
    });
    let t0 = std::time::Instant::now();
    let packing = Packing {
        number,
        diameter_min: 1.0,
        diameter_max: 1.0,
        state: if jam > 0.0 {
            InitialState::Jammed
        } else {
            InitialState::Rest
        },
        axial_velocity: if jam > 0.0 { -eps * 10.0 } else { 0.0 },
        seed: seed as u64,
    };
    let (bodies, report) = pack(&packing, &wall, normal).unwrap();
    println!("N {number} {report:?} {:?}", t0.elapsed());
    let spp = (1.0 / (eps * 0.05)).round() as u64;
    let mut sim = Simulation::new(
        bodies,
        wall,
        Parameters {
            contact: ContactModel {
                normal,
                friction: None,
            },
            integrator: Integrator::Verlet,
            time_step: 0.05,
            skin: 0.3,
        },
    );
    let t0 = std::time::Instant::now();
    let mut last = (0..number)
        .map(|i| sim.bodies().unfolded(i, lattice.length()))
        .sum::<f64>();
    let mut out = String::new();
    let mut tau = None;
    let (mut late, mut nl) = (0.0, 0.0);
    for p in 0..periods as usize {
        sim.advance(spp).unwrap();
        let now = (0..number)
            .map(|i| sim.bodies().unfolded(i, lattice.length()))
            .sum::<f64>();
        let j = -(now - last) / (number as f64 * 10.0);
        if j > 0.5 && tau.is_none() {
            tau = Some(sim.time());
        }
        if p as f64 >= 0.75 * periods {
            late += j;
            nl += 1.0;
        }
        if p % ((periods as usize / 10).max(1)) == 0 {
            out += &format!("{j:.3} ");
        }
        last = now;
    }
    let el = t0.elapsed().as_secs_f64();
    println!(
        "{out} tau {tau:?} late {:.4} residual {:.2e} speed {:.2} M/s",
        late / nl,
        sim.energy_residual(),
        number as f64 * sim.step() as f64 / el / 1e6
    );
}
