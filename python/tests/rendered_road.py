"""A road rendered by the command line tool, and what its `inspect` writes of it, for the tests."""

import functools
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import roadstereo

_folder = tempfile.TemporaryDirectory(prefix="roadstereo_python_")
FOLDER = pathlib.Path(_folder.name)


def run(*words):
    """Runs the command line tool as `python3 -m roadstereo`."""
    command = [sys.executable, "-m", "roadstereo", *map(str, words)]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


@functools.cache
def road():
    """The folder of one pair: left.png, right.png, calibration.yaml."""
    run("synth", "--scene", "demo", "--size", "320x180", "--output", FOLDER / "road")
    return FOLDER / "road"


@functools.cache
def pair():
    return roadstereo.read_frame(road() / "left.png"), roadstereo.read_frame(road() / "right.png")


@functools.cache
def calibration():
    return roadstereo.read_calibration(road() / "calibration.yaml")


@functools.cache
def inspected():
    """The folder that `inspect` writes for the pair."""
    names = [road() / "left.png", road() / "right.png"]
    run("inspect", *names, "--calibration", road() / "calibration.yaml", "--output", FOLDER / "inspected")
    return FOLDER / "inspected"


def json_file(name):
    return json.loads((inspected() / name).read_text(encoding="utf-8"))


def noise_pair():
    """A pair without a road: each image is its own noise."""
    random = np.random.default_rng(1)
    return tuple(random.integers(0, 256, (180, 320), dtype=np.uint8) for _ in range(2))
