"""Equipment: a mass with its centre off the structure, which resists being turned."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from ...arrays import Floats, skew
from ..effects.candidates import Candidates, places_of, together
from ..effects.effect_kind import Words
from ..effects.effect_laws import MassLaw, TunedLaw
from ..effects.effect_numbers import EFFECTS
from .stands import Stand

_PRODUCTS = 2.0 * np.eye(3) - 1.0
"""Signs between a matrix of inertia and products of inertia."""


@dataclass(frozen=True, eq=False)
class Body:
    """A rigid body of unit mass.

    Parameters
    ----------
    offset : (3,) float
        Of its centre from the place, basic axes.
    extent : (3, 3) float
        Symmetric root of the second moments of its mass about its centre, basic axes: how far it
        reaches, in the rms, along each.
    assumed : bool
        Whether the test does not tell it.
    """

    offset: Floats
    extent: Floats
    assumed: bool = False

    @property
    def inertia(self) -> Floats:
        """Moments and products of inertia (3, 3) about its centre, basic axes."""
        second: Floats = self.extent @ self.extent
        return float(np.trace(second)) * np.eye(3) - second


def ball(offset: Floats, radius: float) -> Body:
    """Return a body of the same radius of gyration about any axis."""
    return Body(offset, radius / np.sqrt(2.0) * np.eye(3))


def block(mass: float, density: float) -> Body:
    """Return a solid block, twice as long as wide and high, its radius the rms about its axes."""
    width = (0.5 * mass / density) ** (1.0 / 3.0)
    return replace(ball(np.zeros(3), float(width / np.sqrt(3.0))), assumed=True)


@dataclass(frozen=True, eq=False)
class Equipment(Candidates):
    """Masses at places, each with its body.

    `paid` is what it cost to have had a choice of bodies, ln of a probability.
    """

    bodies: tuple[Body, ...] = ()
    paid: float = 0.0

    def told(self, row: int, words: Words) -> Words:
        """Return offset and moments of inertia, where they are not alike those of a CONM2."""
        body = self.bodies[row]
        about = words["mass"] * body.inertia
        said: Words = {"offset": body.offset.tolist()} if body.offset.any() else {}
        said["inertia"] = float(np.trace(about)) / 3.0
        if not np.allclose(body.extent, body.extent[0, 0] * np.eye(3)):
            said["inertias"] = (about * _PRODUCTS)[np.tril_indices(3)].tolist()
        if body.assumed:
            said["inertia_assumed"] = True
        return said


def equipment(
    template: Candidates,
    alike: Sequence[Stand],
    bodies: Sequence[Body],
    mount: float | None = None,
    paid: float = 0.0,
) -> Candidates:
    """Return candidates of masses with each of the bodies, at all the places together.

    Rigidly, or each on a mount of a known ln f, alike in all directions and turns.
    """
    each = [(s, _turned(s, b)) for b in bodies for s in alike]
    held = np.array([] if mount is None else [mount])
    anywhere = np.full(1, np.inf)
    single = Equipment(
        kind=template.kind,
        xyz=np.array([s.xyz for s, _ in each]),
        law=MassLaw() if mount is None else TunedLaw(np.zeros((len(each), 1)), 0.0),
        trials=np.hstack([template.trials[:, :1], np.tile(held, (len(template.trials), 1))]),
        root=sp.vstack([_rows(s, b) for s, b in each]).tocsr(),
        rows_each=6,
        where=tuple(s.where for s, _ in each),
        typical=np.append(template.typical[:1], held),
        spread=np.append(template.spread[:1], np.full(len(held), EFFECTS.held)),
        steps=np.ones(1 + len(held)),
        lower=np.append(-anywhere, held),
        upper=np.append(anywhere, held),
        bodies=tuple(b for _, b in each),
        paid=paid,
    )
    if len(alike) == 1:
        return single
    return together(single, np.arange(len(each)).reshape(len(bodies), len(alike)), template.maps)


def grown(c: Candidates, row: int) -> Equipment | None:
    """Return one of some candidates with a body that the test told, None if it is no such."""
    own, first = places_of(c, row)[0]
    return own if isinstance(own, Equipment) and not own.bodies[first].assumed else None


def _turned(s: Stand, b: Body) -> Body:
    return replace(b, offset=s.turn @ b.offset, extent=s.turn @ b.extent @ s.turn.T)


def _rows(s: Stand, b: Body) -> sp.csr_matrix:
    """Root of the mass matrix of unit mass: motion of the centre, and what resists turns."""
    off = np.hstack([np.eye(3), -skew(b.offset)])
    squares, axes = np.linalg.eigh(b.inertia)
    turns = np.hstack([np.zeros((3, 3)), np.sqrt(squares.clip(0.0))[:, None] * axes.T])
    return sp.csr_matrix(np.concatenate([off, turns])) @ s.motion
