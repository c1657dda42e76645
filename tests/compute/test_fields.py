import numpy as np
import pytest

from compute import FieldError, analyze, skeleton, solve_eigenbasis
from compute.fields.scalar_field import diffusion_field, eigenfunction_field, refined_net
from tests.shapes import icosphere, rectangle, star


@pytest.mark.parametrize(("order", "n_cells"), [(1, 1), (2, 4), (3, 9)])
def test_the_net_runs_through_the_nodes_and_keeps_area_and_winding(order, n_cells):
    basis = solve_eigenbasis(rectangle(4, 2), 3, order=order)
    net = refined_net(basis)
    assert len(net.triangles) == 16 * n_cells
    a, b, c = net.positions[net.triangles].swapaxes(0, 1)
    normals = np.cross(b - a, c - a)
    assert (normals[:, 2] > 0).all()
    np.testing.assert_allclose(normals[:, 2] / 2, net.areas, rtol=1e-12)


def test_an_eigenfunction_on_its_net_is_the_cosine():
    field = eigenfunction_field(solve_eigenbasis(rectangle(8, 4), 1), 1)
    exact = np.cos(np.pi * field.net.positions[:, 0] / 2)
    np.testing.assert_allclose(np.abs(field.values), np.abs(exact), atol=2e-4)


def test_diffusion_is_flat_on_a_sphere():
    field = diffusion_field(solve_eigenbasis(icosphere(3), 30))
    assert field.value_range < field.least_range


@pytest.mark.parametrize("scale", [1e-5, 1e5])
def test_diffusion_has_no_unit(scale):
    mesh = star()
    small = type(mesh)(mesh.vertices * scale, mesh.triangles)
    fields = [diffusion_field(solve_eigenbasis(shape, 20)) for shape in (mesh, small)]
    np.testing.assert_allclose(fields[0].values, fields[1].values, atol=1e-6)


def test_diffusion_ends_with_a_whole_eigenspace():
    """Three functions more or less of an eigenspace of the sphere would break its symmetry."""
    basis = solve_eigenbasis(icosphere(3), 10)
    assert diffusion_field(basis).value_range < 0.05


def test_the_users_own_field_is_taken_on_the_mesh_itself():
    mesh = star()
    analysis = analyze(mesh, field=mesh.vertices[:, 0])
    assert analysis.net.triangles is analysis.surface.mesh.triangles
    np.testing.assert_array_equal(analysis.field.values, mesh.vertices[:, 0])


@pytest.mark.parametrize(
    ("field", "sentence"),
    [
        ("heat", '"heat" does not exist'),
        (0, "Eigenfunction 0 does not exist"),
        (np.zeros(3), "one value for each"),
        (np.full(2562, np.nan), "not finite"),
    ],
)
def test_refuses_a_field_that_is_none(field, sentence):
    with pytest.raises(FieldError, match=sentence):
        analyze(star(), field=field)


@pytest.mark.parametrize("scale", [1e300, 1e-310])
def test_values_without_powers_are_refused(scale):
    mesh = star(n_arms=3, n_subdivisions=1)
    with pytest.raises(FieldError, match="too much or too little to be computed with; scale them"):
        analyze(mesh, field=scale * mesh.vertices[:, 0])


@pytest.mark.parametrize("scale", [1e55, 1e-55])
def test_the_unit_of_a_field_does_not_matter(scale):
    mesh = star(n_arms=3, n_subdivisions=2)
    heights = np.linalg.norm(mesh.vertices, axis=1)
    small, usual = (skeleton(analyze(mesh, field=unit * heights)) for unit in (scale, 1.0))
    np.testing.assert_allclose(small.joints, usual.joints, atol=1e-6)
