"""What a call is given: files in any of the ways in which somebody has them."""

from __future__ import annotations

import math
import numbers
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Union

import numpy as np

from . import _engine

Given = Union[str, "os.PathLike[str]", Mapping[str, Any]]
"""A file: its path, its text (a ``str`` with a line break or an ``=``), or what would stand in it."""

Contents = Mapping[Union[str, "os.PathLike[str]"], Union[str, bytes]]
"""Files that a file names, by their names."""


def source(given: Given, files: Contents | None = None, name: str = "file.toml") -> dict[str, Any]:
    """What the engine takes: a path on the disk, or a name among files in memory."""
    if isinstance(given, Mapping):
        return _in_memory(name, _engine.toml_of(given), files)
    if isinstance(given, str) and ("\n" in given or "=" in given):
        return _in_memory(name, given, files)
    if not isinstance(given, (str, os.PathLike)):
        raise TypeError(f"a file is its path, its text, or a dict of what would stand in it, not {type(given).__name__}")
    if files is None:
        return {"path": os.fspath(given), "files": None}
    path = Path(given)
    return _in_memory(path.name, path.read_bytes(), files)


def sheet(given: str | os.PathLike[str] | bytes, name: str) -> dict[str, Any]:
    """A file that is no TOML: its path, or its content, whose kind the ending of ``name`` tells."""
    if isinstance(given, bytes) or (isinstance(given, str) and "\n" in given):
        return _in_memory(name, given, None)
    if not isinstance(given, (str, os.PathLike)):
        raise TypeError(f"a sheet is its path, its text or its bytes, not {type(given).__name__}")
    return {"path": os.fspath(given), "files": None}


def _in_memory(name: str, content: str | bytes, files: Contents | None) -> dict[str, Any]:
    contents = {name: content, **{os.fspath(one): held for one, held in (files or {}).items()}}
    return {"path": name, "files": [(one, _content(one, given)) for one, given in contents.items()]}


def _content(name: str, given: str | bytes) -> bytes:
    if not isinstance(given, (str, bytes)):
        kind = type(given).__name__
        raise TypeError(f"files: what {name} holds is a text or bytes, not {kind}; of a frame, frame.to_csv(index=False)")
    return given.encode() if isinstance(given, str) else given


def whole(name: str, given: Any, least: int = 0, most: int = 2**64 - 1) -> int:
    """A whole number, whatever its type (``1e6``)."""
    wanted = f"{name}: a whole number from {least} to {most} is needed, not {given!r}"
    is_whole = isinstance(given, numbers.Real) and math.isfinite(given) and given == math.floor(given)
    if not is_whole:
        raise TypeError(wanted)
    count = int(given)
    if not least <= count <= most:
        raise ValueError(wanted)
    return count


def flag(name: str, given: Any) -> bool:
    """Yes or no, and nothing that only counts as one of them."""
    if not isinstance(given, (bool, np.bool_)):
        raise TypeError(f"{name}: True or False is needed, not {given!r}")
    return bool(given)


def several(names: str | Sequence[str]) -> list[str]:
    """One name, or several."""
    return [names] if isinstance(names, str) else list(names)
