"""Predictions against the numbers of the design and by going there and back."""

import pytest

from .conftest import Daemon
from .test_bad_input import is_problem

PREDICTIONS = "/v1/predictions"


def test_the_papers_current_holds_all_four_objects(daemon: Daemon) -> None:
    body = {"current_mA": 10.7, "diameter_mm": [65, 58, 41, 22]}
    found = daemon.http.post(PREDICTIONS, json=body).json()
    assert (found["gripper"], found["model"]) == ("g0", "reference")
    forces = [each["force_N"] for each in found["predictions"]]
    assert forces == pytest.approx([47.6, 39.8, 22.5, 5.6], abs=0.05)
    assert [each["diameter_mm"] for each in found["predictions"]] == [65, 58, 41, 22]
    for each in found["predictions"]:
        # 4-20 mA to 0-500 kPa.
        assert each["pressure_kPa"] == pytest.approx(6.7 / 16 * 500, abs=0.001)
        assert each["std_N"] > 0
        assert (each["reaches"], each["extrapolated"]) == (True, False)


def test_force_to_current_is_current_to_force_backwards(daemon: Daemon) -> None:
    there = {"force_N": 12, "diameter_mm": 58, "stiffness_N_per_mm": 10}
    (first,) = daemon.http.post(PREDICTIONS, json=there).json()["predictions"]
    back = there | {"current_mA": first["current_mA"]}
    del back["force_N"]
    (second,) = daemon.http.post(PREDICTIONS, json=back).json()["predictions"]
    assert second["force_N"] == pytest.approx(12, abs=1e-4)
    # 12 N on 10 N/mm press a jaw's share of 1.2 mm.
    assert second["opening_mm"] == pytest.approx(58 - 1.2, abs=1e-3)


def test_friction_helps_a_muscle_that_extends(daemon: Daemon) -> None:
    body: dict[str, object] = {"current_mA": 10.7, "diameter_mm": 58}
    (closing,) = daemon.http.post(PREDICTIONS, json=body).json()["predictions"]
    body |= {"direction": "extending"}
    (opening,) = daemon.http.post(PREDICTIONS, json=body).json()["predictions"]
    assert opening["force_N"] > closing["force_N"]


def test_jaws_that_do_not_reach_say_so(daemon: Daemon) -> None:
    body = {"current_mA": 5, "diameter_mm": 20}
    (found,) = daemon.http.post(PREDICTIONS, json=body).json()["predictions"]
    assert (found["force_N"], found["reaches"]) == (0, False)


@pytest.mark.parametrize(
    ("body", "pointer", "says"),
    [
        ({"current_mA": 3, "diameter_mm": 41}, "/current_mA", "outside 4 to 20 mA"),
        ({"force_N": 200, "diameter_mm": 41}, "/force_N", "outside 4 to 20 mA"),
        ({"force_N": 12, "current_mA": 9, "diameter_mm": 41}, "", "give either"),
        ({"diameter_mm": 41}, "", "give either"),
        ({"current_mA": 9}, "/diameter_mm", "is missing (mm)"),
        ({"current_mA": 9, "diameter_mm": []}, "/diameter_mm", "is empty"),
        ({"current_mA": 9, "diameter_mm": "41"}, "/diameter_mm", "write 41"),
        ({"current_mA": 9, "diameter_mm": [41, -1]}, "/diameter_mm/1", "-1 mm"),
        ({"current_mA": 9, "diameter_mm": [41, 90]}, "/diameter_mm/1", "not fit"),
        ({"current_mA": 9, "diameter_mm": [41] * 1001}, "/diameter_mm", "1000"),
        ({"current_mA": 9, "diameter_mm": 41, "gripper": "g9"}, "/gripper", "g0"),
        (
            {"force_N": 12, "diameter_mm": 30, "stiffness_N_per_mm": 0.3},
            "/force_N",
            "flat",
        ),
    ],
)
def test_what_cannot_be_predicted_is_named(
    daemon: Daemon, body: dict[str, object], pointer: str, says: str
) -> None:
    answer = daemon.http.post(PREDICTIONS, json=body)
    found = is_problem(answer, 422, "invalid")
    assert [fault["pointer"] for fault in found["errors"]] == [pointer]
    assert says in found["detail"]


def test_a_force_out_of_reach_names_the_most_there_is(daemon: Daemon) -> None:
    most = {"current_mA": 20, "diameter_mm": 41}
    (found,) = daemon.http.post(PREDICTIONS, json=most).json()["predictions"]
    body = {"force_N": 500, "diameter_mm": 41}
    detail = daemon.http.post(PREDICTIONS, json=body).json()["detail"]
    assert f"the most it gives there is {found['force_N']:.1f} N" in detail
