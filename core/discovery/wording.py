"""The sentence a person reads first."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..arrays import Floats
from .candidates import Candidates
from .findings import Alternative
from .story import MassUnit, mode_ranges, odds

_SAYS = {
    "point_mass": "About {mass} of mass is missing {region}: an attached mass",
    "distributed_mass": "About {mass} of mass, spread out, is missing {region}: distributed mass",
    "local_stiffness": "The stiffness is {factor:.2g} times the deck's {region}: a local change of "
    "stiffness",
    "ground_spring": "A spring to ground of about {stiffness:.3g} (deck units) in direction "
    "{components} is missing {region}: it",
    "support_flexibility": "The support gives {region}, direction {components}, with a stiffness "
    "of about {stiffness:.3g} (deck units): it",
    "tuned_absorber": "About {mass} of mass on a spring tuned to "
    "{frequency_hz:.4g} Hz ({frequency_hz_interval[0]:.4g} to {frequency_hz_interval[1]:.4g}) in "
    "direction {components} is missing {region}: an absorber, which adds a "
    "mode,",
    "joint_flexibility": "The joint gives {region} with a rotational stiffness of about "
    "{stiffness:.3g} (deck units): it",
}

_TEST = {
    "sensor_polarity": "Sensor {0} reads with the wrong sign in every mode: it is wired backwards",
    "sensor_gain": "Sensor {0} reads {1:.2f} times what all the others say it should",
    "sensor_swap": "Sensors {0} and {2} are swapped: each reads what the other should",
    "sensor_axis": "Sensor {0} is turned by {1:.0f}° from the axes that the test says",
}
_HARDLY = 20.0
"""Quotient of the ends of an interval from which on a magnitude is hardly known."""


def magnitude_of(
    c: Candidates, row: int, sizes: Floats, intervals: Floats, masses: MassUnit
) -> dict[str, Any]:
    """Return the magnitudes of a finding by the words of the interface.

    Parameters
    ----------
    c : Candidates
    row : int
    sizes : (t,) float
    intervals : (t, 2) float
        95 %; that of the first magnitude stands beside the magnitudes, in the finding.
    masses : MassUnit
        Masses are given as cards have them.
    """
    where, size = c.where[row], float(sizes[0])
    if c.kind == "point_mass":
        return {"mass": size * masses.card}
    if c.kind == "distributed_mass":
        area = c.extra.get("areas")
        mass = size * masses.card
        return {"mass": mass, "mass_per_area": None if area is None else mass / float(area[row])}
    if c.kind == "local_stiffness":
        return {"factor": size}
    if c.kind == "tuned_absorber":
        return {
            "mass": size * masses.card,
            "frequency_hz": float(sizes[1]),
            "frequency_hz_interval": intervals[1].tolist(),
            "components": where["components"],
        }
    free = {"free_components": where["free_components"]} if "free_components" in where else {}
    return {"stiffness": size, "components": where.get("components", []), **free}


def sentence_of(
    kind: str,
    magnitude: dict[str, Any],
    region: str,
    interval: tuple[float, float],
    modes: Sequence[int],
    masses: MassUnit,
    next_best: Alternative | None,
) -> str:
    """Say what is missing, where, which test modes it explains, how sure, and what comes next."""
    values = {**magnitude, "region": region}
    low, high = (f"{v:.3g}" for v in interval)
    if "components" in values:
        values["components"] = "".join(str(k) for k in values["components"])
    if "mass" in values:
        values["mass"] = masses.said(float(magnitude["mass"]))
        low, high = masses.said(interval[0]).split()[0], masses.said(interval[1])
    if "free_components" in values:
        turning = "".join(str(k) for k in values["free_components"])
        values["components"] += f" and freely in direction {turning}"
    text = _SAYS[kind].format(**values)
    what = mode_ranges(modes) if modes else "the test a little better"
    text += f" explains {what} (95 %: {low} to {high}"
    text += ", the test hardly tells)" if interval[1] > _HARDLY * interval[0] else ")"
    if next_best is not None:
        what = " and ".join(k.replace("_", " ") for k in next_best.kinds) or "the known parameters"
        if next_best.kinds == (kind,):
            what = next_best.sentence.partition(":")[0]
            what = f"{kind.replace('_', ' ')} there alone" if what.endswith(region) else what
        text += f"; next best, {what}, is {odds(next_best.times_less_likely)}"
    return text + "."


def test_sentence(kind: str, sensors: list[str], size: float) -> str:
    """Say what is wrong with a sensor: a factor, or an angle [deg]."""
    half = len(sensors) // 2
    first, other = sensors[:half], sensors[half:]
    if kind != "sensor_swap":
        first, other = sensors, []
    return _TEST[kind].format(", ".join(first), size, ", ".join(other)) + "."
