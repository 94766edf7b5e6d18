#include "flight/frame_files.hpp"

#include <fmt/core.h>

#include <array>

#include "roadstereo/io/damage_overlay.hpp"
#include "roadstereo/io/image_file.hpp"
#include "roadstereo/io/pictures.hpp"
#include "roadstereo/io/point_cloud.hpp"

namespace roadstereo::cli {

namespace {

constexpr std::array all_files = {FrameFile::disparity, FrameFile::transformed, FrameFile::sheet, FrameFile::cloud,
                                  FrameFile::overlay};

std::string name_of_file(FrameFile file, std::int64_t index) {
  switch (file) {
    case FrameFile::disparity:
      return fmt::format("disparity/{:06}.tiff", index);
    case FrameFile::transformed:
      return fmt::format("transformed/{:06}.tiff", index);
    case FrameFile::sheet:
      return fmt::format("sheet/{:06}.png", index);
    case FrameFile::cloud:
      return fmt::format("cloud/{:06}.ply", index);
    case FrameFile::overlay:
      return fmt::format("overlay/{:06}.png", index);
  }
  return {};
}

std::vector<std::uint8_t> sheet_of(const FlightJob& job) {
  const auto geometry = job.result.roll_found ? std::optional(job.result.geometry) : std::nullopt;
  return io::encode_png(io::result_sheet(job.pair.left.view(), job.frame.white_level, job.result.disparity,
                                         job.result.transformed, job.result.delta_t, geometry, job.frame.name)
                            .view());
}

std::vector<std::uint8_t> content_of(FrameFile file, const std::optional<StereoCalibration>& calibration,
                                     const FlightJob& job) {
  switch (file) {
    case FrameFile::disparity:
      return io::encode_float_tiff(job.result.disparity);
    case FrameFile::transformed:
      return io::encode_float_tiff(job.result.transformed);
    case FrameFile::sheet:
      return sheet_of(job);
    case FrameFile::cloud:
      return io::encode_ply(
          cloud_from_disparity(job.result.disparity, job.pair.left.view(), job.frame.white_level, calibration.value()));
    case FrameFile::overlay:
      return io::encode_png(io::damage_overlay(job.pair.left.view(), job.frame.white_level, job.damage).view());
  }
  return {};
}

}  // namespace

StagedFile encode_frame_file(FrameFile file, const std::optional<StereoCalibration>& calibration,
                             const FlightJob& job) {
  return {name_of_file(file, job.frame.index), content_of(file, calibration, job)};
}

std::vector<std::string> frame_file_names(std::int64_t index) {
  std::vector<std::string> names;
  names.reserve(all_files.size());
  for (const FrameFile file : all_files) names.push_back(name_of_file(file, index));
  return names;
}

}  // namespace roadstereo::cli
