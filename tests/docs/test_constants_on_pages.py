"""Numbers that the pages give for constants of the engine are those of the code."""

import re

import pytest

from compute.fem import assembly, eigensolver, elements_by_need, multilevel_eigenpairs, order_choice
from compute.fields import scalar_field, shell_fields
from compute.registration.dense import by_shape, confidence, deformation_graph, nonrigid_alignment, point_map, transfer
from compute.registration.eigenfunctions import confidence as map_confidence
from compute.registration.eigenfunctions import hypotheses, map_scoring, spectral_shape, zoomout
from compute.registration.parts import part_matching
from compute.segmentation.hierarchy import arc_measures, levels, necks, nesting
from compute.skeletons import bends, binding
from compute.surface import bridging
from tests.docs.pages import ROOT


def percent(share):
    return f"{100 * share:g} %"


def power(number):
    """Return 3e-6 for 3e-06."""
    return re.sub(r"e-0", "e-", f"{number:g}")


IN_WORDS = {4: "four", 1e-6: "a millionth"}
METHOD = {
    "slivers": f"Slivers count with {IN_WORDS[assembly.AREA_FLOOR]} of the mean",
    "functions of the field": f"up to {scalar_field.DIFFUSION_FUNCTIONS} functions",
    "default level": f"above {percent(levels.DEFAULT_THRESHOLD)} of the range",
    "blunt": f"< {nesting.BLUNT:g} ",
    "neck of the body": f"< {nesting.NECK:g} ",
    "joint": f"l / min(m, m') < {necks.NARROW:g},  l²/area < {necks.SLENDER:g} ",
    "samples": f"at {spectral_shape.N_SAMPLES} points",
    "sizes of the map": f"from {zoomout.MATCHING_SIZES[0]} to {zoomout.MATCHING_SIZES[-1]}",
    "tearing": f"({map_scoring.USUAL_TEARING:g} + τ)",
    "evidence": f"{map_confidence.CURVATURE_WEIGHT:g} min(ρ, {map_confidence.FULL_AGREEMENT:g})"
    f" - {map_confidence.COST_WEIGHT:g} ln max(cost",
    "tie": f"less than {map_confidence.TIE:g}",
    "doubtful cost": f"(1 + cost / {power(map_confidence.DOUBTFUL_COST)})",
    "least cost": f"max(cost, {power(map_scoring.LEAST_COST)})",
    "overlap": f"at least {part_matching.LEAST_OVERLAP:g}:",
    "followed": f"follows {IN_WORDS[deformation_graph.FOLLOWED]} of",
    "nodes": f"up to {by_shape.N_NODES} nodes",
    "rounds": f"each of {len(nonrigid_alignment.ROUNDS)} rounds",
    "sliding": f"{nonrigid_alignment.SLIDING:g}² |x' - y|²",
    "lost": f"{nonrigid_alignment.TURN:g}² |n' - n|²) / {nonrigid_alignment.LOST:g}²",
    "step": f"lengthened by {nonrigid_alignment.RELAXATION:g}",
    "gap": f"(gap / {confidence.DOUBTFUL_GAP:g})²",
    "stretch": f"ln {confidence.DOUBTFUL_STRETCH:g})⁴",
    "cost of a joint": f"{bends.BEND:g} · number of joints",
    "neck of a limb": f"thinner than {bends.NECK:g} of",
    "softness": f"limb: {binding.SOFTNESS:g} of its radius",
}
LOOSE_PARTS = {
    "detail": f"less than {percent(bridging.LEAST_SHARE)} of the area",
    "near": f"than {percent(bridging.TOUCHING)} of the root",
    "crumb": f"fewer than {shell_fields.LEAST_TRIANGLES} triangles",
    "lying": f"{percent(bridging.LYING_SHARE)} of its vertices nearer than {percent(bridging.LYING)} of the root",
}
TROUBLESHOOTING = {"islands": f"more than {transfer.MOST_ISLANDS} islands"}
DECISIONS = {
    "bridged_loose_parts": {name: LOOSE_PARTS[name] for name in ("detail", "near", "lying")},
    "cubic_elements": {
        "memory": f"below {order_choice.MEMORY_BUDGET / 1e9:g} GB",
        "unknown": f"({order_choice.BYTES_PER_UNKNOWN / 1000:g} kB an unknown)",
        "error of linear elements": f"eigenvalues is at most {elements_by_need.LARGEST_EXCESS:g}",
        "least vertices": f"from {elements_by_need.LEAST_VERTICES} vertices on",
    },
    "coarser_levels": {
        "unknowns": f"From {multilevel_eigenpairs.LEAST_UNKNOWNS:,} unknowns on",
        "pairs": f"up to {multilevel_eigenpairs.MOST_PAIRS} pairs",
    },
    "own_elimination_order": {"width": f"block Lanczos, {IN_WORDS[eigensolver.LEAST_WIDTH]} functions at a time"},
    "diffusion_field": {
        "functions": f"up to {scalar_field.DIFFUSION_FUNCTIONS} functions",
        "time": f"diffusion, time {scalar_field.DIFFUSION_TIME:g} (the present one)",
        "flat": f"range of {scalar_field.FLAT_DIFFUSION:g} it counts as flat",
    },
    "default_level": {
        "threshold": f"above {percent(levels.DEFAULT_THRESHOLD)} of the range",
        "noise": f"Below {percent(levels.NOISE_THRESHOLD)} they are noise",
        "blunt": f"is below {nesting.BLUNT:g}, its tip left out",
    },
    "nested_in_blender": {
        "neck": f"of the two sides, below {nesting.NECK:g}",
        "height": f"span {percent(arc_measures.LEAST_HEIGHT)} of the range",
        "area": f"have {percent(nesting.LEAST_AREA)} of the area",
    },
    "matching_by_moments": {"growth": f"grow to {hypotheses.Effort().levels[-1]} first"},
    "bent_surfaces": {
        "nodes": f"up to {by_shape.N_NODES} nodes",
        "rounds": f"in {len(nonrigid_alignment.ROUNDS)} rounds",
        "functions": f"refined to {point_map.DENSE_SIZES[-1]} functions",
    },
}
PAGES = {
    "docs/method.md": METHOD,
    "docs/guide/loose_parts.md": LOOSE_PARTS,
    "docs/guide/troubleshooting.md": TROUBLESHOOTING,
    **{f"docs/decisions/{name}.md": told for name, told in DECISIONS.items()},
}


@pytest.mark.parametrize(
    ("page", "told"),
    [pytest.param(page, told, id=name) for page, numbers in PAGES.items() for name, told in numbers.items()],
)
def test_the_page_has_the_constant_of_the_code(page, told):
    text = re.sub(r"(?<=\S)\n *(?=\S)", " ", (ROOT / page).read_text())
    assert told in text
