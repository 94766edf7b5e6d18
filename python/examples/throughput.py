"""Pairs per second of one pipeline, and of two in two threads, each on one core.

python3 throughput.py left.png right.png calibration.yaml [pairs]
"""

import sys
import threading
import time

import roadstereo


def pairs_per_second(pipelines: list[roadstereo.Pipeline], left: str, right: str, pairs: int) -> float:
    frames = roadstereo.read_frame(left), roadstereo.read_frame(right)

    def work(pipeline: roadstereo.Pipeline) -> None:
        for _ in range(pairs):
            pipeline.process(*frames)

    for pipeline in pipelines:  # the first pair allocates
        pipeline.process(*frames)
    threads = [threading.Thread(target=work, args=[pipeline]) for pipeline in pipelines]
    start = time.perf_counter()
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return len(pipelines) * pairs / (time.perf_counter() - start)


def main() -> None:
    left, right, calibration_file, *rest = sys.argv[1:]
    pairs = int(rest[0]) if rest else 200
    calibration = roadstereo.read_calibration(calibration_file)
    if isinstance(calibration, roadstereo.StereoRig):
        raise SystemExit(f"{calibration_file}: the pair must be rectified")
    pipelines = [roadstereo.Pipeline("default", calibration, threads=1) for _ in range(2)]
    one, two = (pairs_per_second(pipelines[:count], left, right, pairs) for count in (1, 2))
    print(f"one pipeline: {one:.1f} pairs/s, two: {two:.1f} pairs/s, {two / one:.2f} times as many")


if __name__ == "__main__":
    main()
