"""Versions of one model: numbered files that never change, and which one is active.

Version 0 is the configured model file itself, named ``reference`` for example; as it
was when the first version was made from it, ``0.yaml`` has it. Version 3 is the file
``3.yaml``, and the model in it is named ``reference-3``. Both spellings name a version,
and so does :data:`ACTIVE`.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from datetime import datetime
from pathlib import Path

from gripperd.config import Complaint, ModelFile, load_model
from gripperd.config.complaint import did_you_mean, dotted, gathering
from gripperd.config.durable import create_file, remove_file, replace_file
from gripperd.config.lineage import Lineage, Provenance
from gripperd.config.model_text import model_text
from gripperd.config.sealed import check_seal, sealed
from gripperd.errors import ConfigError, NotFound, Refused
from gripperd.store.difference import difference
from gripperd.store.pointer import Pointer, locked, read_pointer, write_pointer
from gripperd.store.records import writing
from gripperd.store.version import Shelf, Version

ACTIVE = "active"
"""Stands for whichever version is active."""
VERSIONS = "[1-9]*.yaml"
"""Files of the versions that were made."""


class Versions:
    """The versions of one model.

    Parameters
    ----------
    folder
        Where they are kept.
    base
        The configured model, version 0.
    """

    def __init__(self, folder: Path, base: ModelFile) -> None:
        self._folder = folder
        self._base = base

    @classmethod
    def kept(cls, folder: Path) -> "Versions | None":
        """Those in a folder, of the model that the first was made from; none if none.

        Raises
        ------
        ConfigError
            That model is damaged.
        """
        base = folder / "0.yaml"
        if not (base.exists() and any(folder.glob(VERSIONS))):
            return None
        check_seal(base)
        return cls(folder, load_model(base))

    @property
    def active(self) -> int:
        """Number of the active version.

        Raises
        ------
        ConfigError
            The file that says so is damaged.
        """
        return self._read_pointer().active

    def add(
        self,
        model: ModelFile,
        *,
        parent: int,
        created_at: datetime,
        provenance: Provenance,
        once: bool = False,
    ) -> Version:
        """Keep a model as the next version; the active one stays active.

        Returns
        -------
        The version as its file has it, which is what every later reader gets. A number
        that the unit of its key cannot say exactly differs in the last bit. Once means
        that it is the one of :meth:`same`, where that is there.

        Raises
        ------
        NotFound
            There is no such parent.
        ConfigError
            The file that says which one is active is damaged.
        Refused
            The model is one that could not be read again, or the disk is full or cannot
            be written; nothing was kept.
        """
        self.get(parent)
        with self._changing():
            # Under the lock: two that judge one recording at once keep one.
            if once and (
                known := self.same(model, parent=parent, provenance=provenance)
            ):
                return known
            pointer = self._read_pointer()
            number = max(pointer.made, *self._numbers(), 0) + 1
            lineage = Lineage(
                version=number,
                parent=parent,
                created_at=created_at,
                provenance=provenance,
            )
            name = self._name(number)
            text = model_text(replace(model, name=name, lineage=lineage))
            if not any(self._numbers()):
                replace_file(self._file(0), sealed(model_text(self._base)))
            create_file(self._file(number), sealed(text), check=_readable)
            try:
                write_pointer(replace(pointer, made=number), self._pointer)
            except OSError:
                remove_file(self._file(number))
                raise
        return self.get(number)

    def same(
        self, model: ModelFile, *, parent: int, provenance: Provenance
    ) -> Version | None:
        """The first version of that parent, recording and content; None without one."""
        for version in self.all().versions:
            lineage = version.model.lineage
            if lineage is None or lineage.parent != parent:
                continue
            content = replace(version.model, lineage=None)
            recorded = lineage.provenance.recording.sha256
            if recorded == provenance.recording.sha256 and not difference(
                content, replace(model, lineage=None)
            ):
                return version
        return None

    def all(self) -> Shelf:
        """Every version; one broken file costs one version."""
        complaints: list[str] = []
        versions: list[Version] = []
        numbers = (0, *sorted(self._numbers()))
        for number in numbers:
            with gathering(complaints):
                versions.append(self.get(number))
        active = self.active
        if active not in numbers:
            complaints.append(self._gone(active))
        return Shelf(tuple(versions), active, tuple(complaints))

    def get(self, which: int | str = ACTIVE) -> Version:
        """One version, by number, name or :data:`ACTIVE`.

        Raises
        ------
        NotFound
            There is none.
        ConfigError
            Its file is damaged, or the active one is there no more.
        """
        number = self._number(which)
        if number == 0:
            return Version(0, self._base)
        path = self._file(number)
        check_seal(path)
        model = load_model(path)
        if model.name != self._name(number) or model.lineage is None:
            detail = f'"{model.name}" is not version {number} of {self._base.name}'
            raise ConfigError(Complaint(detail, source=str(path), path=("name",)))
        return Version(number, model)

    def activate(self, which: int | str) -> Version:
        """Make a version the active one.

        Raises
        ------
        NotFound
            There is none.
        ConfigError
            Its file is damaged, or it has no valve or gripper.
        Refused
            The disk cannot be written; the one before is still active.
        """
        return self._point(lambda before: before.to(self._number(which)))

    def rollback(self) -> Version:
        """Make the version active that was so before; again, the one before that.

        Those whose files are gone are passed over.

        Raises
        ------
        Refused
            There was none before, or the disk cannot be written.
        ConfigError
            The file of the one before is damaged.
        """
        return self._point(self._back)

    def before(self) -> Version:
        """Version that :meth:`rollback` would go back to.

        Raises
        ------
        Refused
            There was none before.
        ConfigError
            Its file, or the one that says which is active, is damaged.
        """
        return self.get(self._back(self._read_pointer()).active)

    def _back(self, pointer: Pointer) -> Pointer:
        others = {0, *self._numbers()} - {pointer.active}
        pointer = pointer.back()
        while pointer.active not in others:
            pointer = pointer.back()
        return pointer

    def _point(self, move: Callable[[Pointer], Pointer]) -> Version:
        with self._changing():
            pointer = move(self._read_pointer())
            version = self.get(pointer.active)
            version.model.chain()
            write_pointer(pointer, self._pointer)
            return version

    def _number(self, which: int | str) -> int:
        numbers = (0, *self._numbers())
        if which == ACTIVE:
            if (active := self.active) not in numbers:
                raise ConfigError(self._gone(active))
            return active
        known: dict[int | str, int] = {}
        for number in numbers:
            known |= {number: number, str(number): number, self._name(number): number}
        if which not in known:
            names = {self._name(each) for each in known.values()}
            hint = self._elsewhere(which) or did_you_mean(str(which), names)
            message = f"{self._base.name} has no version {which!r}; {hint}"
            raise NotFound(message, key="version")
        return known[which]

    def _gone(self, number: int) -> Complaint:
        detail = "is not there, and is the active version"
        return Complaint(detail, source=str(self._file(number)))

    def _elsewhere(self, which: int | str) -> str:
        """Say that it is a version of another model; empty when it is none."""
        for path in self._folder.parent.glob(f"*/{VERSIONS}"):
            if f"{path.parent.name}-{path.stem}" == which:
                return f"it is one of {path.parent.name}: {path}"
        return ""

    def _numbers(self) -> Iterator[int]:
        for path in self._folder.glob(VERSIONS):
            if path.stem.isdecimal():
                yield int(path.stem)

    def _name(self, number: int) -> str:
        return f"{self._base.name}-{number}" if number else self._base.name

    def _file(self, number: int) -> Path:
        return self._folder / f"{number}.yaml"

    @property
    def _pointer(self) -> Path:
        return self._folder / f"{ACTIVE}.yaml"

    def _read_pointer(self) -> Pointer:
        return read_pointer(self._pointer)

    @contextmanager
    def _changing(self) -> Iterator[None]:
        with writing(self._folder), locked(self._folder):
            yield


def _readable(draft: Path) -> None:
    try:
        load_model(draft)
    except ConfigError as unusable:
        said = "; ".join(
            f"{dotted(one.path)}: {one.detail}" if isinstance(one, Complaint) else one
            for one in unusable.complaints
        )
        message = f"nothing was kept, for nobody could read it again: {said}"
        raise Refused(message, code="model-unusable") from unusable
