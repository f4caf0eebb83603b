//! One diagram: a frame, two axes, and data drawn inside.

use super::axis::{Axis, Tick};
use super::canvas::{Canvas, Dash, Pen, Point, TextLook};
use super::palette::{FAINT, GREY, INK};

/// A diagram's place on the sheet and its axes.
pub struct Panel<'c, 's> {
    canvas: &'c Canvas<'s>,
    /// Top left corner of the frame.
    corner: Point,
    /// Width and height of the frame.
    size: (f64, f64),
    x: Axis,
    y: Axis,
}

/// Size of the numbers at the ticks, pixels.
const TICK_TEXT: f64 = 15.0;

/// How a figure and its error are marked.
#[derive(Debug, Clone, Copy)]
pub struct Mark {
    /// Colour and thickness of the bar.
    pub pen: Pen,
    /// Radius of the disc; zero for a bar alone.
    pub radius: f64,
    /// Whether the disc is filled.
    pub filled: bool,
    /// Pixels to the right of its true place, so that marks at one `x` do not cover each other.
    pub aside: f64,
}

impl<'c, 's> Panel<'c, 's> {
    /// Draws the empty diagram: grid, ticks, numbers and frame.
    pub fn new(canvas: &'c Canvas<'s>, corner: Point, size: (f64, f64), axes: (Axis, Axis)) -> Self {
        let panel = Self { canvas, corner, size, x: axes.0, y: axes.1 };
        panel.grid();
        let opposite = (corner.0 + size.0, corner.1 + size.1);
        canvas.frame(corner, opposite, Pen::new(GREY, 1.0));
        panel
    }

    fn grid(&self) {
        let ((left, top), (width, height)) = (self.corner, self.size);
        let (right, bottom) = (left + width, top + height);
        let look = TextLook::new(TICK_TEXT);
        let mut comb = vec![(left, bottom)];
        for tick in self.x.ticks() {
            let Some(x) = self.x.place(tick.at).map(|p| left + p * width) else { continue };
            comb.extend([(x, bottom), (x, bottom - length(&tick)), (x, bottom)]);
            if let Some(label) = tick.label {
                self.canvas.line(&[(x, top), (x, bottom)], Pen::new(FAINT, 1.0));
                self.canvas.text(&label, (x, bottom + 14.0), look.middle());
            }
        }
        self.canvas.line(&comb, Pen::new(GREY, 1.0));
        let mut comb = vec![(left, bottom)];
        for tick in self.y.ticks() {
            let Some(y) = self.y.place(tick.at).map(|p| bottom - p * height) else { continue };
            comb.extend([(left, y), (left + length(&tick), y), (left, y)]);
            if let Some(label) = tick.label {
                self.canvas.line(&[(left, y), (right, y)], Pen::new(FAINT, 1.0));
                self.canvas.text(&label, (left - 5.0, y), look.end());
            }
        }
        self.canvas.line(&comb, Pen::new(GREY, 1.0));
    }

    /// Place on the sheet, inside the frame or not; `None` for what a logarithmic axis cannot hold.
    fn place(&self, x: f64, y: f64) -> Option<Point> {
        let (px, py) = (self.x.place(x)?, self.y.place(y)?);
        Some((self.corner.0 + px * self.size.0, self.corner.1 + (1.0 - py) * self.size.1))
    }

    /// A line through values, cut at the frame.
    pub fn line(&self, values: &[(f64, f64)], pen: Pen) {
        for part in self.visible(values) {
            self.canvas.line(&part, pen);
        }
    }

    /// A broken line through values, cut at the frame.
    pub fn dashes(&self, values: &[(f64, f64)], dash: Dash, pen: Pen) {
        for part in self.visible(values) {
            self.canvas.dashes(&part, dash, pen);
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

    /// A figure with its bar from `low` to `high`, both cut at the frame; the figure itself is left out beyond it.
    pub fn mark(&self, x: f64, y: f64, (low, high): (f64, f64), mark: Mark) {
        let inside = |v: f64| v.clamp(self.y.low(), self.y.high());
        let beside = |y: f64| self.place(x, y).map(|(px, py)| (px + mark.aside, py));
        let (Some(foot), Some(head)) = (beside(inside(low)), beside(inside(high))) else { return };
        if head.1 < foot.1 {
            let cap = |end: Point, cut: bool| {
                let reach = if cut { 0.0 } else { 3.0 };
                [end, (end.0 - reach, end.1), (end.0 + reach, end.1), end]
            };
            let bar = [cap(foot, low < self.y.low()), cap(head, high > self.y.high())].concat();
            self.canvas.line(&bar, mark.pen);
        }
        let shown = (self.y.low()..=self.y.high()).contains(&y);
        if let Some(centre) = beside(y).filter(|_| shown && mark.radius > 0.0) {
            self.canvas.disc(centre, mark.radius, mark.pen, mark.filled);
        }
    }

    /// A title above the frame.
    pub fn title(&self, text: &str) {
        let point = (self.corner.0 + self.size.0 / 2.0, self.corner.1 - 13.0);
        self.canvas.text(text, point, TextLook::new(16.0).bold().middle());
    }

    /// The name of the horizontal axis, below its numbers.
    pub fn x_name(&self, text: &str) {
        let point = (self.corner.0 + self.size.0 / 2.0, self.corner.1 + self.size.1 + 35.0);
        self.canvas.text(text, point, TextLook::new(15.0).middle());
    }

    /// The name of the vertical axis, `distance` pixels left of the frame.
    pub fn y_name(&self, text: &str, distance: f64) {
        let point = (self.corner.0 - distance, self.corner.1 + self.size.1 / 2.0);
        self.canvas.text(text, point, TextLook::new(15.0).middle().upwards().colour(INK));
    }

    /// A remark in the middle of an otherwise empty diagram.
    pub fn remark(&self, text: &str) {
        let centre = (self.corner.0 + self.size.0 / 2.0, self.corner.1 + self.size.1 / 2.0);
        self.canvas.text(text, centre, TextLook::new(15.0).middle().colour(GREY));
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

    #[test]
    fn a_segment_is_cut_at_the_frame() {
        let frame = ((0.0, 0.0), (10.0, 10.0));
        let cut = |a, b| clip(a, b, frame.0, frame.1);
        assert_eq!(cut((-5.0, 5.0), (15.0, 5.0)), Some(((0.0, 5.0), (10.0, 5.0))));
        assert_eq!(cut((2.0, 2.0), (3.0, 3.0)), Some(((2.0, 2.0), (3.0, 3.0))));
        assert_eq!(cut((-5.0, 5.0), (-1.0, 9.0)), None);
    }
}
