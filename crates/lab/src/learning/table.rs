//! A table to learn from.

use thiserror::Error;

/// What the rows of a fold must not share.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Group {
    /// Where the rig comes from.
    pub family: String,
    /// Effect and law of its cause; empty where there is none.
    pub law: String,
    /// Its base.
    pub base: String,
}

/// What is true of a row beside its class.
#[derive(Debug, Clone, PartialEq)]
pub struct Truth {
    /// Size of the cause: what survives identification anew, over what the records without it leave.
    pub size: f64,
    /// What the rig was made to show.
    pub kind: String,
    /// Whether a model is given.
    pub is_given: bool,
    /// Names that are not wrong.
    pub also: Vec<String>,
}

/// Rows of finite numbers in named columns, each with a class, a positive weight and a group.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Values, a vector a column.
    pub values: Vec<Vec<f64>>,
    /// Names of the classes.
    pub classes: Vec<String>,
    /// Class of every row.
    pub labels: Vec<usize>,
    /// Weight of every row.
    pub weights: Vec<f64>,
    /// Group of every row.
    pub groups: Vec<Group>,
    /// What else is true of every row.
    pub truths: Vec<Truth>,
}

/// Why there is no table.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum TableError {
    /// The header lacks a column.
    #[error(
        "the table lacks the column `{0}`; it needs label, weight, family, law, base, size, kind, given, also, and numbers behind them"
    )]
    Header(&'static str),
    /// A cell is no finite number, or a weight not positive.
    #[error("line {line}, column `{column}`: `{cell}` is no {what}; correct it")]
    Cell {
        /// Line of the file.
        line: usize,
        /// Column.
        column: String,
        /// What stands there.
        cell: String,
        /// What should.
        what: &'static str,
    },
    /// A line is no line of the table.
    #[error("line {line}: {what}")]
    Line {
        /// Line of the file.
        line: usize,
        /// What is wrong.
        what: String,
    },
    /// No row can be judged by models that have learnt neither its base nor its law.
    #[error(
        "of {rows} rows none can be held out by its base and its law; some hundred rows are the least, ten thousand are better"
    )]
    NotHeldOut {
        /// Rows.
        rows: usize,
    },
    /// Fewer than two classes, or no row at all.
    #[error(
        "a table of {rows} rows in {classes} classes teaches nothing; it needs rows of two classes at least"
    )]
    Few {
        /// Rows.
        rows: usize,
        /// Classes.
        classes: usize,
    },
}

/// Columns before those of numbers.
const LEADING: [&str; 9] = ["label", "weight", "family", "law", "base", "size", "kind", "given", "also"];

impl Table {
    /// Reads CSV with the columns `label,weight,family,law,base,size,kind,given,also` and then named numbers. Classes stand in the order of the alphabet.
    ///
    /// # Errors
    /// [`TableError`].
    pub fn from_csv(text: &str) -> Result<Self, TableError> {
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let bad = |error: csv::Error| {
            let line = error.position().map_or(1, |place| place.line() as usize);
            TableError::Line { line, what: error.to_string() }
        };
        let header = reader.headers().map_err(bad)?.clone();
        for (at, name) in LEADING.iter().enumerate() {
            if header.get(at) != Some(name) {
                return Err(TableError::Header(name));
            }
        }
        let columns: Vec<String> = header.iter().skip(LEADING.len()).map(str::to_owned).collect();
        let (mut values, mut names) = (vec![Vec::new(); columns.len()], Vec::new());
        let (mut weights, mut groups, mut truths) = (Vec::new(), Vec::new(), Vec::new());
        for record in reader.records() {
            let record = record.map_err(bad)?;
            let line = record.position().map_or(0, |place| place.line() as usize);
            let cell = |at: usize| record.get(at).unwrap_or_default();
            let number = |at: usize, column: &str| {
                let parsed = cell(at).parse::<f64>().ok().filter(|x| x.is_finite());
                parsed.ok_or_else(|| TableError::Cell {
                    line,
                    column: column.to_owned(),
                    cell: cell(at).to_owned(),
                    what: "finite number",
                })
            };
            let weight = number(1, "weight")?;
            if weight <= 0.0 {
                let (column, cell) = ("weight".to_owned(), cell(1).to_owned());
                return Err(TableError::Cell { line, column, cell, what: "positive number" });
            }
            names.push(cell(0).to_owned());
            weights.push(weight);
            let [family, law, base] = [2, 3, 4].map(|at| cell(at).to_owned());
            groups.push(Group { family, law, base });
            truths.push(Truth {
                size: number(5, "size")?,
                kind: cell(6).to_owned(),
                is_given: cell(7) == "yes",
                also: cell(8).split(';').map(str::to_owned).collect(),
            });
            for (at, (column, values)) in columns.iter().zip(&mut values).enumerate() {
                values.push(number(LEADING.len() + at, column)?);
            }
        }
        let mut classes = names.clone();
        classes.sort();
        classes.dedup();
        if classes.len() < 2 {
            return Err(TableError::Few { rows: names.len(), classes: classes.len() });
        }
        let labels = names.iter().map(|name| classes.binary_search(name).expect("one of them")).collect();
        Ok(Self { columns, values, classes, labels, weights, groups, truths })
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.labels.len()
    }

    /// Values of a row.
    pub fn row(&self, row: usize) -> Vec<f64> {
        self.values.iter().map(|column| column[row]).collect()
    }

    /// Whether anybody knows that the class of a row is right: a machine that was measured has effects by itself, so that nobody knows whether
    /// nothing is wrong where nothing was put in.
    pub fn is_known(&self, row: usize) -> bool {
        self.classes[self.labels[row]] != "none" || self.groups[row].family != "measured"
    }

    /// The rows whose class is known.
    #[must_use]
    pub fn known(&self) -> Self {
        self.of_rows(&(0..self.rows()).filter(|row| self.is_known(*row)).collect::<Vec<usize>>())
    }

    /// The table of some rows, with all classes.
    #[must_use]
    pub fn of_rows(&self, rows: &[usize]) -> Self {
        Self {
            columns: self.columns.clone(),
            values: self.values.iter().map(|column| rows.iter().map(|r| column[*r]).collect()).collect(),
            classes: self.classes.clone(),
            labels: rows.iter().map(|r| self.labels[*r]).collect(),
            weights: rows.iter().map(|r| self.weights[*r]).collect(),
            groups: rows.iter().map(|r| self.groups[*r].clone()).collect(),
            truths: rows.iter().map(|r| self.truths[*r].clone()).collect(),
        }
    }
}
