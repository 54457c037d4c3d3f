"""Frameworks that palpate itself does not need, imported where a module of it is for them."""

from __future__ import annotations

from importlib import import_module
from typing import Any


def framework(name: str, package: str, needed_by: str) -> Any:
    """A module, or an error that states which package has it.

    Checkers of types find `palpate.jax` for an ``import jax`` in this folder where jax is not installed.
    """
    try:
        return import_module(name)
    except ImportError as error:
        raise ImportError(f"{needed_by} needs {package}, which is not installed: {error}") from None
