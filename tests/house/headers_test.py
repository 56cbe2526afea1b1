# SPDX-License-Identifier: Apache-2.0
"""Headers without a source file of their own compile alone (the build shows it of the others).

    headers_test.py COMPILER BUILD_FOLDER
"""

import json
import os
import shlex
import subprocess
import sys
import unittest
from concurrent.futures import ThreadPoolExecutor

import house


def lonely_headers():
    return [path for path in house.files(".h") if path.split("/")[0] in house.MAY_INCLUDE
            and not os.path.exists(os.path.join(house.ROOT, path[:-2] + ".cc"))]


def flags_by_module(build):
    """Include folders and definitions with which each module's sources are compiled."""
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
        commands = json.load(file)
    flags = {}
    for entry in commands:
        module = os.path.relpath(entry["file"], house.ROOT).split("/")[0]
        words = shlex.split(entry["command"])
        kept = [word for i, word in enumerate(words)
                if word.startswith(("-I", "-D", "-std")) or word == "-isystem"
                or words[i - 1] == "-isystem"]
        flags.setdefault(module, kept)
    return flags


class Headers(unittest.TestCase):
    compiler = build = ""

    def test_each_compiles_alone(self):
        flags = flags_by_module(self.build)

        def compile_alone(path):
            words = flags.get(path.split("/")[0])
            if words is None:  # a module that is not part of this build
                return None
            run = subprocess.run([self.compiler, *words, "-fsyntax-only", "-x", "c++",
                                  os.path.join(house.ROOT, path)],
                                 capture_output=True, text=True, check=False)
            return None if run.returncode == 0 else f"{path}: {run.stderr}"

        with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
            found = [message for message in pool.map(compile_alone, lonely_headers()) if message]
        self.assertEqual(found, [])


if __name__ == "__main__":
    Headers.compiler, Headers.build = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1])
