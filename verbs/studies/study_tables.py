"""The tables of a study file: stages, load cases, configurations."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from ...core.errors import InputError

_FOLDER = re.compile(r"\w[\w .+-]*")


@dataclass(frozen=True)
class StageRequest:
    """One ``[[stages]]`` table of a study: parameters move on the named residuals."""

    parameters: tuple[str, ...] = ()
    residuals: str = "both"
    max_iterations: int = 10


@dataclass(frozen=True)
class LoadRequest:
    """One ``[[load_cases]]`` table: forces as "1187:-Z=100", what was read as "40:+Z=-1.25"."""

    loads: tuple[str, ...] = ()
    readings: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for said in ("loads", "readings"):
            if not getattr(self, said):
                raise InputError(f"a load case says no {said}; give some, as in '1187:-Z=100'")
            for text in getattr(self, said):
                value_at(text)


@dataclass(frozen=True)
class ConfigurationRequest:
    """One ``[[configurations]]`` table: the deck and the test of one state of the structure.

    `name` is that of its folder (default: the deck's), `parameters` are moved besides the study's;
    whatever else is left out is as in the study.
    """

    name: str = ""
    deck: Path | None = None
    test: tuple[Path, ...] = ()
    parameters: tuple[str, ...] = ()
    deck_length_unit: str | None = None
    fmin: float | None = None
    fmax: float | None = None
    test_modes: tuple[int, ...] = ()
    exclude_test: tuple[int, ...] = ()
    exclude_analysis: tuple[int, ...] = ()
    exclude_sensors: tuple[str, ...] = ()
    pairs: tuple[tuple[int, int], ...] = ()
    mode_weights: tuple[tuple[int, float], ...] = ()
    node_map: tuple[tuple[int, int], ...] = ()
    measured_mass: float | None = None
    measured_centre_of_gravity: tuple[float, ...] = ()
    load_cases: tuple[LoadRequest, ...] = ()

    def __post_init__(self) -> None:
        if self.deck is None or not self.test:
            which = f"configuration '{self.name}'" if self.name else "a configuration"
            raise InputError(f"{which} names no {'test' if self.deck else 'deck'}; give both")
        object.__setattr__(self, "name", self.name or self.deck.stem)
        if not _FOLDER.fullmatch(self.name) or self.name in ("tables", "deck"):
            raise InputError(
                f"a configuration is called '{self.name}', which cannot be that of its folder; "
                "use letters, digits, spaces and '-'"
            )


def value_at(text: str) -> tuple[str, float]:
    """Return the place and the value of "1187:-Z=100".

    Raises
    ------
    InputError
        It is none.
    """
    place, _, value = text.rpartition("=")
    try:
        return place, float(value)
    except ValueError:
        raise InputError(f"'{text}' cannot be read; write it as in '1187:-Z=100'") from None
