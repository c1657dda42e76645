"""The form of an output: what the user reads of it, the attributes it writes, and how it is written and taken back."""

from collections.abc import Callable
from dataclasses import dataclass

import bpy

from ..mesh_data.mesh_arrays import OwnAttribute
from .division import Division


@dataclass(frozen=True)
class Output:
    """Something that the parts of a mesh can be written to beside the face map; it follows the level.

    Attributes
    ----------
    key : str
        How it is called in scripts and on the mesh.
    name, description : str
        For the user.
    attributes : tuple of OwnAttribute
        What it writes, so that something of the user's of that name is noticed before.
    write : callable
        Writes it to a mesh, over what is ours only.
    remove : callable
        Takes it back, if it is there.
    is_default, shows_colours : bool
    is_compound : bool
        Whether it is more than attributes and properties of the mesh, so that it is written anew after a failure.
    options : tuple of str
        Settings of the mesh that it depends on, which the panel shows below it.
    """

    key: str
    name: str
    description: str
    attributes: tuple[OwnAttribute, ...]
    write: Callable[[bpy.types.Mesh, Division], None]
    remove: Callable[[bpy.types.Mesh], None]
    is_default: bool = False
    shows_colours: bool = False
    is_compound: bool = False
    options: tuple[str, ...] = ()

    @property
    def property_name(self) -> str:
        """The name of its tick box among the settings of a mesh."""
        return self.key.lower()
