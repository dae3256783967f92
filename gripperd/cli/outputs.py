"""Files that a command writes: checked before its work, written after it."""

from collections.abc import Mapping
from os.path import realpath
from pathlib import Path

from gripperd.errors import InputError


def check_outputs(outputs: Mapping[str, Path], inputs: Mapping[str, Path]) -> None:
    """Complain before the work, not after it.

    Parameters
    ----------
    outputs
        Files to write, by the option that names each.
    inputs
        Files that are read, by what each is, such as ``the recording``.

    Raises
    ------
    InputError
        One cannot be written, or would take the place of an input or of another.
    """
    taken = dict(inputs)
    for option, place in outputs.items():
        for what, other in taken.items():
            if _is_same(place, other):
                message = f"{place}: is {what}; name another file for {option}"
                raise InputError(message, key=option)
        _check_place(place, option)
        taken[f"the file for {option}"] = place


def write(place: Path, text: str) -> None:
    """Write a file.

    Raises
    ------
    InputError
        It cannot be written.
    """
    try:
        place.write_text(text, encoding="utf-8")
    except OSError as refusal:
        raise _unwritable(place, refusal) from refusal


def _is_same(one: Path, other: Path) -> bool:
    if one.exists() and other.exists():
        return one.samefile(other)
    return _real(one) == _real(other)


def _real(place: Path) -> Path:
    """Where links lead to; as far as they do where they lead round in a circle."""
    return Path(realpath(place))


def _check_place(place: Path, option: str) -> None:
    if not place.parent.is_dir():
        message = f"{place}: there is no folder {place.parent}"
        raise InputError(message, key=option)
    if place.is_dir():
        message = f"{place}: is a folder; name a file in it"
        raise InputError(message, key=option)
    if place.exists() and not place.is_file():
        # A pipe: opening it would already tell its reader something.
        return
    # Of a link, the file it leads to: only that is made and removed.
    real = _real(place)
    try:
        if real.exists():
            real.open("ab").close()
        else:
            real.open("xb").close()
            real.unlink()
    except OSError as refusal:
        raise _unwritable(place, refusal) from refusal


def _unwritable(place: Path, refusal: OSError) -> InputError:
    return InputError(f"{place}: cannot be written: {refusal.strerror}")
