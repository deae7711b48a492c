"""The sentence a person reads first."""

from __future__ import annotations

from typing import Any

from ..arrays import Floats
from .candidates import Candidates
from .findings import Alternative

_SAYS = {
    "point_mass": "About {mass:.3g} of mass (deck units) is missing {region}: an attached mass",
    "distributed_mass": "About {mass:.3g} of mass (deck units), spread out, is missing {region}: "
    "distributed mass",
    "local_stiffness": "The stiffness is {factor:.2g} times the deck's {region}: a local change of "
    "stiffness",
    "ground_spring": "A spring to ground of about {stiffness:.3g} (deck units) in direction "
    "{components} is missing {region}: it",
    "support_flexibility": "The support gives {region}, direction {components}, with a stiffness "
    "of about {stiffness:.3g} (deck units): it",
    "tuned_absorber": "About {mass:.3g} of mass (deck units) on a spring tuned to "
    "{frequency_hz:.4g} Hz in direction {components} is missing {region}: an absorber, which adds "
    "a mode,",
    "joint_flexibility": "The joint gives {region} with a rotational stiffness of about "
    "{stiffness:.3g} (deck units): it",
}

_TEST = {
    "sensor_polarity": "Sensor {0} reads with the wrong sign in every mode: it is wired backwards",
    "sensor_gain": "Sensor {0} reads {1:.2f} times what all the others say it should",
    "sensor_swap": "Sensors {0} and {2} are swapped: each reads what the other should",
    "sensor_axis": "Sensor {0} is turned by {1:.0f}° from the axes that the test says",
}


def magnitude_of(c: Candidates, row: int, sizes: Floats, intervals: Floats) -> dict[str, Any]:
    """Return the magnitudes of a finding by the words of the interface.

    Parameters
    ----------
    c : Candidates
    row : int
    sizes : (t,) float
    intervals : (t, 2) float
        95 %; that of the first magnitude stands beside the magnitudes, in the finding.
    """
    where, size = c.where[row], float(sizes[0])
    if c.kind == "point_mass":
        return {"mass": size}
    if c.kind == "distributed_mass":
        area = c.extra.get("areas")
        per_area = None if area is None else size / float(area[row])
        return {"mass": size, "mass_per_area": per_area}
    if c.kind == "local_stiffness":
        return {"factor": size}
    if c.kind == "tuned_absorber":
        return {
            "mass": size,
            "frequency_hz": float(sizes[1]),
            "frequency_hz_interval": intervals[1].tolist(),
            "components": where["components"],
        }
    return {"stiffness": size, "components": where.get("components", [])}


def sentence_of(
    kind: str,
    magnitude: dict[str, Any],
    region: str,
    interval: tuple[float, float],
    next_best: Alternative | None,
) -> str:
    """Say what is missing, where, how sure, and what comes next."""
    values = {**magnitude, "region": region}
    if "components" in values:
        values["components"] = "".join(str(k) for k in values["components"])
    text = _SAYS[kind].format(**values)
    text += f" explains the measured modes (95 %: {interval[0]:.3g} to {interval[1]:.3g})"
    if next_best is not None:
        what = " and ".join(k.replace("_", " ") for k in next_best.kinds) or "the known parameters"
        text += f"; next best, {what}, is {next_best.times_less_likely:.2g} times less likely"
    return text + "."


def test_sentence(kind: str, sensors: list[str], size: float) -> str:
    """Say what is wrong with a sensor: a factor, or an angle [deg]."""
    half = len(sensors) // 2
    first, other = sensors[:half], sensors[half:]
    if kind != "sensor_swap":
        first, other = sensors, []
    return _TEST[kind].format(", ".join(first), size, ", ".join(other)) + "."
