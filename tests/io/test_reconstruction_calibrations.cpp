// Calibrations of COLMAP and of the RealSense Viewer.

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "tests/io/calibration_test.hpp"

namespace roadstereo::io {
namespace {

using ColmapCalibration = CalibrationTest;
using RealSenseCalibration = CalibrationTest;

template <std::size_t Count>
void expect_values(const std::array<double, Count>& values, const std::array<double, Count>& expected) {
  for (std::size_t i = 0; i < Count; ++i) EXPECT_NEAR(values[i], expected[i], 1e-11) << i;
}

// As the RealSense Viewer saves it: a D435i at 1280×720 and 848×480, and a size that is not used.
const std::string realsense = R"({
  "baseline": "-49.9496",
  "intrinsic_left.x.x": "0.501421",
  "rectified.0.fx": "647.125",
  "rectified.0.fy": "647.125",
  "rectified.0.height": "720",
  "rectified.0.ppx": "637.102",
  "rectified.0.ppy": "363.714",
  "rectified.0.width": "1280",
  "rectified.1.fx": "428.72",
  "rectified.1.fy": "428.72",
  "rectified.1.height": "480",
  "rectified.1.ppx": "422.08",
  "rectified.1.ppy": "242.461",
  "rectified.1.width": "848",
  "rectified.2.fx": "585.156",
  "rectified.2.fy": "585.156",
  "rectified.2.height": "0",
  "rectified.2.ppx": "367.15",
  "rectified.2.ppy": "0",
  "rectified.2.width": "0",
  "world2left_rot.x.x": "0.999"
})";

TEST_F(RealSenseCalibration, IsChosenBySize) {
  CalibrationFile file = read_calibration(write(realsense));
  EXPECT_EQ(file.format, "RealSense");
  ASSERT_EQ(file.rigs.size(), 2U);
  file.select_size(848, 480, "d435i.json");
  ASSERT_TRUE(file.rectified && !file.rig && file.rigs.empty());
  EXPECT_EQ(file.format, "RealSense");
  EXPECT_DOUBLE_EQ(file.rectified->focal_px, 428.72);
  EXPECT_DOUBLE_EQ(file.rectified->cx_px, 422.08);
  EXPECT_DOUBLE_EQ(file.rectified->cy_px, 242.461);
  EXPECT_DOUBLE_EQ(file.rectified->baseline_m, 0.0499496);
  EXPECT_EQ(file.rectified->width, 848);
  CalibrationFile other = read_calibration(write(realsense));
  EXPECT_THROW(other.select_size(640, 480, "d435i.json"), Error);
}

TEST_F(RealSenseCalibration, BadValueIsSentence) {
  expect_refused(replaced(realsense, "-49.9496", "-0.0499496"), "the baseline is 4.99496e-05");
  expect_refused(replaced(realsense, "baseline", "other"), "baseline is missing");
  expect_refused(replaced(realsense, "\"428.72\"", "\"wide\""), "rectified.1.fx is \"wide\"");
  expect_refused(replaced(realsense, "\"848\"", "\"848.5\""), "rectified.1.width is 848.5");
  expect_refused(replaced(realsense, "{", "{\"x\": ,"), "invalid JSON");
  const std::string nested = std::string(200000, '[') + std::string(200000, ']');
  expect_refused(replaced(realsense, "\"-49.9496\"", nested), "baseline must be a number");
  expect_refused("{\"baseline\": -50, \"rectified.0.fx\": 0, \"rectified.0.width\": 9, \"rectified.0.height\": 9}",
                 "no size of the images");
}

// The rig is that of COLMAP's documentation; its camera models, and others, with images of one size.
const std::string cameras_txt = R"(# Camera list with one line of data per camera:
#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]
# Number of cameras: 5
1 SIMPLE_PINHOLE 3072 2304 2559.81 1536 1152
2 PINHOLE 3072 2304 2560.56 2561.5 1536 1152
3 SIMPLE_RADIAL 3072 2304 2559.69 1536 1152 -0.0218531
4 OPENCV 3072 2304 2559 2560 1537 1153 0.1 -0.2 0.001 -0.002
5 OPENCV_FISHEYE 3072 2304 2559 2560 1537 1153 0.1 -0.2 0.01 -0.02
)";
const std::string rigs_txt =
    "# Rig calib list with one line of data per calib:\n# Number of rigs: 2\n"
    "1 2 CAMERA 1 CAMERA 2 1 -0.9999701516465348 -0.0011120266840749639 -0.0075347911527510894 0.0012985125893421306 "
    "-0.19316906391350164 0.00085222218993398979 0.0070758955539026785\n2 1 CAMERA 3\n";

TEST_F(ColmapCalibration, ReadsRig) {
  const CalibrationFile file = read_calibration(write(cameras_txt, "cameras.txt"), write(rigs_txt, "rigs.txt"));
  EXPECT_EQ(file.format, "COLMAP");
  ASSERT_TRUE(file.rig);
  expect_values(file.rig->left_matrix, {2559.81, 0, 1535.5, 0, 2559.81, 1151.5, 0, 0, 1});  // half a pixel less
  expect_values(file.rig->right_matrix, {2560.56, 0, 1535.5, 0, 2561.5, 1151.5, 0, 0, 1});
  expect_values(file.rig->translation_m, {-0.19316906391350164, 0.00085222218993398979, 0.0070758955539026785});
  // scipy.spatial.transform.Rotation.from_quat((x, y, z, w)).as_matrix()
  expect_values(file.rig->rotation,
                {0.9998830815747, 0.0026137054394, 0.01506624454199, -0.002580189884117, 0.9999941545234,
                 -0.002243555026159, -0.01507202046458, 0.002204418941479, 0.9998839806379});
  EXPECT_TRUE(file.rig->left_distortion.empty());
  EXPECT_FALSE(file.rig->fisheye);
  EXPECT_EQ(file.rig->width, 3072);
}

TEST_F(ColmapCalibration, ReferenceMayBeRightCamera) {
  const CalibrationFile file = read_calibration(
      write(cameras_txt, "cameras.txt"), write("1 2 CAMERA 4 CAMERA 3 1 0.6 0.8 0 0 0.2 0.01 0.02\n", "rigs.txt"));
  ASSERT_TRUE(file.rig);
  // 2·acos(0.6) about x: cos = −0.28, sin = 0.96; inverted.
  expect_values(file.rig->rotation, {1, 0, 0, 0, -0.28, 0.96, 0, -0.96, -0.28});
  expect_values(file.rig->translation_m, {-0.2, 0.0028 - 0.0192, 0.0096 + 0.0056});
  EXPECT_EQ(file.rig->left_distortion, (std::vector<double>{-0.0218531, 0, 0, 0}));
  EXPECT_EQ(file.rig->right_distortion, (std::vector<double>{0.1, -0.2, 0.001, -0.002}));
  expect_values(file.rig->right_matrix, {2559, 0, 1536.5, 0, 2560, 1152.5, 0, 0, 1});
}

// The second camera 0.5 m to the right of the first; points of an image, or none.
const std::string images_txt = R"(# Image list with two lines of data per image:
#   IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME
1 1 0 0 0 1 2 3 1 left/a b.png
2362.39 248.498 58396 1784.7 268.254 59027 1784.7 268.254 -1
2 1 0 0 0 0.5 2 3 2 right/a b.png

3 0.5 0.5 0.5 0.5 7 8 9 1 left/c b.png

4 0.5 0.5 0.5 0.5 6.5 8 9.002 2 right/c b.png
1190.83 663.957 23056 1258.77 640.354 59070
5 1 0 0 0 0 0 0 1 left/alone.png

)";

TEST_F(ColmapCalibration, ReadsMeanPoseOfImages) {
  const CalibrationFile file = read_calibration(write(cameras_txt, "cameras.txt"), write(images_txt, "images.txt"));
  ASSERT_TRUE(file.rig);
  // In the axes of the cameras the second ones lie at (−0.5, 0, 0) and (−0.5, 0, 0.002).
  expect_values(file.rig->translation_m, {-0.5, 0, 0.001});
  expect_values(file.rig->rotation, {1, 0, 0, 0, 1, 0, 0, 0, 1});
}

TEST_F(ColmapCalibration, BadPosesAreSentences) {
  const std::string cameras = write(cameras_txt, "cameras.txt");
  const auto refused = [&](const std::string& poses, const std::string& part) {
    expect_refused_file(cameras, part, write(poses, "poses.txt"));
  };
  expect_refused_file(cameras, "rigs.txt or images.txt with the poses is needed, too");
  refused(replaced(images_txt, " 2 right/c", " 1 right/c"), "are not of the cameras 1 and 2");
  refused(replaced(images_txt, "7 8 9 1", "7 8 x 1"), "a pose is \"x\"");
  refused("# nothing\n", "no two images of the same name");
  refused("1 2 3\n", "has 3 words");
  refused(replaced(rigs_txt, "CAMERA 2 1", "CAMERA 9 1"), "there is no camera 9");
  refused(replaced(rigs_txt, "CAMERA 1 CAMERA 2", "CAMERA 1 IMU 2"), "is not one of two cameras");
  refused(replaced(rigs_txt, "-0.19316906391350164", "-19.3"), "the baseline is 19.3");
  refused(replaced(rigs_txt, "2 1 CAMERA 3\n", rigs_txt), "several rigs");
  refused(replaced(rigs_txt, "CAMERA 1 CAMERA 2", "CAMERA 5 CAMERA 2"), "the lens models of the cameras differ");
}

TEST_F(ColmapCalibration, BadCameraIsSentence) {
  const std::string rigs = write(rigs_txt, "rigs.txt");
  expect_refused_file(write(replaced(cameras_txt, " 1536 1152\n", " 1536\n"), "cameras.txt"),
                      "camera 1 has 2 parameters", rigs);
  expect_refused_file(write(replaced(cameras_txt, "2 PINHOLE", "2 FOV"), "cameras.txt"),
                      "the camera model FOV is not supported", rigs);
}

}  // namespace
}  // namespace roadstereo::io
