"""What a command found: its figures as attributes, its document in every format."""

from __future__ import annotations

import html
import json
import math
import os
import warnings
from collections.abc import Iterator
from functools import cached_property
from itertools import zip_longest
from typing import Any, Literal

import numpy as np

from ._digits import estimate, figure
from ._engine import Made
from ._faults import typed
from ._given import Given, flag, source, whole
from ._table import Table

Language = Literal["en", "zh"]

Languages = Literal["en", "zh", "both"]
"""Those of a report: ``both`` beside each other."""


class Record:
    """A structure of the machine form (``docs/*.schema.json``): its fields are attributes, its lists of numbers arrays, its matrices of two dimensions.

    Infinity is ``inf``; ``None`` means that there is no such figure.
    """

    __slots__ = ("_fields",)

    def __init__(self, fields: dict[str, Any]):
        self._fields = fields

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return _wrapped(self._fields[name])
        except KeyError:
            kinds = type(self).__mro__
            symbols = [one for kind in kinds for one, held in vars(kind).items() if isinstance(held, property) and one[0] != "_"]
            raise AttributeError(f"there is no {name}; there are {', '.join([*symbols, *self._fields])}") from None

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._fields]

    def to_dict(self) -> dict[str, Any]:
        """The fields as they stand in the JSON."""
        return self._fields

    def __repr__(self) -> str:
        def short(value: Any) -> str:
            return f"<{len(value)} entries>" if isinstance(value, (list, dict)) else repr(value)

        fields = ", ".join(f"{name}={short(value)}" for name, value in self._fields.items())
        return f"{type(self).__name__}({fields})"


class Measurand(Record):
    """A measurand of an evaluated budget: the figures that are reported, by their symbols; all others by their names."""

    __slots__ = ()

    @property
    def y(self) -> float:
        """The estimate."""
        return float(self.reported.estimate)

    @property
    def u(self) -> float | None:
        """The standard uncertainty; ``None`` where the distribution has none."""
        return _figure(self.reported.standard_uncertainty)

    @property
    def nu(self) -> float | None:
        """The degrees of freedom that give k; ``None`` for a k that is fixed."""
        return _figure(self.reported.degrees_of_freedom)

    @property
    def k(self) -> float | None:
        """The coverage factor."""
        return _figure(self.reported.coverage_factor)

    @property
    def U(self) -> float | None:  # noqa: N802 - the symbol of the standard
        """The expanded uncertainty; ``None`` where an interval is reported instead."""
        return _figure(self.reported.expanded_uncertainty)

    @property
    def interval(self) -> tuple[float, float] | None:
        """The coverage interval: y ± U, or that of the Monte Carlo method where it is reported."""
        stated = self.reported.interval
        if stated is not None:
            return (float(stated[0]), float(stated[1]))
        return None if self.U is None else (self.y - self.U, self.y + self.U)

    @property
    def p(self) -> float | None:
        """The coverage probability, where one is claimed."""
        return _figure(self.reported.coverage_probability)

    def __repr__(self) -> str:
        unit = "" if self.unit == "1" else f" {self.unit}"
        figures = {"u": self.u, "k": self.k, "U": self.U}
        shown = [f", {symbol} = {figure(one, 3)}" for symbol, one in figures.items() if one is not None]
        interval = self.interval
        half = None if interval is None else (interval[1] - interval[0]) / 2
        spread = next((one for one in (self.u, self.U, half) if one), None)
        return f"<{self.name} = {estimate(self.y, spread)}{unit}{''.join(shown)}>"


class Row(Record):
    """What was found of one row of a series, or of a file without one."""

    __slots__ = ()

    def __getitem__(self, name: str) -> Any:
        """A measurand of a budget, or a coefficient of a calibration, by its name."""
        named = self._named
        if name not in named:
            raise KeyError(f"there is no {name}; there are {', '.join(named) or 'none'}")
        return _wrapped(named[name])

    def __contains__(self, name: object) -> bool:
        return name in self._named

    @property
    def _named(self) -> dict[str, Any]:
        named = [*(self._fields.get("measurands") or []), *(self._fields.get("coefficients") or [])]
        return {one["name"]: one for one in named}


class SeveralRows(LookupError, AttributeError):
    """One row is asked for, and there are several. What asks for an attribute that may be missing, as ``hasattr`` does, is told that
    it is."""


class Result:
    """What a command found.

    The fields of its machine form are attributes; ``text``, ``to_html`` and the others are its report. Of a budget
    with a series, ``rows`` has the results of all rows.
    """

    def __init__(self, made: Made, language: Language):
        self._made = made
        self._language = language

    @cached_property
    def rows(self) -> list[Row]:
        """The machine form of each row of a series; one of anything else."""
        value = json.loads(self._made.json())
        return [Row(one) for one in (value if isinstance(value, list) else [value])]

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(self._only(), name)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.rows[0].to_dict()]

    def __getitem__(self, name: str) -> Any:
        """A measurand of a budget, or a coefficient of a calibration, by its name."""
        return self._only()[name]

    def __contains__(self, name: object) -> bool:
        """Whether there is a measurand or a coefficient of this name."""
        return name in self.rows[0]

    def _only(self) -> Row:
        if len(self.rows) > 1:
            raise SeveralRows(f"there are {len(self.rows)} rows: take one of `rows`")
        return self.rows[0]

    @property
    def statement(self) -> str:
        """The sentences for the certificate."""
        return "\n".join(self._only().statement.to_dict()[self._language])

    def samples(self, trials: int = 1_000_000, row: int = 0) -> dict[str, np.ndarray]:
        """Values of every measurand in trials of the Monte Carlo method; the n-th of all are of one trial."""
        row = range(len(self.rows))[row]
        samples = self._made.samples(row, whole("trials", trials, 1))
        return dict(zip((one.name for one in self.rows[row].measurands), samples))

    def table(self) -> Table:
        """What is reported of every measurand and row, of every coefficient, or of every group of a fleet, by columns."""
        found = self.rows[0].to_dict()
        if "grouped_by" in found:
            return _of_groups(found)
        if found.get("coefficients"):
            return _of_coefficients(found["coefficients"])
        if "measurands" not in found:
            raise ValueError("evaluated budgets, calibrations and fleets have a table, and nothing else")
        columns = ("label", "measurand", "unit", "y", "u", "nu", "k", "U", "lower", "upper")
        lines = [
            (row.label, one.name, one.unit, one.y, one.u, one.nu, one.k, one.U, *(one.interval or (None, None)))
            for row in self.rows
            for one in row.measurands
        ]
        return _tabulated({column: [line[at] for line in lines] for at, column in enumerate(columns)})

    def to_pandas(self) -> Any:
        """``table`` as a frame of pandas."""
        return self.table().to_pandas()

    def to_polars(self) -> Any:
        """``table`` as a frame of polars."""
        return self.table().to_polars()

    def files(self, language: Language | None = None) -> dict[str, str]:
        """Files that go with the result, by name: a budget of the coefficients, the improved experiment."""
        return dict(self._made.files(language or self._language))

    def render(self, format: str, language: Languages | None = None, width: int = 100) -> bytes:
        """The report in a format of the program: ``text``, ``markdown``, ``html``, ``json`` and whatever else it has."""
        return self._made.render(format, language or self._language, whole("width", width))

    def save(self, path: str | os.PathLike[str], language: Languages | None = None, replace: bool = False) -> None:
        """Writes the report in the format of the ending: ``.html``, ``.xlsx``, ``.md``, ``.json`` …

        A file that is there is replaced if gumption wrote it and nobody changed it since, or with ``replace``; otherwise
        ``FileExistsError``. A file that was read for the result is never overwritten (``OSError``).
        """
        self._made.save(path, language or self._language, flag("replace", replace))

    def text(self, language: Languages | None = None, width: int = 100) -> str:
        """The report as text."""
        return self.render("text", language, width).decode()

    def to_html(self, language: Languages | None = None) -> str:
        """The report as a page that stands alone."""
        return self.render("html", language).decode()

    def to_xlsx(self, language: Languages | None = None) -> bytes:
        """The report as a workbook that calculates."""
        return self.render("xlsx", language)

    def certified(self, certificate: Given) -> Result:
        """The same as a certificate: its reports are headed by number, dates, laboratory, customer and item.

        ``certificate`` is their file (``gumption new --certificate`` writes one to fill in), its text, or a ``dict``.
        """
        with typed():
            made, kept = self._made.certified(source(certificate, name="certificate.toml"), self._language)
        if kept is not None:
            warnings.warn(kept, stacklevel=2)
        return Result(made, self._language)

    def to_dcc(self, certificate: Given | None = None, language: Languages | None = None) -> bytes:
        """The report as a digital calibration certificate (DCC, XML), with these data of a certificate."""
        result = self if certificate is None else self.certified(certificate)
        return result.render("dcc", language)

    def _repr_html_(self) -> str:
        page = html.escape(self.to_html(), quote=True)
        return f'<iframe srcdoc="{page}" style="width:100%;height:32em;border:0" sandbox></iframe>'

    def __copy__(self) -> Result:
        # Nothing in it changes.
        return self

    def __deepcopy__(self, _: Any) -> Result:
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        raise TypeError("a result stays in its process; what can be handed over is its `rows`, `table()` or `text()`")

    def __iter__(self) -> Iterator[Row]:
        return iter(self.rows)

    def __len__(self) -> int:
        return len(self.rows)

    def __str__(self) -> str:
        return self.text()

    def __repr__(self) -> str:
        return f"<gumption {self.rows[0].format}, rows: {len(self.rows)}>"


def _of_coefficients(coefficients: list[dict[str, Any]]) -> Table:
    keys = {"coefficient": "name", "unit": "unit", "value": "value", "u": "u", "nu": "dof", "k": "k", "U": "U"}
    return _tabulated({column: [_wrapped(one[key]) for one in coefficients] for column, key in keys.items()})


def _of_groups(fleet: dict[str, Any]) -> Table:
    """A line for each measurand and group, with every figure that is one number."""
    lines = []
    for measurand in fleet["measurands"]:
        for group, figures in zip(fleet["groups"], measurand["groups"]):
            line = {"measurand": measurand["name"], "unit": measurand["unit"], "rows": group["rows"]}
            # A group of one row has no consistency, and the same columns.
            consistency = figures["consistency"] or {}
            numbers = {name: one for name, one in figures.items() if name != "consistency" and not isinstance(one, (dict, list))}
            line |= {name: _wrapped(one) for name, one in numbers.items()}
            line |= {name: _wrapped(consistency.get(name)) for name in ("birge", "p_value")}
            # A group may be called as a figure is.
            own = [f"{name} (group)" if name in line else name for name in fleet["grouped_by"]]
            lines.append(dict(zip_longest(own, group["key"], fillvalue="")) | line)
    return _tabulated({name: [line[name] for line in lines] for name in (lines[0] if lines else ())})


def _tabulated(columns: dict[str, list[Any]]) -> Table:
    """Numbers as arrays, ``nan`` where there is none."""
    return Table({name: column if _is_of_texts(name, column) else _numbers(column) for name, column in columns.items()})


def _is_of_texts(name: str, column: list[Any]) -> bool:
    return name == "label" or any(not isinstance(one, (int, float, type(None))) for one in column)


def _numbers(column: list[Any]) -> np.ndarray:
    return np.array([math.nan if one is None else one for one in column])


def _figure(value: Any) -> float | None:
    return None if value is None else float(value)


def _wrapped(value: Any) -> Any:
    if value == "inf":
        return math.inf
    if value == "-inf":
        return -math.inf
    if isinstance(value, dict):
        return Measurand(value) if "reported" in value and "gum" in value else Record(value)
    if isinstance(value, list):
        if value and all(isinstance(one, (int, float)) and not isinstance(one, bool) for one in value):
            return np.array(value, dtype=float)
        rows = [_wrapped(one) for one in value]
        shapes = {one.shape if isinstance(one, np.ndarray) else None for one in rows}
        is_matrix = len(shapes) == 1 and None not in shapes
        return np.array(rows) if is_matrix else rows
    return value
