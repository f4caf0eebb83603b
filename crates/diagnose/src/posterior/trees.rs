//! Boosted trees.

use super::bytes::{Reader, Writer};
use super::error::PosteriorError;

/// A node of a tree, in preorder: the left child of a split follows it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Node {
    /// Left where the column is at most the edge of that number.
    Split {
        /// Column.
        column: u16,
        /// Number of the edge among the column's.
        edge: u8,
        /// Position of the right child.
        right: u16,
    },
    /// What is added to the score.
    Leaf(f32),
}

/// A tree.
#[derive(Debug, Clone, PartialEq)]
pub struct Tree(pub Vec<Node>);

/// Sums of trees, one sum a class: `score_k = start_k + Σ_t tree_tk`.
#[derive(Debug, Clone, PartialEq)]
pub struct Trees {
    /// Increasing edges of every column's bins.
    pub edges: Vec<Vec<f32>>,
    /// Scores before any tree.
    pub start: Vec<f32>,
    /// Rounds of one tree a class.
    pub rounds: Vec<Vec<Tree>>,
}

/// Marks a leaf in the file.
const LEAF: usize = 0xFFFF;
/// Bytes of the smallest tree: its number of nodes, and one leaf.
const SMALLEST: usize = 8;

impl Tree {
    /// Its value, where `goes_left` decides at a column and an edge.
    pub fn value(&self, goes_left: impl Fn(u16, u8) -> bool) -> f32 {
        let mut at = 0;
        loop {
            match self.0[at] {
                Node::Leaf(value) => return value,
                Node::Split { column, edge, right } => {
                    at = if goes_left(column, edge) { at + 1 } else { usize::from(right) };
                }
            }
        }
    }

    fn write(&self, out: &mut Writer) {
        out.small(self.0.len());
        for node in &self.0 {
            match node {
                Node::Split { column, edge, .. } => {
                    out.small(usize::from(*column));
                    out.byte(*edge);
                }
                Node::Leaf(value) => {
                    out.small(LEAF);
                    out.number(*value);
                }
            }
        }
    }

    /// Right children follow from the preorder.
    fn read(from: &mut Reader<'_>, edges: &[Vec<f32>]) -> Result<Self, PosteriorError> {
        let count = from.small()?;
        let mut nodes = Vec::new();
        // Splits whose left subtree is still being read, and those whose right one is.
        let mut open: Vec<usize> = Vec::new();
        for number in 0..count {
            if number > 0 && open.is_empty() {
                return Err(from.damaged("a tree goes on behind its end"));
            }
            let column = from.small()?;
            if column != LEAF {
                let edge = from.byte()?;
                if edges.get(column).is_none_or(|edges| usize::from(edge) >= edges.len()) {
                    return Err(from.damaged("a split at an edge that is not there"));
                }
                open.push(number);
                nodes.push(Node::Split { column: column as u16, edge, right: 0 });
                continue;
            }
            nodes.push(Node::Leaf(from.number()?));
            // The innermost split without a right child gets the next node; those that have both are done.
            while let Some(split) = open.pop() {
                if let Node::Split { right, .. } = &mut nodes[split]
                    && *right == 0
                {
                    *right = (number + 1) as u16;
                    open.push(split);
                    break;
                }
            }
        }
        if count == 0 || !open.is_empty() {
            return Err(from.damaged("a tree ends too early"));
        }
        Ok(Self(nodes))
    }
}

impl Trees {
    /// Scores of a row.
    pub fn scores(&self, row: &[f64]) -> Vec<f64> {
        let mut scores: Vec<f64> = self.start.iter().map(|s| f64::from(*s)).collect();
        let left = |column: u16, edge: u8| {
            let column = usize::from(column);
            row[column] <= f64::from(self.edges[column][usize::from(edge)])
        };
        for round in &self.rounds {
            for (score, tree) in scores.iter_mut().zip(round) {
                *score += f64::from(tree.value(left));
            }
        }
        scores
    }

    pub(super) fn write(&self, out: &mut Writer) {
        out.count(self.edges.len());
        self.edges.iter().for_each(|edges| out.numbers(edges));
        out.numbers(&self.start);
        out.count(self.rounds.len());
        for tree in self.rounds.iter().flatten() {
            tree.write(out);
        }
    }

    pub(super) fn read(from: &mut Reader<'_>, columns: usize) -> Result<Self, PosteriorError> {
        let count = from.count_of(4)?;
        if count != columns || count >= LEAF {
            return Err(from.damaged("trees of another number of columns"));
        }
        let edges = (0..count).map(|_| from.numbers()).collect::<Result<Vec<_>, _>>()?;
        let start = from.numbers()?;
        if start.is_empty() {
            return Err(from.damaged("trees of no score"));
        }
        let rounds = from.count_of(SMALLEST * start.len())?;
        let round = |from: &mut Reader<'_>| (0..start.len()).map(|_| Tree::read(from, &edges)).collect();
        let rounds = (0..rounds).map(|_| round(from)).collect::<Result<Vec<_>, _>>()?;
        Ok(Self { edges, start, rounds })
    }
}
