"""REST: the only place that knows HTTP."""
