//! A signal that many share.

use std::ops::{Deref, DerefMut};
use std::sync::Arc;

/// One value a sample. Copies share them, until one is written to.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Signal(Arc<Vec<f64>>);

impl From<Vec<f64>> for Signal {
    fn from(values: Vec<f64>) -> Self {
        Self(Arc::new(values))
    }
}

impl FromIterator<f64> for Signal {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        values.into_iter().collect::<Vec<f64>>().into()
    }
}

impl Deref for Signal {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.0
    }
}

impl DerefMut for Signal {
    fn deref_mut(&mut self) -> &mut [f64] {
        Arc::<Vec<f64>>::make_mut(&mut self.0).as_mut_slice()
    }
}

impl<'a> IntoIterator for &'a Signal {
    type Item = &'a f64;
    type IntoIter = std::slice::Iter<'a, f64>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<'a> IntoIterator for &'a mut Signal {
    type Item = &'a mut f64;
    type IntoIter = std::slice::IterMut<'a, f64>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter_mut()
    }
}
