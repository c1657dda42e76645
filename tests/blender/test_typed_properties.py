"""Properties are declared like the values that they hold, and known values are what Blender has."""

import importlib
from itertools import chain

import bpy
import pytest
from bpy.props import IntProperty


@pytest.fixture
def typed(extension):
    return importlib.import_module(f"{extension.__name__}.operators.blender.typed_properties")


@pytest.fixture
def known(extension):
    return importlib.import_module(f"{extension.__name__}.operators.blender.known_values")


@pytest.fixture
def registered(typed):
    """Return a class with a property of its own and one of a mixed-in base, registered for a while."""

    class Base(typed.TypedProperties):
        depth: float = typed.FloatProperty(default=0.5)

    class EigenpartsProbe(Base, bpy.types.PropertyGroup):
        level: int = typed.IntProperty(default=3)
        note: str

    bpy.utils.register_class(EigenpartsProbe)
    bpy.types.Scene.eigenparts_probe = bpy.props.PointerProperty(type=EigenpartsProbe)
    yield EigenpartsProbe
    del bpy.types.Scene.eigenparts_probe
    bpy.utils.unregister_class(EigenpartsProbe)


def test_a_declared_value_is_a_property_of_blender(registered):
    probe = bpy.context.scene.eigenparts_probe
    assert (probe.level, probe.depth) == (3, 0.5)
    probe.level = 7
    assert bpy.context.scene.eigenparts_probe.level == 7


def test_only_properties_are_registered(registered):
    assert set(registered.bl_rna.properties.keys()) == {"rna_type", "name", "level", "depth"}
    assert registered.__annotations__["note"] is str


@pytest.mark.parametrize("kind", ["Bool", "Int", "Float", "String"])
def test_each_kind_is_that_of_blender(typed, kind):
    declared = getattr(typed, f"{kind}Property")(name="Probe")
    assert declared.function is getattr(bpy.props, f"{kind}Property")
    assert declared.keywords == {"name": "Probe"}


def test_all_properties_of_ours_are_declared_with_values(extension, typed):
    """None is left an annotation that a type checker cannot read."""
    kinds = (bpy.types.Operator, bpy.types.PropertyGroup, bpy.types.AddonPreferences)
    ours = [one for one in chain(*(kind.__subclasses__() for kind in kinds)) if one.__module__.startswith("eigenparts")]
    declared = type(IntProperty())
    holders = [one for one in ours if any(isinstance(value, declared) for value in one.__annotations__.values())]
    assert len(holders) > 8
    assert all(issubclass(one, typed.TypedProperties) for one in holders)


def test_the_data_of_an_object_has_its_kind(known, star_object):
    assert known.mesh_of(star_object) == star_object.data
    with pytest.raises(AssertionError):
        known.data_of(star_object, bpy.types.Curve)
    with pytest.raises(AssertionError):
        known.present(None)


def test_a_shader_takes_values_of_its_inputs(known):
    material = bpy.data.materials.new("Probe")
    if material.node_tree is None:
        material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    known.set_input(shader, "Base Color", (0.25, 0.5, 0.75, 1.0))
    assert known.values_of(shader.inputs["Base Color"].default_value)[:3] == pytest.approx((0.25, 0.5, 0.75))
    bpy.data.materials.remove(material)
