"""Least squares by SysIdentPy, on the columns of `regression.py`. Needs sysidentpy 0.9.0."""

from __future__ import annotations

import numpy as np
from regression import columns, of_coefficients
from switchback_method import serve
from sysidentpy import __version__
from sysidentpy.parameter_estimation import LeastSquares


def estimate(request) -> np.ndarray:
    phi, y = columns(request)
    return of_coefficients(request, LeastSquares().optimize(phi, y[:, None])[:, 0])


if __name__ == "__main__":
    serve(estimate, version=f"sysidentpy {__version__}")
