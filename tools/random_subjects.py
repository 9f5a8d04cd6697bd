"""Draws the subjects of the studies `subjects_adults` and `subjects_children`: python tools/random_subjects.py.

Adults have any stature from 1.45 to 2.05 m and any body mass index from 17 to 38 kg/m2, evenly distributed. Children
have about the statures and body mass indices of the CDC's growth charts (from memory). All walk at the dimensionless
speed of 1.2 m/s at a leg of 0.93 m.
"""

import csv
import math
from pathlib import Path

import numpy as np

import humanwalk
from humanwalk.body.subject import Subject

STUDIES = Path(humanwalk.__file__).parent / "models" / "studies"
SPEED, LEG = 1.2, 0.93
AGES, STATURES, INDICES = (6.0, 10.0, 14.0), (1.15, 1.385, 1.62), (15.5, 16.8, 19.5)
SPREAD_STATURE, SPREAD_INDEX = 0.04, 0.10


def adults(number: int, random: np.random.Generator) -> list[Subject]:
    """Draw adults of both sexes."""
    sexes, statures = random.choice(["female", "male"], number), random.uniform(1.45, 2.05, number)
    return [
        _subject(stature, random.uniform(17.0, 38.0), sex, 30.0) for sex, stature in zip(sexes, statures, strict=True)
    ]


def children(number: int, random: np.random.Generator) -> list[Subject]:
    """Draw girls and boys of 6 to 14 years."""
    drawn = []
    for age in random.uniform(6.0, 14.0, number):
        stature = np.interp(age, AGES, STATURES) * np.clip(random.normal(1.0, SPREAD_STATURE), 0.92, 1.08)
        index = np.interp(age, AGES, INDICES) * math.exp(np.clip(random.normal(0.0, SPREAD_INDEX), -0.2, 0.2))
        drawn.append(
            _subject(float(stature), float(index), str(random.choice(["female", "male"])), round(float(age), 1))
        )
    return drawn


def _subject(stature: float, index: float, sex: str, age: float) -> Subject:
    return Subject(round(index * stature**2, 1), round(stature, 2), sex, age)  # type: ignore[arg-type]


def write(name: str, subjects: list[Subject]) -> None:
    """Write the rows of a study, each with a seed of its own."""
    with open(STUDIES / f"{name}.csv", "w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        fields = ("sex", "age", "mass", "stature")
        speed_field = "controller.balanced.command.points.0.forward"
        rows.writerow([*(f"subject.{field}" for field in fields), speed_field, "seed"])
        for seed, subject in enumerate(subjects):
            speed = SPEED * math.sqrt(subject.body.hip_height / LEG)
            rows.writerow([*(getattr(subject, field) for field in fields), round(speed, 3), seed])


if __name__ == "__main__":
    write("subjects_adults", adults(100, np.random.default_rng(19)))
    write("subjects_children", children(40, np.random.default_rng(20)))
