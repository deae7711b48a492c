"""Normal modes of a pencil (K, M), each solution checked."""
