//! The page, read by a parser of HTML.

use std::collections::HashSet;

use peristalsis_reproduce::report::Report;
use peristalsis_reproduce::{Outcome, Size};
use peristalsis_study::Ending;
use scraper::{ElementRef, Html, Selector};

use crate::{HOSTILE, hostile, specimen};

fn parsed(report: &Report) -> Html {
    let page = Html::parse_document(&report.html());
    assert_eq!(page.errors, Vec::<std::borrow::Cow<'static, str>>::new());
    page
}

fn all<'a>(page: &'a Html, selector: &str) -> Vec<ElementRef<'a>> {
    page.select(&Selector::parse(selector).unwrap()).collect()
}

fn text(element: ElementRef<'_>) -> String {
    let words: String = element.text().collect();
    words.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn texts(page: &Html, selector: &str) -> Vec<String> {
    all(page, selector).into_iter().map(text).collect()
}

#[test]
fn every_claim_has_its_verdict_and_what_is_behind_it() {
    let page = parsed(&specimen().unwrap());
    assert_eq!(
        texts(&page, "table.overview tbody td:nth-child(2)"),
        [
            "reproduced",
            "open thin statistics",
            "differs",
            "differs",
            "open not examined",
            "answered"
        ]
    );
    assert_eq!(texts(&page, "section.claim").len(), 6);
    assert_eq!(
        texts(&page, ".tally"),
        ["1 reproduced 2 different 1 answered 2 open"]
    );
    assert_eq!(
        texts(&page, "#claim-f2 .quantities tbody tr:first-child td"),
        ["1.03+0.18−0.06", "[0.92, 1.47]", "1", "+0.5 σ"]
    );
    assert_eq!(
        texts(&page, "#claim-f2 .quantities tbody tr:last-child td"),
        ["not determined", "–", "1", "–"]
    );
    assert!(
        text(all(&page, "#claim-f2 .statistics")[0])
            .contains("too few for a verdict, which takes 4 × 8 × 10")
    );
    assert_eq!(
        all(&page, "#claim-f2 figure svg[role=img]").len(),
        2 + labels(&page)
    );
    assert_eq!(all(&page, "#claim-f2 figure.table tbody tr").len(), 4);
    assert!(text(all(&page, "#claim-f9 .failure")[0]).contains("disk I/O error"));
    assert!(all(&page, "#claim-f9 .statistics").is_empty());
    assert!(
        text(all(&page, "#study-divergence-coarse .meta")[0])
            .contains("60 of 72 runs finished, 2 failed, 10 missing")
    );
    assert!(
        text(all(&page, "#study-divergence-coarse pre")[0])
            .contains("keys = [\"drive.strain_rate\", \"drive.width\"]")
    );
    // Markup has become elements.
    assert_eq!(texts(&page, "#claim-f2 blockquote sub"), ["c", "c"]);
    assert!(!texts(&page, "main")[0].contains("*w*"));
}

/// Windows within drawings are `svg` elements, too, but none with a role.
fn labels(page: &Html) -> usize {
    all(page, "svg svg[role=img]").len()
}

#[test]
fn names_are_unique_and_references_lead_to_them() {
    let page = parsed(&specimen().unwrap());
    let names: Vec<&str> = all(&page, "[id]")
        .iter()
        .map(|element| element.attr("id").unwrap())
        .collect();
    let unique: HashSet<&str> = names.iter().copied().collect();
    assert_eq!(names.len(), unique.len());
    // Three figures share glyphs.
    assert!(names.len() > 50);
    let references = all(&page, "[href]");
    assert!(references.len() > 100);
    for element in references {
        let target = element.attr("href").unwrap();
        assert!(
            unique.contains(target.strip_prefix('#').unwrap()),
            "{target}"
        );
    }
    for element in all(&page, "[aria-labelledby]") {
        assert!(unique.contains(element.attr("aria-labelledby").unwrap()));
    }
}

#[test]
fn the_page_needs_no_other_file_and_no_program() {
    let html = specimen().unwrap().html();
    let page = Html::parse_document(&html);
    assert!(
        all(
            &page,
            "script, link, iframe, object, [src], [onclick], [onload]"
        )
        .is_empty()
    );
    // Addresses occur as names of XML, and nowhere else.
    let addresses = html.matches("http").count();
    assert_eq!(
        addresses,
        html.matches("xmlns=\"http://www.w3.org/2000/svg\"").count()
    );
    assert!(!html.contains("@import") && !html.contains("url(\"") && !html.contains("url(h"));
}

#[test]
fn readers_who_do_not_see_are_told_what_is_there() {
    let page = parsed(&specimen().unwrap());
    assert_eq!(all(&page, "html[lang=en] head title").len(), 1);
    assert_eq!(all(&page, "h1").len(), 1);
    for drawing in all(&page, ".drawing > svg") {
        assert_eq!(drawing.attr("role"), Some("img"));
        assert!(drawing.attr("aria-label").unwrap().len() > 20);
    }
    for table in all(&page, "table") {
        let heads = Selector::parse("thead th[scope=col]").unwrap();
        assert!(table.select(&heads).count() > 1);
    }
    // Contents, verdict by wall, overview, six claims, studies, how to read.
    assert_eq!(all(&page, "nav[aria-label] a").len(), 1 + 1 + 1 + 6 + 2);
}

#[test]
fn hostile_text_stays_text() {
    let report = hostile();
    let page = Html::parse_document(&report.html());
    assert!(all(&page, "script").is_empty());
    assert_eq!(all(&page, "main > section.claim").len(), 6);
    // In the overview, the section, the paragraph, the weakness, the quantity (4), the table (3), the caption, ...
    let shown = text(all(&page, "body")[0])
        .matches("<script>alert(\"x\")</script> & 'q' --> ]]>")
        .count();
    assert!(shown >= 15, "{shown}");
    let label = all(&page, "#claim-f2 .drawing > svg")[0]
        .attr("aria-label")
        .unwrap();
    assert_eq!(label, HOSTILE);
}

#[test]
fn the_same_findings_give_the_same_bytes_and_other_ones_others() {
    let (one, mut other) = (specimen().unwrap(), specimen().unwrap());
    assert_eq!(one.html(), other.html());
    assert_eq!(one.json(), other.json());
    other.size = Size::Full;
    assert_ne!(one.html(), other.html());
    assert!(one.html().contains("This is the <b>quick</b> design"));
    assert!(!other.html().contains("This is the <b>quick</b> design"));
}

#[test]
fn a_report_of_nothing_is_a_page() {
    let report = Report::of(
        Size::Quick,
        Outcome {
            ending: Ending::Stopped,
            examinations: Vec::new(),
            studies: Vec::new(),
            published: Vec::new(),
            drawn: None,
        },
    );
    let page = parsed(&report);
    assert_eq!(texts(&page, "#overview p"), ["No claim was examined."]);
    assert!(all(&page, "#studies").is_empty());
}
