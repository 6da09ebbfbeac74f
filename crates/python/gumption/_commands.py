"""One function for each command."""

from __future__ import annotations

import datetime
from collections.abc import Callable
from typing import Any, Literal, Union

from . import _engine
from ._faults import typed
from ._given import Contents, Given, sheet, source
from ._result import Language, Result

Progress = Union[Callable[[float], Any], None]
"""Called now and then with how far the work has come; what it raises ends the work, as an interrupt does."""


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
    trials: int | Literal["adaptive"] | None,
    seed: int | None,
    quasi_random: bool,
    indices: bool,
    threads: int | None,
) -> dict[str, Any]:
    """What the engine is asked for in place of what a file says."""
    if trials is not None and trials != "adaptive" and trials < 1000:
        raise ValueError("trials: 1000 at least, or 'adaptive'")
    return {
        "profile": profile,
        "monte_carlo": monte_carlo,
        "trials": 0 if trials == "adaptive" else trials,
        "seed": seed,
        "quasi_random": quasi_random,
        "indices": indices,
        "threads": threads,
    }


def calibrate(experiment: Given, *, files: Contents | None = None, language: Language = "en") -> Result:
    """Finds the coefficients of an experiment with their covariance.

    ``result.files()`` has a budget of the coefficients, which ``evaluate`` takes.
    """
    with typed():
        return Result(_engine.calibrate(source(experiment, files), language), language)


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
    seed: int | None = None,
    progress: Progress = None,
    language: Language = "en",
) -> Result:
    """Holds a recording against its declared model, and says what was left out.

    ``progress`` is told the share that is done; ``result.files()`` has the improved experiment.
    """
    with typed():
        return Result(_engine.diagnose(source(experiment, files), seed, progress, language), language)


def simulate(
    experiment: Given, *, files: Contents | None = None, seed: int = 1, language: Language = "en"
) -> str:
    """The recording that an experiment predicts, as CSV."""
    with typed():
        return _engine.simulate(source(experiment, files), seed, language)


def verify(
    *budgets: Given, files: Contents | None = None, progress: Progress = None, language: Language = "en"
) -> Result:
    """Holds budgets with claims against their claimed figures; without any, the published examples of the library.

    ``progress`` is told the number of trials.
    """
    today = datetime.date.today().isoformat()
    sources = [source(budget, files) for budget in budgets]
    return Result(_engine.verify(sources, today, progress), language)


def audit(claimed: Given | bytes, *, name: str = "sheet.csv", language: Language = "en") -> Result:
    """Recomputes the claimed budgets of a spreadsheet, and names the slip behind their figures.

    ``claimed`` is a path, or the content of a file whose kind the ending of ``name`` tells.
    """
    with typed():
        return Result(_engine.audit(sheet(claimed, name), language), language)
