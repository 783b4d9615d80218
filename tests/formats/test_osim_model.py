"""OpenSim models: what the joints say is what the coordinates then mean; OpenSim itself agrees."""

from __future__ import annotations

import copy
import itertools
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

from exo_pin.anatomy import JOINTS
from exo_pin.errors import FormatError, UnknownNameError
from exo_pin.formats import load_gait
from exo_pin.formats.opensim.convention import model_convention
from exo_pin.formats.opensim.coordinate_names import LEG_COORDINATES
from exo_pin.formats.opensim.osim_model import load_model
from exo_pin.formats.opensim.pelvis_axes import FROM_OPENSIM

MANGLED = 40  # a second each; by hand it were thousands
EXACT = 1e-12  # [rad, m] the same numbers on another way
FILE = 1e-6  # [m] eight digits of degrees in OpenSim's file, seven in the poses
X, Y, Z = np.eye(3)
TILT, LIST, ROTATION = ("pelvis_tilt", Z), ("pelvis_list", X), ("pelvis_rotation", Y)
LEG: dict[str, Any] = {  # joint of the right leg: coordinates with their axes, the place in the parent
    "hip": ([("hip_flexion", Z), ("hip_adduction", X), ("hip_rotation", Y)], (-0.06, -0.08, 0.09)),
    "knee": ([("knee_angle", Z)], (0.0, -0.4, 0.0)),
    "ankle": ([("ankle_angle", (-0.105, -0.174, 0.979))], (0.0, -0.4, 0.0)),
    "subtalar": ([("subtalar_angle", (0.787, 0.605, -0.121))], (-0.05, -0.04, 0.0)),
}
BODIES = {"hip": "femur", "knee": "tibia", "ankle": "talus", "subtalar": "calcn"}


def words(values):
    return " ".join(map(repr, map(float, values)))


def axis(kind, k, coordinate, vector, version, slope=1.0):
    function = f"<LinearFunction NAME><coefficients>{slope} 0</coefficients></LinearFunction>"
    if not coordinate:
        function = "<Constant NAME><value>0</value></Constant>"
    if version == 4:
        function = function.replace("NAME", 'name="function"')
    else:
        function = f"<function>{function.replace(' NAME', '')}</function>"
    return (
        f'<TransformAxis name="{kind}{k + 1}"><coordinates>{coordinate}</coordinates>'
        f"<axis>{words(vector)}</axis>{function}</TransformAxis>"
    )


def resting(some):
    """Axes for which nobody asks, but which OpenSim wants: those furthest from the others first."""
    return [
        ("", v) for v in sorted((X, Y, Z), key=lambda v: max([abs(np.dot(v, a)) for _, a in some], default=0))
    ]


def spatial(turns, slides, version, slope):
    turns, slides = ([*some, *resting(some)][:3] for some in (turns, slides))
    rows = [axis("rotation", k, name, v, version, slope) for k, (name, v) in enumerate(turns)]
    rows += [axis("translation", k, name, v, version) for k, (name, v) in enumerate(slides)]
    return f"<SpatialTransform>{''.join(rows)}</SpatialTransform>"


def joint(name, parent, child, turns, slides=(), *, place=(0, 0, 0), tilt=(0, 0, 0), version=4, **more):
    """A joint with its offsets, as version 4 or 3 writes it."""
    kind = more.get("kind", "CustomJoint")
    names = [c for c, _ in (*turns, *slides)]
    coordinates = "".join(
        f'<Coordinate name="{c}"><default_value>0</default_value></Coordinate>' for c in names
    )
    inner = spatial(turns, slides, version, more.get("slope", 1.0)) if kind == "CustomJoint" else ""
    if version == 3:
        return (
            f'<{kind} name="{name}"><parent_body>{parent}</parent_body>'
            f"<location_in_parent>{words(place)}</location_in_parent>"
            f"<orientation_in_parent>{words(tilt)}</orientation_in_parent>"
            "<location>0 0 0</location><orientation>0 0 0</orientation>"
            f"<CoordinateSet><objects>{coordinates}</objects></CoordinateSet>{inner}</{kind}>"
        )
    path = "/ground" if parent == "ground" else f"/bodyset/{parent}"
    return (
        f'<{kind} name="{name}"><socket_parent_frame>there</socket_parent_frame>'
        f"<socket_child_frame>/bodyset/{child}</socket_child_frame><coordinates>{coordinates}</coordinates>"
        f'<frames><PhysicalOffsetFrame name="there"><socket_parent>{path}</socket_parent>'
        f"<translation>{words(place)}</translation><orientation>{words(tilt)}</orientation>"
        f"</PhysicalOffsetFrame></frames>{inner}</{kind}>"
    )


SLIDES = tuple(zip(("pelvis_tx", "pelvis_ty", "pelvis_tz"), np.eye(3), strict=True))


def osim(turns=(TILT, LIST, ROTATION), slides=SLIDES, *, version=4, knee=1.0, leg=LEG, **pelvis):
    """The text of a model: pelvis and two legs."""
    joints = {"pelvis": joint("ground_pelvis", "ground", "pelvis", turns, slides, version=version, **pelvis)}
    for side, mirror in (("r", 1), ("l", -1)):
        parent = "pelvis"
        for name, (own, place) in leg.items():
            own = [(f"{c}_{side}", np.multiply(v, [mirror, mirror, 1])) for c, v in own]
            body, place = f"{BODIES[name]}_{side}", np.multiply(place, [1, 1, mirror])
            slope = knee if name == "knee" else 1.0
            joints[body] = joint(
                f"{name}_{side}", parent, body, own, place=place, version=version, slope=slope
            )
            parent = body
    bodies = {
        name: f'<Body name="{name}"><mass>1</mass>'
        + ("<mass_center>0 0 0</mass_center><inertia>1 1 1 0 0 0</inertia>" if version == 4 else "")
        + (f"<Joint>{text}</Joint>" if version == 3 else "")
        + "</Body>"
        for name, text in joints.items()
    }
    rest = f"<JointSet><objects>{''.join(joints.values())}</objects></JointSet>" if version == 4 else ""
    if version == 3:
        bodies = {"ground": '<Body name="ground"><mass>0</mass><Joint /></Body>'} | bodies
    return (
        f'<?xml version="1.0"?><OpenSimDocument Version="{version}0000"><Model name="made">'
        f"<BodySet><objects>{''.join(bodies.values())}</objects></BodySet>{rest}</Model></OpenSimDocument>"
    )


def motion(path, values):
    """A .mot of these coordinates [deg, m]; the legs stand still but for what is given."""
    n = len(next(iter(values.values())))
    table = {"time": np.arange(n) / 10} | dict.fromkeys(LEG_COORDINATES, np.zeros(n)) | values
    rows = ["\t".join(map(repr, map(float, row))) for row in zip(*table.values(), strict=True)]
    path.write_text("\n".join(["Coordinates", "inDegrees=yes", "endheader", "\t".join(table), *rows]))
    return path


def about(vector, angle):
    """A rotation by quaternions: another way than the package's."""
    x, y, z = np.sin(angle / 2) * np.asarray(vector) / np.linalg.norm(vector)
    w = np.cos(angle / 2)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


@pytest.fixture
def model(tmp_path):
    return tmp_path / "made.osim"


@pytest.fixture
def angles(rng):
    return {c: rng.uniform(-40, 40, 5) for c, _ in (TILT, LIST, ROTATION)}


ORDERS = list(itertools.permutations((TILT, LIST, ROTATION)))


@pytest.mark.parametrize("version", [3, 4])
@pytest.mark.parametrize("turns", ORDERS, ids=lambda t: "".join(c[7] for c, _ in t))
def test_every_order_of_turns_is_composed_as_the_model_has_it(model, tmp_path, angles, rng, turns, version):
    signs = rng.choice([-1.0, 1.0], 3)
    turns = [(c, sign * v) for (c, v), sign in zip(turns, signs, strict=True)]
    model.write_text(osim(turns, version=version))
    slides = {f"pelvis_t{a}": rng.normal(size=5) for a in "xyz"}
    path = motion(tmp_path / "x.mot", angles | slides)
    base = load_gait(path, model=model).base
    for k in range(5):
        R = np.eye(3)
        for name, vector in turns:
            R = R @ about(vector, np.radians(angles[name][k]))
        np.testing.assert_allclose(base[k, :3, :3], FROM_OPENSIM @ R @ FROM_OPENSIM.T, atol=EXACT)
        p = np.array([slides[f"pelvis_t{a}"][k] for a in "xyz"]) + R @ [-0.06, -0.08, 0.0]
        np.testing.assert_allclose(base[k, :3, 3], FROM_OPENSIM @ p, atol=EXACT)
    if (signs == 1).all():
        order = [c.removeprefix("pelvis_") for c, _ in turns]
        told = load_gait(path, preset="opensim-gait2392", pelvis_order=order).base
        np.testing.assert_allclose(told[:, :3, :3], base[:, :3, :3], atol=EXACT)


def test_the_models_knee_tells_its_own_sign(model, tmp_path):
    bent = np.full(5, -60.0)
    path = motion(tmp_path / "x.mot", {"knee_angle_l": bent, "knee_angle_r": bent})
    for slope, sign in ((1.0, -1), (-1.0, 1)):  # positive about z stretches the knee
        model.write_text(osim(knee=slope))
        assert model_convention(model).signs["left_knee_flexion"] == sign
        gait = load_gait(path, model=model)
        assert np.degrees(gait.q[0, JOINTS.index("right_knee_flexion")]) == pytest.approx(-60 * sign)
        assert "so its model" in gait.source
    assert model_convention(model).signs == dict.fromkeys(JOINTS, 1)
    assert np.degrees(load_gait(path, model=model, preset="opensim-gait2392").q[0, 3]) == pytest.approx(60)


@pytest.mark.parametrize(("turn", "sign"), [(np.pi / 2, 1), (-np.pi / 2, -1)])
def test_an_offset_frame_turns_the_axis_of_its_joint(model, turn, sign):
    text = osim(leg=LEG | {"knee": ([("knee_angle", X)], LEG["knee"][1])})
    before, after = text.split('name="knee_r"><socket')
    old = "<orientation>0.0 0.0 0.0<"
    model.write_text(f'{before}name="knee_r"><socket{after.replace(old, f"<orientation>0 {turn} 0<", 1)}')
    signs = model_convention(model).signs
    assert signs["right_knee_flexion"] == sign  # turned by +90 deg about y, x points to -z: flexion
    assert "left_knee_flexion" not in signs  # its axis points forward: nobody's knee


def test_a_hip_in_another_order_is_converted_through_its_rotation(model, tmp_path, rng):
    odd = LEG | {"hip": ([("hip_rotation", Y), ("hip_adduction", X), ("hip_flexion", Z)], LEG["hip"][1])}
    model.write_text(osim(leg=odd))
    names = ("hip_rotation", "hip_adduction", "hip_flexion")
    given = {f"{c}_{s}": rng.uniform(-30, 30, 5) for c in names for s in "lr"}
    gait = load_gait(motion(tmp_path / "x.mot", given), model=model)
    for side, mirror in (("left", -1), ("right", 1)):
        f, a, r = gait.q[0, [JOINTS.index(f"{side}_{m}") for m in names[::-1]]]
        ours = about(Z, f) @ about(mirror * X, a) @ about(mirror * Y, r)
        r, a, f = (np.radians(given[f"{c}_{side[0]}"][0]) for c in names)
        np.testing.assert_allclose(
            ours, about(mirror * Y, r) @ about(mirror * X, a) @ about(Z, f), atol=EXACT
        )


def test_coordinates_that_the_file_lacks_have_the_models_default(model, tmp_path, angles):
    leg = {name: ([c for c in own if "adduction" not in c[0]], place) for name, (own, place) in LEG.items()}
    del leg["subtalar"]
    text = osim(leg=leg).replace(
        '"pelvis_ty"><default_value>0</default_value>', '"pelvis_ty"><default_value>0.9</default_value>'
    )
    model.write_text(text)
    path = motion(tmp_path / "x.mot", angles)
    lines = [line.split("\t") for line in path.read_text().splitlines()[3:]]
    keep = [k for k, name in enumerate(lines[0]) if "adduction" not in name and "subtalar" not in name]
    rows = ["\t".join(line[k] for k in keep) for line in lines]
    path.write_text("\n".join(["Coordinates", "inDegrees=yes", "endheader", *rows]))
    (remark,) = load_gait(path, preset="opensim-gait2392").remarks
    assert "pelvis_ty at 0 m, " in remark
    assert remark.endswith("(no model is given)")
    gait = load_gait(path, model=model)
    assert "pelvis_ty at 0.9 m, pelvis_tz at 0 m (the model's default)" in gait.remarks[0]
    assert not gait.q.any()
    assert 0.8 < gait.base[:, 2, 3].min() < 0.9
    assert "not in the file, so held: hip_adduction_l, subtalar_angle_l" in gait.source
    assert "pelvis_ty" in gait.source


LINE = '<LinearFunction name="function"><coefficients>1.0 0</coefficients></LinearFunction>'
CURVE = '<SimmSpline name="function"><x>0 1 2</x><y>0 1 4</y></SimmSpline>'


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("", "no XML"),
        ("<a><b></a>", "no XML"),
        ('<!DOCTYPE a [<!ENTITY x "y">]><a>&x;</a>', "document type"),
        ("<a>" * 200 + "</a>" * 200, "more than 100 levels"),
        ('<?xml version="1.0" encoding="klingon"?><a/>', "no XML"),
        ("<OpenSimDocument/>", "no <Model>"),
        ("<OpenSimDocument><Model/></OpenSimDocument>", "without joints"),
        (osim().replace("hip_flexion_l", "other"), "no joint rotates by 'hip_flexion_l'"),
        (osim().replace("/ground", "/bodyset/floor"), "lead from the ground to body 'floor'"),
        (osim().replace("/ground", "/bodyset/pelvis"), "lead from the ground to body 'pelvis'"),
        (osim().replace("0.09", "much"), "'much' is no number"),
        (osim().replace("0.09", "1e99"), "no length or angle"),
        (osim().replace("<axis>0.0 0.0 1.0<", "<axis>1<", 1), "<axis> holds 1 numbers"),
        (osim(kind="PinJoint"), "has 6 coordinates; a PinJoint has 1"),
        (osim(leg=LEG | {"hip": ([*LEG["hip"][0][::2], ("other", X)], (0, 0, 0))}), "expected rotations by"),
        (osim().replace(LINE, CURVE, 1), "'ground_pelvis' moves along curves"),
    ],
)
def test_what_is_no_model_is_refused_in_one_line(model, tmp_path, angles, text, match):
    model.write_text(text)
    with pytest.raises(FormatError, match=match) as caught:
        load_gait(motion(tmp_path / "x.mot", angles), model=model)
    assert "\n" not in str(caught.value)
    assert "made.osim" in str(caught.value)


TEXTS = [
    "",
    "nan",
    "1e999",
    "0 0 0",
    "1 2",
    "ground",
    "/bodyset/pelvis",
    "knee_angle_l",
    "hip_flexion_l",
    "..",
]
TAGS = ["FreeJoint", "CustomJoint", "PinJoint", "Body", "Coordinate", "SimmSpline", "Constant", "x"]


def mangled(root, rng):
    """A well-formed model whose elements got lost, doubled, renamed or other texts."""
    root = copy.deepcopy(root)
    elements = list(root.iter())
    for _ in range(rng.integers(1, 4)):
        one, other = (elements[k] for k in rng.integers(0, len(elements), 2))
        match rng.integers(5):
            case 0:
                one.text = rng.choice(TEXTS)
            case 1:
                one.set("name", rng.choice(TEXTS))
            case 2:
                one.tag = rng.choice(TAGS)
            case 3:
                one[:] = one[1:]
            case 4:
                one.append(copy.deepcopy(other))
    return ElementTree.tostring(root)


@pytest.mark.parametrize("version", [3, 4])
def test_mangled_models_are_read_or_refused_but_never_crash(model, tmp_path, angles, rng, version):
    path, root = motion(tmp_path / "x.mot", angles), ElementTree.fromstring(osim(version=version))
    messages = []
    for _ in range(MANGLED):
        model.write_bytes(mangled(root, rng))
        try:
            assert np.isfinite(load_gait(path, preset="opensim-gait2392", model=model).q).all()
        except FormatError as error:
            messages.append(str(error))
    assert 0 < len(messages) < MANGLED
    assert not any("\n" in message for message in messages)


def test_models_and_orders_are_for_opensims_files(model, tmp_path, angles):
    path = motion(tmp_path / "x.mot", angles)
    with pytest.raises(UnknownNameError, match="in any order"):
        load_gait(path, pelvis_order=("tilt", "list"))
    (tmp_path / "x.csv").write_text("time_s\n")
    with pytest.raises(FormatError, match=r"is for \.mot and \.sto"):
        load_gait(tmp_path / "x.csv", model=model)


def test_the_recordings_model_has_its_hips_and_signs(shared):
    folder = shared / "opensim_subject01_walk"
    means = model_convention(folder / "subject01_simbody.osim")
    assert {name for name, sign in means.signs.items() if sign < 0} == {
        "left_knee_flexion",
        "right_knee_flexion",
    }
    assert not means.hips
    by_habit = load_gait(folder / "subject01_walk1_ik.mot")
    gait = load_gait(folder / "subject01_walk1_ik.mot", model=folder / "subject01_simbody.osim")
    np.testing.assert_array_equal(gait.q, by_habit.q)
    moved = np.linalg.norm(gait.base[:, :3, 3] - by_habit.base[:, :3, 3], axis=1)
    assert 0.001 < moved.max() < 0.005  # this person's hips are not the generic ones


def on_a_floor(text):
    """The same model (version 4) on a floor that tilts and slides."""
    weight = "<mass>1</mass><mass_center>0 0 0</mass_center><inertia>1 1 1 0 0 0</inertia>"
    floor = f'<Body name="floor">{weight}</Body>'
    turns, slides = [("floor_tilt", Z), ("floor_list", X)], [("floor_tx", X)]
    below = joint("ground_floor", "ground", "floor", turns, slides, place=(0, 0.1, 0), tilt=(0, 0.4, 0))
    text = text.replace("/ground</socket_parent>", "/bodyset/floor</socket_parent>")
    text = text.replace('<Body name="pelvis">', f'{floor}<Body name="pelvis">')
    return text.replace("<JointSet><objects>", f"<JointSet><objects>{below}")


def test_joints_between_ground_and_pelvis_follow_each_other(model, tmp_path, angles):
    model.write_text(on_a_floor(osim()))
    coordinates = angles | {"floor_tilt": np.full(5, 10.0), "floor_list": np.full(5, -20.0)}
    coordinates |= {"floor_tx": np.full(5, 0.3), "pelvis_ty": np.full(5, 0.9)}
    gait = load_gait(motion(tmp_path / "x.mot", coordinates), model=model, preset="opensim-gait2392")
    floor = about(Y, 0.4) @ about(Z, np.radians(10)) @ about(X, np.radians(-20))
    for k in range(5):
        R = floor @ np.linalg.multi_dot(
            [about(v, np.radians(angles[c][k])) for c, v in (TILT, LIST, ROTATION)]
        )
        np.testing.assert_allclose(gait.base[k, :3, :3], FROM_OPENSIM @ R @ FROM_OPENSIM.T, atol=EXACT)
        p = [0, 0.1, 0] + about(Y, 0.4) @ [0.3, 0, 0] + floor @ [0, 0.9, 0] + R @ [-0.06, -0.08, 0]
        np.testing.assert_allclose(gait.base[k, :3, 3], FROM_OPENSIM @ p, atol=EXACT)


KINDS = {
    "CustomJoint": {},
    "tilted": {"place": (0.1, 0.2, -0.3), "tilt": (0.3, -0.5, 0.7)},
    "FreeJoint": {"kind": "FreeJoint"},
    "BallJoint": {"kind": "BallJoint", "slides": ()},
    "GimbalJoint": {"kind": "GimbalJoint", "slides": ()},
    "UniversalJoint": {"kind": "UniversalJoint", "turns": (TILT, LIST), "slides": ()},
    "PlanarJoint": {"kind": "PlanarJoint", "turns": (TILT,), "slides": SLIDES[:2]},
    "PinJoint": {"kind": "PinJoint", "turns": (TILT,), "slides": ()},
    "SliderJoint": {"kind": "SliderJoint", "turns": (), "slides": SLIDES[:1]},
}


@pytest.mark.parametrize("more", KINDS.values(), ids=KINDS)
@pytest.mark.parametrize("version", [3, 4])
def test_opensim_puts_the_pelvis_in_the_same_place(model, tmp_path, rng, more, version):
    opensim = pytest.importorskip("opensim", reason="OpenSim is not installed (extra `oracle`)")
    model.write_text(osim(version=version, **more))
    theirs = opensim.Model(str(model))
    state = theirs.initSystem()
    found = load_model(model)
    values = {name: rng.uniform(-1, 1, 3) for joint in found.chain("pelvis") for name in joint.coordinates}
    text = {c: v if c[-3:-1] == "_t" else np.degrees(v) for c, v in values.items()}
    gait = load_gait(motion(tmp_path / "x.mot", text), model=model, preset="opensim-gait2392")
    for k in range(3):
        for name, value in values.items():
            theirs.getCoordinateSet().get(name).setValue(state, float(value[k]), False)
        theirs.realizePosition(state)
        T = theirs.getBodySet().get("pelvis").getTransformInGround(state)
        R = np.array([[T.R().get(i, j) for j in range(3)] for i in range(3)])
        hips = (
            theirs.getBodySet()
            .get("pelvis")
            .findStationLocationInGround(state, opensim.Vec3(-0.06, -0.08, 0))
        )
        np.testing.assert_allclose(gait.base[k, :3, :3], FROM_OPENSIM @ R @ FROM_OPENSIM.T, atol=EXACT)
        np.testing.assert_allclose(
            gait.base[k, :3, 3], FROM_OPENSIM @ [hips.get(i) for i in range(3)], atol=EXACT
        )
