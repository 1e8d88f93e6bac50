# SPDX-License-Identifier: Apache-2.0
"""Settings of the stages, as the engine's tables have them: checks, what is told of them, options, signatures."""

from __future__ import annotations

import argparse
import functools
import inspect
import numbers
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

from photonloupe import _engine
from photonloupe.checks import check_choice, check_count, check_number
from photonloupe.errors import ArgumentError

STAGES = ("trace", "relax", "irradiance", "render", "loupe")

FunctionT = TypeVar("FunctionT", bound=Callable[..., Any])


@dataclass(frozen=True)
class Setting:
    """A row of `engine/<stage>/settings.h`; `engine/core/settings.h` says what its fields mean."""

    name: str
    kind: str
    default: Any
    doc: str
    low: float
    high: float
    choices: tuple[str, ...]
    width: int
    empty: str
    automatic: str
    alias: str
    unit: str
    spreads: bool
    differs: bool

    @property
    def limits(self) -> tuple[int, int]:
        """Least and largest of a count."""
        return int(self.low), int(self.high)

    @property
    def names(self) -> tuple[str, ...]:
        """What can be chosen, that of holding nothing first."""
        return (self.empty, *self.choices) if self.empty else self.choices

    @property
    def option(self) -> str:
        """Its option of the command line."""
        return "--" + (self.alias or self.name).replace("_", "-")

    @property
    def shown_default(self) -> Any:
        """The default as it would be typed."""
        if self.default is None:
            return None if self.empty == "none" else self.empty
        return tuple(self.default) if self.kind == "numbers" else self.default

    def check(self, value: Any) -> Any:
        """Return the value as the engine takes it, None where the setting holds nothing; None stands for the default.

        Raises
        ------
        ArgumentError
            If the setting may not be that.
        """
        if value is None:
            return None if self.empty == "none" else self.default
        if self.kind == "flag":
            return bool(value)
        if self.kind == "choice":
            name = check_choice(self.name, value, self.names)
            return None if name == self.empty else name
        if isinstance(value, str) and self.empty:
            if value == self.empty:
                return None
            what = {"count": "a whole number", "number": "a number"}.get(self.kind, f"{self.width} numbers")
            raise ArgumentError(f"{self.name} must be {what} or {self.empty}, not {value!r}")
        if self.kind == "count":
            return check_count(self.name, value, *self.limits)
        if self.kind == "number":
            return check_number(self.name, value, self.low, self.high)
        return self._check_numbers(value)

    def _check_numbers(self, value: Any) -> list[float]:
        try:
            parts = (value,) * self.width if self.spreads and isinstance(value, numbers.Real) else tuple(value)
        except TypeError:
            parts = ()
        if len(parts) != self.width:
            raise ArgumentError(f"{self.name} must be {self.width} numbers, not {value!r}")
        checked = [check_number(self.name, number, self.low, self.high) for number in parts]
        if self.differs and len(set(checked)) == 1:
            raise ArgumentError(f"{self.name} must be two different numbers, not both {checked[0]:g}")
        return checked

    def parse(self, text: str) -> Any:
        """Turn the text of an option into a value."""
        if self.empty and text == self.empty:
            return text
        if self.kind == "numbers":
            numbers = tuple(_parse_number(part) for part in text.split(","))
            return numbers[0] if self.spreads and len(numbers) == 1 else numbers
        if self.kind == "number":
            return _parse_number(text)
        try:
            return int(text)
        except ValueError:
            raise argparse.ArgumentTypeError(f"must be a whole number, not {text!r}") from None

    def write(self, value: Any) -> str:
        """Write a value as options have it, numbers shortened."""
        if value is None:
            return self.empty
        if isinstance(value, bool):
            return "yes" if value else "no"
        if self.kind == "numbers":
            return ",".join(f"{number:g}" for number in value)
        return f"{value:g}" if self.kind == "number" else str(value)

    def tell_range(self) -> str:
        """Say what it may be, or nothing where its names say it."""
        if self.kind not in ("count", "number", "numbers"):
            return ""
        unit = f" {self.unit}" if self.unit else ""
        return f"{self.low:.10g} to {self.high:.10g}{unit}"

    def tell_default(self) -> str:
        """Say what it is where nothing is said."""
        text = self.write(self.default)
        return f"{text}: {self.automatic}" if self.default is None and self.automatic else text

    def tell(self) -> str:
        """Say all of it in one line."""
        parts = [self.doc, *filter(None, [self.tell_range()])]
        if self.empty and self.default is not None:
            parts.append(f"{self.empty}: {self.automatic}" if self.automatic else f"or {self.empty}")
        return "; ".join(parts) + ("" if self.kind == "flag" else f"; default {self.tell_default()}")


def _parse_number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"must be a number, not {text!r}") from None


@functools.cache
def list_settings(stage: str) -> dict[str, Setting]:
    """Every setting of a stage by its name."""
    rows = _engine.describe_settings(stage)
    return {row["name"]: Setting(**{**row, "choices": tuple(row["choices"])}) for row in rows}


def check_settings(stage: str, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return all settings of a stage as the engine takes them, those that nothing was said of at their default.

    Raises
    ------
    ArgumentError
        If a setting may not be what it is.
    TypeError
        If there is no such setting.
    """
    known = list_settings(stage)
    for name in given:
        if name not in known:
            raise TypeError(f"there is no setting {name!r}; {stage} has {', '.join(known)}")
    return {name: setting.check(given[name]) if name in given else setting.default for name, setting in known.items()}


def add_setting_options(parser: argparse.ArgumentParser, stage: str, skip: Iterable[str] = ()) -> None:
    """Add an option for each setting of a stage; one that is not given leaves the keyword out."""
    for setting in list_settings(stage).values():
        how: dict[str, Any] = {"dest": setting.name, "default": argparse.SUPPRESS}
        if setting.kind == "flag":
            how["action"] = "store_true"
        elif setting.kind == "choice":
            how["choices"] = setting.names
        else:
            letters = ",".join("ABCD"[: setting.width])
            how |= {"type": setting.parse, "metavar": letters if setting.width > 1 else "N"}
        if setting.name not in skip:
            parser.add_argument(setting.option, help=setting.tell().replace("`", "").replace("%", "%%"), **how)


def read_setting_options(arguments: argparse.Namespace, stage: str) -> dict[str, Any]:
    """Turn the options that were given into keywords."""
    return {name: getattr(arguments, name) for name in list_settings(stage) if hasattr(arguments, name)}


def takes_settings(stage: str, skip: Iterable[str] = ()) -> Callable[[FunctionT], FunctionT]:
    """Let a function that takes a stage's settings name them, with their defaults, in its signature and docstring.

    In the docstring they take the place of ``{settings}``.
    """
    settings = [setting for setting in list_settings(stage).values() if setting.name not in skip]

    def tell(function: FunctionT) -> FunctionT:
        text = "\n".join(f"{setting.name}\n    {setting.tell()}." for setting in settings)
        if function.__doc__:
            function.__doc__ = inspect.cleandoc(function.__doc__).replace("{settings}", text)
        function.__signature__ = _name_settings(function, settings)  # type: ignore[attr-defined]
        return function

    return tell


def _name_settings(function: Callable[..., Any], settings: Iterable[Setting]) -> inspect.Signature:
    signature = inspect.signature(function)
    named = {
        name: parameter
        for name, parameter in signature.parameters.items()
        if parameter.kind is not inspect.Parameter.VAR_KEYWORD
    }
    for setting in settings:
        old = named.get(setting.name)
        kind = inspect.Parameter.KEYWORD_ONLY if old is None else old.kind
        default = setting.shown_default if old is None or old.default is None else old.default
        named[setting.name] = inspect.Parameter(setting.name, kind, default=default)
    return signature.replace(parameters=sorted(named.values(), key=lambda parameter: parameter.kind))
