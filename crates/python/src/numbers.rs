//! Arrays between the languages: the bytes of float64 numbers in the order of the machine.
//!
//! The buffers of NumPy are no part of the stable interface of CPython 3.9; bytes are, and copying them takes no time beside what is computed.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

const WIDTH: usize = size_of::<f64>();

/// The numbers in some bytes.
pub(crate) fn numbers(bytes: &[u8]) -> PyResult<Vec<f64>> {
    let (numbers, []) = bytes.as_chunks::<WIDTH>() else {
        return Err(PyValueError::new_err("an array of float64 numbers has eight bytes a number"));
    };
    Ok(numbers.iter().map(|number| f64::from_ne_bytes(*number)).collect())
}

/// The bytes of numbers.
pub(crate) fn bytes<'py>(py: Python<'py>, numbers: &[f64]) -> Bound<'py, PyBytes> {
    let write = |bytes: &mut [u8]| {
        let places = bytes.chunks_exact_mut(WIDTH);
        places.zip(numbers).for_each(|(place, number)| place.copy_from_slice(&number.to_ne_bytes()));
        Ok(())
    };
    PyBytes::new_with(py, size_of_val(numbers), write).expect("there is memory for it")
}
