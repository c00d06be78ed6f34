//! Progress on standard error: a bar on a terminal, plain lines on a pipe.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget, ProgressStyle};
use peristalsis_run::Progress;

use crate::commands::unsigned_zero;
use crate::failure::say;

/// Where progress goes.
pub(crate) enum Display {
    /// Nowhere.
    Silent,
    /// To a bar that is redrawn, and lines below it.
    Bar(Bar),
    /// To a line now and then.
    Lines(LastLine),
}

/// A bar on a terminal.
pub(crate) struct Bar {
    all: MultiProgress,
    bar: ProgressBar,
    below: Vec<ProgressBar>,
}

impl Bar {
    /// Shows how much is done, in words too, with more lines below.
    pub(crate) fn show(&mut self, done: u64, words: String, below: &[String]) {
        self.bar.set_position(done);
        self.bar.set_message(words);
        while self.below.len() < below.len() {
            let line = ProgressBar::new(1).with_style(style("  {wide_msg}"));
            self.below.push(self.all.add(line));
        }
        for (index, line) in self.below.iter().enumerate() {
            line.set_message(below.get(index).cloned().unwrap_or_default());
        }
    }
}

/// The last line of progress on a pipe.
pub(crate) struct LastLine {
    printed: Instant,
    /// Tenth of the work in which it was printed.
    pub(crate) tenth: u64,
}

impl LastLine {
    /// A line that is printed now.
    pub(crate) fn now(tenth: u64) -> Self {
        Self {
            printed: Instant::now(),
            tenth,
        }
    }

    /// Whether the next line is due even within the same tenth.
    pub(crate) fn is_old(&self) -> bool {
        self.printed.elapsed() > LINE_INTERVAL
    }
}

/// Redraws in a second.
const REFRESH_RATE: u8 = 10;
/// Time after which a line is printed even within the same tenth.
const LINE_INTERVAL: Duration = Duration::from_secs(30);

/// How a bar or a line is drawn.
fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template)
        .expect("the template is a constant with known fields")
        .progress_chars("━╸─")
}

impl Display {
    /// Of a run, or of other work in so many pieces.
    pub(crate) fn new(quiet: bool, pieces: u64) -> Self {
        let template = "{bar:30.cyan/dim} {percent:>3}%  {msg}  [{eta} left]";
        Self::with_bar(quiet, pieces, template)
    }

    /// The same with a bar that is drawn by a template of its own.
    pub(crate) fn with_bar(quiet: bool, pieces: u64, template: &str) -> Self {
        if quiet {
            return Self::Silent;
        }
        if !std::io::stderr().is_terminal() {
            return Self::Lines(LastLine::now(0));
        }
        let target = ProgressDrawTarget::stderr_with_hz(REFRESH_RATE);
        let all = MultiProgress::with_draw_target(target);
        let bar = all.add(ProgressBar::new(pieces).with_style(style(template)));
        let below = Vec::new();
        Self::Bar(Bar { all, bar, below })
    }

    /// Shows how far the run is.
    pub(crate) fn update(&mut self, progress: &Progress) {
        let done = [progress.samples, progress.samples_total];
        self.show(done, progress.elapsed, || found(progress));
    }

    /// Shows how many pieces of work are done of how many, with a few words.
    pub(crate) fn show(
        &mut self,
        [done, of]: [u64; 2],
        elapsed: Duration,
        words: impl FnOnce() -> String,
    ) {
        match self {
            Self::Silent => {}
            Self::Bar(bar) => bar.show(done, words(), &[]),
            Self::Lines(last) => {
                let tenth = 10 * done / of.max(1);
                if tenth > last.tenth || last.is_old() {
                    *last = LastLine::now(tenth);
                    let part = done as f64 / of.max(1) as f64;
                    let left = elapsed.as_secs_f64() * (1.0 - part) / part;
                    let (words, left) = (words(), seconds(left));
                    say(&format!("{:3.0} %  {words}  {left} left", 100.0 * part));
                }
            }
        }
    }

    /// Says a line that stays.
    pub(crate) fn tell(&self, text: &str) {
        match self {
            Self::Silent => {}
            Self::Bar(bar) => drop(bar.all.println(text)),
            Self::Lines(_) => say(text),
        }
    }

    /// Takes bar and lines away.
    pub(crate) fn finish(&self) {
        if let Self::Bar(Bar { bar, below, .. }) = self {
            for line in below.iter().chain([bar]) {
                line.finish_and_clear();
            }
        }
    }
}

/// What was found so far, in a few words.
pub(crate) fn found(progress: &Progress) -> String {
    // A static wave counts no periods.
    let mut text = match progress.period > 0.0 {
        true => format!("t/T {:.1}", progress.period),
        false => format!("t {:.1}", progress.time),
    };
    if progress.flow_rate_ratio.is_finite() {
        text.push_str(&format!(
            "  J/Jmax {:+.3}",
            unsigned_zero(progress.flow_rate_ratio, 3)
        ));
    }
    if let Some(time) = progress.transition_time {
        text.push_str(&format!("  transition at t = {time:.1}"));
    }
    text
}

/// A time span in words: "12 s", "3 min 20 s", "2 h 05 min".
pub(crate) fn seconds(span: f64) -> String {
    let whole = span.max(0.0).round() as u64;
    match whole {
        0 if span > 0.0 => "less than 1 s".to_owned(),
        0..60 => format!("{whole} s"),
        60..3600 => format!("{} min {:02} s", whole / 60, whole % 60),
        _ => format!("{} h {:02} min", whole / 3600, whole % 3600 / 60),
    }
}

#[cfg(test)]
mod tests {
    use super::seconds;

    #[test]
    fn time_spans_read_well() {
        for (span, text) in [
            (0.0, "0 s"),
            (0.3, "less than 1 s"),
            (12.4, "12 s"),
            (200.0, "3 min 20 s"),
            (7500.0, "2 h 05 min"),
        ] {
            assert_eq!(seconds(span), text);
        }
    }
}
