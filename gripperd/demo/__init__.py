"""A rig that hides one effect, and the whole way to finding it."""
