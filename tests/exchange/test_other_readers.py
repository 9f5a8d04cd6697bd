"""Readers of other programs return the numbers and units of the run; skipped where they are not installed."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from humanwalk.body import SIDES
from humanwalk.body.opensim_names import R_OW
from humanwalk.exchange import c3d as c3d_module
from humanwalk.exchange import export_run
from humanwalk.exchange.motion import ground_force, marker_paths
from humanwalk.exchange.opensim import angles, external_loads, torques
from humanwalk.quantity import ParameterError
from humanwalk.run.folder import Run
from humanwalk.sides import Side


@pytest.fixture(scope="module")
def c3d(run: Run, tmp_path_factory: pytest.TempPathFactory) -> Any:
    ezc3d = pytest.importorskip("ezc3d", reason="optional extra c3d")
    (path,) = export_run(run, "c3d", tmp_path_factory.mktemp("c3d"))
    return ezc3d.c3d(str(path), extract_forceplat_data=True)


def test_c3d_markers_are_millimeters_with_names_and_landmarks(c3d: Any, run: Run) -> None:
    point = c3d["parameters"]["POINT"]
    assert point["UNITS"]["value"] == ["mm"]
    assert point["RATE"]["value"][0] == 200
    paths = marker_paths(run)
    assert point["LABELS"]["value"] == list(paths)
    assert point["DESCRIPTIONS"]["value"][point["LABELS"]["value"].index("RKNE")] == "lateral epicondyle of the femur"
    for i, path in enumerate(paths.values()):
        np.testing.assert_allclose(c3d["data"]["points"][:3, i].T, 1000 * path, atol=1e-3)


@pytest.mark.parametrize(("plate", "side"), list(enumerate(SIDES)))
def test_c3d_force_plate_of_each_foot_shows_its_ground_force(c3d: Any, run: Run, plate: int, side: Side) -> None:
    found, load = c3d["data"]["platform"][plate], ground_force(run, side)
    assert (found["unit_force"], found["unit_moment"], found["unit_position"]) == ("N", "Nmm", "mm")
    np.testing.assert_allclose(found["force"].T, load.force, atol=1e-3)
    loaded = load.force[:, 2] > 0
    np.testing.assert_allclose(found["center_of_pressure"].T[loaded], 1000 * load.point[loaded], atol=0.05)
    np.testing.assert_allclose(found["Tz"][2, loaded], 1000 * load.free_moment[loaded, 2], atol=2.0)


def test_c3d_plate_contains_every_center_of_pressure(c3d: Any, run: Run) -> None:
    low, high = (bound(c3d["data"]["platform"][0]["corners"], axis=1) for bound in (np.min, np.max))
    for side in SIDES:
        point = 1000 * ground_force(run, side).point
        assert (point[:, :2] > low[:2]).all()
        assert (point[:, :2] < high[:2]).all()


def test_without_ezc3d_the_extra_is_named(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "ezc3d", None)
    with pytest.raises(ParameterError, match=r"pip install -e '\.\[c3d\]"):
        c3d_module.write_c3d(run, tmp_path)
    assert not list(tmp_path.iterdir())


@pytest.fixture(scope="module")
def opensim() -> Any:
    return pytest.importorskip("opensim", reason="optional extra opensim")


@pytest.mark.parametrize(
    ("name", "expected"), [("angles.mot", angles), ("torques.sto", torques), ("ground_forces.mot", external_loads)]
)
def test_opensim_reads_the_same_tables(opensim: Any, run: Run, tmp_path: Path, name: str, expected: Any) -> None:
    export_run(run, "opensim", tmp_path)
    table, wanted = opensim.TimeSeriesTable(str(tmp_path / name)), expected(run)
    assert tuple(table.getColumnLabels()) == wanted.columns
    assert table.getTableMetaDataString("inDegrees") == ("yes" if wanted.in_degrees else "no")
    np.testing.assert_allclose(table.getIndependentColumn(), wanted.time, atol=1e-12)
    np.testing.assert_allclose(table.getMatrix().to_numpy(), wanted.data, rtol=1e-10, atol=1e-10)


def test_opensim_reads_the_same_markers(opensim: Any, run: Run, tmp_path: Path) -> None:
    export_run(run, "opensim", tmp_path)
    table = opensim.TimeSeriesTableVec3(str(tmp_path / "markers.trc"))
    assert table.getTableMetaDataString("Units") == "mm"
    paths = marker_paths(run)
    assert list(table.getColumnLabels()) == list(paths)
    for name, path in paths.items():
        column = table.getDependentColumn(name)
        found = np.array([[column[i][axis] for axis in range(3)] for i in range(path.shape[0])])
        np.testing.assert_allclose(found, 1000 * path @ R_OW.T, atol=1e-5)


def test_opensim_reads_the_external_loads(opensim: Any, run: Run, tmp_path: Path) -> None:
    export_run(run, "opensim", tmp_path)
    loads = opensim.ExternalLoads(str(tmp_path / "external_loads.xml"), True)
    assert [loads.get(i).getAppliedToBodyName() for i in range(loads.getSize())] == ["calcn_r", "calcn_l"]
    assert loads.getDataFileName() == "ground_forces.mot"
