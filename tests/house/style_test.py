# SPDX-License-Identifier: Apache-2.0
"""Licence lines, headers' form, and nothing that ties a file to one machine."""

import os
import re
import unittest

import house

SPDX = "SPDX-License-Identifier: Apache-2.0"
MACHINE_PATH = re.compile(r"(?<![\w.}\"-])/(home|root|work|tmp|mnt|opt|Users)/")
OPEN_POINT = re.compile(r"\b(TODO|FIXME|XXX)\b")
SOURCES = (".h", ".cc", ".py", ".sh", ".ts", ".js", ".cmake")


def scripts():
    """Files without an extension that start with #!."""
    return [path for path in house.files("") if house.lines(path)[0].startswith("#!")]


class Style(unittest.TestCase):
    def collect(self, paths, check):
        found = [f"{path}:{number}: {text}" for path in paths for number, text in check(path)]
        self.assertEqual(found, [])

    def test_each_source_names_its_licence(self):
        def check(path):
            head = house.lines(path)[:2]
            if not any(SPDX in line for line in head):
                yield 1, f"want the line {SPDX} first"
        self.collect([p for p in house.files(*SOURCES) if not p.endswith(".cmake")] + scripts(),
                     check)

    def test_no_file_knows_a_machine(self):
        def check(path):
            for number, line in enumerate(house.lines(path), 1):
                if MACHINE_PATH.search(line) and "MACHINE_PATH" not in line:
                    yield number, line.strip()
        extra = ["CMakeLists.txt", "CMakePresets.json", "README.md", "CHANGELOG.md"]
        extra = [path for path in extra if os.path.exists(os.path.join(house.ROOT, path))]
        self.collect(house.files(*SOURCES, ".txt", ".json", ".in") + scripts() + extra, check)

    def test_no_point_is_left_open(self):
        def check(path):
            for number, line in enumerate(house.lines(path), 1):
                if OPEN_POINT.search(line) and "OPEN_POINT" not in line:
                    yield number, line.strip()
        self.collect(house.files(*SOURCES) + scripts(), check)

    def test_lines_end_cleanly(self):
        def check(path):
            text = house.lines(path)
            if text[-1]:
                yield len(text), "want a newline at the end of the file"
            for number, line in enumerate(text, 1):
                if line != line.rstrip() or "\t" in line:
                    yield number, "got a tab or a space at the end, want neither"
        self.collect(house.files(*SOURCES) + scripts(), check)

    def test_headers_guard_themselves(self):
        def check(path):
            if "#pragma once" not in house.lines(path):
                yield 1, "want #pragma once"
        # Highway includes its -inl.h files once a target, so they guard themselves in its way.
        self.collect([p for p in house.files(".h") if not p.endswith("-inl.h")], check)

    def test_a_source_includes_its_own_header_first(self):
        """So the build itself shows that these headers can stand alone."""
        def check(path):
            header = path[:-3] + ".h"
            included = house.includes(path)
            if os.path.exists(os.path.join(house.ROOT, header)) and \
                    (not included or included[0][1] != header):
                yield 1, f'want #include "{header}" first'
        self.collect([path for path in house.files(".cc")
                      if path.split("/")[0] not in ("tests", "bench", "web")], check)


if __name__ == "__main__":
    unittest.main()
