//! Progress of a study on standard error: lines that are redrawn on a terminal, plain ones on a pipe.

use std::io::IsTerminal;

use indicatif::{MultiProgress, ProgressBar};
use peristalsis_study::{Board, Working};

use super::status::estimate;
use crate::commands::say;
use crate::progress::{LastLine, seconds, style, terminal};

/// Estimates that are shown on a terminal.
const ESTIMATES_SHOWN: usize = 6;
/// Workers that are shown on a terminal.
const WORKERS_SHOWN: usize = 8;

/// Progress of the whole work; a board may show a part of it.
pub(crate) struct Whole {
    /// In words.
    pub(crate) words: String,
    /// Part of the work that is done.
    pub(crate) fraction: f64,
}

/// Where progress goes.
pub(crate) enum Display {
    /// Nowhere.
    Silent,
    /// To lines that are redrawn.
    Bars(Bars),
    /// To a line now and then.
    Lines {
        last: LastLine,
        /// Runs that had ended.
        ended: usize,
    },
}

/// The lines on a terminal.
pub(crate) struct Bars {
    all: MultiProgress,
    runs: ProgressBar,
    estimates: Vec<ProgressBar>,
    workers: Vec<ProgressBar>,
}

impl Display {
    pub(crate) fn new(quiet: bool, workers: usize) -> Self {
        if quiet {
            return Self::Silent;
        }
        if !std::io::stderr().is_terminal() {
            return Self::Lines {
                last: LastLine::now(0),
                ended: usize::MAX,
            };
        }
        let all = MultiProgress::with_draw_target(terminal());
        let bar = ProgressBar::new(1000).with_style(style("{bar:30.cyan/dim} {msg}"));
        let runs = all.add(bar);
        Self::Bars(Bars {
            estimates: Vec::new(),
            workers: (0..workers.min(WORKERS_SHOWN))
                .map(|_| all.add(line()))
                .collect(),
            runs,
            all,
        })
    }

    /// Shows how far the study is.
    pub(crate) fn update(&mut self, board: &Board) {
        self.update_part(
            board,
            &Whole {
                words: overall(board),
                fraction: board.fraction,
            },
        );
    }

    /// Shows the progress of a study, and of the whole work.
    pub(crate) fn update_part(&mut self, board: &Board, whole: &Whole) {
        match self {
            Self::Silent => {}
            Self::Bars(bars) => bars.update(board, whole),
            Self::Lines { last, ended } => {
                for news in &board.news {
                    say(news);
                }
                let tenth = (10.0 * whole.fraction) as u64;
                let is_news = *ended != board.done + board.failed
                    && (tenth != last.tenth || *ended == usize::MAX || board.done == board.total);
                if is_news || last.is_old() {
                    *ended = board.done + board.failed;
                    *last = LastLine::now(tenth);
                    say(&whole.words);
                    for bracket in &board.brackets {
                        say(&format!("  {}", estimate(bracket)));
                    }
                }
            }
        }
    }

    /// Says a line that stays.
    pub(crate) fn tell(&self, text: &str) {
        match self {
            Self::Silent => {}
            Self::Bars(bars) => drop(bars.all.println(text)),
            Self::Lines { .. } => say(text),
        }
    }

    /// Takes the lines away.
    pub(crate) fn finish(&self) {
        if let Self::Bars(bars) = self {
            let lines = bars.estimates.iter().chain(&bars.workers);
            for line in lines.chain([&bars.runs]) {
                line.finish_and_clear();
            }
        }
    }
}

/// A line of text.
fn line() -> ProgressBar {
    ProgressBar::new(1).with_style(style("  {wide_msg}"))
}

impl Bars {
    fn update(&mut self, board: &Board, whole: &Whole) {
        for news in &board.news {
            drop(self.all.println(news));
        }
        self.runs.set_position((1000.0 * whole.fraction) as u64);
        self.runs.set_message(whole.words.clone());
        let more = board.brackets.len().saturating_sub(ESTIMATES_SHOWN);
        while self.estimates.len() < board.brackets.len().min(ESTIMATES_SHOWN) {
            let below = self.estimates.len() + 1;
            self.estimates.push(self.all.insert(below, line()));
        }
        for (index, line) in self.estimates.iter().enumerate() {
            line.set_message(match board.brackets.get(index) {
                Some(_) if more > 0 && index + 1 == ESTIMATES_SHOWN => {
                    format!("and {} estimates more", more + 1)
                }
                Some(bracket) => estimate(bracket),
                None => String::new(),
            });
        }
        for (line, working) in self.workers.iter().zip(&board.workers) {
            line.set_message(working.as_ref().map_or_else(|| "idle".to_owned(), in_words));
        }
    }
}

fn overall(board: &Board) -> String {
    let mut text = format!("{} of {} runs done", board.done, board.total);
    if board.failed > 0 {
        text.push_str(&format!(", {} failed", board.failed));
    }
    text.push_str(&format!(", {:.0} % of the work", 100.0 * board.fraction));
    if let Some(left) = board.left {
        text.push_str(&format!(", {} left", seconds(left.as_secs_f64())));
    }
    text
}

fn in_words(working: &Working) -> String {
    let mut text = working.point.clone();
    if let Some(progress) = working.progress {
        text.push_str(&format!(
            "  {:.0} %  t/T {:.1}  J/Jmax {:+.3}",
            100.0 * progress.samples as f64 / progress.samples_total.max(1) as f64,
            progress.period,
            progress.flow_rate_ratio
        ));
        if let Some(time) = progress.transition_time {
            text.push_str(&format!("  transition at t = {time:.1}"));
        }
    } else {
        text.push_str("  packing");
    }
    text
}
