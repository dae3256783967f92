import numpy as np

from gripperd.diagnose.objection import contradicted, left_out
from gripperd.diagnose.readings.recording import Contradiction, Rejection


def test_where_nothing_was_repeated_nothing_is_said_of_it() -> None:
    found = Contradiction(("a",), ("b",), "force_N", 310.0, "N", np.nan)
    said = contradicted(found)
    assert said.endswith("by 310 N at the same place")


def test_samples_are_left_out_by_column_and_reason() -> None:
    found = [
        Rejection("a", "force_N", 3, "frozen"),
        Rejection("a", "force_N", 1, "spike"),
        Rejection("b", "force_N", 4, "frozen"),
        Rejection("b", "pressure_kPa", 2, "frozen"),
    ]
    assert left_out(found) == [
        "7 of force_N in a and b, frozen",
        "1 of force_N in a, spike",
        "2 of pressure_kPa in b, frozen",
    ]
