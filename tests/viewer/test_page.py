from __future__ import annotations

import base64
import gzip
import hashlib
import json
import re
import struct
from dataclasses import replace
from html import unescape

import numpy as np
import pytest

from exo_pin import viewer
from exo_pin.gait import normative_gait
from exo_pin.robot import load_robot
from exo_pin.viewer.page.page import SCRIPTS, PageTemplate

HOSTILE = """</title><script>alert("1")</script>&'{{engine}}"""
LARGEST = {False: 1_500_000, True: 2_000_000}  # bytes of an offline page without and with the wearer


def chunks(packed):
    data, at, out = gzip.decompress(packed), 0, []
    while at < len(data):
        (size,) = struct.unpack_from("<I", data, at)
        out.append(data[at + 4 : at + 4 + size])
        at += 4 + size
    return out


def unpacked(spec, data, kind):
    """Columns of an array: differences whose first bytes come first, summed up."""
    size = np.dtype(kind).itemsize
    changes = np.frombuffer(data, np.uint8).reshape(size, -1).T.copy().view(kind)
    return np.cumsum(changes.reshape(spec["width"], -1), axis=1, dtype=kind)


def test_a_bundle_gives_back_header_commands_and_arrays(scene):
    header, *rest = chunks(viewer.bundle(scene))
    facts = json.loads(header)
    assert facts["title"] == scene.title
    assert facts["commands"] == len(scene.commands)
    found = {spec["name"]: (spec, rest[facts["commands"] + spec["chunk"]]) for spec in facts["arrays"]}
    assert np.array_equal(unpacked(*found["q"], "<u4").view("<f4").T, scene.arrays["q"])
    spec, data = found["speeds"]
    steps = unpacked(spec, data, "<u2").view("<i2").T
    speeds = np.array(spec["middle"]) + np.where(steps == -32768, np.nan, steps) * spec["step"]
    assert np.all(np.abs(speeds - scene.arrays["speeds"]) <= 0.51 * np.array(spec["step"]))
    assert np.all(np.array(spec["step"]) < np.ptp(scene.arrays["speeds"], axis=0) / 65_533)


def test_the_same_scene_is_the_same_page_to_the_byte():
    texts = {viewer.html(viewer.scene(load_robot(), normative_gait())) for _ in range(2)}
    assert len(texts) == 1


def test_two_different_scenes_have_different_names(scene):
    other = replace(scene, facts=replace(scene.facts, title="other"))
    ids = {json.loads(chunks(viewer.bundle(each))[0])["id"] for each in (scene, other)}
    assert len(ids) == 2


@pytest.mark.parametrize("wearer", [False, True])
def test_the_offline_page_is_small(wearer):
    scene = viewer.scene(load_robot(), normative_gait(), wearer=wearer)
    assert len(viewer.html(scene).encode()) < LARGEST[wearer]


def test_hostile_names_are_text(scene):
    text = viewer.html(replace(scene, facts=replace(scene.facts, title=HOSTILE)))
    assert "alert" not in text.replace("&lt;script&gt;alert", "")
    assert text.count("<script") == viewer.html(scene).count("<script")


def test_placeholders_are_filled_in_one_pass():
    text = PageTemplate.load().page("{{script}} {{engine}}")
    assert text.count("{{script}} {{engine}}") == 2  # title and heading: not filled again
    assert not re.search(r"\{\{(style|policy|bundle|licences)\}\}", text)


def test_the_policy_forbids_everything_from_elsewhere(scene):
    text = viewer.html(scene)
    (policy,) = re.findall(r'Content-Security-Policy" content="([^"]*)"', text)
    assert "default-src &#x27;none&#x27;" in policy
    assert "connect-src &#x27;none&#x27;" in policy
    assert "unsafe-eval" not in policy
    assert "'unsafe-inline'" not in script_sources(policy)


def script_sources(policy):
    return re.search("script-src ([^;]*);", unescape(policy))[1].split()


def test_the_policy_allows_the_two_scripts_of_the_page_and_no_other(scene):
    text = viewer.html(scene)
    (policy,) = re.findall(r'Content-Security-Policy" content="([^"]*)"', text)
    (script,) = re.findall("(?s)<script>(.*?)</script>", text)
    engine = gzip.decompress(base64.b64decode(PageTemplate.load().engine))
    hashes = [base64.b64encode(hashlib.sha256(part).digest()) for part in (script.encode(), engine)]
    assert script_sources(policy) == [f"'sha256-{each.decode()}'" for each in hashes]


def test_the_page_names_nothing_to_load(scene):
    text = viewer.html(scene)
    shell = re.sub(r"(?s)<pre>.*?</pre>", "", text)  # licences hold addresses as text
    assert not re.search(
        r"""(?:src|href)\s*=\s*["']?(?!data:)[\w/.]""", re.sub(r"(?s)<script.*?</script>", "", shell)
    )


def test_the_engine_is_meshcats_own_and_its_licences_travel_with_it(scene):
    source = gzip.decompress(base64.b64decode(PageTemplate.load().engine))
    assert b"MeshCat" in source
    text = viewer.html(scene)
    for name in ("Robin Deits", "Three.js Authors", "dat.gui", "LAAS-CNRS"):
        assert name in text


def test_every_script_in_the_folder_is_used():
    from importlib import resources

    folder = resources.files("exo_pin.viewer") / "page"
    assert {file.name for file in folder.iterdir() if file.name.endswith(".js")} == set(SCRIPTS)
