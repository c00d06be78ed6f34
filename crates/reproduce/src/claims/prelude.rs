//! The words in which claims are written.

pub(super) use peristalsis_analysis::Uncertain;
pub(super) use peristalsis_analysis::number::{decimal as number, interval, with_error};
pub(super) use peristalsis_figures::chart::{
    ChartFigure, ChartPanel, LegendPlace, Line as Curve, Pattern, Points, Reference, Tint, Window,
};
pub(super) use peristalsis_figures::{Quantity as Axis, Scale, Width};
pub(super) use peristalsis_formats::Table;

pub(super) use crate::branch::{
    Branch, Branches, Control, Point, Step, columns, difference, distance,
};
pub(super) use crate::claim::Claim;
pub(super) use crate::critical::{DIVERGENCES, OnLattice, bar, crossing, slope, weighted_mean};
pub(super) use crate::draft::Draft;
pub(super) use crate::error::Result;
pub(super) use crate::evidence::{Evidence, StudyResults, first_kept};
pub(super) use crate::exhibit::{
    NONE, both_starts, branch_points, cell, cell_of, coloured, colours, course, ends, error_band,
    flow_panel, fluid, joined, label, listed, numbered, panel, points, rate_colours, spaced,
};
pub(super) use crate::finding::{Finding, Quantity, ReportFigure, Statistics, Verdict};
pub(super) use crate::forces::ForceLine;
pub(super) use crate::judgement::{Part, agrees, all_hold, best, judge};
pub(super) use crate::lattices::{AtRate, Shown};
pub(super) use crate::prose::{Prose, values};
pub(super) use crate::row::{
    Lattice, Row, Start, ascending, behind, by_strain_rate, grouped, longest, mean, mean_of,
};
