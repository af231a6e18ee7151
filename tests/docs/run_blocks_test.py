"""Shows that run_blocks.py runs what it should, and that a command that fails is seen."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parent / "run_blocks.py"


class RunBlocks(unittest.TestCase):
    def run_document(self, text):
        with tempfile.TemporaryDirectory() as directory:
            document = pathlib.Path(directory) / "a.md"
            document.write_text(text)
            return subprocess.run([sys.executable, SCRIPT, document, "--source", directory, "--motes", "/bin/true"],
                                  capture_output=True, text=True)

    def test_blocks_share_a_directory(self):
        result = self.run_document("```sh\n$ echo 1 >a\n```\ntext\n```sh\ngrep 1 a\n```\n")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("2 blocks ran", result.stdout)

    def test_failure_names_the_line(self):
        result = self.run_document("one\n\n```sh\nfalse\ntrue\n```\n")
        self.assertEqual(result.returncode, 1)
        self.assertIn("a.md:4: ", result.stderr)

    def test_other_blocks_are_left_alone(self):
        result = self.run_document("```sh no-test\nfalse\n```\n```console\nfalse\n```\n```json\n{}\n```\n")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("0 blocks ran", result.stdout)

    def test_open_block(self):
        self.assertEqual(self.run_document("```sh\ntrue\n").returncode, 1)


if __name__ == "__main__":
    unittest.main()
