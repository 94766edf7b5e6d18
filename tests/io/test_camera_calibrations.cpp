// Calibrations that cameras and calibration tools come with: EuRoC, Kalibr, ZED, DepthAI, messages of ROS 2.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "roadstereo/io/rectification.hpp"
#include "tests/io/calibration_test.hpp"

namespace roadstereo {
namespace {

using namespace roadstereo::io;
using CameraCalibration = CalibrationTest;

template <std::size_t Count>
void expect_values(const std::array<double, Count>& values, const std::array<double, Count>& expected) {
  for (std::size_t i = 0; i < Count; ++i) EXPECT_NEAR(values[i], expected[i], 1e-11) << i;
}

// The sensor.yaml files of the EuRoC MAV dataset.
const std::string euroc_left = R"(# General sensor definitions.
sensor_type: camera
comment: VI-Sensor cam0 (MT9M034)

# Sensor extrinsics wrt. the body-frame.
T_BS:
  cols: 4
  rows: 4
  data: [0.0148655429818, -0.999880929698, 0.00414029679422, -0.0216401454975,
         0.999557249008, 0.0149672133247, 0.025715529948, -0.064676986768,
        -0.0257744366974, 0.00375618835797, 0.999660727178, 0.00981073058949,
         0.0, 0.0, 0.0, 1.0]

# Camera specific definitions.
rate_hz: 20
resolution: [752, 480]
camera_model: pinhole
intrinsics: [458.654, 457.296, 367.215, 248.375] #fu, fv, cu, cv
distortion_model: radial-tangential
distortion_coefficients: [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]
)";
const std::string euroc_right = R"(sensor_type: camera
T_BS:
  cols: 4
  rows: 4
  data: [0.0125552670891, -0.999755099723, 0.0182237714554, -0.0198435579556,
         0.999598781151, 0.0130119051815, 0.0251588363115, 0.0453689425024,
        -0.0253898008918, 0.0179005838253, 0.999517347078, 0.00786212447038,
         0.0, 0.0, 0.0, 1.0]
resolution: [752, 480]
camera_model: pinhole
intrinsics: [457.587, 456.134, 379.999, 255.238]
distortion_model: radial-tangential
distortion_coefficients: [-0.28368365, 0.07451284, -0.00010473, -3.55590700e-05]
)";

TEST_F(CameraCalibration, ReadsEurocSensors) {
  const std::string left = write(euroc_left, "left"), right = write(euroc_right, "right");
  const CalibrationFile file = read_calibration(left, right);
  EXPECT_EQ(file.format, "EuRoC sensor.yaml");
  ASSERT_TRUE(file.rig);
  expect_values(file.rig->left_matrix, {458.654, 0, 367.215, 0, 457.296, 248.375, 0, 0, 1});
  EXPECT_EQ(file.rig->right_distortion, (std::vector<double>{-0.28368365, 0.07451284, -0.00010473, -3.555907e-05}));
  // inv(T_BS right) · T_BS left by numpy
  EXPECT_NEAR(file.rig->translation_m[0], -0.1100738081272, 1e-9);
  EXPECT_NEAR(file.rig->translation_m[1], 3.991215470e-4, 1e-9);
  EXPECT_NEAR(file.rig->translation_m[2], -8.537025034e-4, 1e-9);
  EXPECT_NEAR(file.rig->rotation[1], 2.312067192424e-3, 1e-9);
  EXPECT_NEAR(file.rig->rotation[5], 1.408983584665e-2, 1e-9);
  EXPECT_EQ(file.rig->width, 752);
  EXPECT_NEAR(Rectifier(*file.rig, 752, 480).calibration().baseline_m, 0.11008, 1e-5);
  expect_refused_file(left, "sensor.yaml of one camera; the file of the right camera is needed, too");
  expect_refused_file(left, "T_BS has 15 values; it must have 16",
                      write(replaced(euroc_right, "0.0, 0.0, 0.0, 1.0", "0.0, 0.0, 1.0"), "right"));
  expect_refused_file(left, "camera_model is omni", write(replaced(euroc_right, "pinhole", "omni"), "right"));
  expect_refused_file(left, "752×481", write(replaced(euroc_right, "480", "481"), "right"));
  expect_refused_file(left, "R is not a rotation", write(replaced(euroc_right, "-0.999755099723", "-0.7"), "right"));
  expect_refused_file(left, "intrinsics is missing", write(replaced(euroc_right, "intrinsics", "other"), "right"));
}

const std::string kalibr = R"(cam0:
  camera_model: pinhole
  distortion_coeffs: [0.01, -0.02, 0.002, -0.0009]
  distortion_model: radtan
  intrinsics: [386.8, 388.2, 317.0, 241.8]
  resolution: [640, 480]
  rostopic: /infra_left
cam1:
  T_cn_cnm1:
  - [1.0, 0.0, 0.0, -0.05]
  - [0.0, 0.8, -0.6, 0.001]
  - [0.0, 0.6, 0.8, -0.002]
  - [0.0, 0.0, 0.0, 1.0]
  camera_model: pinhole
  distortion_coeffs: [0.03, -0.04, 0.001, -0.0005]
  distortion_model: radtan
  intrinsics: [387.0, 388.0, 318.0, 242.0]
  resolution: [640, 480]
)";

TEST_F(CameraCalibration, ReadsKalibrCamchain) {
  const CalibrationFile file = read_calibration(write(kalibr));
  EXPECT_EQ(file.format, "Kalibr camchain");
  ASSERT_TRUE(file.rig);
  expect_values(file.rig->left_matrix, {386.8, 0, 317, 0, 388.2, 241.8, 0, 0, 1});
  expect_values(file.rig->right_matrix, {387, 0, 318, 0, 388, 242, 0, 0, 1});
  expect_values(file.rig->rotation, {1, 0, 0, 0, 0.8, -0.6, 0, 0.6, 0.8});
  expect_values(file.rig->translation_m, {-0.05, 0.001, -0.002});
  EXPECT_EQ(file.rig->left_distortion, (std::vector<double>{0.01, -0.02, 0.002, -0.0009}));
  EXPECT_FALSE(file.rig->fisheye);
  const std::string fisheye = replaced(replaced(kalibr, "radtan", "equidistant"), "radtan", "equidistant");
  EXPECT_TRUE(read_calibration(write(fisheye)).rig->fisheye);
  expect_refused(replaced(kalibr, "radtan", "equidistant"), "the lens models of the cameras differ");
  expect_refused(replaced(kalibr, "radtan", "fov"), "distortion_model is fov");
  expect_refused(replaced(kalibr, "distortion_coeffs", "distortion_coefficients"), "distortion_coeffs");
  const std::string none = replaced(kalibr, "  distortion_coeffs: [0.01, -0.02, 0.002, -0.0009]\n", "");
  EXPECT_TRUE(read_calibration(write(replaced(none, "radtan", "none"))).rig->left_distortion.empty());
  expect_refused(replaced(kalibr, "pinhole", "ds"), "camera_model is ds");
  expect_refused(replaced(kalibr, "cam0", "cam9"), "cam0 is missing");
  expect_refused(kalibr.substr(0, kalibr.find("cam1:")), "the file has one camera; a pair is needed");
  expect_refused(replaced(kalibr, "[386.8, 388.2, 317.0, 241.8]", "[386.8]"), "intrinsics has 1 values");
  expect_refused(replaced(kalibr, "  - [0.0, 0.0, 0.0, 1.0]\n", ""), "T_cn_cnm1 must be a list of four rows");
  expect_refused(replaced(kalibr, "-0.05", "-50"), "the baseline is 50");
  expect_refused(replaced(kalibr, "640", "640.5"), "resolution[0] is 640.5");
}

/// Both cameras of one resolution, as in SNxxxx.conf.
std::string zed_cameras(const std::string& resolution, double scale) {
  const auto text = [&](const std::string& side, double fx, double cx, const char* k) {
    return "[" + side + "_CAM_" + resolution + "]\nfx=" + std::to_string(scale * fx) +
           "\nfy=" + std::to_string(scale * fx) + "\ncx=" + std::to_string(scale * cx) +
           "\ncy=" + std::to_string(scale * 360) + "\n" + k + "\n";
  };
  return text("LEFT", 699.41, 652.8, "k1=-0.170704\nk2=0.0249542\np1=9.6e-05\np2=-0.0001\nk3=-9.9e-11\n") +
         text("RIGHT", 697.635, 671.665, "k1=-0.171533\nk2=0.0258402\n");
}
const std::string zed_stereo =
    "[STEREO]\r\nBaseline=119.905\r\nTY=0.0458908\r\nTZ=-0.467919\r\nCV_HD=0.00697667\r\nRX_HD=0.00239722\r\n"
    "RZ_HD=-0.0021326\r\nCV_VGA=0.00697667\r\nRX_VGA=0\r\nRZ_VGA=0\r\nTZ_VGA=-0.5\r\n[MISC]\r\nSensor_ID=0\r\n";

TEST_F(CameraCalibration, ReadsZedConfByResolution) {
  const std::string text = zed_cameras("HD", 1) + zed_cameras("VGA", 0.5) + zed_stereo;
  CalibrationFile file = read_calibration(write(text, "SN1234.conf"));
  EXPECT_EQ(file.format, "ZED");
  EXPECT_FALSE(file.rectified || file.rig);
  ASSERT_EQ(file.rigs.size(), 2U);
  CalibrationFile small = file;
  file.select_size(1280, 720, "SN1234.conf");
  ASSERT_TRUE(file.rig && file.rigs.empty());
  expect_values(file.rig->left_matrix, {699.41, 0, 652.8, 0, 699.41, 360, 0, 0, 1});
  EXPECT_EQ(file.rig->left_distortion, (std::vector<double>{-0.170704, 0.0249542, 9.6e-05, -0.0001, -9.9e-11}));
  EXPECT_EQ(file.rig->right_distortion, (std::vector<double>{-0.171533, 0.0258402, 0, 0, 0}));
  expect_values(file.rig->translation_m, {-0.119905, -0.0458908e-3, 0.467919e-3});
  // cv2.Rodrigues((RX, CV, RZ))
  expect_values(file.rig->rotation, {0.999973389177, 0.002140941306, 0.00697404529, -0.002124216775, 0.999994852702,
                                     -0.002404635627, -0.006979157576, 0.002389757253, 0.99997278984});
  EXPECT_NEAR(Rectifier(*file.rig, 1280, 720).calibration().baseline_m, 0.1199, 1e-4);
  small.select_size(672, 376, "SN1234.conf");
  EXPECT_DOUBLE_EQ(small.rig->left_matrix[0], 349.705);
  EXPECT_NEAR(small.rig->translation_m[2], 0.5e-3, 1e-12);
  CalibrationFile other = read_calibration(write(text));
  EXPECT_THROW(other.select_size(640, 480, "SN1234.conf"), Error);
  expect_refused(replaced(text, "cx=652.800000", "cz=1"), "left_cam_hd:cx is missing");
  expect_refused(replaced(text, "Baseline=119.905", "Baseline=x"), "stereo:baseline is \"x\"");
  expect_refused(replaced(text, "Baseline=119.905", "Baseline=0.1199"), "the baseline is 0.000");
  expect_refused(replaced(text, "CV_HD", "CW_HD"), "stereo:cv_hd is missing");
  expect_refused("[LEFT_CAM_8K]\nfx=1\n", "no camera of a known resolution");
}

const std::string depthai = R"({"batchTime": 0, "boardName": "OAK-D", "cameraData": [
 [0, {"cameraType": 0, "distortionCoeff": [], "extrinsics": {"rotationMatrix": [], "specTranslation": {}, "toCameraSocket": -1,
      "translation": {"x": 0.0, "y": 0.0, "z": 0.0}}, "height": 2160, "intrinsicMatrix": [], "lensPosition": 135, "width": 3840}],
 [1, {"cameraType": 0, "distortionCoeff": [-5.5, 16.9, 0.001, -0.002, -14.2, -5.6, 17.2, -14.9, 0, 0, 0, 0, 0, 0],
      "extrinsics": {"rotationMatrix": [[1.0, 0.0, 0.0], [0.0, 0.8, -0.6], [0.0, 0.6, 0.8]],
                     "specTranslation": {"x": -7.5, "y": 0.0, "z": 0.0}, "toCameraSocket": 2,
                     "translation": {"x": -7.58, "y": -0.01, "z": 0.04}},
      "height": 800, "intrinsicMatrix": [[799.7, 0.0, 662.9], [0.0, 799.4, 382.2], [0.0, 0.0, 1.0]],
      "lensPosition": 0, "specHfovDeg": 71.9, "width": 1280}],
 [2, {"cameraType": 0, "distortionCoeff": [-5.0, 15.9, 0.001, -0.002, -13.2, -5.1, 16.2, -13.9, 0, 0, 0, 0, 0, 0],
      "extrinsics": {"rotationMatrix": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], "toCameraSocket": 0,
                     "translation": {"x": 3.7, "y": 0.0, "z": 0.0}},
      "height": 800, "intrinsicMatrix": [[801.1, 0.0, 651.4], [0.0, 800.9, 390.3], [0.0, 0.0, 1.0]],
      "lensPosition": 0, "specHfovDeg": 71.9, "width": 1280}]],
 "stereoRectificationData": {"leftCameraSocket": 1, "rectifiedRotationLeft": [], "rectifiedRotationRight": [],
                             "rightCameraSocket": 2}, "version": 6})";

TEST_F(CameraCalibration, ReadsDepthAi) {
  const CalibrationFile file = read_calibration(write(depthai));
  EXPECT_EQ(file.format, "DepthAI");
  ASSERT_TRUE(file.rig);
  expect_values(file.rig->left_matrix, {799.7, 0, 662.9, 0, 799.4, 382.2, 0, 0, 1});
  expect_values(file.rig->right_matrix, {801.1, 0, 651.4, 0, 800.9, 390.3, 0, 0, 1});
  expect_values(file.rig->rotation, {1, 0, 0, 0, 0.8, -0.6, 0, 0.6, 0.8});
  expect_values(file.rig->translation_m, {-0.0758, -0.0001, 0.0004});
  EXPECT_EQ(file.rig->left_distortion.size(), 14U);
  EXPECT_EQ(file.rig->width, 1280);
  EXPECT_EQ(file.rig->height, 800);
  // Extrinsics from the right camera to the left one: inverted. Rᵀ·t = (−7.58, 0.8·(−0.01) + 0.6·0.04, …) cm
  const std::string swapped = replaced(replaced(depthai, "\"leftCameraSocket\": 1", "\"leftCameraSocket\": 2"),
                                       "\"rightCameraSocket\": 2", "\"rightCameraSocket\": 1");
  const CalibrationFile from_right = read_calibration(write(swapped));
  expect_values(from_right.rig->rotation, {1, 0, 0, 0, 0.8, 0.6, 0, -0.6, 0.8});
  expect_values(from_right.rig->translation_m, {0.0758, -0.00016, -0.00038});
  expect_refused(depthai.substr(0, depthai.size() - 1), "invalid JSON");
  const std::string nested = std::string(200000, '[') + std::string(200000, ']');
  expect_refused(replaced(depthai, "[-5.5, 16.9,", "[" + nested + ", 16.9,"), "distortionCoeff must be a number");
  expect_refused(replaced(depthai, "\"toCameraSocket\": 2", "\"toCameraSocket\": 7"), "no extrinsics between");
  expect_refused(replaced(depthai, "\"leftCameraSocket\": 1", "\"leftCameraSocket\": 5"), "no camera of socket 5");
  expect_refused(replaced(depthai, "799.7", "\"x\""), "intrinsicMatrix must be a number");
  expect_refused(replaced(depthai, "\"width\": 1280", "\"width\": -1"), "width is -1");
  expect_refused(replaced(depthai, "\"cameraData\": [", "\"cameraData\": 3, \"other\": ["),
                 "cameraData must be a list");
}

/// What `ros2 topic echo --once /left/camera_info` prints.
std::string ros2_message(double p3) {
  std::string text =
      "header:\n  stamp:\n    sec: 1700000000\n    nanosec: 5\n  frame_id: left\nheight: 480\nwidth: 640\n"
      "distortion_model: plumb_bob\nd:\n- 0.1\n- -0.2\n- 0.0\n- 0.0\n- 0.0\nk:\n";
  for (const double value : {500, 0, 320, 0, 500, 240, 0, 0, 1}) text += "- " + std::to_string(value) + "\n";
  text += "r:\n";
  for (const double value : {1, 0, 0, 0, 1, 0, 0, 0, 1}) text += "- " + std::to_string(value) + "\n";
  text += "p:\n";
  for (const double value : {500., 0., 320., p3, 0., 500., 240., 0., 0., 0., 1., 0.}) {
    text += "- " + std::to_string(value) + "\n";
  }
  return text + "binning_x: 0\nbinning_y: 0\nroi:\n  x_offset: 0\n  do_rectify: false\n---\n";
}

TEST_F(CameraCalibration, ReadsMessagesOfRos2AndRos1) {
  const std::string left = write(ros2_message(0), "left");
  const CalibrationFile file = read_calibration(left, write(ros2_message(-60), "right"));
  EXPECT_EQ(file.format, "ROS camera_info");
  ASSERT_TRUE(file.rig);
  expect_values(file.rig->left_matrix, {500, 0, 320, 0, 500, 240, 0, 0, 1});
  EXPECT_EQ(file.rig->left_distortion, (std::vector<double>{0.1, -0.2, 0, 0, 0}));
  expect_values(file.rig->translation_m, {-0.12, 0, 0});
  EXPECT_EQ(file.rig->width, 640);
  EXPECT_EQ(file.rig->height, 480);
  std::string upper = ros2_message(-60);
  for (const auto& [from, to] : {std::pair{"\nd:", "\nD:"}, {"\nk:", "\nK:"}, {"\nr:", "\nR:"}, {"\np:", "\nP:"}}) {
    upper = replaced(upper, from, to);
  }
  EXPECT_NEAR(read_calibration(left, write(upper, "right")).rig->translation_m[0], -0.12, 1e-12);
  expect_refused_file(left, "camera_matrix is missing", write(replaced(ros2_message(-60), "\nk:", "\nq:"), "right"));
  expect_refused_file(left, "the file of the right camera is needed, too");
}

}  // namespace
}  // namespace roadstereo
