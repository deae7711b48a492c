"""Modal plants for simulators: Functional Mock-up Units of one C kernel, and plain arrays."""

from .write_state_space import write_state_space
from .write_unit import write_unit

__all__ = ["write_state_space", "write_unit"]
