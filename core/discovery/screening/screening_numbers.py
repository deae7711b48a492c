"""The tuned numbers of what takes part in a discovery."""

from dataclasses import dataclass

from ...number_table import number

ELASTIC = "of the first elastic frequency"


@dataclass(frozen=True)
class ScreeningNumbers:
    noticed: float = number(0.01, "of f", "shift of a frequency that is noticed")
    most: int = number(12, "parameters", "that are small and may matter move, those with the largest shifts")
    swings: float = number(0.5, ELASTIC, "below which a test mode that moves as a whole swings on its suspension")
    swings_far: float = number(0.15, ELASTIC, "below which it does whatever its shape", "what it moves in is not measured")
    modes_above: float = number(1.6, "of the test's highest frequency", "up to where modes of the model are found, at the usual tolerance of pairs")
    modes_least: int = number(60, "modes", "of the model that are found at least, where it has them many times")
    modes_times: int = number(4, "times the modes", "degrees of freedom a model has to have for that")
    moved: float = number(2e-3, "of a property", "by which a known property has moved if it is to change in the deck")
    pairs: float = number(0.5, "of the test's modes", "that pair at least where nothing is said to be missing")
    repeats: float = number(0.005, "of f", "mean deviation from which on there is a gap", "what a test repeats by when a structure is mounted anew")
    off: float = number(0.15, "of f", "that a mode which pairs is off at most where nothing is said to be missing", "12 % at most in 158 such answers in unseen cases")
    effect: int = number(4, "unknowns", "of one effect: where it is and how large", "three coordinates and a magnitude")
    alike: float = number(0.9, "of 1 - MAC", "that is left where shapes come clearly nearer")
    as_a_whole: float = number(0.8, "of a shape's square", "that rigid motions take up if it moves as a whole")


SCREENING = ScreeningNumbers()
