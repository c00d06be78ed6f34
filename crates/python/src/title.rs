//! Title, numbers and curves of figures, for Matplotlib.

use numpy::{IntoPyArray, PyArray1};
use peristalsis_figures::{Letter, Level, letters};
use pyo3::prelude::*;

use crate::run::Run;

type Reals<'py> = Bound<'py, PyArray1<f64>>;

const DOT_ABOVE: char = '\u{307}';

/// The parameters of a run as the command line's figures have them, as text with Matplotlib's mathematical text in it.
#[pyfunction]
pub(crate) fn title(py: Python<'_>, run: &Run) -> String {
    mathematical(&run.look(py, |run| peristalsis_run::title(run.configuration())))
}

/// t/T and J/Jmax of the samples, and of the averages over each period, as the command line's figure has them.
#[pyfunction]
pub(crate) fn flow_in_time<'py>(py: Python<'py>, run: &Run) -> [(Reals<'py>, Reals<'py>); 2] {
    let courses = run.look(py, |run| peristalsis_run::flow_in_time(run));
    courses.map(|(time, ratio)| (time.into_pyarray(py), ratio.into_pyarray(py)))
}

/// A value with its standard error, by the rule of the command line's figures.
#[pyfunction]
pub(crate) fn with_error(value: f64, error: f64) -> String {
    mathematical(&peristalsis_analysis::number::with_error(value, error))
}

/// Markup of our figures as Matplotlib reads it.
fn mathematical(markup: &str) -> String {
    let letters = letters(markup);
    let is_plain = |letter: &Letter| !letter.italic && letter.level == Level::Base;
    let mut text = String::new();
    for part in letters.chunk_by(|one, other| is_plain(one) == is_plain(other)) {
        if part.iter().all(is_plain) {
            text.extend(part.iter().map(|letter| letter.character));
            continue;
        }
        text.push('$');
        for same in
            part.chunk_by(|one, other| (one.italic, one.level) == (other.italic, other.level))
        {
            let Letter { italic, level, .. } = same[0];
            let inner = symbols(same, italic);
            match level {
                Level::Base => text += &inner,
                Level::Subscript => text += &format!("_{{{inner}}}"),
                Level::Superscript => text += &format!("^{{{inner}}}"),
            }
        }
        text.push('$');
    }
    text
}

fn symbols(letters: &[Letter], italic: bool) -> String {
    let mut text = String::new();
    let mut characters = letters.iter().map(|letter| letter.character).peekable();
    while let Some(character) = characters.next() {
        match (character, characters.next_if_eq(&DOT_ABOVE)) {
            (_, Some(_)) => text += &format!("\\dot{{{character}}}"),
            // In braces a sign takes no more room than a letter.
            ('−' | '*', None) => text += &format!("{{{character}}}"),
            (_, None) => text.push(character),
        }
    }
    if italic {
        text
    } else {
        format!("\\mathrm{{{text}}}")
    }
}
