"""Bases for classes that are mixed into Blender's own.

A class that is not registered must not be a panel or operator itself, but is used as one wherever it is mixed in; so
type checkers are told that it is.
"""

from typing import TYPE_CHECKING

import bpy

if TYPE_CHECKING:
    OperatorMixin = bpy.types.Operator
    GroupMixin = bpy.types.PropertyGroup

    class PanelMixin(bpy.types.Panel):
        """A panel, which Blender gives its layout before it asks it to draw."""

        layout: bpy.types.UILayout
else:
    OperatorMixin = GroupMixin = PanelMixin = object
