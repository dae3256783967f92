"""Where the configuration that ships with the package lies."""

from pathlib import Path

PACKAGE = Path(__file__).parents[1]


def shipped(name: str = "") -> Path:
    """Path of a shipped file: inside an installed package, or in the checkout."""
    installed = PACKAGE / "_shipped"
    folder = installed if installed.is_dir() else PACKAGE.parent / "config"
    return folder / name
