"""Gauss–Newton on the one-step errors of the rank-one model, from its least squares on: at the Cramér–Rao bound. Needs NumPy."""

from __future__ import annotations

import numpy as np
from regression import columns, of_coefficients
from switchback_method import serve

#: It has converged where no parameter moves by more than this.
CONVERGED, MOST_STEPS = 1e-10, 20


def estimate(request) -> np.ndarray:
    phi, y = columns(request)
    n, count = request.order, 2 * (request.points - 1)
    gram, right = phi.T @ phi, phi.T @ y
    theta = np.linalg.solve(gram, right)
    a, mu, kappa = theta[:n], theta[n:-1].reshape(n, -1), theta[-1]
    b, w = mu[:, 0], mu[:, 0] @ mu[:, 1:] / (mu[:, 0] @ mu[:, 0])
    for _ in range(MOST_STEPS):
        levels = np.concatenate([[1.0], w])
        full = np.concatenate([a, np.outer(b, levels).ravel(), [kappa]])
        # How the coefficients of all columns change with a, b, w and κ.
        jacobian = np.zeros((phi.shape[1], 2 * n + count + 1))
        jacobian[:n, :n] = np.eye(n)
        for i in range(n):
            rows = slice(n + i * (1 + count), n + (i + 1) * (1 + count))
            jacobian[rows, n + i] = levels
            jacobian[rows, 2 * n : 2 * n + count][1:] = b[i] * np.eye(count)
        jacobian[-1, -1] = 1.0
        step = np.linalg.solve(jacobian.T @ gram @ jacobian, jacobian.T @ (right - gram @ full))
        a, b, w, kappa = a + step[:n], b + step[n : 2 * n], w + step[2 * n : -1], kappa + step[-1]
        if np.abs(step).max() < CONVERGED:
            return of_coefficients(request, np.concatenate([a, np.outer(b, [1.0, *w]).ravel(), [kappa]]))
    raise RuntimeError(f"no convergence within {MOST_STEPS} steps")


if __name__ == "__main__":
    serve(estimate, version="1")
