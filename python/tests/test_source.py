"""Recordings as iterators."""

import os
import pathlib
import shutil
import threading
import unittest

import numpy as np
from rendered_road import FOLDER, run

import roadstereo


class Source(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = FOLDER / "flight"
        run("synth", "--scene", "demo", "--size", "160x90", "--frames", 4, "--output", cls.folder)

    def test_pairs_equal_files(self):
        source = roadstereo.open_source(self.folder)
        self.assertEqual((source.size, source.live), (4, False))
        written = roadstereo.read_calibration(self.folder / "calibration.yaml")
        self.assertEqual(source.calibration.focal_px, written.focal_px)
        self.assertIn("4 pairs", source.description)
        pairs = list(source)
        self.assertEqual([pair.index for pair in pairs], [0, 1, 2, 3])
        np.testing.assert_allclose([pair.time_s for pair in pairs], np.arange(4) / 30, atol=1e-6)
        for pair in pairs:
            self.assertEqual(pair.error, "")
            for side in ("left", "right"):
                read = roadstereo.read_frame(self.folder / side / f"{pair.index:06}.png")
                self.assertTrue(np.array_equal(getattr(pair, side), read))
        self.assertEqual(list(source), [])

    def test_frames_outlive_source(self):
        frames = [pair.left for pair in roadstereo.open_source(str(self.folder))]
        self.assertEqual(len({frame.tobytes() for frame in frames}), 4)

    def test_two_folders(self):
        source = roadstereo.open_source(self.folder / "left", self.folder / "right", rate_hz=10)
        source.skip(2)
        pair = next(source)
        self.assertEqual(pair.index, 2)
        self.assertAlmostEqual(pair.time_s, 0.2)

    def test_pair_that_cannot_be_read(self):
        folder = FOLDER / "damaged"
        shutil.copytree(self.folder, folder)
        (folder / "right" / "000001.png").write_bytes(b"no image")
        pairs = list(roadstereo.open_source(folder))
        self.assertEqual([bool(pair.error) for pair in pairs], [False, True, False, False])
        self.assertIn("000001.png", pairs[1].error)
        with self.assertRaisesRegex(roadstereo.Error, "000001.png"):
            pairs[1].left

    def test_names_that_are_not_utf8(self):
        folder = FOLDER / "bytes"
        shutil.copytree(self.folder, folder)
        for side in ("left", "right"):
            (folder / side / "000003.png").rename(folder / side / os.fsdecode(b"000003\xff.png"))
        (folder / "right" / os.fsdecode(b"000003\xff.png")).write_bytes(b"no image")
        pair = list(roadstereo.open_source(folder))[3]
        self.assertEqual(pair.name, "000003\ufffd")
        self.assertIn("000003\ufffd.png", pair.error)
        self.assertIn("000003\ufffd", repr(pair))

    def test_no_source(self):
        with self.assertRaisesRegex(roadstereo.Error, "no/such"):
            roadstereo.open_source(pathlib.Path("no/such"))
        with self.assertRaisesRegex(roadstereo.Error, "side-by-side"):
            roadstereo.open_source(self.folder, layout="diagonal")
        with self.assertRaises(TypeError):
            roadstereo.open_source(3)

    def test_several_readers(self):
        source, read = roadstereo.open_source(self.folder), []
        readers = [threading.Thread(target=lambda: read.extend(pair.index for pair in source)) for _ in range(3)]
        for reader in readers:
            reader.start()
        for reader in readers:
            reader.join()
        self.assertEqual(sorted(read), [0, 1, 2, 3])


if __name__ == "__main__":
    unittest.main()
