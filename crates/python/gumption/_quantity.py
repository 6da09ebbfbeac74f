"""Uncertain numbers: written as arithmetic, evaluated by the engine as a budget."""

from __future__ import annotations

import itertools
import math
import numbers
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from copy import deepcopy
from decimal import Decimal
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any, NoReturn, Union, cast
from uuid import uuid4
from weakref import WeakValueDictionary

import numpy as np

from . import _units as units
from ._commands import evaluate
from ._digits import estimate, figure, rounded, short
from ._result import Measurand, Result
from ._units import Units

Operand = Union["Quantity", float]

_DIGITS_OF_U = re.compile(r"(?:\.([1-9]))?u(S?)")
"""So many digits of u, and whether they stand in brackets, as the package ``uncertainties`` writes it."""

_COMPARISONS = {"equal", "not_equal", "less", "less_equal", "greater", "greater_equal"}
"""Functions of NumPy that arrays call for their elements."""

_OURS = re.compile(r"[qy]\d*")
"""Names that are given here: of quantities without one, and of results."""

_lasting: WeakValueDictionary[str, Lasting] = WeakValueDictionary()
"""What was handed over, or came, by its key."""


class Lasting:
    """Comes back from a pickle as what it was, where that still is: as with a copy, another one would have nothing in common
    with it."""

    _key: str | None = None

    def __reduce__(self) -> tuple[Any, ...]:
        if self._key is None:
            self._key = uuid4().hex
            _lasting[self._key] = self
        state = {name: one for name, one in self.__dict__.items() if name != "result"}
        return _again, (type(self), self._key), state

    def __setstate__(self, state: dict[str, Any]) -> None:
        if self.__dict__.keys() == {"_key"}:
            self.__dict__.update(state)


def _again(kind: type[Lasting], key: str) -> Lasting:
    found = _lasting.get(key)
    if found is None:
        found = _lasting[key] = kind.__new__(kind)
        found._key = key
    return found


class Quantity(Lasting):
    """A quantity: one of which something is known, or a formula of others.

    Arithmetic keeps what quantities have in common: ``x - x`` is 0 exactly. Nothing is computed until a figure is
    asked for; then the formula and what it rests on are a budget, and ``result`` is what ``evaluate`` makes of it, with
    ν_eff, k, U, Monte Carlo and everything found. Units are those of the budget file; a bare number has none.
    """

    def __init__(
        self,
        formula: str = "",
        parts: tuple[Quantity, ...] = (),
        known: dict[str, Any] | None = None,
        unit: Units | None = None,
        name: str | None = None,
    ):
        self._name = name
        self._formula = formula
        self._parts = parts
        self._known = known
        self._units = unit or {}
        self._joint: Joint | None = None

    @cached_property
    def result(self) -> Result:
        """The evaluated budget."""
        budget = _budget([self])
        if "input" not in budget:
            raise ValueError(
                "nothing here is uncertain: state u, half_width, readings …; "
                "what is exact stands in formulas beside quantities that are not, and is a plain number otherwise"
            )
        return evaluate(budget)

    @property
    def _found(self) -> Measurand:
        return cast(Measurand, self.result["y"])

    @property
    def y(self) -> float:
        """The estimate."""
        return self._found.y

    @property
    def unit(self) -> str:
        """Its unit."""
        return str(self._found.unit)

    @property
    def u(self) -> float | None:
        """The standard uncertainty."""
        return self._found.u

    @property
    def nu(self) -> float:
        """The effective degrees of freedom (Welch and Satterthwaite)."""
        return float(self._found.gum.effective_degrees_of_freedom)

    @property
    def k(self) -> float | None:
        """The coverage factor."""
        return self._found.k

    @property
    def U(self) -> float | None:  # noqa: N802 - the symbol of the standard
        """The expanded uncertainty."""
        return self._found.U

    @property
    def interval(self) -> tuple[float, float] | None:
        """The coverage interval."""
        return self._found.interval

    def to(self, unit: str) -> Quantity:
        """The same quantity, in another unit."""
        _known(unit)
        return Quantity("{}", (self,), unit=units.of(unit))

    def budget(self) -> dict[str, Any]:
        """The budget that is evaluated."""
        return _budget([self])

    def sensitivities(self) -> dict[Quantity, float]:
        """Derivatives to the quantities on which it rests, those with an uncertainty."""
        resting = {name: one for one, name in _named([self]).items() if one._known is not None}
        names = [one.name for one in self.result.inputs]
        return {resting[name]: one.sensitivity for name, one in zip(names, self._found.gum.inputs)}

    def to_uncertainties(self) -> Any:
        """A number of the package ``uncertainties``, correlated with all others that were made so."""
        from ._uncertainties import to_uncertainties

        return to_uncertainties(self)

    def to_gtc(self) -> Any:
        """An uncertain number of the package ``GTC`` with its degrees of freedom, correlated with all others that were made so."""
        from ._gtc import to_gtc

        return to_gtc(self)

    def __add__(self, other: Operand) -> Quantity:
        return _formed("add", self, other)

    def __radd__(self, other: Operand) -> Quantity:
        # `sum` begins with 0, whatever the unit.
        return self if isinstance(other, numbers.Real) and other == 0 else _formed("add", other, self)

    def __sub__(self, other: Operand) -> Quantity:
        return _formed("subtract", self, other)

    def __rsub__(self, other: Operand) -> Quantity:
        return _formed("subtract", other, self)

    def __mul__(self, other: Operand) -> Quantity:
        return _formed("multiply", self, other)

    def __rmul__(self, other: Operand) -> Quantity:
        return _formed("multiply", other, self)

    def __truediv__(self, other: Operand) -> Quantity:
        return _formed("divide", self, other)

    def __rtruediv__(self, other: Operand) -> Quantity:
        return _formed("divide", other, self)

    def __pow__(self, other: Operand) -> Quantity:
        return _formed("power", self, other)

    def __rpow__(self, other: Operand) -> Quantity:
        return _formed("power", other, self)

    def __neg__(self) -> Quantity:
        return _formed("negative", self)

    def __pos__(self) -> Quantity:
        return self

    def __abs__(self) -> Quantity:
        return _formed("absolute", self)

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *given: Any, **settings: Any) -> Any:
        """NumPy's functions are those of the model language: ``np.sin(x)``, ``np.sqrt(x)``."""
        if method == "__call__" and not settings and ufunc.__name__ not in _OPERATIONS | dict.fromkeys(_COMPARISONS):
            raise TypeError(f"np.{ufunc.__name__} takes no quantities; those that do are {', '.join(sorted(_OPERATIONS))}")
        if method != "__call__" or settings or ufunc.__name__ not in _OPERATIONS:
            return NotImplemented
        if any(isinstance(one, np.ndarray) and one.ndim for one in given):
            arrays = np.broadcast_arrays(*(np.asarray(one, dtype=object) for one in given))
            flat = [_formed(ufunc.__name__, *ones) for ones in zip(*(array.flat for array in arrays))]
            return np.array(flat, dtype=object).reshape(arrays[0].shape)
        return _formed(ufunc.__name__, *given)

    def __repr__(self) -> str:
        """The estimate to the digits that three digits of u leave it."""
        y, u = self.y, self.u
        return self._shown(estimate(y, u), None if u is None else figure(u, 3) if u else "0")

    def __format__(self, spec: str) -> str:
        """Estimate and u alike, ``f"{x:.3f}"``; to two digits of u, ``f"{x:.2u}"``, with them in brackets, ``f"{x:.2uS}"``."""
        if not spec:
            return repr(self)
        if of_u := _DIGITS_OF_U.fullmatch(spec):
            return self._to_digits_of_u(int(of_u[1] or 2), in_brackets=bool(of_u[2]))
        try:
            return self._shown(f"{self.y:{spec}}", None if self.u is None else f"{self.u:{spec}}")
        except ValueError:
            raise ValueError(
                f"{spec!r} is no format of a number, such as '.3f', nor one of the digits of u, '.2u' or '.2uS'; "
                "without one u has three digits, and the estimate ends with it"
            ) from None

    def _to_digits_of_u(self, count: int, *, in_brackets: bool) -> str:
        y, u = self.y, self.u
        if not u:
            return repr(self)
        if not in_brackets:
            return self._shown(estimate(y, rounded(u, count), count), figure(u, count))
        return short(y, u, count) + ("" if self.unit == "1" else f" {self.unit}")

    def _shown(self, y: str, u: str | None) -> str:
        unit = "" if self.unit == "1" else f" {self.unit}"
        return f"<{y}{unit}>" if u is None else f"<{y}{unit}, u = {u}>"

    def _compared(self, _: object) -> NoReturn:
        raise TypeError("quantities have no order: compare their estimates, a.y < b.y, or ask whether a - b differs from 0")

    __lt__ = __le__ = __gt__ = __ge__ = _compared

    def __float__(self) -> NoReturn:
        raise TypeError("a quantity is no float: its estimate is .y; functions that keep its uncertainty are those of NumPy, np.sin(x)")

    # A checker of types knows what there is.
    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> NoReturn:
            """Tells what there is where a name of another package is asked for, such as ``nominal_value``."""
            if name.startswith("_"):
                raise AttributeError(name)
            own = ", ".join(one for one in vars(Quantity) if not one.startswith("_") and one not in _OPERATIONS)
            raise AttributeError(f"a quantity has no {name}; it has {own}")

    def __copy__(self) -> Quantity:
        return self

    def __deepcopy__(self, _: Any) -> Quantity:
        # A copy would be another quantity, that had nothing in common with this one.
        return self


class Joint(Lasting):
    """Quantities of which correlation coefficients are stated."""

    def __init__(self, members: list[Quantity], correlation: Any):
        self.members = members
        self._correlation = correlation
        for one in members:
            one._joint = self

    def coefficient(self, one: int, other: int) -> float:
        """The correlation coefficient of two members, by their places."""
        return float(self._correlation[one][other])

    def table(self, names: Mapping[Quantity, str]) -> dict[str, Any] | None:
        """The table of a budget for those of these that correlate with another; nothing where none does."""
        named = [place for place, one in enumerate(self.members) if one in names]
        at = [i for i in named if any(i != j and self.coefficient(i, j) != 0 for j in named)]
        if not at:
            return None
        matrix = [[self.coefficient(i, j) for j in at] for i in at]
        return {"inputs": [names[self.members[i]] for i in at], "correlation": matrix}


_OPERATIONS: dict[str, tuple[str, Callable[..., Units]]] = {
    "absolute": ("abs({})", units.alike),
    "add": ("{} + {}", units.alike),
    "arctan2": ("atan2({}, {})", units.none),
    "cbrt": ("cbrt({})", units.power_of(1 / 3)),
    "ceil": ("ceil({})", units.alike),
    "divide": ("{} / {}", units.quotient),
    "floor": ("floor({})", units.alike),
    "hypot": ("hypot({}, {})", units.alike),
    "conjugate": ("{}", units.alike),
    "exp2": ("2 ^ {}", units.none),
    # exp(x) - 1 and ln(1 + x) without the digits that the difference would lose.
    "expm1": ("2 * exp(0.5 * {0}) * sinh(0.5 * {0})", units.none),
    "float_power": ("{} ^ {}", units.power),
    "log": ("ln({})", units.none),
    "log1p": ("2 * atanh({0} / (2 + {0}))", units.none),
    "maximum": ("max({}, {})", units.alike),
    "minimum": ("min({}, {})", units.alike),
    "multiply": ("{} * {}", units.product),
    "negative": ("-{}", units.alike),
    "positive": ("{}", units.alike),
    "power": ("{} ^ {}", units.power),
    "reciprocal": ("1 / {}", units.power_of(-1)),
    "sqrt": ("sqrt({})", units.power_of(1 / 2)),
    "square": ("{} ^ 2", units.power_of(2)),
    "subtract": ("{} - {}", units.alike),
    **{name: (f"{name}({{}})", units.none) for name in "exp log10 log2 sin cos tan sinh cosh tanh sign".split()},
    **{f"arc{name}": (f"a{name}({{}})", units.none) for name in "sin cos tan sinh cosh tanh".split()},
}
"""By the names of NumPy: how the model language writes it, and the unit of what comes out."""


def _method(name: str) -> Callable[[Quantity], Any]:
    return lambda one: _formed(name, one)


# NumPy calls them for the elements of an array.
for _name, (_written, _) in _OPERATIONS.items():
    if "{0}" in _written or _written.count("{}") == 1:
        setattr(Quantity, _name, _method(_name))


def quantity(
    value: Any = None, u: float | str | None = None, unit: str | None = None, *, name: str | None = None, **known: Any
) -> Quantity:
    """A quantity of which something is known.

    ``u`` is its standard uncertainty; ``quantity("5 V", 0.01)`` has its unit with the value; anything else is said as in an
    input of a budget file: ``half_width=0.1``, ``dof=9``, ``readings=[…]`` (without ``value``), ``distribution="triangular"``, ``certificate={"U": 0.2, "k": 2}``.
    A number of the package ``uncertainties`` or ``GTC`` stays correlated with all others that are taken so. ``name`` is what
    reports call it.
    """
    if hasattr(value, "nominal_value"):
        from ._uncertainties import from_uncertainties

        return from_uncertainties(value)
    if type(value).__module__.partition(".")[0] == "GTC":
        from ._gtc import from_gtc

        return from_gtc(value)
    if name is not None and not (isinstance(name, str) and name.isidentifier()):
        raise ValueError(f"{name!r} cannot be the name of a quantity: write letters, digits and _")
    if name is not None and _OURS.fullmatch(name):
        raise ValueError(f"{name!r} cannot be the name of a quantity: results are called so, and quantities without a name")
    if isinstance(value, str) and unit is None:
        # "5 V" says its unit, in which a number for u is, too.
        unit = value.strip().partition(" ")[2].strip() or None
    # What can be seen at once is told at once, and not where a figure is asked for.
    for what, number in (("value", value), ("u", u)):
        if isinstance(number, numbers.Real) and not math.isfinite(number):
            raise ValueError(f"{what} is {number}: a finite number is needed")
    if isinstance(u, numbers.Real) and u < 0:
        raise ValueError(f"u is {u}: write it without sign")
    if unit is not None:
        _known(unit)
    stated = {"value": value, "u": None if u == 0 else u, "unit": "1" if unit is None else unit, **known}
    # A list that is changed afterwards changes nothing here.
    stated = {key: list(one) if isinstance(one, Iterator) else deepcopy(one) for key, one in stated.items() if one is not None}
    if known or not all(one is None or isinstance(one, numbers.Real) for one in (value, u)) or value is None:
        _checked(stated, name or "x")
    return Quantity(known=stated, unit=units.of(unit), name=name)


@lru_cache(maxsize=1024)
def _known(unit: str) -> None:
    """Raises ``Refused`` where there is no such unit."""
    _checked({"value": 1, "u": 1, "unit": unit}, "x")


def _checked(known: dict[str, Any], name: str) -> None:
    """Raises ``Refused`` where this cannot be known of an input."""
    # What is exact is that beside an uncertainty, too.
    known = {"u": 1, **known} if _is_exact(known) else known
    budget = {"measurand": {"y": {"model": name, "unit": known["unit"]}}, "input": {name: known}}
    evaluate(budget, monte_carlo=False)


def _is_exact(known: Mapping[str, Any]) -> bool:
    """Of what has neither uncertainty nor readings nothing is in doubt."""
    return set(known) <= {"value", "unit"}


def correlated(
    values: Sequence[float],
    u: Sequence[float],
    correlation: Any,
    unit: Sequence[str] | str | None = None,
    names: Sequence[str] | None = None,
) -> list[Quantity]:
    """Quantities with standard uncertainties and a matrix of correlation coefficients."""
    matrix = np.asarray(correlation, dtype=float)
    of_each = [unit] * len(values) if unit is None or isinstance(unit, str) else list(unit)
    named = [None] * len(values) if names is None else list(names)
    if matrix.shape != (len(values), len(values)) or {len(u), len(of_each), len(named)} != {len(values)}:
        raise ValueError(
            f"{len(values)} values take as many u, units and names, and a matrix of as many rows and columns"
        )
    each = zip(values, u, of_each, named)
    members = Joint([quantity(y, s, one, name=name) for y, s, one, name in each], matrix).members
    covariance(members)
    return members


def covariance(quantities: Iterable[Quantity]) -> np.ndarray:
    """Covariance matrix of quantities, from their sensitivity coefficients (JCGM 102, 6.2)."""
    quantities = list(quantities)
    for one in quantities:
        if not isinstance(one, Quantity):
            raise TypeError(f"{one!r} is no quantity: write quantity({one!r})")
    if all(_is_exact(one._known) for one in _named(quantities) if one._known is not None):
        return np.zeros((len(quantities), len(quantities)))
    result = evaluate(_budget(quantities), monte_carlo=False)
    if len(quantities) == 1:
        return np.array([[result["y"].gum.standard_uncertainty ** 2]])
    return np.array(result.joint.covariance, dtype=float)


def _formed(operation: str, *given: Any) -> Quantity:
    given = tuple(_taken(one) for one in given)
    if not all(isinstance(one, (Quantity, numbers.Real)) for one in given):
        return cast(Quantity, NotImplemented)
    places = itertools.count()
    # A formula may name an operand twice.
    written = [f"{{{next(places)}}}" if isinstance(one, Quantity) else _number(float(one)) for one in given]
    formula, unit = _OPERATIONS[operation]
    operands = [one._units if isinstance(one, Quantity) else one for one in given]
    parts = tuple(one for one in given if isinstance(one, Quantity))
    return Quantity(formula.format(*written), parts, unit=unit(*operands))


def _taken(one: Any) -> Any:
    """What arithmetic takes as a quantity or a number: uncertain numbers of other packages, and decimals, too."""
    if isinstance(one, (Quantity, numbers.Real)):
        return one
    if isinstance(one, Decimal):
        return float(one)
    is_uncertain = hasattr(one, "nominal_value") or type(one).__module__.partition(".")[0] == "GTC"
    return quantity(one) if is_uncertain else one


def _number(value: float) -> str:
    if not math.isfinite(value):
        raise ValueError(f"{value} cannot stand in a formula")
    return f"({value!r})"


def _named(quantities: list[Quantity]) -> dict[Quantity, str]:
    """They and what they rest on, each after its parts, with their names in a budget."""
    order: dict[Quantity, None] = {}
    waiting = [(one, False) for one in reversed(quantities)]
    while waiting:
        one, ready = waiting.pop()
        if one in order:
            continue
        if ready:
            order[one] = None
        else:
            waiting.append((one, True))
            waiting.extend((part, False) for part in reversed(one._parts))
    numbers = itertools.count(1)
    names = {one: one._name or f"q{next(numbers)}" for one in order}
    for name, count in Counter(names.values()).items():
        if count > 1:
            raise ValueError(f"two quantities are called {name}")
    return names


def _budget(quantities: list[Quantity]) -> dict[str, Any]:
    """What is known as inputs, formulas as statements of one model, each after those that it uses."""
    names = _named(quantities)
    formulas = [
        f"{name} = {one._formula.format(*(names[part] for part in one._parts))}"
        for one, name in names.items()
        if one._known is None
    ]
    known = [(one, name, one._known) for one, name in names.items() if one._known is not None]
    inputs = {one: name for one, name, what in known if not _is_exact(what)}
    outputs = ["y"] if len(quantities) == 1 else [f"y{at}" for at in range(1, len(quantities) + 1)]
    measurands = {
        output: {"model": names[one], "unit": units.written(one._units)}
        for output, one in zip(outputs, quantities)
    }
    groups = {id(one._joint): one._joint for one in inputs if one._joint is not None}
    tables = [group.table(inputs) for group in groups.values()]
    parts = {
        "title": "Quantities",
        "model": "\n".join(formulas),
        "measurand": measurands,
        "constant": {name: what for one, name, what in known if one not in inputs},
        "input": {name: what for one, name, what in known if one in inputs},
        "joint": [table for table in tables if table is not None],
    }
    return {key: part for key, part in parts.items() if part}
