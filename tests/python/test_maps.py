"""OctoMap files against OctoMap itself, which writes them and lists their leaves."""

import shutil
import subprocess

import numpy as np
import pytest
from karst.errors import Error
from karst.maps import read_map

pytest.importorskip("karst._maps")

WRITER = r"""
#include <octomap/octomap.h>
#include <cstdio>
#include <random>
int main(int, char** argv) {
  octomap::OcTree tree(0.25);
  std::mt19937 random(5);
  std::normal_distribution<double> place(0, 1.5);
  for (int i = 0; i < 20000; ++i) {
    const double x = place(random), y = place(random) - 3, z = place(random);
    tree.updateNode(octomap::point3d(x, y, z), x * x + z * z > 2);
  }
  for (int i = 0; i < 8 * 8 * 8; ++i)  // equal cells, which pruning joins
    tree.updateNode(octomap::point3d(20.1 + 0.25 * (i % 8), 0.1 + 0.25 * (i / 8 % 8), 0.1 + 0.25 * (i / 64)),
                    true);
  tree.prune();
  tree.write(std::string(argv[1]) + "/map.ot");
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf)
    std::printf("%.9g %.9g %.9g %.9g %.9g\n", leaf.getX(), leaf.getY(), leaf.getZ(), leaf.getSize(),
                leaf->getLogOdds());
  tree.toMaxLikelihood();
  tree.prune();
  tree.writeBinaryConst(std::string(argv[1]) + "/map.bt");
}
"""


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """The folder of map.ot and map.bt, and the leaves (x, y, z, size, log-odds) of the former."""
    folder = tmp_path_factory.mktemp("octomap")
    (folder / "writer.cpp").write_text(WRITER)
    compiler = shutil.which("g++")
    if compiler is None:
        pytest.skip("no g++")
    command = [compiler, "-O1", folder / "writer.cpp", "-o", folder / "writer", "-loctomap", "-loctomath"]
    if subprocess.run(command, capture_output=True).returncode:
        pytest.skip("no liboctomap-dev")
    lines = subprocess.run([folder / "writer", folder], capture_output=True, text=True, check=True).stdout
    return folder, np.array([line.split() for line in lines.splitlines() if line[0] in "-0123456789"], float)


def in_order(rows):
    return rows[np.lexsort(np.round(rows[:, 2::-1], 6).T)]


def test_leaves_are_those_of_octomap(written):
    folder, leaves = written
    found = read_map(folder / "map.ot")
    rows = np.column_stack([found.centres_m, found.sizes_m, found.log_odds])
    assert found.resolution_m == 0.25 and len(set(found.sizes_m)) > 1
    np.testing.assert_allclose(in_order(rows), in_order(leaves), atol=1e-5)


def test_classes_are_those_of_the_log_odds(written):
    folder, _ = written
    exact, classes = read_map(folder / "map.ot"), read_map(folder / "map.bt")
    for occupied in (True, False):
        a, b = exact.cells(occupied), classes.cells(occupied)
        np.testing.assert_allclose(in_order(a), in_order(b), atol=1e-9)
    assert classes.free_volume_m3 == pytest.approx(exact.free_volume_m3)
    assert len(exact.cells(False)) * 0.25**3 == pytest.approx(exact.free_volume_m3)


def test_damaged_files(written, tmp_path):
    folder, _ = written
    for name in ("map.ot", "map.bt"):
        whole = (folder / name).read_bytes()
        for length in (0, 20, len(whole) // 2, len(whole) - 1):
            (tmp_path / name).write_bytes(whole[:length])
            with pytest.raises(Error, match=f"{name}: (line 1|byte)"):
                read_map(tmp_path / name)
    (tmp_path / "map.ot").write_text("ply\nformat ascii 1.0\n")
    with pytest.raises(Error, match="map.ot: line 1: is no OctoMap .bt or .ot file"):
        read_map(tmp_path / "map.ot")
    with pytest.raises(Error, match="cannot be opened: no such file"):
        read_map(tmp_path / "none.ot")
