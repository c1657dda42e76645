"""Short examples on the pages do what the text beside them says; docs/scripting.md is run as a whole elsewhere."""

import numpy as np
import pytest

from tests.docs.pages import ROOT, python_blocks
from tests.shapes import star


@pytest.fixture(scope="module")
def shape():
    """Five arms, one of which points up."""
    flat = star(n_arms=5, n_subdivisions=3)
    return flat.vertices[:, [1, 2, 0]], flat.triangles


def names_after(page, number, **given):
    names = dict(given)
    exec(python_blocks(ROOT / page)[number], names)
    return names


def test_the_readme_divides_a_star_into_its_arms_and_the_body(shape):
    vertices, triangles = shape
    labels = names_after("README.md", 0, vertices=vertices, triangles=triangles)["labels"]
    assert len(labels) == len(triangles)
    assert set(labels) == set(range(6))


def test_peaks_are_parts_of_the_height(shape):
    vertices, triangles = shape
    labels = names_after("docs/extending.md", 0)["parts_by_height"](vertices, triangles)
    touches_the_peak = (triangles == vertices[:, 2].argmax()).any(axis=1)
    assert np.unique(labels[touches_the_peak]).tolist() != [0]
    assert len(set(labels[touches_the_peak])) == 1
