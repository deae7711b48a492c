"""Cards of shells, panels and bodies of revolution."""
