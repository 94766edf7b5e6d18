"""RGB-D odometry of Open3D: reads the frames of a folder, prints the 3×4 motion from each to the next and the seconds.

    python3 - FOLDER FRAMES FOCAL CX CY MAX_DEPTH_M
"""
import sys
import time

import numpy
import open3d


def main():
    folder, frames = sys.argv[1], int(sys.argv[2])
    focal, cx, cy, max_depth = map(float, sys.argv[3:7])
    odometry = open3d.pipelines.odometry

    def read(index):
        grey = numpy.asarray(open3d.io.read_image(f"{folder}/images/{index:06}.png"), dtype=numpy.float32) / 255
        depth = open3d.io.read_image(f"{folder}/depths/{index:06}.png")
        return open3d.geometry.RGBDImage.create_from_color_and_depth(
            open3d.geometry.Image(grey), depth, depth_scale=65535 / max_depth, depth_trunc=max_depth,
            convert_rgb_to_intensity=False)

    last = read(0)
    height, width = numpy.asarray(last.depth).shape
    camera = open3d.camera.PinholeCameraIntrinsic(width, height, focal, focal, cx, cy)
    option = odometry.OdometryOption()
    for name in ("depth_max", "max_depth"):
        if hasattr(option, name):
            setattr(option, name, max_depth)
    motion = numpy.eye(4)
    for index in range(1, frames):
        frame = read(index)
        begin = time.perf_counter()
        success, found, _ = odometry.compute_rgbd_odometry(
            last, frame, camera, motion, odometry.RGBDOdometryJacobianFromHybridTerm(), option)
        seconds = time.perf_counter() - begin
        if success:
            motion = found
        print(*(motion[:3].ravel() if success else ["nan"] * 12), seconds)
        last = frame


main()
