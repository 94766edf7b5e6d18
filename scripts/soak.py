#!/usr/bin/env python3
"""Runs `roadstereo live` for long, with a recording, viewers that stay, viewers that come and go, and a camera that
vanishes and returns; fails unless memory and descriptors stay flat:

  scripts/soak.py [--player build/bin/live_player] [--frames 10000] [--viewers 40] [--reconnects 100] [--losses 50]

Prints the run's summary. Flat: after the first fifth of the run memory grows by at most 5 %, and the descriptors at its
end are no more than the most of its first half.
"""
import argparse
import http.client
import json
import os
import re
import subprocess
import sys
import tempfile
import threading
import time
import urllib.parse

GROWTH = 1.05


def fetch(connection, path):
    connection.request("GET", path)
    return connection.getresponse().read()


def view(address, counts, once):
    """A viewer as the page is one; with `once` it leaves after its first picture."""
    frame = 0
    try:
        connection = http.client.HTTPConnection(address.hostname, address.port, timeout=20)
        while True:
            state = json.loads(fetch(connection, f"/state?after={frame}"))
            if state["frame"] > frame:
                frame = state["frame"]
                counts["bytes"] += len(fetch(connection, f"/left.jpg?frame={frame}"))
                counts["pictures"] += 1
            if once:
                connection.close()
                counts["reconnects"] += 1
                return
    except (OSError, http.client.HTTPException, ValueError):
        counts["cut_off"] += 1  # at the end of the run


def start(target, *arguments):
    threading.Thread(target=target, args=arguments, daemon=True).start()


def sample(process):
    """Resident memory in MiB, open descriptors, threads."""
    with open(f"/proc/{process.pid}/status", encoding="utf-8") as status:
        text = status.read()
    return (int(re.search(r"VmRSS:\s+(\d+)", text)[1]) / 1024, len(os.listdir(f"/proc/{process.pid}/fd")),
            int(re.search(r"Threads:\s+(\d+)", text)[1]))


def run(arguments, folder):
    width, height = arguments.size.split("x")
    calibration, recording = os.path.join(folder, "calibration.yaml"), os.path.join(folder, "recording")
    pairs = max(1, arguments.frames // (arguments.losses + 1))
    process = subprocess.Popen(
        [arguments.player, width, height, calibration, "live", str(pairs), "camera", "--calibration", calibration,
         "--json", "--serve", "0", "--rate", str(arguments.rate), "--frames", str(arguments.frames), "--record", recording],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    url = next(found.group() for found in (re.search(r"http://\S+", line) for line in process.stderr) if found)
    start(process.stderr.read)
    address = urllib.parse.urlsplit(url)
    counts = {"pictures": 0, "bytes": 0, "reconnects": 0, "cut_off": 0}
    for _ in range(arguments.viewers):
        start(view, address, counts, False)
    samples, comers = [], 0
    period_s = arguments.frames / arguments.rate / max(1, arguments.reconnects)
    begin = time.monotonic()
    while process.poll() is None:
        try:
            samples.append(sample(process))
        except (OSError, TypeError):
            break  # it is ending
        if comers < arguments.reconnects and time.monotonic() - begin > comers * period_s:
            comers += 1
            start(view, address, counts, True)
        time.sleep(0.2)
    summary = json.loads(process.communicate()[0])
    summary["viewers"] = counts
    summary["recorded_files"] = len(os.listdir(os.path.join(recording, "left")))
    return summary, samples


def assess(samples):
    """What is not flat, and the figures."""
    settled = samples[len(samples) // 5:-3]
    memory, descriptors = [one[0] for one in settled], [one[1] for one in settled]
    middle = len(settled) // 2
    figures = {"memory_mib_first": round(memory[0], 1), "memory_mib_max": round(max(memory), 1),
               "memory_mib_last": round(memory[-1], 1), "descriptors_max_first_half": max(descriptors[:middle]),
               "descriptors_max_second_half": max(descriptors[middle:]), "threads_max": max(one[2] for one in settled)}
    faults = []
    if max(memory) > GROWTH * memory[0]:
        faults.append(f"memory grew from {memory[0]:.1f} to {max(memory):.1f} MiB")
    if descriptors[-1] > max(descriptors[:middle]):
        faults.append(f"descriptors grew from {max(descriptors[:middle])} to {descriptors[-1]}")
    return figures, faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--player", default="build/bin/live_player")
    parser.add_argument("--size", default="320x180", help="of one view")
    parser.add_argument("--rate", type=float, default=30, help="pairs a second")
    parser.add_argument("--frames", type=int, default=10000)
    parser.add_argument("--viewers", type=int, default=40)
    parser.add_argument("--reconnects", type=int, default=100, help="viewers that come and go")
    parser.add_argument("--losses", type=int, default=50, help="times that the camera vanishes")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="roadstereo_soak_") as folder:
        summary, samples = run(arguments, folder)
    figures, faults = assess(samples)
    print(json.dumps(summary | figures, indent=2))
    for fault in faults:
        print(f"soak: {fault}", file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
