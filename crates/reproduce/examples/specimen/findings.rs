//! Made-up findings with everything that a report can hold.

use std::f64::consts::TAU;

use peristalsis_analysis::{Interval, Uncertain};
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line, Reference, Tint};
use peristalsis_figures::{Drawing, FigureError, Width};
use peristalsis_reproduce::report::{Program, Report};
use peristalsis_reproduce::{
    Claim, ClaimError, Evidence, Examination, Finding, Prose, Quantity, ReportFigure, ReportTable,
    Size, Statistics, StudyFile, StudyOutcome, Verdict,
};

const STUDY: &str = r#"# Transition times from rest as the bottleneck widens to the critical one.
name = "divergence-fine"
title = "Transition times near the critical bottleneck, fine lattice"
preset = "frictionless-fine"
states = ["rest"]
replicates = 4

[[axes]]                        # six widths about where the jump was found first
keys = ["drive.strain_rate", "drive.width"]
rows = [
    [0.05, 2.545], [0.05, 2.715], [0.05, 2.805], [0.05, 2.85], [0.05, 2.875], [0.05, 2.925], [0.1, 2.445], [0.1, 2.615],
    [0.2, 2.225], [0.2, 2.395], [0.2, 2.485], [0.2, 2.53], [0.2, 2.555], [0.2, 2.605],
]
"#;

const FINE: StudyFile = StudyFile::new(
    "divergence-fine",
    "studies/divergence-fine.toml",
    STUDY,
    STUDY,
);
const COARSE: StudyFile = StudyFile::new(
    "divergence-coarse",
    "studies/divergence-coarse.toml",
    STUDY,
    STUDY,
);

fn unexamined(_: &Evidence) -> Result<Finding, ClaimError> {
    Err(ClaimError::NoSuchStudy("none".to_owned()))
}

const fn claim(
    id: &'static str,
    markdown: &'static str,
    studies: &'static [&'static str],
) -> Claim {
    Claim {
        id,
        prose: Prose::new(markdown),
        studies,
        examine: unexamined,
    }
}

const CLAIMS: [Claim; 6] = [
    claim(
        "F1",
        "# Two kinds of flow\n\nSource: talk, slides 14 to 18\n\n\
         From rest, a wide bottleneck keeps a steady slow flow; in a narrow one an unsteady slow flow turns at a time *τ* into a \
         steady fast one with *J* near *J*_{max}.\n",
        &["divergence-fine"],
    ),
    claim(
        "F2",
        "# The transition time diverges\n\nSource: talk, slides 14 to 18\n\n\
         *τ* diverges as *w* → *w*_c from below: *τ* ~ (*w*_c − *w*)^{−1}.\n",
        &["divergence-fine"],
    ),
    claim(
        "F6",
        "# The flow rate jumps\n\nSource: talk, slides 14 to 18\n\n\
         The stationary *J*/*J*_{max} against *w* jumps at *w*_c(*ε\u{307}*): a discontinuous transition, which peristalsis of a \
         Newtonian fluid does not have.\n",
        &["divergence-fine", "divergence-coarse"],
    ),
    claim(
        "F7",
        "# The critical bottleneck shrinks with the strain rate\n\nSource: talk, slides 14 to 18\n\n\
         *w*_c falls linearly with *ε\u{307}*: *w*_c = −3.75 *ε\u{307}* + *w*_{max}.\n",
        &["divergence-fine", "divergence-coarse"],
    ),
    claim(
        "F9",
        "# Hysteresis\n\nSource: talk, slides 14 to 18\n\n\
         From jammed, a narrow bottleneck stays jammed and a wide one turns at some time into slow flow, at *w*'_c ≠ *w*_c.\n",
        &["divergence-coarse"],
    ),
    claim(
        "Q1",
        "# Slow waves\n\nSource: talk, slides 14 to 18\n\n\
         What is *w*_c for *ε\u{307}* ≤ 10^{−2}?\n",
        &["divergence-coarse"],
    ),
];

/// A run that jams at `onset` periods.
fn flow(periods: usize, onset: f64, width: Width) -> Result<Drawing, FigureError> {
    let level = |period: f64| {
        0.2 + 0.06 * libm::sin(period / 9.0) + 0.76 / (1.0 + libm::exp(-(period - onset) / 0.9))
    };
    let (mut time, mut ratio) = (Vec::new(), Vec::new());
    let (mut middles, mut averages) = (Vec::new(), Vec::new());
    for period in 0..periods {
        for part in 0..10 {
            let at = period as f64 + f64::from(part) / 10.0;
            time.push(at);
            ratio.push(level(at) + 0.05 * libm::sin(TAU * 2.0 * at) * libm::sin(11.3 * at));
        }
        middles.push(period as f64 + 0.5);
        averages.push(level(period as f64 + 0.5));
    }
    let panel = ChartPanel::new("time, *t*/*T*", "flow rate, *J*/*J*_{max}")
        .y_range(0.0..=1.05)
        .with(Line::new("samples", &time, &ratio).tint(Tint::Sky))
        .with(Line::new("mean over a period", &middles, &averages).tint(Tint::Blue))
        .with(Reference::horizontal(0.5).label("threshold"))
        .with(Reference::vertical(onset).tint(Tint::Vermillion));
    ChartFigure::new(panel)
        .title("*w* = 2.75 *d*, *ε\u{307}* = 0.05, *ρ* = 0.15, *N* = 202")
        .width(width)
        .draw()
}

fn quantity(name: &str, symbol: &str, source: Option<f64>, ours: Option<Uncertain>) -> Quantity {
    Quantity {
        name: name.to_owned(),
        symbol: symbol.to_owned(),
        unit: String::new(),
        source,
        ours,
        method: "weighted fit of the law; bootstrap over runs".to_owned(),
    }
}

fn texts<const N: usize>(texts: [&str; N]) -> Vec<String> {
    texts.map(str::to_owned).to_vec()
}

/// What every verdict begins with.
fn finding(verdict: Verdict, summary: &str, statistics: [usize; 4]) -> Finding {
    let [strain_rates, widths, replicates, runs] = statistics;
    let statistics = Statistics {
        strain_rates,
        widths,
        replicates,
        runs,
    };
    Finding::new(
        verdict,
        summary.to_owned(),
        statistics,
        &Statistics::FOR_A_VERDICT,
    )
}

fn divergence() -> Result<Finding, FigureError> {
    let open = Uncertain {
        interval_68: Interval {
            lower: 2.876,
            upper: f64::INFINITY,
        },
        interval_95: Interval {
            lower: 2.862,
            upper: f64::INFINITY,
        },
        ..Uncertain::normal(2.882, 0.009)
    };
    let skew = Uncertain {
        interval_68: Interval {
            lower: 0.97,
            upper: 1.21,
        },
        interval_95: Interval {
            lower: 0.92,
            upper: 1.47,
        },
        ..Uncertain::normal(1.03, 0.12)
    };
    Ok(Finding {
        quantities: vec![
            quantity(
                "exponent of the mean transition time, *ε\u{307}* = 0.05",
                "*α*",
                Some(1.0),
                Some(skew),
            ),
            quantity(
                "exponent of the mean transition time, *ε\u{307}* = 0.1",
                "*α*",
                Some(1.0),
                Some(Uncertain::normal(1.084, 0.041)),
            ),
            Quantity {
                unit: "*d*".to_owned(),
                ..quantity(
                    "critical bottleneck, *ε\u{307}* = 0.05",
                    "*w*_c",
                    None,
                    Some(open),
                )
            },
            quantity(
                "amplitude of the law",
                "*A*",
                None,
                Some(Uncertain::normal(3.21e-6, 4.0e-7)),
            ),
            quantity("exponent, *ε\u{307}* = 0.2", "*α*", Some(1.0), None),
        ],
        figures: vec![
            ReportFigure {
                name: "transition-times".to_owned(),
                caption: "Flow rate *J*/*J*_{max} against time in periods for the bottleneck next to the critical one. Faint: samples; \
                          strong: averages over periods; the vertical line is *τ*."
                    .to_owned(),
                drawing: flow(60, 22.0, Width::SingleColumn)?,
            },
            ReportFigure {
                name: "transition-times-long".to_owned(),
                caption: "The same over a thousand periods.".to_owned(),
                drawing: flow(400, 310.0, Width::DoubleColumn)?,
            },
        ],
        paragraphs: texts([
            "Each run from rest gives a transition time *τ*, or none before its end: then it is *censored*, and not dropped. Near *w*_c \
             the longest times are cut off by the length of the runs, so the mean of those that did turn is too small. We therefore fit \
             the law *τ* = *A* (*w*_c − *w*)^{−*α*} to all runs at once by their censored likelihood.",
            "The exponent is stable against the window of the fit: without the two widths next to *w*_c it is 1.06 ± 0.05, without the two \
             farthest 1.10 ± 0.06.",
        ]),
        tables: vec![ReportTable {
            caption: "Mean transition time *τ* \\[(*m*/*k*)^{1/2}\\] at each width, Kaplan-Meier; in the last column the runs that \
                      ended before a transition."
                .to_owned(),
            head: texts(["*w*/*d*", "*ε\u{307}* = 0.05", "*ε\u{307}* = 0.1", "*ε\u{307}* = 0.2", "censored"]),
            rows: vec![
                texts(["2.545", "93 ± 2", "212 ± 6", "–", "0 of 30"]),
                texts(["2.715", "188 ± 7", "670 ± 30", "–", "0 of 30"]),
                texts(["2.805", "400 ± 20", "–", "–", "2 of 30"]),
                texts(["2.850", "1210 ± 90", "–", "–", "7 of 30"]),
            ],
        }],
        weaknesses: texts([
            "The power law is one of several laws that diverge; a barrier law fits nearly as well (see F5).",
            "All runs have ten waves: the tube's length may round the divergence.",
        ]),
        ..finding(
            Verdict::Open,
            "The exponent is *α* = 1.08 ± 0.04 at *ε\u{307}* = 0.1, where the source has 1; three strain rates and four replicates do not \
             allow a verdict.",
            [3, 6, 4, 72],
        )
    })
}

/// A report with claims of every verdict.
pub(crate) fn specimen() -> Result<Report, FigureError> {
    let findings = [
        (
            Finding {
                figures: vec![ReportFigure {
                    name: "two-kinds".to_owned(),
                    caption: "A run that turns from slow to fast flow.".to_owned(),
                    drawing: flow(60, 30.0, Width::SingleColumn)?,
                }],
                ..finding(
                    Verdict::Reproduced,
                    "All 212 runs below *w*_c turn to *J*/*J*_{max} ≥ 0.95; none of 148 above it does within 1000 periods.",
                    [6, 12, 30, 2160],
                )
            },
            None,
        ),
        (divergence()?, None),
        (
            finding(
                Verdict::Differs,
                "*J*/*J*_{max} jumps by 0.873 ± 0.004 on the fine lattice, as the source says, but falls over a range of 0.06 *d* on the \
                 coarse one.",
                [6, 12, 30, 4320],
            ),
            None,
        ),
        (
            Finding {
                quantities: vec![quantity(
                    "slope, fine lattice",
                    "d*w*_c/d*ε\u{307}*",
                    Some(-3.75),
                    Some(Uncertain::normal(-2.21, 0.06)),
                )],
                ..finding(
                    Verdict::Differs,
                    "*w*_c falls linearly, but with the slope −2.21 ± 0.06 on the fine lattice.",
                    [6, 12, 30, 4320],
                )
            },
            None,
        ),
        (
            finding(Verdict::Open, "It could not be examined.", [0; 4]),
            Some(
                "study divergence-coarse: the index of the store, stores/divergence-coarse/index.sqlite: disk I/O error"
                    .to_owned(),
            ),
        ),
        (
            finding(
                Verdict::Answered,
                "It turns back: *w*_c is largest at *ε\u{307}* = 0.021 ± 0.002.",
                [5, 8, 10, 400],
            ),
            None,
        ),
    ];
    let outcome = |file: StudyFile, done, failed, failure: Option<&str>| StudyOutcome {
        file,
        title: "Transition times near the critical bottleneck".to_owned(),
        runs: 72,
        done,
        failed,
        failure: failure.map(str::to_owned),
    };
    Ok(Report {
        size: Size::Quick,
        program: Program {
            version: "0.1.0".to_owned(),
            revision: "0123456789ab".to_owned(),
            physics_version: 1,
        },
        examinations: CLAIMS
            .into_iter()
            .zip(findings)
            .map(|(claim, (finding, failure))| Examination {
                claim,
                finding,
                failure,
            })
            .collect(),
        studies: vec![
            outcome(FINE, 72, 0, None),
            outcome(
                COARSE,
                60,
                2,
                Some("stores/divergence-coarse/index.sqlite: disk I/O error"),
            ),
        ],
    })
}
