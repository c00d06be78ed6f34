//! The markup of labels: `*italic*`, `_{subscript}`, `^{superscript}`, and a backslash for a literal character.

/// Where a character stands on the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// On the baseline.
    Base,
    /// Below it, smaller.
    Subscript,
    /// Above it, smaller.
    Superscript,
}

/// One character with its setting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Letter {
    /// The character.
    pub character: char,
    /// Whether it is set in italics.
    pub italic: bool,
    /// Where it stands.
    pub level: Level,
}

/// Reads the markup; anything that is not markup is taken literally, so that no text fails.
pub fn letters(markup: &str) -> Vec<Letter> {
    let mut letters = Vec::new();
    let mut italic = false;
    let mut level = Level::Base;
    let mut braced = false;
    let mut characters = markup.chars().peekable();
    while let Some(character) = characters.next() {
        match character {
            '*' => italic = !italic,
            '_' | '^' if level == Level::Base && characters.peek().is_some() => {
                let is_below = character == '_';
                level = if is_below {
                    Level::Subscript
                } else {
                    Level::Superscript
                };
                braced = characters.next_if_eq(&'{').is_some();
            }
            '}' if braced => {
                level = Level::Base;
                braced = false;
            }
            _ => {
                let escaped = (character == '\\').then(|| characters.next()).flatten();
                let character = escaped.unwrap_or(character);
                letters.push(Letter {
                    character,
                    italic,
                    level,
                });
                if !braced {
                    level = Level::Base;
                }
            }
        }
    }
    letters
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(markup: &str) -> String {
        let letters = letters(markup);
        letters.iter().map(|letter| letter.character).collect()
    }

    #[test]
    fn italics_and_scripts_are_read() {
        let letters = letters("*J*_{max}^2x");
        let found: Vec<_> = letters
            .iter()
            .map(|it| (it.character, it.italic, it.level))
            .collect();
        let expected = [
            ('J', true, Level::Base),
            ('m', false, Level::Subscript),
            ('a', false, Level::Subscript),
            ('x', false, Level::Subscript),
            ('2', false, Level::Superscript),
            ('x', false, Level::Base),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn broken_markup_and_escapes_stay_readable() {
        assert_eq!(plain("a_{bc"), "abc");
        assert_eq!(plain("a}b_"), "a}b_");
        assert_eq!(plain("run\\_7\\*\\^{x"), "run_7*^{x");
    }
}
