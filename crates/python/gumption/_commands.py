"""One function for each command."""

from __future__ import annotations

import datetime
import json
import os
from collections.abc import Callable, Mapping
from typing import Any, Literal, Union

from . import _engine
from ._faults import as_faults
from ._result import Result

Given = Union[str, os.PathLike, Mapping[str, Any]]
"""A file: its path, its text (a ``str`` with a line break or an ``=``), or what would stand in it."""

Contents = Mapping[str, Union[str, bytes]]
Language = Literal["en", "zh"]


def evaluate(
    budget: Given,
    *,
    files: Contents | None = None,
    profile: str | None = None,
    trials: int | Literal["adaptive"] | None = None,
    seed: int | None = None,
    monte_carlo: bool = True,
    quasi_random: bool = False,
    indices: bool = False,
    threads: int | None = None,
    language: Language = "en",
) -> Result:
    """Evaluates a budget by the GUM and by Monte Carlo.

    What is not given is as the file says. ``trials="adaptive"`` runs until two digits of u are stable (JCGM 101, 7.9);
    ``quasi_random`` takes scrambled Sobol' points; ``indices`` adds Sobol' sensitivity indices. The same seed gives the
    same bits on any number of threads.

    Raises ``Refused`` with all faults of a file, ``NoResult`` where the model has no value.
    """
    if trials is not None and trials != "adaptive" and trials < 1000:
        raise ValueError("trials: 1000 at least, or 'adaptive'")
    settings = {
        "profile": profile,
        "monte_carlo": monte_carlo,
        "trials": 0 if trials == "adaptive" else trials,
        "seed": seed,
        "quasi_random": quasi_random,
        "indices": indices,
        "threads": threads,
    }
    with as_faults():
        return Result(_engine.evaluate(_source(budget, files), settings, language), language)


def calibrate(experiment: Given, *, files: Contents | None = None, language: Language = "en") -> Result:
    """Finds the coefficients of an experiment with their covariance.

    ``result.files()`` has a budget of the coefficients, which ``evaluate`` takes.
    """
    with as_faults():
        return Result(_engine.calibrate(_source(experiment, files), language), language)


def plan(
    experiment: Given,
    *,
    files: Contents | None = None,
    progress: Callable[[float], Any] | None = None,
    language: Language = "en",
) -> Result:
    """Says what an experiment would tell, before anything is measured."""
    with as_faults():
        return Result(_engine.plan(_source(experiment, files), progress, language), language)


def diagnose(
    experiment: Given,
    *,
    files: Contents | None = None,
    seed: int | None = None,
    progress: Callable[[float], Any] | None = None,
    language: Language = "en",
) -> Result:
    """Holds a recording against its declared model, and says what was left out.

    ``progress`` is called with the share that is done; what it raises ends the work, as an interrupt does.
    ``result.files()`` has the improved experiment.
    """
    with as_faults():
        return Result(_engine.diagnose(_source(experiment, files), seed, progress, language), language)


def simulate(
    experiment: Given, *, files: Contents | None = None, seed: int = 1, language: Language = "en"
) -> str:
    """The recording that an experiment predicts, as CSV."""
    with as_faults():
        return _engine.simulate(_source(experiment, files), seed, language)


def verify(*budgets: Given, files: Contents | None = None, language: Language = "en") -> Result:
    """Holds budgets with claims against their claimed figures; without any, the published examples of the library."""
    today = datetime.date.today().isoformat()
    sources = [_source(budget, files) for budget in budgets]
    return Result(_engine.verify(sources, today), language)


def audit(sheet: Given | bytes, *, name: str = "sheet.csv", language: Language = "en") -> Result:
    """Recomputes the claimed budgets of a spreadsheet, and names the slip behind their figures.

    ``sheet`` is a path, or the content of a file whose kind the ending of ``name`` tells.
    """
    if isinstance(sheet, bytes):
        source = {"path": name, "files": [(name, sheet)]}
    elif isinstance(sheet, str) and "\n" in sheet:
        source = {"path": name, "files": [(name, sheet.encode())]}
    else:
        source = {"path": os.fspath(sheet), "files": None}
    return Result(_engine.audit(source), language)


def _source(given: Given, files: Contents | None) -> dict[str, Any]:
    """What the engine takes: a path on the disk, or a name among files in memory."""
    if isinstance(given, Mapping):
        text = _engine.toml_of(json.dumps(given, allow_nan=True))
    elif isinstance(given, str) and ("\n" in given or "=" in given):
        text = given
    elif files is None:
        return {"path": os.fspath(given), "files": None}
    else:
        with open(given, encoding="utf-8") as file:
            text = file.read()
    contents = {"file.toml": text, **(files or {})}
    as_bytes = [(name, one.encode() if isinstance(one, str) else bytes(one)) for name, one in contents.items()]
    return {"path": "file.toml", "files": as_bytes}
