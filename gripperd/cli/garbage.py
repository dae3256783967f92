"""Pauses of the garbage collector, which a process that must answer cannot have."""

import gc


def spare_what_stays() -> None:
    """Leave everything there is out of every later collection.

    Modules, routes and models live as long as the process, 150,000 objects in the
    service. A full collection that walks through them stopped every answer for 0.1 s
    a few times a minute under load, and would stop a control loop as well. Call this
    once, when all is loaded and before the work begins.
    """
    gc.collect()
    gc.freeze()
