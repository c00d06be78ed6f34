//! References: closed forms, and equations of motion integrated to twelve digits, independently of the engine.

pub(crate) mod hertz;
pub(crate) mod impact;
pub(crate) mod kinetic;
pub(crate) mod maw;
pub(crate) mod ode;
