"""Inspects a rendered flight with --write mcap, decodes flight.mcap by itself (mcap_decoder.py), and compares its messages
with the other files of the flight.

    check_flight_mcap.py PROGRAM
"""
import csv
import math
import pathlib
import statistics
import struct
import subprocess
import sys
import tempfile

from mcap_decoder import Mcap

FRAMES = 3
TOPICS = {"/roadstereo/left/image_rect/compressed", "/roadstereo/disparity", "/roadstereo/left/camera_info",
          "/roadstereo/points", "/roadstereo/damages", "/tf", "/roadstereo/odometry"}


def near(value, expected, tolerance, what):
    assert abs(value - expected) <= tolerance, f"{what}: {value}, not {expected} ± {tolerance}"


def rows(path):
    with open(path, newline="", encoding="utf-8") as table:
        return list(csv.DictReader(table))


def read_ply(path):
    """x, y, z, red, green, blue of every point."""
    head, body = path.read_bytes().split(b"end_header\n", 1)
    assert b"property uchar red" in head
    return list(struct.iter_unpack("<fffBBB", body))


def points_of(message):
    assert [f["name"] for f in message["fields"]] == ["x", "y", "z", "sigma", "intensity"]
    assert [f["offset"] for f in message["fields"]] == [0, 4, 8, 12, 16]
    assert all((f["datatype"], f["count"]) == (7, 1) for f in message["fields"])
    assert message["row_step"] == len(message["data"]) == 20 * message["width"] and message["height"] == 1
    return list(struct.iter_unpack("<fffff", message["data"]))


def matrix(transform):
    """Rows of the rotation, and the translation, of a pose or a transform."""
    q = transform.get("rotation") or transform["orientation"]
    t = transform.get("translation") or transform["position"]
    x, y, z, w = (q[name] for name in "xyzw")
    near(x * x + y * y + z * z + w * w, 1, 1e-9, "length of a quaternion")
    rotation = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    return rotation, [t[name] for name in "xyz"]


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def relative(first, second):
    """Motion from the first pose to the second, in the axes of the first."""
    (r0, t0), (r1, t1) = first, second
    back = [list(column) for column in zip(*r0)]
    return product(back, r1), [sum(back[i][k] * (t1[k] - t0[k]) for k in range(3)) for i in range(3)]


def check_disparity(message, calibration, cloud):
    """Depths f·T/d are those of the cloud of the same frame, in the same order."""
    image = message["image"]
    assert (image["encoding"], image["is_bigendian"], image["step"]) == ("32FC1", 0, 4 * image["width"])
    near(message["f"], calibration["focal_px"], 1e-3, "f")
    near(message["t"], calibration["baseline_m"], 1e-6, "T")
    values = [value for (value,) in struct.iter_unpack("<f", image["data"])]
    assert len(values) == image["width"] * image["height"]
    finite = [value for value in values if not math.isnan(value)]
    assert (message["min_disparity"], message["max_disparity"]) == (min(finite), max(finite))
    assert len(finite) >= len(cloud)
    depths = [message["f"] * message["t"] / d for d in finite if d >= calibration["focal_px"] / 250]
    assert len(depths) == len(cloud)
    assert all(abs(depth - point[2]) <= 1e-5 * point[2] for depth, point in zip(depths, cloud))


def check_points(points, cloud, road, height_m, calibration):
    """The points of the PLY; transformed by /tf most of them lie on the road."""
    assert [point[:3] for point in points] == [point[:3] for point in cloud]
    assert all(abs(point[4] - other[3]) <= 1 for point, other in zip(points, cloud)), "intensities"
    scale = calibration["focal_px"] * calibration["baseline_m"]
    sigmas_px = [point[3] * scale / point[2] ** 2 for point in points]
    assert 0 < min(sigmas_px) and max(sigmas_px) <= 1.4001, "disparities with more are invalid"
    rotation, origin = matrix(road)
    near(math.hypot(*origin), height_m, 1e-6, "height of the camera")
    heights = [sum(rotation[i][2] * (point[i] - origin[i]) for i in range(3)) for point in points]
    near(statistics.median(heights), 0, 0.01, "height of the road")


def check_damages(message, sightings):
    markers = message["markers"]
    assert markers[0]["action"] == 3 and all(marker["header"]["frame_id"] == "road" for marker in markers)
    assert len(markers) == 1 + 2 * len(sightings)
    for i, sighting in enumerate(sightings):
        outline, text = markers[1 + 2 * i:3 + 2 * i]
        assert (outline["type"], text["type"], outline["action"]) == (4, 9, 0)
        assert text["text"].startswith(sighting["distress"])
        polygon = [(point["x"], point["y"]) for point in outline["points"]]
        assert polygon[0] == polygon[-1]
        area = sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(polygon, polygon[1:])) / 2
        near(area, float(sighting["area_m2"]), 0.2 * float(sighting["area_m2"]), "area within an outline")
        near(text["pose"]["position"]["x"], float(sighting["road_x_m"]), 1e-3, "x of a text")


def check_odometry(messages, out):
    """Motion from the first frame to the last, and standard deviations, as in the other files of the trajectory."""
    lines = [[float(word) for word in line.split()] for line in (out / "trajectory_kitti.txt").read_text().splitlines()]
    expected = [([line[0:3], line[4:7], line[8:11]], [line[3], line[7], line[11]]) for line in (lines[0], lines[-1])]
    found = [matrix(messages[i]["pose"]["pose"]) for i in (0, -1)]
    for got, wanted in zip(relative(*found), relative(*expected)):
        for a, b in zip(sum(got, []) if isinstance(got[0], list) else got, sum(wanted, []) if isinstance(wanted[0], list) else wanted):
            near(a, b, 1e-6, "motion")
    for message, row in zip(messages, rows(out / "trajectory.csv")):
        assert (message["header"]["frame_id"], message["child_frame_id"]) == ("odom", "left_camera_optical")
        trace = [sum(message["pose"]["covariance"][7 * i] for i in axes) for axes in ((0, 1, 2), (3, 4, 5))]
        for value, names in zip(trace, (("sd_x_m", "sd_y_m", "sd_z_m"), ("sd_rx_rad", "sd_ry_rad", "sd_rz_rad"))):
            wanted = sum(float(row[name]) ** 2 for name in names)
            near(value, wanted, 1e-4 * wanted, "covariance")
        assert message["twist"]["covariance"][0] == -1


def check(folder, program):
    def run(*words):
        done = subprocess.run([program, *words], cwd=folder, text=True, capture_output=True, check=False)
        assert done.returncode == 0, done.stderr

    run("synth", "--scene", "uav", "--size", "320x180", "--frames", str(FRAMES), "--flight", "default", "--output", "flight",
        "--quiet")
    run("inspect", "flight", "--write", "mcap,cloud", "--trajectory", "--output", "out", "--rate", "10", "--quiet")
    out = folder / "out"
    calibration = {key: float(value) for key, value in
                   (line.split(":", 1) for line in (folder / "flight/calibration.yaml").read_text().splitlines()
                    if ":" in line and not line.startswith("#"))}
    data = (out / "flight.mcap").read_bytes()
    mcap = Mcap(data)
    mcap.check_summary()
    assert mcap.profile == "ros2" and {topic for topic, _ in mcap.channels.values()} == TOPICS
    frames = rows(out / "frames.csv")
    by_topic = {topic: list(mcap.of_topic(topic)) for topic in TOPICS}
    for topic, messages in by_topic.items():
        assert [message[0] for message in messages] == list(range(FRAMES)), topic
        assert [message[1] for message in messages] == [round(1e9 * float(row["time_s"])) for row in frames], topic
    damages = 0
    for i, row in enumerate(frames):
        message = {topic: messages[i][2] for topic, messages in by_topic.items()}
        cloud = read_ply(out / f"cloud/{i:06}.ply")
        picture = message["/roadstereo/left/image_rect/compressed"]
        assert picture["format"] == "jpeg" and picture["data"].startswith(b"\xff\xd8") and picture["data"].endswith(b"\xff\xd9")
        stamp = picture["header"]["stamp"]
        near(stamp["sec"] + 1e-9 * stamp["nanosec"], float(row["time_s"]), 1e-9, "stamp")
        check_disparity(message["/roadstereo/disparity"], calibration, cloud)
        info = message["/roadstereo/left/camera_info"]
        assert (info["width"], info["height"], info["r"], len(info["d"])) == (320, 180, [1, 0, 0, 0, 1, 0, 0, 0, 1], 5)
        wanted = [calibration["focal_px"], 0, calibration["cx_px"], 0, calibration["focal_px"], calibration["cy_px"], 0, 0, 1]
        assert info["k"] == wanted and info["p"] == wanted[0:3] + [0] + wanted[3:6] + [0] + wanted[6:9] + [0]
        frames_of_tf = {(t["header"]["frame_id"], t["child_frame_id"]): t["transform"] for t in message["/tf"]["transforms"]}
        assert set(frames_of_tf) == {("odom", "left_camera_optical"), ("left_camera_optical", "road")}
        pose = message["/roadstereo/odometry"]["pose"]["pose"]
        assert matrix(frames_of_tf["odom", "left_camera_optical"]) == matrix(pose)
        check_points(points_of(message["/roadstereo/points"]), cloud, frames_of_tf["left_camera_optical", "road"],
                     float(row["height_m"]), calibration)
        sightings = [one for one in rows(out / "sightings.csv") if one["frame"] == row["frame"]]
        check_damages(message["/roadstereo/damages"], sightings)
        damages += len(sightings)
    assert damages > 0, "the scene has damage"
    near(by_topic["/roadstereo/odometry"][0][2]["pose"]["pose"]["position"]["z"], float(frames[0]["height_m"]), 1e-6, "z")
    check_odometry([message for _, _, message in by_topic["/roadstereo/odometry"]], out)

    # Cut off anywhere it has the frames before.
    chunks = mcap.chunks
    cut = Mcap(data[:chunks[-1][0] + 100])
    assert not cut.complete and cut.messages == [m for m in mcap.messages if m[1] < FRAMES - 1]
    print(f"flight.mcap: {len(mcap.messages)} messages in {len(chunks)} chunks, {damages} damages")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as root:
        check(pathlib.Path(root), str(pathlib.Path(sys.argv[1]).resolve()))
