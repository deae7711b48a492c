"""Time records that stand beside frequency responses."""

from __future__ import annotations

import numpy as np

from ....core.data.dofs import Dofs
from ....core.identification.survey.time_records import TimeRecord
from ..universal_content import UniversalContent


def time_records_of(content: UniversalContent) -> tuple[TimeRecord, ...]:
    """Return the time records (type 1 of dataset 58) of points with a direction."""
    found = []
    for function in content.functions:
        node, direction = function.response
        if function.kind == "time response" and direction and function.over == "time":
            name = Dofs(np.array([node]), np.array([abs(direction)])).labels[0]
            is_force = function.quantity == "force"
            found.append(TimeRecord(name, function.abscissa, function.values.real, is_force))
    return tuple(found)
