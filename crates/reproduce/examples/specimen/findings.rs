//! Made-up findings with everything that a report can hold.

use peristalsis_analysis::{Interval, Uncertain};
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line, Reference};
use peristalsis_figures::{FigureError, Width};
use peristalsis_reproduce::report::{Program, Report};
use peristalsis_reproduce::{
    Claim, Examination, Finding, Prose, Quantity, ReportFigure, ReportTable, ReproduceError, Size,
    Statistics, StudyFile, StudyOutcome, Verdict, WallVerdict, Without,
};

const STUDY: &str = r#"# Transition times from rest as the bottleneck widens to the critical one.
name = "divergence-fine"
preset = "frictionless-fine"
replicates = 4

[[axes]]                        # six widths about where the jump was found first
keys = ["drive.strain_rate", "drive.width"]
rows = [[0.05, 2.545], [0.05, 2.715], [0.1, 2.445], [0.1, 2.615], [0.2, 2.225], [0.2, 2.395]]
"#;

const FINE: StudyFile =
    StudyFile::new("divergence-fine", "studies/divergence-fine.toml", STUDY, "");
const COARSE: StudyFile = StudyFile::new(
    "divergence-coarse",
    "studies/divergence-coarse.toml",
    STUDY,
    "",
);

/// A claim of the source that needs studies.
macro_rules! claim {
    ($id:literal, $title:literal, $statement:literal, $studies:expr) => {
        Claim::new(
            $id,
            Prose::new(concat!(
                "# ",
                $title,
                "\n\nSource: talk, slides 14 to 18\n\n",
                $statement
            )),
            $studies,
            |_| Err(ReproduceError::NoSuchStudy("none".to_owned())),
        )
    };
}

const CLAIMS: [Claim; 6] = [
    claim!(
        "F1",
        "Two kinds of flow",
        "A wide bottleneck keeps a slow flow; in a narrow one it turns at a time *τ* into a fast one.",
        &["divergence-fine"]
    ),
    claim!(
        "F2",
        "The transition time diverges",
        "*τ* diverges as *w* → *w*_c from below: *τ* ~ (*w*_c − *w*)^{−1}.",
        &["divergence-fine"]
    ),
    claim!(
        "F6",
        "The flow rate jumps",
        "The stationary *J*/*J*_{max} against *w* jumps at *w*_c(*ε\u{307}*).",
        &["divergence-fine", "divergence-coarse"]
    ),
    claim!(
        "F7",
        "The critical width shrinks with the strain rate",
        "*w*_c falls linearly with *ε\u{307}*: *w*_c = −3.75 *ε\u{307}* + *w*_{max}.",
        &["divergence-fine", "divergence-coarse"]
    ),
    claim!(
        "F9",
        "Hysteresis",
        "From jammed, a wide bottleneck turns at some time into slow flow, at *w*'_c ≠ *w*_c.",
        &["divergence-coarse"]
    ),
    claim!(
        "Q1",
        "Slow waves",
        "What is *w*_c for *ε\u{307}* ≤ 10^{−2}?",
        &["divergence-coarse"]
    ),
];

/// The figure of a run that jams at `onset` periods.
fn flow(name: &str, onset: f64, width: Width) -> Result<ReportFigure, FigureError> {
    let period: Vec<f64> = (0..200)
        .map(|sample| 0.02 * f64::from(sample) * onset)
        .collect();
    let level = |period: &f64| 0.2 + 0.76 / (1.0 + libm::exp(onset - period));
    let ratio: Vec<f64> = period.iter().map(level).collect();
    let panel = ChartPanel::new("time *t*/*T* in periods", "flow rate *J*/*J*_{max}")
        .with(Line::new(
            "*w* = 2.75 *d*, *ε\u{307}* = 0.05",
            &period,
            &ratio,
        ))
        .with(Reference::vertical(onset).label("*τ*"));
    Ok(ReportFigure {
        name: name.to_owned(),
        caption: "Flow rate *J*/*J*_{max} against time in periods; the vertical line is *τ*."
            .to_owned(),
        drawing: ChartFigure::new(panel).width(width).draw()?,
    })
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

/// A finding with a verdict and nothing else yet.
fn finding(verdict: Verdict, summary: &str, statistics: [usize; 4]) -> Finding {
    let [strain_rates, widths, replicates, runs] = statistics;
    Finding {
        verdict,
        summary: summary.to_owned(),
        statistics: Statistics {
            strain_rates,
            widths,
            replicates,
            runs,
        },
        ..Finding::default()
    }
}

/// A number whose intervals have these ends.
fn between(value: f64, error: f64, narrow: [f64; 2], wide: [f64; 2]) -> Option<Uncertain> {
    let interval = |[lower, upper]: [f64; 2]| Interval { lower, upper };
    Some(Uncertain {
        value,
        error,
        interval_68: interval(narrow),
        interval_95: interval(wide),
    })
}

fn divergence() -> Result<Finding, FigureError> {
    let normal = |value, error| Some(Uncertain::normal(value, error));
    let skew = between(1.03, 0.12, [0.97, 1.21], [0.92, 1.47]);
    let open = between(2.882, 0.009, [2.876, f64::INFINITY], [2.862, f64::INFINITY]);
    let mut critical = quantity("critical width", "*w*_c", None, open);
    critical.unit = "*d*".to_owned();
    Ok(Finding {
        quantities: vec![
            quantity("exponent, *ε\u{307}* = 0.05", "*α*", Some(1.0), skew),
            quantity(
                "exponent, *ε\u{307}* = 0.1",
                "*α*",
                Some(1.0),
                normal(1.084, 0.041),
            ),
            critical,
            quantity("amplitude of the law", "*A*", None, normal(3.21e-6, 4.0e-7)),
            quantity("exponent, *ε\u{307}* = 0.2", "*α*", Some(1.0), None),
        ],
        figures: vec![
            flow("transition-times", 22.0, Width::SingleColumn)?,
            flow("transition-times-long", 310.0, Width::DoubleColumn)?,
        ],
        paragraphs: texts([
            "Each run from rest gives a transition time *τ*, or none before its end: then it is *censored*, and not dropped.",
            "The exponent is stable against the window of the fit: 1.06 ± 0.05 without the two widths next to *w*_c.",
        ]),
        tables: vec![ReportTable {
            caption: "Mean transition time *τ* \\[(*m*/*k*)^{1/2}\\] at each width.".to_owned(),
            head: texts([
                "*w*/*d*",
                "*ε\u{307}* = 0.05",
                "*ε\u{307}* = 0.1",
                "censored",
            ]),
            rows: vec![
                texts(["2.545", "93 ± 2", "212 ± 6", "0 of 30"]),
                texts(["2.715", "188 ± 7", "670 ± 30", "0 of 30"]),
                texts(["2.805", "400 ± 20", "–", "2 of 30"]),
                texts(["2.850", "1210 ± 90", "–", "7 of 30"]),
            ],
        }],
        weaknesses: texts([
            "The power law is one of several laws that diverge.",
            "All runs have ten waves: the tube's length may round the divergence.",
        ]),
        ..finding(
            Verdict::Open,
            "The exponent is *α* = 1.08 ± 0.04 at *ε\u{307}* = 0.1, where the source has 1.",
            [3, 6, 4, 72],
        )
    })
}

fn slope() -> Finding {
    let ours = Some(Uncertain::normal(-2.21, 0.06));
    let slope = quantity(
        "slope, fine lattice",
        "d*w*_c/d*ε\u{307}*",
        Some(-3.75),
        ours,
    );
    Finding {
        quantities: vec![slope],
        walls: vec![WallVerdict {
            wall: "24 × 26".to_owned(),
            verdict: Verdict::Differs,
            depends_on: vec![Without {
                strain_rate: 0.2,
                verdict: Verdict::Open,
            }],
            number: "slope −2.21 ± 0.06".to_owned(),
            why: "*ε\u{307}* = 0.03 to 0.2".to_owned(),
        }],
        ..finding(
            Verdict::Differs,
            "The slope is −2.21 ± 0.06.",
            [6, 12, 30, 4320],
        )
    }
}

/// A report with claims of every verdict.
pub(crate) fn specimen() -> Result<Report, FigureError> {
    let mut kinds = finding(Verdict::Reproduced, "All 212 runs turn.", [6, 12, 30, 2160]);
    kinds.figures = vec![flow("two-kinds", 30.0, Width::SingleColumn)?];
    let findings = [
        kinds,
        divergence()?,
        finding(
            Verdict::Differs,
            "*J*/*J*_{max} jumps by 0.873 ± 0.004.",
            [6, 12, 30, 4320],
        ),
        slope(),
        finding(Verdict::Open, "It could not be examined.", [0; 4]),
        finding(
            Verdict::Answered,
            "*w*_c is largest at 0.021 ± 0.002.",
            [5, 8, 10, 400],
        ),
    ];
    let disk = "stores/divergence-coarse/index.sqlite: disk I/O error";
    let outcome = |file: StudyFile, done, failed, failure: Option<&str>| StudyOutcome {
        file,
        title: "Transition times near the critical width".to_owned(),
        runs: 72,
        done,
        failed,
        failure: failure.map(str::to_owned),
    };
    let examinations = CLAIMS
        .into_iter()
        .zip(findings)
        .map(|(claim, finding)| Examination {
            experiment: claim,
            finding,
            failure: (claim.id == "F9").then(|| format!("study divergence-coarse: {disk}")),
        });
    Ok(Report {
        size: Size::Quick,
        program: Program {
            version: "0.1.0".to_owned(),
            revision: "0123456789ab".to_owned(),
            physics_version: 1,
        },
        examinations: examinations.collect(),
        studies: vec![
            outcome(FINE, 72, 0, None),
            outcome(COARSE, 60, 2, Some(disk)),
        ],
        published: Vec::new(),
        drawn: None,
    })
}
