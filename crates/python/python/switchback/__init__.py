"""Switchback: identify switched-hysteresis systems, benchmark their estimators' consistency, diagnose the sim-to-real gap.

>>> import switchback as sb
>>> rig = sb.Rig.from_frame(frame, input="travel", output="force", time="time")     # doctest: +SKIP
>>> print(sb.diagnose(rig).words)                                                   # doctest: +SKIP

| call | command line |
|---|---|
| ``Rig.read``, ``Rig.from_frame`` | the files of a verb, or ``rig.toml`` |
| ``identify`` | ``switchback identify`` |
| ``diagnose``, ``power`` | ``switchback gap``, ``switchback gap --power`` |
| ``compare`` | ``switchback gap --against``, ``--model``, or with ``y_sim`` |
| ``plant``, ``design`` | ``switchback plant``, ``switchback design`` |
| ``Model.simulate`` | ``switchback simulate`` |
| ``study`` | ``switchback SCENARIO.toml`` |
| ``SwitchedHysteresis`` | an estimator for scikit-learn |

Every result has ``to_json()``, the object of the command line's ``--json``, and ``save(folder)``, the files of its ``--out``. What cannot be used raises
``SwitchbackError``, a ``ValueError``, in the words of the command line.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._design import Design, EffectPower, Planted, Power, design, plant, power
from ._diagnosis import Candidate, Diagnosis, Difference, Gap, Parameter, PartVerdict, Place, RecordGap, Stability, Verdict, compare, diagnose
from ._identification import Flag, Identification, RecordFit, identify
from ._methods import MethodExperiment, MethodRecords
from ._model import Bode, Model, Point, Simulation
from ._native import SwitchbackError, __version__
from ._result import Result
from ._rig import Record, Rig
from ._study import Cell, Expectation, Study, Summary, study
from ._table import Estimate, Table

if TYPE_CHECKING:
    from ._estimator import SwitchedHysteresis

__all__ = [
    "Bode",
    "Candidate",
    "Cell",
    "Design",
    "Diagnosis",
    "Difference",
    "EffectPower",
    "Estimate",
    "Expectation",
    "Flag",
    "Gap",
    "Identification",
    "MethodExperiment",
    "MethodRecords",
    "Model",
    "Parameter",
    "PartVerdict",
    "Place",
    "Planted",
    "Point",
    "Power",
    "Record",
    "RecordFit",
    "RecordGap",
    "Result",
    "Rig",
    "Simulation",
    "Stability",
    "Study",
    "Summary",
    "SwitchbackError",
    "SwitchedHysteresis",
    "Table",
    "Verdict",
    "__version__",
    "compare",
    "design",
    "diagnose",
    "identify",
    "plant",
    "power",
    "study",
]


def __getattr__(name: str) -> Any:
    # scikit-learn takes a second to load: whoever does without it does not wait for it.
    if name == "SwitchedHysteresis":
        from ._estimator import SwitchedHysteresis

        return SwitchedHysteresis
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
