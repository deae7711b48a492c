"""Correlate Nastran models with modal tests, update them, and find what they lack.

The verbs of the command line as functions, on files or objects alike, and the nouns they work on;
each is imported when it is first used::

    import trueup

    deck = trueup.read_deck("duct.bdf")
    test = trueup.read_test("duct_test.unv")
    found = trueup.correlate(deck, test, deck_length_unit="mm")
    better = trueup.update(deck, test, ["PBAR 11 I1, PBAR 11 I2"], residuals="frequencies")
    told = trueup.discover(deck, test, deck_length_unit="mm")
    print(told.verdict, told.findings[0].sentence)
    told.deck.write("out/")
    told.save("run/")

What lies below stays open: `trueup.core` for the nouns and the mathematics, `trueup.adapters` for
the formats.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from .core.late_imports import lazy_names
from .core.version import VERSION

if TYPE_CHECKING:
    from .adapters.nastran import Deck as Deck
    from .adapters.universal import ModalTest as ModalTest
    from .core.data.dofs import Dofs as Dofs
    from .core.data.frfs import Frfs as Frfs
    from .core.data.geometry import Geometry as Geometry
    from .core.data.measurement import Measurement as Measurement
    from .core.data.modes import Modes as Modes
    from .core.data.parameter import Parameter as Parameter
    from .core.data.parametric_model import Model as Model
    from .core.errors import (
        CheckError as CheckError,
        InputError as InputError,
        TrueupError as TrueupError,
    )
    from .core.updating.residuals import register_residual as register_residual
    from .verbs.compare import SideBySide as SideBySide, compare as compare
    from .verbs.convert import convert as convert
    from .verbs.correlate import correlate as correlate
    from .verbs.discover import discover as discover
    from .verbs.files.read import read as read
    from .verbs.files.sources import read_deck as read_deck, read_test as read_test
    from .verbs.files.write_fmu import Converted as Converted, write_fmu as write_fmu
    from .verbs.identify import identify as identify
    from .verbs.inspect import Inspected as Inspected, inspect as inspect
    from .verbs.parameters import (
        MovableParameters as MovableParameters,
        parameters as parameters,
    )
    from .verbs.plan import Planned as Planned, plan as plan
    from .verbs.runs.identified import Identified as Identified
    from .verbs.runs.open_run import open_run as open_run
    from .verbs.runs.report import report as report
    from .verbs.runs.run import (
        Correlated as Correlated,
        Discovered as Discovered,
        Updated as Updated,
    )
    from .verbs.runs.solved import Solved as Solved
    from .verbs.runs.together import UpdatedTogether as UpdatedTogether
    from .verbs.solve import solve as solve
    from .verbs.studies.options import (
        CompareOptions as CompareOptions,
        CorrelateOptions as CorrelateOptions,
        DiscoverOptions as DiscoverOptions,
        ParametersOptions as ParametersOptions,
        PlantOptions as PlantOptions,
        UpdateOptions as UpdateOptions,
    )
    from .verbs.studies.study import Study as Study
    from .verbs.update import update as update

__version__ = VERSION

__getattr__, __all__ = lazy_names(
    __name__,
    {
        ".adapters.nastran": "Deck",
        ".adapters.universal": "ModalTest",
        ".core.data.dofs": "Dofs",
        ".core.data.frfs": "Frfs",
        ".core.data.geometry": "Geometry",
        ".core.data.measurement": "Measurement",
        ".core.data.modes": "Modes",
        ".core.data.parameter": "Parameter",
        ".core.data.parametric_model": "Model",
        ".core.errors": "CheckError InputError TrueupError",
        ".core.updating.residuals": "register_residual",
        ".verbs.compare": "SideBySide compare",
        ".verbs.convert": "convert",
        ".verbs.correlate": "correlate",
        ".verbs.discover": "discover",
        ".verbs.identify": "identify",
        ".verbs.inspect": "Inspected inspect",
        ".verbs.runs.open_run": "open_run",
        ".verbs.studies.options": "CompareOptions CorrelateOptions DiscoverOptions "
        "ParametersOptions PlantOptions UpdateOptions",
        ".verbs.parameters": "MovableParameters parameters",
        ".verbs.plan": "Planned plan",
        ".verbs.files.read": "read",
        ".verbs.runs.report": "report",
        ".verbs.runs.run": "Correlated Discovered Updated",
        ".verbs.solve": "solve",
        ".verbs.files.sources": "read_deck read_test",
        ".verbs.studies.study": "Study",
        ".verbs.update": "update",
        ".verbs.runs.identified": "Identified",
        ".verbs.runs.solved": "Solved",
        ".verbs.runs.together": "UpdatedTogether",
        ".verbs.files.write_fmu": "Converted write_fmu",
    },
)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
