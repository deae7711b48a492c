"""The verbs of the library: files or objects in, typed results out; `cli` speaks them."""
