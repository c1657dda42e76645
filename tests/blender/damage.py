"""Ways to damage what is stored on a mesh, for each thing that is stored."""

import bpy
import numpy as np

STATE = "eigenparts_state"
HUGE = 2**31 - 1
# What stands in place of any stored value.
REPLACEMENTS = {
    "zero": 0,
    "negative": -5,
    "huge": HUGE,
    "tiny": -HUGE - 1,
    "nan": float("nan"),
    "infinite": float("inf"),
    "text": "__import__('os').abort()",
    "no text": "",
    "undecodable": b"\xff\x00\xfe",
    "no group": {},
    "group": {"0": {"dtype": "object", "shape": [HUGE, HUGE], "values": "x"}},
    "flat group": {"1": 3, "x": 4},
    "numbers": [1, 2, 3],
    "decimals": [float("nan"), -1e300, 2.5],
    "texts": ["a", "b"],
    "groups": [{"a": 1}, {"b": 2}],
}
# What becomes of the numbers of a list or an array.
CHANGES = {
    "cut short": lambda values: values[:-1],
    "too long": lambda values: values * 2,
    "all negative": lambda values: [max(-abs(value) - 2, -HUGE) for value in values],
    "all zero": lambda values: [0 for _ in values],
    "all huge": lambda values: [HUGE for _ in values],
    "all least": lambda values: [-HUGE - 1 for _ in values],
    "no numbers": lambda values: [float("nan") for _ in values],
    "all infinite": lambda values: [float("inf") for _ in values],
    "reversed": lambda values: values[::-1],
    "one huge": lambda values: [HUGE, *values[1:]],
    "one negative": lambda values: [-7, *values[1:]],
    "rising": lambda values: list(range(1, len(values) + 1)),
}


def places(group, path=()):
    """Return the path of every value in a group, groups and what is in them alike."""
    found = []
    for name in group:
        found.append((*path, name))
        if hasattr(group[name], "to_dict"):
            found += places(group[name], (*path, name))
    return found


def is_list(value):
    return hasattr(value, "typecode") and len(value) > 0


def damages_of(mesh):
    """Return each (place, kind) of damage to the properties of a mesh that are ours."""
    roots = [name for name in mesh.keys() if name.startswith("eigenparts_")]  # noqa: SIM118
    found = []
    for root in roots:
        value = mesh[root]
        for path in [(root,), *places(value, (root,))] if hasattr(value, "to_dict") else [(root,)]:
            found += [(path, kind) for kind in ("gone", "object", *REPLACEMENTS)]
            if is_list(at(mesh, path)):
                found += [(path, kind) for kind in CHANGES]
    return found


def at(mesh, path):
    group = mesh
    for name in path:
        group = group[name]
    return group


def damage(mesh, path, kind):
    """Damage one stored value; do nothing if it is not there any more."""
    owner = at(mesh, path[:-1])
    if kind == "gone":
        del owner[path[-1]]
    elif kind == "object":
        owner[path[-1]] = bpy.context.object
    elif kind in CHANGES:
        owner[path[-1]] = CHANGES[kind](list(owner[path[-1]]))
    else:
        owner[path[-1]] = REPLACEMENTS[kind]


ATTRIBUTE_DAMAGES = ("gone", "other type", "other domain", "huge", "negative", "no numbers", "shuffled", "zero")


def damage_attribute(mesh, name, kind):
    """Damage an attribute of ours."""
    attribute = mesh.attributes[name]
    data_type, domain = attribute.data_type, attribute.domain
    if kind in ("gone", "other type", "other domain"):
        mesh.attributes.remove(attribute)
    if kind == "other type":
        mesh.attributes.new(name, "FLOAT_VECTOR" if data_type != "FLOAT_VECTOR" else "FLOAT_COLOR", domain)
    if kind == "other domain":
        mesh.attributes.new(name, data_type, "CORNER" if domain != "CORNER" else "POINT")
    if kind in ("huge", "negative", "no numbers", "shuffled", "zero"):
        _fill(attribute, kind)


def _fill(attribute, kind):
    storage = {
        "INT": ("value", 1, np.int32),
        "FLOAT": ("value", 1, np.float32),
        "FLOAT_VECTOR": ("vector", 3, np.float32),
        "FLOAT_COLOR": ("color", 4, np.float32),
    }
    name, n_components, dtype = storage[attribute.data_type]
    values = np.empty(n_components * len(attribute.data), dtype=dtype)
    attribute.data.foreach_get(name, values)
    extreme = {"huge": HUGE, "negative": -HUGE, "zero": 0, "no numbers": np.nan if dtype is np.float32 else -HUGE - 1}
    values = np.random.default_rng(0).permutation(values) if kind == "shuffled" else np.full_like(values, extreme[kind])
    attribute.data.foreach_set(name, values)


def own_attributes(mesh):
    return [
        attribute.name for attribute in mesh.attributes if attribute.name in mesh["eigenparts_attributes"].split("\n")
    ]
