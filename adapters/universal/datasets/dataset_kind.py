"""What a kind of dataset declares, what its reader adds to, and what its writer prints."""

from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeVar

from ....core.arrays import Floats
from ....core.data.frfs import Frfs
from ....core.data.geometry import Geometry
from ....core.data.modes import Modes
from ....core.errors import InputError
from ..container import Section
from ..open_file import Source
from ..systems import CoordinateSystem
from ..universal_content import Dataset, Function, Skipped, Units, UniversalContent

Noun = TypeVar("Noun")


@dataclass(frozen=True)
class Selection:
    """Which mode shapes (counted from 1) and reference nodes are wanted; None: all."""

    modes: Collection[int] | None = None
    references: Collection[int] | None = None


@dataclass
class Gathered:
    """What has been read so far, file by file; a reader adds the nouns it makes."""

    wanted: Selection = Selection()
    n_shape: int = 0
    nouns: dict[type, list[Any]] = field(default_factory=lambda: defaultdict(list))
    systems: dict[int, CoordinateSystem] = field(default_factory=dict)
    systems_of: dict[str, dict[int, CoordinateSystem]] = field(default_factory=dict)
    datasets: list[Dataset] = field(default_factory=list)
    skipped: list[Skipped] = field(default_factory=list)
    failed: list[InputError] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)

    def add(self, *nouns: object) -> None:
        """Keep nouns in file order.

        Those of a type that trueup does not join into geometry, modes, responses or units stand
        in `UniversalContent.extensions`.
        """
        for noun in nouns:
            self.nouns[type(noun)].append(noun)

    def of(self, kind: type[Noun]) -> list[Noun]:
        """Return what was added of one type."""
        return self.nouns[kind]

    def next_shape_is_wanted(self) -> bool:
        """Count one more mode shape; whether it was asked for."""
        self.n_shape += 1
        return self.wanted.modes is None or self.n_shape in self.wanted.modes


@dataclass(frozen=True, eq=False)
class Outgoing:
    """What is to be written, and how; `systems` are displacement axes (3, 3) by node."""

    name: str
    description: str = ""
    geometry: Geometry | None = None
    modes: Modes | None = None
    frfs: Frfs | None = None
    functions: tuple[Function, ...] = ()
    units: Units | None = None
    extensions: tuple[object, ...] = ()
    systems: Mapping[int, Floats] = field(default_factory=dict)
    binary: bool = False
    single: bool = False
    node_dataset: int = 2411

    def of(self, kind: type[Noun]) -> tuple[Noun, ...]:
        """Return the extensions of one type."""
        return tuple(e for e in self.extensions if isinstance(e, kind))


@dataclass(frozen=True)
class DatasetKind:
    """A kind of dataset of universal files.

    Parameters
    ----------
    number : int
        As it stands in the line after the opening -1.
    name : str
        What `inspect` and messages call it.
    read : callable
        ``read(source, section, into)`` reads one dataset, adds what it makes to `into`
        (`Gathered.add`) and returns how many nodes, points, rows ... it holds. `Source.lines`
        gives its lines; `Source.error` makes the error that names file and line.
    tell : callable, optional
        ``tell(content)`` returns the entries of ``contents`` by which `inspect` describes it.
    write : callable, optional
        ``write(out)`` gives the datasets to print, each made by `printing.dataset`.
    vital : bool
        A file in which one cannot be read is no sound test.
    tells_own_end : bool
        Whether the reader itself knows if a dataset without closing -1 is whole.
    """

    number: int
    name: str
    read: Callable[[Source, Section, Gathered], int]
    tell: Callable[[UniversalContent], dict[str, Any]] = lambda content: {}
    write: Callable[[Outgoing], Iterable[bytes]] = lambda out: ()
    vital: bool = False
    tells_own_end: bool = False
