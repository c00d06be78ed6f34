//! Every combination of law, friction, sizes, control and integrator: one loop over a table.

mod common;

use common::*;
use peristalsis_engine::WallContact;

struct Case {
    name: String,
    state: State,
}

/// All laws x {mono-, polydisperse} x {strain, strain of an even wall, stress} x {Verlet, Adams-Bashforth}.
fn table() -> Vec<Case> {
    let strain = strained(coarse(2), -1.0, 2.6, 0.1);
    let even = smooth(strain.clone());
    let stress = elastic(elastic_parameters());
    let mut rows = Vec::new();
    for (law, model, integrator) in methods() {
        for (sizes, diameter_min) in [("monodisperse", 1.0), ("polydisperse", 0.8)] {
            for (control, wall, number) in [
                ("strain", &strain, 60),
                ("even", &even, 60),
                ("stress", &stress, 120),
            ] {
                rows.push(Case {
                    name: format!("{law}, {sizes}, {control}, {integrator:?}"),
                    state: State {
                        bodies: packed(number, diameter_min, wall, model.normal, 5),
                        wall: wall.clone(),
                        parameters: parameters_with(model, integrator, 0.04),
                    },
                });
            }
        }
    }
    rows
}

fn start(case: &Case) -> Simulation {
    case.state.start(Kernel::default())
}

fn on_wall(simulation: &Simulation) -> Vec<WallContact> {
    let mut contacts = Vec::new();
    simulation.for_each_wall_contact(|contact| contacts.push(contact));
    contacts
}

#[test]
fn each_runs_closes_its_ledger_and_goes_on_from_a_snapshot_with_the_same_bits() {
    const STEPS: u64 = 300;
    let rows = table();
    assert_eq!(rows.len(), 108);
    let mut all_bits = Vec::new();
    for row in &rows {
        let name = &row.name;
        let mut whole = start(row);
        let mut stopped = start(row);
        // Stops in the first step, early, and later, each time through a snapshot.
        let mut done = 0;
        for stop in [1, 2, 117, 118, STEPS] {
            whole.advance(stop - done).unwrap();
            stopped.advance(stop - done).unwrap();
            done = stop;
            let snapshot = stopped.snapshot();
            assert!(
                snapshot == whole.snapshot(),
                "{name}: differs at step {stop}"
            );
            stopped = Simulation::restore(snapshot, row.state.wall.clone(), row.state.parameters)
                .unwrap();
            assert!(
                stopped.snapshot() == whole.snapshot(),
                "{name}: restored differently at step {stop}"
            );
            assert_eq!(on_wall(&stopped), on_wall(&whole), "{name} at step {stop}");
        }
        assert_eq!(bits(&whole), bits(&stopped), "{name}");
        let mut again = start(row);
        again.advance(STEPS).unwrap();
        assert_eq!(bits(&whole), bits(&again), "{name}: not reproducible");
        assert_eq!(again.snapshot(), whole.snapshot());

        assert!(
            whole
                .bodies()
                .position
                .iter()
                .chain(&whole.bodies().velocity)
                .all(|v| v.is_finite())
        );
        assert!(
            whole.energy_residual() < 6e-3,
            "{name}: residual {}",
            whole.energy_residual()
        );
        assert!(
            whole.tally().grain_contacts > 0 && whole.tally().wall_contacts > 0,
            "{name}: no contacts"
        );
        let model = row.state.parameters.contact;
        let turns = whole.bodies().rotational_energy() > 0.0;
        assert_eq!(turns, model.friction.is_some(), "{name}");
        assert_eq!(whole.takes_threads(), !model.is_general(), "{name}");
        let snapshot = whole.snapshot();
        let springs = !snapshot.pair_histories.is_empty();
        assert_eq!(springs, turns && !model.is_general(), "{name}");
        let general = !snapshot.general_histories[0].is_empty();
        let remembers = model.rolling.is_some() || breaks(&model);
        assert_eq!(general, remembers, "{name}");
        all_bits.push((bits(&whole), name));
    }
    // No two rows are the same simulation.
    for (i, (one, name)) in all_bits.iter().enumerate() {
        for (other, other_name) in &all_bits[i + 1..] {
            assert!(one != other, "{name} is {other_name}");
        }
    }
}

#[test]
fn a_snapshot_of_another_simulation_is_refused() {
    let rows = table();
    let find = |parts: &[&str]| {
        rows.iter()
            .find(|row| parts.iter().all(|part| row.name.contains(part)))
            .unwrap()
    };
    let (smooth, frictional) = (
        find(&["linear, smooth, mono", "strain", "Verlet"]),
        find(&["linear, rough, mono", "strain", "Verlet"]),
    );
    let rolling = find(&["linear, rolling, mono", "strain", "Verlet"]);
    let elastic = find(&["linear, smooth, mono", "stress", "Verlet"]);
    let mut simulation = start(frictional);
    simulation.advance(50).unwrap();
    let snapshot = simulation.snapshot();
    assert!(!snapshot.wall_histories.is_empty());
    let of = |row: &Case| (row.state.wall.clone(), row.state.parameters);
    let (wall, mut cohesive) = of(frictional);
    cohesive.contact.cohesion = Some(PULL);
    for ((wall, parameters), reason) in [
        (of(smooth), "another law"),
        ((wall, cohesive), "another law"),
        (of(elastic), "wall spheres"),
    ] {
        let refused = Simulation::restore(snapshot.clone(), wall, parameters).unwrap_err();
        assert!(refused.to_string().contains(reason), "{refused}");
    }
    let mut rolled = start(rolling);
    rolled.advance(50).unwrap();
    for (wall, parameters) in [of(smooth), of(frictional)] {
        let refused = Simulation::restore(rolled.snapshot(), wall, parameters).unwrap_err();
        assert!(refused.to_string().contains("another law"), "{refused}");
    }
    let restore = |change: &dyn Fn(&mut peristalsis_engine::Snapshot)| {
        let mut changed = snapshot.clone();
        change(&mut changed);
        Simulation::restore(
            changed,
            frictional.state.wall.clone(),
            frictional.state.parameters,
        )
    };
    assert!(restore(&|_| ()).is_ok());
    assert!(restore(&|s| s.bodies.mass.truncate(3)).is_err());
    assert!(restore(&|s| s.bodies.position[3].y = f64::NAN).is_err());
    assert!(restore(&|s| s.pair_histories[0].1 = 10_000).is_err());
    assert!(restore(&|s| s.wall_histories.reverse()).is_err());
    // A contact remembered of grains at opposite ends.
    assert!(restore(&|s| s.bodies.position[s.pair_histories[0].0 as usize].z += 9.0).is_err());
}
