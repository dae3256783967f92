"""Effects of a model file: a name, or a name with parameters."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from typing import Annotated, TypeAlias

from pydantic import PlainValidator, TypeAdapter, ValidationError, ValidationInfo
from pydantic_core import to_json

from gripperd.config.complaint import Complaint, KeyPath, did_you_mean, gathering
from gripperd.config.document import Document
from gripperd.config.wording import describe, shown
from gripperd.errors import ConfigError
from gripperd.model import MuscleEffect
from gripperd.units import SI_PER_UNIT, split


@dataclass(frozen=True, slots=True)
class Library:
    """The effects there are, and the document that asks for some of them."""

    document: Document
    known: Mapping[str, type[MuscleEffect]]

    def effects(self, entries: object) -> tuple[MuscleEffect, ...]:
        """Build the effects a document lists.

        Raises
        ------
        ConfigError
            With everything that is wrong with any of them.
        """
        if not isinstance(entries, list):
            detail = f"{shown(entries)} is not a list of effects"
            raise ConfigError(self.document.complaint(("effects",), detail))
        complaints: list[str] = []
        effects: dict[str, MuscleEffect] = {}
        for index, entry in enumerate(entries):
            path = ("effects", index)
            with gathering(complaints):
                effect = self._effect(entry, path)
                if effect.name in effects:
                    detail = f"{effect.name} is listed twice"
                    raise ConfigError(self.document.complaint(path, detail))
                effects[effect.name] = effect
        if complaints:
            raise ConfigError(*complaints)
        return tuple(effects.values())

    def _effect(self, entry: object, path: KeyPath) -> MuscleEffect:
        named = entry if isinstance(entry, dict) else {"name": entry}
        name = named.get("name")
        if not isinstance(name, str) or name not in self.known:
            hint = did_you_mean(str(name), self.known)
            detail = f"{shown(name)} is not an effect; {hint}"
            raise ConfigError(self.document.complaint(path, detail))
        parameters = {key: value for key, value in named.items() if key != "name"}
        return self._built(self.known[name], parameters, path)

    def _built(
        self, kind: type[MuscleEffect], parameters: dict[str, object], path: KeyPath
    ) -> MuscleEffect:
        keys = {split(key)[0]: key for key in parameters}
        complaints = self._misnamed(kind, parameters, path)
        values = {name: _in_si(key, parameters[key]) for name, key in keys.items()}
        try:
            effect = TypeAdapter(kind).validate_json(to_json(values), strict=True)
        except ValidationError as refused:
            for error in refused.errors(include_url=False):
                place = (*path, *(keys.get(str(step), step) for step in error["loc"]))
                detail = describe(error, place)
                complaints.append(self.document.complaint(place, detail))
        else:
            if not complaints:
                return effect
        raise ConfigError(*complaints)

    def _misnamed(
        self, kind: type[MuscleEffect], keys: Iterable[str], path: KeyPath
    ) -> list[Complaint]:
        known = [field.name for field in fields(kind)]
        complaints: list[Complaint] = []
        first: dict[str, str] = {}
        for key in keys:
            name = split(key)[0]
            if name not in known:
                hint = did_you_mean(name, known)
                detail = f"is not a parameter of {kind.name}; {hint}"
                complaints.append(self.document.complaint((*path, key), detail))
            elif first.setdefault(name, key) != key:
                detail = f"says again what {first[name]} says"
                complaints.append(self.document.complaint((*path, key), detail))
        return complaints


def _in_si(key: str, value: object) -> object:
    unit = split(key)[1]
    if unit and isinstance(value, int | float) and not isinstance(value, bool):
        return value * SI_PER_UNIT[unit]
    return value


def _listed(entries: object, asked: ValidationInfo) -> tuple[MuscleEffect, ...]:
    library = asked.context
    assert isinstance(library, Library)
    return library.effects(entries)


Effects: TypeAlias = Annotated[tuple[MuscleEffect, ...], PlainValidator(_listed)]
"""Type of the key ``effects``; the context of the validation is a `Library`."""
