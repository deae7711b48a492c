"""Correlate Nastran models with modal tests, update them, and find what they lack.

The verbs of the command line as functions on neutral objects, and the nouns they work on; each is
imported when it is first used::

    import trueup

    deck = trueup.read_deck("duct.bdf")
    model = trueup.build_model(deck, [trueup.parse_parameter("PBAR 11 I1, PBAR 11 I2")])
    modes = trueup.modes_of(model, trueup.solve(model, n_modes=40))
    placed = trueup.place_test(model.geometry, modes, trueup.read_test(["duct_test.unv"]), "mm")
    found = trueup.compare(model.geometry, modes, placed)
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .adapters.nastran import (
        Deck,
        build_model,
        parse_parameter,
        read_deck,
        read_deck_text,
        read_modes,
        set_values,
        unified_diff,
        write_deck,
    )
    from .adapters.store import read_store, write_store
    from .adapters.universal import read_test, read_universal, write_universal
    from .core.alignment import Alignment, align
    from .core.comparison import Comparison, Placed, compare, place_test
    from .core.correlate import Correlation, Criteria, Pair, correlate
    from .core.discovery.discover import Request, discover
    from .core.dofs import Dofs
    from .core.eigen import Eigensolution, modes_of, solve
    from .core.errors import CheckError, InputError, TrueupError
    from .core.frfs import Frfs
    from .core.geometry import Geometry
    from .core.identification.identify import identify
    from .core.measurement import Measurement
    from .core.model import Model
    from .core.modes import Modes
    from .core.observation import Observation, observe
    from .core.parameter import Parameter
    from .core.residuals import Weights
    from .core.updating import Stage, Target, Updated, update

__version__ = "0.1.0"

_HOME = {
    ".adapters.nastran": (
        "Deck",
        "build_model",
        "parse_parameter",
        "read_deck",
        "read_deck_text",
        "read_modes",
        "set_values",
        "unified_diff",
        "write_deck",
    ),
    ".adapters.store": ("read_store", "write_store"),
    ".adapters.universal": ("read_test", "read_universal", "write_universal"),
    ".core.alignment": ("Alignment", "align"),
    ".core.comparison": ("Comparison", "Placed", "compare", "place_test"),
    ".core.correlate": ("Correlation", "Criteria", "Pair", "correlate"),
    ".core.discovery.discover": ("Request", "discover"),
    ".core.dofs": ("Dofs",),
    ".core.eigen": ("Eigensolution", "modes_of", "solve"),
    ".core.errors": ("CheckError", "InputError", "TrueupError"),
    ".core.frfs": ("Frfs",),
    ".core.geometry": ("Geometry",),
    ".core.identification.identify": ("identify",),
    ".core.measurement": ("Measurement",),
    ".core.model": ("Model",),
    ".core.modes": ("Modes",),
    ".core.observation": ("Observation", "observe"),
    ".core.parameter": ("Parameter",),
    ".core.residuals": ("Weights",),
    ".core.updating": ("Stage", "Target", "Updated", "update"),
}
_MODULE = {name: module for module, names in _HOME.items() for name in names}

__all__ = [
    "Alignment",
    "CheckError",
    "Comparison",
    "Correlation",
    "Criteria",
    "Deck",
    "Dofs",
    "Eigensolution",
    "Frfs",
    "Geometry",
    "InputError",
    "Measurement",
    "Model",
    "Modes",
    "Observation",
    "Pair",
    "Parameter",
    "Placed",
    "Request",
    "Stage",
    "Target",
    "TrueupError",
    "Updated",
    "Weights",
    "align",
    "build_model",
    "compare",
    "correlate",
    "discover",
    "identify",
    "modes_of",
    "observe",
    "parse_parameter",
    "place_test",
    "read_deck",
    "read_deck_text",
    "read_modes",
    "read_store",
    "read_test",
    "read_universal",
    "set_values",
    "solve",
    "unified_diff",
    "update",
    "write_deck",
    "write_store",
    "write_universal",
]


def __getattr__(name: str) -> Any:
    if name not in _MODULE:
        raise AttributeError(f"module 'trueup' has no attribute '{name}'")
    value = getattr(import_module(_MODULE[name], __name__), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
