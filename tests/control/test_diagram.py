from pathlib import Path

from gripperd.control.diagram import page
from gripperd.control.monitors.policy import Cause

DOCUMENT = Path(__file__).parents[2] / "docs" / "states.md"


def test_the_document_is_what_the_tables_say() -> None:
    written = DOCUMENT.read_text()
    assert written == page(), "python -m gripperd.control.diagram > docs/states.md"


def test_the_document_shows_both_machines_and_every_cause() -> None:
    written = DOCUMENT.read_text()
    assert "    fault --> disabled: reset\n" in written
    assert "    holding --> part_lost: loss, miss, let_go\n" in written
    assert written.count("stateDiagram-v2") == 2
    for cause in Cause:
        assert f"| `{cause}` |" in written
