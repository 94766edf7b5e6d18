"""Two pipelines in two threads: the same results as one after the other, and the interpreter runs meanwhile."""

import threading
import unittest

import numpy as np
from rendered_road import pair

import roadstereo


class Threads(unittest.TestCase):
    def setUp(self):
        self.frames = [np.kron(frame, np.ones((2, 2), np.uint8)) for frame in pair()]

    def test_two_pipelines_give_what_one_gives(self):
        expected = roadstereo.Pipeline("default", threads=1).process(*self.frames)
        results = [None, None]

        def work(k):
            results[k] = roadstereo.Pipeline("default", threads=1).process(*self.frames)

        workers = [threading.Thread(target=work, args=[k]) for k in range(2)]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
        for result in results:
            np.testing.assert_array_equal(result.disparity, expected.disparity)

    def test_interpreter_runs_while_a_pair_is_processed(self):
        pipeline = roadstereo.Pipeline("default", threads=1)
        worker = threading.Thread(target=lambda: [pipeline.process(*self.frames) for _ in range(3)])
        worker.start()
        steps = 0
        while worker.is_alive():
            steps += 1
        self.assertGreater(steps, 1000)  # with the lock held there would be a few, between the pairs


if __name__ == "__main__":
    unittest.main()
