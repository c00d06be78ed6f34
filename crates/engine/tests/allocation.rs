//! Once warm, steps take no memory: whatever a step needs, the steps before it have left.

use allocation_counter::measure;

mod common;

use common::*;

/// Small, so that lists and orders are made anew again and again.
const SKIN: f64 = 0.05;

/// Places of the grains along the tube, unfolded.
fn places(simulation: &Simulation) -> Vec<f64> {
    let (bodies, length) = (simulation.bodies(), simulation.wall().length());
    (0..bodies.grains)
        .map(|grain| bodies.unfolded(grain, length))
        .collect()
}

/// 500 steps in one advance, after 2000: not one allocation, in any kernel, for either model.
///
/// A list grows to a new maximum now and then, but to twice the room that it had, so that a warm run has met all that it
/// will need. As the bits of a run are the same everywhere, so is what this test finds. A prescribed wall whose amplitude
/// jumps is the exception: in that step it copies the state.
#[test]
fn warm_steps_allocate_nothing() {
    // Runs of the reference, of the kernel with a list, of the one that sorts.
    let mut kernels = [0; 3];
    for tube in [Tube::Narrow, Tube::Wide, Tube::Elastic] {
        let chosen = rows(tube).into_iter().filter(|row| {
            let smooth = row.alike && row.normal == LINEAR && row.sliding.is_none();
            let rough = row.normal == HERTZ && row.sliding == Some(Sliding::Spring);
            smooth && row.integrator == Integrator::Verlet || rough && !row.alike
        });
        for row in chosen {
            let mut state = lively(row);
            state.parameters.skin = SKIN;
            for kernel in [Kernel::Reference, Kernel::Fast] {
                let mut simulation = state.start(kernel);
                simulation.advance(2000).unwrap();
                let before = places(&simulation);
                let copied = measure(|| drop(simulation.clone()));
                assert!(copied.count_total > 0, "nothing is counted");
                let warm = measure(|| simulation.advance(500).unwrap());
                assert_eq!(warm.count_total, 0, "{row:?}, {kernel:?}: {warm:?}");

                let moved = places(&simulation)
                    .into_iter()
                    .zip(before)
                    .map(|(z, from)| z - from);
                let least = moved.clone().fold(f64::INFINITY, f64::min);
                let largest = moved.fold(f64::NEG_INFINITY, f64::max);
                // A list holds for an approach of two skins at most.
                assert!(
                    largest - least > 10.0 * 2.0 * SKIN,
                    "{row:?}: few lists were made"
                );
                let sorted = simulation.snapshot().sorting.is_some();
                kernels[usize::from(kernel == Kernel::Fast) + usize::from(sorted)] += 1;
            }
        }
    }
    assert!(kernels.iter().all(|&runs| runs >= 2), "{kernels:?}");
}
