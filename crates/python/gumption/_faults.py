"""What is wrong in a user's file."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass

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

    def __init__(self, drawn: str, faults: list[Fault]):
        super().__init__(drawn)
        self.faults = faults


@contextmanager
def as_faults():
    """Turns the refusal of the engine into one with typed faults."""
    try:
        yield
    except _engine.Refused as refused:
        drawn, faults = refused.args
        raise Refused(drawn, [Fault(**fault) for fault in faults]) from None
