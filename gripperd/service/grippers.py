"""Grippers: their states, stop, enable and disable."""

from starlette.responses import Response

from gripperd.control.snapshot import GripperState
from gripperd.link.control import Disable, Enable, Stop
from gripperd.service.body import router
from gripperd.service.context import Context, Daemon
from gripperd.service.rendering import Document
from gripperd.service.state import StateDocument, state_document

routes = router("grippers")


class Grippers(Document):
    """Every gripper there is."""

    grippers: tuple[StateDocument, ...]


@routes.get("/grippers")
async def list_grippers(daemon: Daemon) -> Grippers:
    """State of every gripper."""
    seen = [await daemon.states.get(name) for name in daemon.fleet]
    return Grippers(grippers=tuple(each.document for each in seen))


@routes.get("/grippers/{gripper}", response_model=StateDocument)
async def read_gripper(daemon: Daemon, gripper: str) -> Response:
    """State of one gripper; up to 5 ms older than `age_ms` says."""
    seen = await daemon.states.get(daemon.gripper(gripper).name)
    return Response(seen.json, media_type="application/json")


@routes.post("/grippers/{gripper}/stop")
async def stop(daemon: Daemon, gripper: str) -> StateDocument:
    """Freeze at once and end every command. Never queues, never releases."""
    return await _changed(daemon, Stop(gripper))


@routes.post("/grippers/{gripper}/enable")
async def enable(daemon: Daemon, gripper: str) -> StateDocument:
    """Allow commands; nothing moves."""
    return await _changed(daemon, Enable(gripper))


@routes.post("/grippers/{gripper}/disable")
async def disable(daemon: Daemon, gripper: str) -> StateDocument:
    """Allow no more commands; the current stays, and with it the grip."""
    return await _changed(daemon, Disable(gripper))


async def _changed(daemon: Context, request: Stop | Enable | Disable) -> StateDocument:
    settings = daemon.gripper(request.gripper)
    return state_document(await daemon.change(request, GripperState), settings)
