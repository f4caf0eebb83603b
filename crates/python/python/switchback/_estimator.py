"""An estimator with the conventions of scikit-learn."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike
from sklearn.base import BaseEstimator, RegressorMixin
from sklearn.utils.validation import check_array, check_is_fitted, check_X_y

from . import _native
from ._arrays import Floats
from ._model import Model
from ._native import SwitchbackError
from ._options import number


class SwitchedHysteresis(RegressorMixin, BaseEstimator):  # type: ignore[misc]
    """A linear system behind a switched hysteresis, identified from one record by the method ``free``.

    A record is a time series: row ``t`` of ``X`` is the input at sample ``t``, and rows must stay in their order. Split them by
    ``TimeSeriesSplit``, without shuffling.

    Parameters
    ----------
    order : int, default=2
        Order of the linear part, from 1 to 20; None to have it chosen by cross-validation within the record.
    points : int, default=8
        Knots of each border, from 2 to 200; None to have them chosen.
    delay : int, default=None
        Samples of delay beyond the one that every lag has, −1 or more in a causal model; None to have it chosen.
    causal : bool, default=True
        Only models that could run in real time, which a prediction from inputs up to now takes.
    sample_time : float, default=1.0
        Seconds between samples; only the fitted model's ``bode`` and file depend on it.
    threads : int, default=None
        Worker threads, one a core if None; results do not depend on it.

    Attributes
    ----------
    model_ : Model
        The fitted model, which can be saved, simulated with a band, and exported.
    a_, b_ : ndarray
        Coefficients of ``A(q⁻¹) y = B(q⁻¹) u``.
    n_features_in_ : int
        1.

    Notes
    -----
    ``predict`` is a free run that begins at rest, as if the input had always been at its first value; no output is ever looked at. After a cut,
    the first samples therefore hold the transient from the state that the machine really had.

    Examples
    --------
    >>> from sklearn.model_selection import GridSearchCV, TimeSeriesSplit
    >>> search = GridSearchCV(SwitchedHysteresis(), {"order": [1, 2, 3], "points": [4, 8]}, cv=TimeSeriesSplit(3))
    >>> search.fit(v.reshape(-1, 1), y)   # doctest: +SKIP
    """

    def __init__(
        self,
        order: Optional[int] = 2,
        points: Optional[int] = 8,
        *,
        delay: Optional[int] = None,
        causal: bool = True,
        sample_time: float = 1.0,
        threads: Optional[int] = None,
    ) -> None:
        self.order = order
        self.points = points
        self.delay = delay
        self.causal = causal
        self.sample_time = sample_time
        self.threads = threads

    def fit(self, X: ArrayLike, y: ArrayLike) -> SwitchedHysteresis:
        """Identifies the system from inputs ``X``, shape ``(samples,)`` or ``(samples, 1)``, and outputs ``y``, shape ``(samples,)``."""
        inputs, outputs = check_X_y(_as_column(X), y, dtype=np.float64, y_numeric=True)
        _one_feature(self, inputs)
        pieces = [(inputs[:, 0].tobytes(), np.ascontiguousarray(outputs, dtype=np.float64).tobytes())]
        text = _native.fit(pieces, self._fixed())
        self.model_ = Model(text)
        self.n_features_in_ = 1
        self.a_, self.b_ = self.model_.a, self.model_.b
        return self

    def predict(self, X: ArrayLike) -> Floats:
        """The outputs of a free run on inputs ``X``, shape ``(samples,)`` or ``(samples, 1)``; the result has the shape ``(samples,)``."""
        check_is_fitted(self)
        inputs = check_array(_as_column(X), dtype=np.float64)
        _one_feature(self, inputs)
        return self.model_.simulate(inputs[:, 0]).y

    def _fixed(self) -> _native._Fixed:
        whole = {name: _whole(name, getattr(self, name)) for name in ("order", "points", "delay", "threads")}
        if not (np.isfinite(self.sample_time) and self.sample_time > 0):
            raise SwitchbackError(f"sample_time={self.sample_time} is no time; give positive seconds")
        for name, least, most in (("order", 1, 20), ("points", 2, 200), ("threads", 1, 1024)):
            value = whole[name]
            if value is not None and not least <= value <= most:
                raise SwitchbackError(f"{name}={value} must lie between {least} and {most}; None leaves the choice to the program")
        return {
            "order": whole["order"],
            "points": whole["points"],
            "delay": whole["delay"],
            "threads": whole["threads"],
            "causal": bool(self.causal),
            "sample_time": float(self.sample_time),
        }

    def __sklearn_tags__(self) -> Any:
        tags = super().__sklearn_tags__()
        # A model of a machine is none of independent rows.
        tags.regressor_tags.poor_score = True
        return tags


def _whole(name: str, value: Optional[int]) -> Optional[int]:
    if value is None:
        return None
    try:
        return int(number(value))
    except ValueError:
        raise SwitchbackError(f"{name}={value} is no whole number") from None


def _as_column(X: ArrayLike) -> Any:
    """A series of shape ``(samples,)`` as a column; whatever else is left to the checks of scikit-learn."""
    return np.asarray(X).reshape(-1, 1) if np.ndim(X) == 1 else X


def _one_feature(estimator: SwitchedHysteresis, inputs: Floats) -> None:
    if inputs.shape[1] != 1:
        raise SwitchbackError(
            f"X has {inputs.shape[1]} features, but {type(estimator).__name__} is expecting 1 features as input: the input of the machine"
        )
