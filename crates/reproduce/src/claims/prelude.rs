//! The words in which claims are written.

pub(super) use peristalsis_analysis::Uncertain;
pub(super) use peristalsis_analysis::number::{decimal as number, with_error};
pub(super) use peristalsis_figures::chart::{
    ChartFigure, ChartPanel, Key, LegendPlace, Line as Curve, Pattern, Points, Reference, Tint,
    Window,
};
pub(super) use peristalsis_figures::{Quantity as Axis, Scale};
pub(super) use peristalsis_formats::Table;
pub(super) use peristalsis_run::files;

pub(super) use crate::branch::*;
pub(super) use crate::claim::Claim;
pub(super) use crate::collapse::*;
pub(super) use crate::critical::*;
pub(super) use crate::draft::Draft;
pub(super) use crate::error::Result;
pub(super) use crate::estimates::*;
pub(super) use crate::evidence::{Evidence, StudyResults, first_kept};
pub(super) use crate::exhibit::*;
pub(super) use crate::finding::{Finding, Quantity, ReportFigure, Statistics, Verdict};
pub(super) use crate::forces::*;
pub(super) use crate::judgement::*;
pub(super) use crate::near::*;
pub(super) use crate::prose::{Prose, values};
pub(super) use crate::row::*;
pub(super) use crate::thresholds::*;
pub(super) use crate::walls::*;
