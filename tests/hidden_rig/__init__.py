"""A rig with something hidden, simulated by other hands than the model's."""

from tests.hidden_rig.case import Case, make_case
from tests.hidden_rig.draw import ARTEFACTS, FAMILIES, KINDS
from tests.hidden_rig.hidden import NAMES, OUTSIDE

__all__ = ["ARTEFACTS", "FAMILIES", "KINDS", "NAMES", "OUTSIDE", "Case", "make_case"]
