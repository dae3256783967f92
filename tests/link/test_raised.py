"""Every error of a line arrives at the other end as what it was."""

import pytest

from gripperd import errors
from gripperd.link.frames import failed, raised


@pytest.mark.parametrize(
    "error",
    [
        errors.LinkError("a"),
        errors.LinkLost("b"),
        errors.ReplyTimeout("c"),
        errors.BadReply("d"),
        errors.LocalEcho("e"),
        errors.ModuleMismatch("f"),
        errors.DeviceRefused("g"),
        errors.DeviceRefused("h", exception_code=6),
        errors.WatchdogTripped("i"),
    ],
    ids=lambda error: f"{type(error).__name__} {error}",
)
def test_an_error_of_a_line_arrives_as_it_was(error: errors.LinkError) -> None:
    arrived = raised(failed(error))
    assert type(arrived) is type(error)
    assert str(arrived) == str(error)
    code = getattr(error, "exception_code", None)
    assert getattr(arrived, "exception_code", None) == code
