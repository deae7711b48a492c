"""OUTPUT4 files, and what a matrix of Nastran is."""
