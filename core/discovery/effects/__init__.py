"""The kinds of effects: one module each, one list."""

from ...errors import InputError, require_kind
from . import (
    distributed_mass,
    ground_spring,
    joint_flexibility,
    link_spring,
    local_damper,
    local_stiffness,
    point_mass,
    support_flexibility,
    tuned_absorber,
)
from .candidates import Candidates as Candidates
from .effect_kind import (
    FACTOR as FACTOR,
    MASS as MASS,
    STIFFNESS as STIFFNESS,
    EffectKind as EffectKind,
    Magnitude as Magnitude,
    Scale as Scale,
)

KINDS: dict[str, EffectKind] = {
    k.name: k
    for k in (
        point_mass.KIND,
        distributed_mass.KIND,
        local_stiffness.KIND,
        ground_spring.KIND,
        support_flexibility.KIND,
        joint_flexibility.KIND,
        tuned_absorber.KIND,
        link_spring.KIND,
        local_damper.KIND,
    )
}


def register_effect(kind: EffectKind) -> None:
    """Let discovery look for a further kind of effect; ``del KINDS[name]`` takes it away.

    Raises
    ------
    InputError
        A name that another kind has.
    """
    require_kind(kind, EffectKind, "what is registered")
    if kind.name in KINDS:
        raise InputError(f"there is a kind of effect named {kind.name} already")
    KINDS[kind.name] = kind
