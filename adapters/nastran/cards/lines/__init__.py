"""Cards of bars, rods and beams."""
