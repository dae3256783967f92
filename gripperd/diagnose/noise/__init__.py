"""Noise of a column: how loud it is, what it remembers, how it drifts."""
