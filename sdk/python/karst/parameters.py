"""Parameters of a policy: attributes of its class that a mission file, a campaign or `karst tune` may set."""

from __future__ import annotations

from typing import Any, Sequence


class _Parameter:
    """The base of the kinds. An instance of the policy reads the value as an attribute."""

    kind = 0  # of the ABI (karst_abi_policy.h)

    def __init__(self, default: Any, help: str):
        self.default = default
        self.help = str(help)
        self.name = ""

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    def __get__(self, instance: object, owner: type) -> Any:
        return self if instance is None else instance.__dict__.get(self.name, self.default)

    def __set__(self, instance: object, value: Any) -> None:
        instance.__dict__[self.name] = value

    def declaration(self) -> dict:
        """As the ABI has it."""
        return {
            "id": self.name, "type": self.kind, "help": self.help, "unit": "", "choices": "",
            "default_text": "", "default_number": 0.0, "low": 0.0, "high": 0.0,
        }


class Real(_Parameter):
    """A number with a unit and a range, ends included: ``weight = karst.Real(1.0, 0, 10, "m", "what it does")``.

    ``unit``: "m", "m/s", "s", "rad", ...; "" for a plain number. The policy gets SI units.
    """

    kind = 1

    def __init__(self, default: float, low: float, high: float, unit: str, help: str):
        super().__init__(float(default), help)
        self.low, self.high, self.unit = float(low), float(high), unit

    def declaration(self) -> dict:
        return super().declaration() | {
            "default_number": self.default, "low": self.low, "high": self.high, "unit": self.unit,
        }


class Integer(_Parameter):
    """A whole number: ``min_cells = karst.Integer(10, 1, 10000, "smaller frontiers are ignored")``."""

    kind = 2

    def __init__(self, default: int, low: int, high: int, help: str):
        super().__init__(int(default), help)
        self.low, self.high = int(low), int(high)

    def declaration(self) -> dict:
        return super().declaration() | {
            "default_number": float(self.default), "low": float(self.low), "high": float(self.high),
        }


class Boolean(_Parameter):
    """Yes or no: ``greedy = karst.Boolean(True, "takes the nearest")``."""

    kind = 3

    def __init__(self, default: bool, help: str):
        super().__init__(bool(default), help)

    def declaration(self) -> dict:
        return super().declaration() | {"default_number": float(self.default)}


class Text(_Parameter):
    """A text, one of ``choices`` if there are any: ``side = karst.Text("left", "first here", ["left", "right"])``."""

    kind = 4

    def __init__(self, default: str, help: str, choices: Sequence[str] = ()):
        super().__init__(str(default), help)
        self.choices = tuple(choices)

    def declaration(self) -> dict:
        return super().declaration() | {"default_text": self.default, "choices": "|".join(self.choices)}


def parameters_of(policy: type) -> list[_Parameter]:
    """Those of a class and of its bases, in the order of their declaration."""
    found: dict[str, _Parameter] = {}
    for base in reversed(policy.__mro__):
        for name, value in vars(base).items():
            if isinstance(value, _Parameter):
                found[name] = value
            else:
                found.pop(name, None)  # a class may fix a parameter of its base
    return list(found.values())
