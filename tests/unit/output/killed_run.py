"""A run in time that is killed again and again, at any moment, ends with the files of one that was not, byte by byte.

killed_run.py SCRATCH PROGRAM -- LAUNCHER...
"""
import pathlib
import random
import shutil
import subprocess
import sys
import xml.etree.ElementTree as xml

scratch, program, launcher = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2], sys.argv[4:]
KILLS = 6 if launcher else 15  # mpirun takes its time to notice


def run(folder, microseconds=0):
    """What the run printed, or nothing if it was killed."""
    folder.mkdir(exist_ok=True)
    done = subprocess.run([*launcher, program, str(folder), str(microseconds)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          universal_newlines=True)
    if done.returncode == 0:
        return done.stdout
    assert microseconds > 0 and "The " not in done.stderr, f"exit code {done.returncode}:\n{done.stderr}"
    return None


def check_listed(folder):
    """The XDMF file, if there is one, is whole, its times rise, and the files to which it refers are there. Returns the times."""
    if not (folder / "fields.xdmf").exists():
        return []
    tree = xml.parse(folder / "fields.xdmf")
    times = [float(time.get("Value")) for time in tree.iter("Time")]
    assert times == sorted(set(times)), f"the times do not rise: {times}"
    for item in tree.iter("DataItem"):
        assert (folder / item.text.split(":")[0]).exists(), f"{item.text} is not there"
    return times


def contents(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


shutil.rmtree(scratch, ignore_errors=True)
scratch.mkdir(parents=True)
whole = scratch / "whole"
duration = int(run(whole))
expected = contents(whole)
frames = len(check_listed(whole))
assert frames == 30 and len(expected) == frames + 5, sorted(expected)

chance = random.Random(7)
killed, rounds, most_listed = 0, 0, 0
while killed < KILLS:
    rounds += 1
    assert rounds <= 3 * KILLS, f"only {killed} of {rounds} runs were killed"
    folder = scratch / "killed"
    shutil.rmtree(folder, ignore_errors=True)
    while run(folder, 1 + int(duration * chance.uniform(0.02, 0.6))) is None:
        killed += 1
        most_listed = max(most_listed, len(check_listed(folder)))
    found = contents(folder)
    assert sorted(found) == sorted(expected), f"other files: {sorted(set(found) ^ set(expected))}"
    for name, data in expected.items():
        assert found[name] == data, f"{name} differs from that of a run that was not killed"
print(f"killed {killed} times in {rounds} runs of {duration / 1e6:.2f} s, at best behind {most_listed} of {frames} frames: the same files")
