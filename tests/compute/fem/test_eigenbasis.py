"""The eigenfunctions against closed forms."""

import numpy as np
import pytest
import scipy.linalg
from scipy.sparse.linalg import eigsh

from compute.errors import Cancelled, EngineError
from compute.fem import shift_invert
from compute.fem.assembly import mass_matrix, stiffness_matrix
from compute.fem.eigenbasis import solve_eigenbasis, solve_on_surface
from compute.fem.space import function_space
from compute.surface.cleaning import clean_surface
from compute.surface.mesh import TriangleMesh
from tests.shapes import icosphere, joined, rectangle, tetrahedron

orders = pytest.mark.parametrize("order", [1, 2, 3])


@pytest.mark.parametrize(("order", "rate"), [(1, 2), (2, 4), (3, 6)])
def test_eigenvalues_converge_at_twice_the_order_on_a_tetrahedron(order, rate):
    """The tetrahedron with edge 1 has the eigenvalue 4 pi^2 / 3 three times."""
    coarse, fine = (solve_eigenbasis(tetrahedron(n), 3, order=order).values.mean() for n in (2, 3))
    exact = 4 * np.pi**2 / 3
    assert np.log2((coarse - exact) / (fine - exact)) == pytest.approx(rate, abs=0.1)


def test_tetrahedron_has_its_closed_form_with_all_multiplicities():
    """One eigenvalue 4 pi^2 / 3 (m^2 + mn + n^2) for each pair ±(m, n): up to sixfold here."""
    norms = sorted(m * m + m * n + n * n for m in range(-6, 7) for n in range(-6, 7))[1::2]
    for n_functions in (6, 10, 24):
        values = solve_eigenbasis(tetrahedron(5), n_functions).values
        np.testing.assert_allclose(values, 4 * np.pi**2 / 3 * np.array(norms[:n_functions]), rtol=1e-7)


@pytest.mark.parametrize(("order", "rate"), [(1, 2), (2, 3), (3, 4)])
def test_eigenfunctions_converge_one_order_above_their_degree(order, rate):
    coarse, fine = (_distance_to_exact_eigenspace(n, order) for n in (2, 3))
    assert np.log2(coarse / fine) == pytest.approx(rate, abs=0.25)


def _distance_to_exact_eigenspace(n_subdivisions, order):
    """Return the largest L2 distance of the first three functions from the exact ones, by quadrature of degree 11.

    Unfolded, the tetrahedron's corners are the half periods of a lattice, and its functions are waves on it.
    """
    mesh = tetrahedron(n_subdivisions)
    basis = solve_eigenbasis(mesh, 3, order=order)
    points, weights = _triangle_quadrature(8)
    element = function_space(mesh, order).element
    values = np.einsum("pl,tlk->tpk", element.evaluate(points), basis.functions[basis.elements])
    corners = np.stack([1 - points.sum(axis=1), *points.T], axis=1) @ mesh.vertices[mesh.triangles]
    unfolded = [
        [(0, 0), (1, 0), (0, 1)],
        [(0, 0), (1, -1), (1, 0)],
        [(0, 0), (0, 1), (-1, 1)],
        [(1, 0), (1, 1), (0, 1)],
    ]
    faces = tetrahedron().vertices[tetrahedron().triangles]
    plane = np.stack([corners[f::4] @ np.linalg.inv(faces[f]) @ np.array(unfolded[f]) for f in range(4)], axis=1)
    waves = np.cos(np.pi * plane @ np.array([[1, 0], [0, 1], [1, 1]]).T).reshape(*values.shape)
    scale = np.sqrt(2 * mesh.areas[:, None] * weights)[:, :, None]
    exact = np.linalg.qr((waves * scale).reshape(-1, 3))[0]
    ours = (values * scale).reshape(-1, 3)
    return np.linalg.norm(ours - exact @ (exact.T @ ours), axis=0).max()


def _triangle_quadrature(n):
    """Return points and weights of a Gauss rule that is folded from the square onto the reference triangle."""
    nodes, weights = np.polynomial.legendre.leggauss(n)
    s, t = np.meshgrid((nodes + 1) / 2, (nodes + 1) / 2, indexing="ij")
    return np.stack([s, t * (1 - s)], axis=-1).reshape(-1, 2), (np.outer(weights, weights) / 4 * (1 - s)).ravel()


@pytest.mark.parametrize(("boundary", "exact"), [("neumann", [1, 4, 4, 5, 8]), ("dirichlet", [5, 8, 13, 17, 20])])
def test_rectangle_has_its_products_of_waves(boundary, exact):
    """A 2 x 1 rectangle has eigenvalues pi^2 / 4 (m^2 + 4 n^2)."""
    basis = solve_eigenbasis(rectangle(20, 10), 5, boundary=boundary)
    np.testing.assert_allclose(basis.values, np.pi**2 / 4 * np.array(exact), rtol=1e-5)


@orders
def test_dirichlet_functions_vanish_on_the_boundary(order):
    basis = solve_eigenbasis(rectangle(8, 4), 4, order=order, boundary="dirichlet")
    x, y, _ = basis.nodes.T
    on_rim = np.isclose(x, 0) | np.isclose(x, 2) | np.isclose(y, 0) | np.isclose(y, 1)
    np.testing.assert_array_equal(basis.functions[on_rim], 0)


@pytest.mark.parametrize("n_functions", [8, 10, 15, 24])
@pytest.mark.parametrize("n_subdivisions", [2, 3, 4])
def test_sphere_has_multiplicities_3_5_7_9(n_subdivisions, n_functions):
    """Icospheres keep multiplicities 3 and 5 exactly, the hardest case for an iteration on few functions at a time."""
    values = solve_eigenbasis(icosphere(n_subdivisions), n_functions).values
    np.testing.assert_allclose(values, ([2] * 3 + [6] * 5 + [12] * 7 + [20] * 9)[:n_functions], rtol=0.03)
    np.testing.assert_allclose(values[:3], values[0], rtol=1e-9)
    np.testing.assert_allclose(values[3:8], values[3], rtol=1e-9)


def test_ellipsoid_crosses_where_the_paper_says():
    """Stretched along z, the value of Y20 falls below that of Y1±1 at rz = 2.757 (Fig. 2)."""
    at = np.array([2.74, 2.78])
    below, above = (_y20_minus_y11(rz) for rz in at)
    assert at[0] + below / (below - above) * (at[1] - at[0]) == pytest.approx(2.757, abs=0.01)


def _y20_minus_y11(rz):
    sphere = icosphere(4)
    basis = solve_eigenbasis(TriangleMesh(sphere.vertices * [1, 1, rz], sphere.triangles), 4)
    sideways = np.linalg.norm(basis.nodes[:, :2].T @ basis.mass @ basis.functions, axis=0)
    is_y11 = sideways > 0.1 * sideways.max()
    is_y20 = ~is_y11 & (np.arange(4) > 0)
    assert is_y11.sum() == 2
    return basis.values[is_y20].min() - basis.values[is_y11].mean()


@pytest.mark.parametrize(("n_subdivisions", "order"), [(1, 3), (2, 1), (2, 2), (2, 3), (3, 1)])
def test_small_meshes_agree_with_full_matrices(n_subdivisions, order):
    mesh = _bumpy(icosphere(n_subdivisions))
    space = function_space(mesh, order)
    matrices = (matrix(space).toarray() for matrix in (stiffness_matrix, mass_matrix))
    exact = scipy.linalg.eigh(*matrices, eigvals_only=True, subset_by_index=[1, 15])
    np.testing.assert_allclose(solve_eigenbasis(mesh, 15, order=order).values * mesh.areas.sum(), exact, rtol=1e-10)


@pytest.mark.parametrize("order", [2, 3])
def test_block_iteration_agrees_with_arpack(order):
    mesh = _bumpy(icosphere(3 if order == 3 else 4))
    space = function_space(mesh, order)
    start = np.random.default_rng(3).standard_normal(space.n_unknowns)
    expected = eigsh(stiffness_matrix(space), 21, mass_matrix(space), sigma=-4, v0=start, return_eigenvectors=False)
    values = solve_eigenbasis(mesh, 20, order=order).values * mesh.areas.sum()
    np.testing.assert_allclose(values, np.sort(expected)[1:], rtol=1e-9)


@pytest.mark.parametrize(("n_subdivisions", "order"), [(2, 1), (2, 2), (2, 3), (3, 3)])
def test_functions_are_orthonormal_eigenfunctions(n_subdivisions, order):
    mesh = _bumpy(icosphere(n_subdivisions))
    basis = solve_eigenbasis(mesh, 8, order=order)
    np.testing.assert_allclose(basis.functions.T @ basis.mass @ basis.functions, np.eye(8), atol=1e-9)
    stiff = stiffness_matrix(function_space(mesh, order)) @ basis.functions
    residuals = stiff - basis.mass @ basis.functions * basis.values
    assert np.abs(residuals).max() < 1e-5 * np.abs(stiff).max()


def _bumpy(mesh):
    x, y, z = mesh.vertices.T
    radius = 1 + 0.3 * np.sin(3 * x + y) * np.cos(2 * y + 1) + 0.2 * z**3
    return TriangleMesh(mesh.vertices * radius[:, None], mesh.triangles)


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_values_scale_with_the_inverse_square_of_the_length(scale):
    mesh = _bumpy(icosphere(3))
    scaled = solve_eigenbasis(TriangleMesh(mesh.vertices * scale, mesh.triangles), 8)
    plain = solve_eigenbasis(mesh, 8)
    np.testing.assert_allclose(scaled.values * scale**2, plain.values, rtol=1e-9)
    np.testing.assert_allclose(scaled.functions * scale, plain.functions, atol=1e-4)


def test_nothing_depends_on_place_and_vertex_order():
    mesh = _bumpy(icosphere(3))
    random = np.random.default_rng(5)
    order = random.permutation(len(mesh.vertices))
    turned = mesh.vertices @ np.linalg.qr(random.standard_normal((3, 3)))[0] + [10, 20, 30]
    moved = TriangleMesh(turned[order], np.argsort(order)[mesh.triangles])
    plain, other = solve_eigenbasis(mesh, 8), solve_eigenbasis(moved, 8)
    np.testing.assert_allclose(other.values, plain.values, rtol=1e-9)
    np.testing.assert_allclose(other.functions[: len(order)], plain.functions[: len(order)][order], atol=1e-4)


def test_the_basis_of_an_eigenspace_does_not_depend_on_the_numbering():
    mesh = icosphere(3)
    order = np.random.default_rng(6).permutation(len(mesh.vertices))
    shuffled = TriangleMesh(mesh.vertices[order], np.argsort(order)[mesh.triangles])
    plain, other = (solve_eigenbasis(m, 8).functions[: len(order)] for m in (mesh, shuffled))
    np.testing.assert_allclose(other, plain[order], atol=1e-5)


def test_two_runs_agree_to_the_last_bit():
    first, second = (solve_eigenbasis(icosphere(3), 8) for _ in range(2))
    np.testing.assert_array_equal(first.functions, second.functions)


def test_other_components_and_unused_vertices_have_zero_and_no_mass():
    small = TriangleMesh(tetrahedron(1).vertices + 9, tetrahedron(1).triangles)
    mesh = joined(icosphere(2), small)
    n_ball = len(icosphere(2).vertices)
    mesh = TriangleMesh(np.vstack([mesh.vertices, [[np.nan] * 3]]), mesh.triangles)
    basis = solve_eigenbasis(mesh, 6)
    np.testing.assert_array_equal(basis.functions[n_ball : len(mesh.vertices)], 0)
    np.testing.assert_array_equal(basis.mass.sum(axis=1)[n_ball : len(mesh.vertices)], 0)
    np.testing.assert_allclose(basis.values, solve_eigenbasis(icosphere(2), 6).values, rtol=1e-9)


@pytest.mark.parametrize("n_subdivisions", [2, 3])
def test_flipped_faces_change_nothing(n_subdivisions):
    mesh = _bumpy(icosphere(n_subdivisions))
    triangles = mesh.triangles.copy()
    triangles[::3] = triangles[::3, ::-1]
    flipped = solve_eigenbasis(TriangleMesh(mesh.vertices, triangles), 6)
    np.testing.assert_allclose(flipped.values, solve_eigenbasis(mesh, 6).values, rtol=1e-9)


@pytest.mark.parametrize("n_subdivisions", [2, 3])
def test_slivers_change_little(n_subdivisions):
    """Vertices pulled onto a neighbour leave triangles without area; the surface is nearly the same."""
    mesh = _bumpy(icosphere(n_subdivisions))
    vertices = mesh.vertices.copy()
    ends = mesh.edges.vertices[:: len(mesh.edges.vertices) // 12]
    vertices[ends[:, 0]] = vertices[ends[:, 1]]
    pulled = solve_eigenbasis(TriangleMesh(vertices, mesh.triangles), 6)
    np.testing.assert_allclose(pulled.values, solve_eigenbasis(mesh, 6).values, rtol=0.1 / 2**n_subdivisions + 0.02)


def test_a_third_sheet_on_an_edge_is_solved():
    """Three half discs on one line: functions that are odd under exchanging two sheets vanish on the line."""
    half = rectangle(12, 12, width=1.0, height=1.0)
    angle = 2 * np.pi / 3
    x, y, _ = half.vertices.T
    sheets = [np.stack([x * np.cos(k * angle), y, x * np.sin(k * angle)], axis=1) for k in range(3)]
    _, place = np.unique(np.vstack(sheets).round(9) + 0.0, axis=0, return_inverse=True)
    vertices = np.empty((place.max() + 1, 3))
    vertices[place.ravel()] = np.vstack(sheets)
    triangles = np.vstack([half.triangles + k * len(x) for k in range(3)])
    values = solve_eigenbasis(TriangleMesh(vertices, place.ravel()[triangles]), 2).values
    np.testing.assert_allclose(values, np.pi**2 / 4, rtol=1e-5)


def test_functions_far_above_the_first_are_left_out():
    mesh = _bumpy(icosphere(3))
    ellipsoid = TriangleMesh(mesh.vertices * [1, 1, 4], mesh.triangles)
    everything = solve_eigenbasis(ellipsoid, 30).values
    few = solve_on_surface(clean_surface(ellipsoid), 30, largest_ratio=10.0).values
    assert 1 < len(few) < 30
    np.testing.assert_allclose(few, everything[everything <= 10 * everything[0]], rtol=1e-9)


@orders
def test_pairs_that_are_computed_in_turns_are_those_that_are_computed_at_once(order):
    """A tetrahedron has eigenvalues that are threefold and sixfold, which a turn may cut in two."""
    mesh = tetrahedron(4)
    everything = solve_eigenbasis(mesh, 40, order=order)
    few = solve_on_surface(clean_surface(mesh), 40, order=order, largest_ratio=14.0)
    n_few = len(few.values)
    assert shift_invert.FIRST_PAIRS < n_few < 40
    np.testing.assert_allclose(few.values, everything.values[:n_few], rtol=1e-9)
    np.testing.assert_allclose(few.functions.T @ few.mass @ few.functions, np.eye(n_few), atol=1e-9)


@orders
def test_functions_that_nobody_uses_are_not_computed(monkeypatch, order):
    """A long body has few functions within the ratio, and one turn of linear pairs is enough for them."""
    asked, solve = [], shift_invert.eigsh
    monkeypatch.setattr(shift_invert, "eigsh", lambda *a, **options: asked.append(a[1]) or solve(*a, **options))
    mesh = _bumpy(icosphere(4))
    long = clean_surface(TriangleMesh(mesh.vertices * [1, 1, 6], mesh.triangles))
    few = solve_on_surface(long, 30, order=order, largest_ratio=10.0)
    assert len(few.values) < 8
    assert asked == [shift_invert.FIRST_PAIRS]


def test_how_many_more_pairs_are_wanted_follows_from_those_that_are_known():
    wanted = shift_invert.WantedPairs(31, n_constant=1, largest_ratio=10.0)
    assert wanted.n_missing(np.zeros(0)) == shift_invert.FIRST_PAIRS
    assert wanted.n_missing(np.array([0.0, 1.0, 9.0, 10.1])) == 0
    # Three pairs up to 5 promise six up to 10, and one more shows that there are no others.
    assert wanted.n_missing(np.array([0.0, 1.0, 5.0])) == 4
    # The promise is never more than what is wanted at the most, whatever the values are.
    for values in ([0.0, 0.0, 0.0], [-1e-17, -1e-18, 0.0], [0.0, 1.0, 1.0]):
        assert wanted.n_missing(np.array(values)) <= 28
    assert shift_invert.WantedPairs(31).n_missing(np.array([1.0, 2.0])) == 29


def test_progress_never_falls_and_ends_at_one():
    fractions = []
    solve_eigenbasis(icosphere(3), 8, progress=lambda fraction, text: fractions.append(fraction))
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1.0
    assert len(fractions) > 10


def test_a_callback_stops_the_work():
    def stop_at_half(fraction, text):
        if fraction > 0.5:
            raise Cancelled

    with pytest.raises(Cancelled):
        solve_eigenbasis(icosphere(3), 8, progress=stop_at_half)


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"order": 4}, "order 4"),
        ({"boundary": "robin"}, "robin"),
        ({"boundary": "dirichlet"}, "closed"),
        ({"n_functions": 10_000}, "carries only"),
        ({"n_functions": 0}, "at least one"),
        ({"component": 7}, "does not exist"),
    ],
)
def test_impossible_questions_are_refused_with_a_sentence(options, sentence):
    with pytest.raises(EngineError, match=sentence):
        solve_eigenbasis(tetrahedron(2), **options)


def test_a_single_triangle_is_refused_with_a_sentence():
    with pytest.raises(EngineError, match="single triangle"):
        solve_eigenbasis(TriangleMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))
