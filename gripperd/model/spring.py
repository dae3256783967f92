"""A part that gives under its load, and the less the more of it there is.

References
----------
.. [1] Y. C. Fung, "Biomechanics: Mechanical Properties of Living Tissues", 2nd ed.,
       Springer, 1993, section 7.5: the stiffness of tendon and other soft tissue rises
       in proportion to its load.
"""

import numpy as np

from gripperd.model.real import Real


def extension(load: Real, compliance: float, stiffening: float) -> Real:
    r"""How far it gives.

    With a stiffness that rises in proportion to the load [1]_,
    :math:`dF/dx = (1 + s F) / c`, it is :math:`x = c \ln(1 + s F) / s`, and
    :math:`c F` where s is 0.

    Parameters
    ----------
    load
        At least 0. [N]
    compliance
        Without a load. [per N of whatever gives]
    stiffening
        Share of the stiffness that each newton adds. [1/N]

    Examples
    --------
    >>> round(float(extension(50.0, 1e-5, 0.02)), 7)
    0.0003466
    """
    if stiffening == 0.0:
        return compliance * load
    return compliance * np.log1p(stiffening * load) / stiffening
