"""What a set of frequency responses is worth: checked, cleaned, weighted, oriented."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...arrays import Bools, Floats, Numbers
from ...data.dofs import Dofs
from ...data.frfs import Frfs
from ...errors import InputError
from .faults import Fault, listed
from .function_faults import cut_off, dead
from .modal_synthesis import derivative_order
from .survey_numbers import SURVEY
from .usable_functions import Said, lines_with_values, refuse_copies, usable


@dataclass(frozen=True, eq=False)
class Survey:
    """Frequency responses ready to be fitted.

    Parameters
    ----------
    frequencies_hz : (n_line,) float
    values : (n_output, n_input, n_line) complex
        Weighted by `output_weight` and `input_weight`; 0 where not `measured`.
    measured : (n_output, n_input) bool
    output_weight, input_weight : float
        (n_output,), (n_input,): one over the noise, as a product.
    outputs, inputs : Dofs
        Shapes are found at the outputs. They are the responses, or the references of a survey
        with more references than responses (a roving hammer), by reciprocity.
    roving_hammer : bool
        Whether outputs and inputs are exchanged.
    quantity : str
        Of the functions as given; `values` are accelerations whatever it is.
    source : str
    faults : tuple of Fault
        What is wrong with which functions.
    warnings : tuple of str
        What is to be told, the sentences of `faults` among it.
    ranges : tuple of (low, high)
        First and last line [Hz] of each part of the axis that is used, rising.
    coherence : (n_line,) float, optional
        Of all functions together, each counting by its square; NaN where it was not measured.
    """

    frequencies_hz: Floats
    values: Numbers
    measured: Numbers
    output_weight: Floats
    input_weight: Floats
    outputs: Dofs
    inputs: Dofs
    roving_hammer: bool
    quantity: str
    source: str
    faults: tuple[Fault, ...]
    warnings: tuple[str, ...]
    ranges: tuple[tuple[float, float], ...]
    coherence: Floats | None = None

    def function(self, output: int, input_: int) -> str:
        """Name a function by response and reference as the file has them."""
        pair = self.outputs.labels[output], self.inputs.labels[input_]
        return "/".join(pair[::-1] if self.roving_hammer else pair)

    @property
    def physical(self) -> Numbers:
        """Values without the weights, (n_output, n_input, n_line) complex."""
        weights = self.output_weight[:, None] * self.input_weight
        return np.asarray(self.values / weights[:, :, None])

    def lines(self, low: float, high: float) -> slice:
        """Lines from `low` to `high` [Hz], both included."""
        first, last = np.searchsorted(self.frequencies_hz, [low, np.nextafter(high, np.inf)])
        return slice(int(first), int(last))


def told(survey: Survey, *faults: Fault) -> Survey:
    """Add faults, and their sentences."""
    sentences = tuple(f.sentence for f in faults)
    return replace(survey, faults=survey.faults + faults, warnings=survey.warnings + sentences)


def weighed(survey: Survey) -> Survey:
    """Weigh the functions anew, after some were exchanged or left out."""
    values = survey.physical
    measured = survey.measured.astype(bool)
    output_weight, input_weight = _weights(measured, *_noise_and_size(values, measured))
    values = values * output_weight[:, None, None] * input_weight[None, :, None]
    return replace(survey, values=values, output_weight=output_weight, input_weight=input_weight)


def named_and_left_out(
    survey: Survey, kind: str, functions: Bools, what: str, done: str = "left out"
) -> Survey:
    """Name functions (n_output, n_input), and leave them out unless they are too many."""
    names = tuple(survey.function(o, i) for o, i in zip(*np.nonzero(functions), strict=True))
    if not names:
        return survey
    if np.count_nonzero(functions) > SURVEY.left_out_most * np.count_nonzero(survey.measured):
        done = ""
    sentence = f"{listed(names)}: {what}" + (f"; {done}" if done else "")
    survey = told(survey, Fault(kind, names, sentence, done))
    return left_out(survey, functions) if done else survey


def left_out(survey: Survey, functions: Bools) -> Survey:
    """Take functions (n_output, n_input) out, and outputs or inputs that have no other."""
    if not functions.any():
        return survey
    measured = survey.measured & ~functions
    rows, columns = measured.any(axis=1), measured.any(axis=0)
    values = np.where(measured[:, :, None], survey.values, 0.0)
    return replace(
        survey,
        values=values[rows][:, columns],
        measured=measured[rows][:, columns],
        output_weight=survey.output_weight[rows],
        input_weight=survey.input_weight[columns],
        outputs=survey.outputs.take(np.flatnonzero(rows)),
        inputs=survey.inputs.take(np.flatnonzero(columns)),
    )


def prepare(frfs: Frfs, ranges: Sequence[tuple[float, float]] = ((0.0, np.inf),)) -> Survey:
    """Check, clean, weight and orient frequency responses, their lines in some ranges [Hz].

    Whatever the quantity, they are fitted as accelerations, which accelerometers measure with noise
    alike at all lines: one and the same test has one answer.
    Functions that are no frequency responses (constant, real, with gaps) are left out and named
    in the warnings.

    Raises
    ------
    InputError
        A frequency axis that does not rise, too few lines, or nothing that can be fitted.
    """
    name = frfs.source or "the frequency responses"
    said = Said(name, frfs.responses, frfs.references)
    derivative_order(quantity := frfs.quantity)
    given, frfs = frfs, frfs.as_acceleration
    f, keep, ranges = _axis(frfs, ranges, name)
    values = np.ascontiguousarray(frfs.values[:, :, keep])
    responses, references = frfs.responses, frfs.references
    filled = lines_with_values(values, f, said)
    f, values = f[filled], values[:, :, filled]
    measured = usable(values, f, said)
    missing = np.isnan(values).all(axis=2)
    noise, rms = _noise_and_size(values, measured)
    quiet = measured & (noise > SURVEY.noise_only * rms)
    said.name("dead_channel", quiet, ("holds", "nothing but noise"), "left out")
    measured &= ~quiet
    silent = dead(values, measured)
    said.name("dead_channel", silent, ("holds", "nothing that decays (a dead channel)"), "left out")
    measured &= ~silent
    if not measured.any():
        reason = f": {said.warnings[-1]}" if said.warnings else ""
        raise InputError(f"{name} holds no frequency response that can be fitted{reason}")
    refuse_copies(values[measured], name)
    cut = measured & cut_off(given)
    few = np.count_nonzero(cut) <= SURVEY.left_out_most * np.count_nonzero(measured)
    at_one = "is", "cut off at one value (an overload)"
    said.name("overload", cut, at_one, "left out" if few else "")
    measured &= ~(cut & few)
    smooth = float(np.median(noise[measured] / np.maximum(rms[measured], 1e-300)))
    if smooth < SURVEY.too_smooth:
        said.warnings.append(
            f"{name}: the functions are smooth to {smooth:.0e} of their size, as measured ones "
            "are not: they seem computed from an earlier identification, whose own errors the "
            "standard errors here cannot know"
        )
    rows, columns = measured.any(axis=1), measured.any(axis=0)
    rows, columns = _one_component(measured, rows, columns, responses, references, said.warnings)
    values, measured = values[rows][:, columns], measured[rows][:, columns]
    noise, rms = noise[rows][:, columns], rms[rows][:, columns]
    responses = responses.take(np.flatnonzero(rows))
    references = references.take(np.flatnonzero(columns))
    _say_missing(missing[rows][:, columns], responses, references, said)
    roving = len(references) > len(responses)
    if roving:
        values, measured = np.ascontiguousarray(values.transpose(1, 0, 2)), measured.T
        noise, rms = noise.T, rms.T
        responses, references = references, responses
        said.warnings.append(
            f"{name} has more references than responses ({len(responses)} and {len(references)}):"
            " taken as a roving-hammer survey, shapes are given at the references by reciprocity"
        )
    values[~measured] = 0.0
    output_weight, input_weight = _weights(measured, noise, rms)
    values *= (output_weight[:, None] * input_weight)[:, :, None]
    return Survey(
        f, values, measured, output_weight, input_weight, responses, references, roving,
        quantity, frfs.source, tuple(said.faults), tuple(said.warnings), ranges,
    )  # fmt: skip


def _noise_and_size(values: Numbers, measured: Numbers) -> tuple[Floats, Floats]:
    """Noise and rms of each function, (n_response, n_reference); 1 where not measured."""
    noise, rms = np.ones(measured.shape), np.ones(measured.shape)
    for o in np.flatnonzero(measured.any(axis=1)):
        row = values[o, measured[o]][None]
        noise[o, measured[o]] = noise_levels(row)[0]
        rms[o, measured[o]] = np.sqrt(np.mean(np.abs(row[0]) ** 2, axis=1))
    return noise, rms


def noise_levels(values: Numbers) -> Floats:
    """Estimate the noise of each function from its roughness from line to line.

    Parameters
    ----------
    values : (n_output, n_input, n_line) complex

    Returns
    -------
    (n_output, n_input) float
        Standard deviation (real and imaginary part together): the median modulus of the fourth
        difference, which white complex noise σ makes √70·√ln 2·σ. Resonances are smooth at this
        scale but for a few lines, which a median does not see.
    """
    levels = np.empty(values.shape[:2])
    for some in few_at_a_time(values):
        rough = np.abs(np.diff(values[some], n=4, axis=2))
        levels[some] = np.median(rough, axis=2) / np.sqrt(70.0 * np.log(2.0))
    return levels


def few_at_a_time(values: Numbers) -> Iterator[slice]:
    """Yield slices of outputs of (n_output, n_input, n_line) values that a cache holds."""
    step = max(SURVEY.cached // max(values[0].size, 1), 1) if len(values) else 1
    for first in range(0, len(values), step):
        yield slice(first, first + step)


def _axis(
    frfs: Frfs, ranges: Sequence[tuple[float, float]], name: str
) -> tuple[Floats, Bools, tuple[tuple[float, float], ...]]:
    """Return the lines to use, which of all they are, and the first and last of each range."""
    f = frfs.frequencies_hz
    if len(f) > 1 and np.any(np.diff(f) <= 0.0):
        line = int(np.flatnonzero(np.diff(f) <= 0.0)[0]) + 1
        raise InputError(f"the frequency axis of {name} does not rise at line {line + 1}")
    keep, ends = np.zeros(len(f), bool), []
    for low, high in ranges:
        own = (f >= low) & (f <= high) & (f > 0.0)
        if np.count_nonzero(own) < SURVEY.lines_least:
            where = f" between {low:g} and {high:g} Hz" if low > 0.0 or high < np.inf else ""
            raise InputError(
                f"{name} has {np.count_nonzero(own)} frequency line(s){where}; "
                f"identification needs {SURVEY.lines_least}"
            )
        ends.append((float(f[own][0]), float(f[own][-1])))
        keep |= own
    return np.asarray(f[keep]), keep, tuple(ends)


def _say_missing(missing: Bools, responses: Dofs, references: Dofs, said: Said) -> None:
    names = [f"{responses.labels[o]}/{references.labels[i]}" for o, i in np.argwhere(missing)]
    if names:
        said.warnings.append(
            f"{said.source} lacks {len(names)} of {missing.size} combinations of response and "
            f"reference ({listed(names)}): shapes rest on fewer functions there"
        )


def _one_component(
    measured: Numbers,
    rows: Numbers,
    columns: Numbers,
    responses: Dofs,
    references: Dofs,
    warnings: list[str],
) -> tuple[Numbers, Numbers]:
    """Keep the largest set of responses and references that measured combinations connect.

    Between two sets without a common function the relative scale of the shapes is unknown.
    """
    best = np.zeros_like(rows), np.zeros_like(columns)
    left = columns.copy()
    while left.any():
        in_set = np.zeros_like(columns)
        in_set[np.flatnonzero(left)[0]] = True
        while True:
            out_set = measured[:, in_set].any(axis=1)
            grown = measured[out_set].any(axis=0)
            if (grown == in_set).all():
                break
            in_set = grown
        left &= ~in_set
        if measured[out_set][:, in_set].sum() > measured[best[0]][:, best[1]].sum():
            best = out_set, in_set
    lost = rows & ~best[0]
    if lost.any():
        labels = ", ".join(responses.take(np.flatnonzero(lost)).labels[: SURVEY.named])
        more = ", ..." if lost.sum() > SURVEY.named else ""
        kept = ", ".join(references.take(np.flatnonzero(best[1])).labels)
        warnings.append(
            f"{np.count_nonzero(lost)} response(s) ({labels}{more}) "
            f"share no reference with the others ({kept}): "
            "their scale is unknown, left out"
        )
    return best


def _weights(measured: Numbers, noise: Floats, rms: Floats) -> tuple[Floats, Floats]:
    """One over the noise of each function, as a product of output and input weights.

    Functions across the planes of a structure, small both for their output and for their input,
    are no product of the two, and tell nothing of how the planes weigh against each other.
    """
    with np.errstate(divide="ignore"):
        level = np.log(np.hypot(noise, SURVEY.model_error * rms))
    level[~measured] = np.nan
    small = level - np.log(SURVEY.across)
    across = (small < np.nanmax(level, axis=1, keepdims=True)) & (small < np.nanmax(level, axis=0))
    level[across] = np.nan
    of_input = np.zeros(level.shape[1])
    of_output = np.zeros(level.shape[0])
    for _ in range(SURVEY.level_rounds):
        of_output = np.nanmedian(level - of_input, axis=1)
        of_input = np.nanmedian(level - of_output[:, None], axis=0)
    return np.exp(-of_output), np.exp(-of_input)
