//! The fast kernels: eight contacts at a time, the same bits on every set of instructions.

pub(crate) mod columns;
pub(crate) mod lanes;
pub(crate) mod listed;
pub(crate) mod machine;
pub(crate) mod sorted;
mod sums;
pub(crate) mod threads;
