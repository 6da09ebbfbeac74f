"""What a call is given: files in any of the ways in which somebody has them."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Union

from . import _engine

Given = Union[str, "os.PathLike[str]", Mapping[str, Any]]
"""A file: its path, its text (a ``str`` with a line break or an ``=``), or what would stand in it."""

Contents = Mapping[str, Union[str, bytes]]
"""Files that a file names, by their names."""


def source(given: Given, files: Contents | None = None, name: str = "file.toml") -> dict[str, Any]:
    """What the engine takes: a path on the disk, or a name among files in memory."""
    if isinstance(given, Mapping):
        return _in_memory(name, _engine.toml_of(given), files)
    if isinstance(given, str) and ("\n" in given or "=" in given):
        return _in_memory(name, given, files)
    if files is None:
        return {"path": os.fspath(given), "files": None}
    path = Path(given)
    return _in_memory(path.name, path.read_bytes(), files)


def sheet(given: str | os.PathLike[str] | bytes, name: str) -> dict[str, Any]:
    """A file that is no TOML: its path, or its content, whose kind the ending of ``name`` tells."""
    if isinstance(given, bytes) or (isinstance(given, str) and "\n" in given):
        return _in_memory(name, given, None)
    return {"path": os.fspath(given), "files": None}


def _in_memory(name: str, content: str | bytes, files: Contents | None) -> dict[str, Any]:
    contents = {name: content, **(files or {})}
    as_bytes = [(one, text.encode() if isinstance(text, str) else bytes(text)) for one, text in contents.items()]
    return {"path": name, "files": as_bytes}
