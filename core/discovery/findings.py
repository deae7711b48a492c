"""What discovery says."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .faults import Fault

VERDICTS = ("effect", "parameters_only", "test_fault", "no_gap", "undecided")


@dataclass(frozen=True)
class Finding:
    """Something that is missing in the model or wrong in the test.

    Parameters
    ----------
    side : {"model", "test"}
    kind : str
        One of the fixed words.
    where : dict
        ``grids``, ``elements`` or ``sensors``, ``xyz`` in deck units, ``region`` in words.
    magnitude : dict
    interval : tuple of float
        95 %, of the first magnitude.
    credible_set : tuple of dict
        Places that explain the data about as well: ``grids`` or ``elements``, ``xyz``, ``weight``.
    confidence : float
        0 to 1.
    sentence : str
    """

    side: str
    kind: str
    where: dict[str, Any]
    magnitude: dict[str, Any]
    interval: tuple[float, float] | None
    credible_set: tuple[dict[str, Any], ...]
    confidence: float
    sentence: str


@dataclass(frozen=True)
class Alternative:
    """What else was considered: `where`, and how many times less likely it is, `odds` in words.

    `regions` are the places in words, one a kind.
    """

    kinds: tuple[str, ...]
    places: tuple[tuple[float, ...], ...]
    times_less_likely: float
    where: str
    odds: str
    regions: tuple[str, ...] = ()

    @property
    def sentence(self) -> str:
        """Both in one."""
        return f"{self.where}: {self.odds}"


@dataclass(frozen=True)
class MovedParameter:
    """A known parameter that moved along: its factor, and a standard deviation of the factor."""

    number: int
    factor: float
    standard_error: float
    significant: bool


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
    parameters alone; `posterior` its probability among the hypotheses compared; `foretold` by how
    much the last effect lowers the misfit of what was held out from the search, in units of the
    noise found.
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
    damping: ModalDamping | None = None
    responses: ResponseGap | None = None
