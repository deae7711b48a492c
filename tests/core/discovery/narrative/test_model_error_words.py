"""What an error of the model without a place is told as."""

import pytest

from trueup.core.discovery.model_error.diffuse_fit import Drift
from trueup.core.discovery.model_error.set_up_fields import SENSORS
from trueup.core.discovery.narrative.model_error_words import _drift


@pytest.mark.parametrize(
    ("name", "said"),
    [
        (
            "mass from corner to corner in x and y",
            "mass that drifts by 8.4 % from corner to corner",
        ),
        ("stiffness along z", "stiffness that drifts by 8.4 % along z"),
        (SENSORS, "the mass of the sensors, 8.4 % of the structure's in all"),
    ],
)
def test_a_drift_reads_as_a_person_would_say_it(name, said):
    assert _drift(Drift(name, 0.084)).startswith(said)
