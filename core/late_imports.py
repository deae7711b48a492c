"""Packages that are used where they are installed, names that are imported when first used."""

from collections.abc import Callable, Mapping
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


def lazy_names(package: str, homes: Mapping[str, str]) -> tuple[Callable[[str], object], list[str]]:
    """Return the ``__getattr__`` and the ``__all__`` of a package.

    Parameters
    ----------
    package : str
        Its ``__name__``.
    homes : mapping of str to str
        By module, relative to the package: the names that stand there, separated by blanks.
    """
    home = {name: module for module, names in homes.items() for name in names.split()}

    def attribute(name: str) -> object:
        if name not in home:
            raise AttributeError(f"module '{package}' has no attribute '{name}'")
        return getattr(import_module(home[name], package), name)

    return attribute, sorted(home)
