# SPDX-License-Identifier: Apache-2.0
"""The house: which module may include which, and the outside libraries each may use."""

import os
import re

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))

# Arrows go down only (docs: the map of the house).
MAY_INCLUDE = {
    "base": ["base"],
    "optics": ["optics", "base"],
    "geometry": ["geometry", "optics", "base"],
    "tracking": ["tracking", "base"],
    "render": ["render", "geometry", "optics", "base"],
    "validation": ["validation", "render", "tracking", "geometry", "optics", "base"],
    "apps": ["apps", "validation", "render", "tracking", "geometry", "optics", "base"],
    "web": ["web", "optics", "base"],
}

# Include prefixes of the outside libraries, and the modules that may use them.
EVERYWHERE = list(MAY_INCLUDE)
LIBRARIES = {
    "Eigen/": EVERYWHERE,
    "tl/expected": EVERYWHERE,
    "fmt/": EVERYWHERE,
    "hwy/": ["optics", "render"],
    "nlohmann/": ["base", "geometry", "tracking", "render", "validation", "apps", "web"],
    "tbb/": ["base", "tracking", "render", "validation", "apps"],
    "CGAL/": ["geometry"],
    "boost/": ["geometry"],
    "tiny_gltf": ["geometry"],
    "opencv2/": ["tracking"],
    "ceres/": ["tracking"],
    "embree3/": ["render"],
    "Imf": ["render"],
    "OpenEXR/": ["render"],
    "Imath": ["render"],
    "libav": ["render"],
    "libswscale/": ["render"],
    "CLI/": ["apps"],
    "httplib": ["apps"],
    "emscripten/": ["web"],
}
SYSTEM = ["sys", "arpa", "netinet"]  # folders of the operating system's own headers
TEST_LIBRARIES = ["gtest/", "gmock/", "rapidcheck", "arpa/", "netinet/"]
BENCH_LIBRARIES = ["benchmark/"]

# optics/ compiles to WebAssembly as it stands: no file, no thread, no stream to a device.
NOT_IN_OPTICS = {"fstream", "filesystem", "cstdio", "stdio.h", "iostream", "thread", "mutex",
                 "future", "execution", "base/atomic_file.h", "base/image.h", "base/progress.h"}

FOLDERS = EVERYWHERE + ["tests", "bench", "scripts", "cmake"]
NOT_OURS = {"node_modules", "dist", "__pycache__"}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def files(*extensions):
    """Paths, relative to the root, of our files with one of the extensions."""
    found = []
    for folder in FOLDERS:
        for path, folders, names in os.walk(os.path.join(ROOT, folder)):
            folders[:] = sorted(f for f in folders if f not in NOT_OURS and not f.startswith("."))
            found += [os.path.relpath(os.path.join(path, name), ROOT) for name in sorted(names)
                      if os.path.splitext(name)[1] in extensions]
    return found


def lines(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read().split("\n")


def includes(path):
    """[(line number, name, is it <...>)]"""
    found = []
    for number, line in enumerate(lines(path), 1):
        match = INCLUDE.match(line)
        if match:
            found.append((number, match.group(2), match.group(1) == "<"))
    return found
