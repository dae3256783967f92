"""Octets to try: noise, and good octets that a bad line has changed."""

import random

from gripperd.protocol.rtu import crc

INTERESTING = b"\0\1\2\3\4\5\6\x10\x2b\x80\x83\xff\r\n!?>#$~0123456789ABCDEF+."


def noise(rng: random.Random) -> bytes:
    """Octets that nobody meant, half of them such as decoders look for."""
    count = rng.randrange(40) if rng.random() < 0.98 else rng.randrange(400)
    octets = rng.randbytes(count)
    if rng.random() < 0.5:
        return octets
    return bytes(INTERESTING[octet % len(INTERESTING)] for octet in octets)


def mutated(rng: random.Random, octets: bytes) -> bytes:
    """Octets that a bad line has made of good ones."""
    found = bytearray(octets)
    for _ in range(rng.randrange(4)):
        place = rng.randrange(len(found) + 1)
        match rng.randrange(6):
            case 0:
                found[place : place + 1] = bytes((rng.randrange(256),))
            case 1:
                found[place:place] = rng.randbytes(rng.randrange(1, 4))
            case 2:
                del found[place : place + rng.randrange(1, 4)]
            case 3:
                found[place : place + 1] = rng.choice(INTERESTING).to_bytes()
            case 4:
                found += octets[: rng.randrange(len(octets) + 1)]
            case _:
                del found[place:]
    return bytes(found)


def sealed(rng: random.Random, frame: bytes) -> bytes:
    """A frame of RTU, more often than not with a checksum that fits."""
    if rng.random() < 0.3:
        return frame
    return frame[:-2] + crc(frame[:-2]).to_bytes(2, "little")


def framed(rng: random.Random, frame: bytes) -> bytes:
    """A frame of TCP, more often than not with a length that fits."""
    if rng.random() < 0.3 or len(frame) < 7:
        return frame
    return frame[:4] + (len(frame) - 6 & 0xFFFF).to_bytes(2) + frame[6:]


def as_it_is(rng: random.Random, octets: bytes) -> bytes:
    """Lines of text are not repaired."""
    return octets
