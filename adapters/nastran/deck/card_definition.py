"""What a bulk data card holds, declared as the Quick Reference Guide prints it.

A layout is a row of words, one a field from the second on; ``/`` starts the next line:

==================  ==============================================================================
``MID:i``           name in the guide and kind of value; None where the deck leaves it blank
``MID:i!``          must be given
``T:r=0.``          value where it is blank; ``=EID`` takes that of another field
``TS/T>shear:r``    the attribute is `shear`; without ``>`` it is the name in small letters
``X1,X2,X3>x:r``    several fields of one attribute, which is a tuple; they may stand apart too
``-``               a field without a meaning
``G>nodes:*``       numbers to the end of the card: ``a THRU b BY c`` becomes a `range`
``[G:i C:c]``       repeated to the end of the card: tuples, blank repetitions left out; ``=^``
                    takes the value of the repetition before
``...``             what follows is not read
==================  ==============================================================================

Kinds: ``i`` integer, ``r`` real, ``w`` word, ``c`` components (digits in order, as text), ``ir``
integer or real, ``iw`` integer or word, ``x`` the text in capitals.
"""

from collections import namedtuple
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from ....core.elements import ELEMENTS, Element
from .field_values import Field, Fields, parse
from .movable_values import Moves

Values = Any
"""A card as read: a named tuple with the attributes of its definition."""

Known = Mapping[str, Any]
"""Values read so far, by attribute."""


@dataclass(frozen=True, eq=False)
class Card:
    """The definition of one kind of card.

    Parameters
    ----------
    name : str
        In capitals.
    layout : str
        See the module.
    number : str
        Attribute that holds its number; "" where it has none of its own (it is kept in a list).
    several : int
        Fields apart of several on one card; 0 where there is one.
    unique : bool
        Whether no two cards may have the same number.
    space : str
        What its number counts together with other kinds of cards ("shell property", ...).
    blanks_from : str
        Card whose fields stand for blank ones (GRDSET, BAROR, BEAMOR).
    more : callable, optional
        Reads what no row of words can tell: gets the fields and the values read so far by
        attribute, and returns values of the attributes in `extra`, in their order.
    extra : str
        Attributes that `more` gives.
    grids : str
        Attributes that hold numbers of grids or scalar points.
    ignored, refused : str
        Why a card is left out, or stops the assembly; "" where it is read.
    selected_by : str
        Command of case control without which a refused card is left out.
    warned : bool
        Whether leaving it out is said in a warning.
    elements : str
        Elements of the core that it stands for: without and with middle nodes.
    properties : str
        Cards that its PID may refer to, in the order they are looked for.
    companions : str
        Cards of the same number that say more of it.
    moves : Moves or None
        Its reals may be parameters, and what else is known of them.
    """

    name: str
    layout: str = ""
    number: str = ""
    several: int = 0
    unique: bool = True
    space: str = ""
    blanks_from: str = ""
    more: Callable[[Fields, Known], Sequence[Any]] | None = None
    extra: str = ""
    grids: str = "nodes scalars"
    ignored: str = ""
    refused: str = ""
    selected_by: str = ""
    warned: bool = False
    elements: str = ""
    properties: str = ""
    companions: str = ""
    moves: Moves | None = None

    @cached_property
    def fields(self) -> tuple[Field, ...]:
        """Fields from the second on; those that are repeated follow in `repeated`."""
        return tuple(parse(self.layout.partition("[")[0]))

    @cached_property
    def repeated(self) -> tuple[Field, ...]:
        """Fields of one repetition."""
        return tuple(parse(self.layout.partition("[")[2].partition("]")[0]))

    @cached_property
    def reals(self) -> dict[str, int]:
        """Its real values by name, each with its data field: 0 is the first after the name."""
        return {f.name: k for k, f in enumerate(self.fields) if f.kind == "r"}

    @cached_property
    def repeated_reals(self) -> dict[str, int]:
        """Likewise in a repetition."""
        return {f.name: k for k, f in enumerate(self.repeated) if f.kind == "r"}

    @cached_property
    def others(self) -> dict[str, int]:
        """Its numbers and options by name, each with its data field."""
        return {f.name: k for k, f in enumerate(self.fields) if f.kind not in ("", "r")}

    @cached_property
    def places(self) -> dict[str, list[int]]:
        """By attribute: its data fields."""
        found: dict[str, list[int]] = {}
        for k, f in enumerate(self.fields):
            if f.kind:
                found.setdefault(f.attribute, []).append(k)
        return found

    @property
    def open_end(self) -> bool:
        """Whether more may follow than its fields."""
        return bool(self.repeated or self.more) or self.layout.endswith("...")

    def place(self, name: str) -> int:
        """Return the data field of a name in the guide."""
        return next(k for k, f in enumerate(self.fields) if f.name == name)

    @property
    def element(self) -> Element | None:
        """Element of the core that it stands for, that without middle nodes."""
        return ELEMENTS[self.elements.split()[0]] if self.elements else None

    @cached_property
    def grid_fields(self) -> tuple[int, ...]:
        """Data fields that hold grids."""
        held = self.grids.split()
        return tuple(k for k, f in enumerate(self.fields) if f.attribute in held)

    @cached_property
    def type(self) -> type[Any]:
        """Class of the cards as read."""
        fields = (f for f in (*self.fields, *self.repeated) if f.kind)
        names = (*dict.fromkeys(f.attribute for f in fields), *self.extra.split())
        return namedtuple(self.name, names)

    def grids_of(self, card: Values) -> list[int]:
        """Grids and scalar points that a card refers to."""
        held = [getattr(card, name) for name in self.grids.split() if hasattr(card, name)]
        found: list[int] = []
        while held:
            part = held.pop(0)
            if isinstance(part, tuple):
                held = [*part, *held]
            elif part:
                found.append(part)
        return found
