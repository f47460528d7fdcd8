"""Runs in time that are killed or told to end go on from their checkpoint and end with the same results as a run that was not.

in_time.py SCENARIO DECK PROGRAM -- LAUNCHER...   (RANKS in the launcher stands for the number of ranks)
"""
import csv
import json
import math
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import h5py

HERE = Path(__file__).resolve().parent
scenario, deck, program, launcher = sys.argv[1], HERE / f"{sys.argv[2]}.xml", sys.argv[3], sys.argv[5:]
scratch = Path.cwd() / f"{sys.argv[2]}_{scenario}"


def command(*arguments, ranks=1):
    return [*([str(ranks) if word == "RANKS" else word for word in launcher] if ranks > 1 else []), program, *map(str, arguments)]


def thixis(*arguments, ranks=1, expect=0):
    done = subprocess.run(command(*arguments, ranks=ranks), cwd=scratch, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          universal_newlines=True)
    assert done.returncode == expect, f"exit code {done.returncode}, not {expect}, of {arguments} on {ranks}:\n{done.stdout}"
    return done.stdout


def summary(folder):
    return json.loads((scratch / folder / "summary.json").read_text())


def rows(folder, name):
    with open(scratch / folder / name) as file:
        return [{key: value for key, value in row.items() if key != "seconds"} for row in csv.DictReader(file)]


def fields(folder):
    """{name of the field: values} of every frame."""
    frames = {}
    with h5py.File(scratch / folder / "fields.h5") as file:
        for name in file:
            if name.startswith("fields_"):
                frames[name] = (file[name].attrs["time"], {field: values[()] for field, values in file[name].items()})
    return frames


def close(a, b, tolerance):
    return a == b or (math.isnan(a) and math.isnan(b)) or abs(a - b) <= tolerance * max(abs(a), abs(b), 1)


def expect_same_table(folder, whole, name, tolerance):
    a, b = rows(folder, name), rows(whole, name)
    assert len(a) == len(b), f"{name}: {len(a)} rows behind the restart, {len(b)} without"
    for number, (left, right) in enumerate(zip(a, b)):
        for key in right:
            same = left[key] == right[key] if tolerance == 0 or not right[key] else close(float(left[key]), float(right[key]), tolerance)
            assert same, f"{name}, row {number}, {key}: {left[key]} behind the restart, {right[key]} without"


def expect_same(folder, whole, tolerance=0):
    """The results agree; bit for bit without a tolerance."""
    a, b = summary(folder), summary(whole)
    assert a["exit_code"] == 0 and b["exit_code"] == 0, (a["verdict"], b["verdict"])
    counts = ("steps", "cells", "unknowns") + (("newton_iterations", "linear_iterations", "retries", "verdict") if tolerance == 0 else ())
    for key in counts:
        assert a[key] == b[key], f"{key}: {a[key]} behind the restart, {b[key]} without"
    expect_same_table(folder, whole, "series.csv", tolerance)
    if tolerance == 0:
        expect_same_table(folder, whole, "history.csv", 0)
    ours, theirs = fields(folder), fields(whole)
    assert list(ours) == list(theirs) and len(theirs) > 3, (list(ours), list(theirs))
    for frame, (moment, values) in theirs.items():
        assert ours[frame][0] == moment and list(ours[frame][1]) == list(values), frame
        for name, expected in values.items():
            found = ours[frame][1][name]
            scale = max(1, abs(expected).max()) if expected.size else 1
            assert found.shape == expected.shape and abs(found - expected).max() <= tolerance * scale, (
                f"{frame}/{name}: largest difference {abs(found - expected).max()}, of values up to {scale}")


def begun(folder, *arguments, ranks=1, until):
    """A process that runs until its log says that step `until` is done."""
    process = subprocess.Popen(command("run", deck, "--output", folder, *arguments, ranks=ranks), cwd=scratch, stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
    history = scratch / folder / "history.csv"
    while process.poll() is None:
        if history.exists() and any(row["time_step"] == str(until) for row in rows_so_far(history)):
            break
        time.sleep(0.002)
    assert process.poll() is None, "the run must not end before it is killed"
    return process


def rows_so_far(path):
    with open(path) as file:
        return [row for row in csv.DictReader(file) if row.get("time_step")]


def killed():
    """kill -9 at several moments: what was written behind the last checkpoint is written again."""
    thixis("run", deck, "--output", "whole")
    for until in (5, 7):
        folder = f"killed_{until}"
        process = begun(folder, "--set", "output/checkpoint every=3", until=until)
        process.kill()
        process.wait()
        thixis("restart", f"{folder}/checkpoint.h5")
        expect_same(folder, "whole")
    # killed again after the restart
    process = begun("twice", "--set", "output/checkpoint every=2", until=4)
    process.kill()
    process.wait()
    process = subprocess.Popen(command("restart", "twice/checkpoint.h5"), cwd=scratch, stdout=subprocess.DEVNULL)
    while process.poll() is None and not any(row["time_step"] == "8" for row in rows_so_far(scratch / "twice/history.csv")):
        time.sleep(0.002)
    process.kill()
    process.wait()
    thixis("restart", "twice/checkpoint.h5")
    expect_same("twice", "whole")


def terminated():
    """SIGTERM: a checkpoint, a verdict and exit code 6."""
    thixis("run", deck, "--output", "whole")
    process = begun("ended", until=4)
    process.send_signal(signal.SIGTERM)
    assert process.wait() == 6, process.returncode
    found = summary("ended")
    assert found["exit_code"] == 6 and found["verdict"].startswith("told to end by SIGTERM at time "), found["verdict"]
    assert not list((scratch / "ended").glob("*.part")), "nothing is left beside the results"
    thixis("restart", "ended/checkpoint.h5")
    expect_same("ended", "whole")


def mistaken():
    """Data that are wrong from some time on cost the steps behind it, and no others."""
    wrong = ["--set", "output/fields every=1"]
    text = thixis("run", deck, "--output", "kept", *wrong, expect=2)
    assert "solved up to time 0.5 of 1, in 5 time steps" in text and "scene/data/f1: the value at" in text, text
    found = summary("kept")
    assert found["exit_code"] == 2 and found["steps"] == 5 and abs(found["time_end"] - 0.5) < 1e-12, found
    assert len(rows("kept", "series.csv")) == 6
    assert sorted(round(moment, 9) for moment, _ in fields("kept").values()) == [0, 0.1, 0.2, 0.3, 0.4, 0.5]
    thixis("restart", "kept/checkpoint.h5", "--set", "scene/data/f1=-1")
    assert summary("kept")["steps"] == 10


def unbounded():
    """Steps without estimate leave no bound: who asks for one is refused; a rule that only steers goes on, and says so."""
    half, begin = {"mistaken": (0.2, "scene/data/initial/u1=3"), "flow": (30000, "scene/flow/initial/P=2e6")}[sys.argv[2]]
    thixis("run", deck, "--output", "cut", "--set", "stopping/rule=exact", "--set", f"time/end={half}", "--set",
           "output/checkpoint every=1000")
    before = (scratch / "cut/summary.json").read_text()
    end = ["--set", f"time/end={2 * half}"]

    def refused(path, *arguments, ranks=1):
        text = thixis("restart", "cut/checkpoint.h5", *end, *arguments, expect=2, ranks=ranks)
        assert f"{path}: " in text, text
        assert (scratch / "cut/summary.json").read_text() == before, "nothing is written by a restart that is refused"
        return text

    for ranks in (1, 2):
        text = refused("stopping/estimate", "--set", "stopping/estimate=true", ranks=ranks)
        assert "ran without stopping/estimate = true" in text and "begin a new run (thixis run)" in text, text
    refused("expect/bound at most", "--set", "stopping/rule=adaptive", "--set", "expect/bound at most=1")
    if sys.argv[2] == "mistaken":
        refused("stopping/target", "--set", "stopping/target=1")
        thixis("restart", "cut/checkpoint.h5", *end, "--set", "stopping/rule=adaptive", "--output", "steered")
        found = summary("steered")
        assert "; no bound on the error: steps before the checkpoint ran without" in found["verdict"], found["verdict"]
        assert found["estimate"] is None, found
    text = refused(begin.split("=")[0], "--set", begin)
    assert "a restart begins with the state of the checkpoint" in text, text


def on_other_ranks():
    """From one number of ranks to another, where the solvers leave nothing to differ."""
    exact = ["--set", "stopping/rule=exact", "--set", "stopping/linear tolerance=1e-13", "--set", "stopping/nonlinear tolerance=1e-10"]
    thixis("run", deck, "--output", "whole", *exact)
    thixis("run", deck, "--output", "two", *exact, ranks=2)
    expect_same("two", "whole", 1e-8)
    process = begun("moved", *exact, "--set", "output/checkpoint every=3", until=5)
    process.kill()
    process.wait()
    thixis("restart", "moved/checkpoint.h5", ranks=3)
    expect_same("moved", "whole", 1e-8)


shutil.rmtree(scratch, ignore_errors=True)
scratch.mkdir(parents=True)
{"killed": killed, "terminated": terminated, "on_other_ranks": on_other_ranks, "mistaken": mistaken, "unbounded": unbounded}[scenario]()
