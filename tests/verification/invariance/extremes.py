"""Data far from one: only what acts and what can touch sets a scale.

usage: extremes.py PROGRAM SCRATCH_FOLDER [arguments of unittest]
"""
import csv
import json
import math
import os
import pathlib
import subprocess
import sys
import unittest
import xml.etree.ElementTree as xml

try:
    import h5py
except ImportError as missing:
    print(f"skipped: {missing} (Debian: python3-h5py)")
    sys.exit(77)

PROGRAM, SCRATCH = sys.argv[1], pathlib.Path(sys.argv[2])


def run(name, blocks):
    """`blocks`: {"scene": {"model": "obstacle", "data": {...}}, ...}; the exit code, the last line and the summary."""
    folder = SCRATCH / name
    folder.mkdir(parents=True, exist_ok=True)
    deck = xml.Element("ParameterList", name="thixis")

    def put(parent, entries):
        for key, value in entries.items():
            if isinstance(value, dict):
                put(xml.SubElement(parent, "ParameterList", name=key), value)
            else:
                kind = {bool: "bool", int: "int", float: "double", str: "string", tuple: "Array(double)"}[type(value)]
                text = str(value).lower() if kind == "bool" else str(value)
                xml.SubElement(parent, "Parameter", name=key, type=kind, value=text.replace("(", "{").replace(")", "}") if kind[0] == "A" else text)

    put(deck, {"output": {"fields": "none"}, **blocks})
    xml.ElementTree(deck).write(folder / "deck.xml")
    result = subprocess.run([PROGRAM, "run", str(folder / "deck.xml"), "--output", str(folder / "run")], capture_output=True, text=True,
                            timeout=120)
    summary = folder / "run" / "summary.json"
    return result.returncode, result.stdout + result.stderr, json.loads(summary.read_text()) if summary.exists() else {}


def fields(folder):
    """Of every frame, {name and number of the value: value}."""
    frames = []
    with h5py.File(folder / "fields.h5") as file:
        for frame in sorted(name for name in file if name.startswith("fields_")):
            frames.append({f"{name}_{i}": float(value) for name in file[frame] for i, value in enumerate(file[frame][name][()])})
    return frames


SOLVERS = {
    "default": {},
    "direct": {"solver": "direct"},
    "reduced": {"form": "reduced", "solver": "cg", "preconditioner": "muelu"},
}
METHODS = os.environ.get("THIXIS_METHODS", "fem,dg,hho,fv").split(",")  # those that the program has
OTHER_METHODS = [method for method in ({"name": "fem", "degree": 3}, {"name": "hho", "degree": 1}, {"name": "dg", "degree": 2})
                 if method["name"] in METHODS]
MESH = {"cells per side": 8}


class Extremes(unittest.TestCase):
    def solved(self, name, blocks):
        code, said, summary = run(name, blocks)
        self.assertEqual(code, 0, said[-1500:])
        self.assertNotIn("did not settle", said)
        return summary

    def close(self, value, expected, relative):
        self.assertLessEqual(abs(value - expected), relative * abs(expected), (value, expected))

    def test_an_obstacle_out_of_reach_is_none(self):
        for psi in ("-1e4", "-1e10", "-1e14"):
            for solver, linear in SOLVERS.items():
                with self.subTest(psi=psi, solver=solver):
                    scene = {"model": "obstacle", "data": {"f": "-8", "g": "0", "psi": psi}}
                    found = self.solved("none", {"scene": scene, "mesh": MESH, "linear": linear})
                    self.close(found["energy_norm"], 1.4866810967, 1e-9)
                    self.assertEqual(found["active_points"], 0)

    def test_an_obstacle_out_of_reach_is_none_to_every_method(self):
        def over(psi, method):
            scene = {"model": "obstacle", "data": {"f": "-8", "g": "0", "psi": psi}}
            return self.solved("none", {"scene": scene, "mesh": MESH, "method": method})

        for method in OTHER_METHODS:
            near, far = over("-2", method), over("-1e10", method)
            with self.subTest(method=method):
                self.close(far["energy_norm"], near["energy_norm"], 1e-8)
                self.assertEqual(far["active_points"], 0)

    def test_an_obstacle_out_of_reach_in_one_part_is_none_there(self):
        def with_floor(floor, linear):
            scene = {"model": "obstacle", "data": {"f": "-8", "g": "0", "psi": f"x < 0.5 ? -0.05 : {floor}"}}
            return self.solved("part", {"scene": scene, "mesh": {"cells per side": 16}, "linear": linear})

        for solver, linear in SOLVERS.items():
            expected = with_floor("-10", linear)
            self.assertGreater(expected["active_points"], 0)
            for floor in ("-1e6", "-1e10"):
                with self.subTest(floor=floor, solver=solver):
                    found = with_floor(floor, linear)
                    self.close(found["energy_norm"], expected["energy_norm"], 1e-8)
                    self.assertEqual(found["active_points"], expected["active_points"])

    def test_a_membrane_far_below_does_not_matter(self):
        alone = {"model": "obstacle", "data": {"f": "-8", "g": "0", "psi": "-1e4"}}
        expected = self.solved("alone", {"scene": alone, "mesh": MESH})["energy_norm"]
        for below in ("-1e3", "-1e6"):
            with self.subTest(below=below):
                scene = {"model": "membranes", "data": {"f1": "-8", "g1": "0", "g2": below}}
                self.close(self.solved("far", {"scene": scene, "mesh": MESH})["energy_norm"], expected, 1e-8)

    TWO = {"mu1": "1", "mu2": "2", "f1": "-10", "f2": "1", "g1": "0.1", "g2": "0"}
    COARSE = {"cells per side": 4, "refinements": 1}

    def test_only_differences_of_heights_matter(self):
        for method in ({"name": "fem"}, {"name": "fem", "degree": 2}, {"name": "hho"}, {"name": "dg"}):
            if method["name"] not in METHODS:
                continue
            at_zero = self.solved("zero", {"scene": {"model": "membranes", "data": self.TWO}, "mesh": self.COARSE, "method": method})
            for height in ("1e3", "-1e6", "1e9"):
                with self.subTest(method=method, height=height):
                    data = {**self.TWO, "g1": f"{height} + 0.1", "g2": height}
                    found = self.solved("shifted", {"scene": {"model": "membranes", "data": data}, "mesh": self.COARSE, "method": method})
                    self.assertEqual(found["active_points"], at_zero["active_points"])
                    self.assertEqual(found["newton_iterations"], at_zero["newton_iterations"])
                    self.close(found["energy_norm"], at_zero["energy_norm"], max(1e-8, 1e-15 * abs(float(height)) / 0.1))

    def test_heights_are_written_as_they_were_given(self):
        """In probes, series and fields; gaps and multipliers as around zero."""
        def written(model, method, height):
            above, below = f"{height} + 0.1 + 0.02*x", f"{height} - 0.01*y"
            if model == "obstacle":
                data = {"f": "-8", "g": above, "psi": below}
            else:
                data = {"f1": "-8", "f2": "1", "g1": above, "g2": below}
            if model == "parabolic membranes":
                data["initial"] = {"u1": above, "u2": below}
            blocks = {"scene": {"model": model, "data": data}, "mesh": MESH, "method": method, "linear": SOLVERS["direct"],
                      "output": {"fields": "all", "probes": (0.4, 0.3, 0.05, 0.5, 0.0, 0.25)}}
            if model == "parabolic membranes":
                blocks["time"] = {"step": 0.1, "end": 0.2}
            self.solved("written", blocks)
            folder = SCRATCH / "written" / "run"
            table = folder / ("probes.csv" if model != "parabolic membranes" else "series.csv")
            rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(table.read_text().splitlines())]
            return rows + fields(folder)

        height = 1e3
        for model, method in (("obstacle", {"name": "fem", "degree": 1}), ("obstacle", {"name": "hho", "degree": 1}),
                              ("membranes", {"name": "dg", "degree": 1}), ("parabolic membranes", {"name": "fem", "degree": 2})):
            if method["name"] not in METHODS:
                continue
            for at_zero, raised in zip(written(model, method, 0.0), written(model, method, height), strict=True):
                for key, value in at_zero.items():
                    by = height if key.split("_")[0] in ("u", "u1", "u2") else 0
                    with self.subTest(model=model, method=method, key=key):
                        self.assertLessEqual(abs(raised[key] - by - value), 1e-6)

    def test_the_unit_of_force_does_not_matter(self):
        def in_units(factor, method, solver):
            data = {**self.TWO, **{key: f"{factor!r}*({self.TWO[key]})" for key in ("mu1", "mu2", "f1", "f2")}}
            return self.solved("forces", {"scene": {"model": "membranes", "data": data}, "mesh": self.COARSE, "method": method,
                                          "linear": SOLVERS[solver]})

        for method, solver in (({"name": "fem"}, "direct"), ({"name": "fem", "degree": 2}, "direct"), ({"name": "fem"}, "default"),
                               ({"name": "fem"}, "reduced"), ({"name": "hho", "degree": 1}, "direct")):
            if method["name"] not in METHODS:
                continue
            expected = in_units(1.0, method, solver)
            for factor in (1e-8, 1e8):
                with self.subTest(method=method, solver=solver, factor=factor):
                    found = in_units(factor, method, solver)
                    self.assertEqual(found["active_points"], expected["active_points"])
                    self.assertEqual(found["newton_iterations"], expected["newton_iterations"])
                    self.close(found["energy_norm"], math.sqrt(factor) * expected["energy_norm"], 1e-8)

    def test_tensions_that_differ_by_orders_end_with_a_settled_set(self):
        """The stiff membrane is an obstacle to the soft one, or presses it flat."""
        rigid = self.solved("rigid", {"scene": {"model": "obstacle", "data": {"f": "-10", "g": "0.1", "psi": "0"}}, "mesh": self.COARSE})
        for solver, linear in SOLVERS.items():
            with self.subTest(solver=solver):
                data = {"mu1": "1", "mu2": "1e8", "f1": "-10", "f2": "1", "g1": "0.1", "g2": "0"}
                found = self.solved("stiff", {"scene": {"model": "membranes", "data": data}, "mesh": self.COARSE, "linear": linear})
                self.close(found["energy_norm"], rigid["energy_norm"], 1e-5)
                self.assertEqual(found["active_points"], rigid["active_points"])
                data = {"mu1": "1e8", "mu2": "1", "f1": "-10", "f2": "10", "g1": "0.1", "g2": "0"}
                found = self.solved("soft", {"scene": {"model": "membranes", "data": data}, "mesh": self.COARSE, "linear": linear})
                self.close(found["energy_norm"], rigid["energy_norm"], 1e-5)
                self.assertEqual(found["active_points"], rigid["active_points"])

    def test_tensions_that_differ_by_orders_are_no_matter_to_any_method(self):
        for method in OTHER_METHODS:
            def solved(model, data):
                scene = {"model": model, "data": {**data, "f1" if model == "membranes" else "f": "-10"}}
                return self.solved("contrast", {"scene": scene, "mesh": self.COARSE, "method": method})

            rigid = solved("obstacle", {"g": "0.1", "psi": "0"})
            for mu1, mu2, f2 in (("1", "1e8", "1"), ("1e8", "1", "10")):
                with self.subTest(method=method, mu1=mu1, mu2=mu2):
                    found = solved("membranes", {"mu1": mu1, "mu2": mu2, "f2": f2, "g1": "0.1", "g2": "0"})
                    self.close(found["energy_norm"], rigid["energy_norm"], 1e-5)
                    if method["degree"] != 2:  # where functions of degree 2 have no mean, rounding tells who is in contact
                        self.assertEqual(found["active_points"], rigid["active_points"])

    def test_tiny_cells_are_judged_by_their_weight(self):
        mesh = SCRATCH / "graded" / "graded.msh"
        mesh.parent.mkdir(parents=True, exist_ok=True)
        write_graded(mesh)
        norms = {}
        for solver in ("default", "direct"):
            scene = {"model": "obstacle", "data": {"f": "-8", "g": "0", "psi": "-0.05"}}
            found = self.solved("graded", {"scene": scene, "mesh": {"generator": "file", "file": "graded.msh"}, "linear": SOLVERS[solver]})
            norms[solver] = found["energy_norm"]
            self.assertGreater(found["active_points"], 0)
        self.close(norms["default"], norms["direct"], 1e-8)

    def test_short_steps_are_judged_by_what_acts(self):
        for step in (1e-3, 1e-9, 1e-12):
            with self.subTest(step=step):
                data = {**self.TWO, "initial": {"u1": "0.1", "u2": "0"}}
                found = self.solved("short", {"scene": {"model": "parabolic membranes", "data": data}, "mesh": self.COARSE,
                                              "time": {"step": step, "end": 3 * step}})
                self.assertLessEqual(max(found["kkt"][key] for key in ("infeasible", "negative", "complementary", "equilibrium")), 1e-6)


def write_graded(path, rings=40, sectors=8, ratio=0.8, radius=1.0):
    """A quarter of a disk whose cells shrink towards the corner, areas from 4e-2 to 1e-9."""
    points = [(0.0, 0.0)]
    for k in range(rings):
        for i in range(sectors + 1):
            angle = math.pi / 2 * i / sectors
            points.append((radius * ratio**k * math.cos(angle), radius * ratio**k * math.sin(angle)))
    at = lambda k, i: 2 + k * (sectors + 1) + i
    rim = [(at(0, i), at(0, i + 1)) for i in range(sectors)]
    for i in (0, sectors):
        rim += [(at(k, i), at(k + 1, i)) for k in range(rings - 1)] + [(at(rings - 1, i), 1)]
    cells = [(1, at(rings - 1, i), at(rings - 1, i + 1)) for i in range(sectors)]
    for k in range(rings - 1):
        for i in range(sectors):
            cells += [(at(k, i), at(k, i + 1), at(k + 1, i)), (at(k, i + 1), at(k + 1, i + 1), at(k + 1, i))]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "2", '1 1 "rim"', '2 2 "sheet"', "$EndPhysicalNames", "$Nodes",
             str(len(points))]
    lines += [f"{n + 1} {x!r} {y!r} 0" for n, (x, y) in enumerate(points)]
    lines += ["$EndNodes", "$Elements", str(len(rim) + len(cells))]
    lines += [f"{n + 1} 1 2 1 1 {a} {b}" for n, (a, b) in enumerate(rim)]
    lines += [f"{n + 1 + len(rim)} 2 2 2 1 {a} {b} {c}" for n, (a, b, c) in enumerate(cells)]
    path.write_text("\n".join(lines + ["$EndElements", ""]))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
