"""The residuals that an update may minimise: one declaration a file, one line each in a list."""

from .declaration import (
    Beside,
    DampedPairs,
    Linearisation,
    LoadCase,
    Relation,
    Residual,
    Responses,
    Seen,
    Slopes,
    Target,
)
from .known_residuals import RESIDUALS, Weights, register_residual, residuals_named

__all__ = [
    "RESIDUALS",
    "Beside",
    "DampedPairs",
    "Linearisation",
    "LoadCase",
    "Relation",
    "Residual",
    "Responses",
    "Seen",
    "Slopes",
    "Target",
    "Weights",
    "register_residual",
    "residuals_named",
]
