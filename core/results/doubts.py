"""What a reader of a correlation should doubt: clusters, test modes, supports, sensors."""

from __future__ import annotations

import numpy as np

from ..arrays import Floats, Numbers
from ..correlation.comparison import Comparison
from ..correlation.correlation_numbers import CORRELATION
from ..correlation.mac import mac, realised
from ..correlation.mode_pairing import Correlation
from ..identification.survey.suspension import rigid_share
from ..localisation.localisation_numbers import MAPS
from ..localisation.sensor_agreement import SensorAgreement


def doubts(c: Comparison, agreement: SensorAgreement | None) -> tuple[str, ...]:
    """Return warnings of a comparison, each a sentence."""
    hz, shapes = c.test.frequencies_hz, c.test.shapes
    own = c.analysis.frequencies_hz
    held = len(own) > 0 and bool(own.min() > MAPS.rigid * own.max())
    whole = rigid_share(realised(shapes), c.observation.sensors, c.placed.test_geometry)
    labels = c.observation.sensors.labels
    return (
        *_crowded(c.correlation),
        *_twice(hz, shapes),
        *(_free(hz, whole) if held else ()),
        *(_reversed(agreement, labels) if agreement is not None else ()),
    )


def _crowded(found: Correlation) -> tuple[str, ...]:
    side = "test" if found.criteria.rotate == "test" else "analysis"
    sizes = [len(getattr(c, side)) for c in found.clusters]
    turned = [p for p in found.pairs if p.cluster is not None]
    crowd = sum(sizes[p.cluster] > CORRELATION.crowd for p in turned if p.cluster is not None)
    if not crowd:
        return ()
    return (
        f"{crowd} of {len(found.pairs)} pairs come of turning clusters of up to {max(sizes)} "
        f"{side} modes: so many hold nearly any shape, so their MAC says little; a cluster_width "
        f"below {found.criteria.cluster_width:g} keeps modes apart",
    )


def _twice(hz: Floats, shapes: Numbers) -> tuple[str, ...]:
    alike = np.argwhere(np.triu(mac(shapes, shapes) > CORRELATION.identical, 1))
    said = []
    for i, j in alike[: CORRELATION.named]:
        same = abs(hz[i] - hz[j]) <= CORRELATION.same_hz * max(hz[i], hz[j])
        why = "one mode listed twice" if same else "at these sensors nothing tells them apart"
        said.append(
            f"test modes {i + 1} and {j + 1} ({hz[i]:.5g} and {hz[j]:.5g} Hz) have the same shape: "
            f"{why}"
        )
    more = len(alike) - len(said)
    return (*said, *([f"{more} more pairs of test modes have the same shape"] if more > 0 else []))


def _free(hz: Floats, whole: Floats) -> tuple[str, ...]:
    """Say which test modes move the whole where the model cannot."""
    moving = np.flatnonzero(np.nan_to_num(whole) > CORRELATION.rigid)
    if len(moving) < CORRELATION.rigid_modes:
        return ()
    which = ", ".join(f"{k + 1} ({hz[k]:.4g} Hz)" for k in moving)
    return (
        f"test modes {which} move the structure as a whole, as on a soft suspension, and the model "
        "has no rigid-body modes: check its supports (SPC) against how the test was hung",
    )


def _reversed(found: SensorAgreement, labels: list[str]) -> list[str]:
    worst = [k for k in np.argsort(-found.reversed_mac) if found.suspect[k]]
    named = ", ".join(labels[k] for k in worst[: CORRELATION.named])
    if not worst:
        return []
    one = len(worst) == 1
    more = f" and {len(worst) - CORRELATION.named} more" if len(worst) > CORRELATION.named else ""
    return [
        f"{'sensor' if one else 'sensors'} {named}{more} {'reads' if one else 'read'} against the "
        f"model in most modes: turned round, {'it' if one else 'the first'} alone would raise the "
        f"mean MAC of {found.modes} modes from {found.mac:.2f} to "
        f"{found.reversed_mac[worst[0]]:.2f}; check the polarity, or let discover test it"
    ]
