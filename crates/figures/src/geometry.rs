//! Places, rectangles and outlines on a page, in points, y downwards.

use ttf_parser::OutlineBuilder;

/// A place on the page in points, from the top left corner, y downwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Point {
    pub(crate) x: f64,
    pub(crate) y: f64,
}

impl Point {
    pub(crate) const fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }

    /// This place as seen from another, which becomes the origin of a shape.
    pub(crate) fn from(self, origin: Self) -> Self {
        Self::new(origin.x + self.x, origin.y + self.y)
    }
}

/// A rectangle on the page, in points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rectangle {
    pub(crate) left: f64,
    pub(crate) top: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

impl Rectangle {
    /// From its upper left corner, with its width and height.
    pub(crate) const fn new((left, top): (f64, f64), (width, height): (f64, f64)) -> Self {
        Self {
            left,
            top,
            width,
            height,
        }
    }

    /// From its left to its right end, and from its top to its bottom.
    pub(crate) fn between((left, right): (f64, f64), (top, bottom): (f64, f64)) -> Self {
        Self::new((left, top), (right - left, bottom - top))
    }

    pub(crate) fn right(&self) -> f64 {
        self.left + self.width
    }

    pub(crate) fn bottom(&self) -> f64 {
        self.top + self.height
    }

    /// The corners, from the upper left one clockwise.
    pub(crate) fn corners(&self) -> [Point; 4] {
        [
            Point::new(self.left, self.top),
            Point::new(self.right(), self.top),
            Point::new(self.right(), self.bottom()),
            Point::new(self.left, self.bottom()),
        ]
    }

    /// Whether a place lies inside or on the edge.
    pub(crate) fn holds(&self, place: Point) -> bool {
        const SLACK: f64 = 1e-6;
        (self.left - SLACK..=self.right() + SLACK).contains(&place.x)
            && (self.top - SLACK..=self.bottom() + SLACK).contains(&place.y)
    }
}

/// One step of a pen along an outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Step {
    /// To a place without a line.
    Move(Point),
    /// Straight to a place.
    Line(Point),
    /// Along a parabola with one control point.
    Quadratic(Point, Point),
    /// Along a cubic curve with two control points.
    Cubic(Point, Point, Point),
    /// Round a whole circle by its centre and radius.
    Circle(Point, f64),
    /// Straight to the place where this part began.
    Close,
}

/// What a pen draws: any number of lines and outlines.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Path {
    pub(crate) steps: Vec<Step>,
}

impl Path {
    /// An open line through points.
    pub(crate) fn line(points: impl IntoIterator<Item = Point>) -> Self {
        let mut points = points.into_iter();
        let start = points.next().map(Step::Move);
        Self {
            steps: start.into_iter().chain(points.map(Step::Line)).collect(),
        }
    }

    /// A closed line through points.
    pub(crate) fn polygon(corners: impl IntoIterator<Item = Point>) -> Self {
        let mut path = Self::line(corners);
        path.steps.push(Step::Close);
        path
    }

    /// Straight lines apart from each other, each from its first to its second point.
    pub(crate) fn segments(segments: impl IntoIterator<Item = [Point; 2]>) -> Self {
        let steps = |[from, to]: [Point; 2]| [Step::Move(from), Step::Line(to)];
        Self {
            steps: segments.into_iter().flat_map(steps).collect(),
        }
    }

    pub(crate) fn circle(centre: Point, radius: f64) -> Self {
        Self {
            steps: vec![Step::Circle(centre, radius)],
        }
    }

    /// Copies of this path with its origin at each of some places.
    pub(crate) fn at(&self, places: impl IntoIterator<Item = Point>) -> Self {
        let copy = |place: Point| {
            self.steps.iter().map(move |step| match *step {
                Step::Move(to) => Step::Move(to.from(place)),
                Step::Line(to) => Step::Line(to.from(place)),
                Step::Quadratic(control, to) => {
                    Step::Quadratic(control.from(place), to.from(place))
                }
                Step::Cubic(first, second, to) => {
                    Step::Cubic(first.from(place), second.from(place), to.from(place))
                }
                Step::Circle(centre, radius) => Step::Circle(centre.from(place), radius),
                Step::Close => Step::Close,
            })
        };
        Self {
            steps: places.into_iter().flat_map(copy).collect(),
        }
    }

    /// The points that a path of straight lines goes through, and the centres of its circles.
    #[cfg(test)]
    pub(crate) fn points(&self) -> Vec<Point> {
        let point = |step: &Step| match *step {
            Step::Move(to) | Step::Line(to) | Step::Circle(to, _) => Some(to),
            _ => None,
        };
        self.steps.iter().filter_map(point).collect()
    }
}

/// Outlines of glyphs have y upwards; ours has it downwards.
fn turned(x: f32, y: f32) -> Point {
    Point::new(f64::from(x), -f64::from(y))
}

impl OutlineBuilder for Path {
    fn move_to(&mut self, x: f32, y: f32) {
        self.steps.push(Step::Move(turned(x, y)));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.steps.push(Step::Line(turned(x, y)));
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let step = Step::Quadratic(turned(x1, y1), turned(x, y));
        self.steps.push(step);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let step = Step::Cubic(turned(x1, y1), turned(x2, y2), turned(x, y));
        self.steps.push(step);
    }

    fn close(&mut self) {
        self.steps.push(Step::Close);
    }
}
