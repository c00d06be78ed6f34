//! What the targets share: tubes that run within a millisecond, and bytes that are damaged by an input.

use std::path::PathBuf;

use peristalsis_configuration::{Configuration, Sources};

/// A preset with settings over it.
///
/// # Panics
/// Where they are not ones that can run.
#[must_use]
pub fn configuration(preset: &str, settings: &[&str]) -> Configuration {
    let overrides: Vec<String> = settings.iter().map(ToString::to_string).collect();
    Configuration::from_sources(&Sources {
        file: None,
        preset: Some(preset),
        overrides: &overrides,
    })
    .expect("the settings of the targets are allowed")
}

/// The smallest tubes of both models.
#[must_use]
pub fn tubes() -> [Configuration; 2] {
    [
        configuration(
            "frictionless",
            &["grains.number=8", "tube.waves=1", "run.periods=1"],
        ),
        configuration(
            "frictional",
            &["grains.number=8", "tube.waves=2", "run.periods=0.1"],
        ),
    ]
}

/// How an input wants bytes to be: as they stand after its first byte, or as changes of what is whole.
///
/// A first byte that is even means all that follows; an odd one means changes of three bytes each, place and value, of
/// which the place 65535 cuts what is behind the place of the last change away.
#[must_use]
pub fn damaged(whole: &[u8], input: &[u8]) -> Vec<u8> {
    let Some((mode, rest)) = input.split_first() else {
        return whole.to_vec();
    };
    if mode % 2 == 0 {
        return rest.to_vec();
    }
    let mut bytes = whole.to_vec();
    let mut last = 0;
    for change in rest.chunks_exact(3) {
        let place = usize::from(u16::from_le_bytes([change[0], change[1]]));
        if place == usize::from(u16::MAX) {
            bytes.truncate(last);
        } else if let Some(byte) = bytes.get_mut(place) {
            *byte = change[2];
            last = place;
        }
    }
    bytes
}

/// A folder of this process alone, in memory where the system has such a place.
///
/// # Panics
/// Where it cannot be made.
#[must_use]
pub fn scratch(target: &str) -> PathBuf {
    let memory = PathBuf::from("/dev/shm");
    let place = if memory.is_dir() {
        memory
    } else {
        std::env::temp_dir()
    };
    let folder = place.join(format!("peristalsis-fuzz-{target}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder can be made for what is fuzzed");
    folder
}
