"""Interrupted runs go on from their checkpoint as if nothing had happened.

restart.py SCENARIO PROGRAM -- LAUNCHER...   (RANKS in the launcher stands for the number of ranks)
"""
import csv
import json
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
CONTACT = HERE / "contact.xml"
GO_ON = ["--set", "newton/max iterations=200"]
scenario, program, launcher = sys.argv[1], sys.argv[2], sys.argv[4:]
scratch = Path.cwd() / scenario


def thixis(*arguments, ranks=1, expect=0, folder=None):
    """Runs the program; returns what it printed."""
    command = [str(ranks) if word == "RANKS" else word for word in launcher] if ranks > 1 else []
    done = subprocess.run([*command, program, *map(str, arguments)], cwd=folder or scratch, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, universal_newlines=True)
    assert done.returncode == expect, f"exit code {done.returncode}, not {expect}, of {arguments} on {ranks}:\n{done.stdout}"
    return done.stdout


def interrupted(output, steps, *arguments, ranks=1):
    """Runs the contact deck for some steps only."""
    printed = thixis("run", CONTACT, "--output", output, "--set", f"newton/max iterations={steps}", *arguments, ranks=ranks, expect=3)
    found = summary(output)
    assert found["exit_code"] == 3 and found["verdict"].startswith(f"not converged: No convergence in {steps} step"), found["verdict"]
    assert "the residual is" in found["verdict"] and "not below" in found["verdict"], found["verdict"]
    assert f"thixis restart {output}/checkpoint.h5 --set \"newton/max iterations=" in printed, printed
    return f"{output}/checkpoint.h5"


def summary(output):
    return json.loads((scratch / output / "summary.json").read_text())


def newton_steps(output):
    """(level, step) of every Newton step in the history."""
    with open(scratch / output / "history.csv") as file:
        return [(int(row["level"]), int(row["newton"])) for row in csv.DictReader(file) if row["active"]]


def krylov_iterations(output):
    with open(scratch / output / "history.csv") as file:
        return sum(int(row["linear"]) for row in csv.DictReader(file) if row["active"])


def expect_same(output, whole):
    a, b = summary(output), summary(whole)
    for key in ("newton_iterations", "newton_finest", "active_points", "unknowns", "nonzeros"):
        assert a[key] == b[key], f"{key}: {a[key]} behind the restart, {b[key]} without"
    assert abs(a["energy_error"] - b["energy_error"]) <= 1e-10 * b["energy_error"], (a["energy_error"], b["energy_error"])


def from_ranks(ranks):
    thixis("run", CONTACT, "--output", "whole")
    interrupted("one", 1, ranks=ranks)
    checkpoint = interrupted("cut", 3, ranks=ranks)
    # into another folder: a history of its own; then into the same one, which goes on
    thixis("restart", checkpoint, *GO_ON, "--output", "elsewhere", ranks=2)
    expect_same("elsewhere", "whole")
    assert newton_steps("elsewhere") == newton_steps("whole")[3:]
    assert summary("cut")["exit_code"] == 3
    thixis("restart", checkpoint, *GO_ON, ranks=1)
    expect_same("cut", "whole")
    assert newton_steps("cut") == newton_steps("whole")
    assert summary("cut")["linear_iterations"] == krylov_iterations("cut")
    log = (scratch / "cut/log.txt").read_text()
    # results that were moved go on where they are
    interrupted("moved", 3, ranks=ranks)
    (scratch / "moved").rename(scratch / "here")
    thixis("restart", "here/checkpoint.h5", *GO_ON, "--output", "here/")
    assert newton_steps("here") == newton_steps("whole") and (scratch / "here/checkpoint.h5").exists()
    assert "No convergence in 3 steps" in log and "goes on from level 3, Newton step 3" in log and "solved in" in log, log


def nested():
    start = ["--set", "newton/start=nested", "--set", "newton/sweeps=0"]
    thixis("run", CONTACT, "--output", "whole", *start)
    checkpoint = interrupted("cut", 2, *start, ranks=2)
    level = newton_steps("cut")[-1][0]
    assert level < 3, "the run must be interrupted below the finest level"
    # a second interruption, two steps later; the limit counts the steps since the restart
    thixis("restart", checkpoint, expect=3)
    assert newton_steps("cut") == newton_steps("whole")[:len(newton_steps("cut"))]
    assert len(newton_steps("cut")) >= 4 and summary("cut")["newton_iterations"] == len(newton_steps("cut"))
    thixis("restart", checkpoint, *GO_ON, ranks=3)
    expect_same("cut", "whole")
    assert newton_steps("cut") == newton_steps("whole")
    # what is saved on the finest level goes on to finer ones
    thixis("run", CONTACT, "--output", "finer", *start, "--set", "mesh/refinements=4")
    checkpoint = "coarser/checkpoint.h5"
    thixis("run", CONTACT, "--output", "coarser", *start, "--set", "output/checkpoint every=1000")
    thixis("restart", checkpoint, "--set", "mesh/refinements=4", ranks=2)
    a, b = summary("coarser"), summary("finer")
    assert a["cells"] == b["cells"] and abs(a["energy_error"] - b["energy_error"]) <= 1e-8 * b["energy_error"]


def mesh_file():
    """The mesh file is found relative to the deck, wherever the restart is called from."""
    decks, calls = scratch / "decks", scratch / "calls"
    decks.mkdir()
    calls.mkdir()
    shutil.copy(HERE.parent / "unit/mesh/files/l_shape_41.msh", decks / "plate.msh")
    (decks / "plate.xml").write_text((HERE / "plate.xml").read_text())
    thixis("run", "decks/plate.xml", "--output", "whole")
    thixis("run", "decks/plate.xml", "--output", "cut", "--set", "newton/max iterations=1", expect=3, ranks=2)
    printed = thixis("restart", "cut/checkpoint.h5", *GO_ON, "--set", "scene/boundary/clamped side/kind=neumann", "--output", "other",
                     expect=2, ranks=2)
    assert "belongs to another model, mesh or method" in printed, printed
    thixis("restart", "../cut/checkpoint.h5", *GO_ON, folder=calls)
    a, b = summary("cut"), summary("whole")
    assert a["exit_code"] == 0 and a["newton_iterations"] == b["newton_iterations"]
    assert abs(a["energy_norm"] - b["energy_norm"]) <= 1e-10 * b["energy_norm"]
    # what has taken the place of the mesh is read as a mesh, and never executed
    (decks / "plate.msh").write_text('/*\n$MeshFormat\n2.2 0 8\n$EndMeshFormat\n*/\nSystemCall "touch executed";\n')
    printed = thixis("restart", "../cut/checkpoint.h5", *GO_ON, folder=calls, expect=2)
    assert "is not a Gmsh mesh" in printed and not list(scratch.rglob("executed")), printed


def every():
    thixis("run", CONTACT, "--output", "whole")
    assert not (scratch / "whole/checkpoint.h5").exists(), "nothing to go on with, nothing asked for"
    thixis("run", CONTACT, "--output", "often", "--set", "output/checkpoint every=7", ranks=2)
    expect_same("often", "whole")
    # a run that is killed has the last checkpoint: go on behind it and be where the whole one is
    process = subprocess.Popen([program, "run", str(CONTACT), "--output", "killed", "--set", "output/checkpoint every=4", "--set",
                                "mesh/refinements=4"], cwd=scratch, stdout=subprocess.DEVNULL)
    while process.poll() is None and not (scratch / "killed/checkpoint.h5").exists():
        time.sleep(0.001)
    process.kill()
    process.wait()
    thixis("restart", "killed/checkpoint.h5", ranks=2)
    thixis("run", CONTACT, "--output", "whole4", "--set", "mesh/refinements=4")
    expect_same("killed", "whole4")
    assert newton_steps("killed") == newton_steps("whole4")
    # a new run leaves no checkpoint of an older one
    thixis("run", CONTACT, "--output", "often")
    assert not (scratch / "often/checkpoint.h5").exists()


def adaptive():
    """The meshes that were added are built again from what the checkpoint knows, on any number of ranks."""
    target = ["--set", "stopping/target=5e-4", "--set", "output/checkpoint every=1000"]
    thixis("run", CONTACT, "--output", "whole", *target)
    assert summary("whole")["verdict"].startswith("solved") and len({level for level, _ in newton_steps("whole")}) > 3
    thixis("run", CONTACT, "--output", "cut", *target, "--set", "adapt/max levels=1", ranks=2, expect=4)
    assert summary("cut")["verdict"].startswith("target missed: energy error at most "), summary("cut")["verdict"]
    thixis("restart", "cut/checkpoint.h5", "--set", "adapt/max levels=2", ranks=3, expect=4)
    thixis("restart", "cut/checkpoint.h5", "--set", "adapt/max levels=30")
    a, b = summary("cut"), summary("whole")
    assert a["exit_code"] == 0 and a["cells"] == b["cells"] and a["unknowns"] == b["unknowns"], (a["cells"], b["cells"])
    assert abs(a["estimate"]["total"] - b["estimate"]["total"]) <= 1e-6 * b["estimate"]["total"], (a["estimate"], b["estimate"])


def refusals():
    checkpoint = interrupted("cut", 1)
    before = (scratch / "cut/summary.json").read_text()

    def refused(sentence, code, *arguments, ranks=1):
        printed = thixis("restart", *arguments, expect=code, ranks=ranks)
        assert sentence in printed, f"'{sentence}' is not in:\n{printed}"
        assert (scratch / "cut/summary.json").read_text() == before, "nothing is written by a restart that is refused"

    for ranks in (1, 2):
        refused("There is no checkpoint 'none.h5'", 5, "none.h5", ranks=ranks)
        refused("is no checkpoint of Thixis", 5, "cut/fields.h5", ranks=ranks)
        refused("is no checkpoint of Thixis", 5, "cut/deck.xml", ranks=ranks)
        refused("mesh/cells per side: the checkpoint 'cut/checkpoint.h5' belongs to another model, mesh or method", 2, checkpoint, "--set",
                "mesh/cells per side=8", ranks=ranks)
    refused("method/nodes: the checkpoint", 2, checkpoint, "--set", "method/nodes=bernstein")
    refused("newton/initial/u1: a restart begins with the state of the checkpoint", 2, checkpoint, "--set", "newton/initial/u1=0.1")
    if "dg" in os.environ.get("THIXIS_METHODS", "dg"):
        refused("method/penalty: this is used only with method/name = dg", 2, checkpoint, "--set", "method/penalty=20")
    refused("belongs to level 3", 2, checkpoint, "--set", "mesh/refinements=2")
    refused("write newton/start = nested", 2, checkpoint, "--set", "mesh/refinements=4")
    refused("Did you mean 'max iterations'?", 2, checkpoint, "--set", "newton/max iteration=20")
    damaged = scratch / "damaged.h5"
    damaged.write_bytes((scratch / checkpoint).read_bytes()[:20000])
    refused("The checkpoint 'damaged.h5' is damaged", 5, "damaged.h5", ranks=2)


shutil.rmtree(scratch, ignore_errors=True)
scratch.mkdir(parents=True)
{"from_1_rank": lambda: from_ranks(1), "from_2_ranks": lambda: from_ranks(2), "from_3_ranks": lambda: from_ranks(3), "nested": nested,
 "mesh_file": mesh_file, "every": every, "adaptive": adaptive, "refusals": refusals}[scenario]()
