"""The run folder: what a verb leaves behind."""
