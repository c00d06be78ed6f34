//! Progress of a study on standard error: lines that are redrawn on a terminal, plain ones on a pipe.

use std::time::Duration;

use peristalsis_study::{Board, Working};

use super::status::estimate;
use crate::commands::{counted, say};
use crate::progress::{Display, LastLine, found, seconds};

/// Estimates that are shown on a terminal.
const ESTIMATES_SHOWN: usize = 6;
/// Workers that are shown on a terminal.
const WORKERS_SHOWN: usize = 8;
/// Pieces into which a bar divides the work.
const PIECES: f64 = 1000.0;

/// The progress of a study.
pub(crate) struct StudyDisplay {
    display: Display,
    /// Runs that had ended at the last line on a pipe.
    ended: Option<usize>,
}

impl StudyDisplay {
    pub(crate) fn new(quiet: bool) -> Self {
        Self {
            display: Display::with_bar(quiet, PIECES as u64, "{bar:30.cyan/dim} {msg}"),
            ended: None,
        }
    }

    /// Shows how far the study is.
    pub(crate) fn update(&mut self, board: &Board) {
        let part = format!(", {:.0} % of the work", 100.0 * board.fraction);
        self.update_part(board, overall(board, &part, board.left), board.fraction);
    }

    /// Shows the progress of a study, and of the whole work that it belongs to, in words and as a fraction.
    pub(crate) fn update_part(&mut self, board: &Board, words: String, fraction: f64) {
        for news in &board.news {
            self.display.tell(news);
        }
        match &mut self.display {
            Display::Silent => {}
            Display::Bar(bar) => {
                bar.show((PIECES * fraction) as u64, words, &below(board));
            }
            Display::Lines(last) => {
                let tenth = (10.0 * fraction) as u64;
                let ended = board.done + board.failed;
                let is_news = self.ended.is_none_or(|before| {
                    ended != before && (tenth != last.tenth || board.done == board.total)
                });
                if is_news || last.is_old() {
                    self.ended = Some(ended);
                    *last = LastLine::now(tenth);
                    say(&words);
                    for bracket in &board.brackets {
                        say(&format!("  {}", estimate(bracket)));
                    }
                }
            }
        }
    }

    /// Says a line that stays.
    pub(crate) fn tell(&self, text: &str) {
        self.display.tell(text);
    }

    /// Takes the lines away.
    pub(crate) fn finish(&self) {
        self.display.finish();
    }
}

/// The lines below the bar: estimates, then what each worker does.
fn below(board: &Board) -> Vec<String> {
    let mut lines: Vec<String> = board.brackets.iter().map(estimate).collect();
    if lines.len() > ESTIMATES_SHOWN {
        let more = lines.len() - ESTIMATES_SHOWN + 1;
        lines.truncate(ESTIMATES_SHOWN - 1);
        lines.push(format!("and {} more", counted(more, "estimate")));
    }
    let workers = board.workers.iter().take(WORKERS_SHOWN);
    lines.extend(workers.map(|it| it.as_ref().map_or_else(|| "idle".to_owned(), in_words)));
    lines
}

/// The progress of a study in words; `part` names the work, and `left` is the time that it still takes.
pub(crate) fn overall(board: &Board, part: &str, left: Option<Duration>) -> String {
    let mut text = format!("{} of {} done", board.done, counted(board.total, "run"));
    if board.failed > 0 {
        text.push_str(&format!(", {} failed", board.failed));
    }
    text.push_str(part);
    if board.waits_for > 0 && board.done + board.failed < board.total {
        let runs = counted(board.waits_for, "run");
        text.push_str(&format!(", waits for {runs} that other programs hold"));
    } else if let Some(left) = left {
        text.push_str(&format!(", {} left", seconds(left.as_secs_f64())));
    }
    text
}

fn in_words(working: &Working) -> String {
    let mut text = working.point.clone();
    if let Some(progress) = working.progress {
        let part = 100.0 * progress.part();
        text.push_str(&format!("  {part:.0} %  {}", found(&progress)));
    } else {
        text.push_str("  packing");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cluster's user: the time left grew while a dead worker's run was waited for.
    #[test]
    fn what_others_hold_is_waited_for_and_has_no_time_left() {
        let mut board = Board {
            total: 6,
            done: 5,
            waits_for: 1,
            ..Board::default()
        };
        let words = |board: &Board| overall(board, "", Some(Duration::from_secs(42)));
        assert_eq!(
            words(&board),
            "5 of 6 runs done, waits for 1 run that other programs hold"
        );
        board.waits_for = 0;
        assert_eq!(words(&board), "5 of 6 runs done, 42 s left");
    }
}
