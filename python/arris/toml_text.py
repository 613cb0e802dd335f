# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of Python and NumPy as TOML."""

import os

from ._arris import InputError

_ESCAPES = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\r": "\\r", "\t": "\\t"}


def to_toml(value, key=""):
    """One value as TOML; tables are inline. `key` names it in errors."""
    if hasattr(value, "tolist"):  # NumPy's arrays and numbers
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value)  # "inf" and "nan" are TOML, too, and refused with the key's allowed values
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, str):
        if any("\ud800" <= character <= "\udfff" for character in value):
            raise InputError(f"{key} = {value!a}: is not Unicode; allowed: str without surrogates")
        return '"' + "".join(map(_escape, value)) + '"'
    if isinstance(value, dict):
        items = [f"{to_key(k)} = {to_toml(v, f'{key}.{k}')}" for k, v in value.items() if v is not None]
        return "{ " + ", ".join(items) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(to_toml(v, f"{key}.{i}") for i, v in enumerate(value)) + "]"
    raise InputError(f"{key} = {' '.join(repr(value).split())}: is of type {type(value).__name__}; allowed: numbers, "
                     "bool, str, paths, lists, tuples, NumPy arrays and dicts")


def to_document(scene):
    """A scene's dict as a TOML document. None leaves a key out."""
    return "".join(f"{to_key(key)} = {to_toml(value, key)}\n" for key, value in scene.items() if value is not None)


def to_key(key):
    if not isinstance(key, str):
        raise InputError(f"key {key!r}: is of type {type(key).__name__}; allowed: str")
    return to_toml(key)


def _escape(character):
    if character in _ESCAPES:
        return _ESCAPES[character]
    return character if character >= " " and character != "\x7f" else f"\\u{ord(character):04x}"
