"""The skeleton: the Reeb graph of the field, cleared of what is no limb and laid into the mesh."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import cKDTree

from ..analysis import Analysis
from ..errors import LevelError, MeshError
from ..msc.reeb import ReebGraph
from ..readings import reeb_graph
from ..segmentation.parts.part_labels import BODY
from ..surface.mesh import Bools, Floats, Ints
from ..surface.ties import CHOICE, first_largest, first_nearest
from .branching import Chain, chains_between
from .hubs import Hub, gathered_hubs, hub_numbers, joined_hubs
from .interior import Interior
from .layout import BoneLayout, Tips, layout_of, level_with_tips, root_of_layout, tips_on_sides, with_layout
from .limbs import Ends, Limb, lay_limb, trace_limb, with_equal_joints
from .ownership import bones_of_vertices
from .slices import Slices, centres_at_rest, centres_in_pose, slice_arcs
from .tips import hidden_crown, reaching, tips_of_parts, widest_slice

ONE_PART = "The mesh is one part at this level, so there are no limbs to put bones in; choose a higher level."
NO_LIMBS = "The parts of this level are too short for bones; choose another level."
# Bones shorter than this fraction of the skeleton are none.
SHORTEST_BONE = 2e-3
# The hub in the middle of a shape that has only two ends: no node of the graph.
MIDDLE = -1


@dataclass(frozen=True, eq=False)
class Skeleton:
    """Joints joined to a tree by bones; J joints, each but the root with the bone that ends in it.

    Attributes
    ----------
    joints : (J, 3) float64
    parent : (J,) int64
        The joint at which the bone begins, of smaller index; -1 for the root, which comes first.
    part : (J,) int64
        The part each bone lies in; that of the hub for the root.
    radius : (J,) float64
        Of the limb around each joint.
    loops : (L, 2) int64
        Pairs of joints at one place, where a handle was opened to make the graph a tree.
    bone_of_vertex : (V,) int64
        The bone, by the joint it ends in, that each vertex of the input belongs to.
    warnings : tuple of str
        Sentences for the user.
    layout : BoneLayout or None
        Which bones these are, to lay the same into a registered shape; None where there are loops.
    """

    joints: Floats
    parent: Ints
    part: Ints
    radius: Floats
    loops: Ints
    bone_of_vertex: Ints
    warnings: tuple[str, ...] = ()
    layout: BoneLayout | None = None


def skeleton(
    analysis: Analysis,
    *,
    level: int | None = None,
    mode: str = "features",
    labels: NDArray[np.int32] | None = None,
    poses: Sequence[ArrayLike] = (),
    n_pieces: int = 1,
    partner: Ints | None = None,
    layout: BoneLayout | None = None,
) -> Skeleton:
    """Return joints and bones of a shape from the Reeb graph of its field.

    Joints lie where limbs begin, at necks, and at the bends of the pose at hand and of further ones.

    Parameters
    ----------
    analysis : Analysis
    level : int, optional
        Which extrema are limbs; the default level if None.
    mode : "features" or "nested"
        Which of them are parts.
    labels : (T,) int32, optional
        Parts of the input's triangles in place of those of the level, such as those of a registered shape.
    poses : sequence of (V, 3) float
        The vertices in other poses.
    n_pieces : int
        Bones that a long straight limb is divided into, so that it can be bent.
    partner : (P,) int64, optional
        For each label the part that is its mirror image, as of `mirror_parts`: both get joints at the same places.
    layout : BoneLayout, optional
        Of the skeleton of another shape with the same parts: equal parts get the same bones here, whatever the level,
        and each joint lies at the same share of the way along its limb.

    Raises
    ------
    LevelError
        If the level does not exist or has one part only.
    MeshError
        If a pose does not have the vertices of the mesh.
    RegistrationError
        If each shell was analyzed by itself.

    References
    ----------
    .. [1] Reuter, IJCV 2010, section 5.3 and Fig. 19.
    """
    analysis.require_one_shape()
    if labels is None:
        labels = _labels_of_level(analysis, level, mode)
    if layout is not None:
        level = analysis.hierarchy.default_level if level is None else level
        level = level_with_tips(analysis, labels, layout.tips, level)
    graph = reeb_graph(analysis, level=level)
    if labels.min() == labels.max():
        raise LevelError(ONE_PART)
    slices = slice_arcs(analysis, graph, labels)
    interior = Interior.of(analysis.surface)
    others = _checked_poses(analysis, poses)
    at_rest = centres_at_rest(analysis)
    middles = [interior.centred(slices.means(at_rest), slices.radius)]
    centres = np.stack([*middles, *(slices.means(centres_in_pose(analysis, vertices)) for vertices in others)])
    poses_of_mesh = np.stack([analysis.mesh.vertices, *others])
    plan = _plan(analysis, graph, slices, centres, poses_of_mesh, at_rest, interior, layout)
    traces = [
        trace_limb(chain, ends, slices, plan.centres, n_pieces)
        for chain, ends in zip(plan.chains, plan.ends, strict=True)
    ]
    if partner is not None:
        traces = with_equal_joints(traces, slices, partner)
    if layout is not None:
        traces = with_layout(traces, plan.sides, layout)
    limbs = [lay_limb(trace, slices) for trace in traces]
    found = _assembled(analysis, plan, limbs, slices, interior)
    if any(plan.closes_loop):
        return found
    return replace(found, layout=layout_of(traces, plan.sides, plan.root, labels, slices))


def _labels_of_level(analysis: Analysis, level: int | None, mode: str) -> NDArray[np.int32]:
    """Return the parts of a level; of a shape whose features are all at its handles, the parts that end there."""
    labels = analysis.segment(level=level, mode=mode).labels
    if labels.min() == labels.max():
        return analysis.segment(level=level, mode=mode, essential=True).labels
    return labels


def _checked_poses(analysis: Analysis, poses: Sequence[ArrayLike]) -> list[Floats]:
    """Return further poses as arrays, or say which one has the wrong number of vertices."""
    arrays = [np.asarray(pose, dtype=np.float64) for pose in poses]
    for number, pose in enumerate(arrays, start=1):
        if pose.shape != analysis.mesh.vertices.shape or not np.isfinite(pose).all():
            n_vertices = len(analysis.mesh.vertices)
            raise MeshError(f"Pose {number} needs a finite place for each of the {n_vertices} vertices of the mesh.")
    return arrays


@dataclass(frozen=True, eq=False)
class _Plan:
    """Chains with their ends and the tips on both sides, from the root outward, and the middles of the slices."""

    hubs: list[Hub]
    root: int
    root_part: int
    chains: list[Chain]
    ends: list[Ends]
    sides: list[tuple[Tips, Tips]]
    closes_loop: list[bool]
    centres: Floats


def _plan(
    analysis: Analysis,
    graph: ReebGraph,
    slices: Slices,
    centres: Floats,
    poses: Floats,
    at_rest: Floats,
    interior: Interior,
    layout: BoneLayout | None,
) -> _Plan:
    part_of_tip = tips_of_parts(analysis, graph, slices, layout)
    tips = set(part_of_tip)
    bare = chains_between(graph, slices, tips)
    chains, hubs = _with_middle(bare, _hubs(bare, part_of_tip, slices, centres, layout), tips, slices, centres)
    if not chains:
        raise LevelError(NO_LIMBS)
    root = _root(chains, hubs, slices)
    if layout is not None:
        known = root_of_layout(layout, chains, hubs, tips_on_sides(chains, part_of_tip, hubs))
        root = known if known >= 0 else root
    parts = [_part_of_hub(hub, graph, slices) for hub in hubs]
    order, closes_loop = _from_root(chains, hubs, root)
    vertices = cKDTree(analysis.mesh.vertices)
    nearest = first_nearest(vertices, analysis.net.positions[graph.vertex])
    number = hub_numbers(hubs)
    ends, centres = [], centres.copy()
    for chain in order:
        start, end = number[chain.start], number.get(chain.end, -1)
        if end >= 0:
            place, part = hubs[end].places, parts[end]
        else:
            crown = hidden_crown(chain, slices, centres[0], at_rest)
            tip, last = nearest[chain.end], chain.slices[-1]
            if crown is not None:
                tip, last = first_nearest(vertices, at_rest[crown, None])[0], widest_slice(chain, slices)
            place, part = reaching(centres[:, last], poses[:, tip], interior), -1
            late = chain.slices[1 + np.flatnonzero(chain.slices == last)[0] :]
            way = np.linspace(0, 1, len(late) + 2)[1:-1, None]
            centres[:, late] = centres[:, last, None] + way * (place - centres[:, last])[:, None]
        ends.append(Ends(start, end, np.stack([hubs[start].places, place], axis=1), (parts[start], part)))
    return _Plan(hubs, root, parts[root], order, ends, tips_on_sides(order, part_of_tip, hubs), closes_loop, centres)


def _hubs(
    chains: list[Chain], part_of_tip: dict[int, int], slices: Slices, centres: Floats, layout: BoneLayout | None
) -> list[Hub]:
    """Return the hubs: of a known layout those that lie between its limbs, else nodes that lie close together."""
    if layout is None:
        return gathered_hubs(chains, set(part_of_tip), slices, centres)
    nodes = {end for chain in chains for end in (chain.start, chain.end)} - set(part_of_tip)
    sides = zip(chains, tips_on_sides(chains, part_of_tip), strict=True)
    joints = [chain for chain, both in sides if {chain.start, chain.end} <= nodes and not layout.is_split(both)]
    return joined_hubs(nodes, joints, chains, slices, centres)


def _with_middle(
    chains: list[Chain], hubs: list[Hub], tips: set[int], slices: Slices, centres: Floats
) -> tuple[list[Chain], list[Hub]]:
    """Return chains and hubs; a single chain from tip to tip is given a hub in its middle."""
    if not hubs and len(chains) == 1:
        (chain,) = chains
        length = np.cumsum(slices.length[chain.slices])
        half = min(int(np.searchsorted(length, (0.5 - CHOICE) * length[-1])), len(length) - 1)
        middle = chain.slices[half]
        hubs = [Hub(frozenset([MIDDLE]), centres[:, middle], float(slices.radius[middle]))]
        chains = [
            Chain(MIDDLE, chain.start, chain.slices[: half + 1][::-1]),
            Chain(MIDDLE, chain.end, chain.slices[half:]),
        ]
    number = hub_numbers(hubs)
    return [_outward(chain, tips) for chain in chains if not _is_inside(chain, number)], hubs


def _outward(chain: Chain, tips: set[int]) -> Chain:
    return chain.reversed() if chain.start in tips else chain


def _is_inside(chain: Chain, number: Mapping[int, int]) -> bool:
    """Whether a chain was gathered into a hub, given those of nodes; a loop of its own at a node was not."""
    start, end = number.get(chain.start, -1), number.get(chain.end, -1)
    return start == end >= 0 and chain.start != chain.end


def _root(chains: list[Chain], hubs: list[Hub], slices: Slices) -> int:
    """Return the hub farthest from the bluntest limb: the hips, as that limb is the head in most cases."""
    number = hub_numbers(hubs)
    free = [chain for chain in chains if chain.end not in number] or chains[:1]
    bluntness = [np.median(slices.radius[chain.slices]) / slices.length[chain.slices].sum() for chain in free]
    blunt = free[first_largest(np.array(bluntness))]
    head = hubs[number.get(blunt.start, -1)].places[0]
    return int(first_largest(np.array([np.linalg.norm(hub.places[0] - head) for hub in hubs])))


def _part_of_hub(hub: Hub, graph: ReebGraph, slices: Slices) -> int:
    """Return the part that the widest of the level sets below a hub lies in; what grows out of it lies above."""
    arcs = enumerate(graph.arcs.tolist())
    below = [slices.of_arc(arc) for arc, (low, high) in arcs if high in hub.nodes and low not in hub.nodes]
    tops = [int(of_arc[-1]) for of_arc in below if len(of_arc)]
    return int(slices.part[tops[first_largest(slices.girth[tops])]]) if tops else BODY


def _from_root(chains: list[Chain], hubs: list[Hub], root: int) -> tuple[list[Chain], list[bool]]:
    """Return the chains in the order in which they are met from the root, each from its inner end."""
    reached, waiting, left = {root}, [root], list(chains)
    number = hub_numbers(hubs)
    order: list[Chain] = []
    closes_loop: list[bool] = []
    while waiting:
        hub = waiting.pop(0)
        for chain in [chain for chain in left if hub in (number.get(chain.start), number.get(chain.end))]:
            left.remove(chain)
            order.append(chain if number.get(chain.start) == hub else chain.reversed())
            end = number.get(order[-1].end, -1)
            closes_loop.append(end in reached)
            if end >= 0 and end not in reached:
                reached.add(end)
                waiting.append(end)
    return order, closes_loop


def _assembled(analysis: Analysis, plan: _Plan, limbs: list[Limb], slices: Slices, interior: Interior) -> Skeleton:
    """Put limbs together to a tree."""
    joint_of_hub = {plan.root: 0}
    joints, parent = [plan.hubs[plan.root].places[:1]], [np.array([-1])]
    part, radius = [np.array([plan.root_part])], [np.array([plan.hubs[plan.root].radius])]
    loops, bone_of_slice, n_joints = [], np.full(slices.count, -1), 1
    for limb, closes_loop in zip(limbs, plan.closes_loop, strict=True):
        numbers = n_joints + np.arange(len(limb.joints))
        joints.append(limb.joints)
        parent.append(np.append(joint_of_hub[limb.start], numbers[:-1]))
        part.append(limb.part)
        radius.append(limb.radius)
        bone_of_slice[limb.slices] = numbers[limb.bone_of_slice]
        if closes_loop:
            loops.append((int(numbers[-1]), joint_of_hub[limb.end]))
        elif limb.end >= 0:
            joint_of_hub[limb.end] = int(numbers[-1])
        n_joints += len(numbers)
    places = np.concatenate(joints)
    tree, parts = np.concatenate(parent), np.concatenate(part)
    radii = np.concatenate(radius)
    pairs = np.array(loops, dtype=np.int64).reshape(-1, 2)
    is_tip = _is_leaf(tree)
    is_tip[pairs[:, 0]] = False
    strays = np.flatnonzero(~is_tip | ~interior.holds(places))
    places[strays] = interior.pulled_inside(places[strays], radii[strays])
    kept, stands_for = _real_joints(places, tree)
    places, tree, parts, radii = places[kept], stands_for[tree[kept]], parts[kept], radii[kept]
    tree[0], pairs = -1, stands_for[pairs]
    bone_of_slice = np.where(bone_of_slice < 0, -1, stands_for[bone_of_slice])
    bone_of_slice[bone_of_slice == 0] = -1
    bones = bones_of_vertices(analysis, slices, bone_of_slice, places, tree, parts)
    return Skeleton(places, tree, parts, radii, pairs, bones, _warnings(analysis, len(pairs)))


def _real_joints(places: Floats, parent: Ints) -> tuple[Ints, Ints]:
    """Return the joints with a bone of some length, and for each joint the place of the one that stands for it."""
    least = SHORTEST_BONE * np.ptp(places, axis=0).max()
    stands_for = np.arange(len(parent))
    for joint in range(1, len(parent)):
        before = stands_for[parent[joint]]
        if np.linalg.norm(places[joint] - places[before]) < least:
            stands_for[joint] = before
    kept, number = np.unique(stands_for, return_inverse=True)
    return kept, number.reshape(-1)


def _is_leaf(parent: Ints) -> Bools:
    is_leaf = np.ones(len(parent), dtype=bool)
    is_leaf[parent[1:]] = False
    return is_leaf


def _warnings(analysis: Analysis, n_loops: int) -> tuple[str, ...]:
    warnings = []
    if analysis.surface.n_components > 1:
        warnings.append(
            f"The mesh has {analysis.surface.n_components} loose parts; the bones lie in {analysis.surface.n_joined} of"
            " them, the others follow what is next to them."
        )
    if n_loops:
        handles = "a handle" if n_loops == 1 else f"{n_loops} handles"
        warnings.append(f"The shape has {handles}; bones are a tree, so they are open at one end there.")
    return tuple(warnings)
