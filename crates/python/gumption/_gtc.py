"""Quantities as uncertain numbers of the package GTC, and back.

What such numbers rest on (GTC's leaves: elementary uncertain numbers) and what quantities rest on are matched one to one, with
degrees of freedom and correlation, so that everything that passes in either direction stays correlated.
"""

from __future__ import annotations

import math
from typing import Any

import GTC  # type: ignore[import-untyped]
from GTC.vector import Vector  # type: ignore[import-untyped]

from ._quantity import Joint, Quantity, as_number, quantity

_taken: dict[tuple[int, int], Quantity] = {}
"""The deviation of each leaf from its value, which a leaf does not know, by its identity."""

_own: dict[tuple[int, int], tuple[float, Quantity]] = {}
"""The value of each number that was made here, and its quantity, by the identity of its leaf."""

_made: dict[Quantity, Any] = {}
"""The number of each quantity of which something is known."""


class _Leaves(Joint):
    """Deviations of leaves that may correlate, with what GTC says of them when a figure is asked for."""

    def __init__(self) -> None:
        super().__init__([], [])
        self._leaves: list[Any] = []

    def add(self, leaf: Any, deviation: Quantity) -> None:
        self._leaves.append(leaf)
        self.members.append(deviation)
        deviation._joint = self

    def coefficient(self, one: int, other: int) -> float:
        leaf, also = self._leaves[one], self._leaves[other]
        return 1.0 if one == other else float(leaf.correlation.get(also.uid, 0.0))


_leaves = _Leaves()


def from_gtc(number: Any) -> Quantity:
    """The quantity of a number: linear in the deviations of its leaves."""
    if not isinstance(number, GTC.lib.UncertainReal):
        raise TypeError("only real numbers of GTC become quantities: take z.real and z.imag of a complex one")
    components = [*number._u_components.iteritems(), *number._d_components.iteritems()]
    match components:
        case [(leaf, component)] if component == leaf.u and (own := _own.get(leaf.uid)) and own[0] == number.x:
            return own[1]
    total = quantity(number.x)
    for leaf, component in components:
        total = total + _slope(component / leaf.u) * _deviation(leaf)
    return total


def _slope(slope: float) -> float:
    """3 where the division leaves 3.0000000000000004: what should cancel does."""
    short = float(f"{slope:.14g}")
    return short if abs(short - slope) <= 2 * math.ulp(slope) else slope


def _deviation(leaf: Any) -> Quantity:
    if leaf.uid not in _taken:
        known = {} if math.isinf(leaf.df) else {"dof": leaf.df}
        deviation = _taken[leaf.uid] = quantity(0.0, leaf.u, **known)
        component, nothing = Vector(index=[leaf], value=[leaf.u]), Vector()
        parts = (component, nothing) if leaf.independent else (nothing, component)
        _made[deviation] = GTC.lib.UncertainReal(0.0, *parts, Vector(), leaf)
        if not leaf.independent:
            _leaves.add(leaf, deviation)
    return _taken[leaf.uid]


def to_gtc(one: Quantity) -> Any:
    """The number of a quantity: linear in those of what it rests on, with the sensitivity coefficients of the GUM."""
    number: Any = GTC.constant(one._found.gum.estimate)
    for resting, sensitivity in one.sensitivities().items():
        elementary = _number_of(resting)
        number = number + sensitivity * (elementary - elementary.x)
    return number


def _number_of(resting: Quantity) -> Any:
    if resting not in _made:
        members = [resting] if resting._joint is None else resting._joint.members
        known = [member._found.gum for member in members]
        for member, gum in zip(members, known):
            value, u, nu = gum.estimate, gum.standard_uncertainty, gum.effective_degrees_of_freedom
            number = GTC.ureal(value, u, nu, label=member._name, independent=resting._joint is None)
            _made[member], leaf, own = number, number._node.uid, as_number(member)
            _own[leaf], _taken[leaf] = (value, own), own - value
        if resting._joint is not None:
            for at, member in enumerate(members):
                for before in range(at):
                    r = resting._joint.coefficient(before, at)
                    GTC.set_correlation(r, _made[members[before]], _made[member])
    return _made[resting]
