"""What the best of many candidates gains on noise alone: the price of looking.

Columns are whitened, so under the noise their products with it are normal with the
Gram itself as covariance; constants are drawn from their priors.

References
----------
.. [1] P. H. Westfall, S. S. Young, "Resampling-Based Multiple Testing", Wiley, 1993,
       section 2.1: the distribution of the maximum pays for multiplicity.
"""

from collections.abc import Sequence

import numpy as np

from gripperd.diagnose.fit.design import Design, Member
from gripperd.model.track import Array

SIMULATIONS = 400


def null_gains(
    design: Design, members: Sequence[Member], rng: np.random.Generator
) -> Array:
    """Largest gain of evidence of any candidate in recordings without a discrepancy.

    Returns
    -------
    One a simulation, rising, shape ``(SIMULATIONS,)``. [nat]
    """
    gram = design.gram
    products = gram.products
    values, vectors = np.linalg.eigh(products)
    root = vectors * np.sqrt(np.maximum(values, 0.0))
    draws = root @ rng.standard_normal((values.size, SIMULATIONS))
    always = design.columns()
    draws += products[:, always] @ rng.standard_normal((always.size, SIMULATIONS))
    base = _explained(products, draws, always)
    best = np.zeros(SIMULATIONS)
    for member in members:
        gain = _explained(products, draws, design.columns(member)) - base
        if member.columns.size == 1:
            (column,) = member.columns
            size = _size(products, draws, design, member)
            below = (gram.low[column] >= 0) & (size < 0)
            above = (gram.high[column] <= 0) & (size > 0)
            gain = np.where(below | above, 0.0, gain)
        np.maximum(best, gain, out=best)
    return np.sort(best)


def _explained(
    products: Array, draws: Array, columns: "np.ndarray[tuple[int], np.dtype[np.intp]]"
) -> Array:
    """Log evidence up to a constant, one a draw. [nat]."""
    matrix = products[np.ix_(columns, columns)] + np.eye(columns.size)
    moments = draws[columns]
    squares = np.einsum("ij,ij->j", moments, np.linalg.solve(matrix, moments))
    volume = float(np.linalg.slogdet(matrix)[1])
    return np.asarray(0.5 * (squares - volume))


def _size(products: Array, draws: Array, design: Design, member: Member) -> Array:
    """Size of a candidate that has one, in its priors, one a draw. [-]."""
    columns = design.columns(member)
    matrix = products[np.ix_(columns, columns)] + np.eye(columns.size)
    return np.asarray(np.linalg.solve(matrix, draws[columns])[-1])
