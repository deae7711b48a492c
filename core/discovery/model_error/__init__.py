"""What a model that lacks nothing still gets wrong, and how likely a test is by such a model."""
