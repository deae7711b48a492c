"""Element matrices, vectorised over elements."""
