"""A comparison of devices: ranked, with the motion that each number comes from."""

from __future__ import annotations

from collections.abc import Mapping

from exo_pin.anatomy.names import PelvisMotion
from exo_pin.compare import Comparison, JointChoices, comparison_table
from exo_pin.report.document.blocks import Document, Figure, Paragraph, Section, Table, Tiles
from exo_pin.report.draw import device_drawings as drawn
from exo_pin.report.draw.drawing import Drawing
from exo_pin.report.draw.pareto import pareto_svg
from exo_pin.report.sections import losses
from exo_pin.version import __version__

_PELVIS: dict[PelvisMotion, str] = {
    "recorded": "moves as recorded under every device: the legs alone are compared",
    "device": "as each device holds it: upright at its mean place, moving along the device's slides only",
}
_COLUMNS = (
    "Sole: distance of the soles' corners from the recorded ones. Foot: of the foot frame, under the ankle. "
    "Copy: the sole's error if the device merely copies its own joints and drops the others. Lost: recorded "
    "minus the device's; negative: a wider step, or a foot lifted higher. Knee change: largest difference "
    "from the required angle. Com: path of the centre of mass."
)


def comparison(
    compared: Comparison,
    *,
    name: str = "",
    speeds: Mapping[str, Comparison] | None = None,
    worth: JointChoices | None = None,
    choices: Mapping[str, str] | None = None,
    when: str = "",
) -> Document:
    """The page of a comparison.

    Args:
        compared: The devices under one walk.
        name: What the walk is called.
        speeds: The same devices and conditions under other walks, by name.
        worth: The choices of joints under this walk.
        choices: What was chosen, by name.
        when: The moment of the run, in words.
    """
    sections = [
        _summary(compared),
        _sticks(compared),
        losses.feet(compared),
        losses.steps(compared),
        losses.joints(compared),
        losses.centre_of_mass(compared),
        *([losses.speeds(speeds)] if speeds else []),
        *([_worth(worth)] if worth is not None else []),
        _conditions(compared, choices or {}),
    ]
    under = "; ".join(words for words in (f"walk: {name}" if name else "", when) if words)
    return Document("What each device loses of a walk", under, tuple(sections))


def _summary(compared: Comparison) -> Section:
    gait, body = compared.walk.gait, compared.walk.robot.body
    least, most = compared.best[0], compared.best[-1]
    tiles: tuple[tuple[str, str, bool | None], ...] = (
        ("devices", str(len(compared.best)), None),
        (f"least sole error, rms: {least.device.name}", f"{1e3 * least.rms:.1f} mm", None),
        (f"largest sole error, rms: {most.device.name}", f"{1e3 * most.rms:.1f} mm", None),
        ("length of the walk", f"{gait.duration:.2f} s", None),
        *(() if body is None else (("stature", f"{body.stature:.2f} m", None),)),
    )
    words = (
        f"{gait.source or 'The walk'}. Each device makes the best motion it can towards the recorded feet: "
        "the least sum of squared distances of the sole corners, within the limits and speeds of its joints. "
        f"The pelvis {_PELVIS[compared.conditions.pelvis]}."
    )
    ranked = Table(comparison_table.LOSS_COLUMNS, comparison_table.rows(compared), "Least loss first")
    bars = Figure((drawn.ranking(compared),), "Bar: the best motion. Stroke: the plain copy.", columns=1)
    return Section("Summary", (Tiles(tiles), Paragraph(words), ranked, Paragraph(_COLUMNS, "note"), bars))


def _sticks(compared: Comparison) -> Section:
    caption = (
        "Grey: the recorded walk. Five moments of a cycle from the left, the third also from the front; the "
        "poses are set apart for the picture."
    )
    drawings = tuple(drawn.sticks(loss) for loss in compared.best)
    return Section("How they walk", (Figure(drawings, caption, columns=2),))


def _worth(worth: JointChoices) -> Section:
    picture = Drawing("pareto", "Sole error against number of motors", pareto_svg(worth))
    caption = (
        "All 64 choices of the six movements of a leg, the same on both legs, the pelvis as recorded, at "
        f"{len(worth.walk.gait)} samples of the walk."
    )
    return Section(
        "Which joints are worth their motor",
        (
            Figure((picture,), caption, columns=1),
            Table(
                comparison_table.PARETO_COLUMNS,
                comparison_table.front_rows(worth),
                "Best choice for each number of motors",
                prose=True,
            ),
            Table(comparison_table.MOVEMENT_COLUMNS, comparison_table.single_rows(worth)),
        ),
    )


def _conditions(compared: Comparison, choices: Mapping[str, str]) -> Section:
    body, conditions = compared.walk.robot.body, compared.conditions
    rows = [
        ["walk", compared.walk.gait.source or "source not stated"],
        ["pelvis", _PELVIS[conditions.pelvis]],
        [
            "passive joints",
            {"held": "held at zero", "released": "move as it suits the feet"}[conditions.passive],
        ],
        ["joint limits and speeds", "those that device and body both allow; the device's"],
        *([] if body is None else [["body", f"{body.stature:.3f} m, {body.mass:.1f} kg, {body.sex}"]]),
        *([name, words] for name, words in choices.items()),
        ["made with", f"exo_pin {__version__}"],
    ]
    about = [
        [loss.device.name, loss.device.title or loss.device.name, loss.device.source]
        for loss in compared.best
    ]
    note = "The comparison is kinematic: it does not say what a locked joint does to forces."
    return Section(
        "Conditions",
        (
            Table(("condition", ""), rows, prose=True),
            Table(("device", "what it is", "source"), about, prose=True),
            Paragraph(note, "note"),
        ),
    )
