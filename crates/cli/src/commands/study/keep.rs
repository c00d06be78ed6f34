//! `peristalsis study retry`, `verify`, `scan`, `export`, `pack` and `import`

use std::path::Path;
use std::process::ExitCode;

use peristalsis_study::{Identity, State, Store, Verification, not_whole};

use super::{ExportArguments, ImportArguments, PackArguments, RetryArguments, StoreArguments};
use crate::commands::{code_of, counted, print, say, say_if_replaced};
use crate::failure::Failure;
use crate::sources;

pub(crate) fn retry(arguments: &RetryArguments) -> Result<ExitCode, Failure> {
    let store = Store::open(&arguments.store.store)?;
    let survey = store.survey()?;
    let runs: Vec<Identity> = if arguments.failed {
        let planned = survey.plan.runs().iter().map(|run| run.identity);
        let failed = planned.filter(|identity| survey.state(*identity) == State::Failed);
        failed.collect()
    } else {
        let prefixes = arguments.runs.iter();
        let runs = prefixes.map(|prefix| survey.run_beginning(prefix));
        runs.collect::<Result<_, _>>()?
    };
    let mut begun = 0;
    for identity in &runs {
        if store.retry(*identity)? {
            begun += 1;
        } else {
            say(&format!(
                "run {identity} has neither failed nor finished, or is being worked on: left as it is"
            ));
        }
    }
    print(&format!(
        "{} will be computed again\n",
        counted(begun, "run")
    ))?;
    Ok(code_of(begun == runs.len()))
}

pub(crate) fn verify(arguments: &StoreArguments) -> Result<ExitCode, Failure> {
    let found = Store::open(&arguments.store)?.scan()?;
    print(&in_words(&found))?;
    Ok(code_of(
        found.quarantined.is_empty() && found.lost_tables.is_empty(),
    ))
}

pub(crate) fn scan(arguments: &StoreArguments) -> Result<ExitCode, Failure> {
    print(&in_words(&Store::open(&arguments.store)?.scan()?))
}

fn in_words(found: &Verification) -> String {
    let mut text = format!(
        "{} whose files agree with their hashes, {} imported, {} with a saved state, {} failed\n",
        counted(found.whole, "finished run"),
        found.imported,
        found.checkpointed,
        found.failed
    );
    text.extend(moved_aside(&found.quarantined).map(|line| line + "\n"));
    text.extend(found.lost_tables.iter().map(|(table, runs)| {
        format!(
            "{table} is gone, or was changed and is moved aside, and with it {}: import its table again\n",
            counted(*runs, "finished run")
        )
    }));
    text
}

/// Messages about runs whose files were not whole.
fn moved_aside(runs: &[(Identity, String)]) -> impl Iterator<Item = String> {
    runs.iter()
        .map(|(identity, reason)| not_whole(*identity, reason))
}

pub(crate) fn export(arguments: &ExportArguments) -> Result<ExitCode, Failure> {
    let store = Store::open(&arguments.store.store)?;
    let exported = store.export(&arguments.out, arguments.series)?;
    for line in moved_aside(&exported.quarantined) {
        say(&line);
    }
    for file in &exported.replaced {
        say(&format!("replaces {}", file.display()));
    }
    for file in &exported.removed {
        say(&format!("removes {}, of an older export", file.display()));
    }
    let (failed, missing) = (exported.failed, exported.missing - exported.failed);
    if failed > 0 {
        say(&format!("failed: {}", counted(failed, "run")));
    }
    if missing > 0 {
        say(&format!("not finished yet: {}", counted(missing, "run")));
    }
    if exported.without_series > 0 {
        say(&format!(
            "without a series: {}, imported as rows or without flow_rate_ratio in record.columns",
            counted(exported.without_series, "run")
        ));
    }
    if exported.leaking > 0 {
        say(&format!(
            "grains escaped in {} of {}: see the column escaped_most",
            exported.leaking,
            counted(exported.rows, "run")
        ));
    }
    for file in &exported.files {
        print(&format!("{}\n", file.display()))?;
    }
    Ok(code_of(exported.quarantined.is_empty()))
}

pub(crate) fn pack(arguments: &PackArguments) -> Result<ExitCode, Failure> {
    if !is_archive(&arguments.archive) {
        return Err(Failure::usage(
            format!("{} is no name of an archive", arguments.archive.display()),
            "let it end in .tar, by which study import knows archives",
        ));
    }
    let store = Store::open(&arguments.store.store)?;
    say_if_replaced(&arguments.archive);
    let packed = store.pack(&arguments.archive)?;
    let archive = arguments.archive.display();
    if packed.without_files > 0 {
        say(&format!(
            "left out, for they were imported as rows and have no files: {}; study export writes their rows",
            counted(packed.without_files, "finished run")
        ));
    }
    for (identity, reason) in &packed.refused {
        say(&format!(
            "run {identity} is left out ({reason}): study verify moves it aside, study run computes it again"
        ));
    }
    print(&format!(
        "{} in {archive}\n",
        counted(packed.runs, "finished run")
    ))?;
    Ok(code_of(packed.refused.is_empty()))
}

pub(crate) fn import(arguments: &ImportArguments) -> Result<ExitCode, Failure> {
    let path = &arguments.store.store;
    let is_new = !path.exists();
    let store = match &arguments.study {
        Some(file) => Store::create(path, &sources::study(file)?)?,
        None => Store::open(path)?,
    };
    let (mut is_whole, mut is_empty) = (true, is_new);
    for file in &arguments.files {
        let packed = match is_archive(file) {
            true => store.import_archive(file),
            false => store.import_table(file),
        };
        let packed = match packed {
            Ok(packed) => packed,
            Err(error) => {
                if is_empty {
                    // What was made for this call holds nothing.
                    drop(store);
                    let _ = std::fs::remove_dir_all(path);
                }
                return Err(error.into());
            }
        };
        is_empty = false;
        is_whole &= packed.refused.is_empty();
        for (identity, reason) in &packed.refused {
            let file = file.display();
            say(&format!("run {identity} of {file} is left out: {reason}"));
        }
        let (taken, all, file) = (packed.taken, counted(packed.runs, "run"), file.display());
        print(&format!("{taken} of {all} taken from {file}\n"))?;
        if packed.different > 0 {
            say(&format!(
                "{} finished here already, with other numbers than in {file}: left as they are",
                counted(packed.different, "run")
            ));
        }
    }
    let others = store.survey()?.others();
    if others > 0 {
        say(&format!(
            "not part of the study as it stands: {}",
            counted(others, "finished run")
        ));
    }
    Ok(code_of(is_whole))
}

/// Whether a file is an archive of [`Store::pack`], by its name.
fn is_archive(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "tar")
}
