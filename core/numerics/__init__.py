"""Sparse numerical linear algebra that knows nothing of structures."""
