"""Diagnoses wait for their turn: one runs at a time, in a process of its own."""

import asyncio
from asyncio import Task, to_thread
from collections import deque
from collections.abc import Callable
from dataclasses import replace
from datetime import datetime

import structlog

from gripperd.errors import GripperdError, NotFound, Refused
from gripperd.service.child import Judged, Progress, work
from gripperd.service.problems import code_of
from gripperd.store.diagnoses import Diagnoses, Status, StoredDiagnosis, Why
from gripperd.store.recordings import Recordings

LONGEST_QUEUE = 16
WAITING = Progress("waiting", 0.0)

log = structlog.get_logger()


class Diagnosing:
    """Runs what was asked for, in that order.

    Parameters
    ----------
    kept
        Where diagnoses are written down.
    recordings
        What they are about.
    now
        The time of day, with its zone.
    """

    def __init__(
        self, kept: Diagnoses, recordings: Recordings, now: Callable[[], datetime]
    ) -> None:
        self.kept = kept
        self._recordings = recordings
        self._now = now
        self._waiting: deque[str] = deque()
        self._running: str | None = None
        self._began: datetime | None = None
        self._progress = WAITING
        self._unwritten: dict[str, StoredDiagnosis] = {}
        self._job: Task[Judged] | None = None
        self._serving: Task[None] | None = None

    async def open(self) -> None:
        """Find what was done before, and be ready for more."""
        try:
            await to_thread(self.kept.give_up_interrupted, self._now())
        except Refused as error:
            # A full disk must not keep anybody from stopping a gripper.
            log.warning("diagnoses cannot be kept", reason=str(error))

    async def close(self) -> None:
        """End what runs; the next life finds that it was interrupted."""
        if self._serving is not None:
            self._serving.cancel()
            await asyncio.gather(self._serving, return_exceptions=True)

    def check_room(self) -> None:
        """Refuse more than can wait.

        Raises
        ------
        Refused
            With the number.
        """
        if len(self._waiting) >= LONGEST_QUEUE:
            message = f"{LONGEST_QUEUE} diagnoses are waiting already"
            hints = ("wait, or cancel one",)
            raise Refused(message, code="queue-full", hints=hints)

    def add(self, diagnosis: StoredDiagnosis) -> None:
        """Let a diagnosis that was written down wait for its turn."""
        self._waiting.append(diagnosis.id)
        if self._serving is None or self._serving.done():
            self._serving = asyncio.create_task(self._serve())

    def now(self, diagnosis: str) -> tuple[StoredDiagnosis, Progress | None]:
        """One diagnosis as it stands, and how far it is while it is not over.

        Raises
        ------
        NotFound
            There is none.
        """
        return self.standing(self.kept.get(diagnosis))

    def standing(
        self, written: StoredDiagnosis
    ) -> tuple[StoredDiagnosis, Progress | None]:
        """What was written down, and how far it is by now.

        That it runs is nowhere written: who reads it would be another life.
        """
        written = self._unwritten.get(written.id, written)
        if written.final:
            return written, None
        if written.id != self._running:
            return written, WAITING
        running = replace(written, status=Status.RUNNING, started_at=self._began)
        return running, self._progress

    async def cancel(self, diagnosis: str) -> StoredDiagnosis:
        """End one that waits or runs.

        Raises
        ------
        NotFound, Refused
            There is none; or it is over already.
        """
        found = await to_thread(self.kept.get, diagnosis)
        job = self._job
        if diagnosis in self._waiting:
            self._waiting.remove(diagnosis)
        elif diagnosis != self._running or job is None or not await _stopped(job):
            message = f"diagnosis {diagnosis} is over"
            raise Refused(message, code="already-final")
        return await self._end(found, status=Status.CANCELLED)

    async def _serve(self) -> None:
        while self._waiting:
            self._running, self._began = self._waiting.popleft(), self._now()
            self._job = asyncio.create_task(self._judge(self._running))
            try:
                await asyncio.wait([self._job])
                await self._conclude(self._running, self._job)
            except (Refused, NotFound) as error:
                log.error("a diagnosis is lost", id=self._running, reason=str(error))
            finally:
                await _stopped(self._job)
                self._running, self._job, self._progress = None, None, WAITING

    async def _judge(self, diagnosis: str) -> Judged:
        found = await to_thread(self.kept.get, diagnosis)
        recording = await to_thread(self._recordings.get, found.recording)
        if not await to_thread(self._recordings.intact, found.recording):
            message = f"{recording.file} is not the file that was sent; send it again"
            raise Refused(message, code="recording-damaged")
        file = self._recordings.path(recording)
        place = self.kept.place(diagnosis).absolute()
        return await work(
            "diagnose", file.name, str(place), str(found.seed),
            reply=Judged, folder=file.parent, tell=self._tell,
        )  # fmt: skip

    async def _conclude(self, diagnosis: str, job: Task[Judged]) -> None:
        if job.cancelled():
            # Who cancelled it writes that down.
            return
        found = await to_thread(self.kept.get, diagnosis)
        if (error := job.exception()) is not None:
            why = Why(code=_code(error), message=str(error))
            await self._end(found, status=Status.FAILED, error=why)
            return
        judged = job.result()
        done = replace(
            found,
            verdict=judged.verdict,
            objection=judged.objection,
            unprinted=judged.unprinted,
        )
        await self._end(done, status=Status.SUCCEEDED)

    def _tell(self, progress: Progress) -> None:
        self._progress = progress

    async def _end(
        self, diagnosis: StoredDiagnosis, *, status: Status, error: Why | None = None
    ) -> StoredDiagnosis:
        ended = replace(
            diagnosis,
            status=status,
            error=error,
            started_at=self._began if diagnosis.id == self._running else None,
            completed_at=self._now(),
        )
        try:
            await to_thread(self.kept.put, ended)
        except Refused as refused:
            log.error("a diagnosis is lost", id=ended.id, reason=str(refused))
            if status is Status.SUCCEEDED:
                why = Why(code=refused.code, message=str(refused))
                ended = replace(diagnosis, status=Status.FAILED, error=why)
            # Told as long as this service lives; the next one calls it interrupted.
            self._unwritten[ended.id] = ended
        return ended


async def _stopped(job: Task[Judged]) -> bool:
    """End a job; whether it had not ended by itself."""
    job.cancel()
    await asyncio.wait([job])
    return job.cancelled()


def _code(error: BaseException) -> str:
    if isinstance(error, GripperdError):
        return code_of(error)
    log.error("a diagnosis met a defect", exc_info=error)
    return "internal"
