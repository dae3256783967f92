"""A rig that hides one effect, and the whole way to finding it."""

from gripperd.demo.rig import Hidden
from gripperd.demo.story import Story, demonstrate

__all__ = ["Hidden", "Story", "demonstrate"]
