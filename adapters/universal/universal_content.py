"""What universal files hold, in neutral words."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.arrays import Floats, Ints, Numbers, hold
from ...core.data.frfs import Frfs
from ...core.data.geometry import Geometry
from ...core.data.modes import Modes
from ...core.noun import Noun
from .systems import CoordinateSystem


@dataclass(frozen=True)
class Skipped:
    """Something in a file that was not read: what, where and why.

    `harm` is "" for what trueup does not read by design, "lost" for damaged content that the rest
    does without (a function, elements, a header), and "test" where the rest is no sound test
    without it (a mode, positions, axes, units).
    """

    what: str
    line: int
    why: str
    path: str = ""
    harm: str = ""

    def __str__(self) -> str:
        return f"{self.path} line {self.line}: {self.what} was not read: {self.why}"


@dataclass(frozen=True)
class Dataset:
    """One dataset of a file as an inventory shows it; `count` is of nodes, points, lines, ..."""

    number: int
    line: int
    what: str
    count: int
    path: str = ""


@dataclass(frozen=True)
class Header:
    """Dataset 151 or 2400: where the file comes from."""

    name: str
    description: str
    program: str
    created: str


@dataclass(frozen=True)
class Units:
    """Dataset 164: a value in the file divided by its factor is in SI.

    `length_unit` is "m", "mm", "in" or "ft" where the factor says so, else None.
    """

    code: int
    name: str
    length_factor: float
    force_factor: float = 1.0
    temperature_factor: float = 1.0
    temperature_offset: float = 273.15
    length_unit: str | None = None


@dataclass(frozen=True, eq=False)
class Trace(Noun):
    """Dataset 82: a line drawn through nodes; 0 lifts the pen."""

    number: int
    name: str
    color: int
    nodes: Ints


@dataclass(frozen=True, eq=False)
class Function(Noun):
    """A function of dataset 58 that is not part of the frequency responses (or stands alone).

    Parameters
    ----------
    kind : str
        What dataset 58 calls it: "time response", "auto spectrum", "coherence", ...
    abscissa, values : (n,) float; (n,) float or complex
        Frequencies [Hz] or times [s] as `abscissa_unit` says, and the ordinates as in the file.
    response, reference : (int, int)
        Node and signed direction (+-1..3 translation, +-4..6 rotation, 0 unknown or scalar).
    quantity, per, over : str
        What ordinate, denominator and abscissa are, as dataset 58 calls them.
    ids : tuple of str
        The five text lines.
    codes : (4,) int
        Numbers of `kind`, `over`, `quantity` and `per` in the file, for words of no known number.
    """

    kind: str
    abscissa: Floats
    values: Numbers
    response: tuple[int, int]
    reference: tuple[int, int]
    quantity: str = "unknown"
    per: str = "unknown"
    over: str = "unknown"
    abscissa_unit: str = ""
    ordinate_unit: str = ""
    ids: tuple[str, ...] = ()
    line: int = 0
    path: str = ""
    codes: tuple[int, ...] = (0, 0, 0, 0)

    def __post_init__(self) -> None:
        hold(self, "abscissa", np.float64)
        hold(self, "values")


@dataclass(frozen=True, eq=False)
class UniversalContent(Noun):
    """Everything that one or several universal files hold, merged.

    Parameters
    ----------
    files : tuple of str
        The files, in the order given.
    geometry : Geometry or None
        Nodes (15, 2411) in the basic frame; elements from 2412, and `line` from 82 and 2412.
    modes : Modes or None
        Datasets 55 and 2414, one row for each value of a node, unmeasured (zero) ones included;
        axes turned to the basic frame.
    frfs : Frfs or None
        Frequency responses of dataset 58 and 58b that share one frequency axis.
    functions : tuple of Function
        The other functions of dataset 58 and 58b: time records, coherences, spectra, ...
    units : Units or None
        Dataset 164.
    headers, systems, traces, datasets, skipped, warnings
        Datasets 151, 18 and 2420, 82; the inventory; what was not read and why.
    extensions : tuple
        What datasets registered from outside hold, as their readers made it, in file order.
    """

    files: tuple[str, ...] = ()
    geometry: Geometry | None = None
    modes: Modes | None = None
    frfs: Frfs | None = None
    functions: tuple[Function, ...] = ()
    units: Units | None = None
    headers: tuple[Header, ...] = ()
    systems: Mapping[int, CoordinateSystem] = ()  # type: ignore[assignment]
    traces: tuple[Trace, ...] = ()
    datasets: tuple[Dataset, ...] = ()
    skipped: tuple[Skipped, ...] = ()
    warnings: tuple[str, ...] = ()
    extensions: tuple[Any, ...] = ()

    @property
    def length_unit(self) -> str | None:
        """Unit of positions and displacements: "m", "mm", "in", "ft" or None (not known)."""
        return self.units.length_unit if self.units else None
