// The roll of the camera over a road, from two frames in memory. A camera driver would fill the two
// FrameView; here the frames are drawn.
#include <iostream>
#include <numbers>
#include <roadstereo/roadstereo.hpp>
#include <roadstereo/synth.hpp>

int main() {
  try {
    const auto pair = roadstereo::synth::render(roadstereo::synth::named_scene("demo"));

    roadstereo::Pipeline pipeline(roadstereo::preset("default"), pair.calibration);
    const roadstereo::FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());

    const double degrees = 180 / std::numbers::pi;
    std::cout << "roll " << result.geometry.roll_rad * degrees << " degrees, the truth is " << pair.roll_rad * degrees
              << "\n";
    return result.roll_found ? 0 : 1;
  } catch (const roadstereo::Error& error) {
    std::cerr << error.what() << "\n";
    return 2;
  }
}
