"""Boost's INFO format, as mission.info has it: "key value" lines and blocks in braces."""

from __future__ import annotations

import re
from collections.abc import Iterator
from os import PathLike

from .errors import Error

# A quoted text, a brace, a comment to the end of the line, a word, or a quote without its end.
_TOKEN = re.compile(r'"(?P<quoted>(?:[^"\\]|\\.)*)"|(?P<brace>[{}])|;.*|(?P<word>[^\s{};"]+)|(?P<open>")')
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r", "0": "\0", "a": "\a", "b": "\b", "f": "\f", "v": "\v"}
_DEEPEST = 50  # blocks in blocks; the settings of karst have four

_Token = tuple[str, str, int]  # kind ("text", "{", "}" or "end"), text, line


def parse_info(text: str, file: str | PathLike[str]) -> dict:
    """The settings as nested dicts of text, such as {"map": {"resolution": "0.2 m"}}.

    A key that occurs again makes a list of all its values. A block with a value of its own has it under "".
    `file` is named in errors. Raises Error with the line of a text that is not in this format.
    """
    tokens = list(_tokens(text, file))
    settings, at = _block(tokens, 0, 0, file)
    if tokens[at][0] == "}":
        raise Error.at(file, f"line {tokens[at][2]}", "closes a block that was not opened")
    return settings


def _block(tokens: list[_Token], at: int, depth: int, file: str | PathLike[str]) -> tuple[dict, int]:
    """The settings from token `at` on, and the token at which the block ends."""
    block: dict = {}
    while tokens[at][0] not in ("}", "end"):
        kind, key, line = tokens[at]
        if kind == "{":
            raise Error.at(file, f"line {line}", "a block without a name")
        at += 1
        value: str | dict = ""
        if tokens[at][0] == "text" and tokens[at][2] == line:
            value = tokens[at][1]
            at += 1
        if tokens[at][0] == "{":
            if depth == _DEEPEST:
                raise Error.at(file, f"line {line}", f"more than {_DEEPEST} blocks in each other")
            opened = tokens[at][2]
            inner, at = _block(tokens, at + 1, depth + 1, file)
            if tokens[at][0] == "end":
                raise Error.at(file, f"line {opened}", "the block that begins here does not end")
            value = {"": value, **inner} if value else inner
            at += 1
        elif tokens[at][0] == "text" and tokens[at][2] == line:
            raise Error.at(file, f"line {line}", f'"{tokens[at][1]}" follows the value of {key}')
        if key not in block:
            block[key] = value
        else:
            block[key] = [*block[key], value] if isinstance(block[key], list) else [block[key], value]
    return block, at


def _tokens(text: str, file: str | PathLike[str]) -> Iterator[_Token]:
    line = 0
    for line, content in enumerate(text.split("\n"), 1):
        for token in _TOKEN.finditer(content):
            if token["open"]:
                raise Error.at(file, f"line {line}", "a quoted text that does not end")
            if token["brace"]:
                yield token["brace"], token["brace"], line
            elif token["word"] is not None:
                yield "text", token["word"], line
            elif token["quoted"] is not None:
                yield "text", re.sub(r"\\(.)", lambda e: _ESCAPES.get(e[1], e[1]), token["quoted"]), line
    yield "end", "", line
