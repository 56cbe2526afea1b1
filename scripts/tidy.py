#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs clang-tidy on the modules' sources, skipping those that were clean before.

    tidy.py BUILD_FOLDER [FILE...]

What was clean is remembered per user, like a compiler cache, under a hash of the source, of every
header of ours that it includes, of its compile command and of .clang-tidy: see remembered().
"""

import hashlib
import json
import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor, as_completed

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
MODULES = {"base", "optics", "geometry", "tracking", "render", "validation", "apps"}
INCLUDE = re.compile(rb'^\s*#\s*include\s*"([^"]+)"', re.M)


def read(path):
    with open(os.path.join(ROOT, path), "rb") as file:
        return file.read()


def closure(path, seen):
    """Adds to `seen` the contents of `path` and of what it includes of ours."""
    if path in seen:
        return
    seen[path] = read(path)
    for name in INCLUDE.findall(seen[path]):
        for found in (name.decode(), os.path.join(os.path.dirname(path), name.decode())):
            if os.path.isfile(os.path.join(ROOT, found)):
                closure(os.path.normpath(found), seen)
                break


def without_precompiled(command):
    """The compile command without the headers that GCC precompiled, and what goes with them."""
    command = re.sub(r" -include \S*cmake_pch\.hxx", "", command)
    return command.replace(" -Winvalid-pch", "").replace(" -Wno-restrict", "")


def key(entry, path, version):
    seen = {}
    closure(path, seen)
    digest = hashlib.sha256()
    command = entry["command"].replace(ROOT, "")
    for part in [version, read(".clang-tidy"), command.encode()]:
        digest.update(part + b"\0")
    for name in sorted(seen):
        digest.update(name.encode() + b"\0" + seen[name] + b"\0")
    return digest.hexdigest()


def remembered(name):
    cache = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    folder = os.path.join(cache, "lorgnette-tidy")
    os.makedirs(folder, exist_ok=True)
    return os.path.join(folder, name)


def main():
    build, only = sys.argv[1], set(sys.argv[2:])
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
        entries = json.load(file)
    for entry in entries:
        entry["command"] = without_precompiled(entry["command"])
    database = os.path.join(build, "tidy")
    os.makedirs(database, exist_ok=True)
    with open(os.path.join(database, "compile_commands.json"), "w", encoding="utf-8") as file:
        json.dump(entries, file)
    version = subprocess.run(["clang-tidy", "--version"], capture_output=True, check=True).stdout
    todo, clean = [], 0
    for entry in entries:
        path = os.path.relpath(entry["file"], ROOT)
        if path.split("/")[0] not in MODULES or (only and path not in only):
            continue
        mark = remembered(key(entry, path, version))
        if os.path.exists(mark):
            clean += 1
        else:
            todo.append((path, mark))

    def tidy(job):
        path, mark = job
        run = subprocess.run(["clang-tidy", "-p", database, "--quiet", os.path.join(ROOT, path)],
                             capture_output=True, text=True, check=False)
        if run.returncode == 0:
            with open(mark, "w", encoding="utf-8"):
                pass
        return path, run

    failed = 0
    with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        for done in as_completed([pool.submit(tidy, job) for job in todo]):
            path, run = done.result()
            if run.returncode != 0:
                failed += 1
                print(f"{path}:\n{run.stdout}{run.stderr}", flush=True)
    print(f"clang-tidy: {len(todo)} files looked at, {clean} known to be clean, {failed} with "
          "findings")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
