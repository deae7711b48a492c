"""Where model and test disagree: the misfit of shapes and frequencies, mapped."""
