"""The definitions of levels and parts, word for word and slowly, for small nets."""

import numpy as np


class Net:
    """A net as sets of neighbours, with a strict order of its vertices."""

    def __init__(self, triangles, rank):
        self.rank = rank
        self.vertices = set(triangles.ravel().tolist())
        self.neighbours = {v: set() for v in self.vertices}
        for a, b, c in triangles.tolist():
            self.neighbours[a] |= {b, c}
            self.neighbours[b] |= {a, c}
            self.neighbours[c] |= {a, b}

    def component_above(self, start, rank):
        """Return the vertices of the component of {rank > given} that holds a vertex."""
        found, todo = {start}, [start]
        while todo:
            for v in self.neighbours[todo.pop()]:
                if self.rank[v] > rank and v not in found:
                    found.add(v)
                    todo.append(v)
        return found


def maximum_pairs(net):
    """Return {maximum: saddle} by adding vertices from the top; the lower maximum ends."""
    oldest, pairs = {}, {}

    def find(v):
        while oldest[v] != v:
            v = oldest[v]
        return v

    for v in sorted(net.vertices, key=lambda v: -net.rank[v]):
        oldest[v] = v
        roots = sorted({find(w) for w in net.neighbours[v] if w in oldest and w != v} - {v}, key=lambda r: -net.rank[r])
        for root in roots[1:]:
            pairs[root] = v
            oldest[root] = roots[0]
        if roots:
            oldest[v] = roots[0]
    return pairs


def parts_of_maxima(net, surviving_maxima, surviving_saddles):
    """Return {maximum: vertices}: cut at the nearest surviving saddle that touches what holds the maximum."""
    parts = {}
    for maximum in surviving_maxima:
        for saddle in sorted(surviving_saddles, key=lambda s: -net.rank[s]):
            if net.rank[saddle] < net.rank[maximum]:
                part = net.component_above(maximum, net.rank[saddle])
                if part & net.neighbours[saddle]:
                    parts[maximum] = part
                    break
    return parts


def parts_of_level(triangles, values, level, minima_are_features, essential=frozenset()):
    """Return {(is_maximum, extremum): vertices} of a level, from the definitions alone."""
    rank = np.empty(len(values), dtype=int)
    rank[np.argsort(values, kind="stable")] = np.arange(len(values))
    nets = {True: Net(triangles, rank)}
    if minima_are_features:
        nets[False] = Net(triangles, len(values) - 1 - rank)
    pairs = [
        (abs(values[e] - values[s]), is_maximum, e, s)
        for is_maximum, net in nets.items()
        for e, s in maximum_pairs(net).items()
    ]
    pairs.sort(key=lambda pair: (-pair[0], pair[2]))
    kept = pairs[:level]
    parts = {}
    for is_maximum, net in nets.items():
        top = max(net.vertices, key=lambda v: net.rank[v])
        maxima = [top] + [e for _, kind, e, _ in kept if kind == is_maximum]
        found = parts_of_maxima(net, maxima, {s for *_, s in kept} | essential)
        parts |= {(is_maximum, e): vertices for e, vertices in found.items()}
    return parts
