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

from ._commands import audit, calibrate, diagnose, evaluate, plan, simulate, verify
from ._engine import NoResult, version as __version__
from ._faults import Fault, Refused
from ._quantity import Quantity, covariance, quantity
from ._result import Measurand, Record, Result

__all__ = [
    "Fault",
    "Measurand",
    "NoResult",
    "Quantity",
    "Record",
    "Refused",
    "Result",
    "audit",
    "calibrate",
    "covariance",
    "diagnose",
    "evaluate",
    "plan",
    "quantity",
    "simulate",
    "verify",
]
