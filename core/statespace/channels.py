"""Inputs and outputs of a plant as people write them: ``1187:+Z``, ``tip=40:-RX:acc``."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ..arrays import Floats
from ..data.dofs import Dofs
from ..data.frfs import QUANTITIES
from ..errors import InputError
from .statespace_numbers import STATESPACE

Role = Literal["input", "output"]

_WRITTEN = re.compile(
    r"(?:(?P<name>[^=:]*)=)?(?P<sensor>@?)(?P<node>\d+):(?P<sign>[+-]?)(?P<axis>R?[XYZ])"
    r"(?::(?P<quantity>.*))?",
    re.IGNORECASE,
)
_NAME = re.compile(r"[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*", re.ASCII)
_AXES = ("X", "Y", "Z", "RX", "RY", "RZ")
_SHORT = {"disp": 0, "vel": 1, "acc": 2}
_TAKEN = {"time": "the time of simulators", "mode": "what the modes of the plant are called"}
_TURNING = ("rotation", "angularVelocity", "angularAcceleration")


@dataclass(frozen=True)
class Channel:
    """One input or output of a plant.

    Parameters
    ----------
    name : str
        What simulators call it: ``g40.displacement.X``, or what the user says.
    node, component : int
        1, 2, 3 along, 4, 5, 6 about the basic axes.
    sign : float
        +1 or -1.
    role : {"input", "output"}
    quantity : int
        Of an output: how often displacement is differentiated by time.
    sensor : bool
        `node` is one of the test, whose own direction counts.
    """

    name: str
    node: int
    component: int
    sign: float
    role: Role
    quantity: int = 0
    sensor: bool = False

    @property
    def turns(self) -> bool:
        """Whether it is a moment or a rotation."""
        return self.component > 3

    @property
    def unit(self) -> str:
        """SI unit: N, N.m, m, rad/s2 and so on."""
        if self.role == "input":
            return "N.m" if self.turns else "N"
        return ("rad" if self.turns else "m") + ("", "/s", "/s2")[self.quantity]

    @property
    def direction(self) -> Floats:
        """Unit vector in the basic frame, (3,)."""
        axis = np.zeros(3)
        axis[(self.component - 1) % 3] = self.sign
        return axis

    @property
    def said(self) -> str:
        """As it was written: ``1187:+Z``."""
        sign = "-" if self.sign < 0.0 else "+"
        return f"{'@' * self.sensor}{self.node}:{sign}{_AXES[self.component - 1]}"


def read_channels(given: str | Sequence[str], role: Role) -> tuple[Channel, ...]:
    """Return the inputs or outputs that a text with commas, or a sequence of texts, names.

    Parameters
    ----------
    given : str or sequence of str
        ``[NAME=]GRID:DIRECTION[:QUANTITY]``, DIRECTION one of X, Y, Z, RX, RY, RZ with a sign,
        QUANTITY of an output ``disp`` (default), ``vel`` or ``acc``; ``@NODE`` is a sensor of the
        test.
    role : {"input", "output"}

    Raises
    ------
    InputError
        None at all, one that cannot be read, names that collide.
    """
    if not isinstance(given, str | Sequence):
        raise InputError(f'the {role}s are {given!r}; write them as in "1187:+Z,1187:RZ"')
    every = given.split(",") if isinstance(given, str) else list(given)
    texts = [str(t).strip() for t in every if str(t).strip()]
    if not texts:
        raise InputError(f'no {role} is given; give them as in --{role}s "1187:+Z,1187:RZ"')
    return tuple(_channel(text, role) for text in texts)


def check_names(channels: Sequence[Channel]) -> None:
    """Refuse channels that simulators could not tell apart.

    Raises
    ------
    InputError
        Two of one name, or one that is taken by the plant.
    """
    seen: dict[str, Channel] = {}
    for c in channels:
        if c.name in seen:
            other = seen[c.name]
            raise InputError(
                f"{other.role} {other.said} and {c.role} {c.said} are both called '{c.name}'; "
                "give one of them another name, as in tip=40:+X"
            )
        if taken := _TAKEN.get(c.name.partition(".")[0]):
            raise InputError(f"{c.role} {c.said} is called '{c.name}', which is {taken}")
        seen[c.name] = c
    for name, c in seen.items():
        parts = name.split(".")
        for owner in (".".join(parts[:k]) for k in range(1, len(parts))):
            if owner in seen:
                raise InputError(
                    f"{c.role} {c.said} is called '{name}' and {seen[owner].role} "
                    f"{seen[owner].said} '{owner}', of which it would be a part"
                )


def _channel(text: str, role: Role) -> Channel:
    found = _WRITTEN.fullmatch(text)
    if found is None:
        raise InputError(f"{role} '{text}' cannot be read; write it as 1187:+Z, 40:RX or 40:-X:acc")
    quantity, said = 0, (found["quantity"] or "").lower()
    if found["quantity"] is not None:
        if role == "input":
            raise InputError(f"input '{text}' has a quantity; inputs are forces and moments")
        if said not in (*_SHORT, *QUANTITIES):
            raise InputError(
                f"output '{text}': '{found['quantity']}' is no quantity; give disp, vel or acc, "
                "which come in SI units, or in those of the deck with units='deck'"
            )
        quantity = _SHORT[said] if said in _SHORT else QUANTITIES.index(said)
    component = 1 + _AXES.index(found["axis"].upper())
    if found["sensor"] and role == "input":
        raise InputError(f"input '{text}' is a sensor of the test; give a grid of the model")
    channel = Channel(
        found["name"] or "",
        int(found["node"]),
        component,
        -1.0 if found["sign"] == "-" else 1.0,
        role,
        quantity,
        bool(found["sensor"]),
    )
    if found["name"] is None:
        return _renamed(channel, _own_name(channel))
    if not _NAME.fullmatch(found["name"].strip()):
        raise InputError(
            f"{role} '{text}': '{found['name']}' is no name; use letters, digits, _ and dots"
        )
    return _renamed(channel, found["name"].strip())


def _renamed(c: Channel, name: str) -> Channel:
    return Channel(name, c.node, c.component, c.sign, c.role, c.quantity, c.sensor)


def _own_name(c: Channel) -> str:
    if c.role == "input":
        what = "moment" if c.turns else "force"
    else:
        what = (_TURNING if c.turns else QUANTITIES)[c.quantity]
    axis = ("minus" if c.sign < 0.0 else "") + _AXES[c.component - 1]
    return f"{'s' if c.sensor else 'g'}{c.node}.{what}.{axis}"


def rows_of(channels: Sequence[Channel], dofs: Dofs, owner: str) -> Floats:
    """Return what reads the channels from displacements of all `dofs`, (n, n_dof).

    The transpose turns forces of inputs into forces on the degrees of freedom. Nodes may have
    axes of their own and fewer than three.

    Raises
    ------
    InputError
        A node that is not there, or has no motion in the direction.
    """
    rows = np.zeros((len(channels), len(dofs)))
    for row, c in zip(rows, channels, strict=True):
        at = np.flatnonzero(dofs.node == c.node)
        if not len(at):
            raise InputError(f"{c.role} {c.said}: {owner} has no grid {c.node}")
        at = at[(dofs.component[at] > 3) == c.turns]
        axes = dofs.axis[at]
        weights = np.linalg.lstsq(axes.T, c.direction, rcond=None)[0] if len(at) else np.zeros(0)
        if not len(at) or not np.allclose(axes.T @ weights, c.direction, atol=STATESPACE.aligned):
            what = "rotation" if c.turns else "motion"
            raise InputError(
                f"{c.role} {c.said}: {owner} knows no {what} of {c.node} in that direction"
            )
        row[at] = weights
    return rows


def refuse_fixed(
    channels: Sequence[Channel], moving: Floats, why: str, rounding: float = 0.0
) -> None:
    """Refuse channels at places that cannot move.

    Parameters
    ----------
    moving : (n, m) float
        What each channel reads of all motions that there are.
    rounding : float
        Up to which it is nothing.

    Raises
    ------
    InputError
        An input or output that reads nothing at all.
    """
    for c, row in zip(channels, moving, strict=True):
        if not np.any(np.abs(row) > rounding):
            raise InputError(f"{c.role} {c.said} is fixed: {why}")
