#!/usr/bin/env python3
"""Puts potholes of known shape at fixed places of a drive, as put_potholes.py does in single streets, and counts those found.

scripts/put_potholes_in_drive.py put DRIVE INSPECTED OUTPUT [SEED]
scripts/put_potholes_in_drive.py count OUTPUT RESULT [OUTPUT RESULT ...]

DRIVE has image_0, image_1, poses.txt (camera to world, 3×4 a row) and calibration.yaml; INSPECTED is what `roadstereo
inspect DRIVE` wrote, whose planes are those of the road. Writes image_0, image_1 and potholes.json of 14 potholes on the
lane, 0.4 to 1.2 m wide and 12 to 100 mm deep, to OUTPUT. RESULT is what `roadstereo inspect OUTPUT` wrote, with --map if
the map counts, too. Counted are potholes that cover 300 pixels of a frame.
"""

import csv
import json
import pathlib
import shutil
import sys

import numpy as np
from PIL import Image

from put_potholes import MIN_PIXELS, WALLS, Street, share_of_depth

POTHOLES = 14
HALF_LANE_M = 1.4
CLASSES_M = (0.012, 0.025, 0.05, 0.1)


def read_table(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def read_streets(drive, inspected):
    """The road and the pose of every frame."""
    lines = (drive / "calibration.yaml").read_text(encoding="utf-8").splitlines()
    rig = {key: float(value) for key, value in (line.split(":") for line in lines)}
    poses = np.loadtxt(drive / "poses.txt").reshape(-1, 3, 4)
    shape = int(rig["height"]), int(rig["width"])
    for row, pose in zip(read_table(inspected / "frames.csv"), poses):
        plane = [float(row[name]) for name in ("a0_px", "a2", "a1")]
        yield Street(shape, plane, rig["focal_px"], rig["cx_px"], rig["cy_px"], rig["baseline_m"]), pose


def choose_places(streets, generator):
    """Middles in the world and shapes of potholes that do not touch, 6 to 9 m before some frame."""
    potholes = []
    while len(potholes) < POTHOLES:
        street, pose = streets[generator.integers(len(streets))]
        middle = (street.height * street.normal + generator.uniform(-HALF_LANE_M, HALF_LANE_M) * street.right
                  + generator.uniform(6, 9) * street.forward)
        radius = generator.uniform(0.2, 0.6)
        pothole = {"middle_m": (pose[:, :3] @ middle + pose[:, 3]).tolist(), "radius_m": radius,
                   "aspect": generator.uniform(0.6, 1), "wall": float(generator.choice(WALLS)),
                   "depth_m": 10 ** generator.uniform(np.log10(CLASSES_M[0]), np.log10(CLASSES_M[-1])), "seen": []}
        if all(np.hypot(pothole["middle_m"][0] - other["middle_m"][0], pothole["middle_m"][2] - other["middle_m"][2])
               > 2 * (radius + other["radius_m"]) + 0.5 for other in potholes):
            potholes.append(pothole)
    return potholes


def depth_of(potholes, street, pose, frame):
    """Depth of a frame in metres. Adds to every pothole where the frame sees it."""
    world = street.points @ pose[:, :3].T + pose[:, 3]
    depth = np.zeros(world.shape[:2])
    for pothole in potholes:
        x, _, z = pothole["middle_m"]
        away = np.hypot(world[..., 0] - x, (world[..., 2] - z) / pothole["aspect"]) / pothole["radius_m"]
        away[street.disparity < 5] = 2  # the horizon
        share = share_of_depth(away, pothole["wall"])
        depth += pothole["depth_m"] * share
        v, u = np.nonzero(share > 0.5)
        if len(u):
            pothole["seen"].append({"frame": frame, "pixels": len(u), "box_px": [int(k) for k in (u.min(), v.min(), u.max(), v.max())]})
    return depth


def put(drive, inspected, output, seed=1):
    generator = np.random.default_rng(seed)
    streets = list(read_streets(drive, inspected))
    potholes = choose_places(streets, generator)
    for folder in ("image_0", "image_1"):
        (output / folder).mkdir(parents=True, exist_ok=True)
    for frame, (street, pose) in enumerate(streets):
        name = f"{frame:06}.png"
        right = np.asarray(Image.open(drive / "image_1" / name).convert("L"), float)
        moved = street.move(right, depth_of(potholes, street, pose, frame))
        Image.fromarray(moved.astype(np.uint8)).save(output / "image_1" / name, compress_level=1)
        shutil.copyfile(drive / "image_0" / name, output / "image_0" / name)
    (output / "potholes.json").write_text(json.dumps(potholes), encoding="utf-8")


def is_at(sighting, pothole):
    """Whether the middle of a sighting lies in the box of a pothole, one and a half times as large."""
    for seen in pothole["seen"]:
        u0, v0, u1, v1 = seen["box_px"]
        if seen["frame"] == int(sighting["frame"]):
            return (abs(float(sighting["centroid_u_px"]) - (u0 + u1) / 2) <= 0.75 * (u1 - u0) and
                    abs(float(sighting["centroid_v_px"]) - (v0 + v1) / 2) <= 0.75 * (v1 - v0) + 2)
    return False


def found_by_inspect(result, potholes):
    """Numbers of the potholes found, their depths, and the number of damages that are none."""
    depths = {row["id"]: float(row["max_depth_m"]) for row in read_table(result / "damages.csv")}
    places = {}
    for row in read_table(result / "sightings.csv"):
        if row["road_damage"] in depths:
            places.setdefault(row["road_damage"], set()).update(k for k, one in enumerate(potholes) if is_at(row, one))
    found = {k: depths[damage] for damage, at in places.items() for k in at}
    return found, sum(not places.get(damage) for damage in depths)


def found_in_map(result, potholes):
    """The same of the map, whose x and y are those of the first camera, to the right and ahead."""
    found, others = {}, 0
    for row in read_table(result / "map" / "damages.csv") if (result / "map").is_dir() else []:
        away = [np.hypot(float(row["x_m"]) - one["middle_m"][0], float(row["y_m"]) - one["middle_m"][2]) - one["radius_m"]
                for one in potholes]
        if min(away) < 0.5:
            found[int(np.argmin(away))] = float(row["max_depth_m"])
        else:
            others += 1
    return found, others


def count(*folders):
    print("| depth mm | potholes | found by inspect | depth, % of the true one | found in the map | depth % |")
    print("| --- | --- | --- | --- | --- | --- |")
    of_class = [([], [], []) for _ in CLASSES_M[1:]]
    others = [0, 0]
    for output, result in zip(folders[::2], folders[1::2]):
        potholes = json.loads((output / "potholes.json").read_text(encoding="utf-8"))
        findings = found_by_inspect(result, potholes), found_in_map(result, potholes)
        others = [sum(pair) for pair in zip(others, (finding[1] for finding in findings))]
        for k, pothole in enumerate(potholes):
            if max((seen["pixels"] for seen in pothole["seen"]), default=0) < MIN_PIXELS:
                continue
            known, *shares = of_class[int(np.searchsorted(CLASSES_M[1:-1], pothole["depth_m"]))]
            known.append(k)
            for (found, _), share in zip(findings, shares):
                share += [100 * found[k] / pothole["depth_m"]] if k in found else []
    for low, high, (known, *shares) in zip(CLASSES_M, CLASSES_M[1:], of_class):
        cells = (f"{len(share)} | {np.median(share):.0f}" if share else "0 | " for share in shares)
        print(f"| {1e3 * low:.0f}–{1e3 * high:.0f} | {len(known)} | {' | '.join(cells)} |")
    print(f"| others | | {others[0]} | | {others[1]} | |")


def main():
    words = sys.argv[1:]
    if words[:1] == ["put"] and len(words) in (4, 5):
        put(*map(pathlib.Path, words[1:4]), *map(int, words[4:]))
    elif words[:1] == ["count"] and len(words) >= 3 and len(words) % 2:
        count(*map(pathlib.Path, words[1:]))
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
