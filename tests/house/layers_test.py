# SPDX-License-Identifier: Apache-2.0
"""Includes go down the house only, and outside libraries stay where the table puts them."""

import unittest

import house


def place(path):
    """(module, kind) of a source file; kind is "" in the module itself, or "tests", "bench"."""
    parts = path.split("/")
    if parts[0] in ("tests", "bench"):
        return (parts[1] if parts[1] in house.MAY_INCLUDE else None), parts[0]
    return parts[0], ""


def problem(path, name, angled):
    """What is wrong with `path` including `name`, or None."""
    module, kind = place(path)
    if module is None:
        return None
    folder = name.split("/")[0]
    if module == "optics" and not kind and name in house.NOT_IN_OPTICS:
        return f"optics/ includes {name}, want no file, image or thread there"
    if not angled and folder in house.MAY_INCLUDE:
        allowed = house.MAY_INCLUDE[module]
        return None if folder in allowed else f"{module}/ includes {name}, want {', '.join(allowed)}"
    if not angled and "/" not in name:
        if module == "web":  # has a build of its own, where its folder is the root
            return None
        return f'includes "{name}", want the path from the root'
    if kind and not angled and folder in ("tests", kind):  # helpers that tests, benchmarks share
        return None
    if not angled and name == "cmake/source_dir.h":  # made when the build is configured
        return None
    for prefix, modules in house.LIBRARIES.items():
        if name.startswith(prefix):
            users = house.MAY_INCLUDE[module] if kind else [module]  # tests see what they test
            return None if set(users) & set(modules) else \
                f"{path.split('/')[0]}/ includes <{name}>, want it only in {', '.join(modules)}"
    extra = {"tests": house.TEST_LIBRARIES, "bench": house.BENCH_LIBRARIES}.get(kind, [])
    if any(name.startswith(prefix) for prefix in extra):
        return None
    if "/" in name and folder not in house.SYSTEM:
        return f"includes <{name}>, want a library of the table in tests/house/house.py"
    return None


class Layers(unittest.TestCase):
    def test_includes_go_down_only(self):
        found = []
        for path in house.files(".h", ".cc"):
            for number, name, angled in house.includes(path):
                wrong = problem(path, name, angled)
                if wrong:
                    found.append(f"{path}:{number}: {wrong}")
        self.assertEqual(found, [])

    def test_one_file_knows_the_version_of_embree(self):
        users = [path for path in house.files(".h", ".cc")
                 if any(name.startswith("embree") for _, name, _ in house.includes(path))]
        self.assertLessEqual(len(users), 1, users)

    def test_the_rule_finds_what_it_forbids(self):
        forbidden = [
            ("base/a.cc", "optics/lens.h", False),
            ("optics/a.cc", "geometry/eyewear.h", False),
            ("optics/a.cc", "opencv2/core.hpp", True),
            ("optics/a.cc", "fstream", True),
            ("optics/a.cc", "tbb/parallel_for.h", True),
            ("tracking/a.cc", "optics/lens.h", False),
            ("geometry/a.cc", "render/compositor.h", False),
            ("render/a.cc", "tracking/tracker.h", False),
            ("render/a.cc", "apps/tryon.h", False),
            ("render/a.cc", "gtest/gtest.h", True),
            ("web/a.cc", "geometry/eyewear.h", False),
            ("base/a.cc", "unheard/of.h", True),
            ("base/a.cc", "result.h", False),
            ("tests/optics/a_test.cc", "geometry/eyewear.h", False),
            ("tests/optics/a_test.cc", "CGAL/Polygon_2.h", True),
        ]
        allowed = [
            ("render/a.cc", "geometry/eyewear.h", False),
            ("validation/a.cc", "tracking/tracker.h", False),
            ("optics/a.cc", "hwy/highway.h", True),
            ("optics/a.cc", "vector", True),
            ("tests/optics/a_test.cc", "gtest/gtest.h", True),
            ("tests/optics/a_test.cc", "tests/optics/rays.h", False),
            ("base/a.cc", "sys/stat.h", True),
            ("bench/base/a_bench.cc", "bench/calibration.h", False),
            ("apps/a.cc", "cmake/source_dir.h", False),
        ]
        for case in forbidden:
            self.assertIsNotNone(problem(*case), case)
        for case in allowed:
            self.assertIsNone(problem(*case), case)


if __name__ == "__main__":
    unittest.main()
