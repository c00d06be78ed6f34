//! The command line.

use std::path::PathBuf;
use std::time::Duration;

use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand};
use peristalsis_configuration::preset_names;
use peristalsis_engine::Instructions;
use peristalsis_reproduce::textbook::CASES;
use peristalsis_reproduce::{CLAIMS, Extent};
use peristalsis_run::{Run, Span, TrajectoryFormat, Window};

use crate::choice::{Offered, TRAJECTORIES, names, one_of};
use crate::commands::design::DesignArguments;
use crate::commands::render::RenderArguments;
use crate::commands::schema::SchemaArguments;
use crate::commands::study::{StudyCommand, WorkArguments, time_span};

/// Grains in a peristaltic tube, by the discrete element method.
#[derive(Debug, Parser)]
#[command(
    name = "peristalsis",
    version = concat!(env!("CARGO_PKG_VERSION")),
    propagate_version = true,
    max_term_width = 100,
    after_help = "Exit codes: 0 done, or the time of --for is up (the last line says how to go on); 1 failed or diverged; 2 bad input; 3 a run computed again differs from its published row; 129, 130, 138, 143 stopped by a signal, with everything saved (a second signal, a second later, ends at once); a signal ends view with 0."
)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run one simulation and write its tables and figures.
    Run(RunArguments),
    /// List runs with their results.
    Runs(RunsArguments),
    /// Draw the figures of runs again, from their saved states; computes nothing.
    Figures(FiguresArguments),
    /// Say what would run, how long it would take and what looks doubtful, after a short trial; writes nothing.
    Check(CheckArguments),
    /// Say what to expect of a pump: dimensionless groups, the published runs like it, cost.
    Design(DesignArguments),
    /// Write the spheres of a run, from its saved state on, for other programs to open.
    Trajectory(TrajectoryArguments),
    /// Draw the tube of a run, as picture or film: from the side, cut across, or wave by wave in time.
    Render(RenderArguments),
    /// Watch a tube in the browser and drive it by hand; or look at a recorded run or a study.
    View(ViewArguments),
    /// List the presets, or print one.
    Presets(PresetsArguments),
    /// Print the JSON schema of the configuration.
    Schema(SchemaArguments),
    /// Say how a Newtonian fluid would flow in such a tube (Shapiro, Jaffrin & Weinberg 1969).
    Newtonian(NewtonianArguments),
    /// Plan, compute and export studies: many runs that differ in chosen keys, kept in a store.
    #[command(subcommand)]
    Study(StudyCommand),
    /// Compare the claims of the source with runs, and write the report.
    Reproduce(ReproduceArguments),
    /// Run textbook experiments beside their analytic solutions.
    Validate(ValidateArguments),
    /// Print completions for a shell.
    Completions(CompletionsArguments),
}

/// Help of `--set`.
const SET: &str =
    "Sets a key, such as drive.width=2.7, whatever preset and file say; may be repeated";
/// Help of `--threads`.
const THREADS: &str = "Number of threads, or auto: as many as pay for the number of moving spheres. Results do not depend on it";

/// Where a configuration comes from.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct ConfigurationArguments {
    /// Configuration in TOML; `-` reads it from standard input.
    #[arg(value_name = "FILE")]
    pub(crate) file: Option<PathBuf>,
    /// Preset to start from; values of a file and of --set replace its own (see `peristalsis presets`).
    #[arg(long, value_name = "NAME", value_parser = presets())]
    pub(crate) preset: Option<String>,
    #[arg(long = "set", value_name = "KEY=VALUE", help = SET)]
    pub(crate) overrides: Vec<String>,
    /// Length of the run in periods of drive.strain_rate (run.periods), rounded up to whole samples. `run --resume` takes the
    /// new length of the whole run, to the same bits as one run of that length.
    #[arg(long, value_name = "N", value_parser = positive, allow_negative_numbers = true)]
    pub(crate) periods: Option<f64>,
    /// Length of the run in time [t] (run.duration), rounded up to whole samples.
    #[arg(long, value_name = "T", conflicts_with = "periods", value_parser = positive, allow_negative_numbers = true)]
    pub(crate) duration: Option<f64>,
}

impl ConfigurationArguments {
    /// The length of the run as a setting, if one is asked for.
    pub(crate) fn length(&self) -> Option<String> {
        match (self.periods, self.duration) {
            (Some(periods), _) => Some(format!("run.periods={periods:?}")),
            (None, duration) => Some(format!("run.duration={:?}", duration?)),
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct RunArguments {
    #[command(flatten)]
    pub(crate) configuration: ConfigurationArguments,
    /// Folder for the results; it must not hold a run. Unless given: a new one, runs/NAME-1, runs/NAME-2, ...
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[arg(long, value_name = "N|auto", help = THREADS, default_value = "auto", value_parser = threads, allow_negative_numbers = true)]
    pub(crate) threads: Threads,
    /// Instruction set; the default is the widest of this machine. Results do not depend on it.
    #[arg(long, value_name = "SET", value_parser = one_of(Instructions::ALL))]
    pub(crate) instructions: Option<Instructions>,
    /// Go on with a run, to the same bits as if it had never stopped. DIR is its folder. FILE is a state, such as Python's
    /// `Simulation.save` writes: it goes on in a new folder.
    #[arg(long, value_name = "DIR|FILE", conflicts_with = "seeds")]
    pub(crate) resume: Option<PathBuf>,
    /// Run once with each of these seeds, such as 1..10 or 1,2,5, and show mean and scatter. The runs are in the folders
    /// DIR/seed-K; --resume DIR goes on with all of them.
    #[arg(long, value_name = "SEEDS", value_parser = seeds)]
    pub(crate) seeds: Option<Seeds>,
    /// Time after which the state is saved again; it is also saved when the run begins and when it ends.
    #[arg(long, value_name = "TIME", default_value = "60s", value_parser = time_span)]
    pub(crate) checkpoint_every: Duration,
    #[command(flatten)]
    pub(crate) frames: FrameArguments,
    /// Write the time series as CSV too.
    #[arg(long)]
    pub(crate) csv: bool,
    /// Print the summary as JSON on standard output, and nothing else there.
    #[arg(long)]
    pub(crate) json: bool,
    /// No progress on standard error, only warnings and errors.
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

/// Which frames a run leaves beside its record.
#[derive(Debug, Args)]
pub(crate) struct FrameArguments {
    #[arg(
        long,
        help = format!("Write the spheres frame by frame, in these formats: {}. With --resume the formats stay as they were", names(TRAJECTORIES)),
        value_name = "FORMAT,...",
        value_parser = one_of(TRAJECTORIES),
        value_delimiter = ',',
        hide_possible_values = true
    )]
    pub(crate) trajectory: Vec<TrajectoryFormat>,
    /// Time between two frames, in periods or, as in 2.5t, in time; the default is a tenth of a period.
    #[arg(long, value_name = "SPAN", allow_hyphen_values = true)]
    pub(crate) trajectory_every: Option<Span>,
    /// Frames in this part of the run only, in periods or time: 20:25, 100:, :5t.
    #[arg(long, value_name = "FROM:TO", allow_hyphen_values = true)]
    pub(crate) trajectory_window: Option<Window>,
}

impl FrameArguments {
    /// Whether anything is asked of a trajectory.
    pub(crate) fn asks(&self) -> bool {
        !self.trajectory.is_empty()
            || self.trajectory_every.is_some()
            || self.trajectory_window.is_some()
    }
}

#[derive(Debug, Args)]
pub(crate) struct TrajectoryArguments {
    /// Folder of a run, finished or stopped; none of its files is changed.
    #[arg(value_name = "DIR")]
    pub(crate) folder: PathBuf,
    #[arg(
        long = "format",
        help = format!("Formats: {}", names(TRAJECTORIES)),
        value_name = "FORMAT,...",
        value_parser = one_of(TRAJECTORIES),
        value_delimiter = ',',
        default_value = "gsd",
        hide_possible_values = true
    )]
    pub(crate) formats: Vec<TrajectoryFormat>,
    /// How long to go on from the saved state, in periods or, as in 40t, in time; 0 is the state alone.
    #[arg(
        long,
        value_name = "SPAN",
        default_value = "0",
        allow_hyphen_values = true
    )]
    pub(crate) duration: Span,
    /// Time between two frames; the default is a tenth of a period.
    #[arg(long, value_name = "SPAN", allow_hyphen_values = true)]
    pub(crate) every: Option<Span>,
    /// Folder for the frames, other than a run's; the default is DIR/from-state.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Print what was written as JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Prints an address on this machine that only you know; open it in a browser. From another machine: `ssh -L 8000:localhost:8000 HOST`, and there `peristalsis view --port 8000`. Ctrl-C ends."
)]
pub(crate) struct ViewArguments {
    /// Folder of a run (its trajectory.gsd is played, if it holds one), trajectory (.gsd), configuration in TOML, or name
    /// of a preset; store of a study, folder of a reproduction, or table of rows of runs (.parquet, .csv).
    #[arg(value_name = "DIR|FILE|PRESET", default_value = "frictionless")]
    pub(crate) source: PathBuf,
    #[arg(long = "set", value_name = "KEY=VALUE", help = SET)]
    pub(crate) overrides: Vec<String>,
    /// Compute the run of a folder anew, even if the folder holds a trajectory.
    #[arg(long)]
    pub(crate) live: bool,
    /// Go on from the saved state of a folder instead of from the start.
    #[arg(long, conflicts_with = "overrides")]
    pub(crate) from_state: bool,
    /// Port; 0 is any free one.
    #[arg(long, value_name = "PORT", default_value_t = 0)]
    pub(crate) port: u16,
    /// Folder for the states that you save on the page.
    #[arg(long, value_name = "DIR", default_value = "saved-states")]
    pub(crate) saves: PathBuf,
    #[arg(long, value_name = "N|auto", help = THREADS, default_value = "auto", value_parser = threads, allow_negative_numbers = true)]
    pub(crate) threads: Threads,
}

#[derive(Debug, Args)]
pub(crate) struct RunsArguments {
    /// Folders of runs, or folders that contain them.
    #[arg(value_name = "DIR", default_value = "runs")]
    pub(crate) folders: Vec<PathBuf>,
    /// Print as JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct FiguresArguments {
    /// Folders of runs, finished or stopped.
    #[arg(value_name = "DIR", required = true)]
    pub(crate) folders: Vec<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct CheckArguments {
    #[command(flatten)]
    pub(crate) configuration: ConfigurationArguments,
    #[command(flatten)]
    pub(crate) frames: FrameArguments,
    /// Print as JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct PresetsArguments {
    /// Preset to print, as TOML.
    #[arg(value_name = "NAME")]
    pub(crate) name: Option<String>,
    /// Print as JSON.
    #[arg(long, conflicts_with = "name")]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub(crate) struct NewtonianArguments {
    /// Bottleneck w = 2 (a - b).
    #[arg(long, value_name = "W")]
    pub(crate) width: f64,
    /// Mean radius a, in the same unit.
    #[arg(long, value_name = "A", default_value_t = 1.5)]
    pub(crate) radius: f64,
    /// Pressure rise over a wavelength, P = a^2 Dp/(8 mu c lambda).
    #[arg(long, value_name = "P", default_value_t = 0.0)]
    pub(crate) pressure: f64,
    /// Print as JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Reads the published rows of finished runs, computes a random sample of them again, compares it to the bit, and examines every claim. Called again it goes on where it stopped; runs are shared by --quick, --full and --fresh. Writes report.html, report.md, claims.json, figures/ and tables/, and keeps the runs in stores/ and again/. The exit code is 3 where a run computed again differs from its published row."
)]
pub(crate) struct ReproduceArguments {
    /// How many published rows to compute again: a part of the rows of each study, such as 1%, or as many as fit into a
    /// time, such as 90s. The default is 3 minutes, and 0% with --full.
    #[arg(long, value_name = "PART|TIME", value_parser = extent, conflicts_with_all = ["quick", "fresh"])]
    pub(crate) check: Option<Extent>,
    /// Seed of the random sample, to draw the same rows again; the default is a new one, which is printed.
    #[arg(long, value_name = "N", conflicts_with_all = ["quick", "fresh"])]
    pub(crate) check_seed: Option<u64>,
    /// Compute what the published rows lack as well, in hours or days.
    #[arg(long, conflicts_with = "quick")]
    pub(crate) full: bool,
    /// Begin from nothing and compute every run, in days.
    #[arg(long, conflicts_with_all = ["quick", "full", "import"])]
    pub(crate) fresh: bool,
    /// Begin from nothing and compute a few runs of everything, in some twenty minutes: shows each analysis, too few runs for most verdicts.
    #[arg(long)]
    pub(crate) quick: bool,
    /// Only these claims, such as F3,F6.
    #[arg(long, value_name = "CLAIMS", value_delimiter = ',', value_parser = claims(), hide_possible_values = true)]
    pub(crate) only: Vec<String>,
    /// Folder for report and runs; an older report in it is replaced.
    #[arg(long, value_name = "DIR", default_value = "reproduction")]
    pub(crate) out: PathBuf,
    /// Tables of finished runs (.csv, .parquet), or their folders, to begin from. Default: validation/results here or above.
    #[arg(long, value_name = "PATH", num_args = 1..)]
    pub(crate) import: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) work: WorkArguments,
    /// Print claims.json on standard output, and nothing else there.
    #[arg(long)]
    pub(crate) json: bool,
    /// No progress on standard error.
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

impl ReproduceArguments {
    /// Whether every run of the design is computed that is missing.
    pub(crate) fn computes_all(&self) -> bool {
        self.quick || self.full || self.fresh
    }
}

#[derive(Debug, Args)]
#[command(
    after_help = "Writes validation.json, and a table, a text and figures for each case. The exit code is 1 where a case failed."
)]
pub(crate) struct ValidateArguments {
    /// Only these cases, such as normal-impact,haff.
    #[arg(long, value_name = "CASES", value_delimiter = ',', value_parser = cases(), hide_possible_values = true)]
    pub(crate) only: Vec<String>,
    /// Fewer points and replicates: takes less than a minute.
    #[arg(long)]
    pub(crate) quick: bool,
    /// Folder for the results; older ones in it are replaced.
    #[arg(long, value_name = "DIR", default_value = "validation-report")]
    pub(crate) out: PathBuf,
    /// Put the results into this document, between the lines `<!-- validate CASE -->` and `<!-- /validate -->`.
    #[arg(long, value_name = "FILE")]
    pub(crate) write: Option<PathBuf>,
    /// Print validation.json on standard output, and nothing else there.
    #[arg(long)]
    pub(crate) json: bool,
    /// No progress on standard error.
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Args)]
pub(crate) struct CompletionsArguments {
    /// Shell to complete for.
    pub(crate) shell: clap_complete::Shell,
}

/// The names of the presets.
fn presets() -> PossibleValuesParser {
    PossibleValuesParser::new(preset_names())
}

/// How many rows are computed again.
fn extent(text: &str) -> Result<Extent, String> {
    let misread = || "a part such as 1%, from 0% to 100%, or a time such as 90s".to_owned();
    let Some(part) = text.strip_suffix('%') else {
        return time_span(text).map(Extent::Time).map_err(|_| misread());
    };
    let part: f64 = part.trim().parse().map_err(|_| misread())?;
    match (0.0..=100.0).contains(&part) {
        true => Ok(Extent::Part(part / 100.0)),
        false => Err(misread()),
    }
}

fn claims() -> Offered {
    Offered(CLAIMS.iter().map(|claim| claim.id).collect())
}

fn cases() -> Offered {
    Offered(CASES.iter().map(|case| case.name).collect())
}

/// A number above 0.
fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse().ok();
    let number = number.filter(|number: &f64| *number > 0.0 && number.is_finite());
    number.ok_or_else(|| "a number above 0".to_owned())
}

/// Seeds of replicates, each once.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Seeds(pub(crate) Vec<u64>);

/// Most replicates of one call.
const MOST_SEEDS: usize = 10_000;

/// Threads that compute a run.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Threads {
    /// As many as pay.
    Auto,
    Number(u16),
}

impl Threads {
    /// How many compute `run` where so many processors are free for it.
    pub(crate) fn of(self, run: &Run, processors: usize) -> usize {
        match self {
            Self::Auto => run.simulation().threads_that_pay(processors),
            Self::Number(threads) => usize::from(threads),
        }
    }
}

fn threads(text: &str) -> Result<Threads, String> {
    match text.parse() {
        _ if text == "auto" => Ok(Threads::Auto),
        Ok(threads @ 1..=1024) => Ok(Threads::Number(threads)),
        _ => Err("from 1 to 1024, or auto".to_owned()),
    }
}

fn seeds(text: &str) -> Result<Seeds, String> {
    let misread = || "seeds such as 1..10, both ends among them, or 1,2,5".to_owned();
    let too_many = || format!("at most {MOST_SEEDS} seeds");
    let number = |text: &str| text.trim().parse::<u64>().map_err(|_| misread());
    let mut seeds = Vec::new();
    for part in text.split(',') {
        let (from, to) = match part.split_once("..") {
            Some((from, to)) => (number(from)?, number(to.trim_start_matches('='))?),
            None => (number(part)?, number(part)?),
        };
        if from > to {
            return Err(misread());
        }
        if to - from >= MOST_SEEDS as u64 {
            return Err(too_many());
        }
        seeds.extend(from..=to);
    }
    let given = seeds.len();
    seeds.sort_unstable();
    seeds.dedup();
    match seeds.len() {
        number if number < given => Err("each seed once".to_owned()),
        number if number > MOST_SEEDS => Err(too_many()),
        _ => Ok(Seeds(seeds)),
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    #[test]
    fn seeds_are_a_range_or_a_list() {
        let read = |text: &str| super::seeds(text).map(|seeds| seeds.0);
        assert_eq!(read("1..4").unwrap(), [1, 2, 3, 4]);
        assert_eq!(read("5,1,2").unwrap(), [1, 2, 5]);
        assert_eq!(read("7..=8,1").unwrap(), [1, 7, 8]);
        for text in [
            "",
            "a",
            "4..1",
            "1,1",
            "1..3,2",
            "-1",
            "0..18446744073709551615",
        ] {
            assert!(read(text).is_err(), "{text}");
        }
        let refused = read("1..1000000000").unwrap_err();
        assert!(refused.contains("at most"), "{refused}");
    }

    #[test]
    fn an_extent_is_a_part_or_a_time() {
        use super::{Extent, extent};
        assert_eq!(extent("1%"), Ok(Extent::Part(0.01)));
        assert_eq!(extent("0%"), Ok(Extent::Part(0.0)));
        let time = std::time::Duration::from_secs(90);
        assert_eq!(extent("90s"), Ok(Extent::Time(time)));
        for text in ["", "1", "%", "101%", "-1%", "NaN%", "0s", "1h%"] {
            assert!(extent(text).is_err(), "{text}");
        }
    }

    #[test]
    fn the_command_line_is_consistent() {
        super::Arguments::command().debug_assert();
    }
}
