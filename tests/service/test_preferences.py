"""The header Prefer (RFC 7240)."""

import pytest

from gripperd.service.preferences import preferred_wait


@pytest.mark.parametrize(
    ("headers", "seconds"),
    [
        (["wait=10"], 10),
        (["WAIT = 10"], 10),
        (['wait="10"'], 10),
        (["respond-async, wait=10; foo=1"], 10),
        (["respond-async", "wait=3"], 3),
        (["wait=3, wait=9"], 3),
        (["wait=99999999999999999999"], 999999999),
        (["wait"], None),
        (["wait=-1"], None),
        (["wait=1.5"], None),
        (["wait=\u0664"], None),
        (["waiting=3"], None),
        ([], None),
    ],
)
def test_a_wait_is_understood_or_ignored(
    headers: list[str], seconds: int | None
) -> None:
    assert preferred_wait(headers) == seconds
