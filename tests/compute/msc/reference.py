"""The paper's own loop for persistence pairs, word for word and slow (Reuter 2009, sections 4.2 and 4.3)."""

from collections import defaultdict

import numpy as np


def pairs_of_the_paper(triangles: np.ndarray, values: np.ndarray) -> set[tuple[int, int]]:
    """Return (extremum, saddle) pairs by cancelling the shortest path of the Morse-Smale graph again and again.

    A saddle of higher multiplicity counts as several simple ones, so a pair takes away one path of it at a time.
    """
    paths = morse_smale_graph(triangles, values)
    pairs = set()
    while paths:
        saddle, extremum, is_up = min(paths, key=lambda path: abs(values[path[0]] - values[path[1]]))
        others = [end for start, end, up in paths if (start, up) == (saddle, is_up) and end != extremum]
        paths.remove((saddle, extremum, is_up))
        if not others:
            paths = [path for path in paths if path != (saddle, extremum, is_up)]
        else:
            pairs.add((extremum, saddle))
            paths = [path for path in paths if path != (saddle, extremum, is_up)]
            paths = [(start, others[0] if end == extremum else end, up) for start, end, up in paths]
    return pairs


def morse_smale_graph(triangles: np.ndarray, values: np.ndarray) -> list[tuple[int, int, bool]]:
    """Return (saddle, extremum, whether it is a maximum) for every steepest path from every saddle."""
    link = defaultdict(list)
    for a, b, c in triangles.tolist():
        for vertex, edge in ((a, (b, c)), (b, (c, a)), (c, (a, b))):
            link[vertex].append(edge)
    paths = []
    for is_up in (False, True):
        height = {vertex: (-value, -vertex) if is_up else (value, vertex) for vertex, value in enumerate(values)}
        for vertex in link:
            sectors = components(link[vertex], {w for edge in link[vertex] for w in edge if height[w] < height[vertex]})
            if len(sectors) > 1:
                paths += [(vertex, descend(min(s, key=height.get), link, height), is_up) for s in sectors]
    return paths


def components(edges: list[tuple[int, int]], vertices: set[int]) -> list[set[int]]:
    found = [{vertex} for vertex in vertices]
    for a, b in edges:
        if a in vertices and b in vertices:
            first, second = (next(s for s in found if v in s) for v in (a, b))
            if first is not second:
                found.remove(second)
                first |= second
    return found


def descend(vertex: int, link: dict, height: dict) -> int:
    lowest = min((w for edge in link[vertex] for w in edge), key=height.get)
    return descend(lowest, link, height) if height[lowest] < height[vertex] else vertex
