from gripperd.diagnose.residuals.constants import GRIPPER, MUSCLE, VALVE
from gripperd.diagnose.verdict.key import CONSTANTS


def test_whatever_may_be_called_wrong_has_a_key() -> None:
    owned = {"muscle": MUSCLE, "valve": VALVE, "gripper": GRIPPER}
    paths = {f"{owner}.{name}" for owner, names in owned.items() for name in names}
    assert paths <= CONSTANTS.keys()
