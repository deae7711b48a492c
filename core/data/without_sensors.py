"""A test without some of its sensors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..arrays import Bools
from ..errors import InputError
from .dofs import Dofs
from .measurement import Measurement


def without_sensors(test: Measurement, named: Sequence[str]) -> Measurement:
    """Return a test without the sensors named: ``1112`` a node, ``40:Z`` one direction of it.

    Modes and frequency responses lose them; nodes stay where they are.

    Raises
    ------
    InputError
        A sensor that the test does not have, or none is left.
    """
    if not named:
        return test
    sides = [s for s in (test.modes and test.modes.dofs, test.frfs and test.frfs.responses) if s]
    for name in named:
        if not any(_named(dofs, name).any() for dofs in sides):
            raise InputError(
                f"the test has no sensor {name}; give a node number, or node:direction"
            )
    kept = [~np.any([_named(dofs, name) for name in named], axis=0) for dofs in sides]
    if not all(k.any() for k in kept):
        raise InputError("all sensors of the test are excluded; leave some")
    if test.modes is not None:
        rows, std = np.flatnonzero(kept[0]), test.shape_std
        dofs = test.modes.dofs.take(rows)
        modes = replace(test.modes, shapes=test.modes.shapes[rows], dofs=dofs)
        test = replace(test, modes=modes, shape_std=None if std is None else std[rows])
    if test.frfs is not None:
        test = replace(test, frfs=test.frfs.at(np.flatnonzero(kept[-1])))
    return test


def _named(dofs: Dofs, name: str) -> Bools:
    node, _, direction = name.partition(":")
    of_node = dofs.node == int(node)
    if direction:
        of_node &= np.array([d == direction for d in dofs.directions], bool)
    return np.asarray(of_node)
