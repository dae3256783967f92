"""How commands end that control cannot end any more."""

from gripperd.control.command import Status
from gripperd.service.command_documents import CommandDocument, FailureDocument
from gripperd.service.rendering import timestamp
from gripperd.store.history import CommandRecord

RESTARTED = FailureDocument(
    category="fault",
    code="control-restarted",
    message="the control process ended before the command did; what was held is held",
)
NEVER_BEGUN = FailureDocument(
    category="fault",
    code="not-delivered",
    message="the command did not reach the control process; nothing moved",
)


def ended(
    record: CommandRecord, failure: FailureDocument, at: float
) -> CommandDocument:
    """Make a failed command of one that was left without an end.

    Parameters
    ----------
    record
        As it was kept.
    failure
        Why it ended.
    at
        Seconds since the epoch.
    """
    command = CommandDocument.model_validate_json(record.document)
    return command.model_copy(
        update={
            "status": Status.FAILED,
            "completed_at": timestamp(at),
            "phase": None,
            "error": failure,
        }
    )
