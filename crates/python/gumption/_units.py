"""The unit in which a formula of quantities is reported, as long as nobody asks for another."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from fractions import Fraction
from typing import Union

Units = dict[str, float]
"""Exponents of units, each as somebody wrote it. The engine checks what comes of it, and tells what it should be."""

Operand = Union[Units, float]
"""A quantity's units, or a bare number."""


def of(written: str | None) -> Units:
    """Those of a quantity that states its unit."""
    return {} if written in (None, "1") else {written: 1.0}


def written(units: Units) -> str:
    """As a budget file has it."""
    factors = {unit: exponent for unit, exponent in units.items() if exponent != 0}
    match list(factors.items()):
        case [(unit, 1)]:
            return unit
        case all:
            return "·".join(_factor(unit, exponent) for unit, exponent in all) or "1"


def _factor(unit: str, exponent: float) -> str:
    compound = any(sign in unit for sign in "/*·^²³√ ")
    factor = f"({unit})" if compound else unit
    return factor if exponent == 1 else f"{factor}^{_exponent(exponent)}"


def _exponent(exponent: float) -> str:
    """A root has a simple fraction: ⅓ as a decimal is no exponent of a unit."""
    simple = Fraction(exponent).limit_denominator(12)
    is_simple = math.isclose(float(simple), exponent, rel_tol=1e-12) and simple.denominator > 2
    return f"({simple})" if is_simple else f"{exponent:g}"


def alike(*operands: Operand) -> Units:
    """What is added has one unit; that of the first that has any. What is added to a point of a scale gives a point."""
    having = [one for one in operands if isinstance(one, dict) and one]
    return next(filter(interval, having), having[0] if having else {})


def difference(a: Operand, b: Operand) -> Units:
    """Of what is subtracted: two points of a scale leave a difference, which has another unit."""
    points = isinstance(a, dict) and isinstance(b, dict) and interval(b)
    between = interval(a) if points and isinstance(a, dict) else None
    return of(between) if between else alike(a, b)


_POINT = re.compile(r"(.*)(?:°C|degC|℃|摄氏度)|°F|degF|℉|华氏度")
"""Units of scales with a zero of their own, with what stands before them."""


def interval(units: Units) -> str | None:
    """The unit of differences, where this is one of points on a scale."""
    match list(units.items()):
        case [(unit, 1)] if point := _POINT.fullmatch(unit):
            # `kK`, `mK`; in a compound unit °C is a difference anyway.
            return "Δ°F" if point[1] is None else f"{point[1]}K" if len(point[1]) < 3 else None
    return None


def none(*_: Operand) -> Units:
    """A number."""
    return {}


def product(a: Operand, b: Operand) -> Units:
    """Exponents add."""
    return _combined(a, b, 1)


def quotient(a: Operand, b: Operand) -> Units:
    """Exponents are subtracted."""
    return _combined(a, b, -1)


def power(a: Operand, exponent: Operand) -> Units:
    """By a number; where the exponent is a quantity, both are numbers."""
    return {} if isinstance(exponent, dict) else power_of(float(exponent))(a)


def power_of(exponent: float) -> Callable[[Operand], Units]:
    """By a fixed number."""
    return lambda a: {unit: one * exponent for unit, one in _units(a).items()}


def _combined(a: Operand, b: Operand, sign: int) -> Units:
    all_units = {**_units(a), **_units(b)}
    return {unit: _units(a).get(unit, 0.0) + sign * _units(b).get(unit, 0.0) for unit in all_units}


def _units(one: Operand) -> Units:
    return one if isinstance(one, dict) else {}
