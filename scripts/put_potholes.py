#!/usr/bin/env python3
"""Puts potholes of known shape into real streets: pixels of the right picture move as a hollow would move them.

scripts/put_potholes.py DIR OUTPUT [COUNT]

DIR is laid out as KITTI Stereo 2015 with masks of the road in road/. Writes COUNT (3) pairs of every frame with up to two
potholes each to OUTPUT/left, right and label, and the calibrations of KITTI, for `roadstereo evaluate damage OUTPUT`. The
pictures keep the noise, the rows and the texture that they have; diameters are 0.4 to 1.2 m, depths 12 to 100 mm, and the
walls reach over 0.15, 0.4 or all of the radius. Writes OUTPUT/potholes.csv, too. Nothing may be fitted to them alone.
"""

import csv
import pathlib
import sys

import numpy as np
from PIL import Image, ImageFilter

FOCAL_PX = {1242: 721.54, 1238: 718.34, 1224: 707.05}
CX_PX, CY_PX, BASELINE_M = 609.56, 172.85, 0.5327
WALLS = (0.15, 0.4, 1.0)
MIN_PIXELS = 300


def fit_plane(disparity, road):
    """Coefficients of 1, u, v of the road's disparity, by iteratively reweighted least squares."""
    v, u = np.nonzero((disparity > 0) & (road > 0))
    terms, values = np.stack([np.ones(len(u)), u, v], 1), disparity[v, u]
    weight = np.ones(len(u))
    for _ in range(20):
        plane = np.linalg.lstsq(terms * weight[:, None], values * weight, rcond=None)[0]
        residual = np.abs(terms @ plane - values)
        weight = np.sqrt(1 / np.maximum(residual, 0.1))
    return plane


def share_of_depth(away, wall):
    """Depth at `away` radii from the middle, 0 to 1; the wall reaches over `wall` of the radius."""
    share = np.clip((1 - away) / wall, 0, 1)
    return share * share * (3 - 2 * share)


class Street:
    """A road, whose disparity is offset + across · u + down · v, seen in a picture."""

    def __init__(self, shape, plane, focal_px, cx_px=CX_PX, cy_px=CY_PX, baseline_m=BASELINE_M):
        height, width = shape
        self.u, self.v = np.meshgrid(np.arange(width, dtype=float), np.arange(height, dtype=float))
        offset, across, down = plane
        self.disparity = np.maximum(offset + across * self.u + down * self.v, 1e-3)
        distance = focal_px * baseline_m / self.disparity
        self.points = np.stack([(self.u - cx_px) / focal_px * distance, (self.v - cy_px) / focal_px * distance, distance], -1)
        normal = np.array([across, down, (offset + across * cx_px + down * cy_px) / focal_px])
        self.height = baseline_m / np.linalg.norm(normal)
        self.normal = normal / np.linalg.norm(normal)
        forward = np.array([0, 0, 1]) - self.normal[2] * self.normal
        self.forward = forward / np.linalg.norm(forward)
        self.right = np.cross(self.normal, self.forward)

    def put(self, road, generator):
        """Depth in metres and label of up to two potholes, and what is known of them. `road` is a mask."""
        x, y = self.points @ self.right, self.points @ self.forward
        depth, label, known = np.zeros_like(x), np.zeros(x.shape, bool), []
        places = np.argwhere(road & (self.u > self.disparity + 10))
        for _ in range(400):
            if len(known) == 2 or not len(places):
                break
            v, u = places[generator.integers(len(places))]
            radius, aspect = generator.uniform(0.2, 0.6), generator.uniform(0.6, 1)
            away = np.hypot(x - x[v, u], (y - y[v, u]) / aspect) / radius
            inside, around = away < 1, away < 1.6
            seen = self.u[around].min() > 2 and self.v[around].max() < self.v.max() - 2
            if inside.sum() < MIN_PIXELS or label[around].any() or not seen or road[around].mean() < 0.9:
                continue
            largest = 10 ** generator.uniform(np.log10(0.012), np.log10(0.1))
            wall = generator.choice(WALLS)
            share = share_of_depth(away, wall)
            depth += largest * share
            label |= share > 0.5
            known.append([u, v, round(2 * radius, 3), round(largest, 4), wall, int(inside.sum())])
        return depth, label, known

    def move(self, right, depth):
        """The right picture of the road with that depth: its pixels move to the right."""
        change = self.disparity * depth / (self.height + depth)
        rows = self.v.astype(int)

        def sample(values, u):
            u = np.clip(u, 0, values.shape[1] - 1.001)
            left = u.astype(int)
            return values[rows, left] + (u - left) * (values[rows, left + 1] - values[rows, left])

        seen_from = self.u + 0
        for _ in range(20):  # columns of the left picture that the right one shows at u
            seen_from = self.u + sample(self.disparity, seen_from)
        moved, source = sample(change, seen_from), self.u + 0
        for _ in range(20):
            source = self.u - sample(moved, source)
        return np.where(np.abs(source - self.u) > 0.01, cubic(right, source, rows), right)


def cubic(image, u, rows):
    """Keys' cubic interpolation along the rows."""
    first = np.floor(u).astype(int)
    t = u - first
    weights = (((-0.5 * t + 1) * t - 0.5) * t, (1.5 * t - 2.5) * t * t + 1, ((-1.5 * t + 2) * t + 0.5) * t,
               (0.5 * t - 0.5) * t * t)
    columns = (np.clip(first + k, 0, image.shape[1] - 1) for k in (-1, 0, 1, 2))
    return np.clip(np.rint(sum(w * image[rows, c] for w, c in zip(weights, columns))), 0, 255)


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    source, output = map(pathlib.Path, sys.argv[1:3])
    count = int(sys.argv[3]) if len(sys.argv) == 4 else 3
    names = sorted(path.stem for path in (source / "image_2").glob("*.png"))
    if not names:
        sys.exit(f"{source / 'image_2'}: the folder contains no image")
    for folder in ("left", "right", "label"):
        (output / folder).mkdir(parents=True, exist_ok=True)
    generator = np.random.default_rng(5)
    rows = []
    for name in names:
        left, right = (np.asarray(Image.open(source / folder / f"{name}.png").convert("L"), float)
                       for folder in ("image_2", "image_3"))
        width = left.shape[1]
        if width not in FOCAL_PX:
            sys.exit(f"{source / 'image_2' / name}.png is {width} pixels wide; it must be one of {list(FOCAL_PX)}, as in KITTI")
        disparity = np.asarray(Image.open(source / "disp_noc_0" / f"{name}.png")) / 256.0
        mask = Image.open(source / "road" / f"{name}.png")
        street = Street(disparity.shape, fit_plane(disparity, np.asarray(mask)), FOCAL_PX[width])
        road = np.asarray(mask.filter(ImageFilter.MaxFilter(9))) > 0  # a lidar leaves gaps
        rig = f"p{1 + list(FOCAL_PX).index(width)}"
        (output / f"calibration_{rig}.yaml").write_text(
            f"focal_px: {FOCAL_PX[width]}\ncx_px: {CX_PX}\ncy_px: {CY_PX}\nbaseline_m: {BASELINE_M}\n", encoding="utf-8")
        for k in range(count):
            depth, label, known = street.put(road, generator)
            if not known:
                continue
            own = f"{rig}_{name}_{k}"
            for folder, image in (("left", left), ("right", street.move(right, depth)), ("label", 255 * label)):
                Image.fromarray(image.astype(np.uint8)).save(output / folder / f"{own}.png", compress_level=1)
            rows += [[own, *one] for one in known]
    with open(output / "potholes.csv", "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([["pair", "u_px", "v_px", "diameter_m", "depth_m", "wall", "pixels"], *rows])


if __name__ == "__main__":
    main()
