"""The one exception family of trueup."""

from __future__ import annotations


class TrueupError(Exception):
    """Base of everything trueup raises on purpose; the message is one sentence for the user."""


class InputError(TrueupError):
    """The input is at fault: which file, line or card, what is wrong, what to do."""


class CheckError(TrueupError):
    """The work ended without meeting its own check (for example, a mode was missed)."""
