"""The sparse sensor map: from analysis shapes to what sensors read."""
