"""Runs the ```sh blocks of the documents, each document in a folder of its own, and compares the fields of the files that
are made with those that docs/file_formats.md names.

    check_documents.py PROGRAM [DOCUMENT…]
"""
import csv
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

DOCS = pathlib.Path(__file__).resolve().parents[2] / "docs"
RUN = ("first_flight", "calibration", "flying", "tuning", "cookbook")
# Their keys are names of options, files or kinds of damage.
FREE = {"options", "files", "by_distress"}


def shell_blocks(text):
    return re.findall(r"^```sh\n(.*?)^```", text, re.M | re.S)


def run_blocks(document, program, folder):
    blocks = shell_blocks((DOCS / f"{document}.md").read_text(encoding="utf-8"))
    environment = os.environ | {"PATH": f"{pathlib.Path(program).parent}:{os.environ['PATH']}"}
    for block in blocks:
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", block], cwd=folder, env=environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        if done.returncode != 0:
            sys.exit(f"docs/{document}.md: this block fails:\n{block}\n{done.stdout}")
    return len(blocks)


def keys_of(value):
    """All names in a JSON document but those of free maps."""
    if isinstance(value, list):
        return set().union(*(keys_of(one) for one in value)) if value else set()
    if not isinstance(value, dict):
        return set()
    found = set(value)
    for key, one in value.items():
        if key not in FREE:
            found |= keys_of(one)
    return found


def fields_of(path):
    if path.suffix == ".json":
        return keys_of(json.loads(path.read_text(encoding="utf-8")))
    with open(path, newline="", encoding="utf-8") as table:
        return set(next(csv.reader(table)))


def main():
    program = os.path.abspath(sys.argv[1])
    documented = set(re.findall(r"`([\w.]+)`", (DOCS / "file_formats.md").read_text(encoding="utf-8")))
    missing = {}
    with tempfile.TemporaryDirectory() as root:
        for document in RUN:
            folder = pathlib.Path(root) / document
            folder.mkdir()
            print(f"{document}: {run_blocks(document, program, folder)} blocks")
        names = ("result.json", "damages.json", "damages.csv", "frames.csv", "pose.csv", "summary.json", "truth.json")
        files = [path for path in pathlib.Path(root).rglob("*") if path.name in names]
        if {path.name for path in files} != set(names):
            sys.exit(f"the blocks made only {sorted({path.name for path in files})}")
        for path in files:
            for field in fields_of(path) - documented:
                missing.setdefault(field, path.name)
    if missing:
        sys.exit("docs/file_formats.md lacks " + ", ".join(f"{field} ({name})" for field, name in sorted(missing.items())))


if __name__ == "__main__":
    main()
