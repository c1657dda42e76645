"""Layers of a mesh as arrays: weights, maps, keys and the like in one form for reading, mapping and writing."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

from numpy.typing import NDArray

from .attribute_types import STORAGES, AttributeType

if TYPE_CHECKING:
    from .shape_key_settings import ShapeKeySettings

GROUP, POINT, FACE, CORNER, SHAPE_KEY, MATERIAL, PARTS = (
    "GROUP", "POINT", "FACE", "CORNER", "SHAPE_KEY", "MATERIAL", "PARTS",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Layer:
    """One layer of a mesh.

    Attributes
    ----------
    kind : str
        One of the names above.
    name : str
    values : (n, components)
        For each vertex, face or corner.
    data_type : str
        Of an attribute, as Blender calls it.
    names : tuple of str
        Of the materials that values count.
    is_uv : bool
    settings : ShapeKeySettings, optional
        Of a shape key.
    is_companion : bool
        Whether it comes along with another layer, and what the target has of that name stays.
    """

    kind: str
    name: str
    values: NDArray[Any]
    data_type: AttributeType | Literal[""] = ""
    names: tuple[str, ...] = ()
    is_uv: bool = False
    settings: ShapeKeySettings | None = None
    is_companion: bool = False

    @property
    def can_blend(self) -> bool:
        """Whether values between two values make sense."""
        if self.kind in (GROUP, SHAPE_KEY):
            return True
        return self.kind in (POINT, CORNER) and STORAGES[self.data_type].can_blend

    def with_values(self, values: NDArray[Any]) -> Layer:
        """Return the layer with other values."""
        return replace(self, values=values)
