"""Odometry: the poses of `inspect --trajectory`, and of the renderer."""

import threading
import unittest

import numpy as np
from rendered_road import FOLDER, pair, run

import roadstereo


class Odometry(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        flight = FOLDER / "odometry"
        run("synth", "--scene", "demo", "--size", "320x180", "--frames", 4, "--flight", "default", "--output", flight)
        run("inspect", flight, "--calibration", flight / "calibration.yaml", "--trajectory", "--output", FOLDER / "poses")
        cls.written = np.loadtxt(FOLDER / "poses" / "trajectory_kitti.txt").reshape(-1, 3, 4)
        cls.calibration = roadstereo.read_calibration(flight / "calibration.yaml")
        pipeline = roadstereo.Pipeline("default", cls.calibration)
        cls.results = [pipeline.process(pair.left, pair.right) for pair in roadstereo.open_source(flight)]

    def odometry(self, **options):
        return roadstereo.Odometry(self.calibration, **options)

    def test_poses_equal_those_of_command_line(self):
        odometry = self.odometry()
        self.assertEqual((odometry.reference, odometry.links, odometry.trajectory), (-1, [], []))
        poses = [odometry.add(frame, result) for frame, result in enumerate(self.results)]
        self.assertEqual([(pose.frame, pose.piece) for pose in poses], [(frame, 0) for frame in range(4)])
        found = np.array([pose.camera_to_world for pose in odometry.trajectory])
        np.testing.assert_allclose(found, self.written, atol=1e-6)
        self.assertGreater(np.linalg.norm(found[3, :, 3]), 0.01)

    def test_links_agree_with_poses(self):
        odometry = self.odometry()
        poses = [odometry.add(frame, result) for frame, result in enumerate(self.results)]
        link = odometry.links[0]
        self.assertEqual((link.from_frame, link.to_frame, link.status), (0, 1, "good"))
        step = np.vstack([link.motion, [0, 0, 0, 1]])
        np.testing.assert_allclose(np.linalg.inv(step)[:3], poses[1].camera_to_world, atol=1e-9)
        for covariance in (link.covariance, poses[1].covariance):
            np.testing.assert_allclose(covariance, covariance.T, rtol=1e-9)
            self.assertTrue((np.linalg.eigvalsh(covariance) > 0).all())
        self.assertTrue(0.5 < link.correlation <= 1 and 0.5 < link.overlap <= 1)

    def test_refused(self):
        odometry = self.odometry()
        odometry.add(5, self.results[0])
        with self.assertRaisesRegex(roadstereo.Error, "indices must grow"):
            odometry.add(5, self.results[1])
        other = roadstereo.Pipeline("fast").process(*(frame[:160] for frame in pair()))
        with self.assertRaises(roadstereo.Error):
            odometry.add(6, other)
        with self.assertRaisesRegex(roadstereo.Error, "^odometry.min_overlap is 2; it must be between 0 and 1$"):
            self.odometry(min_overlap=2)
        with self.assertRaisesRegex(roadstereo.Error, "calibration: the baseline is -1; it must be between"):
            roadstereo.Odometry(roadstereo.Calibration(300, 160, 90, -1)).add(0, self.results[0])
        with self.assertRaises(TypeError):
            roadstereo.Odometry(None)
        with self.assertRaises(TypeError):
            odometry.add(7, self.results[0].disparity)

    def test_several_threads(self):
        odometry = self.odometry()
        odometry.add(0, self.results[0])
        failures = []

        def add():
            try:
                odometry.add(1, self.results[1])
            except roadstereo.Error as error:
                failures.append(str(error))

        threads = [threading.Thread(target=add) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(failures), 2)
        self.assertEqual(len(odometry.trajectory), 2)


if __name__ == "__main__":
    unittest.main()
