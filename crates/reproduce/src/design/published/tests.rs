//! The published points, and the branches beside which the viewer draws one's own loop, are those of the rows;
//! `UPDATE_EXPECT=1 cargo test -p peristalsis-reproduce --lib published` writes them anew (then `just viewer-bundle`).

use std::collections::BTreeMap;
use std::path::Path;

use expect_test::expect_file;
use peristalsis_configuration::Configuration;
use peristalsis_formats::{Table, Values, csv, parquet};
use peristalsis_physics::wall::Arrangement;

use super::*;
use crate::branch::is_split;
use crate::design::groups::{groups, unlike};
use crate::row::{Row, by_strain_rate, grouped, rows_of};
use crate::thresholds::MOST_ESCAPED;
use crate::{STUDIES, Size, StudyFile};

#[test]
fn the_published_points_are_those_of_the_rows() {
    let studies = STUDIES
        .iter()
        .filter_map(|study| Some((study, read(study.name)?)));
    let text = encoded(&points_of(&studies.collect::<Vec<_>>()));
    expect_file!["../published.csv"].assert_eq(&text);
    assert!(published().len() > 500, "{}", published().len());
}

#[test]
fn the_published_branches_of_the_page_are_those_of_the_rows() {
    let branches = [
        ("frictionless", "branches-coarse", "width"),
        ("frictionless-source", "branches-12x16", "width"),
        ("frictionless-fine", "branches-fine", "width"),
        ("frictional", "elastic-branches", "force_amplitude"),
        ("friction", "back-flow", "contact.kinetic_friction"),
    ]
    .map(|(of, study, across)| {
        let curves = curves(&read(study).unwrap(), across).join(",");
        format!("\"{of}\":[{curves}]")
    });
    let text = format!("{{{}}}\n", branches.join(","));
    expect_file!["../../../../../viewer/source/ghosts.json"].assert_eq(&text);
}

/// The rows of a study in the repository.
fn read(study: &str) -> Option<Table> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../validation/results");
    let path = folder.join(format!("{study}.parquet"));
    path.exists().then(|| parquet::read(&path).unwrap())
}

/// Means over replicates of J/Jmax against a column, a curve for each strain rate and start; replicates that ended in two
/// flows are on none.
fn curves(table: &Table, across: &str) -> Vec<String> {
    let mut curves = Vec::new();
    for (strain_rate, rows) in by_strain_rate(rows_of(table)) {
        for (start, rows) in grouped(rows, Row::start) {
            let known = rows
                .into_iter()
                .filter(|row| row.flow_rate_ratio().is_finite());
            let branch = grouped(known, |row| row.number(across)).into_iter();
            let points = branch
                .filter(|(_, rows)| !is_split(rows))
                .map(|(value, rows)| {
                    let flow =
                        rows.iter().map(Row::flow_rate_ratio).sum::<f64>() / rows.len() as f64;
                    let [value, flow] = [format!("{value:.5e}"), format!("{flow:.3}")]
                        .map(|text| text.parse::<f64>().unwrap() + 0.0);
                    format!("[{value},{flow}]")
                });
            let points: Vec<String> = points.collect();
            if points.len() > 2 {
                curves.push(format!(
                    "{{\"strain_rate\":{strain_rate},\"start\":\"{}\",\"points\":[{}]}}",
                    start.name(),
                    points.join(",")
                ));
            }
        }
    }
    curves
}

/// Points as CSV, with three digits; the inverse of reading them.
fn encoded(points: &[Point]) -> String {
    let text = |value: fn(&Point) -> &str| points.iter().map(|it| value(it).to_owned()).collect();
    let mut table = Table::builder()
        .column("study", "", "", Values::Text(text(|it| &it.study)))
        .column("start", "", "", Values::Text(text(|it| it.start.name())));
    for (place, group) in ALL.iter().enumerate() {
        let values = points.iter().map(|point| rounded(point.groups[place]));
        table = table.column(group.name, "1", "", Values::Real(values.collect()));
    }
    let flows = points.iter().map(|point| rounded(point.flow)).collect();
    let runs = points.iter().map(|point| point.runs).collect();
    let table = table
        .column("flow", "1", "", Values::Real(flows))
        .column("runs", "1", "", Values::Integer(runs))
        .build()
        .unwrap();
    csv::encode(&table)
}

/// The points of the runs of several studies, each with its rows: those of a staggered wall and a constant sine wave, whose
/// flow no longer drifts and whose tube holds its grains.
fn points_of(studies: &[(&StudyFile, Table)]) -> Vec<Point> {
    let mut found: BTreeMap<String, Point> = BTreeMap::new();
    for (study, table) in studies {
        let specification = study.specification(Size::Full).unwrap();
        let plan = specification.plan();
        let rows: BTreeMap<&str, Row<'_>> = rows_of(table)
            .into_iter()
            .map(|row| (row.identity(), row))
            .collect();
        let of_point: Vec<Option<[f64; GROUPS]>> = plan
            .points()
            .iter()
            .map(|point| comparable(&point.configuration))
            .collect();
        for run in plan.runs() {
            let row = rows.get(run.identity.to_string().as_str());
            let (Some(groups), Some(row)) = (of_point[run.point], row) else {
                continue;
            };
            let flow = row.flow_rate_ratio();
            let leaks = row.escaped_fraction() > MOST_ESCAPED;
            if !row.is_stationary() || leaks || !flow.is_finite() {
                continue;
            }
            let start = row.start();
            let key = format!("{start:?} {:?}", groups.map(rounded));
            let point = found.entry(key).or_insert_with(|| Point {
                study: study.name.to_owned(),
                start,
                groups,
                flow: 0.0,
                runs: 0,
            });
            point.runs += 1;
            point.flow += (flow - point.flow) / point.runs as f64;
        }
    }
    found.into_values().collect()
}

/// The groups of a tube that others are compared with.
fn comparable(configuration: &Configuration) -> Option<[f64; GROUPS]> {
    let is_staggered = configuration.tube.arrangement == Arrangement::Staggered;
    groups(configuration).filter(|_| is_staggered && unlike(configuration).is_empty())
}
