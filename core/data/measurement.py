"""A modal test: where it was measured and what was found."""

from __future__ import annotations

from dataclasses import dataclass

from ..arrays import Floats
from ..errors import InputError, require_kind
from ..noun import Noun
from .frfs import Frfs
from .geometry import Geometry
from .modes import Modes


@dataclass(frozen=True, eq=False)
class Measurement(Noun):
    """A test with its geometry; modes, frequency responses or both.

    Parameters
    ----------
    geometry : Geometry
        Measured nodes in the test's own basic frame, positions in `length_unit`.
    modes : Modes or None
        Shapes in the measured directions only; each row's axis is a unit vector in the basic
        frame of `geometry`.
    frfs : Frfs or None
        Frequency responses, axes likewise.
    length_unit : {"m", "mm", "in", "ft"} or None
        Unit of positions and displacements; None where the source does not say.
    warnings : tuple of str
        What was left out or assumed.
    frequency_std, damping_std : (n_mode,) float or None
        Standard errors of `modes` [Hz; fraction of critical] where they were identified here.
    shape_std : (n_dof, n_mode) float or None
        Standard errors of the shapes, in their scale.
    mpc : (n_mode,) float or None
        Modal phase collinearity of the complex shapes that `modes` are the real ones of.

    Raises
    ------
    InputError
        Neither modes nor frequency responses, or nodes that have no position.
    """

    geometry: Geometry
    modes: Modes | None = None
    frfs: Frfs | None = None
    length_unit: str | None = None
    warnings: tuple[str, ...] = ()
    frequency_std: Floats | None = None
    damping_std: Floats | None = None
    shape_std: Floats | None = None
    mpc: Floats | None = None

    def __post_init__(self) -> None:
        require_kind(self.geometry, Geometry, "geometry of Measurement")
        for given, kind in ((self.modes, Modes), (self.frfs, Frfs)):
            if given is not None:
                require_kind(given, kind, f"{kind.__name__} of Measurement")
        if self.modes is None and self.frfs is None:
            raise InputError("the test holds neither modes nor frequency responses")
        for what, dofs in (
            ("mode shapes", self.modes.dofs if self.modes else None),
            ("frequency responses", self.frfs.responses if self.frfs else None),
        ):
            if dofs is None:
                continue
            lost = dofs.node[self.geometry.index_of(dofs.node) < 0]
            if len(lost):
                raise InputError(
                    f"the {what} of the test use node {lost[0]}, which has no position; "
                    "give the geometry that belongs to them"
                )
