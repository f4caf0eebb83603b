//! A page: title, explanation, legend, and a grid of diagrams below.

use super::canvas::{Canvas, Point, TextLook, draw};
use super::legend::{self, Entry};
use super::palette::GREY;

/// Width of every page, pixels.
pub const WIDTH: f64 = 1200.0;

/// What a page says and how its diagrams are arranged.
pub struct Sheet {
    /// What the figure shows.
    pub title: String,
    /// How it is to be read; one entry a line.
    pub notes: Vec<String>,
    /// What its marks mean.
    pub legend: Vec<Entry>,
    /// The arrangement.
    pub grid: Grid,
}

/// Rows and columns of diagrams of one size.
#[derive(Debug, Clone, Copy)]
pub struct Grid {
    /// Number of columns.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// Height of each diagram's frame, pixels.
    pub height: f64,
    /// Room left of the first column, pixels.
    pub left: f64,
    /// Room between two columns, pixels.
    pub between: f64,
    /// Room above the first row for column titles, and between two rows, pixels.
    pub above: f64,
}

const MARGIN: f64 = 20.0;
const BOTTOM: f64 = 56.0;

impl Sheet {
    /// Draws the page; `paint` gets the canvas and the frames' places, and fills them.
    pub fn render(&self, paint: impl FnOnce(&Canvas<'_>, &Frames)) -> String {
        let entries = legend::lines(&self.legend, WIDTH - 2.0 * MARGIN);
        let notes_top = 62.0;
        let legend_top = notes_top + 22.0 * self.notes.len() as f64 + 8.0;
        let top = legend_top + legend::LINE * entries.len() as f64;
        let frames = Frames { grid: self.grid, top };
        let height = top + (self.grid.above + self.grid.height) * self.grid.rows as f64 + BOTTOM;
        draw((WIDTH, height.round()), |canvas| {
            canvas.text(&self.title, (MARGIN, 30.0), TextLook::new(25.0).bold());
            for (i, note) in self.notes.iter().enumerate() {
                canvas.text(note, (MARGIN, notes_top + 22.0 * i as f64), TextLook::new(16.0).colour(GREY));
            }
            legend::draw(canvas, (MARGIN, legend_top), &entries);
            paint(canvas, &frames);
        })
    }
}

/// Where the diagrams stand.
pub struct Frames {
    grid: Grid,
    top: f64,
}

impl Frames {
    /// Width and height of every frame.
    pub fn size(&self) -> (f64, f64) {
        let gaps = self.grid.between * (self.grid.columns - 1) as f64;
        ((WIDTH - self.grid.left - MARGIN - gaps) / self.grid.columns as f64, self.grid.height)
    }

    /// Top left corner of a frame.
    pub fn corner(&self, row: usize, column: usize) -> Point {
        let (width, height) = self.size();
        let x = self.grid.left + (width + self.grid.between) * column as f64;
        (x, self.top + self.grid.above + (height + self.grid.above) * row as f64)
    }

    /// Writes what a row shows, and its number of points `m`, upwards at its left.
    pub fn name_row(&self, canvas: &Canvas<'_>, row: usize, (name, points): (&str, usize)) {
        let middle = self.corner(row, 0).1 + self.size().1 / 2.0;
        canvas.text(name, (20.0, middle), TextLook::new(17.0).bold().middle().upwards());
        let points = format!("m = {points}");
        canvas.text(&points, (42.0, middle), TextLook::new(15.0).middle().upwards().colour(GREY));
    }
}
