//! A page: title, candidate, legend, and a grid of diagrams below.

use super::axis::Axis;
use super::canvas::{Canvas, Point, draw};
use super::legend::{self, Entry};
use super::panel::{Numbers, Panel, Reading};
use super::style::{GREY, MARGIN, TextLook, WIDTH};

/// Texts of a page and arrangement of its diagrams.
pub(crate) struct Sheet {
    /// Width, pixels.
    pub width: f64,
    /// The subject of the figure.
    pub title: String,
    /// How it is to be read; an entry begins a line, and goes on on the next where it is long.
    pub notes: Vec<String>,
    /// The meaning of its marks.
    pub legend: Vec<Entry>,
    /// The arrangement.
    pub grid: Grid,
}

/// Rows and columns of diagrams of one size.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Grid {
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
    /// Room above the first row, for titles, pixels.
    pub above: f64,
    /// Room between two rows, pixels.
    pub apart: f64,
    /// Room below the last row, for numbers and the axis' name, pixels.
    pub below: f64,
}

impl Grid {
    /// Diagrams of a height with titles above, numbers left of and below each, and room for the axes' names at the first column
    /// and the last row.
    pub(crate) fn new(rows: usize, columns: usize, height: f64) -> Self {
        let (rows, columns) = (rows.max(1), columns.max(1));
        Self { columns, rows, height, left: 84.0, between: 66.0, above: 34.0, apart: 84.0, below: 52.0 }
    }

    /// The same for diagrams that share their axes: numbers stand at the first column and the last row only, names of rows left of all.
    pub(crate) fn shared(rows: usize, columns: usize, height: f64) -> Self {
        Self { left: 92.0, between: 14.0, apart: 14.0, ..Self::new(rows, columns, height) }
    }
}

impl Sheet {
    /// A page of full width without a legend.
    pub(crate) fn new(title: impl Into<String>, notes: Vec<String>, grid: Grid) -> Self {
        Self { width: WIDTH, title: title.into(), notes, legend: Vec::new(), grid }
    }

    /// Draws the page; `paint` gets the canvas and the frames' places, and fills them.
    pub(crate) fn render(&self, paint: impl FnOnce(&Canvas, &Frames)) -> String {
        let room = self.width - 2.0 * MARGIN;
        let wrapped = |look: TextLook, text: &str| -> Vec<(String, TextLook)> {
            look.wrapped(text, room).into_iter().map(|line| (line, look)).collect()
        };
        let mut head = wrapped(TextLook::title(), &self.title);
        head.extend(self.notes.iter().flat_map(|note| wrapped(TextLook::note(), note)));
        let mut lines = Vec::new();
        let mut bottom = MARGIN - 4.0;
        for (text, look) in head {
            lines.push((text, bottom + look.line() / 2.0, look));
            bottom += look.line();
        }
        let entries = legend::lines(&self.legend, room);
        let legend_top = bottom + 6.0 + legend::LINE / 2.0;
        let top = bottom + 6.0 + legend::LINE * entries.len() as f64;
        let frames = Frames { grid: self.grid, width: self.width, top };
        let height = frames.corner(self.grid.rows - 1, 0).1 + self.grid.height + self.grid.below;
        draw((self.width, height.round()), &self.title, |canvas| {
            for (text, y, look) in &lines {
                canvas.text(text, (MARGIN, *y), *look);
            }
            legend::draw(canvas, (MARGIN, legend_top), &entries);
            paint(canvas, &frames);
        })
    }

    /// The page with a remark in place of its diagrams: why there is nothing to draw.
    pub(crate) fn empty(mut self, why: &str) -> String {
        self.legend.clear();
        self.grid = Grid { height: 3.0 * TextLook::label().line(), below: MARGIN, ..Grid::new(1, 1, 0.0) };
        self.render(|canvas, frames| {
            let (_, top) = frames.corner(0, 0);
            let look = TextLook::label().middle().colour(GREY);
            for (i, line) in look.wrapped(why, frames.width - 2.0 * MARGIN).iter().enumerate() {
                canvas.text(line, (frames.width / 2.0, top + i as f64 * look.line()), look);
            }
        })
    }
}

/// Where the diagrams stand.
pub(crate) struct Frames {
    grid: Grid,
    width: f64,
    top: f64,
}

impl Frames {
    /// Width and height of every frame.
    pub(crate) fn size(&self) -> (f64, f64) {
        let gaps = self.grid.between * (self.grid.columns - 1) as f64;
        ((self.width - self.grid.left - MARGIN - gaps) / self.grid.columns as f64, self.grid.height)
    }

    /// Top left corner of a frame.
    pub(crate) fn corner(&self, row: usize, column: usize) -> Point {
        let (width, height) = self.size();
        let x = self.grid.left + (width + self.grid.between) * column as f64;
        (x, self.top + self.grid.above + (height + self.grid.apart) * row as f64)
    }

    /// The empty diagram at a row and column, with numbers at both axes.
    pub(crate) fn panel<'c>(
        &self,
        canvas: &'c Canvas,
        (row, column): (usize, usize),
        axes: (Axis, Axis),
    ) -> Panel<'c> {
        Panel::new(canvas, self.corner(row, column), self.size(), axes)
    }

    /// The empty diagram at a row and column of a grid whose rows and columns share their axes: numbers at the outer ones only.
    pub(crate) fn inner_panel<'c>(
        &self,
        canvas: &'c Canvas,
        (row, column): (usize, usize),
        axes: (Axis, Axis),
    ) -> Panel<'c> {
        let numbers = Numbers { x: row + 1 == self.grid.rows, y: column == 0 };
        Panel::with_numbers(canvas, (self.corner(row, column), self.size()), axes, numbers)
    }

    /// The empty diagram at a row and column whose values a reader reads off.
    pub(crate) fn readable<'c>(
        &self,
        canvas: &'c Canvas,
        (row, column): (usize, usize),
        axes: (Axis, Axis),
        reading: Reading<'_>,
    ) -> Panel<'c> {
        Panel::readable(canvas, (self.corner(row, column), self.size()), axes, reading)
    }
}
