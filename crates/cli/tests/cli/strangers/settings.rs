//! Settings, warnings and what `check` says.
