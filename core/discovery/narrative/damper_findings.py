"""From what the damping says to what a person is told."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ...arrays import Floats, Ints
from ..dampers.damper_evidence import Weighed, moved
from ..dampers.damper_search import DamperFound
from ..effects import KINDS
from ..effects.local_damper import KIND, sentence
from ..effects.sentence_parts import odds
from ..effects.structure_points import Axes
from ..findings import Alternative, Discovery, Finding, ModalDamping
from ..likelihood.complex_modes import Oriented, added
from ..likelihood.likelihood_numbers import LIKELIHOOD
from ..likelihood.request import Request
from ..search.model_selection import times
from .narrative_numbers import NARRATIVE
from .sentences import region


def with_damper(request: Request, w: Weighed | None, said: Discovery) -> Discovery:
    """Add what comes of weighing a dashpot, given the completed model.

    Parameters
    ----------
    request : Request
    w : Weighed or None
    said : Discovery
    """
    if w is None:
        return said
    structure, found, places, modes, u = request.structure, w.found, w.places, w.modes, w.u
    beside = found.level_with if found.exists >= NARRATIVE.damper_listed else found.level_without
    without = tuple(float(v) for v in found.level_without)
    said = replace(said, damping=ModalDamping(without, tuple(float(v) for v in beside)))
    ratio = times(-found.evidence)
    if found.exists < NARRATIVE.damper_listed:
        if found.exists < NARRATIVE.damper_told:
            return said
        spot = region(structure.model.geometry, places.xyz[found.rows[0]])
        alternative = Alternative(
            (KIND.name,),
            (tuple(float(v) for v in places.xyz[found.rows[0]]),),
            ratio,
            f"a dashpot {spot} besides",
            odds(ratio, "none"),
        )
        return replace(said, alternatives=(*said.alternatives, alternative))
    finding, sure = _finding(request, found, places, modes, u)
    model = [f for f in said.findings if f.side == "model"]
    rest = [f for f in said.findings if f.side != "model"]
    verdict, decide = said.verdict, said.would_decide
    if verdict not in {"effect", "undecided"}:
        verdict = "effect" if sure >= NARRATIVE.damper_sure else "undecided"
    if verdict == "undecided":
        decide = (*decide, *_would_decide(request, found, places, modes, u))
    beside_it = _beside(request, finding, model)
    shaken = moved(w) if beside_it else np.zeros(0, np.int64)
    if len(shaken):
        verdict = "undecided"
        which = ", ".join(str(int(request.numbers[j])) for j in shaken)
        decide = (
            *decide,
            f"the same test with the dashpot taken off: it is heavy enough to move modes {which} "
            f"as the {beside_it} beside it would",
        )
    return replace(
        said, verdict=verdict, findings=(*model, finding, *rest), would_decide=tuple(decide)
    )


def _beside(request: Request, damper: Finding, model: list[Finding]) -> str:
    """Name the first effect at the dashpot's place that it might be taken for, "" for none."""
    size = request.structure.model.geometry.size
    for f in model:
        apart = np.linalg.norm(np.subtract(f.where["xyz"], damper.where["xyz"]))
        if KINDS[f.kind].at_points and apart < NARRATIVE.damper_beside * size:
            return KINDS[f.kind].words
    return ""


def _finding(
    request: Request, found: DamperFound, places: Axes, modes: Oriented, u: Floats
) -> tuple[Finding, float]:
    """Return the finding at the place around which most of the posterior lies, and how much."""
    xyz = places.xyz[found.rows]
    size = request.structure.model.geometry.size
    near = np.linalg.norm(xyz[:, None] - xyz[None], axis=2) < NARRATIVE.damper_together * size
    along = np.array([places.where[r]["components"][0] for r in found.rows])
    near &= along[:, None] == along[None]
    mass = near @ found.weights
    k = int(np.argmax(mass + NARRATIVE.damper_tie * found.weights))
    w = np.where(near[k], found.weights, 0.0) / mass[k]
    mean = float(w @ found.log_size)
    variance = float(w @ (found.log_deviation**2 + (found.log_size - mean) ** 2))
    spread = NARRATIVE.interval * float(np.hypot(np.sqrt(variance), KIND.magnitudes[0].place_error))
    c, row = float(np.exp(mean)), int(found.rows[k])
    low, high = float(np.exp(mean - spread)), float(np.exp(mean + spread))
    components = list(places.where[row]["components"])
    where: dict[str, Any] = {**places.where[row], "xyz": places.xyz[row].tolist()}
    where["region"] = region(request.structure.model.geometry, places.xyz[row])
    count = modes.count
    gets = c * added(u[row, :count], modes.omega[:count])
    felt = np.flatnonzero(gets > found.level_with)
    felt = felt if len(felt) else np.array([int(np.argmax(gets))])
    sure = found.exists * float(mass[k])
    finding = Finding(
        "model",
        KIND.name,
        where,
        {KIND.magnitudes[0].word: c, "components": components},
        (low, high),
        tuple(
            {**places.where[r], "xyz": places.xyz[r].tolist(), "weight": float(v)}
            for r, v in zip(found.rows, found.weights, strict=True)
            if v > NARRATIVE.damper_credible * found.weights[0]
        )[: NARRATIVE.damper_places],
        sure * NARRATIVE.damper_confidence,
        sentence(
            c,
            (low, high),
            components,
            where["region"],
            [int(request.numbers[j]) for j in felt],
            times(found.evidence),
        ),
    )
    return finding, sure


def _would_decide(
    request: Request, found: DamperFound, places: Axes, modes: Oriented, u: Floats
) -> tuple[str, ...]:
    """Say which further mode's damping tells the two best places apart."""
    xyz = places.xyz[found.rows]
    size = request.structure.model.geometry.size
    far = NARRATIVE.damper_together * size
    other: Ints = np.flatnonzero(np.linalg.norm(xyz - xyz[0], axis=1) > far)
    further = np.arange(modes.count, len(modes.omega))
    further = further[modes.omega[further] > LIKELIHOOD.elastic * modes.omega.max()]
    if not len(other) or not len(further):
        return ("damping ratios of further modes, which would tell where the dashpot sits",)
    level = float(np.exp(np.mean(np.log(found.level_with))))
    a, b = (
        np.exp(found.log_size[i]) * added(u[found.rows[i], further], modes.omega[further])
        for i in (0, int(other[0]))
    )
    apart = np.abs(np.log((level + a) / (level + b)))
    k = int(np.argmax(apart))
    hz = modes.omega[further[k]] / (2.0 * np.pi)
    spots = [
        region(request.structure.model.geometry, places.xyz[found.rows[i]])
        for i in (0, int(other[0]))
    ]
    return (
        f"the damping of the mode that the model has at {hz:.4g} Hz: about "
        f"{100.0 * (level + a[k]):.2g} % if the dashpot is {spots[0]}, "
        f"{100.0 * (level + b[k]):.2g} % if it is {spots[1]}",
    )
