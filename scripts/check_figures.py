#!/usr/bin/env python3
"""Runs the experiments behind docs/accuracy.md and compares their figures with those of docs/accuracy.json.

A figure may be 1.25 times what was measured; of shares in percent that should be large (density, errors within a
standard error) what is missing to 100 may be.

    scripts/check_figures.py PROGRAM BUILD

PROGRAM is the command line, BUILD the folder that it was built in, whose cache names the real data. Experiments on data
that are not there are left out, and named.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

SLACK = 1.25


def real_data(build):
    """The folder of the real data, or None."""
    cache = (build / "CMakeCache.txt").read_text(encoding="utf-8")
    match = re.search(r"^ROADSTEREO_DATA:PATH=(.+)$", cache, re.MULTILINE)
    return pathlib.Path(match[1]) if match and pathlib.Path(match[1]).is_dir() else None


def run(program, experiment, data):
    """The JSON of one experiment."""
    with tempfile.TemporaryDirectory() as folder:
        output = pathlib.Path(folder) / "figures.json"
        arguments = [str(data)] if data else []
        subprocess.run([program, "evaluate", experiment, *arguments, "--json", output], check=True,
                       stdout=subprocess.DEVNULL)
        return json.loads(output.read_text(encoding="utf-8"))


def row_of(document, entry):
    """The row that an entry of the goldens is about."""
    for key in entry["list"]:
        document = document[key]
    rows = [row for row in document if all(row.get(key) == value for key, value in entry["row"].items())]
    if len(rows) != 1:
        raise SystemExit(f"{entry['experiment']}: {len(rows)} rows are {entry['row']}")
    return rows[0]


def worse(entry, row):
    """What is worse than it may be, as text."""
    place = f"{entry['experiment']} {' '.join(entry['row'].values())}"
    for name, golden in entry.get("at_most", {}).items():
        if not row[name] <= SLACK * golden:
            yield f"{place}: {name} is {row[name]:.4g}, measured was {golden}"
    for name, golden in entry.get("share_at_least", {}).items():
        if not 100 - row[name] <= SLACK * (100 - golden):
            yield f"{place}: {name} is {row[name]:.4g}, measured was {golden}"


def main():
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    program, build = sys.argv[1], pathlib.Path(sys.argv[2])
    root = pathlib.Path(__file__).resolve().parent.parent
    goldens = json.loads((root / "docs/accuracy.json").read_text(encoding="utf-8"))
    data = real_data(build)
    complaints, documents = [], {}
    for entry in goldens:
        experiment = entry["experiment"]
        folder = data / entry["data"] if data and "data" in entry else None
        if "data" in entry and folder is None:
            print(f"{experiment}: left out, there is no {entry['data']}")
            continue
        if experiment not in documents:
            documents[experiment] = run(program, experiment, folder)
        complaints += worse(entry, row_of(documents[experiment], entry))
    if complaints:
        raise SystemExit("\n".join(complaints))
    print(f"Figures: good ({', '.join(documents)}).")


if __name__ == "__main__":
    main()
