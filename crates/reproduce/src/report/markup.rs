//! The markup of figures as HTML and as plain text.

use maud::{Markup, html};
use peristalsis_figures::{Letter, Level, letters};

/// A dot above the letter before it belongs to that letter, however it is set.
const COMBINING_DOT: char = '\u{307}';

/// Signs that no line ends beside.
const RELATIONS: [char; 5] = ['=', '≥', '≤', '±', '×'];

/// Characters of one setting.
struct Stretch {
    italic: bool,
    level: Level,
    text: String,
}

/// A text in the markup of figures as HTML; everything that is not markup is escaped.
pub(crate) fn rich(markup: &str) -> Markup {
    let stretches = stretches(&letters(markup));
    let scripts: Vec<&[Stretch]> = stretches
        .chunk_by(|one, other| one.level == other.level)
        .collect();
    let is_script = |stretches: &[Stretch]| stretches[0].level != Level::Base;
    let groups = scripts.chunk_by(|one, other| is_script(one) && is_script(other));
    html! {
        @for pair in groups.flat_map(|group| group.chunks(2)) {
            // A superscript and a subscript side by side stand above each other.
            @if let [one, other] = pair {
                span.scripts { (script(one)) (script(other)) }
            } @else {
                (script(pair[0]))
            }
        }
    }
}

/// A text in the markup of figures as plain text: italics are dropped, scripts begin with `_` or `^`.
///
/// ```
/// assert_eq!(peristalsis_reproduce::report::plain_text("*J*_{max} = 10^{−3}"), "J_max = 10^−3");
/// ```
pub fn plain_text(markup: &str) -> String {
    let mut plain = String::with_capacity(markup.len());
    let mut level = Level::Base;
    for letter in letters(markup) {
        if letter.level != level {
            level = letter.level;
            match level {
                Level::Base => {}
                Level::Subscript => plain.push('_'),
                Level::Superscript => plain.push('^'),
            }
        }
        plain.push(letter.character);
    }
    plain
}

/// The same as Markdown: italics are dropped, scripts are elements, and what Markdown or a table would take for its own is
/// escaped.
pub(crate) fn markdown(markup: &str) -> String {
    let mut text = String::with_capacity(markup.len());
    let mut level = Level::Base;
    let element = |level: Level| match level {
        Level::Base => None,
        Level::Subscript => Some("sub"),
        Level::Superscript => Some("sup"),
    };
    let mut change = |text: &mut String, to: Level| {
        let from = std::mem::replace(&mut level, to);
        if from != to {
            text.extend(element(from).map(|name| format!("</{name}>")));
            text.extend(element(to).map(|name| format!("<{name}>")));
        }
    };
    for letter in letters(markup) {
        change(&mut text, letter.level);
        match letter.character {
            '<' => text.push_str("&lt;"),
            '&' => text.push_str("&amp;"),
            sign @ ('*' | '|' | '\\') => text.extend(['\\', sign]),
            sign if sign.is_control() => text.push(' '),
            sign => text.push(sign),
        }
    }
    change(&mut text, Level::Base);
    text
}

/// Stretches of one level.
fn script(stretches: &[Stretch]) -> Markup {
    let content = html! { @for stretch in stretches { (set(stretch)) } };
    match stretches[0].level {
        Level::Base => content,
        Level::Superscript => html! { sup { (content) } },
        Level::Subscript => html! { sub { (content) } },
    }
}

fn set(stretch: &Stretch) -> Markup {
    let text = RELATIONS.iter().fold(stretch.text.clone(), |text, sign| {
        text.replace(&format!(" {sign} "), &format!("\u{a0}{sign}\u{a0}"))
    });
    html! {
        @if stretch.italic { i { (text) } } @else { (text) }
    }
}

fn stretches(letters: &[Letter]) -> Vec<Stretch> {
    let mut stretches: Vec<Stretch> = Vec::new();
    for letter in letters {
        match stretches.last_mut() {
            Some(last)
                if letter.character == COMBINING_DOT
                    || (last.italic, last.level) == (letter.italic, letter.level) =>
            {
                last.text.push(letter.character);
            }
            _ => stretches.push(Stretch {
                italic: letter.italic,
                level: letter.level,
                text: letter.character.to_string(),
            }),
        }
    }
    stretches
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_becomes_elements() {
        for (markup, expected) in [
            ("*J*/*J*_{max}", "<i>J</i>/<i>J</i><sub>max</sub>"),
            ("*w*_c", "<i>w</i><sub>c</sub>"),
            ("10^{−*n*}", "10<sup>−<i>n</i></sup>"),
            (
                "2.79^{+0.09}_{−0.03} *d*",
                "2.79<span class=\"scripts\"><sup>+0.09</sup><sub>−0.03</sub></span> <i>d</i>",
            ),
            ("*ε*\u{307}", "<i>ε\u{307}</i>"),
            ("*w* = 2.5", "<i>w</i>\u{a0}=\u{a0}2.5"),
            ("run\\_7 \\*", "run_7 *"),
        ] {
            assert_eq!(rich(markup).into_string(), expected, "{markup}");
        }
    }

    #[test]
    fn everything_else_is_escaped() {
        assert_eq!(
            rich("<b onclick=\"x\">*a<*&amp;^{<i>}").into_string(),
            "&lt;b onclick=&quot;x&quot;&gt;<i>a&lt;</i>&amp;amp;<sup>&lt;i&gt;</sup>"
        );
        assert_eq!(plain_text("*w*_{c}\\* <&"), "w_c* <&");
        let marked = "w<sub>c</sub>\\* &lt;&amp; \\| 10<sup>−3</sup>";
        assert_eq!(markdown("*w*_{c}\\* <& | 10^{−3}"), marked);
    }
}
