"""All that a shape key and its drivers are set to, as plain values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

Settings = dict[str, Any]


@dataclass(frozen=True)
class DriverTarget:
    """What a variable of a driver reads.

    Attributes
    ----------
    role : str
        What it is of the object that has the driver; nothing if it is anything else.
    id_type, name : str
        Of the data, so that it is found again.
    settings : dict
    """

    role: str
    id_type: str
    name: str
    settings: Settings


@dataclass(frozen=True)
class ShapeKeyDriver:
    """A driver with its variables and its curve.

    Attributes
    ----------
    setting : str
        Of the shape key.
    settings, curve : dict
    variables : tuple
        For each variable its settings and what it reads.
    keyframes, modifiers : tuple of dict
        Of the curve.
    """

    setting: str
    settings: Settings
    curve: Settings
    variables: tuple[tuple[Settings, tuple[DriverTarget, ...]], ...]
    keyframes: tuple[Settings, ...]
    modifiers: tuple[Settings, ...]


@dataclass(frozen=True)
class ShapeKeySettings:
    """All that a shape key is set to.

    Attributes
    ----------
    values : dict
        Value, range, mute, interpolation and the name of the vertex group.
    relative_to : str
        The key that it starts from; nothing for the Basis.
    drivers : tuple of ShapeKeyDriver
    """

    values: Settings
    relative_to: str
    drivers: tuple[ShapeKeyDriver, ...]

    @property
    def vertex_group(self) -> str:
        """Name of the vertex group that limits the key; empty if there is none."""
        return str(self.values["vertex_group"])
