//! `peristalsis validate`.

use crate::Place;

#[test]
fn cases_are_run_written_and_put_into_a_document() {
    let place = Place::new();
    let document = "before\n<!-- validate summary -->\nold\n<!-- /validate -->\n<!-- validate chain -->\n<!-- /validate -->\nafter\n";
    std::fs::write(place.path("document.md"), document).unwrap();
    let outcome = place.does("validate --quick --only chain --out out --write document.md --json");
    let found = outcome.json();
    let cases = found["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 1);
    assert_eq!(cases[0]["name"], "chain");
    assert_eq!(cases[0]["passed"], true, "{}", outcome.stdout);
    assert!(place.path("out/validation.json").is_file() && place.path("out/chain.csv").is_file());
    let written = std::fs::read_to_string(place.path("document.md")).unwrap();
    assert!(
        written.starts_with("before\n")
            && written.ends_with("after\n")
            && written.contains("| frequency |")
    );
}

#[test]
fn what_cannot_be_validated_is_said_before_the_work() {
    let place = Place::new();
    std::fs::write(place.path("document.md"), "no places\n").unwrap();
    place.refuses("validate --only chains", &["chains", "slip-to-roll"]);
    place.refuses(
        "validate --quick --only chain --write document.md",
        &["document.md", "<!-- validate"],
    );
    assert_eq!(
        std::fs::read_to_string(place.path("document.md")).unwrap(),
        "no places\n"
    );
}
