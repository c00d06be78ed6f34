//! What the user may have meant: the nearest known name.

/// Edits (insertion, deletion, substitution, swap of neighbours) between two words.
pub(crate) fn edit_distance(one: &str, other: &str) -> usize {
    let one: Vec<char> = one.chars().collect();
    let other: Vec<char> = other.chars().collect();
    let mut above = vec![0; other.len() + 1];
    let mut last: Vec<usize> = (0..=other.len()).collect();
    for i in 1..=one.len() {
        let mut row = vec![i; other.len() + 1];
        for j in 1..=other.len() {
            let substitution = last[j - 1] + usize::from(one[i - 1] != other[j - 1]);
            row[j] = substitution.min(last[j] + 1).min(row[j - 1] + 1);
            let swapped =
                i > 1 && j > 1 && one[i - 1] == other[j - 2] && one[i - 2] == other[j - 1];
            if swapped {
                row[j] = row[j].min(above[j - 2] + 1);
            }
        }
        above = last;
        last = row;
    }
    last[other.len()]
}

/// Edits that are still taken for a slip of the pen in a word.
fn tolerance(word: &str) -> usize {
    (word.chars().count() / 3).clamp(1, 3)
}

/// A word no user meant: longer than any name by far. Distances to it would only cost time.
const LONGEST_WORD: usize = 64;

/// The candidate nearest to `word`, if one is near.
pub(crate) fn nearest<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    if word.len() > LONGEST_WORD {
        return None;
    }
    candidates
        .into_iter()
        .map(|candidate| (edit_distance(word, candidate), candidate))
        .filter(|(distance, _)| *distance <= tolerance(word))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

/// The known key nearest to an unknown one: by its last name, in its own table before others.
///
/// `path` is the unknown key's full path, `known` the full paths of all keys.
pub(crate) fn nearest_key<'a>(path: &str, known: &'a [String]) -> Option<&'a str> {
    let (table, name) = path.rsplit_once('.').unwrap_or(("", path));
    if name.len() > LONGEST_WORD {
        return None;
    }
    known
        .iter()
        .map(|candidate| {
            let (other_table, other_name) = candidate
                .rsplit_once('.')
                .unwrap_or(("", candidate.as_str()));
            let distance = edit_distance(name, other_name);
            (
                2 * distance + usize::from(table != other_table),
                distance,
                candidate.as_str(),
            )
        })
        .filter(|(_, distance, _)| *distance <= tolerance(name))
        .min_by_key(|(rank, _, _)| *rank)
        .map(|(_, _, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_by_hand() {
        assert_eq!(edit_distance("width", "width"), 0);
        assert_eq!(edit_distance("widht", "width"), 1);
        assert_eq!(edit_distance("wide", "width"), 2);
        assert_eq!(edit_distance("", "abc"), 3);
    }

    #[test]
    fn own_table_first_then_others_then_nothing() {
        let known: Vec<String> = [
            "drive.width",
            "tube.waves",
            "wall.drag",
            "drive.strain_rate",
        ]
        .map(Into::into)
        .into();
        assert_eq!(nearest_key("drive.widht", &known), Some("drive.width"));
        assert_eq!(nearest_key("width", &known), Some("drive.width"));
        assert_eq!(
            nearest_key("tube.strain_rat", &known),
            Some("drive.strain_rate")
        );
        assert_eq!(nearest_key("tube.colour", &known), None);
        assert_eq!(nearest("jamed", ["rest", "jammed"]), Some("jammed"));
    }
}
