"""``modelDescription.xml`` of FMI 2.0 and 3.0, and ``buildDescription.xml`` of 3.0."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import islice
from xml.sax.saxutils import quoteattr

from ...core.statespace.modal_plant import ModalPlant
from .plant_variables import UNITS, Variable, dependencies, variables

TOOL = "trueup"


def model_description(
    plant: ModalPlant, version: int, name: str, token: str, sources: Sequence[str]
) -> str:
    """Return the description of a plant.

    Parameters
    ----------
    plant : ModalPlant
    version : {2, 3}
    name : str
        Of the model; its identifier in C is made of it.
    token : str
        Holds description, data and instance together.
    sources : sequence of str
        Names of the files in ``sources/``.
    """
    every = variables(plant)
    body = _version_2(plant, every, sources) if version == 2 else _version_3(plant, every)
    root: tuple[tuple[str, str], ...] = (
        ("fmiVersion", "2.0" if version == 2 else "3.0"),
        ("modelName", name),
        ("guid" if version == 2 else "instantiationToken", token),
        ("description", _told(plant)),
        ("generationTool", TOOL),
        ("variableNamingConvention", "structured"),
    )
    if version == 2:
        root = (*root, ("numberOfEventIndicators", "0"))
    words = body.replace("@NAME", identifier(name))
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        f"<fmiModelDescription{_said(root)}>\n{words}</fmiModelDescription>\n"
    )


def build_description(name: str, sources: Sequence[str]) -> str:
    """Return how the sources of a unit of FMI 3.0 are compiled."""
    files = "".join(f"      <SourceFile{_said((('name', s),))}/>\n" for s in sources)
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n<fmiBuildDescription fmiVersion="3.0">\n'
        f'  <BuildConfiguration modelIdentifier="{identifier(name)}">\n'
        f'    <SourceFileSet language="C99">\n{files}    </SourceFileSet>\n'
        "  </BuildConfiguration>\n</fmiBuildDescription>\n"
    )


def identifier(name: str) -> str:
    """Return the name as one of C."""
    word = re.sub(r"\W", "_", name, flags=re.ASCII)
    return word if word[:1].isalpha() else f"m_{word}"


def _told(plant: ModalPlant) -> str:
    said = f"{len(plant) - plant.residual_modes} modes of a structure"
    if plant.residual_modes:
        said += f" and {plant.residual_modes} residual modes for the others"
    if plant.band_hz is not None:
        said += f", for up to {plant.band_hz:g} Hz"
    if plant.error is not None:
        said += f" with an error of {100.0 * plant.error:.2g} % of a receptance's median there"
    return f"{said}; {'SI units' if plant.si else 'units of the deck'}"


def _said(pairs: Sequence[tuple[str, object]]) -> str:
    return "".join(f" {key}={quoteattr(str(value))}" for key, value in pairs if value is not None)


def _number(value: float | None) -> str | None:
    return None if value is None else repr(float(value))


def _units() -> str:
    lines = "".join(
        f'    <Unit name="{unit}"><BaseUnit{_said(tuple(base.items()))}/></Unit>\n'
        for unit, base in UNITS.items()
    )
    return f"  <UnitDefinitions>\n{lines}  </UnitDefinitions>\n"


def _experiment(plant: ModalPlant) -> str:
    """Twenty steps a period of the highest mode, after which held inputs hardly excite it."""
    highest = plant.frequencies_hz.max(initial=0.0)
    return f'  <DefaultExperiment stepSize="{0.05 / highest:.1e}"/>\n' if highest > 0.0 else ""


def _version_2(plant: ModalPlant, every: Sequence[Variable], sources: Sequence[str]) -> str:
    files = "".join(f'      <File name="{name}"/>\n' for name in sources)
    common = (
        'modelIdentifier="@NAME" canNotUseMemoryManagementFunctions="true"'
        ' canGetAndSetFMUstate="true" canSerializeFMUstate="true"'
        ' providesDirectionalDerivative="true"'
    )
    out = [
        f"  <ModelExchange {common}>\n    <SourceFiles>\n{files}    </SourceFiles>\n"
        "  </ModelExchange>\n"
        f'  <CoSimulation {common} canHandleVariableCommunicationStepSize="true"'
        ' canInterpolateInputs="true">\n'
        f"    <SourceFiles>\n{files}    </SourceFiles>\n  </CoSimulation>\n",
        _units(),
        _experiment(plant),
        "  <ModelVariables>\n",
    ]
    for vr, v in enumerate(every[:-1]):
        head = (
            ("name", v.name),
            ("valueReference", vr),
            ("description", v.description),
            ("causality", v.causality),
            ("variability", v.variability),
            ("initial", v.initial),
        )
        real = (
            ("unit", v.unit),
            ("min", "0.0" if v.causality == "parameter" else None),
            ("nominal", _number(v.nominal)),
            ("start", _number(v.start)),
            ("derivative", None if v.state is None else v.state + 1),
        )
        out.append(f"    <ScalarVariable{_said(head)}><Real{_said(real)}/></ScalarVariable>\n")
    unknowns = [
        f'      <Unknown index="{vr + 1}" dependencies="{" ".join(str(k + 1) for k in by)}"/>\n'
        for vr, by in dependencies(plant)
    ]
    outputs, derivatives = unknowns[: len(plant.outputs)], unknowns[len(plant.outputs) :]
    out += ["  </ModelVariables>\n  <ModelStructure>\n"]
    for word, lines in (
        ("Outputs", outputs),
        ("Derivatives", derivatives),
        ("InitialUnknowns", unknowns),
    ):
        out += [f"    <{word}>\n", *lines, f"    </{word}>\n"] if lines else []
    return "".join([*out, "  </ModelStructure>\n"])


def _version_3(plant: ModalPlant, every: Sequence[Variable]) -> str:
    common = (
        'modelIdentifier="@NAME" canGetAndSetFMUState="true" canSerializeFMUState="true"'
        ' providesDirectionalDerivatives="true"'
    )
    out = [
        f"  <ModelExchange {common}/>\n"
        f'  <CoSimulation {common} canHandleVariableCommunicationStepSize="true"/>\n',
        _units(),
        _experiment(plant),
        "  <ModelVariables>\n",
    ]
    for vr, v in enumerate(every):
        said = (
            ("name", v.name),
            ("valueReference", vr),
            ("description", v.description),
            ("causality", v.causality),
            ("variability", v.variability),
            ("initial", v.initial),
            ("unit", v.unit),
            ("min", "0.0" if v.causality == "parameter" else None),
            ("nominal", _number(v.nominal)),
            ("start", _number(v.start)),
            ("derivative", v.state),
        )
        out.append(f"    <Float64{_said(said)}/>\n")
    out += ["  </ModelVariables>\n  <ModelStructure>\n"]
    lines = [
        f' valueReference="{vr}" dependencies="{" ".join(map(str, by))}"/>\n'
        for vr, by in dependencies(plant)
    ]
    n = len(plant.outputs)
    out += [f"    <Output{line}" for line in islice(lines, n)]
    out += [f"    <ContinuousStateDerivative{line}" for line in lines[n:]]
    out += [f"    <InitialUnknown{line}" for line in lines]
    return "".join([*out, "  </ModelStructure>\n"])
