"""Uncertain numbers: written as arithmetic, evaluated by the engine as a budget."""

from __future__ import annotations

import itertools
import math
import numbers
from collections.abc import Iterable
from functools import cached_property
from typing import Any, Union

import numpy as np

from ._commands import evaluate
from ._result import Measurand, Result

Operand = Union["Quantity", numbers.Real]

_count = itertools.count(1)


class Quantity:
    """A quantity: a leaf with its own uncertainty, or a formula of others.

    Arithmetic keeps what quantities have in common: ``x - x`` is 0 exactly. Nothing is computed until a figure is
    asked for; then the formula and its leaves are a budget, and ``result`` is what ``evaluate`` makes of it, with ν_eff,
    k, U, Monte Carlo and everything found. Units are those of the budget file; a bare number has none.
    """

    __slots__ = ("_name", "_formula", "_parts", "_leaf", "_unit", "__dict__")

    def __init__(self, formula: str, parts: tuple[Quantity, ...], leaf: dict[str, Any] | None, unit: str | None):
        self._name = f"q{next(_count)}"
        self._formula = formula
        self._parts = parts
        self._leaf = leaf
        self._unit = unit

    @cached_property
    def result(self) -> Result:
        """The evaluated budget."""
        return _evaluated([self])

    @property
    def _found(self) -> Measurand:
        return self.result["y"]

    @property
    def y(self) -> float:
        """The estimate."""
        return self._found.y

    value = y

    @property
    def u(self) -> float | None:
        """The standard uncertainty."""
        return self._found.u

    @property
    def nu(self) -> float:
        """The effective degrees of freedom (Welch and Satterthwaite)."""
        return self._found.gum.effective_degrees_of_freedom

    @property
    def k(self) -> float | None:
        """The coverage factor."""
        return self._found.k

    @property
    def U(self) -> float | None:  # noqa: N802 - the symbol of the standard
        """The expanded uncertainty."""
        return self._found.U

    def to(self, unit: str) -> Quantity:
        """The same quantity, in another unit."""
        return Quantity(self._name, (self,), None, unit)

    def budget(self) -> dict[str, Any]:
        """The budget that is evaluated."""
        return _budget([self])

    def to_uncertainties(self):
        """A number of the package ``uncertainties``; what several have in common is kept by ``covariance`` there."""
        import uncertainties

        return uncertainties.ufloat(self.y, self.u, tag=self._name)

    def __add__(self, other: Operand) -> Quantity:
        return _formed("{} + {}", self, other)

    def __radd__(self, other: Operand) -> Quantity:
        return _formed("{} + {}", other, self)

    def __sub__(self, other: Operand) -> Quantity:
        return _formed("{} - {}", self, other)

    def __rsub__(self, other: Operand) -> Quantity:
        return _formed("{} - {}", other, self)

    def __mul__(self, other: Operand) -> Quantity:
        return _formed("{} * {}", self, other)

    def __rmul__(self, other: Operand) -> Quantity:
        return _formed("{} * {}", other, self)

    def __truediv__(self, other: Operand) -> Quantity:
        return _formed("{} / {}", self, other)

    def __rtruediv__(self, other: Operand) -> Quantity:
        return _formed("{} / {}", other, self)

    def __pow__(self, other: Operand) -> Quantity:
        return _formed("{} ^ {}", self, other)

    def __rpow__(self, other: Operand) -> Quantity:
        return _formed("{} ^ {}", other, self)

    def __neg__(self) -> Quantity:
        return _formed("-{}", self)

    def __pos__(self) -> Quantity:
        return self

    def __abs__(self) -> Quantity:
        return _formed("abs({})", self)

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *given: Any, **settings: Any) -> Any:
        """NumPy's functions are those of the model language: ``np.sin(x)``, ``np.sqrt(x)``."""
        formula = _UFUNCS.get(ufunc.__name__)
        if method != "__call__" or settings or formula is None:
            return NotImplemented
        if any(isinstance(one, np.ndarray) and one.ndim for one in given):
            arrays = np.broadcast_arrays(*(np.asarray(one, dtype=object) for one in given))
            flat = [_formed(formula, *ones) for ones in zip(*(array.flat for array in arrays))]
            return np.array(flat, dtype=object).reshape(arrays[0].shape)
        return _formed(formula, *given)

    def __repr__(self) -> str:
        unit = "" if self._found.unit == "1" else f" {self._found.unit}"
        return f"<{self.y:.10g}{unit}, u = {self.u:.3g}>" if self.u is not None else f"<{self.y:.10g}{unit}>"


_SAME = "sqrt cbrt exp log10 log2 sin cos tan sinh cosh tanh floor ceil sign hypot".split()

_UFUNCS = {
    **{name: f"{name}({{}}, {{}})" if name == "hypot" else f"{name}({{}})" for name in _SAME},
    **{f"arc{name}": f"a{name}({{}})" for name in "sin cos tan sinh cosh tanh".split()},
    "absolute": "abs({})",
    "add": "{} + {}",
    "arctan2": "atan2({}, {})",
    "divide": "{} / {}",
    "log": "ln({})",
    "multiply": "{} * {}",
    "negative": "-{}",
    "power": "{} ^ {}",
    "square": "{} ^ 2",
    "subtract": "{} - {}",
}


def quantity(value: Any, u: float | str | None = None, unit: str | None = None, **known: Any) -> Quantity:
    """A quantity of which something is known.

    ``u`` is its standard uncertainty; anything else is said as in an input of a budget file: ``half_width=0.1``,
    ``dof=9``, ``readings=[…]`` (without a value), ``distribution="triangular"``, ``certificate={"U": 0.2, "k": 2}``.
    A number of the package ``uncertainties`` is taken with its standard deviation.
    """
    if hasattr(value, "nominal_value"):
        value, u = value.nominal_value, value.std_dev
    leaf: dict[str, Any] = {**known}
    stated = {"value": value, "u": u, "unit": "1" if unit is None else unit}
    leaf.update({key: one for key, one in stated.items() if one is not None})
    if leaf.get("u") == 0:
        del leaf["u"]
    return Quantity("", (), leaf, unit)


def covariance(quantities: Iterable[Quantity]) -> np.ndarray:
    """Covariance matrix of quantities, from their sensitivity coefficients (JCGM 102, 6.2)."""
    quantities = list(quantities)
    result = _evaluated(quantities)
    if len(quantities) == 1:
        return np.array([[result.measurands[0].gum.standard_uncertainty ** 2]])
    return np.array(result.rows[0].to_dict()["joint"]["covariance"], dtype=float)


def _formed(formula: str, *given: Any) -> Any:
    parts = [one for one in given if isinstance(one, Quantity)]
    if not all(isinstance(one, (Quantity, numbers.Real)) for one in given):
        return NotImplemented
    written = [one._name if isinstance(one, Quantity) else _number(float(one)) for one in given]
    return Quantity(formula.format(*written), tuple(parts), None, None)


def _number(value: float) -> str:
    if not math.isfinite(value):
        raise ValueError(f"{value} cannot stand in a formula")
    return f"({value!r})"


def _evaluated(quantities: list[Quantity]) -> Result:
    return evaluate(_budget(quantities))


def _budget(quantities: list[Quantity]) -> dict[str, Any]:
    """Leaves as inputs, formulas as statements of one model, each after those that it uses."""
    order: dict[str, Quantity] = {}
    waiting = [(one, False) for one in reversed(quantities)]
    while waiting:
        one, ready = waiting.pop()
        if one._name in order:
            continue
        if ready:
            order[one._name] = one
        else:
            waiting.append((one, True))
            waiting.extend((part, False) for part in one._parts)
    statements = [f"{one._name} = {one._formula}" for one in order.values() if one._leaf is None]
    inputs, constants = {}, {}
    for one in order.values():
        if one._leaf is not None:
            exact = set(one._leaf) <= {"value", "unit"}
            (constants if exact else inputs)[one._name] = one._leaf
    names = ["y"] if len(quantities) == 1 else [f"y{at}" for at in range(1, len(quantities) + 1)]
    measurands = {
        name: {"model": one._name, **({} if one._unit is None else {"unit": one._unit})}
        for name, one in zip(names, quantities)
    }
    budget: dict[str, Any] = {"title": "Quantities", "measurand": measurands, "input": inputs}
    if statements:
        budget["model"] = "\n".join(statements)
    if constants:
        budget["constant"] = constants
    return budget
