"""The names of the engine that are loaded when they are first asked for; ``__init__.py`` reads where they live here."""

# The scripting API.
from .analysis.analysis import Analysis as Analysis
from .analysis.analyze import analyze as analyze
from .analysis.readings import reeb_graph as reeb_graph
from .analysis.readings import zero_level as zero_level
from .choices import BORDERS as BORDERS
from .choices import BOUNDARIES as BOUNDARIES
from .choices import FIELDS as FIELDS
from .choices import JOINTED as JOINTED
from .choices import METHODS as METHODS
from .choices import MODES as MODES
from .choices import NESTED as NESTED
from .choices import ORDERS as ORDERS
from .choices import READINGS as READINGS
from .choices import SHELLS as SHELLS
from .errors import Cancelled as Cancelled
from .errors import EngineError as EngineError
from .errors import FieldError as FieldError
from .errors import LevelError as LevelError
from .errors import MeshError as MeshError
from .errors import RegistrationError as RegistrationError
from .errors import SpectrumError as SpectrumError
from .fem.eigenbasis import Eigenbasis as Eigenbasis
from .fem.eigenbasis import solve_eigenbasis as solve_eigenbasis
from .msc.diagram import PersistenceDiagram as PersistenceDiagram
from .msc.diagram import persistence_curve as persistence_curve
from .msc.diagram import size_function as size_function
from .msc.diagram_distance import diagram_distance as diagram_distance
from .msc.morse_smale import MorseSmaleComplex as MorseSmaleComplex
from .msc.reeb import ReebGraph as ReebGraph

# What the extension asks for beside it.
from .progress import Progress as Progress
from .progress import naming as naming
from .progress import section as section
from .progress import silent as silent
from .registration.dense.by_place import lie_together as lie_together
from .registration.dense.correspondence import Correspondence as Correspondence
from .registration.dense.correspondence import correspond as correspond
from .registration.dense.correspondence import correspond_by_place as correspond_by_place
from .registration.dense.transfer import fill_unsure as fill_unsure
from .registration.dense.transfer import majority_of_polygons as majority_of_polygons
from .registration.dense.transfer import mixed as mixed
from .registration.dense.transfer import taken_over as taken_over
from .registration.dense.transfer import transfer_corners as transfer_corners
from .registration.dense.transfer import transfer_displacements as transfer_displacements
from .registration.eigenfunctions.given_points import point_warnings as point_warnings
from .registration.eigenfunctions.matching import Matching as Matching
from .registration.eigenfunctions.matching import match as match
from .registration.eigenfunctions.matching import matching_shape as matching_shape
from .registration.paper.diagram_matching import match_shape_diagrams as match_shape_diagrams
from .registration.parts.population import CONTRADICTS as CONTRADICTS
from .registration.parts.population import Reference as Reference
from .registration.parts.population import agreed_matchings as agreed_matchings
from .registration.parts.population import label_mapped as label_mapped
from .registration.parts.population import map_to_reference as map_to_reference
from .registration.parts.population import match_divisible as match_divisible
from .registration.parts.population import match_members as match_members
from .registration.parts.population import prepare_reference as prepare_reference
from .registration.parts.population import register as register
from .registration.parts.population import with_parts as with_parts
from .registration.parts.transferred_labels import Divisible as Divisible
from .registration.parts.transferred_labels import FaceLabels as FaceLabels
from .registration.parts.transferred_labels import divisible as divisible
from .segmentation.borders.edge_borders import shortened_borders as shortened_borders
from .segmentation.borders.edge_profile import EdgeProfile as EdgeProfile
from .segmentation.borders.edge_profile import vertex_heights as vertex_heights
from .segmentation.borders.level_set_borders import Crossings as Crossings
from .segmentation.borders.level_set_borders import cross_edges as cross_edges
from .segmentation.edits.corrections import CORRECTION_KINDS as CORRECTION_KINDS
from .segmentation.edits.corrections import LEVEL as LEVEL
from .segmentation.edits.corrections import MERGE as MERGE
from .segmentation.edits.corrections import MOVE as MOVE
from .segmentation.edits.corrections import PAINT as PAINT
from .segmentation.edits.corrections import SPLIT as SPLIT
from .segmentation.edits.corrections import Correction as Correction
from .segmentation.edits.corrections import Corrections as Corrections
from .segmentation.edits.part_tracking import carried as carried
from .segmentation.edits.part_tracking import carried_painting as carried_painting
from .segmentation.edits.part_tracking import renumbered as renumbered
from .segmentation.edits.part_tracking import tracked_parts as tracked_parts
from .segmentation.edits.part_tracking import tracked_pieces as tracked_pieces
from .segmentation.edits.redrawing import Drawn as Drawn
from .segmentation.edits.redrawing import corrected_crossings as corrected_crossings
from .segmentation.edits.redrawing import drawn_borders as drawn_borders
from .segmentation.edits.redrawing import hill_of as hill_of
from .segmentation.edits.redrawing import joined_parts as joined_parts
from .segmentation.edits.redrawing import needs_faces as needs_faces
from .segmentation.edits.redrawing import redraw as redraw
from .segmentation.edits.redrawing import undivided as undivided
from .segmentation.edits.relief import Hill as Hill
from .segmentation.edits.relief import Relief as Relief
from .segmentation.edits.relief import relief_of as relief_of
from .segmentation.faces.branches import Branches as Branches
from .segmentation.faces.branches import connected_branches as connected_branches
from .segmentation.faces.exact_labels import exact_labels as exact_labels
from .segmentation.faces.face_graph import FaceGraph as FaceGraph
from .segmentation.faces.face_graph import face_graph as face_graph
from .segmentation.faces.part_tree import PartTree as PartTree
from .segmentation.hierarchy.arc_measures import ArcMeasures as ArcMeasures
from .segmentation.hierarchy.arc_tree import ALWAYS as ALWAYS
from .segmentation.hierarchy.arc_tree import NEVER as NEVER
from .segmentation.hierarchy.arc_tree import NO_SADDLE as NO_SADDLE
from .segmentation.hierarchy.arc_tree import ArcTree as ArcTree
from .segmentation.hierarchy.arc_tree import without_necks as without_necks
from .segmentation.hierarchy.levels import DEFAULT_THRESHOLD as DEFAULT_THRESHOLD
from .segmentation.hierarchy.levels import NOISE_THRESHOLD as NOISE_THRESHOLD
from .segmentation.hierarchy.levels import Hierarchy as Hierarchy
from .segmentation.hierarchy.nesting import first_own_part as first_own_part
from .segmentation.hierarchy.nesting import number_behind as number_behind
from .segmentation.parts.colour_places import VisibleParts as VisibleParts
from .segmentation.parts.colour_places import colour_places as colour_places
from .segmentation.parts.colour_places import places_at_all_levels as places_at_all_levels
from .segmentation.parts.colour_places import visible_parts as visible_parts
from .segmentation.parts.function_hints import FunctionHint as FunctionHint
from .segmentation.parts.function_hints import judge_eigenfunctions as judge_eigenfunctions
from .segmentation.parts.part_labels import BranchLabels as BranchLabels
from .segmentation.parts.part_labels import Parts as Parts
from .segmentation.parts.part_labels import Segmentation as Segmentation
from .segmentation.parts.part_labels import label_branches as label_branches
from .segmentation.parts.part_labels import mode_of as mode_of
from .segmentation.parts.part_labels import reading_of as reading_of
from .skeletons.binding import binding_weights as binding_weights
from .skeletons.embedding import Skeleton as Skeleton
from .skeletons.embedding import skeleton as skeleton
from .skeletons.layout import BoneLayout as BoneLayout
from .skeletons.layout import LimbLayout as LimbLayout
from .skeletons.symmetry import mirror_parts as mirror_parts
from .skeletons.symmetry import sides as sides
from .surface.cleaning import Surface as Surface
from .surface.cleaning import analyzed_surface as analyzed_surface
from .surface.cleaning import welded_vertices as welded_vertices
from .surface.heat_smoothing import softened_labels as softened_labels
from .surface.mesh import TriangleMesh as TriangleMesh

__all__ = [
    "Analysis",
    "Cancelled",
    "Correspondence",
    "Eigenbasis",
    "EngineError",
    "FieldError",
    "LevelError",
    "Matching",
    "MeshError",
    "MorseSmaleComplex",
    "PersistenceDiagram",
    "ReebGraph",
    "RegistrationError",
    "Segmentation",
    "Skeleton",
    "SpectrumError",
    "TriangleMesh",
    "analyze",
    "binding_weights",
    "correspond",
    "correspond_by_place",
    "diagram_distance",
    "match",
    "mirror_parts",
    "persistence_curve",
    "reeb_graph",
    "register",
    "size_function",
    "skeleton",
    "solve_eigenbasis",
    "zero_level",
]
