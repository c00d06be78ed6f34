//! What the user may have meant: the nearest known name.

use strsim::osa_distance;

/// Edits that are still taken for a slip of the pen in a word.
fn tolerance(word: &str) -> usize {
    (word.chars().count() / 3).min(3)
}

/// A word no user meant: longer than any name by far. Distances to it would only cost time.
const LONGEST_WORD: usize = 64;

/// The known key nearest to an unknown one, if one is near: by its last name, or as how one begins or ends, in its own table
/// before others.
///
/// `path` is the unknown key's full path, `known` the full paths of all keys; or a word and the words that there are.
pub(crate) fn nearest<'a>(path: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let split = |path: &'a str| path.rsplit_once('.').unwrap_or(("", path));
    let (table, name) = path.rsplit_once('.').unwrap_or(("", path));
    if name.len() > LONGEST_WORD {
        return None;
    }
    let near = known.into_iter().filter_map(|candidate| {
        let (other_table, other_name) = split(candidate);
        let is_elsewhere = table != other_table;
        let edits = osa_distance(name, other_name);
        // A key such as contact.stiffness is taken for contact.normal_stiffness.
        let is_part = other_name.starts_with(name) || other_name.ends_with(name);
        let distance = match (is_part, is_elsewhere) {
            (true, false) => edits.min(1),
            // In another table than the one that was written every edit counts twice.
            (_, true) if !table.is_empty() => 2 * edits,
            _ => edits,
        };
        let is_near = distance <= tolerance(name);
        is_near.then_some((is_elsewhere, distance, edits, candidate))
    });
    let nearest =
        near.min_by_key(|(is_elsewhere, distance, edits, _)| (*is_elsewhere, *distance, *edits));
    nearest.map(|(.., candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn own_table_first_then_others_then_nothing() {
        let known = [
            "drive.width",
            "tube.waves",
            "wall.drag",
            "tube.rings_per_wave",
            "tube.wavelength",
            "inlet.length",
            "drive.at",
            "drive.strain_rate",
            "run.seed",
        ];
        for (path, expected) in [
            ("drive.widht", Some("drive.width")),
            ("width", Some("drive.width")),
            ("tube.strain_rat", Some("drive.strain_rate")),
            ("drive.rate", Some("drive.strain_rate")),
            ("tube.wave", Some("tube.waves")),
            ("tube.length", Some("tube.wavelength")),
            ("tube.colour", None),
            ("a", None),
            ("drive.feed", None),
            ("feed", Some("run.seed")),
        ] {
            assert_eq!(nearest(path, known), expected, "{path}");
        }
        assert_eq!(nearest("jamed", ["rest", "jammed"]), Some("jammed"));
    }
}
