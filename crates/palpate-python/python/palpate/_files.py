"""Files of records, as Python names them: paths, bytes, and objects that are read."""

from __future__ import annotations

import os
from collections.abc import Mapping
from inspect import iscoroutinefunction
from pathlib import PurePath
from typing import Any

from palpate._palpate import OptionError


def record_file(given: Any, name: str | None = None) -> tuple[str | os.PathLike[str], bytes | None]:
    """A file of records as a path, or as a name and bytes: those of an object that is read, from where it stands."""
    if isinstance(given, (bytes, bytearray, memoryview)):
        return name or "bytes", bytes(given)
    # Some files that are read have a path too, and up to Python 3.12 a path can be entered.
    if isinstance(given, (str, PurePath)) or not (hasattr(given, "read") or hasattr(given, "__enter__")):
        if not isinstance(given, (str, os.PathLike)):
            found = type(given).__name__
            raise OptionError(f"expected a path, bytes or an object with read(), found {found}\nhint: give the bytes of the file, and name=")
        if name is not None:
            raise OptionError("name: expected bytes or an object with read() beside it, found a path\nhint: remove name")
        return given, None
    # An asynchronous upload has the file that it spools to.
    file = getattr(given, "file", given) if iscoroutinefunction(getattr(given, "read", None)) else given
    if hasattr(file, "read"):
        content = file.read()
    else:
        with file as opened:
            content = opened.read()
    if isinstance(content, str):
        content = content.encode()
    if not isinstance(content, (bytes, bytearray, memoryview)):
        raise OptionError(f"expected read() to give bytes, found {type(content).__name__}\nhint: open the file with mode \"rb\"")
    # The name of a form's field is no name of a file: that one is called filename.
    names = (getattr(given, attribute, None) for attribute in ("filename", "name", "full_name", "path"))
    own = next((str(own) for own in names if isinstance(own, (str, os.PathLike)) and str(own)), type(given).__name__)
    return name or own, bytes(content)


def record_files(given: Any) -> list[tuple[str | os.PathLike[str], bytes | None]]:
    """Several files of records: paths, bytes and objects, or a mapping from their names."""
    if isinstance(given, Mapping):
        return [record_file(one, str(name)) for name, one in given.items()]
    if isinstance(given, (str, bytes, bytearray, memoryview)) or not hasattr(given, "__iter__") or hasattr(given, "read"):
        raise OptionError("paths: expected a list of files, found one\nhint: put it into a list")
    return [record_file(one) for one in given]
