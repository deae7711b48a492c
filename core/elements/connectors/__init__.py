"""Springs, bushings, masses, and what joins patches."""
