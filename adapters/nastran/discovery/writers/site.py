"""What a writer of cards works from: a deck and the finding that goes into it."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from .....core.discovery.findings import Finding
from ...deck.read_deck import Deck
from ...editing.add_cards import add_cards
from ...editing.rewrite_fields import Value
from ...properties.grids import Points, read_points
from ...text.deck_text import DeckText

Row = Sequence[Value]
"""Name and data fields of a new card."""


def plain(value: float) -> float:
    """Return a value with as many figures as a field of eight columns shows."""
    return float(f"{value:.6g}")


@dataclass(frozen=True, eq=False)
class Site:
    """A deck as read, and a finding of the model side."""

    deck: Deck
    finding: Finding

    @property
    def grids(self) -> list[int]:
        """Grids of the effect."""
        return list(self.finding.where.grids or ())

    @property
    def elements(self) -> list[int]:
        """Elements of the effect."""
        return list(self.finding.where.elements or ())

    @property
    def components(self) -> list[int]:
        """Directions of the effect."""
        return list(self.finding.magnitude["components"])

    @property
    def arms(self) -> list[tuple[float, ...]]:
        """How far off its grid each place is, none where all are at theirs."""
        return list(self.finding.where.arms or ())

    def total(self, word: str) -> float:
        """Return a magnitude by its word."""
        return float(self.finding.magnitude[word])

    def each(self, word: str) -> float:
        """Return the equal part of a magnitude at each grid."""
        return plain(self.total(word) / len(self.grids))

    @cached_property
    def _points(self) -> Points:
        return read_points(self.deck.bulk)

    def middle(self, grids: Sequence[int]) -> list[float]:
        """Return the mean position of grids, basic frame."""
        xyz = self._points.xyz[np.searchsorted(self._points.ids, grids)]
        return [float(v) for v in xyz.mean(axis=0)]

    def system(self, grid: int) -> int:
        """Return the number of a grid's displacement system, 0 for basic axes."""
        return int(self.deck.bulk.table("GRID")[grid].cd or 0)

    @property
    def note(self) -> str:
        """Comment of the cards."""
        f = self.finding
        said = f"{f.kind.replace('_', ' ')}, confidence {f.confidence:.2f}"
        return f"trueup discover: {said}\n{f.sentence}"

    def added(
        self, text: DeckText, rows: Sequence[Row], grid: int | None = None, more: str = ""
    ) -> DeckText:
        """Return the text with new cards beside a grid, the first of the effect by default."""
        near = self.grids[0] if grid is None else grid
        return add_cards(text, rows, self.note + more, ("GRID", near))


Writer = Callable[[DeckText, Site], DeckText]
"""Returns the text of a deck with an effect as cards; raises InputError where it cannot take it."""


def companion(
    site: Site, grid: int, new: int, number: int, arm: Sequence[float] = (0.0, 0.0, 0.0)
) -> list[list[Any]]:
    """Return the cards of a grid `new` in basic axes, an arm from another that it follows."""
    at = [plain(x + d) for x, d in zip(site.middle([grid]), arm, strict=True)]
    return [["GRID", new, 0, *at, 0], ["RBE2", number, grid, "123456", new]]


def follower(site: Site, grids: Sequence[int], new: int, number: int) -> list[list[Any]]:
    """Return the cards of a grid `new` in the middle of others that moves as these on average."""
    return [
        ["GRID", new, 0, *map(plain, site.middle(grids)), 0],
        ["RBE3", number, None, new, "123456", 1.0, "123456", *grids],
    ]
