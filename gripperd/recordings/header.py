"""The names over the columns: what must be there, what is mistaken for something."""

import re
from collections import Counter
from collections.abc import Sequence
from types import MappingProxyType

from gripperd.config.complaint import printable
from gripperd.diagnose.readings.columns import BY_QUANTITY, COLUMNS, TIME, Column
from gripperd.errors import InputError

RUN = "run"
IDENTITIES = ("muscle", "muscle_serial", "rest_length_mm")
"""Columns that tell which muscle was measured; a recording is of one."""
WORDS = (RUN, *IDENTITIES)
"""Columns of text."""

UNITS = frozenset(
    word
    for words in (
        "n kn mn lbf lb kgf kg g",
        "pa hpa kpa mpa bar mbar barg psi psig atm torr mmhg",
        "a ma ua v mv percent pct % ratio",
        "mm cm m um in inch inches deg",
        "c k f degc degf celsius kelvin",
        "s ms us min h sec seconds hours",
    )
    for word in words.split()
)
"""What stands behind a name when it is a unit, in small letters."""
SYNONYMS = MappingProxyType(
    {"t": "time", "strain": "contraction", "temp": "temperature"}
)


def judge_names(source: str, names: Sequence[str]) -> tuple[str, ...]:
    """Refuse names that cannot be right; give a remark on each that is not read.

    Raises
    ------
    InputError
        A name stands twice, is missing, or has another unit than is expected.
    """
    for name, count in Counter(names).items():
        if count > 1:
            detail = f'{source}: column "{printable(name)}" stands {count} times'
            raise InputError(detail)
    unread = [name for name in names if name not in COLUMNS and name not in WORDS]
    for name in unread:
        meant = misnamed(name)
        if meant and meant.name not in names:
            unit = f" in {meant.unit}" if meant.unit else " as a ratio"
            detail = (
                f'{source}: column "{printable(name)}": {meant.quantity} is expected'
                f'{unit}, in a column "{meant.name}"'
            )
            raise InputError(detail)
    for name in (RUN, TIME.name):
        if name not in names:
            shown = ", ".join(printable(there) for there in names[:20])
            detail = f"{source}: column {name} is missing; there are: {shown}"
            raise InputError(detail)
    return tuple(_unread(name, names) for name in unread)


def _unread(name: str, names: Sequence[str]) -> str:
    """Say that a column is not read, and what it may have been meant to be."""
    unit = name.rpartition("_")[2].casefold()
    meant = [
        column.name
        for column in COLUMNS.values()
        if column.unit.casefold() == unit and column.name not in names
    ]
    said = f'Column "{printable(name)}" is not read'
    return f"{said}; is it {' or '.join(meant)}?" if unit and meant else f"{said}."


def misnamed(name: str) -> Column | None:
    """Give the column that was meant by a name with another unit, or none.

    >>> misnamed("force_lbf").name
    'force_N'
    >>> misnamed("force_raw") is None
    True
    """
    words = re.findall(r"[a-z%]+", name.casefold().replace("µ", "u"))
    if not words or not UNITS.issuperset(words[1:]):
        return None
    return BY_QUANTITY.get(SYNONYMS.get(words[0], words[0]))
