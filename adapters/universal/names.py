"""What the datasets of universal files are called."""

from __future__ import annotations

_NAMES = {
    15: "nodes",
    18: "coordinate systems",
    55: "data at nodes",
    56: "data at element centres",
    57: "data at nodes on elements",
    58: "function at nodal dof",
    82: "trace lines",
    90: "model lists",
    151: "header",
    152: "optimisation",
    164: "units",
    666: "history",
    735: "nodes on surfaces",
    752: "permanent groups",
    756: "trace lines",
    757: "constraints",
    758: "loads",
    770: "permanent groups",
    772: "permanent groups",
    780: "elements",
    781: "nodes",
    789: "physical properties",
    790: "load sets",
    791: "restraint sets",
    1710: "materials",
    1858: "qualifiers of a function",
    2400: "model header",
    2411: "nodes",
    2412: "elements",
    2414: "analysis data",
    2417: "permanent groups",
    2420: "coordinate systems",
    2429: "permanent groups",
    2430: "permanent groups",
    2432: "permanent groups",
    2435: "permanent groups",
    2437: "physical properties",
    2448: "physical properties",
    2452: "permanent groups",
    2467: "permanent groups",
    2470: "physical properties",
    2477: "permanent groups",
    3033: "tables",
}


def name_of(number: int) -> str:
    """Name of a dataset, or that it is not known."""
    return _NAMES.get(number, "unknown to trueup")
