"""What a store holds."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from ...core.data.dofs import Dofs
from ...core.data.frfs import Frfs
from ...core.data.geometry import Geometry
from ...core.data.modes import Modes
from ...core.noun import Noun

FORMAT, VERSION = "trueup", 1
FUNCTION_TEXTS = ("function", "quantity", "per", "over", "abscissa_unit", "ordinate_unit")

Matrix: TypeAlias = npt.NDArray[Any] | sp.csr_matrix
Record: TypeAlias = Mapping[str, Any]


@dataclass(frozen=True, eq=False)
class StoreContent(Noun):
    """Everything a store holds, by name.

    `geometry` is the analysis model's, `test_geometry` the test's, each in its own frame and
    length unit. `mac` maps a name (``mac``, ``mac_rotated``) to ``{"test", "analysis",
    "values"}`` as in result.json. `matrices` are arrays or CSR matrices, `matrix_names` what
    those are called at their source that go by another name here. `pairs` and `history` are rows
    as in result.json. `functions` maps a name to a measured function of any kind:
    ``abscissa``, ``values`` and what they are (``function``, ``response``, ``reference``,
    ``quantity``, ``per``, ``over``, ``abscissa_unit``, ``ordinate_unit``, ``ids``,
    ``codes``).
    """

    geometry: Geometry | None = None
    test_geometry: Geometry | None = None
    modes: dict[str, Modes] = field(default_factory=dict)
    frfs: dict[str, Frfs] = field(default_factory=dict)
    dofs: dict[str, Dofs] = field(default_factory=dict)
    mac: dict[str, dict[str, npt.NDArray[np.float64]]] = field(default_factory=dict)
    matrices: dict[str, Matrix] = field(default_factory=dict)
    matrix_names: dict[str, str] = field(default_factory=dict)
    functions: dict[str, Record] = field(default_factory=dict)
    pairs: Sequence[Record] = ()
    history: Sequence[Record] = ()
