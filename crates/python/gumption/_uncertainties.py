"""Quantities as numbers of the package ``uncertainties``, and back.

What the numbers rest on (its independent ``Variable``) and what quantities rest on are matched one to one, so that
everything that passes in either direction stays correlated.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import uncertainties  # type: ignore[import-untyped]
from uncertainties import UFloat

from ._quantity import Quantity, quantity

_taken: dict[int, tuple[Any, Quantity]] = {}
"""Variables by their identity, with the quantity of each: they can neither be compared nor referred to weakly."""

_made: dict[Quantity, UFloat] = {}
"""The number of each quantity of which something is known."""


def from_uncertainties(number: UFloat) -> Quantity:
    """The quantity of a number: linear in those of its variables."""
    derivatives = {variable: slope for variable, slope in number.derivatives.items() if variable.std_dev > 0}
    if not derivatives:
        return quantity(number.nominal_value)
    if number in derivatives:
        return _quantity_of(number)
    total = quantity(number.nominal_value)
    for variable, slope in derivatives.items():
        total = total + slope * (_quantity_of(variable) - variable.nominal_value)
    return total


def _quantity_of(variable: Any) -> Quantity:
    found = _taken.get(id(variable))
    if found is None:
        taken = quantity(variable.nominal_value, variable.std_dev)
        found = _taken[id(variable)] = (variable, taken)
        _made[taken] = variable
    return found[1]


def to_uncertainties(one: Quantity) -> UFloat:
    """The number of a quantity: linear in those of what it rests on, with the sensitivity coefficients of the GUM."""
    number: Any = one.result["y"].gum.estimate
    for resting, sensitivity in one.sensitivities().items():
        variable = _number_of(resting)
        number = number + sensitivity * (variable - variable.nominal_value)
    return number


def _number_of(resting: Quantity) -> UFloat:
    if resting not in _made:
        members = [resting] if resting._joint is None else resting._joint.members
        known = [member.result["y"].gum for member in members]
        deviations = np.array([gum.standard_uncertainty for gum in known])
        places = range(len(members))
        joint = resting._joint
        matrix = np.eye(1) if joint is None else np.array([[joint.coefficient(i, j) for j in places] for i in places])
        covariance = matrix * np.outer(deviations, deviations)
        numbers = uncertainties.correlated_values([gum.estimate for gum in known], covariance)
        if len(members) == 1:
            numbers = [uncertainties.ufloat(known[0].estimate, deviations[0], tag=resting._name)]
        _made.update(zip(members, numbers))
    return _made[resting]
