#!/usr/bin/env python3
"""Checks the includes of every folder against the table of layers in docs/architecture.md, and the first line of kernels.

The last column of the table names the folders that a folder may include, besides itself and the public headers. The
public headers of `src/pipeline` and `src/io` count as part of those folders. A kernel of the library that does not wait
for the last one (begin_kernel) is a race that no tool shows. It takes less than a second.

    scripts/check_layers.py
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
SUFFIXES = {".hpp", ".cpp", ".h", ".cu", ".cuh"}
PUBLIC = "include/roadstereo"
PIPELINE_HEADERS = {"pipeline.hpp", "options.hpp", "device.hpp", "health.hpp", "lens_spots.hpp",
                    "cell_levels.hpp", "static_mask.hpp", "opencv.hpp", "roadstereo.hpp"}
OPENCV = ("include/roadstereo/opencv.hpp", "src/io", "src/evaluation", "apps", "tests", "examples/opencv")

# Includes that the table does not allow: (file, folder) and the reason. An entry that is not needed is an error.
EXCEPTIONS = {
    ("include/roadstereo/io/flight_frame.hpp", "src/pipeline"): "the journal stores PipelineState",
}


def read_table(path):
    """Maps every folder of the table to the folders it may include."""
    rules = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.split("|")]
        if len(cells) != 5:
            continue
        folder = re.fullmatch(r"`((?:include|src|apps|bench|examples|python)/[\w/]*)`", cells[1])
        if folder:
            rules[folder[1].rstrip("/")] = {name.rstrip("/") for name in re.findall(r"`([\w/]+)`", cells[3])}
    if not rules:
        raise SystemExit(f"{path}: there is no table of layers")
    return rules


def folder_of(path, rules):
    """The folder of the table that a file, given relative to the root, belongs to; None if there is none."""
    parent = path.parent.as_posix()
    if parent == PUBLIC and path.name in PIPELINE_HEADERS:
        return "src/pipeline"
    if parent == f"{PUBLIC}/io":
        return "src/io"
    while parent != "." and parent not in rules:
        parent = pathlib.PurePosixPath(parent).parent.as_posix()
    return parent if parent in rules else None


def resolve(source, name):
    """The file that an include names, relative to the root; None for headers of other projects."""
    for base in ("include", "src", "apps/roadstereo", source.parent.as_posix()):
        if (ROOT / base / name).is_file():
            return pathlib.PurePosixPath(base, name)
    return None


def breaks(rules, used):
    """Every include that the table does not allow, as text."""
    files = [file for top in ("include", "src", "apps", "bench", "examples", "python") for file in (ROOT / top).rglob("*")]
    for file in sorted(file for file in files if file.suffix in SUFFIXES):
        source = pathlib.PurePosixPath(file.relative_to(ROOT).as_posix())
        folder = folder_of(source, rules)
        if folder is None:
            yield f"{source}: its folder is not in the table"
            continue
        text = file.read_text(encoding="utf-8")
        if re.search(r"^#include [<\"]opencv2/", text, re.MULTILINE) and not source.as_posix().startswith(OPENCV):
            yield f"{source}: OpenCV belongs in {', '.join(OPENCV)}"
        for name in re.findall(r"^#include [<\"]([^>\"]+)[>\"]", text, re.MULTILINE):
            target = resolve(source, name)
            other = folder_of(target, rules) if target else None
            if other in (None, PUBLIC, folder) or other in rules[folder]:
                continue
            if (source.as_posix(), other) in EXCEPTIONS:
                used.add((source.as_posix(), other))
                continue
            yield f"{source}: includes {name}; {folder} may not include {other}"


def kernels_without_begin():
    """Every kernel of the library whose first line is not begin_kernel(), as text."""
    for file in sorted((ROOT / "src").rglob("*.cu")):
        for body in re.findall(r"__global__[^{;]*\{\s*([^\n]*)", file.read_text(encoding="utf-8")):
            if not body.startswith(("begin_kernel();", "}")):
                yield f"{file.relative_to(ROOT)}: a kernel begins with {body} and not with begin_kernel();"


def main():
    rules, used = read_table(ROOT / "docs/architecture.md"), set()
    found = list(breaks(rules, used)) + list(kernels_without_begin())
    found += [f"{file}: the exception for {folder} is not needed" for file, folder in EXCEPTIONS.keys() - used]
    if found:
        print("\n".join(found), file=sys.stderr)
        raise SystemExit(1)
    print(f"Layers: {len(rules)} folders, {len(EXCEPTIONS)} exceptions.")


if __name__ == "__main__":
    main()
