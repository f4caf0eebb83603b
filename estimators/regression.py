"""What the estimators of this folder have in common: the columns of a pulse experiment, and border points from its coefficients.

With the input in units of u_M − u_m, u = u_m + w: w is 1 where a descendant experiment rests and 0 at its V₁, the other way round in an ascendant one, so that
y(t) = −Σ aᵢ y(t−i) + κ + Σ bᵢ w(t−i), κ = B(1) u_m. Of the other levels w is not known: each has a column for every lag, with the coefficient bᵢ wⱼ.
"""

from __future__ import annotations

import numpy as np


def inputs(request) -> list[np.ndarray]:
    """For each experiment the samples of its inputs, one a column: where w is known to be 1, then V₂ … V_m of the descendant, of the ascendant one."""
    found = []
    for k, e in enumerate((request.descendant, request.ascendant)):
        u = np.zeros((e.v.size, 1 + 2 * (request.points - 1)))
        u[:, 0] = e.v == (e.satellite if k == 0 else e.levels[0])
        for j in range(1, request.points):
            u[:, 1 + k * (request.points - 1) + j - 1] = e.v == e.levels[j]
        found.append(u)
    return found


def columns(request) -> tuple[np.ndarray, np.ndarray]:
    """The regression: columns −y(t−1) … −y(t−n), each input at each lag (lags together), and 1; and y(t)."""
    n, blocks, right = request.order, [], []
    for e, u in zip((request.descendant, request.ascendant), inputs(request)):
        rows = slice(e.lead, e.lead + request.samples)
        lagged = [-e.y[rows.start - i : rows.stop - i, None] for i in range(1, n + 1)]
        pulses = [u[rows.start - i : rows.stop - i] for i in range(1, n + 1)]
        blocks.append(np.hstack([*lagged, *pulses, np.ones((request.samples, 1))]))
        right.append(e.y[rows])
    return np.vstack(blocks), np.concatenate(right)


def parameters(request, a: np.ndarray, mu: np.ndarray, kappa: float) -> np.ndarray:
    """a, b and the points of both borders, from coefficients of the inputs at each lag, shape (n, inputs)."""
    b = mu[:, 0]
    w = b @ mu[:, 1:] / (b @ b)
    low, half = kappa / b.sum(), request.points - 1
    descending = low + np.concatenate([[0.0], w[:half]])
    ascending = low + np.concatenate([[1.0], w[half:]])
    return np.concatenate([a, b, descending, ascending])


def of_coefficients(request, theta: np.ndarray) -> np.ndarray:
    """The same from the coefficients of :func:`columns`."""
    n = request.order
    return parameters(request, theta[:n], theta[n:-1].reshape(n, -1), theta[-1])
