//! The physics of grains in a peristaltic tube: contact laws, wall kinematics, drives and the Newtonian reference.
//!
//! Everything here is pure: no input or output, no threads, no random numbers, no allocation in a force. Parameter
//! types are `Copy` and carry their units in their documentation. A contact law sees a [`contact::Contact`], never
//! particles, so that grain-grain and grain-wall contacts, every integrator and every kernel share one formula;
//! the laws are written for any [`real::Real`], one number or several side by side.
//!
//! These types are the vocabulary of a configuration as well: a field's documentation, unit, range and default are
//! the ones of its key, from which the reader, its errors and the schema follow.

#![forbid(unsafe_code)]

pub mod contact;
pub mod ends;
pub mod method;
pub mod newtonian;
pub mod real;
pub mod sizes;
pub mod wall;
