"""The commands a person types.

Exit status: 0 done, 1 failed, 2 wrong use or input, 78 unusable configuration.
"""

from gripperd.cli.app import main

__all__ = ["main"]
