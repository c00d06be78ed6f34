//! S1: the flow fields at three forces, and the last of them without friction.

use peristalsis_analysis::Uncertain;
use peristalsis_figures::{
    SnapshotFigure, SnapshotGrain, SnapshotSphere, SnapshotStack, SnapshotWall, Width,
};
use peristalsis_formats::Table;

use super::elastic::{finding, is_frictionless, judged, nothing};
use crate::branches::mean_and_error;
use crate::claim::Claim;
use crate::error::ClaimError;
use crate::evidence::{Evidence, StudyResults};
use crate::finding::{Finding, Quantity, ReportFigure, ReportTable, Statistics, Verdict};
use crate::forces::{CLEAR, ForceLine, together};
use crate::prose::Prose;
use crate::runs::Run;
use crate::text::{number, with_error};

const PROSE: Prose = Prose::new(include_str!("s1.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "S1",
    prose: PROSE,
    studies: &["elastic-flow", "elastic-branches"],
    examine,
};

/// One of the pictures.
struct Scene<'a> {
    force: f64,
    frictionless: bool,
    runs: Vec<&'a Run>,
}

impl Scene<'_> {
    fn name(&self) -> String {
        let grains = if self.frictionless {
            ", without friction"
        } else {
            ""
        };
        format!("*f*^{{P}} = {} *Yd*^{{2}}{grains}", self.force)
    }

    /// J/Jmax, mean over the replicates.
    fn flow(&self) -> Uncertain {
        let ratios: Vec<f64> = self.runs.iter().map(|run| run.flow_rate_ratio).collect();
        let (mean, error) = mean_and_error(&ratios);
        Uncertain::normal(
            mean,
            if error.is_finite() {
                error
            } else {
                self.runs[0].flow_rate_ratio_error
            },
        )
    }

    /// Whether the flow is as the source's picture suggests: along the wave at the largest force and without friction,
    /// against it at the smaller ones; `None` where the error is too large to say.
    fn holds(&self, largest: f64) -> Option<bool> {
        let flow = self.flow();
        let clear = flow.value.abs() > CLEAR * flow.error;
        clear.then_some((flow.value > 0.0) == (self.frictionless || self.force == largest))
    }
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let study = evidence.study("elastic-flow")?;
    let mut scenes: Vec<Scene<'_>> = Vec::new();
    for run in &study.runs {
        let (force, frictionless) = (run.force(), is_frictionless(run));
        match scenes
            .iter_mut()
            .find(|scene| scene.force == force && scene.frictionless == frictionless)
        {
            Some(scene) => scene.runs.push(run),
            None => scenes.push(Scene {
                force,
                frictionless,
                runs: vec![run],
            }),
        }
    }
    scenes.sort_by(|one, other| {
        (other.force, one.frictionless)
            .partial_cmp(&(one.force, other.frictionless))
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    if scenes.is_empty() {
        return Ok(nothing("No runs yet."));
    }
    let largest = scenes[0].force;
    let lines = ForceLine::all_of(&evidence.study("elastic-branches")?.runs);
    let outcomes: Vec<Option<bool>> = scenes.iter().map(|scene| scene.holds(largest)).collect();
    let verdict = if outcomes.contains(&Some(false)) {
        Verdict::Differs
    } else if outcomes.len() >= 4 && outcomes.iter().all(Option::is_some) {
        Verdict::Reproduced
    } else {
        Verdict::Open
    };
    let words: Vec<String> = scenes
        .iter()
        .map(|scene| {
            let flow = scene.flow();
            format!("{} at {}", with_error(flow.value, flow.error), scene.name())
        })
        .collect();
    let mut found = finding(
        verdict,
        format!("*J*/*J*_{{max}} is {}.", words.join(", ")),
        statistics(&lines, &scenes),
    );
    for scene in &scenes {
        found.quantities.push(Quantity {
            name: format!("flow rate, {}", scene.name()),
            symbol: "*J*/*J*_{max}".to_owned(),
            unit: String::new(),
            source: None,
            ours: Some(scene.flow()),
            method: format!("late mean over {} runs that began jammed", scene.runs.len()),
        });
    }
    found.paragraphs.push(
        "The source gives pictures of one strain rate and no numbers; forces and strain rates behind the verdict are those of the \
         branches (S3), of which these flows are part. What is compared is the direction of the flow: along the wave at the largest force, \
         where the jam lasts, and for grains without friction; against it at the smaller forces, where the jam has given way."
            .to_owned(),
    );
    let drifting: Vec<String> = scenes
        .iter()
        .filter(|scene| scene.runs.iter().any(|run| !run.is_stationary()))
        .map(Scene::name)
        .collect();
    if !drifting.is_empty() {
        found.weaknesses.push(format!(
            "The flow still drifts in some of the runs at {}.",
            drifting.join(", ")
        ));
    }
    found.tables.extend(against_the_wave(study, &scenes)?);
    found.figures.extend(snapshots(study, &scenes)?);
    Ok(found)
}

/// The pictures are of one strain rate: forces and strain rates are those of the branches, whose flows these are; replicates
/// the fewest of branches and pictures.
fn statistics(lines: &[ForceLine], scenes: &[Scene<'_>]) -> Statistics {
    let branches = together(judged(lines).into_iter());
    let of_pictures = scenes.iter().map(|scene| scene.runs.len());
    Statistics {
        replicates: of_pictures.fold(branches.replicates, usize::min),
        ..branches
    }
}

/// Which part of the grains moves against the wave in each picture.
fn against_the_wave(
    study: &StudyResults,
    scenes: &[Scene<'_>],
) -> Result<Option<ReportTable>, ClaimError> {
    let mut rows = Vec::new();
    for scene in scenes {
        let Some((run, table)) = picture(study, scene)? else {
            continue;
        };
        let (grain, velocity) = (table.booleans("grain")?, table.reals("axial_velocity")?);
        let velocities: Vec<f64> = grain
            .iter()
            .zip(velocity)
            .filter(|(is_grain, _)| **is_grain)
            .map(|(_, velocity)| velocity / (run.strain_rate * run.wavelength))
            .collect();
        let of_grains = |count: usize| count as f64 / velocities.len().max(1) as f64;
        rows.push(vec![
            scene.name(),
            number(
                of_grains(velocities.iter().filter(|v| **v < 0.0).count()),
                2,
            ),
            number(
                of_grains(velocities.iter().filter(|v| **v > 0.5).count()),
                2,
            ),
            number(run.time * run.strain_rate, 0),
            number(run.escaped_fraction(), 3),
        ]);
    }
    Ok((!rows.is_empty()).then(|| ReportTable {
        caption: "Grains of the pictures: part that moves against the wave, part that moves along it faster than half its speed, \
                  time in periods, part outside the tube."
            .to_owned(),
        head: ["picture", "*v_z* < 0", "*v_z* > *c*/2", "*t*/*T*", "outside"]
            .map(str::to_owned)
            .to_vec(),
        rows,
    }))
}

/// The first run of a scene whose spheres were kept.
fn picture<'a>(
    study: &StudyResults,
    scene: &Scene<'a>,
) -> Result<Option<(&'a Run, Table)>, ClaimError> {
    for run in &scene.runs {
        if let Some(table) = study.snapshot(run)? {
            return Ok(Some((run, table)));
        }
    }
    Ok(None)
}

/// How far from the axis a picture shows spheres, in radii of the tube.
const SHOWN_RADII: f64 = 2.5;

/// The spheres of a table as they are drawn, velocities over a speed.
fn spheres(
    table: &Table,
    reach: f64,
    speed: f64,
) -> Result<(Vec<SnapshotGrain>, Vec<SnapshotSphere>), ClaimError> {
    let grain = table.booleans("grain")?;
    let [along, across, depth, diameter, velocity] =
        ["along", "across", "depth", "diameter", "axial_velocity"].map(|name| table.reals(name));
    let (along, across, depth) = (along?, across?, depth?);
    let (diameter, velocity) = (diameter?, velocity?);
    let (mut grains, mut wall) = (Vec::new(), Vec::new());
    for row in 0..table.rows() {
        // One that has flown off must not stretch the picture.
        if across[row].hypot(depth[row]) > reach {
            continue;
        }
        let sphere = SnapshotSphere {
            along: along[row],
            across: across[row],
            depth: depth[row],
            diameter: diameter[row],
        };
        if grain[row] {
            grains.push(SnapshotGrain {
                sphere,
                axial_velocity: velocity[row] / speed,
            });
        } else {
            wall.push(sphere);
        }
    }
    Ok((grains, wall))
}

fn snapshots(
    study: &StudyResults,
    scenes: &[Scene<'_>],
) -> Result<Option<ReportFigure>, ClaimError> {
    let mut parts = Vec::new();
    for scene in scenes {
        if let Some((run, table)) = picture(study, scene)? {
            let speed = run.strain_rate * run.wavelength;
            let (grains, wall) = spheres(&table, SHOWN_RADII * run.radius, speed)?;
            parts.push((scene.name(), run, grains, wall));
        }
    }
    if parts.is_empty() {
        return Ok(None);
    }
    let figures: Vec<(&str, SnapshotFigure<'_>)> = parts
        .iter()
        .map(|(name, run, grains, wall)| {
            let length = run.wavelength * run.waves as f64;
            (
                name.as_str(),
                SnapshotFigure {
                    grains,
                    wall: SnapshotWall::Spheres(wall),
                    length,
                    period: Some(length),
                    wavelength: Some(run.wavelength),
                    ..SnapshotFigure::default()
                },
            )
        })
        .collect();
    Ok(Some(ReportFigure {
        name: "flow-fields".to_owned(),
        caption: format!(
            "The flow after {} periods from jammed, *n* = 0.710, *ε̇* = 4.01 × 10^{{−3}}: grains in front of and behind the axis, \
             coloured by their axial velocity over the wave's speed, blue against the wave and red along it; the wave runs to the \
             right. The wall is cut along the axis.",
            number(parts[0].1.time * parts[0].1.strain_rate, 0)
        ),
        drawing: SnapshotStack {
            title: "",
            snapshots: &figures,
            width: Width::DoubleColumn,
        }
        .draw()?,
    }))
}
