"""What was measured, cut into sweeps, and what of it is believed."""
