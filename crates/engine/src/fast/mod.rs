//! The fast kernels: eight contacts at a time, the same bits on every set of instructions.

pub(crate) mod dispatch;
pub(crate) mod lanes;
pub(crate) mod listed;
