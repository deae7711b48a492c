"""Find what a model lacks or what is wrong in a test."""
