//! A sheet to draw on: fractions of a pixel, lines, marks and text into an SVG string.

use super::palette::{INK, PAPER};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// The backend places everything on whole units, so the sheet is drawn this many times larger and shown smaller.
const FINE: f64 = 8.0;

/// A point on the sheet, pixels from the top left corner.
pub type Point = (f64, f64);

/// Where a text stands relative to its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// It begins at the point.
    Start,
    /// It is centred on the point.
    Middle,
    /// It ends at the point.
    End,
}

/// How a text looks.
#[derive(Debug, Clone, Copy)]
pub struct TextLook {
    /// Height of the letters' box, pixels.
    pub size: f64,
    /// Ink.
    pub colour: RGBColor,
    /// Horizontal placing; vertically a text is centred on its point.
    pub anchor: Anchor,
    /// Whether it is thicker.
    pub bold: bool,
    /// Whether it runs upwards.
    pub upwards: bool,
}

impl TextLook {
    /// Plain dark text that begins at its point.
    pub fn new(size: f64) -> Self {
        Self { size, colour: INK, anchor: Anchor::Start, bold: false, upwards: false }
    }

    /// The same, centred.
    pub fn middle(self) -> Self {
        Self { anchor: Anchor::Middle, ..self }
    }

    /// The same, ending at its point.
    pub fn end(self) -> Self {
        Self { anchor: Anchor::End, ..self }
    }

    /// The same, thicker.
    pub fn bold(self) -> Self {
        Self { bold: true, ..self }
    }

    /// The same, running upwards.
    pub fn upwards(self) -> Self {
        Self { upwards: true, ..self }
    }

    /// The same in another colour.
    pub fn colour(self, colour: RGBColor) -> Self {
        Self { colour, ..self }
    }
}

/// A line's colour and width in pixels.
#[derive(Debug, Clone, Copy)]
pub struct Pen {
    /// Ink.
    pub colour: RGBColor,
    /// Pixels.
    pub width: f64,
}

impl Pen {
    /// A pen.
    pub fn new(colour: RGBColor, width: f64) -> Self {
        Self { colour, width }
    }

    fn style(self) -> ShapeStyle {
        ShapeStyle {
            color: self.colour.to_rgba(),
            filled: false,
            stroke_width: fine(self.width).max(1) as u32,
        }
    }
}

/// How a line is broken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dash {
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

/// The sheet.
pub struct Canvas<'a> {
    area: DrawingArea<SVGBackend<'a>, Shift>,
}

/// Writing into a string cannot fail.
const IN_MEMORY: &str = "drawing into memory";

fn fine(x: f64) -> i32 {
    (x * FINE).round() as i32
}

fn at((x, y): Point) -> (i32, i32) {
    (fine(x), fine(y))
}

/// Draws a sheet of the given size in pixels and returns the SVG.
pub fn draw((width, height): (f64, f64), paint: impl FnOnce(&Canvas<'_>)) -> String {
    let mut svg = String::new();
    let (w, h) = at((width, height));
    {
        let area = SVGBackend::with_string(&mut svg, (w as u32, h as u32)).into_drawing_area();
        area.fill(&PAPER).expect(IN_MEMORY);
        paint(&Canvas { area: area.clone() });
        area.present().expect(IN_MEMORY);
    }
    let shown = format!("width=\"{width}\" height=\"{height}\"");
    let svg = svg.replacen(&format!("width=\"{w}\" height=\"{h}\""), &shown, 1);
    let svg = [Dash::Dashes, Dash::Dots].into_iter().fold(svg, |svg, dash| {
        let (drawn, left_out) = dash.pattern();
        let pattern = format!("stroke-dasharray=\"{} {}\"", fine(drawn), fine(left_out));
        svg.replace(&format!("opacity=\"{}\"", dash.opacity()), &pattern)
    });
    // Full opacity is what SVG assumes; a sixth of the file would say so.
    svg.replace(" opacity=\"1\"", "")
}

impl Canvas<'_> {
    /// A line through points.
    pub fn line(&self, points: &[Point], pen: Pen) {
        let points: Vec<(i32, i32)> = points.iter().copied().map(at).collect();
        self.area.draw(&PathElement::new(points, pen.style())).expect(IN_MEMORY);
    }

    /// A broken line through points.
    pub fn dashes(&self, points: &[Point], dash: Dash, pen: Pen) {
        let points: Vec<(i32, i32)> = points.iter().copied().map(at).collect();
        let style = ShapeStyle { color: pen.colour.mix(dash.opacity()), ..pen.style() };
        self.area.draw(&PathElement::new(points, style)).expect(IN_MEMORY);
    }

    /// A disc, filled with its colour or hollow.
    pub fn disc(&self, centre: Point, radius: f64, pen: Pen, filled: bool) {
        let fill = if filled { pen.colour } else { PAPER };
        let solid = ShapeStyle { color: fill.to_rgba(), filled: true, stroke_width: 1 };
        self.area.draw(&Circle::new(at(centre), fine(radius), solid)).expect(IN_MEMORY);
        if !filled {
            self.area.draw(&Circle::new(at(centre), fine(radius), pen.style())).expect(IN_MEMORY);
        }
    }

    /// A filled rectangle between two corners.
    pub fn fill(&self, corner: Point, opposite: Point, colour: RGBColor) {
        let solid = ShapeStyle { color: colour.to_rgba(), filled: true, stroke_width: 0 };
        self.area.draw(&Rectangle::new([at(corner), at(opposite)], solid)).expect(IN_MEMORY);
    }

    /// The outline of a rectangle between two corners.
    pub fn frame(&self, corner: Point, opposite: Point, pen: Pen) {
        self.area.draw(&Rectangle::new([at(corner), at(opposite)], pen.style())).expect(IN_MEMORY);
    }

    /// A text.
    pub fn text(&self, text: &str, point: Point, look: TextLook) {
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
        self.area.draw(&Text::new(text.to_owned(), at(point), style)).expect(IN_MEMORY);
    }
}

/// How wide running text comes out, pixels: half its size a letter, roughly.
pub fn text_width(text: &str, size: f64) -> f64 {
    0.5 * size * text.chars().count() as f64
}
