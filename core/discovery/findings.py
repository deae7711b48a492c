"""What discovery says."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Self

from ..arrays import Floats
from ..noun import BESIDE, OPTIONAL, Noun
from .faults import Fault

VERDICTS = ("effect", "parameters_only", "test_fault", "no_gap", "undecided")
ADOPTED = ("effect", "parameters_only", "test_fault")
"""Verdicts by which the deck takes what was found, parameters that are significant included."""


@dataclass(frozen=True, kw_only=True)
class Where(Noun):
    """Where something is: what is there, `xyz` in deck units, `region` in words.

    A place that explains the data about as well has the `kind` that would explain them there, and
    `weight`, its share of the probability. Of what joins two places `ends` are the grids that each
    of them follows, several where it is between grids.
    Of a place that one grid carries at a distance `arms` holds how far off that grid it is, (3,).
    Of equipment on one grid of a sheet, the first of `grids`, `normal` is that of the sheet, about
    which it turns as all the grids do.
    """

    grids: tuple[int, ...] | None = field(default=None, metadata=OPTIONAL)
    elements: tuple[int, ...] | None = field(default=None, metadata=OPTIONAL)
    sensors: tuple[int, ...] | None = field(default=None, metadata=OPTIONAL)
    ends: tuple[tuple[int, ...], ...] | None = field(default=None, metadata=OPTIONAL)
    arms: tuple[tuple[float, ...], ...] | None = field(default=None, metadata=OPTIONAL)
    normal: tuple[float, ...] | None = field(default=None, metadata=OPTIONAL)
    shares: tuple[float, ...] | None = field(default=None, metadata=OPTIONAL)
    radius: float | None = field(default=None, metadata=OPTIONAL)
    components: tuple[int, ...] | None = field(default=None, metadata=OPTIONAL)
    free_components: tuple[int, ...] | None = field(default=None, metadata=OPTIONAL)
    xyz: tuple[float, ...]
    region: str | None = field(default=None, metadata=OPTIONAL)
    directions: tuple[str, ...] | None = field(default=None, metadata=OPTIONAL)
    weight: float | None = field(default=None, metadata=OPTIONAL)
    kind: str | None = field(default=None, metadata=OPTIONAL)

    @classmethod
    def of(cls, place: Mapping[str, Sequence[Any]], xyz: Floats, **more: Any) -> Self:
        """Return a place as candidates describe it: see `Candidates.where`."""
        named: dict[str, Any] = {
            k: tuple(v) if isinstance(v, Sequence) else v for k, v in place.items()
        }
        return cls(**named, xyz=tuple(xyz.tolist()), **more)


@dataclass(frozen=True)
class Finding(Noun):
    """Something that is missing in the model or wrong in the test.

    `side` is ``model`` or ``test``; `magnitude` holds the words of its kind; `interval` is that of
    the first, 95 %; `credible_set` are places that explain the data about as well; `confidence` is
    from 0 to 1; `cards` stand as written to the deck.
    """

    side: str
    kind: str
    where: Where
    magnitude: dict[str, Any]
    interval: tuple[float, float] | None
    credible_set: tuple[Where, ...]
    confidence: float
    cards: tuple[str, ...] = field(default=(), kw_only=True)
    sentence: str


@dataclass(frozen=True)
class Alternative(Noun):
    """What else was considered: `where`, how many times less likely it is, and `odds` in words.

    `sentence` is both in one; `xyz` and `regions` are the places, one a kind.
    """

    kinds: tuple[str, ...]
    xyz: tuple[tuple[float, ...], ...]
    times_less_likely: float
    sentence: str
    where: str = ""
    odds: str = ""
    regions: tuple[str, ...] = field(default=(), metadata=BESIDE)


@dataclass(frozen=True)
class MovedParameter:
    """A known parameter that moved along: its factor, and a standard deviation of the factor.

    Of a significant one both hold with those at the deck's values that are not; `together` is the
    factor where all move. `written` is the one that the completed deck takes.
    """

    number: int
    factor: float
    standard_error: float
    significant: bool
    together: float
    written: float = 1.0


@dataclass(frozen=True)
class ModalDamping:
    """Damping ratios that the structure has by itself, by test mode.

    `without` as the measured ones say if there is no dashpot but the deck's own, `beside` the one
    that was found.
    """

    without: tuple[float, ...]
    beside: tuple[float, ...]


@dataclass(frozen=True)
class ResponseGap:
    """How well measured frequency responses are met.

    `sensors` and `references` as ``node:direction``; `before` and `after` the frequency response
    assurance of each sensor, mean over the references, of the deck as it is and with what was
    found, each with frequencies of its own and measured damping; `log_misfit` the rms log ratio
    of magnitudes before, with the known parameters moved, and after, modes turned onto the
    measured ones at their frequencies; `independent` of `lines` count.
    """

    sensors: tuple[str, ...]
    references: tuple[str, ...]
    lines: int
    independent: float
    before: tuple[float, ...]
    after: tuple[float, ...]
    log_misfit: tuple[float, float, float]


@dataclass(frozen=True)
class Discovery:
    """The verdict with everything that led to it.

    `evidence_for` is twice the log of how much more likely the verdict is than the known
    parameters alone; `posterior` its probability among the hypotheses compared, times the share of
    frozen cases in which an answer like it was right; `foretold` by how many standard deviations
    modes held out agree that it foretells them better than these.
    By `mesh`, relative, the deck's mesh makes frequencies too low on average, which no parameter
    makes up for. `looks_like` names an error of the model without a place that would explain what
    is left, where one does. `proposal` says that the effects explain much and foretell, but leave
    more than right models do: the verdict is ``undecided``, and the deck is completed by them all
    the same.
    """

    verdict: str
    findings: tuple[Finding, ...]
    alternatives: tuple[Alternative, ...]
    parameters: tuple[MovedParameter, ...]
    noise_scale: float
    evidence_for: float
    posterior: float
    foretold: float
    held_out_modes: tuple[int, ...]
    held_out_sensors: tuple[int, ...]
    corrected_sensors: tuple[Fault, ...]
    would_decide: tuple[str, ...]
    warnings: tuple[str, ...]
    error: float = 0.0
    error_alone: float = 0.0
    gain: float = 0.0
    adequacy: float = 1.0
    unexplained: tuple[int, ...] = ()
    proposal: bool = False
    mesh: float = 0.0
    looks_like: str = ""
    damping: ModalDamping | None = None
    responses: ResponseGap | None = None

    @property
    def completes(self) -> bool:
        """Whether the deck is completed by the effects that were found."""
        return self.verdict == "effect" or self.proposal

    @property
    def adopted(self) -> bool:
        """Whether the deck is changed at all."""
        return self.completes or self.verdict in ADOPTED
