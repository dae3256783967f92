from structlog.testing import capture_logs

from gripperd.service.refusals import EVERY, Refusals


def test_a_refusal_is_logged_with_its_code_and_reason() -> None:
    with capture_logs() as logged:
        Refusals(lambda: 0.0).note("misdirected", "not called 'evil\x1b[2J'")
    assert logged == [
        {
            "event": "refused",
            "log_level": "warning",
            "code": "misdirected",
            "reason": "not called 'evil\\x1b[2J'",
            "untold": 0,
        }
    ]


def test_many_refusals_of_a_kind_are_counted_and_do_not_fill_the_log() -> None:
    now = 0.0
    refusals = Refusals(lambda: now)
    with capture_logs() as logged:
        for _ in range(1000):
            refusals.note("foreign-origin", "a page")
        refusals.note("misdirected", "a name")
        now = EVERY
        refusals.note("foreign-origin", "a page")
    told = [(entry["code"], entry["untold"]) for entry in logged]
    assert told == [("foreign-origin", 0), ("misdirected", 0), ("foreign-origin", 999)]
