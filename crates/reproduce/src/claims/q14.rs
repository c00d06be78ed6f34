//! Q14: segments that close in turn beside a smooth wave of equal stroke.

use peristalsis_physics::wall::Waveform;

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("q14.md"));
const STUDIES: &[&str] = &["segments", "segments-wave"];

pub(super) const CLAIM: Claim =
    Claim::new("Q14", PROSE, STUDIES, examine).varying("back pressure", Q14_NEEDED);

/// The smooth wave that opens the tube as little as segments do.
const WAVE: &str = "bolus";
/// Difference of two strokes that are the same.
const SAME_STROKE: f64 = 1e-9;
/// Segments whose orders are compared.
const SEGMENTS: f64 = 4.0;

/// What a drive does against one head.
struct Flow {
    /// Body force along the wave \[d/t^2\].
    body_force: f64,
    flow: Uncertain,
    /// What flows against the wave in a stroke, over Jmax; missing of rows without it.
    back: Option<Uncertain>,
    efficiency: Option<Uncertain>,
}

/// One drive and filling, without and with a head.
struct Drive {
    name: String,
    /// Numbers of the segments in the order in which they close, from the first of them on; empty of a wave.
    order: String,
    /// None of a wave.
    number: Option<f64>,
    duty: Option<f64>,
    /// Part of the tube that is squeezed, averaged over a period.
    squeeze: f64,
    filling: f64,
    /// By descending body force: without head first.
    flows: Vec<Flow>,
}

impl Drive {
    fn free(&self) -> Option<&Flow> {
        self.flows.iter().find(|it| it.body_force == 0.0)
    }

    fn flow(&self) -> Option<Uncertain> {
        self.free().map(|it| it.flow)
    }

    /// Against the largest head.
    fn loaded(&self) -> Option<&Flow> {
        self.flows.last().filter(|it| it.body_force < 0.0)
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
            number(self.filling, 1),
            cell(self.flow()),
            cell(self.free().and_then(|it| it.back)),
            cell(loaded.map(|it| it.flow)),
            cell(loaded.and_then(|it| it.back)),
            cell(loaded.and_then(|it| it.efficiency)),
        ]
    }
}

/// The flows of some rows by descending body force.
fn flows(rows: Vec<Row<'_>>) -> Vec<Flow> {
    let back = |row: &Row<'_>| {
        // Jmax = N c/L.
        let most = row.number("grains") * row.strain_rate() / row.number("waves");
        let (flow, error) = row.number_and_error("back_flow");
        (flow / most, error / most)
    };
    let by_force = grouped(rows, |row| row.number_or("body_force", 0.0));
    let of = |(body_force, rows): (f64, Vec<Row<'_>>)| {
        Some(Flow {
            body_force,
            flow: mean(&rows, "flow_rate_ratio")?,
            back: mean_of(&rows, back),
            efficiency: mean(&rows, "pumping_efficiency"),
        })
    };
    by_force.into_iter().rev().filter_map(of).collect()
}

/// Number of segments, their order, and duty, rise and fall of a run; its filling.
fn cycle<'a>(row: &Row<'a>) -> (f64, &'a str, [f64; 4]) {
    let [duty, rise, fall] =
        ["drive.duty", "drive.rise", "drive.fall"].map(|column| row.number(column));
    let numbers = [duty, rise, fall, row.volume_fraction()];
    (
        row.number("drive.segments"),
        row.text("drive.order"),
        numbers,
    )
}

/// Filling and shape of a wave.
fn shape<'a>(row: &Row<'a>) -> (f64, &'a str) {
    (row.volume_fraction(), row.text("drive.waveform"))
}

fn segments(rows: Vec<Row<'_>>) -> Vec<Drive> {
    let drives = grouped(rows, cycle);
    drives
        .into_iter()
        .map(
            |((segments, order, [duty, rise, fall, filling]), rows)| Drive {
                name: format!("{segments} segments"),
                order: order.trim_matches(['[', ']']).replace(", ", " "),
                number: Some(segments),
                duty: Some(duty),
                squeeze: duty + 0.5 * (rise + fall),
                filling,
                flows: flows(rows),
            },
        )
        .collect()
}

fn waves(rows: Vec<Row<'_>>) -> Vec<Drive> {
    let drive = |((filling, name), rows): ((f64, &str), Vec<Row<'_>>)| Drive {
        name: name.to_owned(),
        order: String::new(),
        number: None,
        duty: None,
        squeeze: serde_json::from_value(name.into())
            .map_or(f64::NAN, |waveform: Waveform| 0.0 - waveform.mean()),
        filling,
        flows: flows(rows),
    };
    let waves = grouped(rows, shape).into_iter();
    waves.map(drive).collect()
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let of_segments = evidence.study(STUDIES[0])?.rows();
    let of_waves = evidence.study(STUDIES[1])?.rows();
    let statistics = behind(&of_segments, |row| row.number_or("body_force", 0.0));
    let by_duty = grouped(of_segments.iter().copied(), |row| row.number("drive.duty"));
    let Some((duty, pressed)) = by_duty.last() else {
        return Ok(PROSE.nothing(statistics));
    };
    let most = |column| largest(pressed, |row| row.number(column));
    let overlap = number(most("largest_overlap"), 2);
    let often = number(100.0 * most("pressed"), 0);
    let (segments, waves) = (segments(of_segments), waves(of_waves));
    let wave = waves.iter().find(|drive| drive.name == WAVE);
    let Some(wave) = wave else {
        return Ok(PROSE.nothing(statistics));
    };
    let mut same: Vec<&Drive> = segments
        .iter()
        .filter(|drive| drive.number == Some(SEGMENTS))
        .filter(|drive| (drive.squeeze - wave.squeeze).abs() < SAME_STROKE)
        .filter(|drive| drive.filling == wave.filling)
        .collect();
    let along = same.iter().find(|drive| drive.is_along()).copied();
    same.sort_by(|one, other| order_of(one).total_cmp(&order_of(other)));
    let (Some(along), [worst, .., best]) = (along, &same[..]) else {
        return Ok(PROSE.nothing(statistics));
    };
    let mut draft = Draft::of(PROSE);
    draft.weakness("pressed", values!(duty = number(*duty, 2), overlap, often));
    for drive in [along, wave] {
        let name = &drive.name;
        for flow in &drive.flows {
            let head = number(-flow.body_force, 3);
            draft.quantity("flow", values!(drive = name, head), flow.flow);
            draft.quantity("back", values!(drive = name, head), flow.back);
            draft.quantity("efficiency", values!(drive = name, head), flow.efficiency);
        }
    }
    let efficiency = |drive: &Drive| drive.loaded().and_then(|it| it.efficiency);
    let loaded = |drive: &Drive| cell(drive.loaded().map(|it| it.flow));
    let back = |drive: &Drive| cell(drive.loaded().and_then(|it| it.back));
    let is_fuller = |drive: &&Drive| drive.filling > wave.filling;
    let fuller = segments
        .iter()
        .filter(is_fuller)
        .find(|drive| drive.is_along());
    let fuller_wave = waves
        .iter()
        .filter(is_fuller)
        .find(|drive| drive.name == WAVE);
    let other = fuller.zip(fuller_wave).map(|(one, wave)| {
        PROSE.text(
            "fuller",
            values!(
                filling = number(one.filling, 1),
                flow = loaded(one),
                wave = loaded(wave),
                efficiency = cell(efficiency(one)),
                wave_efficiency = cell(efficiency(wave))
            ),
        )
    });
    let times = efficiency(wave).zip(efficiency(along)).map(|(wave, own)| {
        let times = wave.value / own.value;
        let relative = (wave.error / wave.value).hypot(own.error / own.value);
        Uncertain::normal(times, times * relative)
    });
    draft.quantity("times", &[], times);
    let summary = PROSE.text(
        "summary",
        values!(
            segments = number(SEGMENTS, 0),
            forward = cell(along.flow()),
            wave = cell(wave.flow()),
            head = cell_of(along.loaded(), |it| number(-it.body_force, 3)),
            loaded = loaded(along),
            wave_loaded = loaded(wave),
            efficiency = cell(efficiency(along)),
            wave_efficiency = cell(efficiency(wave)),
            best = best.order,
            most = cell(best.flow()),
            worst = worst.order,
            least = cell(worst.flow()),
            worst_back = back(worst),
            back = back(along),
            fuller = other.unwrap_or_default()
        ),
    );
    let rows = waves.iter().chain(&segments).map(Drive::cells);
    draft.table("sequences", &[], rows);
    draft.chart("sequences", &[], ChartFigure::new(orders(&same, wave)))?;
    Ok(draft.concluded(Verdict::Answered, summary, statistics))
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
    let free = series("no back pressure", &Drive::flow);
    let loaded = series("back pressure", &|drive| drive.loaded().map(|it| it.flow));
    let panel = ChartPanel::new(
        "order in which the segments close",
        &label(Axis::FlowRateRatio),
    )
    .x_names(&names)
    .with_all(numbered([free, loaded]));
    match wave.flow() {
        None => panel,
        Some(flow) => {
            let ends = [place(0), place(drives.len() - 1)];
            let line = Curve::new(WAVE, &ends, &[flow.value; 2]);
            panel.with(line.tint(Tint::Black).pattern(Pattern::Dotted))
        }
    }
}
