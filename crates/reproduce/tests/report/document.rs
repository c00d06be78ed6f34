//! The document in Markdown.

use peristalsis_reproduce::report::Report;
use peristalsis_reproduce::{Verdict, WallVerdict};

use crate::{hostile, specimen};

fn rows(report: &Report) -> Vec<String> {
    let text = report.markdown("pictures");
    let rows = text.lines().filter(|line| line.starts_with('|'));
    rows.map(str::to_owned).collect()
}

#[test]
fn every_claim_has_a_row_and_a_section() {
    let report = specimen().unwrap();
    let text = report.markdown("pictures");
    for examination in &report.examinations {
        let id = examination.experiment.id;
        let small = id.to_lowercase();
        for part in [
            format!("| [{id}](#{small}) "),
            format!("<a id=\"{small}\"></a>\n\n## {id}. "),
        ] {
            assert!(text.contains(&part), "{part}");
        }
    }
    for part in [
        "reproduced: 1, differs: 2, answered: 1, open: 2",
        "](pictures/transition-times.svg)",
        "\nWeaknesses:\n\n- ",
        "**open** – It could not be examined: ",
    ] {
        assert!(text.contains(part), "{part}");
    }
}

#[test]
fn walls_stand_across_with_the_claims_that_each_meets() {
    let mut report = specimen().unwrap();
    for examination in &mut report.examinations {
        examination.finding.walls.clear();
    }
    let wall = |wall: &str, verdict| WallVerdict {
        wall: wall.to_owned(),
        verdict,
        depends_on: Vec::new(),
        number: "*α* = 1.1 ± 0.2".to_owned(),
        why: "so".to_owned(),
    };
    let walls = vec![
        wall("24 × 26", Verdict::Reproduced),
        wall("12 × 14", Verdict::Differs),
    ];
    report.examinations[1].finding.walls = walls;
    report.examinations[2].finding.walls = vec![wall("12 × 14", Verdict::Open)];
    let rows = rows(&report);
    let head = "| claim | verdict | 24 × 26 | 12 × 14 | result |";
    assert_eq!(rows[0], head);
    let found = "| reproduced: α = 1.1 ± 0.2 | differs: α = 1.1 ± 0.2 | |";
    assert!(rows[3].contains(found), "{}", rows[3]);
    let met = rows.iter().find(|row| row.starts_with("| claims met"));
    assert_eq!(met.unwrap(), "| claims met | | 1 of 1 | 0 of 1 | |");
    let text = report.markdown("pictures");
    assert!(text.contains("\n| 24 × 26 | reproduced | α = 1.1 ± 0.2 | so |\n"));
}

#[test]
fn text_that_would_break_the_document_is_escaped() {
    let text = hostile().markdown("pictures");
    assert!(!text.contains("<script") && !text.contains("</section>") && !text.contains('\u{7}'));
    let cells = |row: &String| row.replace("\\|", "").matches('|').count();
    let counts = |report: &Report| rows(report).iter().map(cells).collect::<Vec<_>>();
    assert_eq!(counts(&hostile()), counts(&specimen().unwrap()));
}
