"""Quantities as numbers of the package ``uncertainties``, and back.

What the numbers rest on (its independent ``Variable``) and what quantities rest on are matched one to one, so that
everything that passes in either direction stays correlated.
"""

from __future__ import annotations

from typing import Any, NamedTuple, cast

import numpy as np
import uncertainties  # type: ignore[import-untyped]
from uncertainties import UFloat

from ._quantity import Joint, Quantity, as_number, is_exact, quantity

_taken: dict[int, _Taken] = {}
"""Variables by their identity, since they can neither be compared nor referred to weakly."""

_made: dict[Quantity, Any] = {}
"""The number of each quantity of which something is known."""


class _Taken(NamedTuple):
    """A variable that is a quantity here."""

    variable: Any
    std_dev: float
    """That of the variable when it was taken."""
    one: Quantity


def from_uncertainties(number: UFloat) -> Quantity:
    """The quantity of a number: linear in those of its variables."""
    for variable in number.derivatives:
        if not np.isfinite(variable.std_dev):
            raise ValueError(f"the std_dev of {variable.nominal_value} is {variable.std_dev}: a finite number is needed")
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
        _match(taken, variable, taken)
        return taken
    if found.std_dev != variable.std_dev:
        raise ValueError(
            f"the std_dev of a number was {found.std_dev} when it became a quantity, and is {variable.std_dev} now: "
            "make another number, ufloat(value, std_dev)"
        )
    return found.one


def _match(known: Quantity, variable: Any, one: Quantity) -> None:
    """From now on the variable is this quantity, made of what is known."""
    _made.setdefault(known, variable)
    _taken[id(variable)] = _Taken(variable, variable.std_dev, one)


def to_uncertainties(one: Quantity) -> UFloat:
    """The number of a quantity: linear in those of what it rests on, with the sensitivity coefficients of the GUM."""
    number: Any = one._found.gum.estimate
    sensitivities = one.sensitivities()
    if sensitivities == {one: 1.0}:
        # Whoever tells variables by their identity finds this one again.
        return _number_of(one)
    for resting, sensitivity in sensitivities.items():
        variable = _number_of(resting)
        number = number + sensitivity * (variable - variable.nominal_value)
    return number


def _number_of(resting: Quantity) -> UFloat:
    if resting not in _made:
        if resting._joint is None:
            gum = resting._found.gum
            variable = uncertainties.ufloat(gum.estimate, gum.standard_uncertainty, tag=resting._name)
            _match(resting, variable, as_number(resting))
        else:
            _make_all(resting._joint)
    return _made[resting]


def _make_all(joint: Joint) -> None:
    """The numbers of quantities that correlate: linear in variables that do not, the principal components of what they deviate
    by, each of which is a quantity made of these in turn."""
    places = [at for at, member in enumerate(joint.members) if not is_exact(member)]
    known = [joint.members[at]._found.gum for at in places]
    variances, vectors = np.linalg.eigh([[joint.coefficient(i, j) for j in places] for i in places])
    # Rounding leaves something of a variance that is zero.
    is_some = variances > len(places) * np.finfo(float).eps
    variances, vectors = variances[is_some], vectors[:, is_some]
    variables = [uncertainties.ufloat(0.0, float(np.sqrt(variance))) for variance in variances]
    deviations = []
    for at, gum, row in zip(places, known, vectors):
        member, u = joint.members[at], gum.standard_uncertainty
        _made[member] = gum.estimate + u * sum(float(part) * variable for part, variable in zip(row, variables))
        deviations.append((as_number(member) - gum.estimate) * (1 / u))
    for variable, column in zip(variables, vectors.T):
        one = sum(float(part) * deviation for part, deviation in zip(column, deviations))
        _taken[id(variable)] = _Taken(variable, variable.std_dev, cast(Quantity, one))
