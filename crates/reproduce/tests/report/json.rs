//! The file for programs.

use serde_json::{Value, json};

use crate::{HOSTILE, hostile, specimen};

fn parsed(text: &str) -> Value {
    assert!(text.ends_with("}\n"));
    serde_json::from_str(text).unwrap()
}

#[test]
fn claims_have_verdict_numbers_and_studies_with_counts() {
    let found = parsed(&specimen().unwrap().json());
    assert_eq!(found["format"], 2);
    assert_eq!(found["size"], "quick");
    assert_eq!(
        found["program"],
        json!({ "version": "0.1.0", "revision": "0123456789ab", "physics_version": 1 })
    );
    let verdicts: Vec<&str> = found["claims"]
        .as_array()
        .unwrap()
        .iter()
        .map(|claim| claim["verdict"].as_str().unwrap())
        .collect();
    assert_eq!(
        verdicts,
        [
            "reproduced",
            "open",
            "differs",
            "differs",
            "open",
            "answered"
        ]
    );
    let claim = &found["claims"][1];
    assert_eq!(claim["id"], "F2");
    assert_eq!(claim["sufficient"], false);
    assert_eq!(claim["failure"], Value::Null);
    assert_eq!(
        claim["statistics"],
        json!({ "strain_rates": 3, "widths": 6, "replicates": 4, "runs": 72 })
    );
    assert_eq!(claim["needed"]["replicates"], 10);
    assert_eq!(claim["quantities"][1]["source"], 1.0);
    assert_eq!(claim["quantities"][1]["ours"]["value"], 1.084);
    // Open ends and missing numbers are null.
    assert_eq!(
        claim["quantities"][2]["ours"]["interval_95"],
        json!([2.862, null])
    );
    assert_eq!(claim["quantities"][2]["source"], Value::Null);
    assert_eq!(claim["quantities"][4]["ours"], Value::Null);
    assert_eq!(
        claim["figures"][1]["file"],
        "figures/transition-times-long.svg"
    );
    assert_eq!(claim["tables"][0]["file"], "tables/f2-1.csv");
    assert_eq!(
        found["claims"][2]["studies"][1],
        json!({
            "name": "divergence-coarse",
            "path": "studies/divergence-coarse.toml",
            "runs": 72,
            "done": 60,
            "missing": 10,
            "failed": 2,
            "failure": "stores/divergence-coarse/index.sqlite: disk I/O error",
        })
    );
    assert!(
        found["claims"][4]["failure"]
            .as_str()
            .unwrap()
            .contains("disk I/O error")
    );
}

#[test]
fn texts_are_taken_as_they_are() {
    let found = parsed(&hostile().json());
    assert_eq!(found["claims"][1]["summary"], HOSTILE);
    let file = found["claims"][1]["figures"][0]["file"].as_str().unwrap();
    let name = file.strip_prefix("figures/").unwrap();
    assert!(!name.contains('/') && !name.contains("..") && !name.contains('<'));
}

#[test]
fn every_key_is_documented() {
    let documentation = include_str!("../../../../docs/book/src/reference/claims-json.md");
    let found = parsed(&specimen().unwrap().json());
    let mut keys = Vec::new();
    collect(&found, &mut keys);
    assert!(keys.len() > 40);
    for key in keys {
        let is_there = [format!("`{key}`"), format!("`{key}."), format!(".{key}`")]
            .iter()
            .any(|text| documentation.contains(text.as_str()));
        assert!(is_there, "{key}");
    }
}

fn collect(value: &Value, keys: &mut Vec<String>) {
    match value {
        Value::Object(object) => {
            for (key, value) in object {
                keys.push(key.clone());
                collect(value, keys);
            }
        }
        Value::Array(values) => values.iter().for_each(|value| collect(value, keys)),
        _ => {}
    }
}
