"""``trueup demo [NAME]``."""

from __future__ import annotations


def demo() -> None:
    """Run an example study from end to end."""
