"""What tells two models apart that have one name."""

from hashlib import sha256
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gripperd.model.chain import Chain


def digest(chain: "Chain") -> str:
    """Hash all that a chain says (FIPS 180-4, SHA-256), in whatever order it says it.

    Constants to their last bit: a message between processes keeps that.
    """
    said = (
        chain.name,
        chain.static,
        chain.regulator,
        chain.linkage,
        chain.effects,
        sorted(chain.tolerances.items()),
        sorted(chain.correlations.items()),
    )
    return sha256(repr(said).encode()).hexdigest()
