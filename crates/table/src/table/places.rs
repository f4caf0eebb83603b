//! Where the rows of a table stand.

use super::error::Place;

/// The place of every row, kept as runs of rows that follow each other: few numbers, however many rows there are.
#[derive(Debug, Clone, Default)]
pub struct Places {
    /// Each run by the number of its first row and where that stands.
    runs: Vec<(usize, Place)>,
    rows: usize,
}

impl Places {
    /// Adds the place of the next row.
    pub fn push(&mut self, place: Place) {
        if self.runs.last().is_none_or(|run| place != after(*run, self.rows)) {
            self.runs.push((self.rows, place));
        }
        self.rows += 1;
    }

    /// Where a row stands, counted from 0.
    ///
    /// # Panics
    /// If there is no such row.
    pub fn get(&self, row: usize) -> Place {
        assert!(row < self.rows, "row {row} of {}", self.rows);
        after(self.runs[self.runs.partition_point(|(first, _)| *first <= row) - 1], row)
    }

    /// Leaves the first `rows` only.
    pub(crate) fn truncate(&mut self, rows: usize) {
        self.runs.retain(|(first, _)| *first < rows);
        self.rows = self.rows.min(rows);
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.rows == 0
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows
    }
}

/// Where a row stands that belongs to a run.
fn after((first, place): (usize, Place), row: usize) -> Place {
    let further = (row - first) as u64;
    match place {
        Place::Line(line) => Place::Line(line + further),
        Place::Row(number) => Place::Row(number + further),
    }
}

impl FromIterator<Place> for Places {
    fn from_iter<I: IntoIterator<Item = Place>>(places: I) -> Self {
        let mut all = Self::default();
        places.into_iter().for_each(|place| all.push(place));
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_found_whatever_stands_between_them() {
        let lines = [3, 4, 5, 9, 10, 20];
        let places: Places = lines.into_iter().map(Place::Line).collect();
        assert_eq!((places.len(), places.runs.len()), (6, 3));
        assert!(lines.iter().enumerate().all(|(row, line)| places.get(row) == Place::Line(*line)));
    }
}
