"""How well a hypothesis explains the test."""
