"""The self-contained HTML report of a run folder.

`make_report` takes ``result.json`` as it is written (schemas ``trueup/correlate/1``,
``trueup/update/1``, ``trueup/discover/1``). Besides the documented keys it knows, where present:

- ``before`` and ``after`` (each a correlation) of a discovery as of an update;
- ``misfit``: ``{"grids", "values"}`` colours the structure, ``{"sensors": [{"node", "value"}]}``
  the sensors, by size against the largest;
- ``xyz`` and ``axis`` of each of ``alignment.sensors``; ``stage`` of each step of ``history``;
- ``criteria.mac_min`` of a correlation, ruled across the MAC bars;
- ``test_modes`` of a ``gap`` entry, for "20 of 24".
"""

from .headline import headline
from .overlay import Overlay, overlay
from .page import make_report

__all__ = ["Overlay", "headline", "make_report", "overlay"]
