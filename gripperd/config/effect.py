"""Effects of a model file: a name, or a name with parameters."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, fields
from typing import Annotated, TypeAlias

from pydantic import PlainValidator, TypeAdapter, ValidationError, ValidationInfo
from pydantic_core import to_json

from gripperd.config.complaint import Complaint, KeyPath, did_you_mean, gathering
from gripperd.config.document import Document
from gripperd.config.number import factor_of
from gripperd.config.section import DIGITS
from gripperd.config.wording import describe, quantity, shown, spelt
from gripperd.errors import ConfigError
from gripperd.model.effect import Effect, StaticEffect
from gripperd.model.parameter import Parameter, parameters
from gripperd.units import split

AnyEffect: TypeAlias = Effect | StaticEffect


def key_of_parameter(name: str, unit: str | None) -> str:
    """Key in a model file of a parameter: its name, and its unit if it has one."""
    return f"{name}_{unit}" if unit else name


def keys_of_effect(effect: AnyEffect | type[Effect]) -> dict[str, str]:
    """Keys that a model file has for an effect, by the names of its fields.

    >>> from gripperd.effects.creep import Creep
    >>> keys_of_effect(Creep)["time"]
    'time_s'
    """
    known = parameters(effect)
    units = {name: known[name].unit for name in known}
    return {
        each.name: key_of_parameter(each.name, units.get(each.name))
        for each in fields(effect)
    }


@dataclass(frozen=True, slots=True)
class Library:
    """The effects there are, and the document that asks for some of them."""

    document: Document
    known: Mapping[str, type[Effect]]

    def effects(self, entries: object) -> tuple[Effect, ...]:
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
        effects: dict[str, Effect] = {}
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

    def _effect(self, entry: object, path: KeyPath) -> Effect:
        named = entry if isinstance(entry, dict) else {"name": entry}
        name = named.get("name")
        if not isinstance(name, str) or name not in self.known:
            hint = did_you_mean(str(name), self.known)
            detail = f"{shown(name)} is not an effect; {hint}"
            raise ConfigError(self.document.complaint(path, detail))
        given = {key: value for key, value in named.items() if key != "name"}
        return self._built(self.known[name], given, path)

    def _built(
        self, kind: type[Effect], given: Mapping[str, object], path: KeyPath
    ) -> Effect:
        keys, declared = keys_of_effect(kind), parameters(kind)
        complaints = [
            *self._misnamed(kind, keys, given, path),
            *self._beyond(kind, keys, given, path),
        ]
        values = {
            name: _in_si(given[key], declared.get(name))
            for name, key in keys.items()
            if key in given
        }
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
        self,
        kind: type[Effect],
        keys: Mapping[str, str],
        given: Iterable[str],
        path: KeyPath,
    ) -> Iterator[Complaint]:
        known = keys.values()
        for key in given:
            name = split(key)[0]
            if key in known:
                continue
            if name in keys:
                detail = f"is not the unit of {name} of {kind.name}; write {keys[name]}"
            else:
                hint = did_you_mean(key, known)
                detail = f"is not a parameter of {kind.name}; {hint}"
            yield self.document.complaint((*path, key), detail)

    def _beyond(
        self,
        kind: type[Effect],
        keys: Mapping[str, str],
        given: Mapping[str, object],
        path: KeyPath,
    ) -> Iterator[Complaint]:
        """Complain about numbers outside the physical bounds."""
        for name, parameter in parameters(kind).items():
            value = given.get(keys[name])
            if isinstance(value, bool) or not isinstance(value, int | float):
                continue
            low, high = _bounds(parameter)
            if not low <= value <= high:
                unit = spelt(parameter.unit)
                detail = (
                    f"{quantity(value, unit)} is outside {low:g} to"
                    f" {quantity(high, unit)}, the physical bounds of {kind.name}"
                )
                yield self.document.complaint((*path, keys[name]), detail)


def _bounds(parameter: Parameter) -> tuple[float, float]:
    """Ends in the unit of the file, without the rounding of the way there."""
    factor = factor_of(parameter.unit)
    low, high = parameter.low / factor, parameter.high / factor
    return float(f"{low:.{DIGITS}g}"), float(f"{high:.{DIGITS}g}")


def _in_si(value: object, parameter: Parameter | None) -> object:
    unit = parameter.unit if parameter else None
    if unit and isinstance(value, int | float) and not isinstance(value, bool):
        return value * factor_of(unit)
    return value


def _listed(entries: object, asked: ValidationInfo) -> tuple[Effect, ...]:
    library = asked.context
    assert isinstance(library, Library)
    return library.effects(entries)


Effects: TypeAlias = Annotated[tuple[Effect, ...], PlainValidator(_listed)]
"""Type of the key ``effects``; the context of the validation is a `Library`."""
