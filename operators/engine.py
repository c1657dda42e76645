"""What the operators use of the engine, loaded when first asked for: scipy takes its time, and may be missing."""

import sys
from importlib import import_module
from importlib.util import find_spec
from typing import Any

MISSING_SCIPY = (
    "Eigenparts needs scipy, which is not installed; "
    "install the Eigenparts zip made for your system and Blender version, or add scipy to Blender's Python."
)

_HOME = {
    "EngineError": "errors",
    "Cancelled": "errors",
    "naming": "progress",
    "section": "progress",
    "TriangleMesh": "mesh",
    "Hierarchy": "segmentation.hierarchy",
    "ArcTree": "segmentation.arc_tree",
    "Branches": "segmentation.branches",
    "Parts": "segmentation.parts",
    "EdgeProfile": "segmentation.profile",
    "label_branches": "segmentation.parts",
    "solve_eigenbasis": "fem.eigenbasis",
    "vertex_heights": "segmentation.profile",
    "cut_arcs": "segmentation.parts",
    "label_behind": "segmentation.parts",
    "connected_branches": "segmentation.branches",
    "FaceGraph": "segmentation.faces",
    "shortened_borders": "segmentation.edge_borders",
    "face_graph": "segmentation.faces",
    "analyzed_surface": "surface",
    "cross_edges": "segmentation.borders",
    "softened_labels": "geodesics",
    "Correction": "segmentation.corrections",
    "Corrections": "segmentation.corrections",
    "CORRECTION_KINDS": "segmentation.corrections",
    "LEVEL": "segmentation.corrections",
    "MERGE": "segmentation.corrections",
    "SPLIT": "segmentation.corrections",
    "MOVE": "segmentation.corrections",
    "PAINT": "segmentation.corrections",
    "MODES": "segmentation.parts",
    "judge_eigenfunctions": "segmentation.function_hints",
    "FunctionHint": "segmentation.function_hints",
    "first_own_part": "segmentation.nesting",
    "number_behind": "segmentation.nesting",
    "Divided": "segmentation.carrying",
    "carried": "segmentation.carrying",
    "carried_painting": "segmentation.carrying",
    "renumbered": "segmentation.carrying",
    "redraw": "segmentation.redrawing",
    "undivided": "segmentation.redrawing",
    "needs_faces": "segmentation.redrawing",
    "hill_of": "segmentation.redrawing",
    "drawn_borders": "segmentation.redrawing",
    "joined_parts": "segmentation.redrawing",
    "corrected_crossings": "segmentation.redrawing",
    "Hill": "segmentation.relief",
    "Relief": "segmentation.relief",
    "relief_of": "segmentation.relief",
    "analyze": "analysis",
    "Analysis": "analysis",
    "silent": "progress",
    "Matching": "registration.matching",
    "matching_shape": "registration.matching",
    "Divisible": "registration.carried_labels",
    "FaceLabels": "registration.carried_labels",
    "divisible": "registration.carried_labels",
    "Reference": "registration.population",
    "label_matched": "registration.population",
    "match_divisible": "registration.population",
    "match_shape_diagrams": "registration.diagrams_matching",
    "prepare_reference": "registration.population",
    "with_parts": "registration.population",
    "match": "registration.matching",
    "Correspondence": "registration.correspondence",
    "correspond": "registration.correspondence",
    "fill_unsure": "registration.transfer",
    "majority_of_polygons": "registration.transfer",
    "mixed": "registration.transfer",
    "taken_over": "registration.transfer",
    "transfer_corners": "registration.transfer",
    "transfer_displacements": "registration.transfer",
    "Skeleton": "skeleton.embedding",
    "BoneLayout": "skeleton.layout",
    "LimbLayout": "skeleton.layout",
    "skeleton": "skeleton.embedding",
    "binding_weights": "skeleton.binding",
    "mirror_parts": "skeleton.symmetry",
    "sides": "skeleton.symmetry",
    "NOISE_THRESHOLD": "segmentation.hierarchy",
    "DEFAULT_THRESHOLD": "segmentation.hierarchy",
}


def is_complete() -> bool:
    """Whether the libraries of the engine are there; cheap enough for every redraw."""
    return "scipy" in sys.modules or find_spec("scipy") is not None


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(name)
    return getattr(import_module(f"..compute.{_HOME[name]}", __package__), name)
