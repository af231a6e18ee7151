"""Breaks each rule of script/check-includes in a small tree and sees it reported."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "script/check-includes"

ROOMS = {
    "core": "motes_room(core SOURCES a.cc)",
    "samples": "motes_room(samples\n  USES core)",
    "field": "motes_room(field\n  SOURCES a.cc\n  USES core samples  # both\n  LINKS hwy::hwy)",
    "integrate": "motes_room(integrate USES core samples)",
}


class CheckIncludes(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.root = pathlib.Path(directory.name)
        for room, text in ROOMS.items():
            self.write(f"src/{room}/CMakeLists.txt", text)
        self.write("src/CMakeLists.txt", "".join(f"add_subdirectory({room})\n" for room in ROOMS))
        self.write("src/core/a.h", "#pragma once\n#include <vector>\n")
        self.write("src/field/deep/a.cc", '#include "core/a.h"\n#include "field/a.h"\n')

    def write(self, path, text):
        path = self.root / path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def run_check(self):
        return subprocess.run([sys.executable, SCRIPT, "--root", self.root], capture_output=True, text=True)

    def expect_breach(self, text):
        result = self.run_check()
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertIn(text, result.stdout)

    def test_sound_tree_passes(self):
        result = self.run_check()
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_room_that_is_not_in_uses(self):
        self.write("src/samples/a.h", '\n#include "field/a.h"\n')
        self.expect_breach("src/samples/a.h:2: field/a.h")

    def test_field_never_includes_integrate(self):
        self.write("src/field/a.h", '#  include "integrate/a.h"\n')
        self.expect_breach("src/field/a.h:1: integrate/a.h")

    def test_integrate_never_uses_field_even_where_the_order_allows_it(self):
        self.write("src/integrate/CMakeLists.txt", "motes_room(integrate\n  USES field)")
        self.expect_breach("src/integrate/CMakeLists.txt:2: integrate and field must not know each other")

    def test_use_against_the_flow(self):
        self.write("src/core/CMakeLists.txt", "motes_room(core USES field)")
        self.expect_breach("src/core/CMakeLists.txt:1: core may not use field")

    def test_apps(self):
        self.write("src/core/b.cc", '#include "apps/main.h"\n')
        self.expect_breach("src/core/b.cc:1: apps/main.h")

    def test_library_that_src_must_not_know(self):
        self.write("src/core/b.cc", "#include <Python.h>\n")
        self.expect_breach("src/core/b.cc:1: Python.h")

    def test_header_of_a_room_in_angle_brackets(self):
        self.write("src/core/b.cc", "#include <core/a.h>\n")
        self.expect_breach("src/core/b.cc:1: core/a.h")

    def test_directory_that_is_no_room(self):
        self.write("src/stray/a.h", "")
        self.expect_breach("src/stray/a.h:1: stray")


if __name__ == "__main__":
    unittest.main()
