"""Files and objects in, files out: decks, tests, modes, matrices, plants for simulators."""
