"""The table of `humanwalk model`: a subject's segments beside de Leva's."""

from rich.box import SIMPLE
from rich.table import Table

from humanwalk.body.growth import ADULT_AGE
from humanwalk.body.segment_table import SegmentRow, segment_rows
from humanwalk.body.subject import Subject

CAPTION = (
    "In brackets the table's. Length [cm], mass [kg], center of mass [% of the length, from the upper end; foot: from "
    "the heel]. Moments of inertia about x forward, y left, z up through the center of mass, over the table's"
)


def segment_table(subject: Subject) -> Table:
    """Segments of a subject beside the tables; left limbs only where they differ from the right ones."""
    of = "women" if subject.sex == "female" else "men"
    at_age = f" of {subject.age:g} years" if subject.age < ADULT_AGE else ""
    title = f"{subject.mass:g} kg, {subject.stature:g} m, beside de Leva's {of}{at_age}"
    table = Table(title=title, caption=CAPTION, box=SIMPLE)
    table.add_column("segment")
    for heading in ("length", "mass", "center", "I x", "I y", "I z"):
        table.add_column(heading, justify="right")
    rows = {row.name: row for row in segment_rows(subject)}
    for name, row in rows.items():
        side, _, limb = name.partition("_")
        pair = [_cells(rows[f"{s}_{limb}"]) for s in ("right", "left")] if side in ("right", "left") else [None, None]
        same = pair[0] == pair[1]
        if not (same and side == "left"):
            label = limb if same and side == "right" else name
            table.add_row(label.replace("_", " "), *_cells(row))
    return table


def _cells(row: SegmentRow) -> list[str]:
    own, table = row.own, row.reference
    return [
        f"{100 * own.length:.1f} ({100 * table.length:.1f})",
        f"{own.mass:.2f} ({table.mass:.2f})",
        f"{100 * own.com / own.length:.0f} ({100 * table.com / table.length:.0f})",
        *(f"{ratio:.2f}" for ratio in row.ratios[1:]),
    ]
