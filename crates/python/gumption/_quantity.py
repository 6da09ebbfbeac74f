"""Uncertain numbers: written as arithmetic, evaluated by the engine as a budget."""

from __future__ import annotations

import itertools
import math
import numbers
import re
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from copy import deepcopy
from decimal import Decimal
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any, NoReturn, Union, cast
from uuid import uuid4
from weakref import WeakValueDictionary

import numpy as np

from . import _engine
from . import _units as units
from ._commands import evaluate
from ._digits import estimate, figure, rounded, short
from ._faults import Refused
from ._result import Measurand, Result
from ._units import Units

Operand = Union["Quantity", float, Decimal, Fraction, "np.integer[Any]", "np.floating[Any]"]
"""What arithmetic takes beside numbers of ``uncertainties`` and ``GTC``, which say nothing to a checker of types."""

Known = Union[float, str, Decimal, Fraction, "np.integer[Any]", "np.floating[Any]", None]
"""What is stated of a quantity: a number, in its unit; a text, with a unit of its own; or nothing."""

_DIGITS_OF_U = re.compile(r"(?:\.([1-9]))?u(S?)|(S)")
"""So many digits of u, and whether they stand in brackets, as the package ``uncertainties`` writes it."""

_COMPARISONS = {"equal", "not_equal", "less", "less_equal", "greater", "greater_equal"}
"""Functions of NumPy that arrays call for their elements."""

_lasting: WeakValueDictionary[str, Lasting] = WeakValueDictionary()
"""What was handed over, or came, by its key."""


class Lasting:
    """Comes back from a pickle as what it was, where that still is: as with a copy, another one would have nothing in common
    with it."""

    _key: str | None = None

    def _lasting_key(self) -> str:
        if self._key is None:
            self._key = uuid4().hex
            _lasting[self._key] = self
        return self._key

    def __reduce__(self) -> tuple[Any, ...]:
        key = self._lasting_key()
        state = {name: one for name, one in self.__dict__.items() if name != "result"}
        return _again, (type(self), key), state

    def __setstate__(self, state: dict[str, Any]) -> None:
        if self.__dict__.keys() == {"_key"}:
            self.__dict__.update(state)


def _of_chain(rows: list[tuple[Any, ...]]) -> Quantity:
    """The last of formulas, each of which rests on those before it and on others."""
    made: list[Quantity] = []
    for own, formula, parts, unit, name in rows:
        one = cast(Quantity, _again(Quantity, own))
        if one.__dict__.keys() == {"_key"}:
            of = tuple(made[part] if isinstance(part, int) else part for part in parts)
            Quantity.__init__(one, formula, of, unit=unit, name=name)
        made.append(one)
    return made[-1]


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

    def __reduce__(self) -> tuple[Any, ...]:
        """Formulas as a list: one within the other, a chain of a thousand would be too deep for a pickle."""
        if self._known is not None:
            return super().__reduce__()
        formulas = [one for one in _order([self]) if one._known is None]
        places = {one: at for at, one in enumerate(formulas)}
        rows = [
            (one._lasting_key(), one._formula, [places.get(part, part) for part in one._parts], one._units, one._name)
            for one in formulas
        ]
        return _of_chain, (rows,)

    @cached_property
    def result(self) -> Result:
        """The evaluated budget."""
        try:
            return evaluate(_budget([self]))
        except Refused as refused:
            raise _in_python(refused) from None

    @property
    def _found(self) -> Measurand:
        return cast(Measurand, self.result.measurands[0])

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
        """The same quantity, in another unit: a temperature in °C is a thermodynamic one in K."""
        _known(unit)
        target = units.of(unit)
        is_point, becomes_point = (units.interval(one) is not None for one in (self._units, target))
        if becomes_point and not is_point:
            raise ValueError(
                f"what is in {units.written(self._units)} may be a difference, which {unit} is not: a thermodynamic temperature x in K is "
                "quantity(0, unit='°C') + (x - quantity(273.15, unit='K')), a difference is added to a temperature"
            )
        is_leaving = is_point and not becomes_point
        return Quantity("kelvin({})" if is_leaving else "{}", (self,), unit=target)

    def budget(self) -> dict[str, Any]:
        """The budget that is evaluated."""
        return _budget([self])

    def sensitivities(self) -> dict[Quantity, float]:
        """Derivatives to the quantities on which it rests, those with an uncertainty."""
        resting = {name: one for one, name in _named([self]).items() if one._known is not None}
        names = [one.name for one in self.result.inputs]
        lines = zip(names, self._found.gum.inputs)
        return {resting[name]: one.sensitivity for name, one in lines if name in resting}

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
            _refuse_masked(*given)
            arrays = np.broadcast_arrays(*(np.asarray(one, dtype=object) for one in given))
            flat = [_element(ufunc.__name__, *ones) for ones in zip(*(array.flat for array in arrays))]
            return np.array(flat, dtype=object).reshape(arrays[0].shape)
        # An array without dimensions is what stands in it.
        return _formed(ufunc.__name__, *(one[()] if isinstance(one, np.ndarray) else one for one in given))

    def arctan2(self, other: Operand) -> Quantity:
        """NumPy calls it for the elements of an array, as those below."""
        return _element("arctan2", self, other)

    def hypot(self, other: Operand) -> Quantity:
        """The root of the sum of both squares."""
        return _element("hypot", self, other)

    def __floor__(self) -> Quantity:
        return _formed("floor", self)

    def __ceil__(self) -> Quantity:
        return _formed("ceil", self)

    def __repr__(self) -> str:
        """The estimate to the digits that three digits of u leave it."""
        y, u = self.y, self.u
        return self._shown(estimate(y, u), None if u is None else figure(u, 3) if u else "0")

    def __format__(self, spec: str) -> str:
        """Estimate and u alike, ``f"{x:.3f}"``; to two digits of u, ``f"{x:.2u}"``, with them in brackets, ``f"{x:.2uS}"``."""
        if not spec:
            return repr(self)
        if of_u := _DIGITS_OF_U.fullmatch(spec):
            return self._to_digits_of_u(int(of_u[1] or 2), in_brackets=bool(of_u[2] or of_u[3]))
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
    "fabs": ("abs({})", units.alike),
    "fmax": ("max({}, {})", units.alike),
    "fmin": ("min({}, {})", units.alike),
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
    "subtract": ("{} - {}", units.difference),
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
    value: Any = None, u: Known = None, unit: str | None = None, *, name: str | None = None, **known: Any
) -> Quantity:
    """A quantity of which something is known.

    ``u`` is its standard uncertainty; ``quantity("5 V", 0.01)`` has its unit with the value; anything else is said as in an
    input of a budget file: ``half_width=0.1``, ``dof=9``, ``readings=[…]`` (without ``value``), ``distribution="triangular"``, ``certificate={"U": 0.2, "k": 2}``.
    A number of the package ``uncertainties`` or ``GTC`` stays correlated with all others that are taken so, and takes a ``unit``
    and nothing else. ``name`` is what reports call it.
    """
    taken = _of_another_package(value)
    if taken is not None:
        if idle := [key for key, one in {"u": u, "name": name, **known}.items() if one is not None]:
            raise TypeError(f"{', '.join(idle)}: a number of another package says by itself what is known of it; beside it stands unit alone")
        return taken if unit is None else in_unit(taken, unit)
    if name is not None and not (isinstance(name, str) and name.isidentifier()):
        raise ValueError(f"{name!r} cannot be the name of a quantity: write letters, digits and _")
    if isinstance(value, str) and unit is None:
        # "5 V" says its unit, in which a number for u is, too.
        unit = _engine.unit_of(value)
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
    budget = {"measurand": {_output([name]): {"model": name, "unit": known["unit"]}}, "input": {name: known}}
    found = len(evaluate(budget, monte_carlo=False).measurands)
    if found != 1:
        raise TypeError(
            f"these are {found} quantities, and a quantity is one: make each of them, [quantity(value, u) for value in values], or all, "
            "correlated(values, u, correlation)"
        )


def _output(names: Collection[str]) -> str:
    """A name for a measurand beside these."""
    return next(_free("y", names)) if "y" in names else "y"


def _is_exact(known: Mapping[str, Any]) -> bool:
    """Of what has neither uncertainty nor readings nothing is in doubt."""
    return set(known) <= {"value", "unit"}


def is_exact(one: Quantity) -> bool:
    """Whether nothing is in doubt of a quantity of which something is known."""
    return one._known is not None and _is_exact(one._known)


def as_number(one: Quantity) -> Quantity:
    """Its number in its unit, which is what a package without units knows of it."""
    between = units.interval(one._units)
    if between:
        return (one - quantity(0, unit=units.written(one._units))) / quantity(1, unit=between)
    return one / quantity(1, unit=units.written(one._units)) if one._units else one


def in_unit(number: Quantity, unit: str) -> Quantity:
    """The quantity that has this number in a unit."""
    _known(unit)
    between = units.interval(units.of(unit))
    if between:
        return quantity(0, unit=unit) + number * quantity(1, unit=between)
    return number * quantity(1, unit=unit)


def correlated(
    values: Sequence[float] | np.ndarray,
    u: Sequence[float] | np.ndarray,
    correlation: Any,
    unit: Sequence[str] | str | None = None,
    names: Sequence[str] | None = None,
) -> list[Quantity]:
    """Quantities with standard uncertainties and a matrix of correlation coefficients."""
    _refuse_masked(correlation)
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
        return np.array([[result.measurands[0].gum.standard_uncertainty ** 2]])
    return np.array(result.joint.covariance, dtype=float)


def _element(operation: str, *given: Any) -> Quantity:
    """As ``_formed``, of elements of arrays, for which nothing else may know what to do."""
    formed = _formed(operation, *given)
    if formed is NotImplemented:
        wrong = next(one for one in map(_taken, given) if not isinstance(one, (Quantity, numbers.Real)))
        raise TypeError(f"{wrong!r} ({type(wrong).__name__}) is no number, and stands in no formula of quantities")
    return formed


def _formed(operation: str, *given: Any) -> Quantity:
    given = tuple(_taken(one) for one in given)
    if not all(isinstance(one, (Quantity, numbers.Real)) for one in given):
        return cast(Quantity, NotImplemented)
    places = itertools.count()
    # A formula may name an operand twice.
    written = [f"{{{next(places)}}}" if isinstance(one, Quantity) else _number(float(one)) for one in given]
    formula, unit = _OPERATIONS[operation]
    _suit_points(operation, given)
    operands = [one._units if isinstance(one, Quantity) else one for one in given]
    parts = tuple(one for one in given if isinstance(one, Quantity))
    return Quantity(formula.format(*written), parts, unit=unit(*operands))


_OF_POINTS = {"add", "subtract", "maximum", "minimum", "positive", "conjugate"}
"""What can be done with temperatures in °C: what would depend on the zero of the scale cannot."""


def _suit_points(operation: str, given: tuple[Any, ...]) -> None:
    """Refuses what has no meaning for points on a scale, with what there is here in place of the functions of a file."""
    points = [one for one in given if isinstance(one, Quantity) and units.interval(one._units)]
    if not points:
        return
    unit, between = units.written(points[0]._units), units.interval(points[0]._units)
    bare = [float(one) for one in given if not isinstance(one, Quantity)]
    if operation == "add" and len(points) == 2:
        raise ValueError(
            f"two points on the {unit} scale have no sum: their mean is a + (b - a)/2, of many a + sum(x - a for x in all)/len(all); "
            f"what is a difference or a correction has the unit {between}"
        )
    if operation not in _OF_POINTS:
        raise ValueError(
            f"{unit} is a scale with an arbitrary zero, of which there is no {operation}: take x.to('K'), the thermodynamic temperature, "
            f"or the difference from a reference, x - quantity(20, unit='{unit}'), which is in {between}"
        )
    if bare:
        raise ValueError(
            f"{bare[0]:g} has no unit: write quantity({bare[0]:g}, unit='{between}'), a difference, or quantity({bare[0]:g}, unit='{unit}')"
        )


def _refuse_masked(*arrays: Any) -> None:
    if any(np.ma.is_masked(one) for one in arrays):
        raise TypeError("some values are masked, and would be taken for values: take those that are there, x.compressed()")


def _taken(one: Any) -> Any:
    """What arithmetic takes as a quantity or a number: uncertain numbers of other packages, and decimals, too."""
    if isinstance(one, (Quantity, numbers.Real)):
        return one
    return float(one) if isinstance(one, Decimal) else _of_another_package(one) or one


def _of_another_package(number: Any) -> Quantity | None:
    """The quantity of an uncertain number of another package; nothing of anything else."""
    if hasattr(number, "nominal_value"):
        from ._uncertainties import from_uncertainties

        return from_uncertainties(number)
    if type(number).__module__.partition(".")[0] == "GTC":
        from ._gtc import from_gtc

        return from_gtc(number)
    return None


def _number(value: float) -> str:
    if not math.isfinite(value):
        raise ValueError(f"{value} cannot stand in a formula")
    return f"({value!r})"


def _order(quantities: list[Quantity]) -> dict[Quantity, None]:
    """They and what they rest on, each after its parts."""
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
    return order


def _named(quantities: list[Quantity]) -> dict[Quantity, str]:
    """They and what they rest on, each after its parts, with their names in a budget."""
    order = _order(quantities)
    given = Counter(one._name for one in order if one._name)
    for name, count in given.items():
        if count > 1:
            raise ValueError(f"two quantities are called {name}")
    ours = _free("q", given)
    return {one: one._name or next(ours) for one in order}


def _free(prefix: str, taken: Collection[str]) -> Iterator[str]:
    """Names with a number that nothing has."""
    return (name for name in (f"{prefix}{at}" for at in itertools.count(1)) if name not in taken)


def _in_python(refused: Refused) -> Refused:
    """Says beside the words of a file what there is here."""
    if not any(fault.code.startswith("M04") for fault in refused.faults):
        return refused
    also = (
        "The file is what the arithmetic wrote: q1, q2 … are the quantities without a name. In Python 20 'K' is quantity(20, unit='K'), "
        "kelvin(x) is x.to('K'), value_in(x, 'V') is x / quantity(1, unit='V')."
    )
    return Refused(f"{refused}\n{also}\n", refused.faults)


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
    stated = {name: what for one, name, what in known if one in inputs}
    nothing = ""
    if not stated:
        # A budget has an input; what is exact stays so beside one that is multiplied by 0.
        doubt, unit = next(_free("nothing", names.values())), quantities[0]._units
        stated = {doubt: {"value": 0, "u": 1, "unit": units.interval(unit) or units.written(unit)}}
        nothing = f" + 0 * {doubt}"
    taken = names.values()
    outputs = [_output(taken)] if len(quantities) == 1 else _free("y", taken)
    measurands = {
        output: {"model": names[one] + nothing, "unit": units.written(one._units)}
        for output, one in zip(outputs, quantities)
    }
    groups = {id(one._joint): one._joint for one in inputs if one._joint is not None}
    tables = [group.table(inputs) for group in groups.values()]
    parts = {
        "title": "Quantities",
        "model": "\n".join(formulas),
        "measurand": measurands,
        "constant": {name: what for one, name, what in known if one not in inputs},
        "input": stated,
        "joint": [table for table in tables if table is not None],
    }
    return {key: part for key, part in parts.items() if part}
