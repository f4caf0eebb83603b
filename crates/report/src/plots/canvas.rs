//! A sheet to draw on: fractions of a pixel, lines, marks and text into an SVG string.

use super::style::{Anchor, PAPER, Pen, Shape, TextLook, minus};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::cell::RefCell;

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
    /// The backend knows no broken lines: they are drawn whole with an opacity that nothing else has, and
    /// [`draw`] puts the pattern in its place.
    fn opacity(self) -> f64 {
        match self {
            Self::Dashes => 0.875,
            Self::Dots => 0.75,
        }
    }

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
pub(crate) struct Canvas<'a> {
    area: DrawingArea<SVGBackend<'a>, Shift>,
    hints: RefCell<String>,
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

/// Draws a sheet of the given size in pixels and returns the SVG; a screen reader reads `title`.
pub(crate) fn draw((width, height): (f64, f64), title: &str, paint: impl FnOnce(&Canvas<'_>)) -> String {
    let mut svg = String::new();
    let (w, h) = at((width, height));
    let hints = {
        let area = SVGBackend::with_string(&mut svg, (w as u32, h as u32)).into_drawing_area();
        area.fill(&PAPER).expect(IN_MEMORY);
        let canvas = Canvas { area: area.clone(), hints: RefCell::default() };
        paint(&canvas);
        area.present().expect(IN_MEMORY);
        canvas.hints.into_inner()
    };
    let svg = svg.replace("</svg>", &(hints + "</svg>"));
    let title = escaped(title);
    let shown = format!("width=\"{width}\" height=\"{height}\" role=\"img\" aria-label=\"{title}\"");
    let svg = svg.replacen(&format!("width=\"{w}\" height=\"{h}\""), &shown, 1);
    let svg = [Dash::Dashes, Dash::Dots].into_iter().fold(svg, |svg, dash| {
        let (drawn, left_out) = dash.pattern();
        let pattern = format!("stroke-dasharray=\"{} {}\"", fine(drawn), fine(left_out));
        svg.replace(&format!("opacity=\"{}\"", dash.opacity()), &pattern)
    });
    // Full opacity is what SVG assumes; a sixth of the file would say so.
    svg.replace(" opacity=\"1\"", "")
}

/// Text that is no markup.
fn escaped(text: &str) -> String {
    minus(text).replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

impl Canvas<'_> {
    /// What is told of a place under the pointer: nothing is seen of it.
    pub(crate) fn hint(&self, (x, y): Point, radius: f64, told: &str) {
        let [x, y, r] = [x, y, radius].map(fine);
        let told = escaped(told);
        let mark = format!(
            "<circle class=\"hint\" cx=\"{x}\" cy=\"{y}\" r=\"{r}\" fill-opacity=\"0\"><title>{told}</title></circle>\n"
        );
        self.hints.borrow_mut().push_str(&mark);
    }

    /// A line through points.
    pub(crate) fn line(&self, points: &[Point], pen: Pen) {
        let points: Vec<(i32, i32)> = points.iter().copied().map(at).collect();
        self.area.draw(&PathElement::new(points, stroke(pen))).expect(IN_MEMORY);
    }

    /// A broken line through points.
    pub(crate) fn dashes(&self, points: &[Point], dash: Dash, pen: Pen) {
        let points: Vec<(i32, i32)> = points.iter().copied().map(at).collect();
        let style = ShapeStyle { color: pen.colour.mix(dash.opacity()), ..stroke(pen) };
        self.area.draw(&PathElement::new(points, style)).expect(IN_MEMORY);
    }

    /// A disc, filled with its colour or hollow.
    pub(crate) fn disc(&self, centre: Point, radius: f64, pen: Pen, filled: bool) {
        let fill = if filled { pen.colour } else { PAPER };
        let solid = ShapeStyle { color: fill.to_rgba(), filled: true, stroke_width: 1 };
        self.area.draw(&Circle::new(at(centre), fine(radius), solid)).expect(IN_MEMORY);
        if !filled {
            self.area.draw(&Circle::new(at(centre), fine(radius), stroke(pen))).expect(IN_MEMORY);
        }
    }

    /// A mark of a shape as large as a disc of that radius, filled with its colour or hollow.
    pub(crate) fn shape(&self, shape: Shape, (x, y): Point, radius: f64, (pen, filled): (Pen, bool)) {
        let corners = match shape {
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

    /// A filled triangle whose tip is at a point: what it stands for lies beyond, in that direction.
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
        self.area.draw(&Polygon::new(corners, solid)).expect(IN_MEMORY);
    }

    /// A filled rectangle between two corners.
    pub(crate) fn fill(&self, corner: Point, opposite: Point, colour: RGBColor) {
        let solid = ShapeStyle { color: colour.to_rgba(), filled: true, stroke_width: 0 };
        self.area.draw(&Rectangle::new([at(corner), at(opposite)], solid)).expect(IN_MEMORY);
    }

    /// The outline of a rectangle between two corners.
    pub(crate) fn frame(&self, corner: Point, opposite: Point, pen: Pen) {
        self.area.draw(&Rectangle::new([at(corner), at(opposite)], stroke(pen))).expect(IN_MEMORY);
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
        self.area.draw(&Text::new(minus(text), at(point), style)).expect(IN_MEMORY);
    }
}
