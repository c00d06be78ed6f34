//! Snapshots above each other, to one scale and with one bar of colours.

use super::view::View;
use super::{SnapshotFigure, SnapshotGrain, SnapshotSphere, row_length};
use crate::axis::Axis;
use crate::colour::BLACK;
use crate::colour_bar::{BAR_HEIGHT, draw_colour_bar};
use crate::drawing::{Anchor, Drawing, Rectangle};
use crate::error::FigureError;
use crate::panel::{Panel, draw_title, left_margin, title_space};
use crate::series::{Sample, extent};
use crate::style::{LABEL_SIZE, LABEL_SPACE, RIGHT_MARGIN, TICK_SPACE, Width};
use crate::text::Text;

/// Snapshots above each other, for instance unjammed flow above jammed, with one scale of length and one of velocity.
///
/// Of each snapshot the grains, the wall and the part of the tube count; titles and widths are those of the stack, the
/// unit of length is the first one's, and the largest limit of the velocity has the deepest colours.
#[derive(Clone, Copy, Debug, Default)]
pub struct SnapshotStack<'a> {
    /// Line above the figure, in markup; none if empty.
    pub title: &'a str,
    /// The snapshots from top to bottom, each with a label above it, in markup; none if empty.
    pub snapshots: &'a [(&'a str, SnapshotFigure<'a>)],
    /// Width of the figure.
    pub width: Width,
}

impl SnapshotStack<'_> {
    /// Lays the figure out.
    ///
    /// # Errors
    /// If there is no snapshot, or as [`SnapshotFigure::draw`].
    pub fn draw(&self) -> Result<Drawing, FigureError> {
        if self.snapshots.is_empty() {
            return Err(FigureError::EmptySeries {
                series: "stack of snapshots",
                length: 0,
            });
        }
        draw_stack(self.title, self.width, self.snapshots)
    }
}

/// A snapshot, checked and in the order of drawing.
pub(super) struct Prepared {
    pub(super) start: f64,
    pub(super) length: f64,
    pub(super) limit: f64,
    /// Where the periodic images of the tube lie.
    pub(super) shifts: Vec<f64>,
    /// Half height of a row.
    pub(super) reach: f64,
    /// Of a mean sphere.
    pub(super) diameter: f64,
    /// How much of the tube is shown, in markup; empty where it is all of it.
    pub(super) extent: String,
    /// From the furthest to the nearest.
    pub(super) grains: Vec<SnapshotGrain>,
    pub(super) spheres: Vec<SnapshotSphere>,
    pub(super) outline: Vec<Vec<Sample>>,
}

const ROW_GAP: f64 = 4.0;
/// Space above a snapshot for its label.
const HEADER_SPACE: f64 = 10.0;

/// Draws at least one snapshot.
pub(super) fn draw_stack(
    title: &str,
    width: Width,
    snapshots: &[(&str, SnapshotFigure<'_>)],
) -> Result<Drawing, FigureError> {
    let parts: Vec<Prepared> = snapshots
        .iter()
        .map(|(_, figure)| figure.prepared())
        .collect::<Result<_, _>>()?;
    let most = |of: fn(&Prepared) -> f64| extent(parts.iter().map(of)).1;
    let (reach, limit) = (most(|part| part.reach), most(|part| part.limit));
    let diameter = extent(parts.iter().map(|part| part.diameter)).0;
    let unit = snapshots[0].1.length_unit;

    let width = width.points();
    let y = Axis::linear((-reach, reach));
    let row_beside = |left: f64| {
        let room = width - left - RIGHT_MARGIN - 4.0;
        let row_length = row_length(most(|part| part.length), room, diameter);
        (room, row_length, 2.0 * reach * room / row_length)
    };
    // The numbers on the vertical axis need room that the height of a row, and so they, depend on.
    let left = left_margin(&y, row_beside(left_margin(&y, 0.0)).2);
    let (room, row_length, height) = row_beside(left);
    let scale = room / row_length;
    let pitch = height + TICK_SPACE + ROW_GAP;
    let rows_of = |part: &Prepared| (part.length / row_length - 1e-9).ceil().max(1.0) as usize;
    let same_extent = parts
        .windows(2)
        .all(|pair| pair[0].extent == pair[1].extent);
    let headers: Vec<String> = snapshots
        .iter()
        .zip(&parts)
        .map(|((label, _), part)| match (same_extent, label.is_empty()) {
            (true, _) => (*label).to_owned(),
            (false, true) => part.extent.clone(),
            (false, false) if part.extent.is_empty() => (*label).to_owned(),
            (false, false) => format!("{label}  ({})", part.extent),
        })
        .collect();
    let header_space = |header: &String| if header.is_empty() { 0.0 } else { HEADER_SPACE };
    let rows: usize = parts.iter().map(rows_of).sum();
    let above = headers.iter().map(header_space).sum::<f64>();
    let mut top = title_space(title) + 4.0;
    let end = top + above + pitch * rows as f64;
    let mut drawing = Drawing::new(
        width,
        end + LABEL_SPACE + BAR_HEIGHT + TICK_SPACE + 1.0,
        &format!("Snapshot of the tube from the side: {title}"),
    );

    draw_title(&mut drawing, title, width);
    for (part, header) in parts.iter().zip(&headers) {
        if !header.is_empty() {
            let text = Text::fitted(header, LABEL_SIZE, room);
            let baseline = top + HEADER_SPACE - 3.0;
            drawing
                .layer("headers", None)
                .text((left, baseline), Anchor::Start, text, BLACK);
            top += HEADER_SPACE;
        }
        for row in 0..rows_of(part) {
            let from = part.start + row_length * row as f64;
            let to = (from + row_length).min(part.start + part.length);
            let frame = Rectangle {
                left,
                top,
                width: (to - from) * scale,
                height,
            };
            let view = View {
                panel: Panel {
                    frame,
                    x: Axis::linear((from, to)),
                    y,
                },
                scale,
            };
            view.draw_wall(&mut drawing, &part.spheres, &part.outline, &part.shifts);
            view.draw_grains(&mut drawing, &part.grains, &part.shifts, limit);
            view.draw_frame(&mut drawing, unit);
            top += pitch;
        }
    }
    let bottom = end - ROW_GAP;
    let mut label = if unit.is_empty() {
        "*z*".to_owned()
    } else {
        format!("*z*/{unit}")
    };
    if same_extent && !parts[0].extent.is_empty() {
        label = format!("{label}  ({})", parts[0].extent);
    }
    let layer = drawing.layer("axes", None);
    layer.text(
        (left + room / 2.0, bottom + LABEL_SIZE),
        Anchor::Middle,
        Text::new(&label, LABEL_SIZE),
        BLACK,
    );
    let velocities = parts
        .iter()
        .flat_map(|part| part.grains.iter().map(|grain| grain.axial_velocity));
    draw_colour_bar(
        &mut drawing,
        left + room / 2.0,
        bottom + LABEL_SPACE + 3.0,
        limit,
        extent(velocities),
    );
    Ok(drawing)
}
