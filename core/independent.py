"""Pieces of work that do not need each other: done here in turn, or by whoever is given instead."""

from collections.abc import Callable, Iterator, Sequence
from typing import Protocol, TypeVar

T = TypeVar("T")
R = TypeVar("R")


class Each(Protocol):
    """Does one piece of work for each item and gives what comes of them, in their order.

    The work is a function of a module, or a `functools.partial` of one, so that it can be sent.
    """

    def __call__(self, work: Callable[[T], R], items: Sequence[T], /) -> Iterator[R]:
        """Give what `work` makes of each item."""


def in_turn(work: Callable[[T], R], items: Sequence[T], /) -> Iterator[R]:
    """Do the pieces one after the other, here."""
    return map(work, items)
