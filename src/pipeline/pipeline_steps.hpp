#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scratch.hpp"
#include "pipeline/frame_stages.hpp"
#include "pipeline/row_correction.hpp"
#include "pipeline/stage_timer.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo {

/// What a pipeline carries through the steps of a frame (paper, section 3), and the steps, in their order.
struct Pipeline::State {
  PipelineOptions options;
  std::optional<StereoCalibration> calibration;
  std::string engine_name;
  int threads = 1;
  std::unique_ptr<FrameStages> stages;
  Image<std::uint8_t> mask;  ///< not 0 masked; empty: none

  PipelineState carried;
  Clock::time_point begin;    ///< of the frame
  int width = 0, height = 0;  ///< of the frame, pixels
  bool has_frame = false;     ///< whether `result` belongs to one frame, whole
  bool has_maps = false;      ///< whether the maps that a device keeps do
  bool has_profile = false;   ///< whether the kernels that a device has timed do
  bool is_shared = false;     ///< whether set_device_options asks for more than any engine has

  ScratchMemory memory;
  FrameResult result;

  GreyImage aligned_right;  ///< align_on_host
  std::vector<int> first_column;

  void begin_frame(const FrameView& left, const FrameView& right);
  GreyPair convert_to_grey(const FrameView& left, const FrameView& right);
  GreyPair equalise_blur(const GreyPair& pair);
  GreyPair undo_misalignment(const GreyPair& pair);
  GreyPair align_on_host(const GreyPair& pair);
  void warn_of_negative_disparities();
  void estimate_road_model(const GreyPair& pair);
  void track_in_noise(const GreyPair& pair);
  void measure_rows(const GreyPair& grey, Rows of);
  MatchInput transform_perspective(const GreyPair& pair);
  CoarseSearchOptions coarse_options(int factor, int block_radius) const;
  MatchInput search_coarsely(const MatchInput& pair);
  double road_foreshortening() const;
  ResidualMaps match(const MatchInput& input);
  DisparityMaps restore_disparity(const ResidualMaps& residual);
  RefinedMaps refine(const DisparityMaps& maps);
  ImageView<const float> interpolate(const RefinedMaps& maps);
  void leave_out_mask(ImageView<float> map, int pixel_step) const;
  ImageView<const float> align(const MatchInput& input, ImageView<const float> disparity);
  bool searches_road_alone() const;
  DisparityPriorView search_scene(const MatchInput& pair);
  ImageView<const float> reject_off_road(ImageView<const float> disparity, const DisparityPriorView& scene);
  ImageView<const float> subtract_bias(ImageView<const float> disparity);
  void estimate_roll(ImageView<const float> disparity);
  void transform_disparity(ImageView<const float> disparity);
  void download();
  void run_stages(const FrameView& left, const FrameView& right);
  void end_frame();
};

}  // namespace roadstereo
