"""Measurement uncertainty: budgets by the GUM and by Monte Carlo, calibrations, diagnoses, audits.

Every function takes a file: a path; its text; or a ``dict`` of what would stand in it. A text or a ``dict`` may name
other files, which are then given as ``files={"readings.csv": "U\\n1.0\\n1.1\\n"}``. The figures are those of the
command ``gumption``, to the last bit.

>>> import gumption
>>> result = gumption.evaluate('''
... title = "Current through a resistor"
... [measurand.I]
... model = "V / R"
... unit = "mA"
... [input]
... V = { value = 1.0001, unit = "V", u = 0.0003 }
... R = { value = 100.02, unit = "ohm", half_width = 0.01 }
... ''')
>>> print(f"{result['I'].y:.4f} {result['I'].unit}")
9.9990 mA
"""

from ._arrow import RecordBatch
from ._batch import arrow_batch, batch
from ._commands import audit, calibrate, diagnose, evaluate, fleet, plan, simulate, verify
from ._engine import version as __version__
from ._faults import Fault, NoResult, Refused
from ._quantity import Quantity, correlated, covariance, quantity
from ._result import Measurand, Record, Result, Row
from ._table import Table

__all__ = [
    "Fault",
    "Measurand",
    "NoResult",
    "Quantity",
    "Record",
    "RecordBatch",
    "Refused",
    "Result",
    "Row",
    "Table",
    "__version__",
    "arrow_batch",
    "audit",
    "batch",
    "calibrate",
    "correlated",
    "covariance",
    "diagnose",
    "evaluate",
    "fleet",
    "plan",
    "quantity",
    "simulate",
    "verify",
]
