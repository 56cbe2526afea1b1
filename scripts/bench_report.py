# SPDX-License-Identifier: Apache-2.0
"""Compares benchmark runs with the baseline of this kind of machine and writes one page.

    bench_report.py [--baseline] [--out PAGE] [--folder BASELINES] RUN.json...

A run is Google Benchmark's JSON with repetitions. Each benchmark's time is divided by that of the
calibration kernel of its own process (the benchmark with /calibration in its name), so that a slow
moment of the machine cancels. A change is flagged when it exceeds what the repetitions of both runs
scatter by (four times the sum of their relative spreads) and LEAST_CHANGE.
"""

import argparse
import html
import json
import os
import re
import statistics
import sys

LEAST_CHANGE = 0.10  # of the ratio to the calibration kernel
SPREADS = 4
UNITS = {"ns": 1, "us": 1e3, "ms": 1e6, "s": 1e9}
MODULE = re.compile(r"^(\w+)/")
NOT_COUNTERS = {"name", "run_name", "run_type", "repetitions", "repetition_index", "threads",
                "iterations", "real_time", "cpu_time", "time_unit", "family_index",
                "per_family_instance_index", "label", "aggregate_name", "aggregate_unit",
                "big_o", "rms", "error_occurred", "error_message", "items_per_second",
                "cpu_coefficient", "real_coefficient"}


def machine_name():
    """The processor as the system names it, fit for a file name."""
    name = "unknown"
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        for line in file:
            if line.startswith("model name"):
                name = line.split(":", 1)[1].strip()
                break
    slug = re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")
    return f"{slug}-{os.cpu_count()}"


def read_run(path):
    """{name: {"median_ns", "spread", "ratio", counters}} of one program's run, and what it could
    not run: {name: reason}."""
    with open(path, encoding="utf-8") as file:
        rows = json.load(file)["benchmarks"]
    times, counters, growth, failed = {}, {}, {}, {}
    for row in rows:
        name = row["run_name"] if "run_name" in row else row["name"]
        if row.get("error_occurred"):
            failed[name] = row.get("error_message", "")
            continue
        if row.get("aggregate_name") == "BigO":
            growth[name] = row.get("big_o", "")
        if row.get("run_type") != "iteration":
            continue
        # What runs on several threads is timed by the wall, all else by the processor.
        key = "real_time" if "real_time" in name else "cpu_time"
        times.setdefault(name, []).append(row[key] * UNITS[row["time_unit"]])
        counters[name] = {k: v for k, v in row.items() if k not in NOT_COUNTERS}
    found = {}
    for name, values in times.items():
        middle = statistics.median(values)
        spread = statistics.median([abs(v - middle) for v in values]) / middle if middle else 0
        found[name] = {"median_ns": middle, "spread": spread, "counters": counters[name]}
    calibrations = [found[name]["median_ns"] for name in sorted(found) if "/calibration" in name]
    if not calibrations:
        sys.exit(f"{path}: has no benchmark with /calibration in its name")
    for name, one in found.items():
        one["ratio"] = one["median_ns"] / calibrations[0]
        family = name.split("/real_time")[0]
        for key, big_o in growth.items():
            if family.startswith(key):
                one["growth"] = big_o
    return found, failed


def compare(now, before):
    """(relative change of the ratio, is it beyond the noise); (None, False) without a baseline."""
    if before is None or before["ratio"] == 0:
        return None, False
    change = now["ratio"] / before["ratio"] - 1
    noise = max(LEAST_CHANGE, SPREADS * (now["spread"] + before["spread"]))
    return change, abs(change) > noise


def in_order(name):
    """Names with their numbers as numbers: 64 before 128."""
    return [(part.isdigit(), int(part) if part.isdigit() else 0, part)
            for part in re.split(r"(\d+)", name)]


def count_text(value):
    return f"{value:,.0f}" if abs(value) >= 1000 else f"{value:.3g}"


def time_text(nanoseconds):
    for unit, size in (("s", 1e9), ("ms", 1e6), ("us", 1e3)):
        if nanoseconds >= size:
            return f"{nanoseconds / size:.3g} {unit}"
    return f"{nanoseconds:.3g} ns"


STYLE = """
:root { color-scheme: light dark; --ink: #1b2430; --paper: #fcfcfa; --line: #c9d0d8;
  --bad: #b3261e; --good: #1d7a4c; --quiet: #5b6673; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6eaef; --paper: #14181d; --line: #39424d;
  --bad: #ff8a80; --good: #5fd39a; --quiet: #9aa6b2; } }
body { font: 16px/1.45 system-ui, sans-serif; color: var(--ink); background: var(--paper);
  margin: 0 auto; padding: 1rem; max-width: 64rem; }
h1 { font-size: 1.5rem; } h2 { font-size: 1.1rem; margin: 2rem 0 .25rem; }
.quiet { color: var(--quiet); } .bad { color: var(--bad); font-weight: 700; }
.good { color: var(--good); font-weight: 700; } .wide { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; min-width: 46rem; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: .25rem .6rem .25rem 0; border-bottom: 1px solid var(--line); }
td.number, th.number { text-align: right; white-space: nowrap; }
"""


def page(machine, results, failed, baseline):
    modules = {}
    for name in sorted(results, key=in_order):
        one = results[name]
        match = MODULE.match(name)
        modules.setdefault(match.group(1) if match else "other", []).append((name, one))
    body = [f"<h1>Lorgnette: benchmarks</h1><p class=\"quiet\">{html.escape(machine)}. Medians of "
            "five repetitions; the ratio is to the calibration kernel of the same process; ± is the "
            "median deviation. Accuracy stands beside speed where a kernel has an error to "
            "show.</p>"]
    for module, rows in modules.items():
        body.append(f"<h2>{html.escape(module)}</h2><div class=\"wide\"><table><tr>"
                    "<th>benchmark</th><th class=\"number\">time</th><th class=\"number\">±</th>"
                    "<th class=\"number\">ratio</th><th class=\"number\">change</th>"
                    "<th>accuracy and counts</th></tr>")
        for name, one in rows:
            change, flagged = compare(one, baseline.get(name))
            kind = ("bad" if change > 0 else "good") if flagged else ""
            text = "" if change is None else f"{100 * change:+.1f} %"
            counts = ", ".join(f"{k} {count_text(v)}" for k, v in one["counters"].items()
                               if isinstance(v, (int, float)))
            if one.get("growth"):
                counts += (", " if counts else "") + "grows as " + one["growth"]
            body.append(
                f"<tr><td>{html.escape(name.split('/process_time')[0])}</td><td class=\"number\">"
                f"{time_text(one['median_ns'])}</td><td class=\"number\">"
                f"{100 * one['spread']:.1f} %</td><td class=\"number\">{one['ratio']:.4g}</td>"
                f"<td class=\"number {kind}\">{text}</td><td>{html.escape(counts)}</td></tr>")
        body.append("</table></div>")
    for name, reason in sorted(failed.items()):
        body.append(f"<p class=\"bad\">{html.escape(name)} was not run: {html.escape(reason)}</p>")
    return ("<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta "
            "name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>Lorgnette: "
            f"benchmarks</title><style>{STYLE}</style></head><body>" + "\n".join(body) +
            "</body></html>\n")


def main(argv):
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--baseline", action="store_true", help="write the baseline")
    parser.add_argument("--out", help="page to write")
    parser.add_argument("--folder", default="bench/baselines")
    parser.add_argument("runs", nargs="+")
    options = parser.parse_args(argv)

    results, failed = {}, {}
    for path in options.runs:
        found, missing = read_run(path)
        results.update(found)
        failed.update(missing)
    machine = machine_name()
    path = os.path.join(options.folder, machine + ".json")
    if options.baseline:
        kept = {name: {"median_ns": round(one["median_ns"], 2), "ratio": float(f"{one['ratio']:.4g}"),
                       "spread": round(one["spread"], 4)} for name, one in sorted(results.items())}
        os.makedirs(options.folder, exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            json.dump({"machine": machine, "benchmarks": kept}, file, indent=1)
            file.write("\n")
        print(path)
    baseline = {}
    if os.path.exists(path):
        with open(path, encoding="utf-8") as file:
            baseline = json.load(file)["benchmarks"]
    if options.out:
        with open(options.out, "w", encoding="utf-8") as file:
            file.write(page(machine, results, failed, baseline))
        print(options.out)
    flagged = 0
    for name, one in sorted(results.items()):
        change, beyond = compare(one, baseline.get(name))
        if beyond:
            flagged += 1
            print(f"{name}: {100 * change:+.1f} % of its ratio to the calibration kernel")
    for name, reason in sorted(failed.items()):
        print(f"{name}: not run: {reason}")
    if not baseline:
        print(f"no baseline of this machine ({path}); scripts/bench --baseline writes one")
    else:
        print(f"{len(results)} benchmarks, {flagged} changed beyond the noise")
    return 1 if flagged else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
