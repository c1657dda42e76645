"""Load the checkout the way Blender loads an extension, and put meshes into the scene."""

import sys

import numpy as np
import pytest

from tools.extension import load_extension

bpy = pytest.importorskip("bpy", reason="needs Blender as a Python module")


@pytest.fixture(scope="session")
def extension():
    """The checkout under its extension name."""
    return load_extension()


@pytest.fixture(autouse=True)
def fresh_scene(extension):
    """An empty file with the extension enabled."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    extension.register()
    yield
    extension.unregister()


@pytest.fixture
def tracebacks(monkeypatch):
    """What Python said in callbacks of properties, where Blender only prints it; it must be nothing."""
    told = []
    monkeypatch.setattr(sys, "excepthook", lambda kind, error, trace: told.append(repr(error)))
    yield told
    assert told == []


@pytest.fixture(scope="session")
def star():
    """Five arms on a ball."""
    from tests.shapes import star

    return star(n_arms=5, n_subdivisions=3)


@pytest.fixture
def star_object(star):
    return add_object(star.vertices, star.triangles)


@pytest.fixture(scope="session")
def saved_scenes():
    """The files of the scenes that were made so far, with what they were made of."""
    return {}


@pytest.fixture
def scene(fresh_scene, saved_scenes, tmp_path_factory):
    """Open the scene that a function makes, and return its active object: it is made once, and a file from then on."""

    def opened(make, *arguments):
        key = make, *map(id, arguments)
        if key not in saved_scenes:
            make(*arguments)
            path = str(tmp_path_factory.mktemp("scene") / f"{make.__name__}.blend")
            bpy.ops.wm.save_as_mainfile(filepath=path)
            # The arguments are kept too, so that no other one has their place in memory.
            saved_scenes[key] = path, arguments
        bpy.ops.wm.open_mainfile(filepath=saved_scenes[key][0])
        return bpy.context.object

    return opened


@pytest.fixture
def analyzed(scene, star):
    """The star, analyzed and divided at its default level."""
    return scene(analyzed_star, star)


def analyzed_star(star):
    """Add the star and analyze it."""
    add_object(star.vertices, star.triangles)
    assert bpy.ops.eigenparts.analyze() == {"FINISHED"}


def add_object(vertices, polygons, name="star"):
    """Add a mesh object to the scene and make it active."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(np.asarray(vertices).tolist(), [], [list(map(int, polygon)) for polygon in polygons])
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    return obj


def values_of(mesh, name, components=1, dtype=np.int32, property_name="value"):
    """Return the values of an attribute."""
    data = mesh.attributes[name].data
    values = np.empty(len(data) * components, dtype=dtype)
    data.foreach_get(property_name, values)
    return values if components == 1 else values.reshape(-1, components)


def exact_labels_of(mesh):
    """Return the part that has the greater half of each face, wherever its borders are shown."""
    from eigenparts.operators.mesh_state.corrected_analysis import exact_labels
    from eigenparts.operators.mesh_state.state import read

    return exact_labels(read(mesh), values_of(mesh, "part"))


def everything_on(mesh):
    """Return all that a user could miss on a mesh: attributes with their bytes, properties, active colour."""
    sizes = {"INT": ("value", 1, np.int32), "FLOAT": ("value", 1, np.float32), "FLOAT_COLOR": ("color", 4, np.float32)}
    attributes = {
        attribute.name: values_of(mesh, attribute.name, components, dtype, name).tobytes()
        for attribute in mesh.attributes
        for name, components, dtype in [sizes.get(attribute.data_type, (None, None, None))]
        if name
    }
    names = sorted(attribute.name for attribute in mesh.attributes)
    return attributes, names, sorted(mesh.keys()), mesh.color_attributes.active_color_name


def give_custom_normals(mesh):
    """Give a mesh normals that have nothing to do with its surface, and change slowly over it."""
    mesh.shade_smooth()
    mesh.normals_split_custom_set_from_vertices(_normals_at(values_of(mesh, "position", 3, np.float32, "vector")))


def corner_normals_of(mesh):
    """Return the normals at the corners of the faces, and what they are after `give_custom_normals`."""
    corners = values_of(mesh, ".corner_vert")
    normals = np.array([normal.vector for normal in mesh.corner_normals])
    return normals, _normals_at(values_of(mesh, "position", 3, np.float32, "vector"))[corners]


def _normals_at(places):
    normals = [0.3, 0.4, 0.9] + 0.1 * np.sin(places)
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)
