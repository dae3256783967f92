"""Talk to hardware. The simulated rig is hardware like any other: across a wire."""
