"""What takes part in a discovery: modes of the test, known parameters."""
