"""MAC, pairing of modes, clusters of close modes turned onto each other."""
