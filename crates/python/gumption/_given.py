"""What a call is given: files in any of the ways in which somebody has them."""

from __future__ import annotations

import math
import numbers
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Union

import numpy as np

from . import _engine

Given = Union[str, "os.PathLike[str]", Mapping[str, Any]]
"""A file: its path, its text (a ``str`` with a line break or an ``=`` that is no path), or what would stand in it."""

Contents = Mapping[Union[str, "os.PathLike[str]"], Union[str, bytes, "os.PathLike[str]"]]
"""Files that a file names, by their names: their texts, their bytes, or where they are."""

Whole = Union[float, "np.integer[Any]"]
"""A whole number, whatever its type."""

_LONGEST_PATH = 4096
"""Characters of a path: systems take no more."""


def source(given: Given, files: Contents | None = None, name: str = "file.toml") -> dict[str, Any]:
    """What the engine takes: a path on the disk, or a name among files in memory."""
    if isinstance(given, Mapping):
        return _in_memory(name, _engine.toml_of(given), files)
    if isinstance(given, str) and _is_text(given):
        return _in_memory(name, given, files)
    if not isinstance(given, (str, os.PathLike)):
        raise TypeError(f"a file is its path, its text, or a dict of what would stand in it, not {type(given).__name__}")
    if len(place := os.fspath(given)) > _LONGEST_PATH:
        raise ValueError(f"{place[:20]!r}… is no path, being too long, and no text of a file, which has a line break or an =")
    if files is None:
        return _on_disk(given)
    return _in_memory(Path(given).name, Path(given), files)


def _is_text(given: str) -> bool:
    """Whether this is the text of a file. A path may have an ``=``, too: ``year=2026/budget.toml``."""
    is_path = given.lower().endswith(".toml") or os.path.isfile(given)
    return "\n" in given or ("=" in given and not is_path)


def _on_disk(given: str | os.PathLike[str]) -> dict[str, Any]:
    return {"path": os.fspath(given), "files": None, "read": []}


def sheet(given: str | os.PathLike[str] | bytes, name: str) -> dict[str, Any]:
    """A file that is no TOML: its path, or its content, whose kind the ending of ``name`` tells."""
    if isinstance(given, bytes) or (isinstance(given, str) and "\n" in given):
        return _in_memory(name, given, None)
    if not isinstance(given, (str, os.PathLike)):
        raise TypeError(f"a sheet is its path, its text or its bytes, not {type(given).__name__}")
    return _on_disk(given)


def _in_memory(name: str, content: str | bytes | os.PathLike[str], files: Contents | None) -> dict[str, Any]:
    """A file with those that it names, of which what was read from the disk is never overwritten."""
    if not isinstance(files, (Mapping, type(None))):
        raise TypeError(f'files: names with what they hold are needed, such as {{"readings.csv": text}}, not {files!r}')
    contents = {name: content, **{os.fspath(one): held for one, held in (files or {}).items()}}
    read = [os.fspath(held) for held in contents.values() if isinstance(held, os.PathLike)]
    return {"path": name, "files": [(one, _content(one, given)) for one, given in contents.items()], "read": read}


def _content(name: str, given: str | bytes | os.PathLike[str]) -> bytes:
    if isinstance(given, os.PathLike):
        return Path(given).read_bytes()
    if not isinstance(given, (str, bytes)):
        kind = type(given).__name__
        raise TypeError(f"files: what {name} holds is a text, bytes or a path, not {kind}; of a frame, frame.to_csv(index=False)")
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


def several(what: str, names: str | Iterable[str]) -> list[str]:
    """One name, or several."""
    listed = [names] if isinstance(names, str) else list(names) if isinstance(names, Iterable) else [names]
    for one in listed:
        if not isinstance(one, str):
            raise TypeError(f"{what}: a text or a list of texts is needed, not {one!r}")
    return listed
