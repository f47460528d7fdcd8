"""What the program does not touch, does not show and does not begin.

guards.py SCENARIO PROGRAM -- LAUNCHER...   (RANKS in the launcher stands for the number of ranks)
"""
import json
import os
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import time
import zlib
from pathlib import Path

DECKS = Path(__file__).resolve().parent.parent
GOOD, TIME = DECKS / "decks/good.xml", DECKS / "restart/parabolic.xml"
scenario, program, launcher = sys.argv[1], sys.argv[2], sys.argv[4:]
scratch = Path.cwd() / scenario
METHODS = os.environ.get("THIXIS_METHODS", "fem,dg,hho,fv").split(",")  # those that the program has
PATIENCE = 60  # seconds: nothing here takes so long


def command(*arguments, ranks=1):
    return [*([str(ranks) if word == "RANKS" else word for word in launcher] if ranks > 1 else []), program, *map(str, arguments)]


def thixis(*arguments, ranks=1, expect=0, says="", **options):
    """Runs the program, which must end with one of the exit codes and say the words; returns what it printed."""
    done = subprocess.run(command(*arguments, ranks=ranks), cwd=scratch, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, timeout=PATIENCE, **options)
    printed = done.stdout.decode(errors="surrogateescape")
    codes = expect if isinstance(expect, tuple) else (expect,)
    assert done.returncode in codes, f"exit code {done.returncode}, not {expect}, of {arguments} on {ranks}:\n{printed[-3000:]}"
    assert says in printed, f"'{says}' is not in:\n{printed[-3000:]}"
    return printed


def with_settings(**values):
    return [word for path, value in values.items() for word in ("--set", f"{path.replace('__', '/').replace('_', ' ')}={value}")]


def special_files():
    """Pipes, devices and folders are refused at once: nobody waits for what never comes."""
    os.mkfifo(scratch / "pipe")
    (scratch / "link").symlink_to("/dev/zero")
    for place in ("pipe", "link", "/dev/zero", "/dev/null", "/dev/stdin"):
        for verb in ("run", "check"):
            thixis(verb, place, expect=5, says="this is no regular file, but a pipe or a device")
        thixis("restart", place, expect=5, says="is no regular file, but a pipe or a device")
    for ranks in (1, 2):
        thixis("run", "pipe", ranks=ranks, expect=5, says="no regular file")
        thixis("restart", "pipe", ranks=ranks, expect=5, says="no regular file")
    thixis("restart", ".", expect=5, says="is a folder")
    with open(scratch / "huge.xml", "wb") as file:
        file.truncate(1 << 40)
    thixis("check", "huge.xml", expect=2, says="the deck is larger than 16 MB")
    assert not (scratch / "results").exists(), "nothing is written for what is refused"


def links():
    """Nothing is written through a link; the folder itself may be one."""
    (scratch / "precious").write_text("mine")
    for name in ("log.txt", "summary.json", "deck.xml", "deck.xml.part", "history.csv", "fields.h5", "fields.xdmf", "checkpoint.h5.part"):
        folder = scratch / f"with_{name}"
        folder.mkdir()
        (folder / name).symlink_to("../precious")
        for ranks in (1, 2):
            thixis("run", GOOD, "--output", folder, ranks=ranks, expect=5, says="there is a link of this name")
        assert (scratch / "precious").read_text() == "mine", name
        assert [entry.name for entry in folder.iterdir()] == [name], f"something was written beside {name}"
    os.mkfifo(scratch / "with_log.txt" / "summary.json")
    (scratch / "with_log.txt" / "log.txt").unlink()
    thixis("run", GOOD, "--output", "with_log.txt", expect=5, says="there is no regular file of this name")
    (scratch / "there").mkdir()
    (scratch / "in_time").mkdir()
    (scratch / "in_time/fields").symlink_to("../there")
    thixis("run", TIME, "--output", "in_time", expect=5, says="fields' can not be written")
    assert not list((scratch / "there").iterdir())
    (scratch / "here").symlink_to("there")
    thixis("run", GOOD, "--output", "here")
    assert json.loads((scratch / "there/summary.json").read_text())["exit_code"] == 0
    # an older run's files are replaced, though another name of theirs exists
    os.link(scratch / "there/summary.json", scratch / "kept.json")
    before = (scratch / "kept.json").read_text()
    thixis("run", GOOD, "--output", "here", *with_settings(mesh__refinements=0))
    assert (scratch / "kept.json").read_text() == before


def two_runs():
    """Two runs in one folder are told apart, and a run that died leaves the folder free."""
    long = ["--output", "shared", *with_settings(time__step="1e-4", time__end=1)]
    for ranks in (1, 2):
        with open(scratch / "words", "w") as words:
            first = subprocess.Popen(command("run", TIME, *long), cwd=scratch, stdout=words, stderr=words)
        log = scratch / "shared/history.csv"
        begun = time.time()
        while first.poll() is None and not log.exists() and time.time() < begun + PATIENCE:
            time.sleep(0.01)
        assert first.poll() is None, (scratch / "words").read_text()
        thixis("run", GOOD, "--output", "shared", ranks=ranks, expect=5, says="Another run writes to the folder 'shared' now")
        thixis("run", GOOD, "--output", "other", ranks=ranks)
        first.kill()
        first.wait()
        thixis("run", GOOD, "--output", "shared", ranks=ranks)
        shutil.rmtree(scratch / "shared")


def sizes():
    """What is too large for the machine, or never ends, does not begin."""
    one = with_settings(scene__model="obstacle", scene__case="torsion")
    for settings in (with_settings(mesh__refinements=16, method__degree=4), with_settings(mesh__refinements=20),
                     with_settings(mesh__generator="disk", mesh__rings=1000, mesh__refinements=15, method__name="hho" if "hho" in METHODS else "fem")):
        for ranks in (1, 2):
            printed = thixis("run", GOOD, *one, *settings, ranks=ranks, expect=2)
            assert re.search(r"mesh/refinements: the run needs [0-9.e+]+ GB of memory or more.*, and there are [0-9.e+]+ GB; take fewer cells",
                             printed), printed
    flow = scratch / "flow.xml"
    flow.write_text((DECKS / "restart/flow.xml").read_text())
    thixis("run", flow, *with_settings(mesh__cells="{400000000}", mesh__refinements=10), expect=2, says="mesh/cells: the run needs")
    for end, step in (("30000", "5e-20"), ("1", "1e-7"), ("1e300", "1"), ("1", "5e-324")):
        for verb in ("check", "run"):
            thixis(verb, TIME, *with_settings(time__end=end, time__step=step), expect=2, says="steps until the end at")
    thixis("check", TIME, *with_settings(time__end="1", time__step="1e-20", time__adaptive="true"), expect=2, says="lost among the digits")
    thixis("check", TIME, *with_settings(time__adaptive="true", time__largest="1e-9", time__smallest="1e-9"), expect=2,
           says="steps until the end at")
    thixis("check", TIME, *with_settings(time__smallest="1e-30"), expect=2, says="lost among the digits")
    thixis("check", TIME, *with_settings(time__step="1e-6", time__end="1"))
    deep = scratch / "deep.xml"
    for depth in (8000, 200000):
        deep.write_text('<ParameterList name="a">' * depth + "</ParameterList>" * depth)
        for verb in ("check", "run"):
            thixis(verb, deep, expect=2, says="the lists are nested too deep")
    thixis("check", GOOD, "--set", "a/" * 30000 + "b=1", expect=2, says="no parameter of a deck has such a long path")
    thixis("check", GOOD, *[word for i in range(1001) for word in ("--set", "mesh/refinements=1")], expect=2, says="more than 1000")
    assert not (scratch / "results").exists()


def extremes():
    """Every number of a deck at the ends of its type: a sentence or a run, never an internal error or a signal."""
    block = ""
    for line in thixis("describe").splitlines():
        heading = re.match(r"(\w[\w/ ]*): ", line)
        if heading and not line.startswith(" "):
            block = heading.group(1)
        entry = re.match(r"  (\S[^<>]*?)  +(int|long long|double)  ", line)
        if not entry or "<" in block:
            continue
        in_time = block == "time" or entry.group(1) in ("fields every", "steps at most", "retries at most")
        deck = TIME if in_time else GOOD
        short = with_settings(mesh__refinements=0, **({"time__step": 0.2, "mesh__cells_per_side": 2} if in_time else {}))
        if block == "adapt" or entry.group(1) == "target":  # such runs refine up to their limits
            short = [*short, *with_settings(adapt__max_unknowns=1000, adapt__max_levels=3)]
        whole = ("2147483647", "-2147483648", "9223372036854775807", "0")
        for value in whole if entry.group(2) != "double" else (*whole, "1e308", "-1e308", "5e-324"):
            thixis("run", deck, "--output", "out", *short, *with_settings(output__fields="none"), "--set",
                   f"{block}/{entry.group(1)}={value}", expect=(0, 2, 3, 4))


def words():
    """Words of others reach terminal, log and files as words: no control characters, no bytes that are no text."""
    escape = "\x1b]0;gotcha\x07\x1b[2J"
    deck = scratch / f"a{escape}.xml"
    shutil.copy(GOOD, deck)
    seen = [thixis("run", deck, "--output", "out"), (scratch / "out/log.txt").read_text(), (scratch / "out/deck.xml").read_text()]
    seen.append(thixis("check", deck))
    seen.append(thixis("check", f"none{escape}\udc9b\udcff.xml", expect=5, says="there is no such file"))
    seen.append(thixis("restart", f"none{escape}.h5", expect=5, says="There is no checkpoint"))
    seen.append(thixis("run", GOOD, "--output", f"{escape}/summary", *with_settings(mesh__refinements=0)))
    seen.append(thixis("run", GOOD, "--output", f"/proc/{escape}", expect=5))
    seen.append(thixis(f"{escape}", expect=2))
    seen.append(thixis("describe", escape, expect=2))
    for setting in (f"mesh/{escape}=1", f"mesh/refinements={escape}", f"{escape}"):
        seen.append(thixis("check", GOOD, "--set", setting, expect=2))
    (scratch / "bad.xml").write_text(GOOD.read_text().replace("smooth contact", f"smooth {escape}"))
    seen.append(thixis("check", "bad.xml", expect=2, says="here is the control character \\x1b"))
    (scratch / "bad.xml").write_text(GOOD.read_text().replace("smooth contact", "smooth &#27;[2J"))
    seen.append(thixis("check", "bad.xml", expect=2, says="'&#27;' stands for no character that a text can hold"))
    (scratch / "bad.xml").write_text(GOOD.read_text().replace("smooth contact", "smooth contact&#10;solved in 1 Newton step"))
    seen.append(thixis("check", "bad.xml", expect=2, says="holds the character &#10;"))
    (scratch / "bad.xml").write_bytes(GOOD.read_text().encode("utf-16"))
    seen.append(thixis("check", "bad.xml", expect=2, says="UTF-16"))
    for text in seen:
        wrong = [c for c in text if (ord(c) < 32 and c not in "\n\t") or 0x7f <= ord(c) < 0xa0 or 0xd800 <= ord(c) < 0xe000]
        assert not wrong, f"{wrong} in:\n{text!r}"


def tensions():
    """Where a tension varies by orders of magnitude inside a cell, a run ends by itself or with a sentence, with every method."""
    deck = DECKS / "guards/tensions.xml"
    for mu in ("exp(-60*x)", "exp(-100*x)", "1+1e8*exp(-2000*(x-0.4)^2)"):
        for method, degrees in (("fem", (1, 2, 4)), ("hho", (1, 3)), ("dg", (1, 3))):
            for degree in degrees if method in METHODS else ():
                thixis("run", deck, "--output", "out", *with_settings(scene__data__mu1=mu, method__name=method, method__degree=degree),
                       expect=(0, 2, 3))
    for ranks in (1, 2) if "dg" in METHODS else ():
        thixis("run", deck, "--output", "out", *with_settings(method__name="dg"), ranks=ranks, expect=2,
               says="method/penalty: it is too small for the tension mu1, which varies by orders of magnitude inside a cell")
    for ranks in (1, 2) if "hho" in METHODS else ():
        thixis("run", deck, "--output", "out", *with_settings(method__name="hho", method__degree=2, scene__data__mu1="exp(-100*x)",
                                                              scene__data__f1="-1e-300"),
               ranks=ranks, expect=2, says="a tension that varies by too many orders of magnitude inside a cell")
    for settings in ({"method__penalty": 1000}, {"method__variant": "nipg"}) if "dg" in METHODS else ():
        thixis("run", deck, "--output", "out", *with_settings(method__name="dg", **settings), expect=(0, 3))


def tilts():
    """A tilt that all heights have in common takes digits from the gap: a run says how many, and ends with exit code 3 where none is left."""
    deck = DECKS / "extremes/membranes/tilted.xml"
    for ranks in (1, 2):
        thixis("run", deck, "--output", "out", ranks=ranks, says="; the rounding of heights of up to 2.0e+09 hides forces below ")
        thixis("run", deck, "--output", "out", *with_settings(scene__data__g1="1e13*(x+y)+0.1", scene__data__g2="1e13*(x+y)"), ranks=ranks,
               expect=3, says="contact cannot be told; subtract from all heights what they have in common")


def sealed(path):
    """Writes the seal of a checkpoint anew, as one who changes it on purpose would."""
    content = path.read_bytes()[512:]
    text = f"thixis checkpoint\nformat 2\nbytes {len(content)}\ncrc32 {zlib.crc32(b'format 2' + bytes([10]), zlib.crc32(content)):08x}\n"
    path.write_bytes(text.encode().ljust(512, b"\0") + content)


def forged():
    """A checkpoint that was changed with a tool is damaged; sealed again, its numbers are judged one by one."""
    try:
        import h5py
    except ImportError as missing:
        print(f"skipped: {missing} (Debian: python3-h5py)")
        return
    thixis("run", GOOD, "--output", "still", *with_settings(newton__max_iterations=1), expect=3)
    thixis("run", TIME, "--output", "moving", *with_settings(time__end=0.1, output__checkpoint_every=2))
    go_on = {"still": with_settings(newton__max_iterations=50), "moving": with_settings(time__end=0.2)}

    def restarted(folder, change, expect, says="", seal=True):
        copy = scratch / "copy"
        shutil.rmtree(copy, ignore_errors=True)
        shutil.copytree(scratch / folder, copy)
        with h5py.File(copy / "checkpoint.h5", "r+") as file:
            change(file)
        if seal:
            sealed(copy / "checkpoint.h5")
        return thixis("restart", "copy/checkpoint.h5", "--output", "copy", *go_on[folder], expect=expect, says=says)

    def nothing(file):
        file.attrs["level"] = file.attrs["level"]

    for folder in go_on:
        restarted(folder, nothing, 0)
        with h5py.File(scratch / folder / "checkpoint.h5") as file:
            names, blocks = list(file["attributes"].attrs), list(file["blocks"])
        for name in names:
            def change(value):
                def with_value(file):
                    file["attributes"].attrs[name] = value
                return with_value
            values = [float("nan")] + ([-2147483646.0] if name in COUNTED else []) + ([1e300] if name in COUNTED[:3] else [])
            for value in values:
                printed = restarted(folder, change(value), (2, 5))
                assert any(words in printed for words in ("is damaged", "is at time", "belongs to")), (name, value, printed)
        restarted(folder, change(3.0), 5, "is damaged", seal=False)
        for level in (-2, 1 << 40):
            def with_level(file):
                file.attrs.create("level", level, dtype="i8")
            restarted(folder, with_level, (2, 5))

        def with_link(file):
            del file["deck"]
            file["deck"] = h5py.ExternalLink(str(scratch / folder / "checkpoint.h5"), "/deck")
        restarted(folder, with_link, 5, "is damaged")

        def with_soft_link(file):
            file["other"] = file[f"blocks/{blocks[0]}"]
            del file[f"blocks/{blocks[0]}"]
            file[f"blocks/{blocks[0]}"] = h5py.SoftLink("/other")
        restarted(folder, with_soft_link, 5, "is damaged")

        def with_huge_array(file):
            del file[f"blocks/{blocks[0]}/ids"]
            file[f"blocks/{blocks[0]}"].create_dataset("ids", shape=(1 << 50,), dtype="i8", chunks=(1024,))
        restarted(folder, with_huge_array, 5, "is damaged")

        def with_nothing(file):
            del file["blocks"]
        restarted(folder, with_nothing, 5, "is damaged")

        def with_value_that_is_none(file):
            block = file[f"blocks/{blocks[0]}"]
            block["values"][0] = float("nan")
            block.attrs["checksum"] = checksum(block["ids"][()], block["values"][()])
        restarted(folder, with_value_that_is_none, 5, "No run has nan")
    printed = thixis("restart", "still/checkpoint.h5", "--output", "other", *go_on["still"],
                     *with_settings(scene__case="discontinuous multiplier"), expect=(0, 3))
    assert "other parameters than those of the checkpoint: newton/max iterations = 50 (was 1)" in printed, printed
    assert "scene/case = discontinuous multiplier (was smooth contact)" in printed and "warning: this is another problem" in printed, printed
    assert "of the checkpoint:" not in thixis("restart", "still/checkpoint.h5", "--output", "same", expect=3)


# numbers that are not below zero; all but the last four are whole
COUNTED = ("cells", "newton_on_level", "newton_iterations", "linear_iterations", "history_rows", "series_rows", "time_step", "retries", "frames",
           "bounded", "seconds", "time", "next_length", "data_time")


def checksum(ids, values):
    """The sum of SplitMix64 hashes of (id, bits of the value) that a block carries."""
    mask = (1 << 64) - 1

    def mixed(state, word):
        state = (state + word + 0x9E3779B97F4A7C15) & mask
        state = ((state ^ (state >> 30)) * 0xBF58476D1CE4E5B9) & mask
        state = ((state ^ (state >> 27)) * 0x94D049BB133111EB) & mask
        return state ^ (state >> 31)

    total = sum(mixed(mixed(0, int(i)), struct.unpack("<Q", struct.pack("<d", v))[0]) for i, v in zip(ids, values)) & mask
    return total - (1 << 64) if total >> 63 else total


def memory():
    """Where memory can not be had, a sentence says so."""
    found = set()
    for megabytes in (600, 800, 1000, 1400, 2000):
        def limited():
            resource.setrlimit(resource.RLIMIT_AS, (megabytes << 20, megabytes << 20))
        done = subprocess.run(command("run", GOOD, "--output", "out", *with_settings(mesh__refinements=7, method__degree=3, output__fields="none",
                                                                                      newton__max_iterations=1, linear__solver="direct",
                                                                                      linear__form="reduced")),
                              cwd=scratch, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=4 * PATIENCE, preexec_fn=limited)
        printed = done.stdout.decode()
        begun = "Thixis" in printed or "model membranes" in printed or "memory" in printed
        if not begun:
            continue  # too little for the libraries to start at all
        assert done.returncode in (2, 3), f"{megabytes} MB: exit code {done.returncode}\n{printed[-2000:]}"
        found.add("the run needs" in printed or "memory of this machine is not enough" in printed)
    assert True in found, "no limit was too small"


def drawn():
    """What is drawn where there is none ends in the true reason, whatever draws it; a state that went astray is called that."""
    flow, left = DECKS / "decks/flow.xml", "scene/flow/boundary/left"
    source = ["--set", "scene/flow/hydrogen source=0"]
    for drawing in (["--set", "scene/flow/hydrogen source=-1e-8"],
                    [*source, "--set", f"{left}/kind=flux", "--set", f"{left}/hydrogen=-1e-6"]):
        printed = thixis("run", flow, *drawing, "--output", "drawn", expect=3, says="more of it is drawn from there than there is")
        assert "larger viscosity" not in printed.splitlines()[-1], printed
    printed = thixis("run", flow, *source, "--set", "scene/flow/water source=-1e-2", "--output", "drawn", expect=3)
    verdict = printed.split("not converged: ")[-1]
    assert "Newton's method diverges" in verdict and "viscosity" not in verdict, verdict


shutil.rmtree(scratch, ignore_errors=True)
scratch.mkdir(parents=True)
signal.alarm(600)
{"special_files": special_files, "links": links, "two_runs": two_runs, "sizes": sizes, "extremes": extremes, "words": words,
 "tensions": tensions, "tilts": tilts, "forged": forged, "memory": memory, "drawn": drawn}[scenario]()
