"""Cards that say what to solve and in which units: EIGRL, EIGR, PARAM, DTI."""

from .card_definition import Card
from .movable_values import Moves, Read, Variable

_MOVED = ("G", "ALPHA1", "ALPHA2", "CK2", "CM2")


def _find(name: str, read: Read) -> int | None:
    return 3 if read(2) == name else None


CARDS = (
    Card("EIGRL", "SID:i! V1:r V2:r ND:i MSGLVL:i=0 MAXSET:i SHFSCL:r NORM:w ...", "sid"),
    Card("EIGR", "SID:i! METHOD:w=LAN F1:r F2:r NE:i ND:i - CRIT:r / NORM:w=MASS G:x C:x", "sid"),
    Card(
        "PARAM",
        "N:x V1:x V2:x ...",
        moves=Moves(variable=Variable(_MOVED, _MOVED.__contains__, _find)),
    ),
    Card("DTI", "NAME:x IREC:x MASS:x FORCE:x LENGTH:x TIME:x ..."),
)
