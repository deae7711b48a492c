"""A verdict that the deck as it is does not bear out."""

from dataclasses import dataclass, field
from types import SimpleNamespace

from trueup.core.discovery.screening.completed_model import borne_out


@dataclass(frozen=True)
class Said:
    verdict: str
    findings: tuple = ()
    would_decide: tuple = field(default=("a sensor",))


def finding(side, kind):
    return SimpleNamespace(side=side, kind=kind)


MASS = Said("effect", (finding("model", "point_mass"),))


def test_nothing_is_missing_where_every_mode_agrees_with_the_deck():
    assert borne_out(MASS, agrees=True) == Said("no_gap", (), ())
    assert borne_out(MASS, agrees=False) is MASS


def test_what_modes_do_not_show_stays():
    for side, kind in (("test", "sensor_gain"), ("model", "local_damper")):
        said = Said("effect", (finding(side, kind),))
        assert borne_out(said, agrees=True) is said
