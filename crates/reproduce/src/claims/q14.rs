//! Q14: segments that close in turn beside a smooth wave of equal stroke.

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("q14.md"));
const STUDIES: &[&str] = &["segments", "segments-wave"];

pub(super) const CLAIM: Claim = Claim::new("Q14", PROSE, STUDIES, examine);

/// The smooth wave that opens the tube as little as segments do.
const WAVE: &str = "bolus";
/// Difference of two strokes that are the same.
const SAME_STROKE: f64 = 1e-9;
/// Segments whose orders are compared.
const SEGMENTS: f64 = 4.0;

/// One drive, without and with a head.
struct Drive {
    name: String,
    /// Numbers of the segments in the order in which they close, from the first of them on; empty of a wave.
    order: String,
    /// None of a wave.
    number: Option<f64>,
    duty: Option<f64>,
    /// Part of the tube that is squeezed, averaged over a period.
    squeeze: f64,
    /// By descending body force: without head first.
    flows: Vec<(f64, Uncertain, Option<Uncertain>)>,
}

impl Drive {
    fn flow(&self) -> Option<Uncertain> {
        self.flows.iter().find(|it| it.0 == 0.0).map(|it| it.1)
    }

    /// The largest head with its flow and its efficiency.
    fn loaded(&self) -> Option<&(f64, Uncertain, Option<Uncertain>)> {
        self.flows.last().filter(|it| it.0 < 0.0)
    }

    /// Whether the segments close one after the other along the wave.
    fn is_along(&self) -> bool {
        !self.order.is_empty() && self.order.split(' ').is_sorted()
    }

    fn cells(&self) -> Vec<String> {
        let loaded = self.loaded();
        vec![
            self.name.clone(),
            if self.order.is_empty() {
                NONE.to_owned()
            } else {
                self.order.clone()
            },
            cell_of(self.duty, |duty| number(duty, 2)),
            number(self.squeeze, 3),
            cell(self.flow()),
            cell(loaded.map(|it| it.1)),
            cell(loaded.and_then(|it| it.2)),
        ]
    }
}

/// The flows of some rows by descending body force.
fn flows(rows: Vec<Row<'_>>) -> Vec<(f64, Uncertain, Option<Uncertain>)> {
    let by_force = grouped(rows, |row| row.number_or("body_force", 0.0));
    by_force
        .into_iter()
        .rev()
        .filter_map(|(force, rows)| {
            let flow = mean(&rows, "flow_rate_ratio")?;
            Some((force, flow, mean(&rows, "pumping_efficiency")))
        })
        .collect()
}

/// Number of segments, their order, and duty, rise and fall of a run.
fn cycle<'a>(row: &Row<'a>) -> (f64, &'a str, [f64; 3]) {
    let times = ["drive.duty", "drive.rise", "drive.fall"].map(|column| row.number(column));
    (row.number("drive.segments"), row.text("drive.order"), times)
}

fn segments(rows: Vec<Row<'_>>) -> Vec<Drive> {
    let drives = grouped(rows, cycle);
    drives
        .into_iter()
        .map(|((segments, order, [duty, rise, fall]), rows)| Drive {
            name: format!("{segments} segments"),
            order: order.trim_matches(['[', ']']).replace(", ", " "),
            number: Some(segments),
            duty: Some(duty),
            squeeze: duty + 0.5 * (rise + fall),
            flows: flows(rows),
        })
        .collect()
}

fn waves(rows: Vec<Row<'_>>) -> Vec<Drive> {
    let waves = grouped(rows, |row| row.text("drive.waveform"));
    let drive = |(name, rows): (&str, Vec<Row<'_>>)| Drive {
        name: name.to_owned(),
        order: String::new(),
        number: None,
        duty: None,
        squeeze: match name {
            "roller" => 0.3,
            "sine" => 0.0,
            _ => 0.25,
        },
        flows: flows(rows),
    };
    waves.into_iter().map(drive).collect()
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let of_segments = evidence.study(STUDIES[0])?.rows();
    let of_waves = evidence.study(STUDIES[1])?.rows();
    let statistics = behind(&of_segments, |row| row.number_or("body_force", 0.0));
    let overlaps = of_segments.iter().map(|row| row.number("largest_overlap"));
    let overlap = number(overlaps.fold(0.0, f64::max), 2);
    let (segments, waves) = (segments(of_segments), waves(of_waves));
    let wave = waves.iter().find(|drive| drive.name == WAVE);
    let Some(wave) = wave else {
        return Ok(PROSE.nothing(statistics, &Q14_NEEDED));
    };
    let mut same: Vec<&Drive> = segments
        .iter()
        .filter(|drive| drive.number == Some(SEGMENTS))
        .filter(|drive| (drive.squeeze - wave.squeeze).abs() < SAME_STROKE)
        .collect();
    let along = same.iter().find(|drive| drive.is_along()).copied();
    same.sort_by(|one, other| order_of(one).total_cmp(&order_of(other)));
    let (Some(along), [worst, .., best]) = (along, &same[..]) else {
        return Ok(PROSE.nothing(statistics, &Q14_NEEDED));
    };
    let mut draft = Draft::of(PROSE);
    draft.weakness("pressed", values!(overlap));
    for drive in [along, wave] {
        let name = &drive.name;
        for (force, flow, efficiency) in &drive.flows {
            let head = number(-force, 4);
            draft.quantity("flow", values!(drive = name, head), *flow);
            draft.quantity("efficiency", values!(drive = name, head), *efficiency);
        }
    }
    let loaded = |drive: &Drive| cell(drive.loaded().map(|it| it.1));
    let efficiency = |drive: &Drive| cell(drive.loaded().and_then(|it| it.2));
    let summary = PROSE.text(
        "summary",
        values!(
            segments = number(SEGMENTS, 0),
            forward = cell(along.flow()),
            wave = cell(wave.flow()),
            head = cell_of(along.loaded(), |it| number(-it.0, 4)),
            loaded = loaded(along),
            wave_loaded = loaded(wave),
            efficiency = efficiency(along),
            wave_efficiency = efficiency(wave),
            best = best.order,
            most = cell(best.flow()),
            worst = worst.order,
            least = cell(worst.flow())
        ),
    );
    let rows = waves.iter().chain(&segments).map(Drive::cells);
    draft.table("sequences", &[], rows);
    draft.chart("sequences", &[], ChartFigure::new(orders(&same, wave)))?;
    Ok(draft.concluded(Verdict::Answered, summary, statistics, &Q14_NEEDED))
}

/// What drives are ordered by: their flow without head.
fn order_of(drive: &Drive) -> f64 {
    drive.flow().map_or(f64::NEG_INFINITY, |flow| flow.value)
}

/// The flow of each order, by ascending flow, beside the wave.
fn orders(drives: &[&Drive], wave: &Drive) -> ChartPanel {
    let names: Vec<String> = drives
        .iter()
        .map(|drive| drive.order.replace(' ', ""))
        .collect();
    let place = |number: usize| number as f64 + 1.0;
    let series = |name: &str, flow: &dyn Fn(&Drive) -> Option<Uncertain>| {
        let known = drives.iter().enumerate();
        points(
            name,
            known.filter_map(|(number, drive)| Some((place(number), flow(drive)?))),
        )
    };
    let free = series("no head", &Drive::flow);
    let loaded = series("head", &|drive| drive.loaded().map(|it| it.1));
    let title = format!("order: {}", names.join(", "));
    let panel = ChartPanel::new(&title, &label(Axis::FlowRateRatio));
    let panel = panel.with_all(numbered([free, loaded]));
    match wave.flow() {
        None => panel,
        Some(flow) => {
            let ends = [place(0), place(drives.len() - 1)];
            let line = Curve::new(WAVE, &ends, &[flow.value; 2]);
            panel.with(line.tint(Tint::Black).pattern(Pattern::Dotted))
        }
    }
}
