"""Rules for the source: no import circles, body names in one place, short files, one definition of each type."""

import ast
import re
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import grimp
import pytest

from humanwalk.body.anatomy import human

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "humanwalk"
MODULES = sorted(path.relative_to(PACKAGE).as_posix() for path in PACKAGE.rglob("*.py"))
SYSTEMS = [module for module in MODULES if re.fullmatch(r"systems/(?!__)\w+\.py", module)]
FREE_OF_BODY_NAMES = [module for module in MODULES if not module.startswith(("body/", "exchange/"))]

LONGEST_FILE, LONGEST_CLASS = 400, 250

BODY_NAMES = {part.name for part in (*human().segments, *human().joints)}  # type: ignore[attr-defined]
BODY_WORDS = {word for name in BODY_NAMES for word in re.findall(r"[A-Z][a-z]+", name)} | {"Sole"}
"""Words that the names of bodies, joints and frames are composed of: Right, Leg, Femur, Motion, ..."""
PLACEHOLDER = "\N{WHITE SQUARE}"
"""Stands for an expression inside an f-string."""
COMPOSED = re.compile(rf"(?:{'|'.join(sorted(BODY_WORDS))}|\d|_|{PLACEHOLDER})+")
LABELS = {("view/plots/gait_cycle.py", "Pelvis")}
"""Headings of figures that happen to be names of the body."""


@cache
def tree(module: str) -> ast.Module:
    return ast.parse((PACKAGE / module).read_text(encoding="utf-8"))


def strings(source: ast.Module) -> list[tuple[int, str]]:
    """Line and value of every string but docstrings; f-strings with placeholders for their expressions."""
    found, parts = [], set()
    for node in ast.walk(source):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            parts.add(node.value)
        elif isinstance(node, ast.JoinedStr):
            parts.update(node.values)  # type: ignore[arg-type]
            texts = (part.value if isinstance(part, ast.Constant) else PLACEHOLDER for part in node.values)
            found.append((node.lineno, "".join(str(text) for text in texts)))
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and node not in parts:
            found.append((node.lineno, node.value))
    return found


def names_of_the_body(text: str) -> list[str]:
    """Names of bodies, joints and frames in a text, and parts of such names; plain words in a sentence do not count."""
    tokens = re.findall(rf"[\w{PLACEHOLDER}]+", text)
    return [token for token in tokens if token in BODY_NAMES or is_part_of_a_name(token, alone=token == text)]


def is_part_of_a_name(token: str, alone: bool) -> bool:
    words = [word for word in re.findall(r"[A-Z][a-z]+", token) if word in BODY_WORDS - {"Right", "Left", "Side"}]
    composed = COMPOSED.fullmatch(token) is not None and words != []
    return composed and (alone or token != words[0])


@pytest.mark.parametrize(
    "text",
    [
        "RightLegTibiaMotion",
        "Femur",
        "LegTibia",
        "_Sole",
        f"{PLACEHOLDER}Leg_Sole",
        f"{PLACEHOLDER}Leg{PLACEHOLDER}Motion",
        "LegFemurMotion.angle_rad",
        "no body like Ribs",
        "::Pelvis",
        "Lumbar_",
        "Thoracic",
    ],
)
def test_a_name_of_the_body_is_recognized(text: str) -> None:
    assert names_of_the_body(text) != []


@pytest.mark.parametrize(
    "text", ["Right", "Side", "Hip, knee and ankle", "right_foot.force_z_N", "MotionTable", "Heading"]
)
def test_plain_words_are_not_names_of_the_body(text: str) -> None:
    assert names_of_the_body(text) == []


@pytest.mark.parametrize("module", FREE_OF_BODY_NAMES)
def test_bodies_and_joints_are_named_in_body_and_exchange_only(module: str) -> None:
    found = [(line, name) for line, text in strings(tree(module)) for name in names_of_the_body(text)]
    assert [(line, name) for line, name in found if (module, name) not in LABELS] == [], "use humanwalk.body.limbs"


def test_no_import_circle_not_even_a_lazy_one_or_one_for_types() -> None:
    graph = grimp.build_graph("humanwalk", exclude_type_checking_imports=False, cache_dir=None)
    imports = {module: graph.find_modules_directly_imported_by(module) for module in graph.modules}
    try:
        TopologicalSorter(imports).prepare()
    except CycleError as error:
        pytest.fail(f"import circle: {' <- '.join(error.args[1])}")


@pytest.mark.parametrize("module", MODULES)
def test_files_and_classes_are_short(module: str) -> None:
    assert len((PACKAGE / module).read_text(encoding="utf-8").splitlines()) <= LONGEST_FILE
    classes = [node for node in ast.walk(tree(module)) if isinstance(node, ast.ClassDef)]
    lengths = {node.name: (node.end_lineno or node.lineno) - node.lineno + 1 for node in classes}
    assert {name: length for name, length in lengths.items() if length > LONGEST_CLASS} == {}


@pytest.mark.parametrize("module", [module for module in MODULES if module != "numerics/__init__.py"])
def test_array_types_are_those_of_numerics(module: str) -> None:
    lines = [
        node.lineno for node in ast.walk(tree(module)) if isinstance(node, ast.Attribute) and node.attr == "NDArray"
    ]
    assert lines == [], "import Array, Indices or Mask from humanwalk.numerics"


@pytest.mark.parametrize("module", SYSTEMS)
def test_ports_are_taken_by_name(module: str) -> None:
    functions = [node.name for node in ast.walk(tree(module)) if isinstance(node, ast.FunctionDef)]
    assert [name for name in functions if re.fullmatch(r"get_\w+_port", name)] == []


@pytest.mark.parametrize("module", SYSTEMS)
def test_every_leaf_system_has_a_test_file_of_its_name(module: str) -> None:
    bases = [
        ast.unparse(base) for node in ast.walk(tree(module)) if isinstance(node, ast.ClassDef) for base in node.bases
    ]
    if "LeafSystem" in bases:
        assert (ROOT / "tests" / "systems" / f"test_{Path(module).name}").is_file()
