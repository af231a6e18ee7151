"""Runs the commands of a document, as its reader would: run_blocks.py DOCUMENT.md --source DIR --motes PROGRAM

Blocks that open with ```sh run, one after the other, in one temporary directory that has data/ as the repository
does, and `motes` on the path. Blocks that open with ```sh no-test do not run; in ```console blocks nothing does.
A leading "$ " is not part of a command. Stops at the first command that fails, naming its line.
"""

import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile


def blocks(text):
    """The blocks to run, as [(line of the first command, commands)]."""
    found, start, lines = [], None, []
    for number, line in enumerate(text.splitlines(), 1):
        if start is None and re.fullmatch(r"```sh\s*", line):
            start, lines = number + 1, []
        elif start is not None and line.startswith("```"):
            found.append((start, "\n".join(lines)))
            start = None
        elif start is not None:
            lines.append(line.removeprefix("$ "))
    if start is not None:
        sys.exit(f"line {start - 1}: this block is never closed")
    return found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("document", type=pathlib.Path)
    parser.add_argument("--source", type=pathlib.Path, required=True, help="root of the repository")
    parser.add_argument("--motes", type=pathlib.Path, required=True, help="the program")
    args = parser.parse_args()
    found = blocks(args.document.read_text())
    environment = dict(os.environ, PATH=f"{args.motes.parent}:{os.environ['PATH']}")
    with tempfile.TemporaryDirectory() as directory:
        (pathlib.Path(directory) / "data").symlink_to(args.source.resolve() / "data")
        for line, commands in found:
            result = subprocess.run(["bash", "-euo", "pipefail", "-c", commands], cwd=directory, env=environment,
                                    stdin=subprocess.DEVNULL)
            if result.returncode != 0:
                sys.exit(f"{args.document}:{line}: this block ends with status {result.returncode}:\n{commands}")
    print(f"{args.document}: {len(found)} blocks ran")


if __name__ == "__main__":
    main()
