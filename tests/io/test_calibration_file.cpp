// Calibrations of one line per value, of OpenCV and of ROS.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <sstream>

#include "tests/io/calibration_test.hpp"

namespace {

namespace fs = std::filesystem;
using namespace roadstereo;
using namespace roadstereo::io;
using ReadCalibration = CalibrationTest;

const std::string plain =
    "# a comment\nfocal_px: 1381.751\ncx_px: 1064.3\ncy_px: 572.5\nbaseline_m: 0.119438\nwidth: "
    "2079\nheight: 1040\n";

TEST_F(ReadCalibration, ReadsPlainYaml) {
  const CalibrationFile file = read_calibration(write(plain));
  EXPECT_EQ(file.format, "plain YAML");
  EXPECT_FALSE(file.rig);
  const StereoCalibration c = file.rectified.value();
  EXPECT_DOUBLE_EQ(c.focal_px, 1381.751);
  EXPECT_DOUBLE_EQ(c.cx_px, 1064.3);
  EXPECT_DOUBLE_EQ(c.cy_px, 572.5);
  EXPECT_DOUBLE_EQ(c.baseline_m, 0.119438);
  EXPECT_EQ(c.disparity_offset_px, 0);
  EXPECT_EQ(c.width, 2079);
  EXPECT_EQ(c.height, 1040);
  const StereoCalibration unknown = rectified("focal_px: 500\ncx_px: 1\ncy_px: 2\nbaseline_m: 0.1\n");
  EXPECT_EQ(unknown.width, 0);
  EXPECT_EQ(unknown.height, 0);
}

TEST_F(ReadCalibration, RejectsBadPlainYaml) {
  expect_refused(replaced(plain, "0.119438", "60"), "the baseline is 60; it must be between 0.005 and 10 metres");
  expect_refused(replaced(plain, "0.119438", "0"), "the baseline is 0;");
  expect_refused(replaced(plain, "0.119438", "-0.12"), "swapped");
  expect_refused(replaced(plain, "1381.751", "3"), "the focal length is 3;");
  expect_refused("focal_px: 3\ncx_px: 1\ncy_px: 2\nbaseline_m: 0.1\n", "the focal length is 3;");
  expect_refused(replaced(plain, "1064.3", ".nan"), "cx_px is .nan; it must be a finite number");
  expect_refused(replaced(plain, "572.5", "-.inf"), "cy_px is -.inf; it must be a finite number");
  expect_refused(replaced(plain, "1064.3", "1e999"), "cx_px is 1e999; it must be a finite number");
  expect_refused(replaced(plain, "1064.3", "12abc"), "cx_px is \"12abc\"; it must be a number");
  expect_refused(replaced(plain, "1064.3", "[1, 2]"), "cx_px must be a number");
  expect_refused(replaced(plain, "2079", "20.5"), "width is 20.5");
  expect_refused(replaced(plain, "baseline_m", "baseline"), "baseline_m is missing");
  expect_refused(plain + "\tx: [\n", "invalid YAML");
  expect_refused(plain + "baseline_m: 0.2\n", "baseline_m is given twice");
}

TEST_F(ReadCalibration, RejectsOtherFiles) {
  expect_refused("", "the file is empty");
  expect_refused("hello world\n", "unknown calibration format");
  expect_refused(std::string("a\0b", 3), "not a text file");
  expect_refused_file((fs::temp_directory_path() / "roadstereo-none.yaml").string(), "does not exist");
  expect_refused_file(fs::temp_directory_path().string(), "is a folder");
  expect_refused_file(write(plain), "remove the second file", write(plain, "second"));
}

const std::string kitti =
    "P0: 721.5 0 609.5 0 0 721.5 172.8 0 0 0 1 0\n"
    "P1: 721.5 0 609.5 -387.6 0 721.5 172.8 0 0 0 1 0\n"
    "P2: 7.215377e+02 0.000000e+00 6.095593e+02 4.485728e+01 0 7.215377e+02 1.728540e+02 2.163791e-01 0 0 1 "
    "2.7e-03\n"
    "P3: 7.215377e+02 0.000000e+00 6.095593e+02 -3.395242e+02 0 7.215377e+02 1.728540e+02 2.199936e+00 0 0 1 "
    "2.7e-03\n"
    "R0_rect: 1 0 0 0 1 0 0 0 1\n";

TEST_F(ReadCalibration, KittiPrefersColourPair) {
  const CalibrationFile file = read_calibration(write(kitti));
  EXPECT_EQ(file.format, "KITTI P2/P3");
  EXPECT_DOUBLE_EQ(file.rectified->focal_px, 721.5377);
  EXPECT_DOUBLE_EQ(file.rectified->cy_px, 172.854);
  EXPECT_NEAR(file.rectified->baseline_m, (44.85728 + 339.5242) / 721.5377, 1e-12);
  EXPECT_EQ(file.rectified->width, 0);
  const CalibrationFile grey = read_calibration(write(kitti.substr(0, kitti.find("P2"))));
  EXPECT_EQ(grey.format, "KITTI P0/P1");
  EXPECT_NEAR(grey.rectified->baseline_m, 387.6 / 721.5, 1e-12);
}

TEST_F(ReadCalibration, KittiRawHasImageSize) {
  const StereoCalibration c = rectified(
      "calib_time: 09-Jan-2012 13:57:47\nS_rect_02: 1.242000e+03 3.750000e+02\n"
      "P_rect_02: 721.5 0 609.5 0 0 721.5 172.8 0 0 0 1 0\nP_rect_03: 721.5 0 610 -360.75 0 721.5 172.8 0 0 "
      "0 1 0\n");
  EXPECT_EQ(c.width, 1242);
  EXPECT_EQ(c.height, 375);
  EXPECT_DOUBLE_EQ(c.baseline_m, 0.5);
  EXPECT_DOUBLE_EQ(c.disparity_offset_px, 0.5);
}

TEST_F(ReadCalibration, RejectsBadKitti) {
  expect_refused("P2: 721.5 0 609.5 0 0 721.5 172.8 0 0 0 1 0\n", "P3 is missing");
  expect_refused("P2: 1 2 3\nP3: 1 2 3\n", "P2 has 3 values; it must have 12");
  expect_refused(replaced(kitti, "7.215377e+02", "nan"), "P2[0] is nan");
  expect_refused(replaced(kitti, "7.215377e+02", "x"), "P2[0] is \"x\"");
  expect_refused(replaced(kitti, "0.000000e+00", "9"), "P2[1] is 9");
  expect_refused(replaced(kitti, "7.215377e+02", "800"), "P3 has 721.5377");
  expect_refused(replaced(kitti, "-3.395242e+02", "4.485728e+01"), "the baseline is 0;");
  expect_refused(replaced(kitti, "-3.395242e+02", "4.485728e+02"), "swapped");
}

const std::string middlebury =
    "cam0=[ 999.421 0 294.182 ; 0 999.421 252.932 ; 0 0 1 ] \ncam1=[999.421 0 326.96; 0 999.421 252.932; 0 0 "
    "1]\n"
    " doffs= 32.778 \nbaseline= 193.001 \nwidth= 741\r\n height= 497\n ndisp= 70\n";

TEST_F(ReadCalibration, MiddleburyIsInMillimetres) {
  const StereoCalibration c = rectified(middlebury);
  EXPECT_DOUBLE_EQ(c.focal_px, 999.421);
  EXPECT_DOUBLE_EQ(c.cx_px, 294.182);
  EXPECT_DOUBLE_EQ(c.cy_px, 252.932);
  EXPECT_NEAR(c.baseline_m, 0.193001, 1e-15);
  EXPECT_DOUBLE_EQ(c.disparity_offset_px, 32.778);
  EXPECT_EQ(c.width, 741);
  EXPECT_EQ(c.height, 497);
  EXPECT_NEAR(rectified(replaced(middlebury, " doffs= 32.778 \n", "")).disparity_offset_px, 32.778, 1e-9);
  expect_refused(replaced(middlebury, "252.932; 0 0 1]", "262.932; 0 0 1]"), "the principal point's row");
  expect_refused(replaced(middlebury, "193.001", "0.193"), "the baseline is 0.000193;");
  expect_refused(replaced(middlebury, "baseline", "base"), "baseline is missing");
  expect_refused(replaced(middlebury, "294.182", "inf"), "cam0[2] is inf");
  expect_refused(replaced(middlebury, "999.421", "3"), "the focal length is 3;");
}

TEST_F(ReadCalibration, ReadsKTxt) {
  const CalibrationFile file = read_calibration(write("754.668 0.0 489.379 0.0 754.668 265.162 0.0 0.0 1.0\n0.063\n"));
  EXPECT_EQ(file.format, "K.txt");
  EXPECT_DOUBLE_EQ(file.rectified->focal_px, 754.668);
  EXPECT_DOUBLE_EQ(file.rectified->cx_px, 489.379);
  EXPECT_DOUBLE_EQ(file.rectified->cy_px, 265.162);
  EXPECT_DOUBLE_EQ(file.rectified->baseline_m, 0.063);
  EXPECT_DOUBLE_EQ(rectified("700 0 320\n0 700 240\n0 0 1\n0.12").baseline_m, 0.12);
  expect_refused("700 0 320\n0 700 240\n0 0 1\n63", "the baseline is 63;");
  expect_refused("700 0 320\n0 700 240\n0 0 1\n", "has 9 values");
  expect_refused("700 2 320\n0 700 240\n0 0 1\n0.12", "K[1] is 2;");
  expect_refused("700 0 320\n0 700 x\n0 0 1\n0.1", "K[5] is \"x\"");
  expect_refused("700 0 320\n0 700 nan\n0 0 1\n0.1", "K[5] is nan");
}

std::string opencv_matrix(const std::string& key, int rows, int columns, const std::string& data) {
  return key + ": !!opencv-matrix\n   rows: " + std::to_string(rows) + "\n   cols: " + std::to_string(columns) +
         "\n   dt: d\n   data: [ " + data + " ]\n";
}

std::string opencv_file(const std::string& letter, const std::string& t,
                        const std::string& d = "0.1, -0.2, 0., 0., 0.") {
  return "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\n" +
         opencv_matrix(letter + "1", 3, 3, "500., 0., 320., 0., 501., 240., 0., 0., 1.") +
         opencv_matrix("D1", 1, 5, d) +
         opencv_matrix(letter + "2", 3, 3, "502., 0., 321., 0., 503., 241., 0., 0., 1.") +
         opencv_matrix("D2", 1, 5, d) + opencv_matrix("R", 3, 3, "1., 0., 0., 0., 0.8, -0.6, 0., 0.6, 0.8") +
         opencv_matrix("T", 3, 1, t);
}

TEST_F(ReadCalibration, ReadsOpenCvStereoYaml) {
  for (const char* letter : {"K", "M"}) {
    const CalibrationFile file = read_calibration(write(opencv_file(letter, "-0.12, 0.001, 0.002")));
    EXPECT_EQ(file.format, "OpenCV stereo");
    ASSERT_TRUE(file.rig);
    EXPECT_FALSE(file.rectified);
    EXPECT_EQ(file.rig->left_matrix, (std::array<double, 9>{500, 0, 320, 0, 501, 240, 0, 0, 1}));
    EXPECT_EQ(file.rig->right_matrix, (std::array<double, 9>{502, 0, 321, 0, 503, 241, 0, 0, 1}));
    EXPECT_EQ(file.rig->left_distortion, (std::vector<double>{0.1, -0.2, 0, 0, 0}));
    EXPECT_EQ(file.rig->rotation, (std::array<double, 9>{1, 0, 0, 0, 0.8, -0.6, 0, 0.6, 0.8}));
    EXPECT_EQ(file.rig->translation_m, (std::array<double, 3>{-0.12, 0.001, 0.002}));
    EXPECT_EQ(file.rig->width, 640);
    EXPECT_EQ(file.rig->height, 480);
    EXPECT_FALSE(file.rig->fisheye);
  }
  const std::string fisheye = opencv_file("K", "-0.12, 0, 0") + "fisheye: 1\n";
  expect_refused(fisheye, "the fisheye model has 4");
}

std::string without(std::string text, const std::string& word, const std::string& instead) {
  const std::size_t at = text.find(word);
  return text.replace(at, word.size(), instead);
}

// Read as none, a distortion costs the damage of a whole recording.
TEST_F(ReadCalibration, DistortionOfOpenCvStereoIsNotLost) {
  const std::string good = opencv_file("K", "-0.12, 0, 0");
  expect_refused(without(good, "D2:", "E2:"), "D2 is missing");
  expect_refused(without(without(good, "D1:", "dist1:"), "D2:", "dist2:"),
                 "D1 and D2 are missing; there is a key dist1");
  expect_refused(good + "distortion_model: mei\n", "distortion_model is mei");
  const std::string four = opencv_file("K", "-0.12, 0, 0", "0.1, -0.2, 0.01, 0.02");
  const std::string short_file = without(without(four, "cols: 5", "cols: 4"), "cols: 5", "cols: 4");
  for (const char* model : {"KannalaBrandt8", "\"equidistant\"", "equi", "Fisheye"}) {
    EXPECT_TRUE(read_calibration(write(short_file + "distortion_model: " + model + "\n")).rig->fisheye) << model;
  }
  for (const char* model : {"plumb_bob", "radtan", "\"Brown\""}) {
    EXPECT_FALSE(read_calibration(write(short_file + "distortion_model: " + model + "\n")).rig->fisheye) << model;
  }
}

TEST_F(ReadCalibration, ReadsOpenCvStereoXmlOfRectifiedPair) {
  const auto matrix = [](const std::string& key, const std::string& size, const std::string& data) {
    return "<" + key + " type_id=\"opencv-matrix\">" + size + "<dt>d</dt><data>" + data + "</data></" + key + ">\n";
  };
  const std::string square = "<rows>3</rows><cols>3</cols>";
  const std::string k = "500. 0. 320. 0. 500. 240. 0. 0. 1.";
  const CalibrationFile file =
      read_calibration(write("<?xml version=\"1.0\"?>\n<opencv_storage>\n" + matrix("K1", square, k) +
                             matrix("K2", square, k) + matrix("R", square, "1. 0. 0. 0. 1. 0. 0. 0. 1.") +
                             matrix("T", "<rows>3</rows><cols>1</cols>", "-0.25 0. 0.") + "</opencv_storage>\n"));
  ASSERT_TRUE(file.rectified);
  EXPECT_FALSE(file.rig);
  EXPECT_EQ(file.rectified->focal_px, 500);
  EXPECT_EQ(file.rectified->cx_px, 320);
  EXPECT_EQ(file.rectified->cy_px, 240);
  EXPECT_EQ(file.rectified->baseline_m, 0.25);
  EXPECT_EQ(file.rectified->width, 0);
}

TEST_F(ReadCalibration, ReadsOpenCvStereoInTwoFiles) {
  const std::string whole = opencv_file("M", "-0.12, 0., 0.");
  const std::size_t cut = whole.find("R: ");
  const CalibrationFile file = read_calibration(write(whole.substr(0, cut), "intrinsics.yml"),
                                                write("%YAML:1.0\n---\n" + whole.substr(cut), "extrinsics.yml"));
  ASSERT_TRUE(file.rig);
  EXPECT_EQ(file.rig->translation_m[0], -0.12);
}

// Whoever adds one key after the other reads six messages.
TEST_F(ReadCalibration, NamesAllMissingKeys) {
  const std::string whole = opencv_file("K", "-0.12, 0., 0.");
  const std::size_t cut = whole.find("R: ");
  expect_refused(whole.substr(0, cut), "R and T are missing; extrinsics in another file are a second --calibration");
  expect_refused("%YAML:1.0\n---\n" + whole.substr(cut), "K1, D1, K2 and D2 are missing; intrinsics in another file");
  expect_refused("%YAML:1.0\n---\nmtxL: 1\n", "K1, D1, K2, D2, R and T are missing");
  expect_refused("focal_px: 500\nbaseline_m: 0.1\n", "cx_px, cy_px are missing; an unknown principal point is about");
  expect_refused("baseline_m: 0.1\ncx_px: 1\ncy_px: 1\n", "focal_px is missing");
}

TEST_F(ReadCalibration, ReadsOtherNamesOfOpenCv) {
  std::string text = opencv_file("K", "-0.12, 0., 0.");
  const CalibrationFile usual = read_calibration(write(text));
  for (const auto& [from, to] : {std::pair("K1:", "cameraMatrix1:"), std::pair("K2:", "cameraMatrix2:"),
                                 std::pair("D1:", "distCoeffs1:"), std::pair("D2:", "distCoeffs2:")}) {
    text = replaced(text, from, to);
  }
  const CalibrationFile file = read_calibration(write(text));
  ASSERT_TRUE(file.rig);
  EXPECT_EQ(file.rig->right_matrix, usual.rig->right_matrix);
  EXPECT_EQ(file.rig->left_distortion, usual.rig->left_distortion);
}

// As `stereoRectify` writes them: P2[3] is −focal length × baseline, 500 px × 0.12 m.
TEST_F(ReadCalibration, ReadsProjectionsOfOpenCvAlone) {
  const auto matrix = [](const std::string& key, const std::string& data) {
    return key + ": !!opencv-matrix\n   rows: 3\n   cols: 4\n   dt: d\n   data: [ " + data + " ]\n";
  };
  const std::string text = "%YAML:1.0\n---\n" + matrix("P1", "500., 0., 320., 0., 0., 500., 240., 0., 0., 0., 1., 0.") +
                           matrix("P2", "500., 0., 322., -60., 0., 500., 240., 0., 0., 0., 1., 0.");
  const StereoCalibration calibration = rectified(text + "image_width: 640\nimage_height: 480\n");
  EXPECT_EQ(calibration.focal_px, 500);
  EXPECT_EQ(calibration.cx_px, 320);
  EXPECT_EQ(calibration.cy_px, 240);
  EXPECT_DOUBLE_EQ(calibration.baseline_m, 0.12);
  EXPECT_EQ(calibration.disparity_offset_px, 2);
  EXPECT_EQ(calibration.width, 640);
  const std::string whole = opencv_file("K", "-0.12, 0., 0.");
  expect_refused(text + whole.substr(whole.find("R: ")), "K1, D1, K2 and D2 are missing");  // of raw pictures
}

// Of a file without an image size the principal point tells whether the pictures were scaled since.
TEST_F(ReadCalibration, PrincipalPointFarFromMiddleIsDoubted) {
  const auto doubt = [&](const std::string& centre, int width, int height, const std::string& more = "") {
    return read_calibration(write("focal_px: 700\nbaseline_m: 0.1\n" + centre + more)).size_doubt(width, height);
  };
  const std::string hd = "cx_px: 639.5\ncy_px: 359.5\n";
  EXPECT_EQ(doubt(hd, 1280, 720), "");
  EXPECT_EQ(doubt(hd, 1000, 562, "width: 1280\nheight: 720\n"), "") << "the file has a size, which is checked";
  for (const auto& [width, height] : {std::pair(640, 360), std::pair(960, 540), std::pair(2560, 1440)}) {
    const std::string text = doubt(hd, width, height);
    EXPECT_NE(text.find("principal point (639.5, 359.5)"), std::string::npos) << width << ": " << text;
    EXPECT_NE(text.find("it suggests 1280×720"), std::string::npos) << width << ": " << text;
  }
  // Rectified rigs: KITTI; Middlebury's Jadeplant and Recycle; a view that was cut off above.
  EXPECT_EQ(doubt("cx_px: 609.56\ncy_px: 172.85\n", 1242, 375), "");
  EXPECT_EQ(doubt("cx_px: 951.3\ncy_px: 970.1\n", 2632, 1988), "");
  EXPECT_EQ(doubt("cx_px: 1135.5\ncy_px: 976.4\n", 2880, 1924), "");
  EXPECT_EQ(doubt("cx_px: 639.5\ncy_px: 180\n", 1280, 540), "");
  const CalibrationFile rig = read_calibration(write(opencv_file("K", "-0.12, 0., 0.")));  // with its size
  EXPECT_EQ(rig.size_doubt(320, 240), "");
}

TEST_F(ReadCalibration, RejectsBadOpenCvStereo) {
  const std::string good = opencv_file("K", "-0.12, 0., 0.");
  expect_refused(opencv_file("K", "-60., 0., 0."), "the baseline is 60; it must be between 0.005 and 10 metres");
  expect_refused(opencv_file("K", "0., 0., 0."), "the baseline is 0;");
  expect_refused(opencv_file("K", "-0.12, .Nan, 0."), "T is .Nan");
  expect_refused(opencv_file("X", "-0.12, 0., 0."), "K1 and K2 are missing; ");
  expect_refused(replaced(good, "T: ", "U: "), "T is missing");
  expect_refused(replaced(good, "500.", "3."), "the focal length is 3;");
  expect_refused(replaced(good, "0.8, -0.6", "0.8, -0.7"), "R is not a rotation");
  expect_refused(replaced(good, "data: [ 500.", "data: [ [ 500."), "invalid YAML");
  expect_refused(replaced(good, "K1: ", "K1: hello\nX1: "), "K1 must be a matrix");
  expect_refused("<?xml version=\"1.0\"?>\n<opencv_storage>\n<K1>", "");
}

TEST_F(ReadCalibration, ReadsOpenCvLists) {
  const std::string lists =
      "K1: [500, 0, 320, 0, 500, 240, 0, 0, 1]\nK2: [500, 0, 320, 0, 500, 240, 0, 0, 1]\nR: [1, 0, 0, 0, 1, 0, 0, 0, "
      "1]\n"
      "T: [-0.25, 0, 0]\nimageSize: [640, 480]\n";
  for (const char* size : {"imageSize: [640, 480]", "imageSize: 640"}) {
    const CalibrationFile file =
        read_calibration(write("%YAML:1.0\n---\n" + replaced(lists, "imageSize: [640, 480]", size)));
    ASSERT_TRUE(file.rectified) << size;
    EXPECT_EQ(file.rectified->width, 640);
    EXPECT_EQ(file.rectified->baseline_m, 0.25);
  }
  const CalibrationFile xml = read_calibration(
      write("<opencv_storage><K1>500 0 320 0 500 240 0 0 1</K1><K2>500 0 320 0 500 240 0 0 1</K2>\n"
            "<R>1 0 0 0 1 0 0 0 1</R><T>\n -0.25 0. 0.</T><imageSize>\n 640 480</imageSize></opencv_storage>"));
  EXPECT_EQ(xml.rectified->height, 480);
}

/// A text of `part` repeated.
std::string repeated(const std::string& part, int times) {
  std::string text;
  for (int i = 0; i < times; ++i) text += part;
  return text;
}

TEST_F(ReadCalibration, RejectsHostileOpenCvFiles) {
  constexpr int deep = 100'000;
  expect_refused("%YAML:1.0\n---\nK1: " + repeated("[", deep), "");
  expect_refused("%YAML:1.0\n---\nK1: " + repeated("{a: ", deep), "");
  expect_refused("%YAML:1.0\n---\nK1: " + repeated("- ", deep), "");
  expect_refused("%YAML:1.0\n---\n" + repeated("? ", deep), "");
  expect_refused("{\"opencv-matrix\": " + repeated("[", deep), "");
  expect_refused("<opencv_storage>" + repeated("<a>", deep), "invalid XML");
  expect_refused("<opencv_storage>" + repeated("<a>", deep) + repeated("</a>", deep) + "</opencv_storage>", "K1");
  expect_refused("%YAML:1.0\n---\n x:\\\nD0:-\nL", "");  // made cv::FileStorage read for ever
  expect_refused(" \xff:5\n :opencv-matrix", "");        // made it throw std::length_error
}

/// Rotation about one axis (0 = x, 1 = y, 2 = z), row-major.
std::array<double, 9> turn(int axis, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  if (axis == 0) return {1, 0, 0, 0, c, -s, 0, s, c};
  if (axis == 1) return {c, 0, s, 0, 1, 0, -s, 0, c};
  return {c, -s, 0, s, c, 0, 0, 0, 1};
}

std::array<double, 3> times(const std::array<double, 9>& m, const std::array<double, 3>& x) {
  std::array<double, 3> y{};
  for (std::size_t i = 0; i < 3; ++i) y[i] = m[3 * i] * x[0] + m[3 * i + 1] * x[1] + m[3 * i + 2] * x[2];
  return y;
}

template <std::size_t Count>
std::string list(const std::array<double, Count>& figures) {
  std::ostringstream text;
  text.precision(17);
  for (std::size_t i = 0; i < Count; ++i) text << (i == 0 ? "[" : ", ") << figures[i];
  return text.str() + "]";
}

std::string ros_file(const std::array<double, 9>& r, double p3, const std::string& d,
                     const std::string& model = "plumb_bob") {
  return "image_width: 640\nimage_height: 480\ncamera_name: left\n"
         "camera_matrix:\n  rows: 3\n  cols: 3\n  data: [500, 0, 320, 0, 500, 240, 0, 0, 1]\n"
         "distortion_model: " +
         model + "\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n  data: " + d +
         "\nrectification_matrix:\n  rows: 3\n  cols: 3\n  data: " + list(r) +
         "\nprojection_matrix:\n  rows: 3\n  cols: 4\n  data: " +
         list(std::array<double, 12>{500, 0, 320, p3, 0, 500, 240, 0, 0, 0, 1, 0}) + "\n";
}

TEST_F(ReadCalibration, RosPairGivesRectifiedRig) {
  const auto left_turn = turn(1, 0.03);
  const auto right_turn = turn(2, -0.02);
  const std::string d = "[0.1, -0.2, 0, 0, 0]";
  const CalibrationFile file = read_calibration(write(ros_file(left_turn, 0, d), "left.yaml"),
                                                write(ros_file(right_turn, -60, d), "right.yaml"));
  EXPECT_EQ(file.format, "ROS camera_info");
  ASSERT_TRUE(file.rig);
  EXPECT_EQ(file.rig->width, 640);
  EXPECT_EQ(file.rig->left_distortion.size(), 5U);
  // A point in the left camera, taken to the right one by the rig and rectified there, must lie beside the
  // same point rectified in the left camera: moved by the baseline of 60 / 500 metres and nothing else.
  const std::array<double, 3> point{0.3, -0.2, 2.5};
  std::array<double, 3> seen = times(file.rig->rotation, point);
  for (std::size_t i = 0; i < 3; ++i) seen[i] += file.rig->translation_m[i];
  const std::array<double, 3> right = times(right_turn, seen);
  const std::array<double, 3> left = times(left_turn, point);
  EXPECT_NEAR(right[0], left[0] - 0.12, 1e-12);
  EXPECT_NEAR(right[1], left[1], 1e-12);
  EXPECT_NEAR(right[2], left[2], 1e-12);
}

TEST_F(ReadCalibration, ReadsRectifiedRosPair) {
  const auto none = turn(0, 0);
  const std::string d = "[0, 0, 0, 0, 0]";
  const std::string left = write(ros_file(none, 0, d), "left.yaml");
  const CalibrationFile file = read_calibration(left, write(ros_file(none, -60, d), "right.yaml"));
  ASSERT_TRUE(file.rectified);
  EXPECT_EQ(file.rectified->focal_px, 500);
  EXPECT_DOUBLE_EQ(file.rectified->baseline_m, 0.12);
  EXPECT_EQ(file.rectified->width, 640);
  expect_refused_file(left, "the file of the right camera is needed, too");
  expect_refused_file(left, "the baseline is 0;", left);
  expect_refused_file(left, "swapped", write(ros_file(none, 60, d), "right.yaml"));
  expect_refused_file(left, "the baseline is 60;", write(ros_file(none, -30000, d), "right.yaml"));
  expect_refused_file(left, "distortion_model is \"odd\"", write(ros_file(none, -60, d, "odd"), "right.yaml"));
  expect_refused_file(left, "rectification_matrix is missing",
                      write(replaced(ros_file(none, -60, d), "rectification_matrix", "other"), "right.yaml"));
  expect_refused_file(left, "projection_matrix[3] is \"x\"",
                      write(replaced(ros_file(none, -60, d), "-60", "x"), "right.yaml"));
}

TEST(ReadCalibrationRealData, ReadsAll) {
  const char* data = std::getenv("ROADSTEREO_DATA");
  if (data == nullptr || !fs::exists(data)) GTEST_SKIP() << "ROADSTEREO_DATA does not name a folder: not tested";
  const fs::path root(data);
  const auto zed = read_calibration((root / "potholes/calibration_p3.yaml").string()).rectified.value();
  EXPECT_DOUBLE_EQ(zed.focal_px, 1389.162);
  zed.validate(2081, 1040, "p3");
  const auto table = read_calibration((root / "middlebury/PlaytableP/calib.txt").string()).rectified.value();
  EXPECT_NEAR(table.baseline_m, 0.193006, 1e-12);
  EXPECT_DOUBLE_EQ(table.disparity_offset_px, 25.07);
  table.validate(681, 462, "PlaytableP");
}

}  // namespace
