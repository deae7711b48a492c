"""The neutral store (HDF5)."""
