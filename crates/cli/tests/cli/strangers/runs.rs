//! Folders of runs, signals, full disks, going on.
