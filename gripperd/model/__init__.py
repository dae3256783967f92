"""Textbook physics of the chain from valve current to grip force.

Pure functions of SI values: no I/O, no clock. The equation numbers are those of
"Study on static characteristics of pneumatic muscles", called *the paper*.
"""

from gripperd.model.chain import Chain
from gripperd.model.effect import Direction, MuscleEffect, MuscleState
from gripperd.model.linkage import Linkage
from gripperd.model.muscle import Muscle
from gripperd.model.prediction import Prediction
from gripperd.model.pressed import PressedObject
from gripperd.model.regulator import Regulator
from gripperd.model.static import StaticMuscle

__all__ = [
    "Chain",
    "Direction",
    "Linkage",
    "Muscle",
    "MuscleEffect",
    "MuscleState",
    "Prediction",
    "PressedObject",
    "Regulator",
    "StaticMuscle",
]
