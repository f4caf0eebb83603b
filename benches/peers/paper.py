"""From regression coefficients to the system and its border: (3.24a–b), (3.25)."""

import numpy as np


def estimate(experiment, a, heights, y0):
    """a, b and F̂(V_1) … F̂(V_m) in the normalisation u_M − u_m = 1, a row a replicate.

    `a` is R × n. `heights` is R × n × m, the coefficient of "V_j was visited i samples ago": μ_ij W_j, so that
    b_i = −heights_i1 and ĉ_j W_j = Σ b_i heights_ij / Σ b_i². `y0` is the mean output at the satellite.
    """
    b = -heights[:, :, 0]
    falls = np.einsum("ri,rij->rj", b, heights) / np.sum(b * b, axis=1)[:, None]
    level = (1.0 + a.sum(axis=1)) / b.sum(axis=1) * y0
    return np.hstack([a, b, falls + level[:, None]])
