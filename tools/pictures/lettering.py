"""Texts, lines and rows of pictures, in the one style that all sheets have."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import cache
from pathlib import Path

import bpy
from PIL import Image, ImageDraw, ImageFont

from tools.render import BACKGROUND

PAPER = (round(255 * BACKGROUND),) * 3
INK, PALE_INK = (32, 33, 36), (112, 116, 122)
# Drawn so many times as large and then made smaller, which smooths the edges of lines and discs.
FINENESS = 4
# Pixels beside and above the pictures of a sheet, and before the titles of rows.
TITLE_WIDTH, TITLE_HEIGHT, MARGIN = 190, 44, 24


@cache
def font(size: float, weight: int = 400) -> ImageFont.FreeTypeFont:
    """Return Inter, which every Blender brings along, in pixels; a weight of 600 is bold."""
    # The stubs leave this function out.
    path = Path(bpy.utils.system_resource("DATAFILES")) / "fonts" / "Inter.woff2"  # type: ignore[attr-defined]
    found = ImageFont.truetype(str(path), size)
    # The axes are the optical size and the weight, whichever comes first.
    found.set_variation_by_axes(
        [weight if axis["name"] == b"Weight" else axis["default"] or 0 for axis in found.get_variation_axes()]
    )
    return found


def paper(width: int, height: int) -> Image.Image:
    """Return an empty picture in the colour of the background."""
    return Image.new("RGB", (width, height), PAPER)


@contextmanager
def fine_lines(image: Image.Image, box: tuple[int, int, int, int]) -> Iterator[ImageDraw.ImageDraw]:
    """Draw smooth lines and discs into a part of a picture, in coordinates ``FINENESS`` times those of the part."""
    part = image.crop(box)
    large = part.resize((FINENESS * part.width, FINENESS * part.height), Image.Resampling.NEAREST)
    yield ImageDraw.Draw(large)
    image.paste(large.reduce(FINENESS), box[:2])


def write(
    image: Image.Image,
    place: tuple[float, float],
    text: str,
    size: float,
    weight: int = 400,
    ink: tuple[int, int, int] = INK,
    anchor: str = "la",
) -> None:
    """Write one line; the anchor is Pillow's: left, middle or right, and ascender, middle or baseline."""
    ImageDraw.Draw(image).text(place, text, font=font(size, weight), fill=ink, anchor=anchor)


def sheet(
    rows: Sequence[Sequence[Image.Image]], row_titles: Sequence[str] = (), titles: Sequence[Sequence[str]] = ()
) -> Image.Image:
    """Return pictures of one size in rows and columns.

    Parameters
    ----------
    rows : sequence of sequence of Image
    row_titles : sequence of str
        Stand at the left; a second line is pale.
    titles : sequence of sequence of str
        Stand above the pictures: one row of them for all rows, or one for each.
    """
    width, height = rows[0][0].size
    left = TITLE_WIDTH if row_titles else 0
    drawn = paper(left + width * max(map(len, rows)), (height + TITLE_HEIGHT) * len(rows))
    bottom = 0
    for number, row in enumerate(rows):
        if number < len(titles):
            _write_titles(drawn, titles[number], left, bottom, width)
            bottom += TITLE_HEIGHT
        for place, image in enumerate(row):
            drawn.paste(image, (left + place * width, bottom))
        if row_titles:
            _write_row_title(drawn, row_titles[number], bottom + height // 2)
        bottom += height
    return drawn.crop((0, 0, drawn.width, bottom))


def _write_titles(image: Image.Image, titles: Sequence[str], left: int, top: int, width: int) -> None:
    for place, title in enumerate(titles):
        write(image, (left + (place + 0.5) * width, top + TITLE_HEIGHT - 14), title, 17, ink=PALE_INK, anchor="mm")


def _write_row_title(image: Image.Image, title: str, middle: int) -> None:
    """Write the title of a row: its first line bold, a second one pale below."""
    first, _, second = title.partition("\n")
    write(image, (MARGIN, middle - (12 if second else 0)), first, 21, 600, anchor="lm")
    write(image, (MARGIN, middle + 14), second, 16, ink=PALE_INK, anchor="lm")
