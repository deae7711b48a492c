"""Several datasets as one set of modes or responses."""
