//! Kills, full disks, flipped bits, several processes: in the end the tables are those of an undisturbed study, bit for bit.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::time::Duration;

use super::{STUDY, place_of, quick, tables};
use crate::limits::with_small_files;
use crate::{Outcome, Place, send};

/// Numbers that look random and are the same every time.
struct Numbers(u64);

impl Numbers {
    /// The next number below a limit.
    fn below(&mut self, limit: u64) -> u64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % limit
    }
}

const RUN: &str = "study run study.toml --store store --checkpoint-every 20ms --workers 2";

/// The tables of this study when nothing disturbs it.
fn undisturbed(text: &str) -> [Vec<u8>; 3] {
    let place = place_of(text);
    place.does(RUN);
    tables(&place, "store")
}

fn usual_tables() -> &'static [Vec<u8>; 3] {
    static TABLES: OnceLock<[Vec<u8>; 3]> = OnceLock::new();
    TABLES.get_or_init(|| undisturbed(STUDY))
}

/// Kills the process at a random moment again and again, until one comes to the end; answers how often.
fn kill_until_done(place: &Place, numbers: &mut Numbers, longest: u64) -> u32 {
    let mut kills = 0;
    loop {
        let mut child = place.start(RUN);
        std::thread::sleep(Duration::from_millis(10 + numbers.below(longest)));
        if let Some(status) = child.try_wait().unwrap() {
            let outcome = Outcome::of(child.wait_with_output().unwrap());
            assert_eq!(status.code(), Some(0), "{}", outcome.stderr);
            return kills;
        }
        child.kill().unwrap();
        child.wait().unwrap();
        kills += 1;
        assert!(kills < 2000, "it never comes to an end");
    }
}

/// Asserts that a store holds each run of its study once, whole, and that nothing had to be thrown away.
fn assert_whole(place: &Place, runs: usize) {
    let verified = format!(
        "{runs} finished runs whose files agree with their hashes, 0 imported, 0 with a saved state, 0 failed"
    );
    place.does("study verify store").shows(&[&verified]);
    assert!(!place.path("store/quarantine").exists());
    let timing = std::fs::read_to_string(place.path("store-tables/tested-timing.csv")).unwrap();
    let identities: BTreeSet<&str> = timing.lines().skip(1).collect();
    assert_eq!(identities.len(), runs);
}

#[test]
fn kills_at_random_moments_lose_nothing() {
    let place = place_of(STUDY);
    let kills = kill_until_done(&place, &mut Numbers(1), 300);
    assert!(kills >= 3, "only {kills} kills");
    println!("{kills} kills");
    assert!(tables(&place, "store") == *usual_tables());
    assert_whole(&place, 12);
}

#[test]
fn two_processes_and_others_that_are_killed_share_a_store() {
    let place = place_of(STUDY);
    let mut steady = [place.start(RUN), place.start(RUN)];
    let mut numbers = Numbers(2);
    let mut kills = 0;
    let is_on = |child: &mut Child| child.try_wait().unwrap().is_none();
    while steady.iter_mut().any(is_on) {
        let mut other = place.start(RUN);
        std::thread::sleep(Duration::from_millis(20 + numbers.below(150)));
        if other.try_wait().unwrap().is_none() {
            other.kill().unwrap();
            kills += 1;
        }
        other.wait().unwrap();
    }
    for child in steady {
        Outcome::of(child.wait_with_output().unwrap()).expect_code(0);
    }
    assert!(kills >= 3, "only {kills} kills");
    println!("{kills} kills");
    assert!(tables(&place, "store") == *usual_tables());
    assert_whole(&place, 12);
}

#[test]
fn a_process_that_slept_too_long_finds_its_run_taken_and_does_no_harm() {
    let place = place_of(STUDY);
    let sleeper = place.start(RUN);
    std::thread::sleep(Duration::from_millis(400));
    send("STOP", &sleeper);
    // Its leases are void for everyone else once the index is gone.
    std::fs::remove_file(place.path("store/index.sqlite")).unwrap();
    let other = place.start(RUN);
    std::thread::sleep(Duration::from_millis(300));
    send("CONT", &sleeper);
    for child in [sleeper, other] {
        // The first may find that its index was pulled from under it; the store is whole in any case.
        child.wait_with_output().unwrap();
    }
    place.does(RUN);
    assert!(tables(&place, "store") == *usual_tables());
}

#[test]
fn bits_that_flip_between_kills_are_found_and_mended() {
    let place = place_of(STUDY);
    let mut numbers = Numbers(3);
    let mut flipped = 0;
    for _ in 0..6 {
        let mut child = place.start(RUN);
        std::thread::sleep(Duration::from_millis(250 + numbers.below(250)));
        drop(child.kill());
        child.wait().unwrap();
        let files = files_below(&place.path("store/runs"));
        let candidates: Vec<&PathBuf> = files
            .iter()
            .filter(|path| {
                let name = path.file_name().unwrap().to_string_lossy();
                !name.contains("signac") && !name.contains("timing") && !name.ends_with(".partial")
            })
            .collect();
        if !candidates.is_empty() {
            let path = candidates[numbers.below(candidates.len() as u64) as usize];
            let mut bytes = std::fs::read(path).unwrap();
            let index = numbers.below(bytes.len() as u64) as usize;
            bytes[index] ^= 1 << numbers.below(8);
            std::fs::write(path, bytes).unwrap();
            flipped += 1;
        }
    }
    assert!(flipped >= 4, "only {flipped} flips");
    place.does(RUN);
    assert!(tables(&place, "store") == *usual_tables());
}

fn files_below(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let Ok(entries) = std::fs::read_dir(folder) else {
        return files;
    };
    for entry in entries {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(files_below(&path));
        } else {
            files.push(path);
        }
    }
    files.sort();
    files
}

/// A small disk of its own, taken away at the end.
struct SmallDisk {
    folder: PathBuf,
}

impl SmallDisk {
    fn mount(folder: PathBuf, size: &str) -> Option<Self> {
        std::fs::create_dir(&folder).unwrap();
        let mounted = Command::new("mount")
            .args(["-t", "tmpfs", "-o", &format!("size={size}"), "tmpfs"])
            .arg(&folder)
            .stderr(Stdio::null())
            .status();
        mounted
            .is_ok_and(|status| status.success())
            .then_some(Self { folder })
    }

    fn resize(&self, size: &str) {
        self.remount(&format!("remount,size={size}"));
    }

    /// Lets nothing be written any more, or again.
    fn close(&self, closed: bool) {
        self.remount(if closed { "remount,ro" } else { "remount,rw" });
    }

    fn remount(&self, options: &str) {
        let mut command = Command::new("mount");
        let status = command.args(["-o", options]).arg(&self.folder).status();
        assert!(status.unwrap().success());
    }
}

impl Drop for SmallDisk {
    fn drop(&mut self) {
        drop(Command::new("umount").arg(&self.folder).status());
    }
}

#[test]
fn a_disk_that_is_full_ends_the_work_and_loses_nothing() {
    let place = place_of(STUDY);
    let Some(disk) = SmallDisk::mount(place.path("disk"), "400k") else {
        println!("skipped: this user may mount no file system");
        return;
    };
    let run = RUN.replace("--store store", "--store disk/store");
    let mut full = 0;
    for size in ["400k", "600k", "900k", "1300k"] {
        disk.resize(size);
        let outcome = place.call(&run);
        if outcome.code == Some(0) {
            continue;
        }
        full += 1;
        outcome
            .expect_code(1)
            .says(&["nothing that was finished is lost"]);
    }
    assert!(full >= 2, "the disk was full {full} times");
    disk.resize("64m");
    place.does(&run);
    assert!(tables(&place, "disk/store") == *usual_tables());
}

#[test]
fn a_store_that_cannot_be_written_to_can_be_looked_at() {
    let place = place_of(&quick());
    let Some(disk) = SmallDisk::mount(place.path("disk"), "64m") else {
        println!("skipped: this user may mount no file system");
        return;
    };
    let run = RUN.replace("--store store", "--store disk/store");
    place.does(&run);
    let expected = tables(&place, "disk/store");
    std::fs::remove_dir_all(place.path("disk/store-tables")).unwrap();
    let before = files_below(&place.path("disk"));
    disk.close(true);
    place.does("study status disk/store").shows(&["4 done"]);
    let identity = std::fs::read_dir(place.path("disk/store/runs"))
        .unwrap()
        .next();
    let identity = identity.unwrap().unwrap().file_name();
    let identity = identity.to_str().unwrap();
    place
        .does(&format!("study why disk/store {identity}"))
        .shows(&["done"]);
    place.does("study export disk/store --out tables --series");
    for (name, bytes) in ["tested.csv", "tested.parquet", "tested-series.parquet"]
        .iter()
        .zip(&expected)
    {
        assert!(std::fs::read(place.path("tables").join(name)).unwrap() == *bytes);
    }
    // What has to write says that it cannot, and what to do.
    for command in [
        &run,
        "study scan disk/store",
        "study verify disk/store",
        &format!("study retry disk/store {identity}"),
    ] {
        place
            .call(command)
            .expect_code(1)
            .says(&["error:", "make the store writable"]);
    }
    assert_eq!(files_below(&place.path("disk")), before);
    disk.close(false);
    place.does(&run);
    assert!(tables(&place, "disk/store") == expected);
}

#[test]
fn files_from_the_future_are_as_good_as_others() {
    let place = place_of(&quick());
    place.does(RUN);
    let expected = tables(&place, "store");
    // The clock was set back by ten years, after the store was made.
    let later = std::time::SystemTime::now() + Duration::from_secs(315_000_000);
    for path in files_below(&place.path("store")) {
        let file = std::fs::File::options().write(true).open(path).unwrap();
        file.set_modified(later).unwrap();
    }
    place.does(RUN).says(&["all runs are done"]);
    place.does("study verify store");
    assert!(!place.path("store/quarantine").exists());
    assert!(tables(&place, "store") == expected);
}

#[test]
#[ignore = "some minutes: a store of ten thousand runs"]
fn a_store_of_ten_thousand_runs_is_looked_at_within_a_second() {
    let text = r#"
name = "large"
preset = "frictionless"
replicates = 10
[base]
grains.number = 1
tube.waves = 1
run.periods = 0.05
[record]
columns = ["time"]
profile = false
[[axes]]
key = "drive.width"
from = 2.5
to = 2.999
step = 0.0005
"#;
    let place = place_of(text);
    place.does(RUN);
    let start = std::time::Instant::now();
    place
        .does("study status store")
        .shows(&["9990 runs: 9990 done"]);
    let took = start.elapsed();
    println!("status of 9990 runs: {took:?}");
    assert!(
        cfg!(debug_assertions) || took < Duration::from_secs(1),
        "{took:?}"
    );
}

#[test]
fn files_that_cannot_grow_end_the_work_and_lose_nothing() {
    let place = place_of(STUDY);
    let mut refused = 0;
    for blocks in [1, 24, 64] {
        let outcome = with_small_files(&place, blocks, RUN);
        if outcome.code != Some(0) {
            refused += 1;
            outcome.expect_code(1);
        }
    }
    assert!(refused >= 2, "refused {refused} times");
    place.does(RUN);
    assert!(tables(&place, "store") == *usual_tables());
}

#[test]
#[ignore = "a minute or two: dozens of kills of two processes at once, with refinement"]
fn dozens_of_kills_of_two_processes_lose_nothing() {
    let text = STUDY
        .replace("replicates = 3", "replicates = 6")
        .replace("run.periods = 70", "run.periods = 150")
        + "[refine]\nkey = \"drive.width\"\ntolerance = 0.15\n";
    let expected = undisturbed(&text);
    let mut kills = 0;
    for seed in 0..40 {
        let place = place_of(&text);
        kills += std::thread::scope(|scope| {
            let place = &place;
            let loops = [100, 200].map(|base| {
                scope.spawn(move || kill_until_done(place, &mut Numbers(base + seed), 300))
            });
            loops.map(|one| one.join().unwrap()).iter().sum::<u32>()
        });
        assert!(tables(&place, "store") == expected);
        assert!(!place.path("store/quarantine").exists());
        if kills >= 100 {
            return;
        }
    }
    panic!("only {kills} kills");
}
