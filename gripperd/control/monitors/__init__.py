"""What is watched all the time, each thing by itself: samples in, symptoms out."""
