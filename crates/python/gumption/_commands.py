"""One function for each command."""

from __future__ import annotations

import datetime
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal, Union, overload

from . import _engine, _table
from ._faults import typed
from ._given import Contents, Given, Whole, flag, several, sheet, source, whole
from ._result import Language, Result
from ._table import Table

Progress = Union[Callable[[float], Any], None]
"""Called now and then with how far the work has come; what it raises ends the work, as an interrupt does."""

Recordings = Union[str, "os.PathLike[str]", Sequence[Union[str, "os.PathLike[str]"]], Mapping[str, _table.Given]]
"""Files or folders; or names with what they stand for."""


def evaluate(
    budget: Given,
    *,
    files: Contents | None = None,
    profile: str | None = None,
    trials: Whole | Literal["adaptive"] | None = None,
    seed: Whole | None = None,
    monte_carlo: bool = True,
    quasi_random: bool = False,
    indices: bool = False,
    threads: Whole | None = None,
    progress: Progress = None,
    language: Language = "en",
) -> Result:
    """Evaluates a budget by the GUM and by Monte Carlo.

    What is not given is as the file says. ``trials="adaptive"`` runs until two digits of u are stable (JCGM 101, 7.9);
    ``quasi_random`` takes scrambled Sobol' points; ``indices`` adds Sobol' sensitivity indices. The same seed gives the
    same bits on any number of threads. ``progress`` is told the number of trials.

    Raises ``Refused`` with all faults of a file, ``NoResult`` where the model has no value.
    """
    wanted = settings(profile, monte_carlo, trials, seed, quasi_random, indices, threads)
    with typed():
        return Result(_engine.evaluate(source(budget, files), wanted, progress, language), language)


def settings(
    profile: str | None,
    monte_carlo: bool,
    trials: Whole | Literal["adaptive"] | None,
    seed: Whole | None,
    quasi_random: bool,
    indices: bool,
    threads: Whole | None,
) -> dict[str, Any]:
    """What the engine is asked for in place of what a file says."""
    if isinstance(trials, str) and trials != "adaptive":
        raise ValueError(f"trials: a whole number or 'adaptive' is needed, not {trials!r}")
    if profile is not None and not isinstance(profile, str):
        raise TypeError(f"profile: the name of one is needed, not {profile!r}")
    wanted = {"trials": trials, "seed": seed, "quasi_random": quasi_random or None, "indices": indices or None}
    idle = [name for name, one in wanted.items() if one is not None]
    if idle and not flag("monte_carlo", monte_carlo):
        raise ValueError(f"{', '.join(idle)}: of use with monte_carlo=True only")
    return {
        "profile": profile,
        "monte_carlo": flag("monte_carlo", monte_carlo),
        "trials": 0 if trials == "adaptive" else _optional("trials", trials, 1000, 10**12),
        "seed": _optional("seed", seed),
        "quasi_random": flag("quasi_random", quasi_random),
        "indices": flag("indices", indices),
        "threads": _optional("threads", threads, 1),
    }


def _optional(name: str, given: Any, *limits: int) -> int | None:
    """A whole number, where one is given."""
    return None if given is None else whole(name, given, *limits)


@overload
def calibrate(experiment: Given, *, files: Contents | None = None, language: Language = "en") -> Result: ...


@overload
def calibrate(
    experiment: Given,
    *,
    recordings: Recordings,
    shares: bool = False,
    files: Contents | None = None,
    progress: Progress = None,
    language: Language = "en",
) -> Table: ...


def calibrate(
    experiment: Given,
    *,
    recordings: Recordings | None = None,
    shares: bool = False,
    files: Contents | None = None,
    progress: Progress = None,
    language: Language = "en",
) -> Result | Table:
    """Finds the coefficients of an experiment with their covariance.

    ``result.files()`` has a budget of the coefficients, which ``evaluate`` takes.

    With ``recordings`` each of them takes the place of that of the experiment: files, or folders of CSV files; or a ``dict`` of
    names with files, texts, frames or columns, and then the experiment finds no other files than those of ``files``. What is
    given then is a table with a line for each: coefficients with u, ν, k and U, the scatter of the residuals, with ``shares``
    the share of each cause in u², and an ``error`` for a recording that gives none, which stops nothing. ``progress`` is told
    the share that is done.
    """
    if recordings is None:
        idle = {"shares": shares or None, "progress": progress}
        if told := [name for name, one in idle.items() if one is not None]:
            raise ValueError(f"{', '.join(told)}: of use with recordings only")
        with typed():
            return Result(_engine.calibrate(source(experiment, files), language), language)
    if isinstance(recordings, Mapping):
        texts, faulty = _recordings(recordings)
        listed = [(name, f"recordings/{name}.csv") for name in texts]
        at_hand: dict[str | os.PathLike[str], str | bytes] = {path: texts[name] for name, path in listed}
        place = source(experiment, {**(files or {}), **at_hand})
    else:
        faulty, given = {}, [recordings] if isinstance(recordings, (str, os.PathLike)) else list(recordings)
        if hasattr(recordings, "columns") or not all(isinstance(one, (str, os.PathLike)) for one in given):
            raise TypeError('recordings: files or folders, or a dict of names with frames, such as {"17": frame}')
        if any("\n" in os.fspath(one) for one in given):
            raise ValueError('recordings: a text has a name, {"17": text}')
        listed = _engine.recordings_of(given, language)
        place = source(experiment, files)
        if place["files"] is not None:
            place["files"] += [(os.fspath(path), Path(path).read_bytes()) for _, path in listed]
    with typed():
        text, _ = _engine.calibrate_each(place, listed, shares, progress, language)
    table = _table.read(text, ("label", "findings", "error"))
    if not faulty or not isinstance(recordings, Mapping):
        return table
    return _table.with_faulty(table, [str(name) for name in recordings], faulty)


def _recordings(given: Mapping[Any, _table.Given]) -> tuple[dict[str, str | bytes], dict[str, str]]:
    """The texts of recordings, and why others have none, by their names."""
    texts: dict[str, str | bytes] = {}
    faulty = {}
    for name, one in given.items():
        try:
            texts[str(name)] = _recording(one)
        except (ValueError, OSError) as why:
            faulty[str(name)] = str(why)
    return texts, faulty


def _recording(given: _table.Given) -> str | bytes:
    """The text of a recording."""
    if isinstance(given, (str, bytes)) and not given:
        raise ValueError("it is empty: a recording has a line of names and rows of numbers")
    if isinstance(given, bytes) or (isinstance(given, str) and "\n" in given):
        return given
    return Path(given).read_bytes() if isinstance(given, (str, os.PathLike)) else _table.written(given)


def fleet(
    results: _table.Given,
    *,
    by: str | Sequence[str] = (),
    date: str | None = None,
    device: str | None = None,
    reference: str | Sequence[str] = (),
    threads: Whole | None = None,
    language: Language = "en",
) -> Result:
    """Says what many results say together: scatter against u, E_n, drift between calibrations, what dominates.

    ``results`` is what ``batch`` gives, or ``calibrate`` of many recordings; a frame or columns with such names; or a CSV file.
    Rows are grouped ``by`` columns, such as type or laboratory; ``date`` is the column of the dates of calibration, ``device``
    the one that names the devices (``label``, where nothing is said), ``reference`` the one of reference values, ``X`` or
    ``y=X``. ``result.groups`` and ``result["y"]`` have the figures, ``result.table()`` those of each group.
    """
    for name, one in (("date", date), ("device", device)):
        if one is not None and not isinstance(one, str):
            raise TypeError(f"{name}: the name of a column is needed, not {one!r}")
    wanted = {
        "by": several("by", by),
        "date": date,
        "device": device,
        "references": several("reference", reference),
        "threads": _optional("threads", threads, 1),
    }
    with typed():
        return Result(_engine.fleet(_table.given(results), wanted, language), language)


def plan(
    experiment: Given,
    *,
    files: Contents | None = None,
    progress: Progress = None,
    language: Language = "en",
) -> Result:
    """Says what an experiment would tell, before anything is measured. ``progress`` is told the share that is done."""
    with typed():
        return Result(_engine.plan(source(experiment, files), progress, language), language)


def diagnose(
    experiment: Given,
    *,
    files: Contents | None = None,
    seed: Whole | None = None,
    why: str | Sequence[str] = (),
    progress: Progress = None,
    language: Language = "en",
) -> Result:
    """Holds a recording against its declared model, and says what was left out.

    ``why`` is an effect, by its identifier or words of its name, several of them, or ``"all"``: the result then says why these are
    not the answer.
    ``progress`` is told the share that is done; ``result.files()`` has the improved experiment.
    """
    with typed():
        wanted = _optional("seed", seed), several("why", why)
        return Result(_engine.diagnose(source(experiment, files), *wanted, progress, language), language)


def simulate(
    experiment: Given, *, files: Contents | None = None, seed: Whole = 1, language: Language = "en"
) -> str:
    """The recording that an experiment predicts, as CSV."""
    with typed():
        return _engine.simulate(source(experiment, files), whole("seed", seed), language)


def verify(
    *budgets: Given, files: Contents | None = None, progress: Progress = None, language: Language = "en"
) -> Result:
    """Holds budgets with claims against their claimed figures; without any, the published examples of the library.

    ``progress`` is told the number of trials.
    """
    today = datetime.date.today().isoformat()
    sources = [source(budget, files) for budget in budgets]
    return Result(_engine.verify(sources, today, progress), language)


def audit(
    claimed: str | os.PathLike[str] | bytes, *, name: str = "sheet.csv", language: Language = "en"
) -> Result:
    """Recomputes the claimed budgets of a spreadsheet, and names the slip behind their figures.

    ``claimed`` is a path, or the content of a file whose kind the ending of ``name`` tells.
    """
    with typed():
        return Result(_engine.audit(sheet(claimed, name), language), language)
