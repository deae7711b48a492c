"""Cards of springs, bushings, dashpots, masses and fasteners."""
