"""The skeleton: the Reeb graph of the field, cleared of all that is no limb and laid into the mesh."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..analysis.analysis import Analysis
from ..errors import LevelError
from ..memory import require_memory, told_if_full
from ..surface.mesh import Floats, Ints
from .joint_tree import join_limbs, pulled_inside, without_short_bones
from .layout import BoneLayout, layout_of, level_with_tips, with_layout
from .limb_plan import plan_limbs
from .limbs import lay_limb, trace_limb, with_equal_joints
from .ownership import bones_of_vertices
from .sliced_shape import slice_shape

# Peak memory for each vertex of the net and of the input (docs/method.md).
BYTES_PER_NODE = 1100
BYTES_PER_VERTEX = 900
TOO_LARGE = (
    "Bones for {:,} vertices take about {} of memory, and {} are free; decimate the mesh or close other programs."
)


@dataclass(frozen=True, eq=False)
class Skeleton:
    """Joints joined to a tree by bones; J joints, each but the root with the bone that ends in it.

    Attributes
    ----------
    joints : (J, 3) float64
        In the mesh's unit of length.
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
        The pattern of the bones, to lay the same into a registered shape; None where there are loops.

    Examples
    --------
    A root with two bones, one after the other:

    >>> import numpy as np
    >>> from compute import Skeleton
    >>> chain = Skeleton(
    ...     joints=np.array([[0.0, 0, 0], [0, 0, 1], [0, 0, 3]]),
    ...     parent=np.array([-1, 0, 1]),
    ...     part=np.array([0, 1, 1]),
    ...     radius=np.full(3, 0.2),
    ...     loops=np.zeros((0, 2), dtype=np.int64),
    ...     bone_of_vertex=np.array([1, 1, 2]),
    ... )
    >>> np.linalg.norm(chain.joints[1:] - chain.joints[chain.parent[1:]], axis=1).tolist()
    [1.0, 2.0]
    """

    joints: Floats
    parent: Ints
    part: Ints
    radius: Floats
    loops: Ints
    bone_of_vertex: Ints
    warnings: tuple[str, ...] = ()
    layout: BoneLayout | None = None


@told_if_full
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
        The level whose extrema are limbs; the default one if None.
    mode : "features" or "nested"
        The mode in which parts are made of them.
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

    Returns
    -------
    Skeleton

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

    Examples
    --------
    A spindle has a bone in either half.

    >>> import numpy as np
    >>> from compute import TriangleMesh, analyze, skeleton
    >>> height, angle = np.mgrid[-3:3:13j, 0 : 2 * np.pi : 8j][:, :, :-1].reshape(2, -1)
    >>> k, right = np.arange(84), np.arange(84).reshape(12, 7)[:, [1, 2, 3, 4, 5, 6, 0]].ravel()
    >>> triangles = np.concatenate([np.stack([k, right, right + 7], 1), np.stack([k, right + 7, k + 7], 1)])
    >>> girth = np.sqrt(9 - height**2) / 3
    >>> spindle = TriangleMesh(np.stack([girth * np.cos(angle), girth * np.sin(angle), height], 1), triangles)
    >>> analysis = analyze(spindle, field=1)
    >>> halves = (height[triangles].mean(axis=1) > 0).astype(np.int32)
    >>> bones = skeleton(analysis, labels=halves)
    >>> bones.parent.tolist(), sorted(np.sign(bones.joints[1:, 2]).tolist())
    ([-1, 0, 0], [-1.0, 1.0])
    """
    analysis.require_one_shape()
    n_vertices = len(analysis.mesh.vertices)
    require_memory(BYTES_PER_NODE * len(analysis.net.positions) + BYTES_PER_VERTEX * n_vertices, TOO_LARGE, n_vertices)
    if n_pieces < 1:
        raise LevelError(f"A long limb is divided into at least 1 bone, not {n_pieces}.")
    labels = analysis.exact_labels(_labels_of_level(analysis, level, mode) if labels is None else labels)
    if layout is not None:
        level = analysis.hierarchy.default_level if level is None else level
        level = level_with_tips(analysis, labels, layout.tips, level)
    shape = slice_shape(analysis, labels, level, poses)
    plan = plan_limbs(shape, layout)
    traces = [trace_limb(limb.chain, limb.ends, shape.slices, plan.centres, n_pieces) for limb in plan.limbs]
    sides = [limb.sides for limb in plan.limbs]
    if partner is not None:
        traces = with_equal_joints(traces, shape.slices, partner)
    if layout is not None:
        traces = with_layout(traces, sides, layout)
    tree = join_limbs(plan, [lay_limb(trace, shape.slices) for trace in traces], shape.slices.count)
    tree = without_short_bones(pulled_inside(tree, shape.interior))
    return Skeleton(
        joints=tree.places,
        parent=tree.parent,
        part=tree.part,
        radius=tree.radius,
        loops=tree.loops,
        bone_of_vertex=bones_of_vertices(analysis, shape.slices, tree),
        warnings=_warnings(analysis, len(tree.loops)),
        layout=None if len(tree.loops) else layout_of(traces, sides, plan.root, labels, shape.slices),
    )


def _labels_of_level(analysis: Analysis, level: int | None, mode: str) -> NDArray[np.int32]:
    """Return the parts of a level; of a shape whose features are all at its handles, the parts that end there."""
    labels = analysis.segment(level=level, mode=mode, joints=False).labels
    if labels.min() == labels.max():
        return analysis.segment(level=level, mode=mode, joints=False, essential=True).labels
    return labels


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
