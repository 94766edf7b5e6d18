"""Maps of the road: heights of the triangulated points, fused over frames."""

import unittest

import numpy as np
from rendered_road import FOLDER, run

import roadstereo


class RoadMap(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        flight = FOLDER / "map"
        run("synth", "--scene", "demo", "--size", "320x180", "--frames", 4, "--flight", "default", "--output", flight)
        calibration = roadstereo.read_calibration(flight / "calibration.yaml")
        pipeline = roadstereo.Pipeline("default", calibration)
        odometry = roadstereo.Odometry(calibration)
        cls.calibration = calibration
        cls.pairs = list(roadstereo.open_source(flight))
        cls.results = [pipeline.process(pair.left, pair.right) for pair in cls.pairs]
        to_map = np.vstack([roadstereo.camera_to_road(cls.results[0]), [0, 0, 0, 1]])
        poses = [odometry.add(index, result).camera_to_world for index, result in enumerate(cls.results)]
        cls.poses = [to_map @ np.vstack([pose, [0, 0, 0, 1]]) for pose in poses]

    def new_map(self, **options):
        return roadstereo.RoadMap(**{"cell_m": 0.02, **options})

    def points_in_map(self):
        """The triangulated points of the first frame, (N, 3), and their grey levels."""
        points, colours = roadstereo.cloud_from_disparity(
            self.results[0].disparity, self.calibration, self.pairs[0].left
        )
        return points @ self.poses[0][:3, :3].T + self.poses[0][:3, 3], colours

    def test_heights_and_picture_are_those_of_points(self):
        road = self.new_map()
        self.assertEqual(road.bounds[2:], [0, 0])
        cells = road.add(self.results[0], self.poses[0], self.pairs[0].left)
        raster = road.read()
        i0, j0, columns, rows = raster.box
        self.assertEqual(raster.height.shape, (rows, columns))
        self.assertEqual(cells, np.isfinite(raster.height).sum())
        points, colours = self.points_in_map()
        u = np.floor(points[:, 0] / road.cell_m).astype(int) - i0
        v = j0 + rows - 1 - np.floor(points[:, 1] / road.cell_m).astype(int)
        inside = (u >= 0) & (u < columns) & (v >= 0) & (v < rows)
        difference = raster.height[v[inside], u[inside]] - points[inside, 2]
        known = np.isfinite(difference)
        self.assertGreater(known.mean(), 0.9)
        self.assertLess(np.median(np.abs(difference[known])), 0.002)
        shown = raster.colour[v[inside], u[inside]].astype(float)[known].mean(axis=1)
        self.assertGreater(np.corrcoef(shown, colours[inside][known].mean(axis=1))[0, 1], 0.8)
        self.assertFalse(raster.height.flags.writeable)

    def test_frames_are_fused(self):
        road = self.new_map()
        for result, pose in zip(self.results, self.poses):
            road.add(result, pose[:3])
        raster = road.read()
        self.assertEqual(raster.views.max(), 4)
        one = self.new_map()
        one.add(self.results[0], self.poses[0])
        box = one.read().box
        seen = road.read(box).views == 4
        self.assertLess(np.median(road.read(box).sigma[seen]), np.median(one.read(box).sigma[seen]))

    def test_damage_lies_where_the_frame_has_it(self):
        road = self.new_map(cell_m=0.01)
        for result, pose in zip(self.results, self.poses):
            road.add(result, pose)
        found = road.find_damage()
        deepest = roadstereo.find_damage(self.results[0]).damages[0]
        u, v = deepest.deepest_px
        disparity = self.results[0].disparity[v, u]
        focal, baseline = self.calibration.focal_px, self.calibration.baseline_m
        z = focal * baseline / disparity
        point = np.array([(u - self.calibration.cx_px) * z / focal, (v - self.calibration.cy_px) * z / focal, z, 1])
        place = (self.poses[0] @ point)[:2]
        nearest = min(found, key=lambda each: np.hypot(*(np.array(each.at_m) - place)))
        self.assertLess(np.hypot(*(np.array(nearest.at_m) - place)), 0.3)
        self.assertAlmostEqual(nearest.damage.metrics.max_depth_m.value, deepest.metrics.max_depth_m.value, delta=0.02)

    def test_cell_is_suggested_without_size_of_calibration(self):
        values = self.calibration
        sizeless = roadstereo.Calibration(values.focal_px, values.cx_px, values.cy_px, values.baseline_m)
        result = roadstereo.Pipeline("default", sizeless).process(self.pairs[0].left, self.pairs[0].right)
        self.assertEqual(roadstereo.suggested_cell_m(result), roadstereo.suggested_cell_m(self.results[0]))

    def test_folder_of_others_is_left_alone(self):
        mine = FOLDER / "mine"
        mine.mkdir()
        (mine / "notes.txt").write_text("mine", encoding="utf-8")
        with self.assertRaisesRegex(roadstereo.Error, "holds notes.txt"):
            roadstereo.RoadMap(mine)
        self.assertTrue((mine / "notes.txt").exists())
        road = roadstereo.RoadMap(FOLDER / "named")
        self.assertTrue((FOLDER / "named").is_dir())
        del road
        self.assertFalse((FOLDER / "named").exists())

    def test_refused(self):
        road = self.new_map()
        with self.assertRaisesRegex(roadstereo.Error, "camera_to_map is no rigid motion"):
            road.add(self.results[0], 1000 * self.poses[0][:3])
        for box in ([0, 0, -1, 5], [0, 0, 100000, 100000]):
            with self.assertRaisesRegex(roadstereo.Error, "a box has"):
                road.read(box)
        with self.assertRaisesRegex(roadstereo.Error, "the last row of camera_to_map is 1, 2, 3, 1; it must be 0, 0, 0, 1"):
            road.add(self.results[0], np.array([*np.eye(4)[:3], [1, 2, 3, 1]]))
        with self.assertRaisesRegex(roadstereo.Error, r"camera_to_map has the shape \(3, 3\); it must be \(3, 4\) or \(4, 4\)"):
            road.add(self.results[0], np.eye(3))
        with self.assertRaisesRegex(roadstereo.Error, "cell_m is 0"):
            self.new_map(cell_m=0)
        with self.assertRaisesRegex(roadstereo.Error, "the image has 320×100 pixels; it must have 320×180"):
            road.add(self.results[0], self.poses[0], self.pairs[0].left[:100])
        bare = roadstereo.Pipeline("default").process(self.pairs[0].left, self.pairs[0].right)
        with self.assertRaisesRegex(roadstereo.Error, "the result has no calibration"):
            road.add(bare, self.poses[0])
        self.assertEqual(road.read().height.size, 0)


if __name__ == "__main__":
    unittest.main()
