#!/usr/bin/env python3
"""Renders random roads with the ray tracer POV-Ray: pictures, exact disparities and labels of damage.

scripts/render_roads.py OUTPUT [--scenes 48] [--seed 1] [--jobs 2]

Needs the program povray, numpy and OpenCV (Debian: povray python3-numpy python3-opencv). Each scene is a folder left.png,
right.png, disparity.tiff, occ.png, region.png, damage.png, truth.json and calibration.yaml, for `roadstereo evaluate
robustness OUTPUT --scenes 0` and `roadstereo evaluate damage OUTPUT`. Streets from a vehicle with kerbs, verges, houses,
parked cars and posts, roads below a low rig and a drone; stones in bitumen or cement, patches, sealed cracks, oil, worn
paint, shadows of leaves and wet roads; potholes and bumps; and a sensor with one fault in seven scenes of ten. Nothing may
be fitted to them.
"""

import argparse
import concurrent.futures
import json
import math
import pathlib
import subprocess
import tempfile

import cv2
import numpy as np

RAYS = 3  # per pixel along a side
ROAD, DAMAGE, OBSTACLE, VERGE, BACKGROUND = 1, 2, 3, 4, 5  # of region.png
HEIGHT_RANGE_M = 1.0  # of the road's height field
SEEN_BY_BOTH, OUTSIDE, HIDDEN = 255, 64, 0  # of occ.png
MIN_OFFSET_M = 0.001  # of damage
SIZES = (640, 360), (640, 480), (800, 300), (1024, 576), (752, 480)
# Field of view and pitch in degrees, height and baseline in metres, standard deviations of roll and yaw in degrees.
VIEWS = {
    "street": dict(fov=(55, 90), pitch=(4, 22), height=(1.1, 2.2), baseline=(0.12, 0.5), roll=1.5, yaw=4),
    "rig": dict(fov=(50, 80), pitch=(30, 65), height=(1.2, 3.0), baseline=(0.08, 0.2), roll=3, yaw=25),
    "oblique": dict(fov=(45, 80), pitch=(30, 60), height=(2.5, 7.0), baseline=(0.15, 0.5), roll=3, yaw=25),
    "nadir": dict(fov=(40, 75), pitch=(75, 90), height=(2.0, 6.0), baseline=(0.12, 0.4), roll=3, yaw=25),
}
# Albedo, size of the stones in metres, contrast.
SURFACES = {
    "asphalt": (0.13, 0.012, 0.5),
    "worn": (0.2, 0.016, 0.6),
    "concrete": (0.38, 0.03, 0.15),
    "new": (0.05, 0.009, 0.45),
    "chippings": (0.17, 0.02, 0.7),
}
GREY = np.ones(3)
MATT = "finish { ambient AMBIENT diffuse 0.75 }"
GRASS = """pigment { bozo turbulence 0.4 color_map { [0 rgb <0.04,0.09,0.02>] [0.5 rgb <0.09,0.14,0.03>]
  [1 rgb <0.22,0.2,0.08>] } scale 0.02 }"""


def smooth_step(share):
    share = np.clip(share, 0, 1)
    return share * share * (3 - 2 * share)


def noise(generator, shape, cell_m, scale_m):
    """Smooth noise of standard deviation 1 with features of scale_m."""
    coarse = generator.standard_normal([max(3, math.ceil(n * cell_m / scale_m) + 3) for n in shape]).astype(np.float32)
    size = [int(n * scale_m / cell_m) + 1 for n in coarse.shape[::-1]]
    field = cv2.resize(coarse, size, interpolation=cv2.INTER_CUBIC)[: shape[0], : shape[1]]
    return field / max(field.std(), 1e-6)


class Ground:
    """Heights, damage and materials of the road on a grid: x to the right, z forward."""

    def __init__(self, generator, x0, x1, z0, z1, cell_m):
        self.generator, self.cell_m, self.x0, self.z0 = generator, cell_m, x0, z0
        self.shape = int((z1 - z0) / cell_m) + 1, int((x1 - x0) / cell_m) + 1
        self.x1, self.z1 = x0 + (self.shape[1] - 1) * cell_m, z0 + (self.shape[0] - 1) * cell_m
        self.x = np.linspace(self.x0, self.x1, self.shape[1])[None, :]
        self.z = np.linspace(self.z0, self.z1, self.shape[0])[:, None]
        self.height = np.zeros(self.shape)
        self.labels = np.zeros(self.shape, np.uint16)
        self.material = np.zeros(self.shape, np.uint8)
        self.damages = []

    def noise(self, scale_m):
        return noise(self.generator, self.shape, self.cell_m, scale_m)

    def shape_road(self):
        half = (self.x1 - self.x0) / 2
        self.height -= self.generator.uniform(0, 0.025) * half * ((self.x - self.x0 - half) / half) ** 2
        for scale_m, amplitude_m in (6.0, 0.006), (2.0, 0.002), (0.5, 0.0007), (0.1, 0.0004):
            self.height += self.noise(scale_m) * amplitude_m * self.generator.uniform(0.3, 1.5)

    def radii_from(self, x, z, radius_x, radius_z, angle=0.0, raggedness=0.0):
        """Distance from (x, z) in radii of an ellipse with a ragged outline."""
        right, forward = self.x - x, self.z - z
        a = math.cos(angle) * right + math.sin(angle) * forward
        b = math.cos(angle) * forward - math.sin(angle) * right
        outline, direction = np.ones(self.shape), np.arctan2(b, a)
        for k in range(2, 9):
            phase = self.generator.uniform(0, 2 * math.pi)
            outline += raggedness / k * self.generator.standard_normal() * np.cos(k * direction + phase)
        return np.hypot(a / radius_x, b / radius_z) / np.clip(outline, 0.4, 1.6)

    def add_damage(self, kind, offset):
        """False where it would overlap another one."""
        inside = np.abs(offset) > MIN_OFFSET_M
        if inside.sum() < 50 or (inside & (self.labels > 0)).any():
            return False
        offset = np.where(inside, offset, 0)
        self.height += offset
        self.labels[inside] = len(self.damages) + 1
        self.damages.append({
            "label": len(self.damages) + 1,
            "kind": kind,
            "area_m2": float(inside.sum() * self.cell_m**2),
            "max_depth_m": float(np.percentile(np.abs(offset[inside]), 99.5)),
            "volume_m3": float(np.abs(offset).sum() * self.cell_m**2),
        })
        return True

    def add_pothole(self, x, z, size_m, rubble):
        """Steep ones lay open the base course, the material `rubble`."""
        g = self.generator
        radii = size_m / 2 * g.uniform(0.7, 1.3, 2)
        away = self.radii_from(x, z, *radii, g.uniform(0, math.pi), g.choice([0.1, 0.3, 0.5]))
        wall = g.choice([0.12, 0.3, 0.6, 1.0])
        share = smooth_step((1 - away) / wall)
        depth_m = g.uniform(0.012, 0.09) * min(1.0, math.sqrt(size_m / 0.35))
        if self.add_damage("pothole", -depth_m * share * (1 + 0.15 * self.noise(0.08) + 0.05 * self.noise(0.025))):
            if wall < 0.5:
                self.material[(self.labels == len(self.damages)) & (share > 0.5)] = rubble

    def add_bump(self, x, z, size_m):
        g = self.generator
        away = self.radii_from(x, z, *(size_m / 2 * g.uniform(0.6, 1.4, 2)), g.uniform(0, math.pi), 0.15)
        self.add_damage("bump", g.uniform(0.012, 0.06) * smooth_step(1 - away) * (1 + 0.1 * self.noise(0.1)))

    def labels_at(self, x, z):
        i, j = (np.round((a - a0) / self.cell_m) for a, a0 in ((x, self.x0), (z, self.z0)))
        inside = (i >= 0) & (j >= 0) & (i < self.shape[1]) & (j < self.shape[0])
        return np.where(inside, self.labels[np.where(inside, j, 0).astype(int), np.where(inside, i, 0).astype(int)], 0)

    def place(self):
        """Of a texture or shape that fills a square, on the ground."""
        return f"scale <{self.x1 - self.x0},1,{self.z1 - self.z0}> translate <{self.x0},0,{self.z0}>"

    def write(self, folder):
        height = np.clip(self.height / HEIGHT_RANGE_M + 0.5, 0, 1) * 65535
        cv2.imwrite(str(folder / "road.png"), np.round(height[::-1]).astype(np.uint16))
        cv2.imwrite(str(folder / "materials.png"), self.material[::-1])


def rgb(colour):
    return "rgb <%.4f,%.4f,%.4f>" % tuple(np.clip(colour, 0.005, 0.95))


def stones(g, albedo, size_m, contrast, tint=GREY):
    """Texture of stones in bitumen or cement."""

    def grey(deviation):
        return rgb(albedo * (1 + contrast * deviation) * tint)

    return f"""pigment {{ average pigment_map {{
      [2 crackle form <1,0,0> turbulence 0.2 color_map {{ [0 {grey(-0.9)}] [0.25 {grey(-0.2)}] [0.6 {grey(0.4)}]
        [1 {grey(1.2)}] }} scale {size_m}]
      [2 cells color_map {{ [0 {grey(-0.9)}] [0.6 {grey(-0.1)}] [0.9 {grey(0.7)}] [1 {grey(1.8)}] }} scale {0.9 * size_m:.4f}]
      [1 granite color_map {{ [0 {grey(-0.8)}] [1 {grey(0.8)}] }} scale {g.uniform(0.1, 0.4):.3f}]
      [1 bozo turbulence 0.6 color_map {{ [0 {grey(-0.3)}] [1 {grey(0.3)}] }} scale {g.uniform(0.4, 2.5):.3f}] }} }}
      normal {{ granite {g.uniform(0, 0.3):.3f} scale {4 * size_m:.4f} }}"""


class Scene:
    def __init__(self, seed, folder):
        self.g = g = np.random.default_rng(seed)
        self.seed, self.folder = seed, pathlib.Path(folder)
        self.view = g.choice(["street", "street", "rig", "oblique", "nadir"])
        self.width, self.height = SIZES[g.integers(len(SIZES))]
        limits = VIEWS[self.view]
        self.focal_px = self.width / 2 / math.tan(math.radians(g.uniform(*limits["fov"])) / 2)
        self.camera_height, self.pitch = g.uniform(*limits["height"]), g.uniform(*limits["pitch"])
        self.roll, self.yaw = g.normal(0, limits["roll"]), g.normal(0, limits["yaw"])
        self.baseline = g.uniform(*limits["baseline"])
        self.objects, self.lights = [], []  # shape, region, texture
        self.make_road()
        for side, edge in (-1, self.ground.x0), (1, self.ground.x1):
            self.make_side(side, edge)
            if self.view == "street":
                self.make_street(side, edge)
        self.make_light()

    def rotation(self):
        """Of right, up and forward of the camera, into a left-handed world as POV-Ray's."""
        (sr, cr), (sp, cp), (sy, cy) = ((math.sin(a), math.cos(a)) for a in map(math.radians, (self.roll, self.pitch, self.yaw)))
        roll = np.array([[cr, -sr, 0], [sr, cr, 0], [0, 0, 1]])
        pitch = np.array([[1, 0, 0], [0, cp, -sp], [0, sp, cp]])
        yaw = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
        return yaw @ pitch @ roll

    def ground_in_view(self):
        """Places of the ground within 40 m that the picture shows."""
        u, v = np.meshgrid(np.linspace(-self.width / 2, self.width / 2, 41), np.linspace(-self.height / 2, self.height / 2, 41))
        rays = np.stack([u, -v, np.full_like(u, self.focal_px)], -1) @ self.rotation().T
        rays = rays[rays[..., 1] < -1e-6]
        places = rays[:, ::2] * (self.camera_height / -rays[:, 1:2])
        return places[np.hypot(*places.T) < 40]

    def make_road(self):
        g, seen = self.g, self.ground_in_view()
        (x0, z0), (x1, z1) = seen.min(0) - 0.3, seen.max(0) + 0.3
        street = self.view == "street"
        if street:
            half = g.uniform(2.8, 4.5)
            middle = g.uniform(-0.6, 0.6) * (half - 1.2)
            x0, x1, z0, z1 = middle - half, middle + half, max(0.5, z0), 32.0
        elif g.random() < 0.5:  # one edge of the road is seen
            edge = (x1 - x0) * g.uniform(0.05, 0.3)
            x0, x1 = (x0 + edge, x1) if g.random() < 0.5 else (x0, x1 - edge)
        cell_m = 0.012 if street else max(0.006, math.sqrt((x1 - x0) * (z1 - z0) / 4e6))
        self.ground = Ground(g, x0, x1, z0, z1, cell_m)
        self.ground.shape_road()
        self.make_surface()
        scale = max(1, self.camera_height / math.sin(math.radians(max(self.pitch, 12))) / 4)
        far = min(14.0, z1 - 0.5) if street else z1 - 0.4
        for _ in range(g.integers(5)):
            x, z = g.uniform(x0 + 0.5, x1 - 0.5), g.uniform(max(z0, seen[:, 1].min()) + 0.4, far)
            if g.random() < 0.65:
                self.ground.add_pothole(x, z, g.uniform(0.15, 0.9) * scale, self.rubble)
            else:
                self.ground.add_bump(x, z, g.uniform(0.2, 1.0) * scale)

    def make_surface(self):
        """What is on the road and no damage."""
        g, ground = self.g, self.ground
        self.surface = g.choice(list(SURFACES))
        albedo, size_m, contrast = SURFACES[self.surface]
        contrast *= g.uniform(0.5, 1.4)
        tint = GREY + np.array([0.03, 0, -0.04]) * g.normal()
        self.wet = bool(g.random() < 0.15)
        finish = MATT if not self.wet else MATT[:-1] + "specular 0.3 roughness 0.02 reflection { 0.01, 0.2 } }"
        self.materials = []

        def material(texture):
            self.materials.append(f"texture {{ {texture} {finish} ")
            return len(self.materials) - 1

        def place():
            return g.uniform(ground.x0, ground.x1), g.uniform(ground.z0, min(ground.z1, ground.z0 + 12))

        material(stones(g, albedo, size_m, contrast, tint))
        self.rubble = material(stones(g, albedo * g.uniform(0.7, 1.4), g.uniform(0.02, 0.04), 0.8, tint))
        for _ in range(g.integers(5)):  # patches of another asphalt
            x, z = place()
            inside = (ground.x > x) & (ground.x < x + g.uniform(0.3, 2)) & (ground.z > z) & (ground.z < z + g.uniform(0.3, 3))
            ground.material[inside] = material(stones(g, albedo * g.uniform(0.4, 1.3), size_m, contrast, tint))
        for _ in range(g.choice([0, 0, 1, 3])):  # sealed cracks
            crack = place()[1] + 0.3 * noise(g, (1, ground.shape[1]), ground.cell_m, 0.6)
            ground.material[np.abs(ground.z - crack) < g.uniform(0.015, 0.05)] = material("pigment { rgb 0.02 }")
        for _ in range(g.choice([0, 0, 1, 2])):  # stains of oil
            away = ground.radii_from(*place(), *g.uniform(0.1, 0.6, 2), raggedness=0.4)
            ground.material[away < 1] = material(stones(g, 0.35 * albedo, size_m, contrast, tint))
        if g.random() < 0.6:
            self.paint(material)

    def paint(self, material):
        """A line along the road, and perhaps a crossing; worn."""
        g, ground = self.g, self.ground
        x = g.uniform(ground.x0 + 0.5, ground.x1 - 0.5)
        paint = (ground.x > x) & (ground.x < x + g.uniform(0.1, 0.2)) & (np.mod(ground.z, 3) < g.choice([1.5, 3]))
        if g.random() < 0.5:
            z = g.uniform(ground.z0, ground.z0 + 8)
            paint = paint | ((np.mod(ground.x, 1) < 0.5) & (ground.z > z) & (ground.z < z + g.uniform(0.3, 3)))
        left = ground.noise(0.05) + ground.noise(0.02) < g.uniform(0.8, 3)
        white = [rgb(level * GREY) for level in (g.uniform(0.5, 0.85), 0.45)]
        ground.material[paint & left] = material(f"pigment {{ granite color_map {{ [0 {white[0]}] [1 {white[1]}] }} scale 0.2 }}")

    def add(self, shape, region, texture, finish=MATT):
        self.objects.append((shape, region, f"texture {{ {texture} {finish} }}"))

    def add_slab(self, from_x, to_x, top, region, texture):
        self.add(f"box {{ <{min(from_x, to_x)},-1,-20>,<{max(from_x, to_x)},{top},90> }}", region, texture)

    def make_side(self, side, edge):
        g, far = self.g, edge + 40 * side
        kind = g.choice(["kerb", "grass", "gravel", "road"] if self.view == "street" else ["kerb", "grass", "gravel"])
        if kind == "kerb":
            top = g.uniform(0.06, 0.16)
            self.add_slab(edge, edge + 0.15 * side, top, OBSTACLE, stones(g, 0.4, 0.01, 0.2))
            tiles = f"pigment {{ checker {rgb(0.33 * GREY)}, {rgb(0.29 * GREY)} scale 0.3 }} normal {{ granite 0.2 scale 0.05 }}"
            self.add_slab(edge + 0.15 * side, far, top - 0.005, VERGE, tiles)
        elif kind == "grass":
            self.make_grass(side, edge)
        else:
            gravel = kind == "gravel"
            texture = stones(g, 0.3, 0.04, 0.6, np.array([1.05, 1, 0.9])) if gravel else stones(g, 0.15, 0.012, 0.5)
            self.add_slab(edge, far, -0.02, VERGE if gravel else ROAD, texture)

    def make_grass(self, side, edge):
        g, width_m, length_m, shape = self.g, 3.0, 18.0, (700, 120)
        height = 0.5 + sum(a * noise(g, shape, length_m / shape[0], scale) for scale, a in ((0.15, 0.03), (0.05, 0.03)))
        cv2.imwrite(str(self.folder / f"grass{side}.png"), (np.clip(height, 0, 1) * 65535).astype(np.uint16))
        x0 = min(edge, edge + width_m * side)
        self.add(f'height_field {{ png "grass{side}.png" gamma 1.0 smooth scale <{width_m},0.6,{length_m}> '
                 f'translate <{x0},{g.uniform(-0.35, -0.1)},{self.ground.z0 - 1}> }}', VERGE, GRASS)
        self.add_slab(edge, edge + width_m * side, -0.05, VERGE, GRASS)
        self.add_slab(edge + width_m * side, edge + 40 * side, 0.05, VERGE, GRASS)

    def make_street(self, side, edge):
        g = self.g
        if g.random() < 0.6:
            z = g.uniform(6, 12)
            while z < 45:
                if g.random() < 0.7:
                    self.make_car(edge - side, z)
                z += g.uniform(5.2, 9)
        if g.random() < 0.6:
            z, front = g.uniform(2, 8), edge + side * g.uniform(2, 6)
            while z < 60:
                length_m = g.uniform(6, 15)
                self.make_house(side, front, z, length_m, g.uniform(5, 14))
                z += length_m + (0 if g.random() < 0.7 else 4)
        bark = "pigment { bozo color_map { [0 rgb 0.05] [1 rgb <0.25,0.2,0.15>] } scale <0.03,0.2,0.03> }"
        for _ in range(g.integers(5)):
            x, z = edge + side * g.uniform(0.6, 2.5), g.uniform(3, 35)
            self.add(f"cylinder {{ <{x},-1,{z}>,<{x},{g.uniform(2, 5)},{z}>,{g.uniform(0.04, 0.2)} }}", OBSTACLE, bark)

    def make_house(self, side, front, z, length_m, height_m):
        wall = rgb(self.g.uniform(0.2, 0.7, 3) * np.array([1, 0.9, 0.8]))
        back = front + 10 * side
        self.add(f"box {{ <{min(front, back)},-1,{z}>,<{max(front, back)},{height_m},{z + length_m}> }}", BACKGROUND,
                 f"pigment {{ brick {rgb(0.4 * GREY)}, {wall} brick_size <0.25,0.08,0.12> mortar 0.01 }}")
        x0, x1 = sorted((front, front - 0.02 * side))
        for z0 in np.arange(z + 1, z + length_m - 1.5, 2.5):
            for y0 in np.arange(1, height_m - 1.5, 3):
                self.add(f"box {{ <{x0},{y0},{z0}>,<{x1},{y0 + 1.4},{z0 + 1}> }}", BACKGROUND, "pigment { rgb <0.05,0.06,0.08> }",
                         "finish { ambient AMBIENT diffuse 0.2 reflection 0.35 }")

    def make_car(self, x, z):
        g = self.g
        paint = f"pigment {{ {rgb(g.choice([0.02, 0.1, 0.4, 0.7]) * g.uniform(0.6, 1.2, 3))} }}"
        shine = MATT[:-1] + "specular 0.6 roughness 0.01 reflection 0.15 }"
        self.add(f"superellipsoid {{ <0.2,0.3> scale <0.88,0.38,2.15> translate <{x},0.62,{z}> }}", OBSTACLE, paint, shine)
        self.add(f"superellipsoid {{ <0.3,0.4> scale <0.75,0.34,1.2> translate <{x},1.2,{z + 0.2}> }}", OBSTACLE,
                 "pigment { rgb 0.03 }", "finish { ambient 0 diffuse 0.2 reflection 0.4 }")
        for x0 in x - 0.85, x + 0.7:
            for z0 in z - 1.35, z + 1.35:
                self.add(f"cylinder {{ <{x0},0.32,{z0}>,<{x0 + 0.15},0.32,{z0}>,0.32 }}", OBSTACLE, "pigment { rgb 0.015 }")

    def make_light(self):
        g = self.g
        self.sunny = bool(g.random() < 0.6)
        if not self.sunny:
            for k in range(3):
                azimuth = g.uniform(0, 2 * math.pi)
                place = f"<{60 * math.cos(azimuth)},90,{60 * math.sin(azimuth)}>"
                self.lights.append(f"light_source {{ {place} rgb 0.25 {'' if k else 'shadowless'} }}")
            return
        elevation, azimuth = math.radians(g.uniform(15, 70)), g.uniform(0, 2 * math.pi)
        sun = np.array([math.cos(elevation) * math.sin(azimuth), math.sin(elevation), math.cos(elevation) * math.cos(azimuth)])
        self.lights.append(f"light_source {{ <{','.join(map(str, 100 * sun))}> rgb <1.15,1.08,0.95> parallel point_at <0,0,0> }}")
        if g.random() < 0.4:  # leaves above the picture
            for _ in range(160):
                at = np.array([g.uniform(-4, 4), 0, self.ground.z0 + 3 + g.uniform(-4, 8)]) + 9 * sun / sun[1]
                self.add(f"sphere {{ <{','.join(map(str, at))}>,{g.uniform(0.05, 0.35)} no_image no_reflection }}", BACKGROUND,
                         "pigment { rgb 0.1 }")

    def source(self, what, right):
        """Scene for POV-Ray that shows a picture, the distance or the region of each pixel."""
        ground = self.ground
        sky = ("<0.4,0.55,0.9>", "<0.45,0.6,0.9>") if self.sunny else ("0.7", "0.8")
        to_square = f"translate <{-ground.x0},0,{-ground.z0}> scale <{1 / (ground.x1 - ground.x0)},1,{1 / (ground.z1 - ground.z0)}>"
        materials = " ".join(texture + to_square + " rotate <-90,0,0> }" for texture in self.materials)
        road = f'texture {{ material_map {{ png "materials.png" interpolate 0 {materials} }} rotate <90,0,0> {ground.place()} }}'
        around = stones(np.random.default_rng(self.seed), 0.15, 0.012, 0.5)
        level = float(ground.height.mean())
        objects = self.objects + [
            (f"box {{ <{ground.x0},-1,{z0}>,<{ground.x1},{level},{z1}> }}", ROAD, f"texture {{ {around} {MATT} }}")
            for z0, z1 in ((-20.0, ground.z0), (ground.z1, 90.0))
        ]
        field = f'png "road.png" gamma 1.0 smooth translate <0,-0.5,0> scale <1,{HEIGHT_RANGE_M},1> {ground.place()}'
        objects.append((f"height_field {{ {field} }}", ROAD, road))
        lines = [f"""#version 3.7; global_settings {{ assumed_gamma 1.0 max_trace_level 4 }}
#declare AMBIENT = {0.35 if self.sunny else 0.5};
#declare Pose = transform {{ translate <{self.baseline if right else 0},0,0> rotate <0,0,{self.roll}> rotate <{self.pitch},0,0>
  rotate <0,{self.yaw},0> translate <0,{self.camera_height},0> }}
camera {{ perspective location 0 direction z*{self.focal_px} right x*{self.width} up y*{self.height} transform {{ Pose }} }}"""]
        if what == "picture":
            lines += self.lights
            lines.append(f"""sky_sphere {{ pigment {{ bozo turbulence 0.6 color_map {{ [0 rgb {sky[0]}] [0.5 rgb {sky[1]}] [1 rgb 0.95] }}
  scale <0.3,0.15,0.3> }} }}""")
        else:  # its remainders modulo 200, 1 and 12.5 m
            lines.append("""background { rgb 0 } #declare Distance = texture { pigment { average pigment_map {
  [1 gradient z color_map { [0 rgb 0] [1 rgb <3,0,0>] } scale 200]
  [1 gradient z color_map { [0 rgb 0] [1 rgb <0,3,0>] }]
  [1 gradient z color_map { [0 rgb 0] [1 rgb <0,0,3>] } scale 12.5] } transform { Pose } }
  finish { emission 1 ambient 0 diffuse 0 } }""")
        for shape, region, texture in objects:
            if what != "picture" and "no_image" in shape:
                continue
            if what == "distance":
                texture = "texture { Distance }"
            elif what == "region":
                texture = f"texture {{ pigment {{ rgb {region}/255 }} finish {{ emission 1 ambient 0 diffuse 0 }} }}"
            lines.append(f"object {{ {shape} {texture} }}")
        return "\n".join(lines)

    def render(self, what, right=False, rays=1):
        """Red, green and blue, 0 … 1, linear."""
        name = self.folder / f"{what}{int(right)}"
        name.with_suffix(".pov").write_text(self.source(what, right))
        command = ["povray", f"+I{name}.pov", f"+O{name}.png", f"+W{rays * self.width}", f"+H{rays * self.height}",
                   "+FN16", "File_Gamma=1.0", "-D", "-A", "+WT1", "-GA"]
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f"povray fails for seed {self.seed}: {done.stderr[-2000:]}")
        image = cv2.imread(f"{name}.png", cv2.IMREAD_UNCHANGED)[..., ::-1] / 65535
        return image.reshape(self.height, rays, self.width, rays, 3).mean((1, 3))

    def distance(self, right):
        far, fine, middle = np.moveaxis(self.render("distance", right), -1, 0)
        middle = 12.5 * (middle + np.round((200 * far - 12.5 * middle) / 12.5))
        return np.where(far > 0, fine + np.round(middle - fine), np.nan)

    def expose(self, light, side, fault, sensor):
        """Lens and sensor: linear light of the road about 0.2, to 8 bits."""
        g = self.g
        light = light * (1 if side == 0 else sensor["gain"])
        light = cv2.GaussianBlur(light, (0, 0), g.uniform(0.4, 0.6) + (g.uniform(0.8, 2.2) if fault == "defocus" else 0))
        if fault == "motion":
            light = cv2.blur(light, (1, sensor["motion_px"]))
        if fault == "rows" and side == 1:
            shift = np.array([[1, 0, 0], [0, 1, sensor["rows_px"]]])
            light = cv2.warpAffine(light, shift, light.shape[1::-1], flags=cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE)
        electrons = g.poisson(np.clip(light, 0, 1) * sensor["full_well"]) + g.normal(0, 4, light.shape)
        image = np.round(255 * np.clip(electrons / sensor["full_well"], 0, 1) ** (1 / 2.2)).astype(np.uint8)
        if fault == "jpeg":
            _, file = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, sensor["quality"]])
            image = cv2.imdecode(file, cv2.IMREAD_UNCHANGED)
        return image

    def write(self, output):
        g = self.g
        self.ground.write(self.folder)
        pictures = [self.render("picture", right, RAYS) for right in (False, True)]
        distances = [self.distance(right) for right in (False, True)]
        region = np.round(255 * self.render("region")[..., 0]).astype(np.uint8)
        disparity, in_right = (np.nan_to_num(self.focal_px * self.baseline / z) for z in distances)
        u, v = np.meshgrid(np.arange(self.width), np.arange(self.height))
        column = np.round(u - disparity).astype(int)
        there = np.take_along_axis(in_right, np.clip(column, 0, self.width - 1), 1)
        seen = np.abs(there - disparity) < np.maximum(1, 0.03 * disparity)
        occ = np.where(disparity == 0, HIDDEN, np.where(column < 0, OUTSIDE, np.where(seen, SEEN_BY_BOTH, HIDDEN)))
        rays = np.stack([u - (self.width - 1) / 2, (self.height - 1) / 2 - v, np.full(u.shape, self.focal_px)], -1)
        world = rays / self.focal_px * np.nan_to_num(distances[0])[..., None] @ self.rotation().T
        labels = np.where(region == ROAD, self.ground.labels_at(world[..., 0], world[..., 2]), 0).astype(np.uint16)
        region[labels > 0] = DAMAGE

        fault = g.choice(["clean", "clean", "clean", "noise", "defocus", "motion", "jpeg", "under", "over", "rows"])
        sensor = {
            "full_well": {"noise": g.uniform(300, 1200), "under": g.uniform(1500, 4000)}.get(fault, g.uniform(6000, 20000)),
            "level": {"under": 0.35, "over": 1.6}.get(fault, g.uniform(0.8, 1.1)),
            "gain": g.uniform(0.95, 1.05),
            "motion_px": int(g.integers(2, 8)),
            "rows_px": g.uniform(-0.5, 0.5),
            "quality": int(g.integers(25, 60)),
        }
        if g.random() < 0.5:  # grey, blue green red otherwise
            pictures = [picture @ np.array([0.3, 0.55, 0.15]) for picture in pictures]
        else:
            pictures = [np.ascontiguousarray(picture[..., ::-1]) for picture in pictures]
        road = pictures[0][(region == ROAD) | (region == DAMAGE)]
        exposure = 0.2 * sensor["level"] / max(np.percentile(road, 60) if road.size else 0.2, 1e-4)

        output.mkdir(parents=True, exist_ok=True)
        for side, name in enumerate(("left.png", "right.png")):
            cv2.imwrite(str(output / name), self.expose(exposure * pictures[side], side, fault, sensor))
        cv2.imwrite(str(output / "disparity.tiff"), np.where(disparity > 0, disparity, np.nan).astype(np.float32))
        cv2.imwrite(str(output / "occ.png"), occ.astype(np.uint8))
        cv2.imwrite(str(output / "region.png"), region)
        cv2.imwrite(str(output / "damage.png"), labels)
        (output / "calibration.yaml").write_text(
            f"focal_px: {self.focal_px:.4f}\ncx_px: {(self.width - 1) / 2}\ncy_px: {(self.height - 1) / 2}\n"
            f"baseline_m: {self.baseline:.5f}\nwidth: {self.width}\nheight: {self.height}\n")
        damages = [dict(damage, pixels=int((labels == damage["label"]).sum())) for damage in self.ground.damages]
        (output / "truth.json").write_text(json.dumps({
            "seed": self.seed, "view": self.view, "surface": self.surface, "wet": self.wet, "sunny": self.sunny,
            "height_m": self.camera_height, "pitch_deg": self.pitch, "roll_deg": self.roll, "yaw_deg": self.yaw,
            "group": fault, "sensor": sensor, "damages": [damage for damage in damages if damage["pixels"] > 0],
        }, indent=1))  # fmt: skip


def render_scene(task):
    seed, output = task
    with tempfile.TemporaryDirectory() as folder:
        scene = Scene(seed, folder)
        scene.write(output)
    return f"{output.name}: {scene.view}, {scene.surface}, {scene.width}×{scene.height}, {len(scene.ground.damages)} damages"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--scenes", type=int, default=48)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    tasks = [(1000 * options.seed + k, options.output / f"{options.seed:02d}_{k:03d}") for k in range(options.scenes)]
    with concurrent.futures.ProcessPoolExecutor(options.jobs) as pool:
        for line in pool.map(render_scene, tasks):
            print(line, flush=True)


if __name__ == "__main__":
    main()
