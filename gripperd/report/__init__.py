"""A diagnosis as one page for a person.

Drawing needs the extra ``report``; the diagnosis does not.
"""

from gripperd.report.page import page

__all__ = ["page"]
