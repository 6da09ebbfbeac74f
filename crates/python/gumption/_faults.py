"""Why there is no result."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from . import _engine


@dataclass(frozen=True)
class Fault:
    """One fault of a file, and how to mend it."""

    code: str
    """Stable; ``gumption explain CODE`` says more."""
    message: str
    expected: str
    """What was expected at the place."""
    mend: str | None
    file: str
    line: int
    """From 1."""
    column: int
    """In characters, from 1."""


class Refused(ValueError):
    """A file with faults; its text shows each under the lines of the file."""

    faults: list[Fault]
    """All of them."""

    def __init__(self, drawn: str, faults: list[Fault]):
        super().__init__(drawn)
        self.faults = faults

    def __reduce__(self) -> tuple[Any, ...]:
        # Comes back from another process as it was raised there.
        return type(self), (str(self), self.faults)


class NoResult(ValueError):
    """A file that is right, and has no result."""

    code: str | None
    """Stable, where the reason has one; ``gumption explain CODE`` says more."""

    def __init__(self, why: str, code: str | None):
        super().__init__(why)
        self.code = code

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.code)


@contextmanager
def typed() -> Iterator[None]:
    """Turns exceptions of the engine into those above."""
    try:
        yield
    except _engine.Refused as refused:
        drawn, faults = refused.args
        raise Refused(drawn, [Fault(**fault) for fault in faults]) from None
    except _engine.NoResult as no_result:
        raise NoResult(*no_result.args) from None
