"""A figure of matplotlib that leaves the user's own settings and pyplot alone."""

from functools import partial
from io import BytesIO
from typing import Any

from ...core.late_imports import optional

INK, FAINT, MESH = "#333333", "#8a8a8a", "#c8ccd2"


def figure(width: float, height: float) -> Any:
    """Return an empty figure, inches; a notebook shows it as the value of its cell.

    Raises
    ------
    InputError
        matplotlib is not installed.
    """
    made = optional("matplotlib.figure", "plot").Figure((width, height), layout="constrained")
    made._repr_png_ = partial(_png, made)
    return made


def _png(made: Any) -> bytes:
    stream = BytesIO()
    made.savefig(stream, format="png", dpi=110)
    return stream.getvalue()


def quiet(axes: Any) -> None:
    """Leave of the frame only what is read."""
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    for side in ("left", "bottom"):
        axes.spines[side].set_color(FAINT)
    axes.tick_params(colors=INK, labelsize=8)
