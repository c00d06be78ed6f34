//! `peristalsis study submit`

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use peristalsis_formats::shell_word;
use peristalsis_study::Store;

use super::{SubmitArguments, store_path};
use crate::commands::{counted, print, refuse_loss, say_if_replaced};
use crate::failure::Failure;
use crate::sources;

/// Time before the end of a task at which Slurm asks it to stop, where it has not stopped by itself.
const WARNING: Duration = Duration::from_secs(60);
/// Options of sbatch, long and short, and those of this command that set them.
const SET_HERE: [([&str; 2], &str); 5] = [
    (["--array", "-a"], "--tasks"),
    (["--cpus-per-task", "-c"], "--processors"),
    (["--time", "-t"], "--time"),
    (["--partition", "-p"], "--partition"),
    (["--account", "-A"], "--account"),
];
/// Shortest time of a task: twice the time kept for saving at its end.
const SHORTEST: Duration = Duration::from_secs(240);

pub(crate) fn submit(arguments: &SubmitArguments) -> Result<ExitCode, Failure> {
    if arguments.time < SHORTEST {
        let [time, shortest] = [arguments.time, SHORTEST].map(|time| time.as_secs());
        return Err(Failure::usage(
            format!("--time is {time} s, too short to save and end within it"),
            format!("give {shortest} s or more"),
        ));
    }
    if let Some(option) = arguments.further_lines() {
        return Err(Failure::usage(
            format!("{option:?} is not one option of sbatch"),
            "give one option at a time, such as --option=--mem-per-cpu=1G",
        ));
    }
    for option in &arguments.options {
        let name = option.split(['=', ' ']).next().unwrap_or(option);
        if let Some((_, own)) = SET_HERE.iter().find(|(names, _)| names.contains(&name)) {
            return Err(Failure::usage(
                format!("--option={option} would set {name} twice"),
                format!("give it as {own} of this command"),
            ));
        }
    }
    if let Some(path) = &arguments.out {
        refuse_loss(path, [arguments.file.clone()])?;
    }
    let study = sources::study(&arguments.file)?;
    let store = store_path(&arguments.store, &study);
    // So that a study that cannot run is refused here, and no two tasks make it.
    drop(Store::create(&store, &study)?);
    let job = Job {
        name: &study.name,
        program: program()?,
        study: absolute(&arguments.file)?,
        store: absolute(&store)?,
        arguments,
    };
    let script = job.script();
    let path = match &arguments.out {
        Some(path) if path.as_os_str() == "-" => {
            return print(&script);
        }
        Some(path) => path.clone(),
        None => PathBuf::from(format!("{}.sbatch", study.name)),
    };
    if path.is_dir() {
        return Err(Failure::usage(
            format!("{} is a folder", path.display()),
            "name the file of the script",
        ));
    }
    say_if_replaced(&path);
    std::fs::write(&path, script).map_err(Failure::write(&path))?;
    print(&format!(
        "{} asks for {} of {} for {}\n\
         submit it with: sbatch {}\n\
         see how far it is: peristalsis study status {}\n",
        path.display(),
        counted(arguments.tasks, "task"),
        counted(arguments.processors, "processor"),
        slurm_time(arguments.time),
        shell_word(&path),
        shell_word(&store),
    ))
}

struct Job<'a> {
    name: &'a str,
    program: PathBuf,
    study: PathBuf,
    store: PathBuf,
    arguments: &'a SubmitArguments,
}

impl Job<'_> {
    fn script(&self) -> String {
        let arguments = self.arguments;
        let mut options = vec![
            format!("--job-name={}", self.name),
            format!("--array=1-{}", arguments.tasks),
            "--ntasks=1".to_owned(),
            format!("--cpus-per-task={}", arguments.processors),
            format!("--time={}", slurm_time(arguments.time)),
            // To the program, which takes the shell's place below: it saves every run and ends.
            format!("--signal=B:USR1@{}", WARNING.as_secs()),
            "--requeue".to_owned(),
            format!("--output={}-%A-%a.log", self.name),
        ];
        let named = [
            ("partition", &arguments.partition),
            ("account", &arguments.account),
        ];
        let named = named.iter();
        options.extend(named.filter_map(|(name, it)| Some(format!("--{name}={}", it.as_ref()?))));
        let lines = options.iter().chain(&arguments.options);
        let options: String = lines.map(|option| format!("#SBATCH {option}\n")).collect();
        // Twice the warning is kept for the last checkpoints.
        let limit = (arguments.time - 2 * WARNING).as_secs();
        format!(
            "#!/bin/bash\n{options}\n\
             # Each task takes runs that no other has, until none is left or its time is up.\n\
             # Submitted again, it goes on where this ended.\n\
             exec {} study run {} \\\n    --store {} \\\n    \
             --workers \"${{SLURM_CPUS_PER_TASK:-1}}\" --for {limit}s\n",
            shell_word(&self.program),
            shell_word(&self.study),
            shell_word(&self.store),
        )
    }
}

/// Days, hours, minutes and seconds, whole ones, as Slurm reads them.
fn slurm_time(time: Duration) -> String {
    let time = time.as_secs();
    let (days, hours) = (time / 86_400, time / 3_600 % 24);
    let (minutes, seconds) = (time / 60 % 60, time % 60);
    format!("{days}-{hours:02}:{minutes:02}:{seconds:02}")
}

/// This program: the file that runs or, where Python runs it, the command that was called.
fn program() -> Result<PathBuf, Failure> {
    let is_named = |path: &Path| path.file_stem().is_some_and(|name| name == "peristalsis");
    let running = std::env::current_exe().map_err(Failure::read(Path::new("this program")))?;
    if is_named(&running) {
        return absolute(&running);
    }
    let mut words = std::env::args_os().map(PathBuf::from);
    let called = words.find(|word| is_named(word) && word.is_file());
    // What `python -m peristalsis` leaves: the one that the task will find.
    called.map_or(Ok(PathBuf::from("peristalsis")), |path| absolute(&path))
}

/// The path from the root on, which the script can hold.
fn absolute(path: &Path) -> Result<PathBuf, Failure> {
    let path = std::path::absolute(path).map_err(Failure::read(path))?;
    if path.to_str().is_none() {
        return Err(Failure::usage(
            format!("{} is no text, which a script is", path.display()),
            "give files and folders names in UTF-8",
        ));
    }
    Ok(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_written_as_slurm_reads_them() {
        for (seconds, text) in [
            (240, "0-00:04:00"),
            (5400, "0-01:30:00"),
            (180_061, "2-02:01:01"),
        ] {
            assert_eq!(slurm_time(Duration::from_secs(seconds)), text);
        }
    }
}
