"""What a run leaves behind: exit code, terminal, log, summary, history, deck, fields.

usage: program.py PROGRAM MPIEXEC SCRATCH_FOLDER [arguments of unittest]
"""
import csv
import json
import pathlib
import shutil
import subprocess
import sys
import unittest
import xml.etree.ElementTree as xml

PROGRAM, MPIEXEC, SCRATCH = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
INPUTS = pathlib.Path(__file__).resolve().parents[3] / "inputs" / "membranes"
DECK = INPUTS / "smooth_contact.xml"
COARSE = ["mesh/refinements=2", "mesh/cells per rank=50", "expect/energy error between={1e-3,2e-3}"]  # 1024 cells

SUMMARY_KEYS = set(
    "verdict exit_code model case method degree ranks threads cells unknowns nonzeros newton_iterations newton_finest linear_iterations "
    "energy_error energy_norm estimate estimate_published effectivity effectivity_published kkt active_points time memory_mb versions".split())
HISTORY_HEADER = "level time_step time newton linear active changed residual eta_disc eta_lin eta_alg eta_total eta_time promise energy_error seconds".split()


class Run:
    """`thixis run` into a fresh folder."""

    def __init__(self, name, sets=(), ranks=1, deck=DECK, flags=()):
        self.folder = SCRATCH / name
        shutil.rmtree(self.folder, ignore_errors=True)
        launcher = [] if ranks == 1 else [MPIEXEC, "-n", str(ranks)]
        options = [word for assignment in sets for word in ("--set", assignment)]
        result = subprocess.run([*launcher, PROGRAM, "run", str(deck), "--output", str(self.folder), *options, *flags],
                                capture_output=True, text=True, timeout=120)
        self.exit_code, self.out, self.err = result.returncode, result.stdout, result.stderr

    @property
    def summary(self):
        return json.loads((self.folder / "summary.json").read_text())

    @property
    def history(self):
        with open(self.folder / "history.csv", newline="") as file:
            return list(csv.DictReader(file))


OBSTACLE = {"scene/model": "obstacle", "scene/data/psi": "-1"}


class Bounds(unittest.TestCase):
    """What the last sentence says of error and bound."""

    def verdict(self, name, **entries):
        SCRATCH.mkdir(parents=True, exist_ok=True)
        deck = SCRATCH / f"{name}.xml"
        deck.write_text('<ParameterList name="thixis"/>')
        run = Run(name, [f"{path}={value}" for path, value in {**entries, "stopping/estimate": "true"}.items()], deck=deck)
        self.assertEqual(run.exit_code, 0, run.out + run.err)
        return run.summary["verdict"]

    def test_an_exact_solution_of_the_disk_is_none_of_the_polygon(self):
        of_the_disk = {**OBSTACLE, "scene/data/u": "1 - r^2", "scene/data/f": "4", "mesh/generator": "disk", "mesh/rings": "1", "method/degree": "2"}
        clause = "(guaranteed), less than the error: the exact solution does not fit the data, or not the polygon that the mesh is"
        self.assertIn(clause, self.verdict("disk", **of_the_disk, **{"scene/data/g": "0"}))
        of_the_polygon = self.verdict("polygon", **of_the_disk)
        self.assertIn("(guaranteed)", of_the_polygon)
        self.assertNotIn("less than the error", of_the_polygon)

    def test_an_exact_solution_of_other_data_is_named(self):
        self.assertIn("less than the error", self.verdict("wrong", **{**OBSTACLE, "scene/data/u": "1 + x", "scene/data/f": "-8"}))

    def test_the_part_of_time_is_not_larger_than_the_whole(self):
        coarse = {"scene/model": "parabolic membranes", "scene/data/f1": "-8", "scene/data/g1": "0.1", "scene/data/g2": "0",
                  "scene/data/initial/u1": "0.1", "scene/data/initial/u2": "0", "time/step": "0.1", "time/end": "0.05", "method/degree": "2"}
        verdict = self.verdict("time", **coarse)
        self.assertIn("most of it for the lengths of the steps", verdict)
        self.assertEqual(verdict.count("e-01"), 1, verdict)


class Results(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.run_1 = Run("solved_1", COARSE)
        cls.run_3 = Run("solved_3", COARSE, ranks=3)

    def test_a_solved_run_exits_0_and_ends_with_its_verdict(self):
        for run in (self.run_1, self.run_3):
            self.assertEqual(run.exit_code, 0, run.out + run.err)
            verdict = run.summary["verdict"]
            self.assertTrue(verdict.startswith("solved in "), verdict)
            self.assertEqual(run.out.splitlines()[-1], verdict)
            self.assertEqual((run.folder / "log.txt").read_text().splitlines()[-1], verdict)
            self.assertEqual((run.folder / "log.txt").read_text(), run.out)

    def test_the_summary_has_every_key(self):
        summary = self.run_1.summary
        self.assertEqual(set(summary), SUMMARY_KEYS)
        self.assertEqual(set(summary["unknowns"]), {"all", "global"})
        self.assertEqual(set(summary["kkt"]), {"infeasible", "negative", "complementary", "between_nodes", "equilibrium"})
        self.assertEqual(set(summary["time"]), {"total", "mesh", "assembly", "preconditioner", "linear", "estimate", "output"})
        self.assertEqual((summary["model"], summary["case"], summary["method"]), ("membranes", "smooth contact", "fem"))
        self.assertEqual((summary["cells"], summary["unknowns"]["all"], summary["unknowns"]["global"]), (1024, 1443, 962))
        self.assertGreater(summary["nonzeros"], 0)
        self.assertGreater(summary["memory_mb"], 0)
        self.assertGreaterEqual(summary["time"]["total"], sum(summary["time"][part] for part in ("mesh", "assembly", "linear", "output")))

    def test_the_summary_is_the_same_on_three_ranks(self):
        one, three = self.run_1.summary, self.run_3.summary
        self.assertEqual((one["ranks"], three["ranks"]), (1, 3))
        for key in ("cells", "unknowns", "newton_iterations", "newton_finest", "active_points", "nonzeros"):
            self.assertEqual(one[key], three[key], key)
        for key in ("energy_error", "energy_norm"):
            self.assertAlmostEqual(one[key] / three[key], 1, delta=1e-8)

    def test_the_history_has_a_row_per_newton_step(self):
        for run in (self.run_1, self.run_3):
            rows = run.history
            self.assertEqual(list(rows[0]), HISTORY_HEADER)
            self.assertEqual(len(rows), run.summary["newton_iterations"])
            for level in range(3):
                steps = [int(row["newton"]) for row in rows if int(row["level"]) == level]
                self.assertEqual(steps, list(range(1, len(steps) + 1)))
            self.assertEqual(int(rows[-1]["active"]), run.summary["active_points"])
            self.assertEqual(sum(int(row["linear"]) for row in rows), run.summary["linear_iterations"])

    def test_the_deck_as_run_gives_the_same_result_again(self):
        again = Run("again", deck=self.run_1.folder / "deck.xml")
        self.assertEqual(again.exit_code, 0, again.out + again.err)
        for key in SUMMARY_KEYS - {"time", "memory_mb"}:
            self.assertEqual(again.summary[key], self.run_1.summary[key], key)
        entries = {entry.get("name"): entry.get("value") for entry in xml.parse(self.run_1.folder / "deck.xml").iter("Parameter")}
        self.assertEqual(entries["refinements"], "2")
        self.assertEqual(entries["c-function"], "min", "a default is not filled in")

    def test_fields_are_read_by_meshio_and_do_not_depend_on_the_ranks(self):
        try:
            import meshio
            import numpy
        except ImportError as missing:
            self.skipTest(f"{missing} (Debian: python3-meshio)")
        meshes = [meshio.read(run.folder / "fields.xdmf") for run in (self.run_1, self.run_3)]
        for mesh in meshes:
            (block,) = mesh.cells
            self.assertEqual((block.type, len(block.data), len(mesh.points)), ("triangle", 1024, 545))
            self.assertEqual(set(mesh.point_data), {"u1", "u2", "lambda", "gap", "active"})
            values = {name: array.ravel() for name, array in mesh.point_data.items()}
            for name, array in values.items():
                self.assertTrue(numpy.isfinite(array).all(), name)
            self.assertEqual(int(values["active"].sum()), self.run_1.summary["active_points"])
            self.assertLess(abs(values["u1"] - values["u2"] - values["gap"]).max(), 1e-14)
            self.assertGreaterEqual(values["gap"].min(), -1e-10)
            self.assertGreaterEqual(values["lambda"].min(), -1e-10)
            self.assertLess(abs(values["gap"] * values["lambda"]).max(), 1e-10)
        one, three = meshes
        self.assertTrue((one.points == three.points).all())
        self.assertTrue((one.cells[0].data == three.cells[0].data).all())
        for name, values in one.point_data.items():
            self.assertLess(abs(values - three.point_data[name]).max(), 1e-8, name)


class ExitCodes(unittest.TestCase):
    def test_a_run_stopped_after_one_step_exits_3_on_every_number_of_ranks(self):
        for ranks in (1, 2, 3):
            run = Run(f"one_step_{ranks}", [*COARSE, "newton/start=cold", "newton/max iterations=1"], ranks)
            self.assertEqual(run.exit_code, 3, run.out + run.err)
            verdict = run.summary["verdict"]
            self.assertTrue(verdict.startswith("not converged: "), verdict)
            self.assertEqual((run.folder / "log.txt").read_text().splitlines()[-1], verdict)
            self.assertEqual(run.summary["exit_code"], 3)
            self.assertEqual(len(run.history), 1)
            figures = f"{float(run.history[0]['residual']):.4e}"  # of the last step
            self.assertIn(figures, run.out)
            self.assertTrue((run.folder / "fields.h5").exists())

    def test_no_steps_only_count_unknowns(self):
        SCRATCH.mkdir(parents=True, exist_ok=True)
        deck = SCRATCH / "count.xml"
        deck.write_text('<ParameterList name="thixis"><ParameterList name="scene"><Parameter name="model" type="string" value="membranes"/>'
                        '<Parameter name="case" type="string" value="smooth contact"/></ParameterList></ParameterList>')
        run = Run("counted", ["newton/max iterations=0", "mesh/refinements=4"], deck=deck)
        self.assertEqual(run.exit_code, 0, run.out + run.err)
        self.assertTrue(run.summary["verdict"].startswith("not solved"), run.summary["verdict"])
        self.assertEqual(run.summary["unknowns"]["all"], 24195)
        self.assertIsNone(run.summary["energy_error"])

    def test_an_expectation_that_does_not_hold_exits_4(self):
        for ranks in (1, 2):
            run = Run(f"missed_{ranks}", [*COARSE, "expect/energy error at most=1e-3"], ranks)
            self.assertEqual(run.exit_code, 4, run.out + run.err)
            self.assertIn("energy error 0.0018818 is above 0.001", run.summary["verdict"])

    def test_an_output_folder_that_is_a_file_exits_5(self):
        SCRATCH.mkdir(parents=True, exist_ok=True)
        (SCRATCH / "a_file").write_text("")
        result = subprocess.run([PROGRAM, "run", str(DECK), "--output", str(SCRATCH / "a_file")], capture_output=True, text=True)
        self.assertEqual(result.returncode, 5)
        self.assertIn("is a file", result.stderr)


class Guaranteed(unittest.TestCase):
    def test_a_target_that_can_not_be_reached_exits_4_with_the_best_bound(self):
        bounds = []
        for ranks in (1, 2, 3):
            run = Run(f"out_of_reach_{ranks}", ["stopping/target=1e-9", "adapt/max unknowns=1000", "mesh/cells per rank=20"], ranks,
                      deck=INPUTS / "target.xml")
            self.assertEqual(run.exit_code, 4, run.out + run.err)
            summary = run.summary
            self.assertEqual(summary["exit_code"], 4)
            self.assertRegex(summary["verdict"], r"^target missed: energy error at most .* \(up to quadrature of the data\), not 1e-09; refinement ended by "
                                                 r"adapt/max unknowns = 1000; allow more of them, or take a higher method/degree; besides, not as expected: ")
            levels = [float(row["eta_total"]) for row in run.history if not row["newton"]]
            bounds.append(summary["estimate"]["total"])
            self.assertAlmostEqual(bounds[-1] / min(levels), 1, delta=1e-12)
            self.assertLessEqual(summary["energy_error"], bounds[-1])
            self.assertLessEqual(summary["unknowns"]["all"], 1000)
            self.assertTrue((run.folder / "fields.h5").exists())
        self.assertLess(max(bounds) / min(bounds) - 1, 1e-6)

    def test_cells_gather_at_the_edge_of_contact(self):
        try:
            import meshio
            import numpy
        except ImportError as missing:
            self.skipTest(f"{missing} (Debian: python3-meshio)")
        run = Run("gathered", ["stopping/target=1e-3"], deck=INPUTS / "adaptive_mesh.xml")
        self.assertEqual(run.exit_code, 0, run.out + run.err)
        mesh = meshio.read(run.folder / "fields.xdmf")
        self.assertEqual(set(mesh.cell_data), {"eta_disc", "eta_lin", "eta_alg"})
        for name, (values,) in mesh.cell_data.items():
            self.assertTrue(numpy.isfinite(values).all() and (values >= 0).all(), name)
        centre = mesh.points[:, :2][mesh.cells[0].data].mean(axis=1) - 0.5
        near = abs(numpy.hypot(centre[:, 0], centre[:, 1]) - 1 / 3) < 0.05  # a ring with 21 % of the area
        self.assertGreater(near.mean(), 1.5 * 0.21)

    def test_the_adaptive_rule_saves_two_of_three_iterations(self):
        deck = INPUTS / "adaptive_stopping.xml"
        adaptive = Run("adaptive_rule", deck=deck).summary
        without = SCRATCH / "exact_rule.xml"  # what takes no part in the rule exact
        without.write_text("".join(line for line in deck.read_text().splitlines(True) if "gamma" not in line and "check every" not in line))
        exact = Run("exact_rule", ["stopping/rule=exact", "adapt/max levels=0"], deck=without).summary
        self.assertLess(3 * adaptive["linear_iterations"], exact["linear_iterations"])
        self.assertLess(adaptive["estimate"]["total"], 1.05 * exact["estimate"]["total"])


class Choices(unittest.TestCase):
    def test_quiet_shows_the_verdict_only(self):
        for ranks in (1, 2):
            run = Run(f"quiet_{ranks}", COARSE, ranks, flags=["--quiet"])
            self.assertEqual(run.exit_code, 0)
            self.assertEqual((run.out, run.err), (run.summary["verdict"] + "\n", ""))

    def test_fields_and_history_can_be_left_out(self):
        run = Run("without", [*COARSE, "output/fields=none", "output/history=false"])
        self.assertEqual({path.name for path in run.folder.iterdir()}, {"summary.json", "deck.xml", "log.txt"})

    def test_fields_can_be_chosen(self):
        run = Run("some", [*COARSE, "output/fields=gap, lambda"])
        names = {attribute.get("Name") for attribute in xml.parse(run.folder / "fields.xdmf").iter("Attribute")}
        self.assertEqual(names, {"gap", "lambda"})


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
