"""Decks that the program has written run again as they are.

again.py deck DECK PROGRAM [--set PATH=VALUE]...     results/deck.xml gives the summary that DECK has given
again.py looks DECK PROGRAM [--set PATH=VALUE]...    every row of the history with a bound has the energy error, below it
again.py scene SCENE PROGRAM                         `describe --format xml SCENE` is a deck without mistakes
"""
import csv
import json
import shutil
import subprocess
import sys
from pathlib import Path

kind, what, program, *overrides = sys.argv[1:]
scratch = Path.cwd() / kind / f"{Path(what).parent.name}_{Path(what).stem}"  # decks of different models have the same name
shutil.rmtree(scratch, ignore_errors=True)
scratch.mkdir(parents=True)


def thixis(*arguments):
    done = subprocess.run([program, *map(str, arguments)], cwd=scratch, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    assert done.returncode == 0, f"exit code {done.returncode} of {arguments}:\n{done.stdout}"
    return done.stdout


def summary(folder):
    found = json.loads((scratch / folder / "summary.json").read_text())
    for key in ("time", "memory_mb"):
        del found[key]
    return found


if kind == "deck":
    thixis("run", what, "--output", "first", *overrides)
    thixis("check", "first/deck.xml")
    thixis("run", "first/deck.xml", "--output", "second")
    first, second = summary("first"), summary("second")
    different = [key for key in first if first[key] != second[key]]
    assert not different, "\n".join(f"{key}: {first[key]}, then {second[key]}" for key in different)
    assert (scratch / "first/deck.xml").read_text().replace("first", "second") == (scratch / "second/deck.xml").read_text()
elif kind == "looks":
    thixis("run", what, "--output", "looks", "--set", "stopping/estimate=true", *overrides)
    with open(scratch / "looks/history.csv") as file:
        rows = [row for row in csv.DictReader(file) if row["eta_total"]]
    assert len(rows) > 5, "the deck has looks"
    for row in rows:
        assert row["energy_error"] and float(row["energy_error"]) <= float(row["eta_total"]), row
else:
    (scratch / "deck.xml").write_text(thixis("describe", "--format", "xml", what))
    thixis("check", "deck.xml")
    words = (scratch / "deck.xml").read_text()
    if "two-phase" not in words:
        assert "capillary" not in words and "probes" in words
