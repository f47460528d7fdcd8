"""Runs one entry of expected.txt: exit code, text, and that nothing was written.

usage: run_wrong_deck.py ENTRY expected.txt PROGRAM SCRATCH_FOLDER [LAUNCHER ...]

An entry of the list:

    name: arguments of the program
      needs METHOD ...              in a program without these methods the entry counts as not built (exit code 77)
      exit CODE                     2: command line or deck, 5: input or output
      found by check | run          whether `thixis check` finds it too (the default), or only a run, once there is a mesh
      says SENTENCE                 a line of the text; all `says` lines together are the whole text on standard error
"""
import os
import pathlib
import shlex
import shutil
import subprocess
import sys


def entry_of(name, path):
    entry = {"found": "check", "says": []}
    inside = False
    for line in path.read_text().splitlines():
        if not line.strip() or line.startswith("#"):
            continue
        if not line.startswith(" "):
            title, _, arguments = line.partition(":")
            inside = title == name
            if inside:
                entry["arguments"] = shlex.split(arguments)
            continue
        if not inside:
            continue
        key, _, text = line.strip().partition(" ")
        if key == "says":
            entry["says"].append(text)
        elif key == "needs":
            entry["needs"] = text.split()
        elif key == "exit":
            entry["exit"] = int(text)
        elif key == "found":
            entry["found"] = text.removeprefix("by ")
        else:
            sys.exit(f"{path}: '{line}' is no line of an entry")
    if "exit" not in entry or not entry["says"]:
        sys.exit(f"{path}: no complete entry '{name}'")
    return entry


def main(name, list_file, program, scratch, *launcher):
    list_file = pathlib.Path(list_file)
    entry = entry_of(name, list_file)
    built = os.environ.get("THIXIS_METHODS")
    missing = [method for method in entry.get("needs", []) if built is not None and method not in built.split(",")]
    if missing:
        print("not built:", ", ".join(missing))
        sys.exit(77)
    scratch = pathlib.Path(scratch)
    shutil.rmtree(scratch, ignore_errors=True)
    wanted = "\n".join(entry["says"]) + "\n"
    failures = []

    def ask(arguments, exit_code, on_ranks):
        result = subprocess.run([*launcher, program, *arguments], cwd=list_file.parent, capture_output=True, text=True)
        shown = f"{' '.join(arguments)}\n  exit code {result.returncode}\n  out: {result.stdout}\n  err: {result.stderr}"
        if result.returncode != exit_code:
            failures.append(f"exit code {result.returncode}, not {exit_code}: {shown}")
        if exit_code == 0:
            return
        if on_ranks:  # the launcher adds words of its own
            if (result.stdout + result.stderr).count(wanted) != 1:
                failures.append(f"the text does not stand there once: {shown}")
        elif result.stderr != wanted or result.stdout:
            failures.append(f"the text is another one: {shown}\n  not: {wanted}")

    arguments = entry["arguments"]
    of_a_deck = len(arguments) > 1 and arguments[0] == "run"
    ask(arguments + (["--output", str(scratch)] if of_a_deck else []), entry["exit"], bool(launcher))
    only_run_knows = any(word.startswith("--") and word != "--set" for word in arguments)
    if of_a_deck and not launcher and not only_run_knows:
        ask(["check", *arguments[1:]], entry["exit"] if entry["found"] == "check" else 0, False)
    if scratch.exists():
        failures.append(f"the folder {scratch} was made")
    sys.exit("\n".join(failures) or 0)


main(*sys.argv[1:])
