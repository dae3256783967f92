"""Plain values as YAML that :mod:`gripperd.config.document` reads back the same."""

import yaml

from gripperd.config.document import DECIMAL, NOT_FINITE, WORDS

WIDTH = 100


class _Dumper(yaml.SafeDumper):
    """Quotes what the reader would take for something other than text."""


def _text(dumper: yaml.SafeDumper, text: str) -> yaml.ScalarNode:
    other = text in WORDS or DECIMAL.fullmatch(text) or NOT_FINITE.fullmatch(text)
    # In any other style a line separator would come back as a space.
    style = '"' if other or not text.isprintable() else None
    return dumper.represent_scalar("tag:yaml.org,2002:str", text, style=style)


_Dumper.add_representer(str, _text)


def yaml_text(value: object) -> str:
    """Write mappings, lists, text and numbers; every digit of a number is kept.

    >>> print(yaml_text({"name": "1e5", "current_mA": [4, 20.0]}), end="")
    name: "1e5"
    current_mA: [4, 20.0]
    """
    return yaml.dump(
        value,
        Dumper=_Dumper,
        sort_keys=False,
        allow_unicode=True,
        default_flow_style=None,
        width=WIDTH,
    )
