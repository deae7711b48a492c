"""What cards say of points, materials, sections and constraints, in numbers."""
