"""Put meshes into files and scenes."""

import bpy
import numpy as np

from compute import TriangleMesh


def write_off(mesh, path):
    """Write a mesh as text, to the last digit."""
    vertices = [" ".join(map(repr, row)) for row in mesh.vertices.tolist()]
    faces = [" ".join(map(str, [3, *row])) for row in mesh.triangles.tolist()]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(["OFF", f"{len(vertices)} {len(faces)} 0", *vertices, *faces]) + "\n")
    return path


def write_blend(path):
    """Write what is open now."""
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True)
    return path


def add_object(mesh, name="star"):
    """Add a mesh to the scene."""
    data = bpy.data.meshes.new(name)
    data.from_pydata(mesh.vertices.tolist(), [], mesh.triangles.tolist())
    obj = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(obj)
    return obj


def turned(mesh, angle=0.7, seed=0):
    """Return a copy, turned and with its vertices and triangles in another order."""
    random = np.random.default_rng(seed)
    old_vertex = random.permutation(len(mesh.vertices))
    new_number = np.argsort(old_vertex)
    rotation = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    triangles = new_number[mesh.triangles][random.permutation(len(mesh.triangles))]
    return TriangleMesh(mesh.vertices[old_vertex] @ rotation.T, triangles)
