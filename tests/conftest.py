"""Hypothesis without deadlines: how long an example takes says more of the machine's load."""

from hypothesis import settings

settings.register_profile("trueup", deadline=None)
settings.load_profile("trueup")
