#include "source_options.hpp"

#include <CLI/CLI.hpp>

#include "image_size.hpp"

namespace roadstereo::cli {

void add_calibration_option(CLI::App& command, std::vector<std::string>& calibration) {
  command.add_option("--calibration", calibration, "Calibration file; repeat (left, right) for a ROS or EuRoC pair")
      ->type_name("FILE")
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all();
}

void add_source_options(CLI::App& command, SourceSettings& choice) {
  command
      .add_option("--layout", choice.layout,
                  "Arrangement of both views in one image: side-by-side, top-bottom, or auto (by aspect ratio)")
      ->type_name("NAME")
      ->capture_default_str();
  command.add_option("--topics", choice.topics, "Left and right image topic of a ROS bag")
      ->type_name("LEFT,RIGHT")
      ->delimiter(',')
      ->expected(1, 2)
      ->allow_extra_args(false);
  command
      .add_option("--max-time-difference", choice.max_time_difference_ms,
                  "Maximum time between the views of a pair, milliseconds")
      ->type_name("MS")
      ->capture_default_str();
  command.add_option("--rate", choice.rate_hz, "Pairs per second, replaces the times of the source")->type_name("HZ");
  command
      .add_option("--camera-size", choice.camera_size,
                  "Size of the image with both views, requested from a V4L2 camera")
      ->type_name("WxH");
}

io::SourceOptions make_source_options(const SourceSettings& choice) {
  constexpr double ms = 1e-3;
  io::SourceOptions options;
  options.layout = io::stereo_layout(choice.layout);
  options.topics = choice.topics;
  options.max_time_difference_s = choice.max_time_difference_ms * ms;
  options.rate_hz = choice.rate_hz;
  if (!choice.camera_size.empty()) {
    const ImageSize size = parse_image_size("--camera-size", choice.camera_size);
    options.camera_width = size.width;
    options.camera_height = size.height;
  }
  options.validate();
  return options;
}

}  // namespace roadstereo::cli
