"""Whether the watchdog of a module can do what the settings ask of it."""

from gripperd.drivers.facts import watchdog_of
from gripperd.drivers.watchdog import BEATS
from gripperd.drivers.wiring import OutputWiring, WatchdogSettings
from gripperd.protocol.watchdog import Watchdog
from gripperd.units import MILLI

ROUNDING = 1e-6
"""So close to a whole number of steps is one: 0.3 s is 3 of 0.1 s. [-]"""


def check_watchdog(wiring: OutputWiring) -> None:
    """Refuse a time-out or a safe value that the module cannot have.

    Raises
    ------
    ValueError
        With what it can.
    """
    asked = wiring.watchdog
    if asked is None:
        return
    watchdog = watchdog_of(wiring)
    if asked.timeout is not None:
        _check_timeout(asked.timeout, watchdog, wiring)
    if asked.safe_current is not None:
        _check_safe_current(asked.safe_current, watchdog, wiring)


def check_kept(asked: WatchdogSettings, rate: float) -> None:
    """Refuse a time-out that control is too slow to keep. [Hz].

    Raises
    ------
    ValueError
        With both.
    """
    if asked.timeout is not None and asked.timeout * rate < BEATS:
        message = (
            f"{rate:g} Hz is too slow for watchdog.timeout_s {asked.timeout:g} s, which"
            f" takes {BEATS} periods or more"
        )
        raise ValueError(message)


def _check_timeout(
    timeout: float, watchdog: Watchdog | None, wiring: OutputWiring
) -> None:
    name = wiring.module.name
    if watchdog is None:
        message = (
            f"watchdog.timeout_s: {name} has no watchdog that can be armed over"
            f" {wiring.dialect}"
        )
        raise ValueError(message)
    if not watchdog.step <= timeout <= watchdog.longest:
        message = (
            f"watchdog.timeout_s: {timeout:g} s is outside {watchdog.step:g} to"
            f" {watchdog.longest:g} s, what {name} takes"
        )
        raise ValueError(message)
    counted = watchdog.steps(timeout) * watchdog.step
    if abs(counted - timeout) > ROUNDING * timeout:
        message = (
            f"watchdog.timeout_s: {timeout:g} s is no whole number of steps of"
            f" {watchdog.step:g} s, in which {name} counts; {counted:g} s is"
        )
        raise ValueError(message)


def _check_safe_current(
    current: float, watchdog: Watchdog | None, wiring: OutputWiring
) -> None:
    name = wiring.module.name
    fixed = watchdog.safe_current if watchdog else None
    if fixed is not None and current != fixed:
        message = (
            f"watchdog.safe_mA: {name} goes to {fixed / MILLI:g} mA on time-out, and"
            f" to nothing else such as {current / MILLI:g} mA"
        )
        raise ValueError(message)
    asked = wiring.module.asked_in(wiring.dialect)
    if fixed is None and (asked is None or asked.safe is None):
        message = f"watchdog.safe_mA: {name} has no safe value over {wiring.dialect}"
        raise ValueError(message)
    wiring.range.check(current, name)
