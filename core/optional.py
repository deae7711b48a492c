"""Packages that are used where they are installed."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from .errors import InputError


def optional(package: str, extra: str) -> Any:
    """Import a package (or a module of it) that trueup can do without.

    Raises
    ------
    InputError
        It is not installed: which extra of trueup brings it.
    """
    try:
        return import_module(package)
    except ImportError as error:
        name = package.partition(".")[0]
        raise InputError(
            f"{name} is not installed: install it, or trueup with it: pip install 'trueup[{extra}]'"
        ) from error
