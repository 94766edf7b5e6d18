"""Successive pairs, masks, one pipeline in several threads; the module as a whole."""

import inspect
import subprocess
import sys
import threading
import unittest

import numpy as np
from rendered_road import calibration, noise_pair, pair, run

import roadstereo


class Pairs(unittest.TestCase):
    def test_road_is_tracked(self):
        pipeline = roadstereo.Pipeline("default", calibration())
        statuses = [pipeline.process(*pair()).road.status for _ in range(3)]
        pipeline.reset()
        statuses.append(pipeline.process(*pair()).road.status)
        self.assertEqual(statuses, ["found", "tracked", "tracked", "found"])

    def test_sizes_in_turn(self):
        left, right = pair()
        pairs = [(left, right), (left[40:, :240], right[40:, :240]), (left[:150], right[:150])]
        expected = [roadstereo.Pipeline("default").process(*frames) for frames in pairs]
        pipeline, results = roadstereo.Pipeline("default"), []
        for turn in range(6):
            results.append(pipeline.process(*pairs[turn % 3]))
        for turn, result in enumerate(results):  # also the first ones are still what they were
            self.assertEqual(result.disparity.shape, pairs[turn % 3][0].shape)
            self.assertEqual(result.disparity.tobytes(), expected[turn % 3].disparity.tobytes(), turn)
            self.assertEqual(result.road.status, "found")
        of_whole_pair = roadstereo.Calibration(300, 160, 90, 0.25, width=320, height=180)
        pipeline = roadstereo.Pipeline("default", of_whole_pair)
        pipeline.process(*pairs[0])
        with self.assertRaisesRegex(roadstereo.Error, "is for 320×180 pixels, but the images have 320×150"):
            pipeline.process(*pairs[2])
        self.assertEqual(pipeline.process(*pairs[0]).road.status, "tracked")

    def test_warm_up_leaves_result(self):
        cold, warm = (roadstereo.Pipeline("default", calibration()) for _ in range(2))
        warm.warm_up(320, 180)
        self.assertEqual(cold.process(*pair()).disparity.tobytes(), warm.process(*pair()).disparity.tobytes())
        with self.assertRaisesRegex(roadstereo.Error, "32×32"):
            roadstereo.Pipeline().warm_up(8, 8)

    def test_mask(self):
        mask = np.zeros((180, 320), bool)
        mask[150:, 100:220] = True
        pipeline = roadstereo.Pipeline("default", calibration())
        for given in (mask, mask.astype(np.uint8) * 255, np.asfortranarray(mask)):
            pipeline.set_mask(given)
            result = pipeline.process(*pair())
            self.assertTrue(np.array_equal(result.mask != 0, mask))
            self.assertTrue(np.isnan(result.disparity[mask]).all())
        pipeline.set_mask(None)
        result = pipeline.process(*pair())
        self.assertIsNone(result.mask)
        self.assertTrue(np.isfinite(result.disparity[mask]).any())

    def test_bad_masks(self):
        pipeline = roadstereo.Pipeline()
        for mask in ([[1]], np.zeros((180, 320)), np.zeros((180, 320), np.uint16)):
            with self.assertRaisesRegex(TypeError, "it must be None or a numpy array of bool or uint8"):
                pipeline.set_mask(mask)
        with self.assertRaisesRegex(roadstereo.Error, "^mask has 3 dimensions"):
            pipeline.set_mask(np.zeros((180, 320, 1), bool))
        pipeline.set_mask(np.ones((3, 4), bool))
        with self.assertRaisesRegex(roadstereo.Error, "the mask has 4×3 pixels; it must have 320×180"):
            pipeline.process(*pair())

    def test_one_pipeline_in_several_threads(self):
        # Without the perspective transformation nothing is carried over: results do not depend on the order.
        pipeline = roadstereo.Pipeline("fast", options={"perspective.enabled": False, "narrow_search": False})
        pairs = [noise_pair(), pair(), tuple(frame[:150] for frame in pair())]
        expected = [pipeline.process(*frames).disparity.tobytes() for frames in pairs]
        self.assertEqual(len(set(expected)), 3)
        found = [[] for _ in pairs]

        def work(k):
            for _ in range(8):
                found[k].append(pipeline.process(*pairs[k]).disparity.tobytes() == expected[k])
                pipeline.options, pipeline.engine_name

        threads = [threading.Thread(target=work, args=[k]) for k in range(len(pairs))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(found, [[True] * 8] * len(pairs))

    def test_interpreter_runs_meanwhile(self):
        frames = [np.kron(frame, np.ones((4, 4), np.uint8)) for frame in pair()]
        pipeline = roadstereo.Pipeline("default", options={"perspective.enabled": False, "narrow_search": False})
        ended, turns = threading.Event(), 0
        worker = threading.Thread(target=lambda: (pipeline.process(*frames), ended.set()))
        worker.start()
        while not ended.wait(0.005):
            turns += 1
        worker.join()
        self.assertGreater(turns, 3)


class HostMaps(unittest.TestCase):
    def test_only_cuda_has_device_maps(self):
        pipeline = roadstereo.Pipeline("fast", engine="cpu")
        pipeline.process(*pair())
        for ask in (pipeline.device_maps, pipeline.set_device_options):
            with self.assertRaisesRegex(roadstereo.Error, "only a pipeline with the engine cuda"):
                ask()


class Module(unittest.TestCase):
    def test_command_line(self):
        self.assertEqual(run("--version"), f"roadstereo {roadstereo.__version__}\n")
        wrong = subprocess.run([sys.executable, "-m", "roadstereo", "inspect"], capture_output=True, check=False)
        self.assertEqual(wrong.returncode, 2)

    def test_errors_are_runtime_errors(self):
        self.assertTrue(issubclass(roadstereo.Error, RuntimeError))
        self.assertEqual(f"{roadstereo.Error.__module__}.{roadstereo.Error.__name__}", "roadstereo.Error")

    def test_everything_has_a_docstring(self):
        for name in roadstereo.__all__:
            value = getattr(roadstereo, name)
            self.assertTrue(inspect.getdoc(value), name)
            members = vars(value).items() if isinstance(value, type) else []
            for member, function in members:
                if not member.startswith("_"):
                    self.assertTrue(inspect.getdoc(function), f"{name}.{member}")


if __name__ == "__main__":
    unittest.main()
