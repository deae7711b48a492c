"""From what the damping says to what a person is told."""

from dataclasses import replace

import numpy as np

from ...arrays import Floats, Ints
from ..dampers.damper_evidence import Weighed
from ..dampers.damper_numbers import DAMPERS
from ..effects import KINDS
from ..effects.local_damper import KIND, sentence
from ..findings import Discovery, Finding, ModalDamping, Where
from ..likelihood.complex_modes import added
from ..likelihood.likelihood_numbers import LIKELIHOOD
from ..likelihood.request import Request
from ..model_error.model_error_numbers import MODEL_ERROR
from ..search.model_selection import times
from ..search.search_numbers import SEARCH
from .narrative_numbers import NARRATIVE
from .sentences import alternative, region


def with_damper(request: Request, w: Weighed | None, said: Discovery) -> Discovery:
    """Add what comes of weighing a dashpot, given the completed model."""
    if w is None:
        return said
    found = w.found
    beside = found.level_with if found.exists >= DAMPERS.likely else found.level_without
    levels = ModalDamping(tuple(found.level_without.tolist()), tuple(beside.tolist()))
    said = replace(said, damping=levels)
    if found.exists < DAMPERS.likely:
        if found.exists < NARRATIVE.damper_told:
            return said
        xyz = w.places.xyz[found.rows[0]]
        where = f"a dashpot {region(request.structure.model.geometry, xyz)} besides"
        further = alternative((KIND.name,), [xyz], times(-found.evidence), where, other="none")
        return replace(said, alternatives=(*said.alternatives, further))
    finding, sure = _finding(request, w)
    model = [f for f in said.findings if f.side == "model"]
    rest = [f for f in said.findings if f.side != "model"]
    verdict, decide = said.verdict, said.would_decide
    left = verdict == "undecided" and (model or said.adequacy < MODEL_ERROR.claimed)
    if verdict != "effect" and not left:
        verdict = "effect" if sure >= NARRATIVE.damper_sure else "undecided"
    if verdict == "undecided":
        decide = (*decide, _would_decide(request, w))
    beside_it = _beside(request, finding, model)
    shaken = w.damped.moved if beside_it else np.zeros(0, np.int64)
    if len(shaken):
        verdict = "undecided"
        which = ", ".join(str(int(request.numbers[j])) for j in shaken)
        decide = (
            *decide,
            f"the same test with the dashpot taken off: it is heavy enough to move modes {which} "
            f"as the {beside_it} beside it would",
        )
    if verdict == "undecided":
        finding = replace(finding, confidence=sure * NARRATIVE.doubted)
    if len(shaken):
        model = [replace(f, confidence=min(f.confidence, NARRATIVE.doubted)) for f in model]
    every = (*model, finding, *rest)
    proposal = said.proposal and not len(shaken)
    return replace(said, verdict=verdict, findings=every, would_decide=decide, proposal=proposal)


def _beside(request: Request, damper: Finding, model: list[Finding]) -> str:
    """Name the first effect at the dashpot's place that it might be taken for, "" for none."""
    size = request.structure.model.geometry.size
    for f in model:
        apart = np.linalg.norm(np.subtract(f.where.xyz, damper.where.xyz))
        if KINDS[f.kind].at_points and apart < SEARCH.beside * size:
            return KINDS[f.kind].label
    return ""


def _finding(request: Request, w: Weighed) -> tuple[Finding, float]:
    """Return the finding at the place around which most of the posterior lies, and how much."""
    found, places, count = w.found, w.places, w.modes.count
    geometry = request.structure.model.geometry
    xyz = places.xyz[found.rows]
    far = NARRATIVE.damper_together * geometry.size
    near = np.linalg.norm(xyz[:, None] - xyz[None], axis=2) < far
    along = np.array([places.where[r]["components"][0] for r in found.rows])
    near &= along[:, None] == along[None]
    mass = near @ found.weights
    k = int(np.argmax(mass + NARRATIVE.damper_tie * found.weights))
    weight = np.where(near[k], found.weights, 0.0) / mass[k]
    mean = float(weight @ found.log_size)
    variance = float(weight @ (found.log_deviation**2 + (found.log_size - mean) ** 2))
    place_error = KIND.magnitudes[0].place_error
    spread = LIKELIHOOD.interval * float(np.hypot(np.sqrt(variance), place_error))
    c, row = float(np.exp(mean)), int(found.rows[k])
    interval = float(np.exp(mean - spread)), float(np.exp(mean + spread))
    components = list(places.where[row]["components"])
    spot = region(geometry, places.xyz[row])
    gets = c * added(w.u[row, :count], w.modes.omega[:count])
    felt = np.flatnonzero(gets > found.level_with)
    felt = felt if len(felt) else np.array([int(np.argmax(gets))])
    modes = [int(request.numbers[j]) for j in felt]
    sure = found.exists * float(mass[k])
    finding = Finding(
        "model",
        KIND.name,
        Where.of(places.where[row], places.xyz[row], region=spot),
        {KIND.magnitudes[0].word: c, "components": components},
        interval,
        tuple(
            Where.of(places.where[r], places.xyz[r], weight=float(v))
            for r, v in zip(found.rows, found.weights, strict=True)
            if v > NARRATIVE.damper_credible * found.weights[0]
        )[: NARRATIVE.damper_places],
        sure * NARRATIVE.damper_confidence,
        sentence(c, interval, components, spot, modes, times(found.evidence)),
    )
    return finding, sure


def _would_decide(request: Request, w: Weighed) -> str:
    """Say which further mode's damping tells the two best places apart."""
    found, modes, geometry = w.found, w.modes, request.structure.model.geometry
    xyz = w.places.xyz[found.rows]
    far = NARRATIVE.damper_together * geometry.size
    other: Ints = np.flatnonzero(np.linalg.norm(xyz - xyz[0], axis=1) > far)
    further = np.arange(modes.count, len(modes.omega))
    further = further[modes.omega[further] > LIKELIHOOD.elastic * modes.omega.max()]
    if not len(other) or not len(further):
        return "damping ratios of further modes, which would tell where the dashpot sits"
    both = (0, int(other[0]))
    level = float(np.exp(np.mean(np.log(found.level_with))))
    ratios: list[Floats] = [
        level + np.exp(found.log_size[i]) * added(w.u[found.rows[i], further], modes.omega[further])
        for i in both
    ]
    k = int(np.argmax(np.abs(np.log(ratios[0] / ratios[1]))))
    hz = modes.omega[further[k]] / (2.0 * np.pi)
    told = [
        f"{100.0 * r[k]:.2g} % if {it} is {region(geometry, xyz[i])}"
        for it, r, i in zip(("the dashpot", "it"), ratios, both, strict=True)
    ]
    return f"the damping of the mode that the model has at {hz:.4g} Hz: about {', '.join(told)}"
