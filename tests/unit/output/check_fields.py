"""Reads the folders that the unit tests left (one per number of ranks) with meshio and compares them.

Each folder holds `single/` (one grid of the disk) and `series/` (two grids in time). Fails with a sentence; exit code 77: meshio is missing.
"""
import math
import pathlib
import sys

try:
    import h5py
    import meshio
    import numpy
except ImportError as missing:
    print(f"skipped: {missing} (Debian: python3-meshio)")
    sys.exit(77)

RINGS = 8  # of the disk after its refinement: 6 N^2 triangles, 1 + 3 N (N + 1) vertices


def require(condition, sentence):
    if not condition:
        sys.exit(sentence)


def check_single(folder):
    mesh = meshio.read(folder / "single" / "fields.xdmf")
    (block,) = mesh.cells
    require(block.type == "triangle", f"cells are {block.type}")
    require(len(block.data) == 6 * RINGS**2, f"{len(block.data)} cells")
    require(len(mesh.points) == 1 + 3 * RINGS * (RINGS + 1), f"{len(mesh.points)} points")
    require(set(block.data.ravel()) == set(range(len(mesh.points))), "some point belongs to no cell")
    require(set(mesh.point_data) == {"u", "gradient"}, f"point fields are {set(mesh.point_data)}")
    require(set(mesh.cell_data) == {"area"}, f"cell fields are {set(mesh.cell_data)}")
    for name, values in mesh.point_data.items():
        require(numpy.isfinite(values).all(), f"{name} is not finite")

    x, y = mesh.points[:, 0], mesh.points[:, 1]
    require((mesh.point_data["u"] == x * x + 2 * y).all(), "u is not x^2 + 2 y at its points")
    require((mesh.point_data["gradient"] == numpy.column_stack([2 * x, 0 * x + 2, 0 * x])).all(), "the gradient is not (2 x, 2, 0)")
    a, b, c = (numpy.column_stack([x, y])[block.data[:, i]] for i in range(3))
    area = ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
    require((area > 0).all(), "some cell is not counter-clockwise")
    require(abs(mesh.cell_data["area"][0] - area).max() < 1e-15, "the areas belong to other cells")
    polygon = 3 * RINGS * math.sin(math.pi / (3 * RINGS))  # regular, 6 N corners
    require(abs(area.sum() - polygon) < 1e-12, "the cells do not fill the disk")


def check_series(folder):
    with meshio.xdmf.TimeSeriesReader(folder / "series" / "fields.xdmf") as reader:
        points, cells = reader.read_points_cells()
        require(reader.num_steps == 2, f"{reader.num_steps} steps")
        for step in range(2):
            time, point_data, _ = reader.read_data(step)
            require(time == 0.5 * step, f"time {time} of step {step}")
            require((point_data["u"] == time * points[:, 0]).all(), f"u of step {step} is not t x")


def arrays(folder):
    found = {}
    for path in sorted(folder.glob("*/fields.h5")):
        with h5py.File(path, "r") as file:
            file.visititems(lambda name, item: found.update({f"{path.parent.name}/{name}": item[()]}) if isinstance(item, h5py.Dataset) else None)
    return found


def main(folders):
    for folder in folders:
        check_single(folder)
        check_series(folder)
    first = arrays(folders[0])
    require(len(first) == 9, f"{len(first)} arrays: {sorted(first)}")
    for folder in folders[1:]:
        other = arrays(folder)
        require(first.keys() == other.keys(), f"{folder} holds other arrays")
        for name, values in first.items():
            require(values.dtype == other[name].dtype and (values == other[name]).all(), f"{folder}: {name} depends on the number of ranks")
        for path in ("single/fields.xdmf", "series/fields.xdmf"):
            require((folders[0] / path).read_text() == (folder / path).read_text(), f"{folder}: {path} depends on the number of ranks")
    print(f"{len(first)} arrays agree in {len(folders)} folders")


main([pathlib.Path(name) for name in sys.argv[1:]])
