"""Bytes on the wire <-> values, in both directions, without I/O.

Driver and bench share this layer, so a wrong scale factor in it would cancel out;
tests therefore pin it with literal bytes and with programs written by others.
"""
