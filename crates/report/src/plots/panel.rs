//! One diagram: a frame, two axes, and data drawn inside.

use super::axis::{Axis, Tick};
use super::canvas::{Canvas, Dash, Point, Towards};
use super::style::{FAINT, GREY, Pen, Shape, TextLook, rounded};
use plotters::style::RGBColor;

/// A diagram's place on the sheet and its axes.
pub(crate) struct Panel<'c> {
    canvas: &'c Canvas,
    /// Top left corner of the frame.
    corner: Point,
    /// Width and height of the frame.
    size: (f64, f64),
    x: Axis,
    y: Axis,
    /// Number of the frame, where a reader reads values off.
    number: Option<usize>,
}

/// How a reader reads values off a diagram, and the names of its axes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reading<'a> {
    /// Name of the horizontal axis.
    pub x: &'a str,
    /// Name of the vertical axis.
    pub y: &'a str,
    /// Whether the horizontal axis can be stretched; all such diagrams of a figure stretch together.
    pub zooms: bool,
}

/// At which axes numbers stand; of diagrams that share an axis only the outer ones need them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Numbers {
    /// Below the frame.
    pub x: bool,
    /// Left of the frame.
    pub y: bool,
}

impl Numbers {
    /// At both.
    pub(crate) const BOTH: Self = Self { x: true, y: true };
}

/// Room that a number takes along the horizontal and the vertical axis, pixels.
const NUMBER: (f64, f64) = (46.0, 34.0);
/// So many numbers have a place below the narrowest diagram.
const LEAST_TICKS: usize = 4;
/// How far names of axes and titles stand from the frame, pixels.
const NUMBERS_BELOW: f64 = 14.0;
const NUMBERS_LEFT: f64 = 5.0;
const NAME_BELOW: f64 = 34.0;
const NAME_LEFT: f64 = 62.0;
const TITLE_ABOVE: f64 = 13.0;
/// Half the width of a bar's ends, and length of a mark for a value beyond the frame, pixels.
const CAP: f64 = 3.0;
const ARROW: f64 = 8.0;

/// How a figure and its error are marked.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Mark {
    /// Colour and thickness of the bar.
    pub pen: Pen,
    /// The mark at the figure.
    pub shape: Shape,
    /// Its radius; zero for a bar alone.
    pub radius: f64,
    /// Whether it is filled.
    pub filled: bool,
    /// Pixels to the right of its true place (below it, for a horizontal bar), so that marks at one place do not cover
    /// each other.
    pub aside: f64,
}

impl Mark {
    /// A filled disc in its place.
    pub(crate) fn disc(pen: Pen, radius: f64) -> Self {
        Self { pen, shape: Shape::Disc, radius, filled: true, aside: 0.0 }
    }

    /// A bar alone in its place.
    pub(crate) fn bar(pen: Pen) -> Self {
        Self::disc(pen, 0.0)
    }
}

impl<'c> Panel<'c> {
    /// Draws the empty diagram: grid, ticks, numbers and frame.
    pub(crate) fn new(canvas: &'c Canvas, corner: Point, size: (f64, f64), axes: (Axis, Axis)) -> Self {
        Self::with_numbers(canvas, (corner, size), axes, Numbers::BOTH)
    }

    /// The same with numbers at some of the axes only.
    pub(crate) fn with_numbers(
        canvas: &'c Canvas,
        (corner, size): (Point, (f64, f64)),
        axes: (Axis, Axis),
        numbers: Numbers,
    ) -> Self {
        let panel = Self { canvas, corner, size, x: axes.0, y: axes.1, number: None };
        panel.x_ticks(numbers.x);
        panel.y_ticks(numbers.y);
        canvas.frame(corner, panel.opposite(), Pen::hair(GREY));
        panel
    }

    /// Draws the empty diagram with numbers and names at both axes. A reader reads off its values and hides its [series](Self::series).
    pub(crate) fn readable(
        canvas: &'c Canvas,
        (corner, size): (Point, (f64, f64)),
        axes: (Axis, Axis),
        reading: Reading<'_>,
    ) -> Self {
        let number = canvas.next_frame();
        let panel = Self { canvas, corner, size, x: axes.0, y: axes.1, number: Some(number) };
        let number = number.to_string();
        canvas.group(&[("ticks", &number)], || panel.x_ticks(true));
        panel.y_ticks(true);
        canvas.frame(corner, panel.opposite(), Pen::hair(GREY));
        panel.x_name(reading.x);
        panel.y_name(reading.y, NAME_LEFT);
        let (x, y) = (panel.x.words(), panel.y.words());
        let mut data = vec![("frame", &*number), ("x", &x), ("y", &y), ("name", reading.x)];
        if reading.zooms {
            data.push(("zooms", ""));
        }
        canvas.frame_data(corner, panel.opposite(), &data);
        panel
    }

    /// Draws a series, which a reader hides and shows by its key where the diagram is readable.
    pub(crate) fn series(&self, key: &str, draw: impl FnOnce()) {
        match self.number {
            Some(number) => self.canvas.series(key, number, draw),
            None => draw(),
        }
    }

    fn opposite(&self) -> Point {
        (self.corner.0 + self.size.0, self.corner.1 + self.size.1)
    }

    fn x_ticks(&self, has_numbers: bool) {
        let ((left, top), (right, bottom)) = (self.corner, self.opposite());
        let width = right - left;
        let mut comb = vec![(left, bottom)];
        for tick in self.x.ticks(((width / NUMBER.0) as usize).max(LEAST_TICKS)) {
            let Some(x) = self.x.place(tick.at).map(|p| left + p * width) else { continue };
            comb.extend([(x, bottom), (x, bottom - length(&tick)), (x, bottom)]);
            let Some(label) = tick.label else { continue };
            self.canvas.line(&[(x, top), (x, bottom)], Pen::hair(FAINT));
            if has_numbers {
                self.canvas.text(&label, (x, bottom + NUMBERS_BELOW), TextLook::number().middle());
            }
        }
        self.canvas.line(&comb, Pen::hair(GREY));
    }

    fn y_ticks(&self, has_numbers: bool) {
        let ((left, top), (right, bottom)) = (self.corner, self.opposite());
        let height = bottom - top;
        let mut comb = vec![(left, bottom)];
        for tick in self.y.ticks((height / NUMBER.1) as usize) {
            let Some(y) = self.y.place(tick.at).map(|p| bottom - p * height) else { continue };
            comb.extend([(left, y), (left + length(&tick), y), (left, y)]);
            let Some(label) = tick.label else { continue };
            self.canvas.line(&[(left, y), (right, y)], Pen::hair(FAINT));
            if has_numbers {
                self.canvas.text(&label, (left - NUMBERS_LEFT, y), TextLook::number().end());
            }
        }
        self.canvas.line(&comb, Pen::hair(GREY));
    }

    /// Place on the sheet, inside the frame or not; `None` for a value without a logarithm on a logarithmic axis.
    pub(crate) fn place(&self, x: f64, y: f64) -> Option<Point> {
        let (px, py) = (self.x.place(x)?, self.y.place(y)?);
        Some((self.corner.0 + px * self.size.0, self.corner.1 + (1.0 - py) * self.size.1))
    }

    /// A line through values, cut at the frame.
    pub(crate) fn line(&self, values: &[(f64, f64)], pen: Pen) {
        for part in self.visible(values) {
            self.canvas.line(&part, pen);
        }
    }

    /// A broken line through values, cut at the frame.
    pub(crate) fn dashes(&self, values: &[(f64, f64)], dash: Dash, pen: Pen) {
        for part in self.visible(values) {
            self.canvas.dashes(&part, dash, pen);
        }
    }

    /// A horizontal line from end to end.
    pub(crate) fn level(&self, y: f64, dash: Option<Dash>, pen: Pen) {
        self.straight(&[(self.x.low(), y), (self.x.high(), y)], dash, pen);
    }

    /// A vertical line from end to end.
    pub(crate) fn upright(&self, x: f64, dash: Option<Dash>, pen: Pen) {
        self.straight(&[(x, self.y.low()), (x, self.y.high())], dash, pen);
    }

    fn straight(&self, ends: &[(f64, f64); 2], dash: Option<Dash>, pen: Pen) {
        match dash {
            Some(dash) => self.dashes(ends, dash, pen),
            None => self.line(ends, pen),
        }
    }

    /// The area between two curves over the same `x`, given as `(x, low, high)`, cut at the frame's lower and upper edge.
    pub(crate) fn band(&self, values: &[(f64, f64, f64)], colour: RGBColor) {
        let inside = |y: f64| self.y.clamp(y);
        let held =
            values.iter().filter(|(x, low, high)| self.x.holds(*x) && low.is_finite() && high.is_finite());
        let held: Vec<_> = held.collect();
        let upper = held.iter().filter_map(|(x, _, high)| self.place(*x, inside(*high)));
        let lower = held.iter().rev().filter_map(|(x, low, _)| self.place(*x, inside(*low)));
        let corners: Vec<Point> = upper.chain(lower).collect();
        if corners.len() > 3 {
            self.canvas.polygon(&corners, colour);
        }
    }

    /// The parts of a line inside the frame.
    fn visible(&self, values: &[(f64, f64)]) -> Vec<Vec<Point>> {
        let places: Vec<Option<Point>> = values.iter().map(|&(x, y)| self.place(x, y)).collect();
        let mut parts: Vec<Vec<Point>> = Vec::new();
        for pair in places.windows(2) {
            let (Some(a), Some(b)) = (pair[0], pair[1]) else { continue };
            let Some((from, to)) = clip(a, b, self.corner, self.size) else { continue };
            match parts.last_mut().filter(|part| part.last() == Some(&from)) {
                Some(part) => part.push(to),
                None => parts.push(vec![from, to]),
            }
        }
        parts
    }

    /// A figure with its upright bar from `low` to `high`. A bar that is cut at the frame ends in an arrow there, and so
    /// does a figure beyond the frame.
    pub(crate) fn mark(&self, x: f64, y: f64, (low, high): (f64, f64), mark: Mark) {
        let beside = |y: f64| self.place(x, y).map(|(px, py)| (px + mark.aside, py));
        let ends = [(low, Towards::Down), (high, Towards::Up)];
        self.bar((y, self.y), ends, mark, &beside);
        if let Some(centre) = beside(y).filter(|_| self.y.holds(y) && mark.radius > 0.0) {
            let interval = if low < high {
                format!(" [{}, {}]", rounded(low, 4), rounded(high, 4))
            } else {
                String::new()
            };
            self.canvas.hint(centre, mark.radius, &format!("{}: {}{interval}", rounded(x, 4), rounded(y, 4)));
        }
    }

    /// A figure with its level bar from `low` to `high`, cut as [`mark`](Self::mark)s are.
    pub(crate) fn level_mark(&self, (low, high): (f64, f64), x: f64, y: f64, mark: Mark) {
        let beside = |x: f64| self.place(x, y).map(|(px, py)| (px, py + mark.aside));
        let ends = [(low, Towards::Left), (high, Towards::Right)];
        self.bar((x, self.x), ends, mark, &beside);
    }

    fn bar(
        &self,
        (figure, axis): (f64, Axis),
        ends: [(f64, Towards); 2],
        mark: Mark,
        place: &dyn Fn(f64) -> Option<Point>,
    ) {
        let (Some(foot), Some(head)) = (place(axis.clamp(ends[0].0)), place(axis.clamp(ends[1].0))) else {
            return;
        };
        let is_long = (foot.0 - head.0).abs().max((foot.1 - head.1).abs()) > 0.0;
        if is_long {
            self.canvas.line(&[foot, head], mark.pen);
        }
        for ((value, towards), end) in ends.into_iter().zip([foot, head]) {
            let is_low_end = matches!(towards, Towards::Down | Towards::Left);
            let figure_beyond = if is_low_end { figure < axis.low() } else { figure > axis.high() };
            if figure_beyond || (is_long && !axis.holds(value)) {
                let length = if figure_beyond { ARROW } else { ARROW / 2.0 };
                self.canvas.arrow(end, towards, length, mark.pen.colour);
            } else if is_long {
                let across =
                    if matches!(towards, Towards::Up | Towards::Down) { (CAP, 0.0) } else { (0.0, CAP) };
                let cap = [(end.0 - across.0, end.1 - across.1), (end.0 + across.0, end.1 + across.1)];
                self.canvas.line(&cap, mark.pen);
            }
        }
        if let Some(centre) = place(figure).filter(|_| axis.holds(figure) && mark.radius > 0.0) {
            self.canvas.shape(mark.shape, centre, mark.radius, (mark.pen, mark.filled));
        }
    }

    /// A mark of a pair of values; at the edge, as an arrow, where it lies beyond the frame.
    pub(crate) fn point(&self, x: f64, y: f64, mark: Mark) {
        let at_edge = self.place(self.x.clamp(x), self.y.clamp(y));
        let (Some(at_edge), Some(px), Some(py)) = (at_edge, self.x.place(x), self.y.place(y)) else { return };
        let towards = match (px, py) {
            (_, py) if py > 1.0 => Towards::Up,
            (_, py) if py < 0.0 => Towards::Down,
            (px, _) if px > 1.0 => Towards::Right,
            (px, _) if px < 0.0 => Towards::Left,
            _ => return self.canvas.shape(mark.shape, at_edge, mark.radius, (mark.pen, mark.filled)),
        };
        self.canvas.arrow(at_edge, towards, ARROW, mark.pen.colour);
    }

    /// Text that the pointer finds at a pair of values, within so many pixels.
    pub(crate) fn hint(&self, (x, y): (f64, f64), radius: f64, text: &str) {
        if let Some(place) = self.place(x, y).filter(|_| self.x.holds(x) && self.y.holds(y)) {
            self.canvas.hint(place, radius, text);
        }
    }

    /// A text at a pair of values, so many pixels beside it.
    pub(crate) fn text(&self, text: &str, (x, y): (f64, f64), (right, down): (f64, f64), look: TextLook) {
        if let Some((px, py)) = self.place(x, y) {
            self.canvas.text(text, (px + right, py + down), look);
        }
    }

    /// A title above the frame.
    pub(crate) fn title(&self, text: &str) {
        let point = (self.corner.0 + self.size.0 / 2.0, self.corner.1 - TITLE_ABOVE);
        self.canvas.text(text, point, TextLook::heading().middle());
    }

    /// The name of the horizontal axis, below its numbers.
    pub(crate) fn x_name(&self, text: &str) {
        let point = (self.corner.0 + self.size.0 / 2.0, self.corner.1 + self.size.1 + NAME_BELOW);
        self.canvas.text(text, point, TextLook::axis().middle());
    }

    /// The name of the vertical axis, `distance` pixels left of the frame.
    pub(crate) fn y_name(&self, text: &str, distance: f64) {
        let point = (self.corner.0 - distance, self.corner.1 + self.size.1 / 2.0);
        self.canvas.text(text, point, TextLook::axis().middle().upwards());
    }

    /// A remark in the middle of an otherwise empty diagram, on as many lines as it takes.
    pub(crate) fn remark(&self, text: &str) {
        let look = TextLook::label().middle().colour(GREY);
        let lines = look.wrapped(text, self.size.0 - 2.0 * CAP);
        let (x, middle) = (self.corner.0 + self.size.0 / 2.0, self.corner.1 + self.size.1 / 2.0);
        for (i, line) in lines.iter().enumerate() {
            let below = i as f64 - (lines.len() - 1) as f64 / 2.0;
            self.canvas.text(line, (x, middle + below * look.line()), look);
        }
    }
}

/// Length of a tick's mark, pixels.
fn length(tick: &Tick) -> f64 {
    if tick.label.is_some() { 5.0 } else { 3.0 }
}

/// The part of a segment inside a rectangle (Liang and Barsky 1984).
fn clip(from: Point, to: Point, corner: Point, size: (f64, f64)) -> Option<(Point, Point)> {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let (mut enter, mut leave) = (0.0f64, 1.0f64);
    for (direction, room) in [
        (-dx, from.0 - corner.0),
        (dx, corner.0 + size.0 - from.0),
        (-dy, from.1 - corner.1),
        (dy, corner.1 + size.1 - from.1),
    ] {
        if direction == 0.0 {
            if room < 0.0 {
                return None;
            }
        } else if direction < 0.0 {
            enter = enter.max(room / direction);
        } else {
            leave = leave.min(room / direction);
        }
    }
    let along = |t: f64| match t {
        0.0 => from,
        1.0 => to,
        _ => (from.0 + t * dx, from.1 + t * dy),
    };
    (enter < leave).then(|| (along(enter), along(leave)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plots::canvas::draw;
    use crate::plots::style::{INK, RADIUS};

    #[test]
    fn a_segment_is_cut_at_the_frame() {
        let frame = ((0.0, 0.0), (10.0, 10.0));
        let cut = |a, b| clip(a, b, frame.0, frame.1);
        assert_eq!(cut((-5.0, 5.0), (15.0, 5.0)), Some(((0.0, 5.0), (10.0, 5.0))));
        assert_eq!(cut((2.0, 2.0), (3.0, 3.0)), Some(((2.0, 2.0), (3.0, 3.0))));
        assert_eq!(cut((-5.0, 5.0), (-1.0, 9.0)), None);
    }

    fn drawn(paint: impl FnOnce(&Panel<'_>)) -> (usize, usize) {
        let axes = (Axis::between(0.0, 10.0), Axis::between(0.0, 10.0));
        let svg = draw((200.0, 200.0), "one diagram", |canvas| {
            paint(&Panel::new(canvas, (50.0, 50.0), (100.0, 100.0), axes));
        });
        (svg.matches("<circle cx").count(), svg.matches("<polygon").count())
    }

    #[test]
    fn what_lies_beyond_the_frame_becomes_an_arrow_at_its_edge() {
        let mark = Mark::disc(Pen::data(INK), RADIUS);
        assert_eq!(drawn(|panel| panel.point(5.0, 5.0, mark)), (1, 0));
        assert_eq!(drawn(|panel| panel.point(5.0, 50.0, mark)), (0, 1));
        assert_eq!(drawn(|panel| panel.mark(5.0, 5.0, (4.0, 6.0), mark)), (1, 0));
        // The figure is in, its bar leaves the frame at both ends.
        assert_eq!(drawn(|panel| panel.mark(5.0, 5.0, (-4.0, 16.0), mark)), (1, 2));
        // The figure is beyond, without and with a bar that reaches in.
        assert_eq!(drawn(|panel| panel.mark(5.0, 15.0, (15.0, 15.0), mark)), (0, 1));
        assert_eq!(drawn(|panel| panel.level_mark((8.0, 22.0), 15.0, 5.0, mark)), (0, 1));
    }

    #[test]
    fn a_script_finds_frames_series_and_marks() {
        let axes = (Axis::between(-2.0, 10.0), Axis::logarithmic([1.0, 100.0]));
        let reading = Reading { x: "time [s]", y: "a < b", zooms: true };
        let svg = draw((300.0, 300.0), "one diagram", |canvas| {
            let panel = Panel::readable(canvas, ((80.0, 50.0), (100.0, 100.0)), axes, reading);
            panel.series("a & b", || panel.line(&[(0.0, 1.0), (5.0, 10.0)], Pen::data(INK)));
            panel.series("marks", || panel.mark(5.0, 5.0, (4.0, 6.0), Mark::disc(Pen::data(INK), RADIUS)));
            panel.hint((99.0, 1.0), RADIUS, "beyond the frame");
        });
        assert!(svg.contains("<g data-series=\"a &amp; b\" data-in=\"0\">\n<polyline"), "{svg}");
        assert!(svg.contains("data-frame=\"0\" data-x=\"linear -2 10\" data-y=\"logarithmic 0."), "{svg}");
        assert!(svg.contains("data-zooms=\"\"") && svg.contains("<g data-ticks=\"0\">"), "{svg}");
        assert!(svg.contains("<circle class=\"hint\" data-of=\"marks\"") && !svg.contains("beyond"), "{svg}");
        assert_eq!(crate::plots::inspect::check(&svg), Ok(()));
    }

    #[test]
    fn a_band_is_cut_at_the_frame() {
        assert_eq!(drawn(|panel| panel.band(&[(1.0, 2.0, 30.0), (5.0, 3.0, 4.0)], FAINT)), (0, 1));
        assert_eq!(drawn(|panel| panel.band(&[], FAINT)), (0, 0));
    }
}
