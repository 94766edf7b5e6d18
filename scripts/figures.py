#!/usr/bin/env python3
"""The figures of README.md and docs/: runs the experiments, writes the tables, compares.

    scripts/figures.py run PROGRAM [--data DIR] [NAME…]     runs experiments, all or those named, into docs/accuracy.json
    scripts/figures.py write                                writes the tables between the markers from that file
    scripts/figures.py verify                               fails where a table is not what `write` would write
    scripts/figures.py check PROGRAM [--data DIR] [NAME…]   runs again; fails where a figure is worse by a quarter

A table stands between <!-- figures:NAME --> and <!-- end -->; scripts/figure_tables.py has a function for every NAME. A
table whose experiments are not in the file stays as it is. Experiments on data that are not in DIR are left out; DIR is
$ROADSTEREO_DATA, else what build/ was configured with, else ../shared/data. A NAME stands for all that begin with it.
"""
import argparse
import datetime
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import figure_tables

ROOT = pathlib.Path(__file__).resolve().parent.parent
FIGURES = ROOT / "docs/accuracy.json"
DOCUMENTS = ("README.md", "docs/accuracy.md", "docs/damage_accuracy.md", "docs/performance.md")
PRESETS = ("default", "fast", "paper")
SLACK = 1.25

# Name → arguments of the program, where {data} is the folder of the real data.
EXPERIMENTS = {
    "kitti": "evaluate kitti {data}/kitti2015",
    "kitti_scene": "evaluate kitti {data}/kitti2015 --set perspective.scope=scene",
    "kitti_wider": "evaluate kitti {data}/wider/kitti2015",
    "kitti_wider_scene": "evaluate kitti {data}/wider/kitti2015 --set perspective.scope=scene",
    "synth": "evaluate synth",
    "sigma": "evaluate sigma",
    "subpixel": "evaluate subpixel",
    "roll": "evaluate roll",
    "lambda": "evaluate lambda",
    "flatness": "evaluate flatness {data}/kitti2015",
    "blur": "evaluate blur",
    "middlebury": "evaluate middlebury {data}/middlebury",
    "damage_maps": "evaluate damage {data}/transformed",
    "damage_pairs": "evaluate damage {data}/potholes",
    "damage_kitti": "evaluate damage {data}/kitti2015",
    "damage_scenes": "evaluate damage",
    "damage_degraded": "evaluate damage --degraded --scenes 30",
    "damage_wide": "evaluate damage --wide",
    "damage_ruts": "evaluate damage --ruts",
    "damage_other": "evaluate damage {data}/wider/synthetic",
    "damage_wider_maps": "evaluate damage {data}/wider/transformed",
    "faults": "evaluate faults",
    "scan": "evaluate scan {data}/potholes",
    "flight": "evaluate flight",
    "flight_jumps": "evaluate flight --flight jump=100,jump=200",
    "odometry_drive": "evaluate odometry {data}/wider/odometry",
    "odometry_flight": "evaluate odometry --flight loop=300",
    "robustness": "evaluate robustness {data}/kitti2015 {data}/wider --scenes 20",
    "ablation": "evaluate ablation --kitti {data}/kitti2015 --sizes small",
}
SIZES = ("640x360 32", "1242x375 64", "2079x1040 64")
EXPERIMENTS |= {
    f"benchmark {preset} {size}": "benchmark --preset {} --size {} --disparities {}".format(preset, *size.split())
    for preset in PRESETS for size in SIZES
}
EXPERIMENTS |= {
    "raw 000003": "benchmark {data}/kitti2015/image_2/000003_10.png {data}/kitti2015/image_3/000003_10.png --disparities 0"
                  " --raw-disparities 128",
    "raw p1_01": "benchmark {data}/potholes/left/p1_01.png {data}/potholes/right/p1_01.png --calibration"
                 " {data}/potholes/calibration_p12.yaml --disparities 0 --raw-disparities 224",
}
# Of these a figure is not compared: times, and variants that are worse on purpose.
UNCHECKED = ("ablation", "benchmark", "lambda", "raw")
# What the tables do not need: values of single frames and trials.
LEFT_OUT = {"trials", "frames", "bins", "damage_bins", "found_regions", "times", "common", "common_damage", "best_visible",
            "best_damage", "phases", "version", "peak_memory_bytes"}

SHARES = re.compile(r"(density|valid|completeness|covered|measured|within_\w*)_percent$|_percent_within$")
SHARES_OF_ONE = {"precision", "recall", "f", "iou"}
ERRORS = re.compile(r"^(e_r|e_p|median_error_px|rms|p\d+_mm|median_mm|false_|ripple|gradient_descent_px|closed_form_px"
                    r"|robust_px|translation_percent|rotation_deg_per_m|ate_percent|link_|mean_abs_error|mean_rad|max_rad|roll_\w+_rad|plane_|max_bias_px|ratio$)")


def real_data():
    """The folder of the real data, unless the command line names it."""
    cache = ROOT / "build/CMakeCache.txt"
    match = re.search(r"^ROADSTEREO_DATA:\w+=(.+)$", cache.read_text(encoding="utf-8"), re.M) if cache.exists() else None
    return pathlib.Path(os.environ.get("ROADSTEREO_DATA") or (match[1] if match else ROOT.parent / "shared/data"))


def reduce(value):
    """The part of a document that is kept, numbers to six digits."""
    if isinstance(value, dict):
        return {key: reduce(item) for key, item in value.items() if key not in LEFT_OUT}
    if isinstance(value, list):
        return [reduce(item) for item in value]
    return float(f"{value:.6g}") if isinstance(value, float) else value


def run(program, data, name):
    """The JSON of one experiment; None where its data are missing."""
    arguments = EXPERIMENTS[name].format(data=data).split()
    folders = [pathlib.Path(argument) for argument in arguments if argument.startswith(str(data))]
    if not all(folder.exists() for folder in folders):
        print(f"{name}: left out, there is no {folders[0]}")
        return None
    print(f"{name} …", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        output = pathlib.Path(folder) / "figures.json"
        subprocess.run([program, *arguments, "--json", output], check=True, stdout=subprocess.DEVNULL)
        return reduce(json.loads(output.read_text(encoding="utf-8")))


def stored():
    return json.loads(FIGURES.read_text(encoding="utf-8")) if FIGURES.exists() else {}


def store(figures):
    ordered = {name: figures[name] for name in EXPERIMENTS if name in figures}
    text = json.dumps(ordered, indent=1, ensure_ascii=False)
    # One row of a table on one line.
    text = re.sub(r"\{\s*([^{}\[\]]*?)\s*\}", lambda m: "{" + re.sub(r"\s*\n\s*", " ", m[1]) + "}", text)
    FIGURES.write_text(text + "\n", encoding="utf-8")


def run_all(program, data, names):
    figures = stored()
    for name in names:
        document = run(program, data, name)
        if document is not None:
            figures[name] = {"date": datetime.date.today().isoformat(), "command": EXPERIMENTS[name], "result": document}
            store(figures)


def rendered(text, results):
    """The text of a document with its tables made anew."""
    def table(match):
        lines = getattr(figure_tables, match[1])(results)
        return match[0] if lines is None else f"<!-- figures:{match[1]} -->\n" + "\n".join(lines) + "\n<!-- end -->"
    return re.sub(r"<!-- figures:(\w+) -->\n.*?<!-- end -->", table, text, flags=re.DOTALL)


def write(verify):
    figures = stored()
    results = {name: entry["result"] for name, entry in figures.items()}
    results["dates"] = {name: entry["date"] for name, entry in figures.items()}
    stale = []
    for name in DOCUMENTS:
        path = ROOT / name
        text = path.read_text(encoding="utf-8")
        new = rendered(text, results)
        if new != text:
            stale.append(name)
            if not verify:
                path.write_text(new, encoding="utf-8")
    if verify and stale:
        raise SystemExit(f"Stale tables in {', '.join(stale)}: run scripts/figures.py write")
    print(f"Tables: {'good' if verify else ', '.join(stale) or 'nothing changed'}.")


def worse(golden, now, place):
    """What is worse than it may be, as text."""
    if isinstance(golden, list):
        rows = zip(golden, now) if len(golden) == len(now) else [(len(golden), f"{place}: {len(now)} rows")]
        for old, new in rows:
            if isinstance(old, dict):
                label = " ".join(value for value in old.values() if isinstance(value, str))
                yield from worse(old, new, f"{place} {label}")
            elif isinstance(new, str):
                yield new
    elif isinstance(golden, dict) and golden.get("method", "default") in PRESETS:
        for key, old in golden.items():
            new = now.get(key)
            if isinstance(old, (dict, list)):
                yield from worse(old, new, f"{place} {key}")
            elif isinstance(old, (int, float)) and not isinstance(old, bool):
                full = 100 if SHARES.search(key) else 1 if key in SHARES_OF_ONE else None
                if full is None and not ERRORS.search(key):
                    continue
                limit = SLACK * (full - old if full else old) + 1e-6
                if new is None or (full - new if full else new) > limit:
                    yield f"{place}: {key} is {new}, measured was {old}"


def check(program, data, names):
    figures, complaints = stored(), []
    for name in names:
        if name not in figures or name.startswith(UNCHECKED):
            continue
        now = run(program, data, name)
        if now is not None:
            complaints += worse(figures[name]["result"], now, name)
    if complaints:
        raise SystemExit("\n".join(complaints))
    print("Figures: good.")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mode", choices=("run", "write", "verify", "check"))
    parser.add_argument("program", nargs="?")
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--data", type=pathlib.Path, default=real_data())
    arguments = parser.parse_intermixed_args()
    if arguments.mode in ("write", "verify"):
        write(arguments.mode == "verify")
        return
    names = [name for name in EXPERIMENTS if name.startswith(tuple(arguments.names or [""]))]
    if not arguments.program or not names:
        parser.error("PROGRAM is missing" if names else f"NAME is one of: {', '.join(EXPERIMENTS)}")
    (run_all if arguments.mode == "run" else check)(arguments.program, arguments.data, names)


if __name__ == "__main__":
    sys.exit(main())
