"""ARX with several inputs by SIPPY, each experiment by itself. Needs sippy-unipi 1.0.1.

An input a level, 1 where v is there: together they are the constant, which SIPPY does not take as an input. What differs between levels is determined all the
same, and so is the sum over lags.
"""

from __future__ import annotations

from importlib.metadata import version

import numpy as np
from regression import parameters
from switchback_method import serve
from sippy_unipi import system_identification


def coefficients(e, order: int) -> tuple[np.ndarray, np.ndarray]:
    """a, and the coefficients of each level at each lag: where v rests, then V₁ … V_m; shape (levels, n)."""
    u = np.array([e.v == level for level in (e.satellite, *e.levels)], dtype=float)
    orders = [[order], [[order] * len(u)], [[0] * len(u)]]
    model = system_identification(e.y[None, :].copy(), u, "ARX", ARX_orders=orders)
    return np.array(model.DENOMINATOR[0][0])[1 : order + 1], np.array(model.NUMERATOR[0])[:, :order]


def estimate(request) -> np.ndarray:
    (a, down), (a_up, up) = (coefficients(e, request.order) for e in (request.descendant, request.ascendant))
    # In a descendant experiment w is 1 where v rests and 0 at V₁, in an ascendant one the other way round.
    b = ((down[0] - down[1]) + (up[1] - up[0])) / 2
    kappa = (down[1].sum() + up[0].sum()) / 2
    mu = np.vstack([b, down[2:] - down[1], up[2:] - up[0]]).T
    return parameters(request, (a + a_up) / 2, mu, kappa)


if __name__ == "__main__":
    serve(estimate, version=f"sippy-unipi {version('sippy-unipi')}")
