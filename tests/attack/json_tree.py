# SPDX-License-Identifier: GPL-3.0-or-later
"""JSON texts as trees that may say what JSON must not: a key twice, numbers that are none, any bytes as a token."""
import json
from dataclasses import dataclass


class Members(list):
    """An object: a list of [key, value], in which a key may stand twice."""


@dataclass
class Token:
    """What stands in the text as it is."""
    text: str


def parse(text):
    """The tree of a text whose numbers are Tokens, so that they keep their form."""
    return json.loads(text, object_pairs_hook=lambda pairs: Members([key, value] for key, value in pairs),
                      parse_float=Token, parse_int=Token)


def dump(node):
    """The text of a tree."""
    if isinstance(node, Token):
        return node.text
    if isinstance(node, Members):
        return "{" + ", ".join(f"{dump(key)}: {dump(value)}" for key, value in node) + "}"
    if isinstance(node, list):
        return "[" + ", ".join(dump(item) for item in node) + "]"
    return json.dumps(node, ensure_ascii=False)


class Place:
    """Where a value stands: in a list or an object, at an index, under the nearest key above it."""

    def __init__(self, parent, index, key):
        self.parent, self.index, self.key = parent, index, key

    @property
    def value(self):
        return self.parent[self.index][1] if isinstance(self.parent, Members) else self.parent[self.index]

    def put(self, value):
        if isinstance(self.parent, Members):
            self.parent[self.index][1] = value
        else:
            self.parent[self.index] = value


def places(node, key=""):
    """All places below a node, in the order of the text."""
    for index, item in enumerate(node if isinstance(node, list) else ()):
        here = item[0] if isinstance(node, Members) else key
        yield Place(node, index, here)
        yield from places(item[1] if isinstance(node, Members) else item, here)
