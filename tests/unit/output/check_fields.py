"""Reads the folders that the unit tests left (one per number of ranks) with meshio and compares them.

Each folder holds `single/` (one grid of the disk), `series/` (two grids in time in one file), `frames/` (three of them in files of their
own, the last one on a finer mesh), `segments/` and `quadrilaterals/` (three of them on other cells). Fails with a sentence; exit code 77: meshio is missing.
"""
import math
import pathlib
import sys
import xml.etree.ElementTree as xml

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


def frame_values(n):
    """The fields of frame n as the unit test wrote them: u on points, flow on triangles."""
    strip = 4 if n < 2 else 7
    u = numpy.arange(2 * (strip + 1)) + float(n)
    flow = numpy.zeros((2 * strip, 3))
    flow[:, :2] = numpy.add.outer(numpy.arange(2 * strip) + float(n), [0, 0.25])
    return u, flow


def check_frames(folder):
    """All frames, by the links of fields.h5, by fields.xdmf, and those on the first mesh by meshio."""
    place = folder / "frames"
    with h5py.File(place / "fields.h5", "r") as file:
        require(set(file) == {"mesh_0", "mesh_2", "fields_0", "fields_1", "fields_2"}, f"fields.h5 holds {set(file)}")
        for n in range(3):
            u, flow = frame_values(n)
            group = file[f"fields_{n}"]
            require(group.attrs["time"] == n / 3, f"time {group.attrs['time']} of frame {n}")
            require((group["u"][()] == u).all() and (group["flow"][()] == flow).all(), f"frame {n} has other values behind the links")
            mesh = file[f"mesh_{group.attrs['mesh']}"]
            require(len(mesh["points"]) == len(u) and len(mesh["triangles"]) == len(flow), f"frame {n} is on another mesh")

    def read(item):
        name, array = item.text.split(":")
        with h5py.File(place / name, "r") as file:
            return file[array][()]

    grids = xml.parse(place / "fields.xdmf").findall("./Domain/Grid[@CollectionType='Temporal']/Grid")
    require([float(grid.find("Time").get("Value")) for grid in grids] == [0, 1 / 3, 2 / 3], "the times of fields.xdmf are others")
    for n, grid in enumerate(grids):
        u, flow = frame_values(n)
        require(len(read(grid.find("Geometry/DataItem"))) == len(u), f"frame {n} has other points")
        require(len(read(grid.find("Topology/DataItem"))) == len(flow), f"frame {n} has other triangles")
        for name, values in ("u", u), ("flow", flow):
            require((read(grid.find(f"Attribute[@Name='{name}']/DataItem")) == values).all(), f"{name} of frame {n} differs")

    with meshio.xdmf.TimeSeriesReader(place / "fields.xdmf") as reader:
        points, cells = reader.read_points_cells()
        for n in range(2):
            time, point_data, cell_data = reader.read_data(n)
            u, flow = frame_values(n)
            require(time == n / 3 and len(points) == len(u), f"meshio finds frame {n} at {time} with {len(points)} points")
            require((point_data["u"] == u).all() and (cell_data["flow"][0] == flow).all(), f"meshio reads other values in frame {n}")


def check_other_cells(folder):
    for name, kind, corners in ("frames_of_segments", "line", 2), ("frames_of_quadrilaterals", "quad", 4):
        with meshio.xdmf.TimeSeriesReader(folder / name / "fields.xdmf") as reader:
            points, cells = reader.read_points_cells()
            found = cells[kind] if isinstance(cells, dict) else next(block.data for block in cells if block.type == kind)
            require(len(points) == 10 and found.shape == (4, corners), f"{name} are {found.shape} on {len(points)} points")
            left = points[found[:, 0], 0]
            require((abs(left - (3 - numpy.arange(4)) / 3) < 1e-15).all(), f"{name} stand at {left}")
            for n in range(3):
                time, _, cell_data = reader.read_data(n)
                require(time == n and (cell_data["u"][0] == numpy.arange(4.0) + n).all(), f"frame {n} on {name} has other values")
def check_row(mesh, kind):
    """Seven cells in a row, numbered 3 k + 1 mod 7."""
    (block,) = mesh.cells
    require(block.type == kind and block.data.shape == (7, 2 if kind == "line" else 4), f"cells are {block.type} of shape {block.data.shape}")
    corners = mesh.points[block.data][:, :, :2]
    k = numpy.arange(7)
    require((corners[:, :, 0].min(axis=1)[(3 * k + 1) % 7] == k / 2).all(), f"the cells of kind {kind} lie elsewhere")
    require((mesh.cell_data["centre"][0][:, :2] == corners.mean(axis=1)).all(), f"the centres belong to other cells of kind {kind}")
    require((mesh.point_data["x"] == mesh.points[:, 0]).all(), "x is not x at its points")
    if kind == "quad":
        a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 1]
        require((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] == 0.25).all(), "some square is not counter-clockwise")


def check_segments_in_time(folder):
    with meshio.xdmf.TimeSeriesReader(folder / "fields.xdmf") as reader:
        points, cells = reader.read_points_cells()
        require(reader.num_steps == 3 and cells[0].type == "line" and len(cells[0].data) == 7, "no series of 7 segments")
        for step in range(3):
            time, point_data, cell_data = reader.read_data(step)
            require(time == step / 4 and (point_data["x"] == step * points[:, 0]).all(), f"step {step} holds other values")
            require((cell_data["centre"][0][:, 0] == points[cells[0].data][:, :, 0].mean(axis=1)).all(), f"centres of step {step}")


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
        check_frames(folder)
        check_other_cells(folder)
        check_row(meshio.read(folder / "segments" / "fields.xdmf"), "line")
        check_row(meshio.read(folder / "quadrilaterals" / "fields.xdmf"), "quad")
        check_segments_in_time(folder / "segments_in_time")
    first = arrays(folders[0])
    require(len(first) == 17, f"{len(first)} arrays: {sorted(first)}")
    for folder in folders[1:]:
        other = arrays(folder)
        require(first.keys() == other.keys(), f"{folder} holds other arrays")
        for name, values in first.items():
            require(values.dtype == other[name].dtype and (values == other[name]).all(), f"{folder}: {name} depends on the number of ranks")
        same = ["single/fields.xdmf", "series/fields.xdmf"] + [str(path.relative_to(folder)) for path in sorted(folder.rglob("frames/**/*.*"))]
        require(len(same) == 7, f"{folder} holds other frames: {same}")
        for path in same:
            require((folders[0] / path).read_bytes() == (folder / path).read_bytes(), f"{folder}: {path} depends on the number of ranks")
    print(f"{len(first)} arrays agree in {len(folders)} folders")


main([pathlib.Path(name) for name in sys.argv[1:]])
