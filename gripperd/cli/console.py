"""Where commands print: names of others stand there as they are."""

from rich.console import Console


def console(
    *, stderr: bool = False, soft_wrap: bool = False, highlight: bool = False
) -> Console:
    """Give a console that takes no brackets for styles and no colons for emoji."""
    return Console(
        stderr=stderr,
        markup=False,
        emoji=False,
        soft_wrap=soft_wrap,
        highlight=highlight,
    )
