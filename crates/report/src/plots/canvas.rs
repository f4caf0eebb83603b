//! A sheet to draw on: fractions of a pixel, lines, marks and text into an SVG string.

use super::style::{Anchor, PAPER, Pen, Shape, TextLook, minus};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::cell::{Cell, RefCell};
use std::fmt::Debug;
use switchback_io::output::visible;

/// The backend places everything on whole units, so the sheet is drawn this many times larger and shown smaller.
const FINE: f64 = 8.0;

/// A point on the sheet, pixels from the top left corner.
pub(crate) type Point = (f64, f64);

/// How a line is broken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Dash {
    /// Dashes.
    Dashes,
    /// Dots.
    Dots,
}

impl Dash {
    /// Drawn and left-out lengths, pixels.
    fn pattern(self) -> (f64, f64) {
        match self {
            Self::Dashes => (6.0, 4.0),
            Self::Dots => (1.5, 3.5),
        }
    }
}

/// Where a mark for something beyond the frame points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Towards {
    /// Greater values of the vertical axis.
    Up,
    /// Smaller ones.
    Down,
    /// Smaller values of the horizontal axis.
    Left,
    /// Greater ones.
    Right,
}

/// The sheet.
pub(crate) struct Canvas {
    /// Width and height in units of the backend.
    size: (u32, u32),
    /// The elements drawn so far.
    drawn: RefCell<String>,
    /// Places that answer the pointer; they lie over all that is drawn.
    places: RefCell<String>,
    /// The series that is being drawn, by its key.
    series: RefCell<Option<String>>,
    /// Frames numbered so far.
    frames: Cell<usize>,
}

/// Attributes that a script reads.
fn attributes(data: &[(&str, &str)]) -> String {
    data.iter().map(|(name, value)| format!(" data-{name}=\"{}\"", escaped(value))).collect()
}

/// A rectangle between two corners that nothing is seen of.
fn unseen(corner: Point, opposite: Point, data: &[(&str, &str)]) -> String {
    let ((left, top), (right, bottom)) = (at(corner), at(opposite));
    let (width, height, data) = (right - left, bottom - top, attributes(data));
    format!(
        "<rect{data} x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" fill-opacity=\"0\"/>\n"
    )
}

/// Writing into a string cannot fail.
const IN_MEMORY: &str = "drawing into memory";

fn fine(x: f64) -> i32 {
    (x * FINE).round() as i32
}

fn at((x, y): Point) -> (i32, i32) {
    (fine(x), fine(y))
}

fn stroke(pen: Pen) -> ShapeStyle {
    let stroke_width = fine(pen.width()).max(1) as u32;
    ShapeStyle { color: pen.colour.to_rgba(), filled: false, stroke_width }
}

/// Draws a sheet of the given size in pixels and returns the SVG, in which control characters of labels are shown; a screen reader reads
/// `title`.
pub(crate) fn draw((width, height): (f64, f64), title: &str, paint: impl FnOnce(&Canvas)) -> String {
    let (w, h) = at((width, height));
    let canvas = Canvas {
        size: (w as u32, h as u32),
        drawn: RefCell::default(),
        places: RefCell::default(),
        series: RefCell::default(),
        frames: Cell::default(),
    };
    canvas.put(|area| area.fill(&PAPER));
    paint(&canvas);
    let (title, drawn, places) =
        (escaped(&minus(title)), canvas.drawn.into_inner(), canvas.places.into_inner());
    let svg = format!(
        "<svg width=\"{width}\" height=\"{height}\" role=\"img\" aria-label=\"{title}\" viewBox=\"0 0 {w} {h}\" \
         xmlns=\"http://www.w3.org/2000/svg\">\n{drawn}{places}</svg>\n"
    );
    visible(&svg).into_owned()
}

/// Text that is no markup.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// An area that the backend draws on.
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

impl Canvas {
    /// The elements of a drawing.
    fn elements<E: Debug>(&self, draw: impl FnOnce(&Area<'_>) -> Result<(), E>) -> String {
        let mut svg = String::new();
        {
            let area = SVGBackend::with_string(&mut svg, self.size).into_drawing_area();
            draw(&area).expect(IN_MEMORY);
            area.present().expect(IN_MEMORY);
        }
        let inside = svg.split_once(">\n").map_or("", |(_, rest)| rest);
        // Full opacity is what SVG assumes; a sixth of the file would say so.
        inside.trim_end_matches("</svg>\n").replace(" opacity=\"1\"", "")
    }

    fn put<E: Debug>(&self, draw: impl FnOnce(&Area<'_>) -> Result<(), E>) {
        let elements = self.elements(draw);
        self.drawn.borrow_mut().push_str(&elements);
    }

    /// Text that only the pointer finds, at a place.
    pub(crate) fn hint(&self, (x, y): Point, radius: f64, text: &str) {
        let [x, y, r] = [x, y, radius].map(fine);
        let text = escaped(&minus(text));
        let of = self.series.borrow().as_ref().map_or_else(String::new, |key| format!(" data-of=\"{key}\""));
        let mark = format!(
            "<circle class=\"hint\"{of} cx=\"{x}\" cy=\"{y}\" r=\"{r}\" fill-opacity=\"0\"><title>{text}</title></circle>\n"
        );
        self.places.borrow_mut().push_str(&mark);
    }

    /// A number for the next frame whose values a reader reads off.
    pub(crate) fn next_frame(&self) -> usize {
        self.frames.replace(self.frames.get() + 1)
    }

    /// An unseen rectangle between two corners with data for a script, over all that is drawn.
    pub(crate) fn frame_data(&self, corner: Point, opposite: Point, data: &[(&str, &str)]) {
        let rectangle = unseen(corner, opposite, data);
        self.places.borrow_mut().push_str(&rectangle);
    }

    /// An unseen rectangle between two corners, below all that is drawn later.
    pub(crate) fn ground(&self, corner: Point, opposite: Point) {
        self.drawn.borrow_mut().push_str(&unseen(corner, opposite, &[]));
    }

    /// Elements in a group with data for a script.
    pub(crate) fn group(&self, data: &[(&str, &str)], draw: impl FnOnce()) {
        self.drawn.borrow_mut().push_str(&format!("<g{}>\n", attributes(data)));
        draw();
        self.drawn.borrow_mut().push_str("</g>\n");
    }

    /// A series, which a reader may hide by its key, in the frame of a number.
    pub(crate) fn series(&self, key: &str, frame: usize, draw: impl FnOnce()) {
        self.series.replace(Some(escaped(key)));
        self.group(&[("series", key), ("in", &frame.to_string())], draw);
        self.series.replace(None);
    }

    /// A line through points.
    pub(crate) fn line(&self, points: &[Point], pen: Pen) {
        let points: Vec<(i32, i32)> = points.iter().copied().map(at).collect();
        self.put(|area| area.draw(&PathElement::new(points, stroke(pen))));
    }

    /// A broken line through points.
    pub(crate) fn dashes(&self, points: &[Point], dash: Dash, pen: Pen) {
        let points: Vec<(i32, i32)> = points.iter().copied().map(at).collect();
        let whole = self.elements(|area| area.draw(&PathElement::new(points, stroke(pen))));
        // The backend knows no broken lines.
        let (drawn, left_out) = dash.pattern();
        let broken =
            format!("<polyline fill=\"none\" stroke-dasharray=\"{} {}\"", fine(drawn), fine(left_out));
        self.drawn.borrow_mut().push_str(&whole.replacen("<polyline fill=\"none\"", &broken, 1));
    }

    /// A disc, filled with its colour or hollow.
    pub(crate) fn disc(&self, centre: Point, radius: f64, pen: Pen, filled: bool) {
        let fill = if filled { pen.colour } else { PAPER };
        let solid = ShapeStyle { color: fill.to_rgba(), filled: true, stroke_width: 1 };
        self.put(|area| area.draw(&Circle::new(at(centre), fine(radius), solid)));
        if !filled {
            self.put(|area| area.draw(&Circle::new(at(centre), fine(radius), stroke(pen))));
        }
    }

    /// A mark of a shape as large as a disc of that radius, filled with its colour or hollow.
    pub(crate) fn shape(&self, shape: Shape, (x, y): Point, radius: f64, (pen, filled): (Pen, bool)) {
        let corners = match shape {
            Shape::Cross => {
                let r = 1.25 * radius;
                self.line(&[(x - r, y - r), (x + r, y + r)], pen);
                return self.line(&[(x - r, y + r), (x + r, y - r)], pen);
            }
            Shape::Disc => return self.disc((x, y), radius, pen, filled),
            Shape::Square => {
                let r = 0.9 * radius;
                vec![(x - r, y - r), (x + r, y - r), (x + r, y + r), (x - r, y + r)]
            }
            Shape::Diamond => {
                let r = 1.25 * radius;
                vec![(x, y - r), (x + r, y), (x, y + r), (x - r, y)]
            }
            Shape::Triangle => {
                let r = 1.25 * radius;
                vec![(x, y - r), (x + r, y + 0.75 * r), (x - r, y + 0.75 * r)]
            }
        };
        self.polygon(&corners, if filled { pen.colour } else { PAPER });
        if !filled {
            let closed: Vec<Point> = corners.iter().chain(&corners[..2]).copied().collect();
            self.line(&closed, pen);
        }
    }

    /// A filled triangle whose tip is at a point: it stands for a value beyond, in that direction.
    pub(crate) fn arrow(&self, (x, y): Point, towards: Towards, length: f64, colour: RGBColor) {
        let half = 0.6 * length;
        let foot = match towards {
            Towards::Up => [(x - half, y + length), (x + half, y + length)],
            Towards::Down => [(x - half, y - length), (x + half, y - length)],
            Towards::Left => [(x + length, y - half), (x + length, y + half)],
            Towards::Right => [(x - length, y - half), (x - length, y + half)],
        };
        self.polygon(&[(x, y), foot[0], foot[1]], colour);
    }

    /// A filled area.
    pub(crate) fn polygon(&self, corners: &[Point], colour: RGBColor) {
        let corners: Vec<(i32, i32)> = corners.iter().copied().map(at).collect();
        let solid = ShapeStyle { color: colour.to_rgba(), filled: true, stroke_width: 0 };
        self.put(|area| area.draw(&Polygon::new(corners, solid)));
    }

    /// A filled rectangle between two corners.
    pub(crate) fn fill(&self, corner: Point, opposite: Point, colour: RGBColor) {
        let solid = ShapeStyle { color: colour.to_rgba(), filled: true, stroke_width: 0 };
        self.put(|area| area.draw(&Rectangle::new([at(corner), at(opposite)], solid)));
    }

    /// The outline of a rectangle between two corners.
    pub(crate) fn frame(&self, corner: Point, opposite: Point, pen: Pen) {
        self.put(|area| area.draw(&Rectangle::new([at(corner), at(opposite)], stroke(pen))));
    }

    /// A text; a hyphen before a number becomes a minus sign.
    pub(crate) fn text(&self, text: &str, point: Point, look: TextLook) {
        let style = if look.bold { FontStyle::Bold } else { FontStyle::Normal };
        let mut font = FontDesc::new(FontFamily::SansSerif, look.size * FINE, style);
        if look.upwards {
            font = font.transform(FontTransform::Rotate270);
        }
        let horizontal = match look.anchor {
            Anchor::Start => HPos::Left,
            Anchor::Middle => HPos::Center,
            Anchor::End => HPos::Right,
        };
        let style = TextStyle::from(font).color(&look.colour).pos(Pos::new(horizontal, VPos::Center));
        self.put(|area| area.draw(&Text::new(minus(text), at(point), style)));
    }
}
