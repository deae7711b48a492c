"""Reduced bases, and derivatives of eigenvalues and eigenvectors."""
