"""What dataset 58 calls functions and what they are of."""

KINDS = {
    0: "general", 1: "time response", 2: "auto spectrum", 3: "cross spectrum",
    4: "frequency response", 5: "transmissibility", 6: "coherence", 7: "auto correlation",
    8: "cross correlation", 9: "power spectral density", 10: "energy spectral density",
    11: "probability density", 12: "spectrum", 13: "cumulative frequency distribution",
    14: "peaks valley", 15: "stress/cycles", 16: "strain/cycles", 17: "orbit",
    18: "mode indicator function", 19: "force pattern", 20: "partial power",
    21: "partial coherence", 22: "eigenvalue", 23: "eigenvector", 24: "shock response spectrum",
    25: "finite impulse response filter", 26: "multiple coherence", 27: "order function",
    28: "phase compensation",
}  # fmt: skip
QUANTITIES = {
    0: "unknown", 1: "general", 2: "stress", 3: "strain", 5: "temperature", 6: "heat flux",
    8: "displacement", 9: "reaction force", 11: "velocity", 12: "acceleration", 13: "force",
    15: "pressure", 16: "mass", 17: "time", 18: "frequency", 19: "rpm", 20: "order",
    21: "sound pressure", 22: "sound intensity", 23: "sound power",
}  # fmt: skip
