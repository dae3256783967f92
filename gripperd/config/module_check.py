"""What a schema cannot see: whether a description agrees with itself."""

import math
from collections.abc import Iterator, Sequence
from typing import TypeAlias

from gripperd.config.complaint import Complaint, did_you_mean
from gripperd.config.document import Document
from gripperd.config.module_parts import VectorSection
from gripperd.config.wording import shown
from gripperd.protocol.encoding import Encoding, Range, ValueType
from gripperd.protocol.engineering import engineering
from gripperd.protocol.itv import Set
from gripperd.protocol.modules import InputModule, OutputModule, OutputPhrases
from gripperd.units import MILLI

AnyModule: TypeAlias = OutputModule | InputModule


def contradictions(
    module: AnyModule, vectors: Sequence[VectorSection], document: Document
) -> Iterator[Complaint]:
    """Everything in a description that cannot be meant."""
    yield from _speechless(module, document)
    yield from _uncounted(module, document)
    yield from _overflowing(module, document)
    yield from _meaningless(module, document)
    yield from _untimed(module, document)
    yield from _contradicted(module, vectors, document)


def _speechless(module: AnyModule, document: Document) -> Iterator[Complaint]:
    if not module.dialects:
        detail = "says nothing of modbus, dcon, adam_ascii or itv: it cannot be asked"
        yield document.complaint((), detail)


def _uncounted(module: AnyModule, document: Document) -> Iterator[Complaint]:
    """Whole counts of mA would be too coarse to be meant."""
    whole = module.modbus and module.modbus.encoding.type is not ValueType.F32
    for name, each in module.ranges.items():
        ends = (each.current_low / MILLI, each.current_high / MILLI)
        if whole and (each.count_low, each.count_high) == ends:
            detail = "counts are missing: integer registers do not count in mA"
            yield document.complaint(("ranges", name), detail)
        if _asks_for_codes(module) and each.code is None:
            detail = "code is missing: there is a range_code to compare it with"
            yield document.complaint(("ranges", name), detail)


def _asks_for_codes(module: AnyModule) -> bool:
    spoken = (phrases.range_code for phrases in module.phrases.values())
    return any((module.modbus and module.modbus.range_code, *spoken))


def _overflowing(module: AnyModule, document: Document) -> Iterator[Complaint]:
    """Counts that would become others in a register."""
    encoding = module.modbus.encoding if module.modbus else None
    for name, each in module.ranges.items():
        for count in (each.count_low, each.count_high) if encoding else ():
            if encoding and abs(_there_and_back(encoding, count) - count) > (
                encoding.resolution
            ):
                detail = f"counts: {count:g} does not fit {encoding.type}"
                yield document.complaint(("ranges", name), detail)


def _there_and_back(encoding: Encoding, count: float) -> float:
    try:
        return encoding.decode(encoding.encode(count))
    except OverflowError:
        return math.inf


def _untimed(module: AnyModule, document: Document) -> Iterator[Complaint]:
    """Time-outs with more digits than a line has."""
    for dialect, phrases in module.phrases.items():
        watchdog = phrases.watchdog if isinstance(phrases, OutputPhrases) else None
        if watchdog and len(watchdog.time_text(watchdog.longest)) > watchdog.digits:
            detail = f"{watchdog.longest:g} s does not fit {watchdog.digits} digits"
            yield document.complaint((dialect, "watchdog", "longest_s"), detail)


def _meaningless(module: AnyModule, document: Document) -> Iterator[Complaint]:
    """Signs that nobody would be told of, and bits that are never read."""
    status = module.modbus.status if module.modbus else None
    known = [*status.bits, *filter(None, [status.fail_safe])] if status else []
    for bit in known:
        if status and bit >= 16 * status.words:
            detail = f"bit {bit} is beyond the {16 * status.words} bits that are read"
            yield document.complaint(("modbus", "status"), detail)
    for condition, sign in (status.signs if status else {}).items():
        if status and not status.causes((sign & 0xFFFF, sign >> 16)):
            detail = f"{sign} stands neither in bits nor in codes"
            yield document.complaint(("modbus", "status", "signs", condition), detail)


def _contradicted(
    module: AnyModule, vectors: Sequence[VectorSection], document: Document
) -> Iterator[Complaint]:
    """Vectors that the rest of the description does not give."""
    for place, vector in enumerate(vectors):
        path = ("vectors", place)
        if vector.range is not None and vector.range not in module.ranges:
            hint = did_you_mean(vector.range, module.ranges)
            yield document.complaint(path, f"{vector.range} is not a range; {hint}")
            continue
        if not vector.registers and vector.text is None:
            yield document.complaint(path, "has neither registers nor text")
        chosen = module.range(vector.range)
        current = vector.current_mA * MILLI
        said = _registers(module, chosen, current)
        if vector.registers and said != tuple(vector.registers):
            detail = f"{vector.current_mA:g} mA is {_hex(said)} by the rest of the file"
            yield document.complaint(path, f"{detail}, not {_hex(vector.registers)}")
        text = _text(module, chosen, current)
        if vector.text is not None and vector.text != text:
            detail = f'{vector.current_mA:g} mA is "{text}" by the rest of the file'
            yield document.complaint(path, f"{detail}, not {shown(vector.text)}")


def _registers(module: AnyModule, chosen: Range, current: float) -> tuple[int, ...]:
    if module.modbus is None:
        return ()
    return module.modbus.encoding.encode(chosen.count(current))


def _text(module: AnyModule, chosen: Range, current: float) -> str:
    """What is sent to channel 0 of unit 1, or comes from it."""
    if isinstance(module, InputModule):
        return engineering(current)
    if module.itv:
        return str(Set(round(chosen.count(current))))
    filled = {"channel": "0", "value": engineering(current)}
    lines = (spoken.write.question(1, filled) for spoken in module.phrases.values())
    return str(next(lines, ""))


def _hex(words: Sequence[int]) -> str:
    return " ".join(f"0x{word:04X}" for word in words) or "nothing"
