//! S1: the flow fields at three forces, and the last of them without friction.

use peristalsis_figures::{
    Snapshot, SnapshotFigure, SnapshotGrain, SnapshotSphere, SnapshotWall, Width,
};

use super::elastic::*;
use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("s1.md"));

pub(super) const CLAIM: Claim = claim("S1", PROSE, &["elastic-flow", "elastic-branches"], examine);

/// One of the pictures.
struct Scene<'a> {
    force: f64,
    frictionless: bool,
    rows: Vec<Row<'a>>,
    /// J/Jmax, mean over the replicates.
    flow: Uncertain,
}

/// The spheres of one run of a scene.
struct Picture<'a> {
    name: String,
    row: Row<'a>,
    spheres: Table,
}

impl<'a> Scene<'a> {
    /// The scenes of some runs, from the largest force to the smallest, without friction last.
    fn all_of(rows: Vec<Row<'a>>) -> Vec<Self> {
        grouped(rows, |row| (-row.force(), is_frictionless(row)))
            .into_iter()
            .map(|((force, frictionless), rows)| Self {
                force: -force,
                frictionless,
                flow: flow_of(&rows),
                rows,
            })
            .collect()
    }

    fn name(&self) -> String {
        let grains = if self.frictionless {
            ", without friction"
        } else {
            ""
        };
        format!("*f*^{{P}} = {} *Yd*^{{2}}{grains}", self.force)
    }

    /// Whether the flow is as the source's picture suggests: along the wave at the largest force and without friction,
    /// against it at the smaller ones; `None` where the error is too large to say.
    fn holds(&self, largest: f64) -> Option<bool> {
        let clear = self.flow.deviations_from(0.0).abs() > CLEAR;
        clear.then_some((self.flow.value > 0.0) == (self.frictionless || self.force == largest))
    }

    /// The first run whose spheres were kept.
    fn picture(&self, study: &StudyResults) -> Result<Option<Picture<'a>>> {
        let kept = first_kept(&self.rows, |row| study.product(row, files::SNAPSHOT))?;
        Ok(kept.map(|(row, spheres)| Picture {
            name: self.name(),
            row,
            spheres,
        }))
    }
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let study = evidence.study("elastic-flow")?;
    let scenes = Scene::all_of(study.rows());
    let Some(first) = scenes.first() else {
        return Ok(PROSE.nothing(Statistics::default()));
    };
    let outcomes = scenes.iter().map(|scene| scene.holds(first.force));
    let outcomes: Vec<Option<bool>> = outcomes.collect();
    let verdict = match all_hold(&outcomes) {
        Some(false) => Verdict::Differs,
        Some(true) if outcomes.len() >= 4 => Verdict::Reproduced,
        _ => Verdict::Open,
    };
    let flow = |scene: &Scene<'_>| format!("{} at {}", scene.flow, scene.name());
    let flows: Vec<String> = scenes.iter().map(flow).collect();
    let lines = ForceLine::all_of(&evidence.study("elastic-branches")?.rows());
    let summary = PROSE.text("summary", values!(flows = flows.join(", ")));
    let mut draft = Draft::of(PROSE);
    for scene in &scenes {
        let (name, runs) = (scene.name(), scene.rows.len());
        draft.quantity("flow rate", values!(scene = name, runs), scene.flow);
    }
    let drifts = |scene: &&Scene<'_>| scene.rows.iter().any(|row| !row.is_stationary());
    let drifting = scenes.iter().filter(drifts).map(|scene| {
        let drifts = |row: &&Row<'_>| !row.is_stationary();
        let number = scene.rows.iter().filter(drifts).count();
        format!("{} in {number} of {} runs", scene.name(), scene.rows.len())
    });
    let drifting: Vec<String> = drifting.collect();
    if !drifting.is_empty() {
        let scenes = drifting.join(", ");
        draft.weakness("drifting", values!(scenes));
    }
    let mut pictures = Vec::new();
    for scene in &scenes {
        pictures.extend(scene.picture(study)?);
    }
    if !pictures.is_empty() {
        draft.table("grains of the pictures", &[], against_the_wave(&pictures)?);
        draft.finding.figures.push(flow_fields(&pictures)?);
    }
    Ok(draft.concluded(verdict, summary, statistics(&lines, &scenes)))
}

/// The pictures are of one strain rate: forces and strain rates are those of the branches, whose flows these are; replicates
/// the fewest of branches and pictures.
fn statistics(lines: &[ForceLine<'_>], scenes: &[Scene<'_>]) -> Statistics {
    let branches = together(judged(lines));
    let of_pictures = scenes.iter().map(|scene| scene.rows.len());
    Statistics {
        replicates: of_pictures.fold(branches.replicates, usize::min),
        ..branches
    }
}

/// Which part of the grains moves against the wave in each picture.
fn against_the_wave(pictures: &[Picture<'_>]) -> Result<Vec<Vec<String>>> {
    let mut cells = Vec::new();
    for Picture { name, row, spheres } in pictures {
        let is_grain = spheres.booleans("grain")?;
        let velocity = spheres.reals("axial_velocity")?;
        let grains = is_grain.iter().zip(velocity).filter(|(grain, _)| **grain);
        let velocities: Vec<f64> = grains
            .map(|(_, velocity)| velocity / row.wave_speed())
            .collect();
        let part = |moves: fn(f64) -> bool| {
            let count = velocities.iter().filter(|v| moves(**v)).count();
            number(count as f64 / velocities.len().max(1) as f64, 2)
        };
        cells.push(vec![
            name.clone(),
            part(|velocity| velocity < 0.0),
            part(|velocity| velocity > 0.5),
            number(row.time() * row.strain_rate(), 0),
            number(row.escaped_fraction(), 3),
        ]);
    }
    Ok(cells)
}

/// How far from the axis a picture shows spheres, in radii of the tube.
const SHOWN_RADII: f64 = 2.5;

impl Picture<'_> {
    /// The grains and the wall as they are drawn, velocities over that of the wave.
    fn drawn(&self) -> Result<(Vec<SnapshotGrain>, Vec<SnapshotSphere>)> {
        let is_grain = self.spheres.booleans("grain")?;
        let column = |name| self.spheres.reals(name);
        let (along, across, depth) = (column("along")?, column("across")?, column("depth")?);
        let (diameter, velocity) = (column("diameter")?, column("axial_velocity")?);
        let (mut grains, mut wall) = (Vec::new(), Vec::new());
        for place in 0..self.spheres.rows() {
            // One that has flown off must not stretch the picture.
            if across[place].hypot(depth[place]) > SHOWN_RADII * self.row.radius() {
                continue;
            }
            let sphere = SnapshotSphere {
                along: along[place],
                across: across[place],
                depth: depth[place],
                diameter: diameter[place],
            };
            if is_grain[place] {
                grains.push(SnapshotGrain {
                    sphere,
                    axial_velocity: velocity[place] / self.row.wave_speed(),
                });
            } else {
                wall.push(sphere);
            }
        }
        Ok((grains, wall))
    }
}

fn flow_fields(pictures: &[Picture<'_>]) -> Result<ReportFigure> {
    let mut drawn = Vec::new();
    for picture in pictures {
        drawn.push((picture, picture.drawn()?));
    }
    let snapshots: Vec<Snapshot<'_>> = drawn
        .iter()
        .map(|(picture, (grains, wall))| {
            let wavelength = picture.row.wavelength();
            let length = wavelength * picture.row.number("waves");
            Snapshot {
                label: &picture.name,
                grains,
                wall: SnapshotWall::Spheres(wall),
                length,
                tube: length,
                outlet: None,
                wavelength,
            }
        })
        .collect();
    let figure = SnapshotFigure {
        title: "",
        snapshots: &snapshots,
        axis: "*z*/*d*",
        velocity: "axial velocity along the wave, *v_z*/*c*",
        width: Width::DoubleColumn,
    };
    let first = &pictures[0].row;
    let periods = number(first.time() * first.strain_rate(), 0);
    Ok(PROSE.figure("flow-fields", values!(periods), figure.draw()?))
}
