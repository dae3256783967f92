"""One explanation fitted: constants, amplitudes and shapes, linear and in full."""
