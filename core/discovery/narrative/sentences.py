"""The sentence a person reads first, and places in words."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...arrays import Floats
from ...data.geometry import Geometry
from ...data.mass_unit import MassUnit
from ..effects import KINDS
from ..effects.candidates import Candidates
from ..effects.effect_kind import EffectKind
from ..effects.effect_numbers import EFFECTS
from ..effects.sentence_parts import listed, mode_ranges, odds
from ..findings import Alternative
from .narrative_numbers import NARRATIVE


def alternative(
    kinds: tuple[str, ...],
    places: Sequence[Floats],
    ratio: float,
    where: str,
    regions: tuple[str, ...] = (),
    other: str = "",
    most: float = EFFECTS.odds_most,
) -> Alternative:
    """Return what is `ratio` times less likely than what was found, or than some `other`.

    In words no more than `most` times.
    """
    xyz, said = tuple(tuple(x.tolist()) for x in places), odds(ratio, other, most)
    return Alternative(kinds, xyz, ratio, f"{where}: {said}", where, said, regions)


def effects_said(kinds: Sequence[str], regions: Sequence[str]) -> str:
    """Say what is where: ``a spring to ground near grid 7 (x = 1)``.

    Effects of one kind together, and several places without their coordinates: ``two attached
    masses, near grid 8 and near grid 9``, a place that several have once.
    """
    if len(regions) > 1:
        regions = [r.split(" (")[0] for r in regions]
    at = {kind: [r for k, r in zip(kinds, regions, strict=True) if k == kind] for kind in kinds}
    comma = "," if len(kinds) > len(at) else ""
    said = []
    for kind, own in at.items():
        where = listed(list(dict.fromkeys(own)))
        said.append(f"{_kind(kind, len(own))}{',' if len(own) > 1 else ''} {where}".rstrip())
    return f"{comma} and ".join(said)


def _kind(name: str, number: int) -> str:
    known = KINDS.get(name)
    return known.said(number) if known else f"{number} {name.replace('_', ' ')}"


def magnitude_of(
    c: Candidates, row: int, sizes: Floats, intervals: Floats, masses: MassUnit
) -> dict[str, Any]:
    """Return the magnitudes of a finding by the words of the interface, masses as cards have them.

    Of `sizes` (t,) and `intervals` (t, 2), 95 %; that of the first magnitude stands beside the
    magnitudes, in the finding.
    """
    said: dict[str, Any] = {}
    for k, (m, size, interval) in enumerate(zip(c.kind.magnitudes, sizes, intervals, strict=False)):
        if m.known_only and interval[1] > EFFECTS.mount_known * interval[0]:
            continue
        unit = masses.card if m.is_mass else 1.0
        said[m.word] = float(size) * unit
        if m.word == "mass" and masses.kilograms is not None:
            said["kilograms"] = float(size) * masses.kilograms
        if k:
            said[f"{m.word}_interval"] = (interval * unit).tolist()
    where = c.where[row]
    said |= {k: where[k] for k in ("components", "free_components") if k in where}
    return said | c.told(row, said)


def sentence_of(
    kind: EffectKind,
    magnitude: dict[str, Any],
    region: str,
    interval: tuple[float, float],
    modes: Sequence[int],
    masses: MassUnit,
    many: int = 1,
) -> str:
    """Say what is missing, where, which test modes it explains, how sure.

    A stiffness that may be anything within a wide interval is not told as one figure.
    """
    values = {**magnitude, "region": region}
    low, high = (f"{v:.3g}" for v in interval)
    known = interval[1] <= NARRATIVE.hardly * interval[0]
    if "stiffness" in magnitude:
        along = masses.per_length(magnitude.get("components") or [1])
        about = f"about {magnitude['stiffness']:.3g} {along}"
        values["size"] = about if known else "a size that the test hardly tells"
    if "components" in values:
        values["components"] = "".join(str(k) for k in values["components"])
    for m in kind.magnitudes:
        if m.is_mass:
            values[m.word] = masses.said(float(magnitude[m.word]))
    if kind.magnitudes[0].is_mass:
        low, high = masses.figure(interval[0]), masses.said(interval[1])
    if "free_components" in values:
        turning = "".join(str(k) for k in values["free_components"])
        values["components"] += f" and freely in direction {turning}"
    text = kind.sentence.format(**values)
    if many > 1:
        text += f" (one of {many} alike, by the symmetry of the structure)"
    what = mode_ranges(modes) if modes else "the test better as a whole"
    text += f" explains {what} (95 %: {low} to {high}"
    text += ")" if known or "size" in values else ", the test hardly tells)"
    if "inertia_assumed" in values:
        text += ". The test does not tell its inertia: taken as that of a solid block"
    elif "inertia" in values:
        text += f". {_stance(magnitude)}"
    return text + "."


def _stance(magnitude: dict[str, Any]) -> str:
    """Say how equipment stands."""
    radius = np.sqrt(magnitude["inertia"] / magnitude["mass"])
    off = np.linalg.norm(magnitude.get("offset", 0.0))
    text = f"It resists being turned (radius of gyration about {radius:.2g} deck units)"
    return text + (f", its centre about {off:.2g} deck units from its foot" if off > 0.0 else "")


def spot_of(geometry: Geometry, c: Candidates, row: int) -> str:
    """Say where a candidate is: what joins two places, and supports that give together, by grids.

    Else near which grid.
    """
    if ends := c.where[row].get("ends"):
        return f"between {' and '.join(_grids(end) for end in ends)}"
    grids, near = c.where[row].get("grids", ()), region(geometry, c.xyz[row])
    if not c.law.shared or len(grids) < 2:
        return near
    if len(grids) <= NARRATIVE.grids_named:
        return f"at grids {listed([str(g) for g in grids])} together"
    own = geometry.xyz[np.isin(geometry.ids, grids)]
    middle = own[np.argmin(np.linalg.norm(own - c.xyz[row], axis=1))]
    return f"over {len(grids)} grids together {region(geometry, middle)}"


def _grids(ids: Sequence[int]) -> str:
    one, *more = (str(g) for g in ids)
    return f"grids {listed([one, *more])}" if more else f"grid {one}"


def region(geometry: Geometry, xyz: Floats) -> str:
    """Say where a point (3,) of the analysis is, for round structures by angle and height."""
    nearest = int(geometry.ids[np.argmin(np.linalg.norm(geometry.xyz - xyz, axis=1))])
    xyz = np.where(np.abs(xyz) < NARRATIVE.at_zero * geometry.size, 0.0, xyz)
    x, y, z = (float(v) for v in xyz)
    axis = _round_axis(geometry.xyz)
    if axis is None:
        return f"near grid {nearest} (x = {x:.4g}, y = {y:.4g}, z = {z:.4g})"
    a, b = ((1, 2), (2, 0), (0, 1))[axis]
    angle = float(np.degrees(np.arctan2(xyz[b], xyz[a]))) % 360.0
    radius = float(np.hypot(xyz[a], xyz[b]))
    return (
        f"near grid {nearest} (θ = {angle:.0f}°, r = {radius:.4g}, {'xyz'[axis]} = {xyz[axis]:.4g})"
    )


def _round_axis(xyz: Floats) -> int | None:
    """Coordinate axis about which a structure is round, None where it is not."""
    for axis in (2, 0, 1):
        a, b = ((1, 2), (2, 0), (0, 1))[axis]
        r = np.hypot(xyz[:, a], xyz[:, b])
        angle = np.arctan2(xyz[:, b], xyz[:, a])
        if not r.max() > 0.0:
            continue
        rim = r > NARRATIVE.rim * r.max()
        filled = np.unique(np.floor((angle[rim] + np.pi) / (np.pi / 12.0))).size
        if filled >= NARRATIVE.rim_filled:
            return axis
    return None
