"""The rooms of packages: how large they are, and which way they see each other.

usage: rooms.py PROJECT

 * Sub-folders of packages/*/src see each other one way only: the graph of their includes has no cycle.
 * A folder holds at most 20 source files.
 * Nine of ten files have at most 200 lines.
"""
import pathlib
import re
import sys

MOST_FILES, MOST_LINES = 20, 200
INCLUDE = re.compile(r'^#include "([^"]+)"', re.MULTILINE)


def sources(folder):
    return [path for pattern in ("*.cpp", "*.hpp") for path in sorted(folder.rglob(pattern))]


def arrows(src):
    """{room: rooms that its files include}, the files beside the rooms not counted."""
    graph = {}
    for path in sources(src):
        room = path.relative_to(src).parts[0]
        for name in INCLUDE.findall(path.read_text()):
            other = name.split("/")[0]
            if (src / room).is_dir() and (src / name).is_file() and other != room and (src / other).is_dir():
                graph.setdefault(room, set()).add(other)
    return graph


def cycle(graph):
    """The rooms of a cycle, in its order; empty: there is none."""
    done = set()

    def visit(room, way):
        if room in way:
            return way[way.index(room):] + [room]
        if room in done:
            return []
        for other in sorted(graph.get(room, ())):
            if found := visit(other, way + [room]):
                return found
        done.add(room)
        return []

    for room in sorted(graph):
        if found := visit(room, []):
            return found
    return []


def main(project):
    faults = []
    everything = sources(project / "packages") + sources(project / "apps")
    folders = {}
    for path in everything:
        folders.setdefault(path.parent, []).append(path)
    for folder, files in sorted(folders.items()):
        if len(files) > MOST_FILES:
            faults.append(f"{folder.relative_to(project)} holds {len(files)} source files; give it sub-folders.")
    for src in sorted(project.glob("packages/*/src")):
        if found := cycle(arrows(src)):
            faults.append(f"{src.relative_to(project)}: rooms see each other in a circle: {' -> '.join(found)}.")
    lines = sorted((path.read_text().count("\n"), str(path.relative_to(project))) for path in everything)
    tenth = lines[int(0.9 * len(lines))]
    print(f"{len(lines)} files; nine of ten have at most {tenth[0]} lines; the longest: {lines[-1][1]} with {lines[-1][0]}")
    if tenth[0] > MOST_LINES:
        faults.append(f"one file of ten has more than {tenth[0]} lines; {MOST_LINES} is the limit.")
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
