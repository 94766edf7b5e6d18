#!/usr/bin/env python3
"""Measures `roadstereo live` on a sequence played out of memory, while one viewer fetches the page's pictures:

  scripts/measure_live.py [--player build/bin/live_player] [--size 640x360] [--pairs 900] [--no-record] [--no-viewer]
                          [-- further options of live]

Prints the run's summary, the processor time a frame, the memory over time, and the load of the machine, which must be
idle for the figures to mean anything. Frames a second and latency of a 30 Hz source: as it is. Memory over 10000 frames:
  scripts/measure_live.py --size 160x96 --pairs 100000000 --no-record -- --rate 1000 --frames 10000
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


def watch(url, seen):
    """A viewer: as the page does it, as fast as it is answered."""
    place = urllib.parse.urlsplit(url)
    connection = http.client.HTTPConnection(place.hostname, place.port, timeout=10)

    def get(path):
        connection.request("GET", path)
        return connection.getresponse().read()

    frame = 0
    try:
        while True:
            state = json.loads(get(f"/state?after={frame}"))
            if state["frame"] > frame:
                frame = state["frame"]
                seen["bytes"] += len(get(f"/left.jpg?frame={frame}")) + len(get(f"/transformed.jpg?frame={frame}"))
                seen["pictures"] += 1
    except (OSError, http.client.HTTPException):
        return  # the run has ended


def resident_mib(process):
    with open(f"/proc/{process.pid}/status", encoding="utf-8") as status:
        found = re.search(r"VmRSS:\s+(\d+)", status.read())
    return int(found.group(1)) / 1024 if found else None


def processor_s(process):
    """Time that the process has used so far, in all its threads."""
    with open(f"/proc/{process.pid}/stat", encoding="utf-8") as stat:
        fields = stat.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def measure(arguments, folder):
    width, height = arguments.size.split("x")
    calibration = os.path.join(folder, "calibration.yaml")
    command = [arguments.player, width, height, calibration, "live", str(arguments.pairs), "--calibration", calibration,
               "--json", "--serve", "0", *arguments.further]
    if not arguments.no_record:
        command += ["--record", os.path.join(folder, "recording")]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    url = next(found.group() for found in (re.search(r"http://\S+", line) for line in process.stderr) if found)
    threading.Thread(target=process.stderr.read, daemon=True).start()
    before_s = after_s = processor_s(process)  # the flight has been rendered
    seen = {"pictures": 0, "bytes": 0}
    if not arguments.no_viewer:
        threading.Thread(target=watch, args=(url, seen), daemon=True).start()
    memory = []
    while process.poll() is None:
        memory.append(resident_mib(process))
        after_s = processor_s(process)
        time.sleep(0.2)
    summary = json.loads(process.stdout.read())
    summary["processor_ms_a_frame"] = 1000 * (after_s - before_s) / max(summary["processed"], 1)
    summary["viewer"] = seen
    known = [one for one in memory if one is not None]
    summary["memory_mib_over_time"] = [round(one, 1) for one in known[::max(1, len(known) // 20)]]
    summary["load_average"] = os.getloadavg()
    return summary


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--player", default="build/bin/live_player")
    parser.add_argument("--size", default="640x360", help="of one view")
    parser.add_argument("--pairs", type=int, default=900)
    parser.add_argument("--no-record", action="store_true")
    parser.add_argument("--no-viewer", action="store_true")
    parser.add_argument("further", nargs="*", help="options of live")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="roadstereo_live_") as folder:
        print(json.dumps(measure(arguments, folder), indent=2))
    return 0


if __name__ == "__main__":
    sys.exit(main())
