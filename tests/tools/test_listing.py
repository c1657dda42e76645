"""What the page of an extension site shows fits its places and says what the manifest says."""

import re

import pytest

pytest.importorskip("bpy", reason="the pictures are rendered by Blender")

from tools.listing import __main__ as listing
from tools.listing.scenes import HEIGHT, LEFT, SECOND_SIZE, TITLE_SIZE, WIDTH, titled
from tools.pictures.lettering import PAPER, font

TEXT = listing.DESCRIPTION.read_text()


@pytest.mark.parametrize("name", listing.CAPTIONS)
def test_title_and_line_stay_on_the_sheet(name):
    for text, size, weight in zip(listing.CAPTIONS[name], (TITLE_SIZE, SECOND_SIZE), (650, 400), strict=True):
        assert LEFT + font(size, weight).getlength(text) < WIDTH - LEFT


def test_a_sheet_is_as_large_as_the_site_shows_it_and_free_but_for_its_lettering():
    sheet = titled(*listing.CAPTIONS["levels.png"])
    assert sheet.size == (WIDTH, HEIGHT) == (1920, 1080)
    assert sheet.crop((0, HEIGHT // 4, WIDTH, HEIGHT)).getcolors() == [(WIDTH * HEIGHT * 3 // 4, PAPER)]


def test_there_are_an_icon_a_featured_picture_and_five_more():
    assert {*listing.RENDERED, listing.WINDOW} == {"icon.png", "featured.png", *listing.CAPTIONS}
    assert len(listing.CAPTIONS) == 5


def test_the_description_tells_each_permission_and_what_for():
    sentence = next(line for line in TEXT.splitlines() if line.startswith("- Permissions"))
    for permission, reason in listing.MANIFEST["permissions"].items():
        assert f"*{permission}*, to {reason[0].lower()}{reason[1:]}" in sentence


def test_the_description_has_no_pictures_and_no_links_that_lead_nowhere():
    assert re.findall(r"!\[|\]\((?!https://)", TEXT) == []


def test_the_description_names_the_oldest_blender():
    oldest = listing.MANIFEST["blender_version_min"].removesuffix(".0")
    assert f"Blender {oldest} or newer" in TEXT
