"""How the numbers of a version go together, from the covariance that its file keeps."""

from collections.abc import Iterable, Iterator
from itertools import combinations
from math import sqrt

from gripperd.config.effect import AnyEffect, keys_of_effect
from gripperd.config.lineage import Covariance
from gripperd.config.model_parts import PARTS
from gripperd.config.section import ENDS, key_of
from gripperd.units import split

ADJUSTED = "parameter:"
"""Stands before the name of a constant of the model."""


def correlations(
    covariance: Covariance, effects: Iterable[AnyEffect]
) -> dict[tuple[str, str], float]:
    """Give the coefficients of correlation between the numbers of a model file.

    Parameters
    ----------
    covariance
        Of a fit. What has no place in a model, as the response time of a valve, is
        passed over.
    effects
        Those of the model.

    Returns
    -------
    Coefficients by two paths, each as in the tolerances of a chain, such as
    ``muscle.diameter``. [-]
    """
    paths = dict(_paths(effects))
    placed = [
        (place, paths[name])
        for place, name in enumerate(covariance.parameters)
        if name in paths and covariance.matrix[place][place] > 0
    ]
    rows = covariance.matrix
    return {
        (one, other): rows[a][b] / sqrt(rows[a][a] * rows[b][b])
        for (a, one), (b, other) in combinations(placed, 2)
    }


def _paths(effects: Iterable[AnyEffect]) -> Iterator[tuple[str, str]]:
    """Paths in a chain, by the names that a covariance has for them."""
    for part, schema in PARTS.items():
        for field in schema.model_fields:
            name, unit = split(field)
            yield f"{ADJUSTED}{part}.{key_of(schema, field)}", f"{part}.{name}"
            for end in ENDS:
                yield f"{ADJUSTED}{part}.{name}_{end}_{unit}", f"{part}.{name}_{end}"
    for effect in effects:
        for name, key in keys_of_effect(effect).items():
            path = f"effects.{effect.name}.{name}"
            yield f"{effect.name}.{key}", path
            # One that the model had already was adjusted as its constants were.
            yield f"{ADJUSTED}effects.{effect.name}.{key}", path
