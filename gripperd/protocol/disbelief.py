"""How a reply that is not believed is reported."""

from gripperd.errors import BadReply


def not_believed(request: object, why: str, came: str) -> BadReply:
    """The error that says what was asked, what came, and what is wrong with it."""
    return BadReply(f"a reply to '{request}' is not believed: {why} ({came})")
