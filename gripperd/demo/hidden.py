"""What the rig of the demonstration does and its model does not know of."""

from enum import StrEnum


class Hidden(StrEnum):
    """What the rig does and the model does not know of."""

    CREEP = "creep"
    THRESHOLD = "threshold"
    HYSTERESIS = "hysteresis"
