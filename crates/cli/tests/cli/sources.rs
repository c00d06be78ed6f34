//! Promises of the sources themselves: unsafe code stands in one module, names for the linker in one more file, and
//! neither can stand anywhere else.

use std::path::{Path, PathBuf};

/// The one module with unsafe code, and the one whose functions WebAssembly exports by names that the linker checks.
const ALLOWED: [&str; 2] = ["engine/src/fast/machine/", "viewer/browser/exports.rs"];
/// Crates that do not forbid unsafe code as a whole: those with the modules, and the one whose macros write glue.
const DENYING: [&str; 2] = ["engine", "python"];

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            found.push(path);
        }
    }
}

#[test]
fn unsafe_code_stands_in_one_module() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut roots = 0;
    for entry in std::fs::read_dir(crates).unwrap() {
        let folder = entry.unwrap().path();
        let name = folder.file_name().unwrap().to_str().unwrap().to_owned();
        let root = ["lib.rs", "main.rs"].map(|root| folder.join("src").join(root));
        let root =
            std::fs::read_to_string(root.iter().find(|root| root.is_file()).unwrap()).unwrap();
        roots += 1;
        assert!(
            DENYING.contains(&name.as_str()) || root.contains("#![forbid(unsafe_code)]"),
            "{name} does not forbid unsafe code"
        );
        let mut found = Vec::new();
        sources(&folder.join("src"), &mut found);
        if name == "viewer" {
            sources(&folder.join("browser"), &mut found);
        }
        for path in found {
            let place = path.strip_prefix(crates).unwrap().to_str().unwrap();
            let text = std::fs::read_to_string(&path).unwrap();
            let code = text
                .lines()
                .filter(|line| !line.trim_start().starts_with("//"));
            let has_unsafe = code.clone().any(|line| {
                line.contains("unsafe ")
                    || line.contains("(unsafe_code)") && !line.contains("forbid")
            });
            assert!(
                ALLOWED.iter().any(|allowed| place.starts_with(allowed)) || !has_unsafe,
                "{place} has unsafe code"
            );
        }
    }
    assert!(roots >= 14, "only {roots} crates");
    // Everything else is denied what no crate may allow itself.
    let workspace = std::fs::read_to_string(crates.parent().unwrap().join("Cargo.toml")).unwrap();
    assert!(workspace.contains("unsafe_code = \"deny\""));
}
