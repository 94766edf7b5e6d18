"""Two pipelines in two threads: at least 1.5 times as many pairs as one."""

import os
import threading
import time
import unittest

import numpy as np
from rendered_road import pair

import roadstereo

PAIRS = 6


def seconds(threads):
    """Time in which each thread processes PAIRS pairs with a pipeline of its own."""
    frames = [np.kron(frame, np.ones((2, 2), np.uint8)) for frame in pair()]
    pipelines = [roadstereo.Pipeline("default", threads=1) for _ in range(threads)]
    for pipeline in pipelines:
        pipeline.process(*frames)

    def work(pipeline):
        for _ in range(PAIRS):
            pipeline.process(*frames)

    workers = [threading.Thread(target=work, args=[pipeline]) for pipeline in pipelines]
    begin = time.perf_counter()
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    return time.perf_counter() - begin


class Threads(unittest.TestCase):
    @unittest.skipIf(len(os.sched_getaffinity(0)) < 2, "needs two cores")
    def test_two_pipelines_run_in_parallel(self):
        rounds = [(seconds(1), seconds(2)) for _ in range(6)]  # in turn: other programs slow down both
        one, two = map(min, zip(*rounds))
        gain = 2 * one / two
        print(f"two pipelines: {gain:.2f} times the rate of one")
        self.assertGreaterEqual(gain, 1.5)


if __name__ == "__main__":
    unittest.main()
