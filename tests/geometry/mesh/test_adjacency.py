"""What touches what on surfaces small enough to be counted by hand."""

import numpy as np

from engine.geometry.mesh.adjacency import edge_table, edges, neighbours, open_edges, unique_edges

TETRAHEDRON = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], np.int32)
STRIP = np.array([[0, 1, 2], [1, 3, 2]], np.int32)


def test_every_vertex_of_a_tetrahedron_is_beside_every_other() -> None:
    np.testing.assert_array_equal(neighbours(TETRAHEDRON, 4).toarray(), 1 - np.eye(4))


def test_vertices_without_an_edge_between_them_are_no_neighbours() -> None:
    """Two triangles with a common edge: the tips, 0 and 3, do not touch; vertex 4 belongs to none."""
    found = neighbours(STRIP, 5).toarray()
    np.testing.assert_array_equal(found, found.T)
    assert found[0].tolist() == [0, 1, 1, 0, 0] and found[4].sum() == 0


def test_edges_are_there_once() -> None:
    assert edges(STRIP).tolist() == [[0, 1], [0, 2], [1, 2], [1, 3], [2, 3]]
    assert len(edges(TETRAHEDRON)) == 6


def test_a_tetrahedron_has_six_edges_and_a_square_a_border() -> None:
    table = edge_table(TETRAHEDRON, np.arange(4, dtype=np.int32))
    assert sorted(tuple(sorted(edge)) for edge in table[:, :2].tolist()) == [
        (a, b) for a in range(4) for b in range(a + 1, 4)
    ]
    for a, b, one, other in table:
        assert one != other and {a, b} <= set(TETRAHEDRON[one]) & set(TETRAHEDRON[other])
    # the square's diagonal has two vertices at one end, which are one point
    square = edge_table(np.array([[0, 1, 2], [0, 4, 3]], np.int32), np.array([0, 1, 2, 3, 2], np.int32))
    assert (square[:, 3] < 0).sum() == 4 and len(square) == 5


def test_pairs_find_their_edge_whichever_way_they_run() -> None:
    pairs = np.array([[5, 2], [0, 1], [2, 5], [1, 0], [5, 5]], np.int32)
    found, which = unique_edges(pairs)
    assert found.tolist() == [[0, 1], [2, 5], [5, 5]] and which.tolist() == [1, 0, 1, 0, 2]
    nothing = unique_edges(np.zeros((0, 2), np.int32))
    assert nothing[0].shape == (0, 2) and nothing[1].shape == (0,)


def test_a_square_is_open_at_its_four_sides_which_run_as_its_triangles_turn() -> None:
    assert sorted(open_edges(STRIP).tolist()) == [[0, 1], [1, 3], [2, 0], [3, 2]]
    assert len(open_edges(TETRAHEDRON)) == 0
