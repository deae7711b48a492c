"""The variables of a unit, in the order of their value references (see ``kernel/plant.h``)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...core.arrays import Floats
from ...core.statespace.channels import Channel
from ...core.statespace.modal_plant import ModalPlant


@dataclass(frozen=True)
class Variable:
    """A real variable of a unit.

    Parameters
    ----------
    name, causality, variability, description : str
    unit : str or None
    start, nominal : float or None
    state : int or None
        Of a derivative: the value reference of its state.
    """

    name: str
    causality: str
    variability: str
    description: str
    unit: str | None = None
    start: float | None = None
    nominal: float | None = None
    state: int | None = None

    @property
    def initial(self) -> str | None:
        """How its value at the start comes about; None of inputs, of which it is plain."""
        if self.causality in ("input", "independent"):
            return None
        return "calculated" if self.start is None else "exact"


_LENGTH, _MASS, _TIME, _ANGLE = {"m": 1}, {"kg": 1}, {"s": 1}, {"rad": 1}
UNITS = {
    "s": _TIME,
    "m": _LENGTH,
    "m/s": {**_LENGTH, "s": -1},
    "m/s2": {**_LENGTH, "s": -2},
    "rad": _ANGLE,
    "rad/s": {**_ANGLE, "s": -1},
    "rad/s2": {**_ANGLE, "s": -2},
    "N": {**_MASS, **_LENGTH, "s": -2},
    "N.m": {**_MASS, "m": 2, "s": -2},
    "Hz": {"s": -1},
    "1": {},
}
"""Exponents of the base units of every unit that a plant has."""


def nominals(plant: ModalPlant) -> Floats:
    """Return the size of each state under forces of one, (2 n_mode,)."""
    w = 2.0 * np.pi * plant.frequencies_hz
    push = np.abs(plant.drive).max(axis=1, initial=0.0)
    push = np.where(push > 0.0, push, 1.0)
    q = push / np.where(w > 0.0, w**2, 1.0)
    return np.column_stack([q, q * np.where(w > 0.0, w, 1.0)]).ravel()


def variables(plant: ModalPlant) -> list[Variable]:
    """Return the variables of a plant; a value reference is a position in this list."""
    return [
        *(_channel(c, plant.si) for c in (*plant.inputs, *plant.outputs)),
        *_modes(plant),
        Variable("time", "independent", "continuous", "simulation time", "s"),
    ]


def _channel(c: Channel, si: bool) -> Variable:
    unit = c.unit if si else None
    at = f"{'sensor' if c.sensor else 'grid'} {c.said.lstrip('@')}"
    what = c.name if c.name.count(".") != 2 else c.name.split(".")[1]
    if c.role == "input":
        return Variable(c.name, "input", "continuous", f"{what} on {at}", unit, start=0.0)
    return Variable(c.name, "output", "continuous", f"{what} of {at}", unit)


def _modes(plant: ModalPlant) -> Iterator[Variable]:
    first, n = len(plant.inputs) + len(plant.outputs), len(plant)
    size, left = nominals(plant), n - plant.residual_modes
    units = ("m", "m/s", "m/s2") if plant.si else (None, None, None)
    told = [f"mode {k + 1}" if k < left else f"residual mode {k + 1}" for k in range(n)]
    for k, name in enumerate(plant.state_names):
        what = f"{'velocity' if k % 2 else 'displacement'} of {told[k // 2]}, modal mass 1"
        yield Variable(name, "local", "continuous", what, units[k % 2], 0.0, float(size[k]))
    for k, name in enumerate(plant.state_names):
        what = f"{'acceleration' if k % 2 else 'velocity'} of {told[k // 2]}"
        unit = units[1 + k % 2]
        yield Variable(f"der({name})", "local", "continuous", what, unit, state=first + k)
    for word, values, unit in (
        ("frequency", plant.frequencies_hz, "Hz"),
        ("damping", plant.damping, "1"),
    ):
        what = "undamped natural frequency" if unit == "Hz" else "fraction of critical damping"
        for k, value in enumerate(values):
            name = f"mode[{k + 1}].{word}"
            yield Variable(name, "parameter", "tunable", f"{what} of {told[k]}", unit, float(value))


def dependencies(plant: ModalPlant) -> Iterator[tuple[int, list[int]]]:
    """Yield the value references of outputs, then derivatives, and of what each depends on."""
    nu, ny = len(plant.inputs), len(plant.outputs)
    state = nu + ny
    driven = plant.drive != 0.0
    for i, quantity in enumerate(plant.quantity):
        seen = np.flatnonzero(plant.sense[i])
        q, v = state + 2 * seen, state + 2 * seen + 1
        by = [[q], [v], [np.flatnonzero(driven[seen].any(axis=0)), q, v]][quantity]
        yield nu + i, np.sort(np.concatenate(by)).tolist()
    for k in range(len(plant)):
        of, slope = state + 2 * k, state + 2 * (len(plant) + k)
        yield slope, [of + 1]
        yield slope + 1, [*np.flatnonzero(driven[k]).tolist(), of, of + 1]
