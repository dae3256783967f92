"""A simulated rig that can fail to grip: physics, sensors and faults."""
