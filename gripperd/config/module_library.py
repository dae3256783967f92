"""Finding descriptions of modules: a user's own folder first, then the shipped."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from gripperd.config.complaint import did_you_mean, gathering
from gripperd.config.document import read_document
from gripperd.config.location import shipped
from gripperd.config.module_check import AnyModule, contradictions
from gripperd.config.module_file import InputSchema, OutputSchema
from gripperd.config.section import NAME
from gripperd.config.validation import validated
from gripperd.config.wording import shown
from gripperd.errors import ConfigError
from gripperd.protocol.modules import InputModule, OutputModule

M = TypeVar("M", OutputModule, InputModule)
SCHEMAS: dict[object, type[OutputSchema] | type[InputSchema]] = {
    "output": OutputSchema,
    "input": InputSchema,
}


@dataclass(frozen=True, slots=True)
class ModuleLibrary:
    """The descriptions that can be named in settings."""

    own: Path | None = None
    """A folder of the user, whose descriptions go before the shipped."""

    def output(self, name: object) -> OutputModule:
        """Output module of that name.

        Raises
        ------
        ValueError
            There is none.
        ConfigError
            Its file is unusable.
        """
        return self._named(name, OutputModule, "output")

    def input(self, name: object) -> InputModule:
        """Input module of that name, see :meth:`output`."""
        return self._named(name, InputModule, "input")

    def all(self) -> Iterator[AnyModule]:
        """Every module; those whose file is broken are left out."""
        seen: set[str] = set()
        for path in self._files():
            if path.stem not in seen:
                seen.add(path.stem)
                with gathering([]):
                    yield load_module(path)

    def check_own(self) -> None:
        """Read the user's descriptions, whether they are named anywhere or not.

        Raises
        ------
        ConfigError
            With everything that is wrong with any of them.
        """
        complaints: list[str] = []
        for path in _described(self.own):
            with gathering(complaints):
                load_module(path)
        if complaints:
            raise ConfigError(*complaints)

    def _named(self, name: object, kind: type[M], word: str) -> M:
        module = self._find(name)
        if isinstance(module, kind):
            return module
        known = [each.name for each in self.all() if isinstance(each, kind)]
        message = f"{shown(name)} is not an {word} module; "
        raise ValueError(message + did_you_mean(str(name), known))

    def _find(self, name: object) -> AnyModule | None:
        if not isinstance(name, str) or not NAME.fullmatch(name):
            return None
        found = (path for path in self._files() if path.stem == name)
        path = next(found, None)
        return load_module(path) if path else None

    def _files(self) -> list[Path]:
        return [*_described(self.own), *_described(shipped("modules"))]


def load_module(path: Path) -> AnyModule:
    """Read one description; its vectors are checked, and its name is that of the file.

    Raises
    ------
    ConfigError
        With everything that is wrong with the file.
    """
    document = read_document(path)
    kind = document.value.get("kind") if isinstance(document.value, dict) else None
    # Whatever is wrong with the kind itself is said by either schema.
    schema = SCHEMAS.get(kind if isinstance(kind, str) else None, OutputSchema)
    section = validated(schema, document)
    module = section.module()
    complaints = tuple(contradictions(module, section.vectors, document))
    if path.stem != module.name:
        detail = f'the module "{module.name}" belongs in a file {module.name}.yaml'
        complaints = (document.complaint(("name",), detail), *complaints)
    if complaints:
        raise ConfigError(*complaints)
    return module


def _described(folder: Path | None) -> list[Path]:
    return sorted(folder.glob("[!.]*.yaml")) if folder is not None else []
