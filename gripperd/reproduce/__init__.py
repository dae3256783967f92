"""The paper, redone: its equations, figures and table, and which claims hold.

*The paper* is "Study on static characteristics of pneumatic muscles". Drawing needs
the extra ``reproduce``; the numbers do not.
"""

from gripperd.reproduce.claims import Claim, Verdict, judge
from gripperd.reproduce.report import Report, draw_force_vs_size, reproduce
from gripperd.reproduce.samples import PAPER_CURRENT, SAMPLES, Grasp, Sample, table_1

__all__ = [
    "PAPER_CURRENT",
    "SAMPLES",
    "Claim",
    "Grasp",
    "Report",
    "Sample",
    "Verdict",
    "draw_force_vs_size",
    "judge",
    "reproduce",
    "table_1",
]
