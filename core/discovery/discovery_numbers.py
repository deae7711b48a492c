"""The tuned numbers of what leads from evidence to verdict."""

from dataclasses import dataclass

from ..number_table import number


@dataclass(frozen=True)
class DiscoveryNumbers:
    mesh_bounds: tuple[float, float] = number((-1.0, 1.05), "-", "between which the error of the mesh lies: 0 lumped mass, 1 consistent")
    modes: int = number(110, "modes", "on which known parameters are fitted, at most", "time")
    small_modes: int = number(80, "modes", "on which suspects are fitted, at most", "time")
    band: float = number(1.15, "of the highest test frequency", "up to which a mode may match")
    band_more: int = number(4, "modes", "above these that may")
    steps: int = number(30, "steps", "for the known parameters and the error of the mesh, at most")
    dashpot_turns: int = number(3, "turns", "of a heavy dashpot and the known parameters, at most", "time")
    modes_held: tuple[int, int] = number((4, 6), "modes", "first that is held out, and every how many after it")
    modes_enough: int = number(10, "modes", "from so many on")
    sensors_held: tuple[int, int] = number((5, 10), "sensors", "first that is held out, and every how many after it")
    sensors_enough: int = number(30, "sensors", "from so many on")


DISCOVERY = DiscoveryNumbers()
