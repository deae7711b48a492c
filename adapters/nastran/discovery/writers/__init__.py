"""The writers of cards: one module a kind of effect, one list."""

from collections.abc import Callable

from .....core.errors import InputError, require_kind
from . import (
    distributed_mass,
    ground_spring,
    joint_flexibility,
    link_spring,
    local_damper,
    local_stiffness,
    point_mass,
    support_flexibility,
    tuned_absorber,
)
from .site import Site as Site, Writer

WRITERS: dict[str, Writer] = {
    "point_mass": point_mass.write,
    "distributed_mass": distributed_mass.write,
    "local_stiffness": local_stiffness.write,
    "ground_spring": ground_spring.write,
    "support_flexibility": support_flexibility.write,
    "joint_flexibility": joint_flexibility.write,
    "tuned_absorber": tuned_absorber.write,
    "local_damper": local_damper.write,
    "link_spring": link_spring.write,
}


def register_writer(kind: str, writer: Writer) -> None:
    """Write a further kind of effect into decks; ``del WRITERS[kind]`` undoes it.

    Raises
    ------
    InputError
        A kind that has a writer.
    """
    require_kind(kind, str, "the kind of effect")
    require_kind(writer, Callable, "the writer")  # type: ignore[arg-type]
    if kind in WRITERS:
        raise InputError(f"there is a writer of {kind} already")
    WRITERS[kind] = writer


def writer_of(kind: str) -> Writer:
    """Return the writer of a kind of effect.

    Raises
    ------
    InputError
        It has none.
    """
    if kind not in WRITERS:
        raise InputError(f"no cards can be written for {kind}: register_writer gives it a writer")
    return WRITERS[kind]
