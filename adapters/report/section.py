"""A section of the page."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Section:
    """A heading, where links lead, and the markup under it."""

    heading: str
    anchor: str
    body: str
