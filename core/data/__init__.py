"""The neutral nouns: geometry, degrees of freedom, modes, responses, tests, parameters, model."""
