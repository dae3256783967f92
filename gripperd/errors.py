"""Everything gripperd raises on purpose, told from the caller's side.

::

    GripperdError
     ├─ InputError          a value you gave is unusable; nothing was changed
     │   ├─ DomainError     the physics has no answer there
     │   └─ NotFound        there is nothing by the name you gave
     ├─ ConfigError         the configuration is unusable; nothing was started
     ├─ Refused             what you ask is not allowed now, or would do harm
     └─ LinkError           no trustworthy answer came over a line
         ├─ LinkLost        there is no connection
         │   └─ NotConnected    nor was there one to send anything over
         ├─ ReplyTimeout    no reply inside the deadline
         ├─ BadReply        a reply that does not answer the request
         │   └─ LocalEcho   it is the request itself, heard on the same line
         ├─ ModuleMismatch  a module is set up otherwise than the settings say
         └─ DeviceRefused   the device understood, and said no
             └─ WatchdogTripped   and will, until its watchdog is cleared
"""


class GripperdError(Exception):
    """Base of all errors below; anything else that escapes is a defect."""


class InputError(GripperdError, ValueError):
    """A value you gave is unusable; the message names it, its unit and its limit.

    Parameters
    ----------
    message
        What is wrong, for a person.
    key
        The name of the value as you spelled it, when it has one.
    """

    def __init__(self, message: str, *, key: str | None = None) -> None:
        super().__init__(message)
        self.key = key


class DomainError(InputError):
    """The physics has no answer there, for example past the end of the stroke."""


class NotFound(InputError, LookupError):
    """There is nothing by the name you gave."""


class ConfigError(GripperdError, ValueError):
    """The configuration is unusable; every complaint names file, line and key.

    Parameters
    ----------
    complaints
        One line each, all that were found.
    """

    def __init__(self, *complaints: str) -> None:
        super().__init__("\n".join(complaints))
        self.complaints = complaints


class Refused(GripperdError):
    """What you ask is not allowed now, or would do harm; nothing moved.

    Parameters
    ----------
    message
        Why, with the numbers.
    code
        A stable word for programs, such as ``wrong-state``.
    hints
        What you could do instead.
    """

    def __init__(self, message: str, *, code: str, hints: tuple[str, ...] = ()) -> None:
        super().__init__(message)
        self.code = code
        self.hints = hints


class LinkError(GripperdError, OSError):
    """No trustworthy answer came over a line."""


class LinkLost(LinkError, ConnectionError):
    """There is no connection; whether the last command arrived is unknown."""


class NotConnected(LinkLost):
    """There was no connection, so nothing was sent: asking again does no harm."""


class ReplyTimeout(LinkError, TimeoutError):
    """No reply inside the deadline; the line has been reopened since."""


class BadReply(LinkError):
    """A reply that does not answer the request; it was not believed."""


class LocalEcho(BadReply):
    """The reply is the request itself: the line hands back what is sent on it."""


class ModuleMismatch(LinkError):
    """A module is set up otherwise than the settings say; it was not driven."""


class DeviceRefused(LinkError):
    """The device understood the request and said no.

    Parameters
    ----------
    message
        The request and the exception, in words.
    exception_code
        The Modbus exception code (Modbus Application Protocol V1.1b3, section 7);
        None from devices that speak something else.
    """

    def __init__(self, message: str, *, exception_code: int | None = None) -> None:
        super().__init__(message)
        self.exception_code = exception_code


class WatchdogTripped(DeviceRefused):
    """The device has missed its host: its outputs are at their safe values.

    It ignores what it is told to put out until the watchdog is cleared.
    """
