"""The look at rooms says yes to a project in order, and names what is wrong with others."""
import contextlib
import io
import pathlib
import tempfile
import unittest

import rooms


class Rooms(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.project = pathlib.Path(folder.name)
        self.write("apps/program/main.cpp", "int main() {}\n")
        self.write("packages/walls/src/stones/stone.hpp", "struct Stone {};\n")
        self.write("packages/walls/src/rows/row.hpp", '#include "stones/stone.hpp"\n')
        self.write("packages/walls/src/walls.cpp", '#include "rows/row.hpp"\n')

    def write(self, name, text):
        path = self.project / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def look(self):
        with contextlib.redirect_stdout(io.StringIO()) as said:
            code = rooms.main(self.project)
        return code, said.getvalue()

    def is_refused(self, because):
        code, said = self.look()
        self.assertEqual(code, 1)
        self.assertIn(because, said)

    def test_in_order(self):
        code, said = self.look()
        self.assertEqual(code, 0, said)

    def test_circle(self):
        self.write("packages/walls/src/stones/stone.cpp", '#include "rows/row.hpp"\n')
        self.is_refused("packages/walls/src: rooms see each other in a circle: rows -> stones -> rows.")

    def test_circle_of_three(self):
        self.write("packages/walls/src/sand/sand.hpp", '#include "rows/row.hpp"\n')
        self.write("packages/walls/src/stones/stone.cpp", '#include "sand/sand.hpp"\n')
        self.is_refused("rows -> stones -> sand -> rows")

    def test_crowded(self):
        for i in range(rooms.MOST_FILES):
            self.write(f"packages/walls/src/stones/stone_{i}.cpp", "\n")
        self.is_refused("packages/walls/src/stones holds 21 source files")

    def test_long(self):
        for i in range(4):
            self.write(f"packages/walls/src/rows/row_{i}.cpp", "\n" * (rooms.MOST_LINES + 1))
        self.is_refused("one file of ten has more than 201 lines")


if __name__ == "__main__":
    unittest.main()
