"""Dense maps between characters: ``python -m benchmarks.between_characters --data DIR``.

Horse, wolf and fox have rigs whose bones have the same names. The main bone of a vertex, that of the largest weight, is
right if it is that of the weights carried from the other animal; bones that the source's vertices do not have count as
wrong. "neighbour" counts a bone next to the right one in the rig, too. Other characters have landmarks: one is right if
the nearest landmark along the source's surface, of the names that both have, has its name. Beside it stands the
nearest point in space, as the meshes stand in their files. CPU seconds are those after the eigenfunctions, matching
included.
"""

import argparse
import json
import struct
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from benchmarks.peers import versions_of
from benchmarks.posed_families import SurfacePoints, closest_points, read_mesh
from compute import Analysis, TriangleMesh, analyze, correspond
from compute.surface.mesh import Bools, Floats, Ints

ANIMALS = "quaternius-animals"
RIGGED = tuple((one, other) for one in ("wolf", "horse", "fox") for other in ("fox", "horse", "wolf") if one != other)
LANDMARKED = (
    *(("odedstein-human", "makehuman"), ("makehuman", "odedstein-human")),
    *(("makehuman", f"quaternius-men-{name}") for name in ("casual", "king", "punk", "adventurer")),
    *(("makehuman", "cesium-man"), ("cesium-man", "makehuman")),
    *(("quaternius-husky", f"quaternius-{name}") for name in ("shibainu", "cow")),
    *(("quaternius-cow", f"quaternius-{name}") for name in ("donkey", "husky")),
    *(("quaternius-donkey", f"quaternius-{name}") for name in ("husky", "fox")),
    ("quaternius-fox", "quaternius-donkey"),
)
COMPONENTS = {5121: np.uint8, 5123: np.uint16, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}


@dataclass(frozen=True, eq=False)
class Rig:
    """The B bones of an animal, the parent of each (-1 for none), and their weights (V, B)."""

    names: list[str]
    parents: list[int]
    weights: Floats


class GltfFile:
    """What a .glb says of a skinned mesh, as far as it is needed here."""

    def __init__(self, path: Path) -> None:
        data = path.read_bytes()
        length = struct.unpack_from("<I", data, 12)[0]
        self.table = json.loads(data[20 : 20 + length])
        self._binary = data[28 + length :]

    def array(self, number: int) -> Floats:
        """Return the entries (n, width) of an accessor."""
        accessor = self.table["accessors"][number]
        view = self.table["bufferViews"][accessor["bufferView"]]
        offset, width = view.get("byteOffset", 0) + accessor.get("byteOffset", 0), WIDTHS[accessor["type"]]
        kind = COMPONENTS[accessor["componentType"]]
        return np.frombuffer(self._binary, kind, accessor["count"] * width, offset).reshape(-1, width)

    def attribute(self, name: str) -> Floats:
        """Return an attribute (n, width) of all pieces of the first mesh."""
        return np.concatenate([self.array(p["attributes"][name]) for p in self.table["meshes"][0]["primitives"]])

    def matrices(self) -> dict[int, Floats]:
        """Return the (4, 4) matrix of each node in the scene."""
        nodes, found = self.table["nodes"], {}
        ahead = [(root, np.eye(4)) for root in self.table["scenes"][0]["nodes"]]
        while ahead:
            number, above = ahead.pop()
            found[number] = above @ _local_matrix(nodes[number])
            ahead += [(child, found[number]) for child in nodes[number].get("children", [])]
        return found


def _local_matrix(node: dict[str, Any]) -> Floats:
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    matrix = np.eye(4)
    matrix[:3, :3] = (np.eye(3) + 2 * w * cross + 2 * cross @ cross) * node.get("scale", (1, 1, 1))
    matrix[:3, 3] = node.get("translation", (0, 0, 0))
    return matrix


def load_rig(path: Path, mesh: TriangleMesh) -> Rig:
    """Return the bones of a .glb with their weights at the vertices of a mesh that was made from it."""
    file = GltfFile(path)
    skin, matrices, nodes = file.table["skins"][0], file.matrices(), file.table["nodes"]
    inverse = file.array(skin["inverseBindMatrices"]).reshape(-1, 4, 4).swapaxes(1, 2)
    motions = np.array([matrices[joint] @ start for joint, start in zip(skin["joints"], inverse, strict=True)])
    places, joints, shares = (file.attribute(name) for name in ("POSITION", "JOINTS_0", "WEIGHTS_0"))
    placed = np.einsum("nk,nkij,nj->ni", shares, motions[joints], np.c_[places, np.ones(len(places))])[:, :3]
    nearest = cKDTree(placed).query(mesh.vertices)[1]
    weights = np.zeros((len(mesh.vertices), len(motions)))
    np.add.at(weights, (np.arange(len(weights))[:, None], joints[nearest]), shares[nearest])
    above = {child: node for node in skin["joints"] for child in nodes[node].get("children", [])}
    place = {node: number for number, node in enumerate(skin["joints"])}
    parents = [place.get(above.get(node), -1) for node in skin["joints"]]
    return Rig([nodes[node]["name"] for node in skin["joints"]], parents, weights)


def main_bones(source: Rig, target: Rig, found: SurfacePoints, triangles: Ints) -> tuple[float, float]:
    """Return the share of vertices with the right main bone, and of those with it or one next to it."""
    carried = np.einsum("nk,nkb->nb", found.barycentric, source.weights[triangles[found.triangle]])
    got, own = np.array(source.names)[carried.argmax(axis=1)], np.array(target.names)[target.weights.argmax(axis=1)]
    above = {name: target.names[parent] for name, parent in zip(target.names, target.parents, strict=True)}
    near = [g == o or above.get(g) == o or above[o] == g for g, o in zip(got.tolist(), own.tolist(), strict=True)]
    return float((got == own).mean()), float(np.mean(near))


@dataclass(frozen=True, eq=False)
class Landmarks:
    """Vertices (n,) and their names (n,)."""

    vertices: Ints
    names: NDArray[np.str_]

    def of(self, names: set[str]) -> "Landmarks":
        """Return those with certain names."""
        chosen: Bools = np.isin(self.names, sorted(names))
        return Landmarks(self.vertices[chosen], self.names[chosen])


def landmarks_right(source: Landmarks, target: Landmarks, found: SurfacePoints, mesh: TriangleMesh) -> float:
    """Return the share of the target's landmarks that land on the source nearest to one of their name."""
    both = set(source.names) & set(target.names)
    source, target = source.of(both), target.of(both)
    row = np.arange(len(target.vertices))
    corner = found.barycentric[target.vertices].argmax(axis=1)
    landed = mesh.triangles[found.triangle[target.vertices]][row, corner]
    away = dijkstra(_paths(mesh), directed=False, indices=source.vertices)[:, landed]
    straight = np.linalg.norm(mesh.vertices[source.vertices][:, None] - mesh.vertices[landed], axis=2)
    # Between loose parts there is no way along the surface.
    away = np.where(np.isfinite(away).any(axis=0), away, straight)
    return float((source.names[away.argmin(axis=0)] == target.names).mean())


def _paths(mesh: TriangleMesh) -> coo_array:
    one, other = mesh.edges.vertices.T
    lengths = np.linalg.norm(mesh.vertices[one] - mesh.vertices[other], axis=1)
    return coo_array((np.maximum(lengths, 1e-12), (one, other)), shape=(len(mesh.vertices),) * 2).tocsr()


class Characters:
    """Reads and analyzes characters of the data folder, each once."""

    def __init__(self, data: Path) -> None:
        self._data = data
        self.analysis = cache(self._analysis)
        self.rig = cache(self._rig)

    def _analysis(self, name: str) -> Analysis:
        path = f"{ANIMALS}/{name}_0_rest.off" if name in dict(RIGGED) else self._about(name)["mesh"]
        analysis = analyze(read_mesh(self._data / path))
        analysis.matching_basis  # noqa: B018 - computed here, so that it is not counted
        return analysis

    def _rig(self, name: str) -> Rig:
        return load_rig(self._data / ANIMALS / "glb" / f"{name.title()}.glb", self.analysis(name).mesh)

    def landmarks(self, name: str) -> Landmarks:
        """Return the landmarks of a character."""
        known = self._about(name)["landmarks"]
        names = np.repeat(list(known), [len(vertices) for vertices in known.values()])
        return Landmarks(np.concatenate(list(known.values())), names)

    def _about(self, name: str) -> dict[str, Any]:
        return json.loads((self._data / "names" / f"{name}.json").read_text())


def rigged_rows(characters: Characters) -> Iterator[str]:
    """Yield a row for each pair of rigged animals."""
    for source, target in RIGGED:
        ours, nearest, rest = _maps(characters, source, target)
        rigs, triangles = (characters.rig(source), characters.rig(target)), characters.analysis(source).mesh.triangles
        right, near = main_bones(*rigs, ours, triangles)
        plain, plain_near = main_bones(*rigs, nearest, triangles)
        yield _row(f"{source} to {target}", f"{right:.1%}", f"{near:.1%}", f"{plain:.1%}", f"{plain_near:.1%}", *rest)


def landmark_rows(characters: Characters) -> Iterator[str]:
    """Yield a row for each pair of characters with landmarks."""
    for source, target in LANDMARKED:
        ours, nearest, rest = _maps(characters, source, target)
        known, mesh = (characters.landmarks(source), characters.landmarks(target)), characters.analysis(source).mesh
        right, plain = (landmarks_right(*known, points, mesh) for points in (ours, nearest))
        yield _row(f"{source} to {target}", f"{right:.1%}", f"{plain:.1%}", *rest)


def _maps(characters: Characters, source: str, target: str) -> tuple[SurfacePoints, SurfacePoints, tuple[str, ...]]:
    """Return our map, the nearest points, and the confidence, share of sure vertices and CPU seconds of ours."""
    analyses = characters.analysis(source), characters.analysis(target)
    start = time.process_time()
    found = correspond(*analyses)
    seconds = time.process_time() - start
    nearest = closest_points(analyses[1].mesh.vertices, analyses[0].mesh)
    rest = f"{found.matching.confidence:.2f}", f"{found.is_sure.mean():.0%}", f"{seconds:.1f}"
    return SurfacePoints(found.triangles, found.barycentric), nearest, rest


def _row(*cells: str) -> str:
    return "| " + " | ".join(cells) + " |"


def _print(heads: tuple[str, ...], rows: Iterator[str]) -> None:
    sys.stdout.write(f"\n{_row(*heads)}\n{'|---' * len(heads)}|\n")
    for row in rows:
        sys.stdout.write(row + "\n")
        sys.stdout.flush()


def main() -> int:
    """Print the tables as Markdown."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True, help="folder with quaternius-animals, names and others")
    parser.add_argument("--rigged", action="store_true", help="the main bones only")
    arguments = parser.parse_args()
    sys.stdout.write(versions_of("numpy", "scipy") + "\n")
    characters, rest = Characters(arguments.data), ("confidence", "sure", "CPU s")
    if (arguments.data / ANIMALS / "glb").is_dir():
        heads = "pair", "main bone right", "or a neighbour", "nearest in space", "or a neighbour"
        _print((*heads, *rest), rigged_rows(characters))
    else:
        sys.stdout.write("no rigged animals: left out\n")
    if not arguments.rigged and (arguments.data / "names").is_dir():
        _print(("pair", "landmarks right", "nearest in space", *rest), landmark_rows(characters))
    elif not arguments.rigged:
        sys.stdout.write("no landmarks: left out\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
