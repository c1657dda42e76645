"""The command ``transfer``: weights, shape keys, UV maps, colours and attributes of a source on each mesh."""

import argparse
import time
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import bpy
import numpy as np

from ..compute.errors import EngineError
from ..compute.progress import silent
from ..operators.mesh_data import mesh_arrays
from ..operators.mesh_state import registration_record
from ..operators.mesh_state.state import read
from ..operators.messages.user_errors import Refusal
from ..operators.transfer.layer_reading import Choice, read_layers
from ..operators.transfer.layer_transferring import Body, Transferred, transfer_bodies
from ..operators.transfer.layer_writing import Mix, refuse_obstacles, write_layers
from ..operators.transfer.layers import PARTS, Layer
from ..operators.transfer.transfer import body_of
from . import formats
from .objects import chosen, report_each
from .report import Report
from .resume import digest_of

WHOLLY = Mix(1.0, "")


@dataclass(frozen=True, eq=False)
class Source:
    """The object whose layers all others get.

    Attributes
    ----------
    name : str
    body : Body
    layers : list of Layer
    colours : (n, 4) float32
        Of its parts.
    """

    name: str
    body: Body
    layers: list[Layer]
    colours: np.ndarray


class Transfer:
    """Transfers to files with the options of one call; the source is read when it is first needed."""

    def __init__(self, options: argparse.Namespace) -> None:
        self._options = options

    @cached_property
    def settings(self) -> Report:
        """What the results depend on besides the files."""
        options = self._options
        if not options.source.is_file():
            raise Refusal(f"the source {options.source}: there is no such file.")
        source = {"file": options.source.name, "digest": digest_of(options.source), "object": options.reference}
        given = {"object": options.object, "layers": options.layers, "mirrored": options.mirrored}
        return {"command": "transfer", **given, "source": source}

    def open_and_divide(self, path: Path) -> list[Report]:
        """Leave a file open whose meshes have the layers of the source, and return a row for each."""
        # The source opens a file of its own, so it comes first.
        source = self._source
        objects = chosen(formats.load(path), self._options.object)
        if path.resolve() == self._options.source.resolve():
            objects = [obj for obj in objects if obj.name != source.name]
        if not objects:
            raise Refusal("there is no mesh in this file but the source.")
        return report_each(objects, self._transfer)

    @cached_property
    def _source(self) -> Source:
        try:
            return _read_source(self._options)
        except (Refusal, EngineError) as error:
            raise Refusal(f"the source {self._options.source}: {error}") from error

    def _transfer(self, obj: bpy.types.Object) -> Report:
        start = time.perf_counter()
        source, mirrored = self._source, self._options.mirrored
        refuse_obstacles(obj, source.layers, WHOLLY)
        bodies = [_body(obj)]
        (result,) = transfer_bodies(source.body, source.layers, bodies, mirrored=mirrored, fills=True, progress=silent)
        refuse_obstacles(obj, result.layers, WHOLLY)
        write_layers(obj, result.layers, WHOLLY, source.colours)
        return _row(obj, source, result) | {"seconds": round(time.perf_counter() - start, 3)}


def _read_source(options: argparse.Namespace) -> Source:
    obj = chosen(formats.load(options.source), options.reference)[0]
    layers = read_layers(obj, Choice(frozenset(kind.upper() for kind in options.layers), "ALL", (), options.mirrored))
    highest = max((int(layer.values.max(initial=0)) for layer in layers if layer.kind == PARTS), default=0)
    return Source(obj.name, _body(obj), layers, read(obj.data).parts.colours_of(highest + 1))


def _body(obj: bpy.types.Object) -> Body:
    return body_of(obj, mesh_arrays.read_mesh(obj.data))


def _row(obj: bpy.types.Object, source: Source, result: Transferred) -> Report:
    torn = [f'the seams of "{name}" could not be kept, there are too many pieces.' for name in result.torn_seams]
    unsure = [f"matched with a confidence of {result.confidence:.0%} only."] * (
        result.confidence <= registration_record.SURE
    )
    return {
        "name": obj.name,
        "source": source.name,
        "confidence": round(result.confidence, 4),
        "found_by": result.found_by,
        "layers": [layer.name for layer in result.layers],
        "unsure_vertices": int((~result.is_sure).sum()),
        "warnings": [*unsure, *torn],
    }
