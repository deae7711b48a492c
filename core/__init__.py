"""The neutral model and its mathematics; knows numpy and scipy only."""
