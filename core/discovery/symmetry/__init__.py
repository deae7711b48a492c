"""Which places of a structure are alike."""
