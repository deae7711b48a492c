"""The tables of how far sensors agree with the model, and of how alike the modes of a side are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..arrays import Floats, Numbers
from ..correlation.mac import mac
from ..localisation.sensor_agreement import SensorAgreement
from . import export
from .plain import Matrix, Table, finite


@dataclass(frozen=True)
class AgreementRow:
    """A sensor, over the pairs and the test modes that nearly have one; None where it is still.

    `misfit` is the rms difference of its readings from the model's over the rms of the shapes,
    `mac_if_reversed` the mean MAC of those modes were it turned round.
    """

    sensor: str
    comac: float | None
    misfit: float
    mac_if_reversed: float
    suspect: bool


@dataclass(frozen=True, eq=False)
class AutoMacTable(Matrix):
    """MAC `values` (n, n), 0..1, of the modes of one side among themselves, from 1."""

    values: Floats

    @classmethod
    def of(cls, shapes: Numbers) -> AutoMacTable:
        """Return that of shapes (n_sensor, n)."""
        return cls(mac(shapes, shapes))

    def __len__(self) -> int:
        return len(self.values)

    @property
    def modes(self) -> tuple[int, ...]:
        """Their numbers."""
        return tuple(range(1, len(self) + 1))

    @property
    def _wide(self) -> tuple[list[export.Column], list[dict[str, object]]]:
        names = ["mode", *map(str, self.modes)]
        rows = zip(self.modes, self.values.tolist(), strict=True)
        records = [dict(zip(names, (n, *row), strict=True)) for n, row in rows]
        return [export.Column(name) for name in names], records


def agreement_table(found: SensorAgreement | None, labels: Sequence[str]) -> Table[AgreementRow]:
    """Return the sensors in the order of the test; none where nothing is alike."""
    if found is None:
        return Table((), AgreementRow)
    columns = (found.comac, found.misfit, found.reversed_mac, found.suspect)
    return Table(
        (AgreementRow(label, finite(k), float(m), float(r), bool(s))
         for label, k, m, r, s in zip(labels, *columns, strict=True)),
        AgreementRow,
    )  # fmt: skip
