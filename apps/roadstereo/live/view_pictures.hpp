#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "live/live_view.hpp"
#include "roadstereo/io/pictures.hpp"

namespace roadstereo::cli {

/// A picture of a view.
struct ViewPicture {
  std::string jpeg;
  double reach_px = 0;  ///< of a transformed map: its colours go from so far below the road to as far above it
};

/// The scale's colours from its lowest to its highest value, PNG.
std::string scale_ramp_png();

/// JPEGs of the latest views, made when somebody asks for them, once for all who do.
class ViewPictures {
 public:
  using Shared = std::shared_ptr<const ViewPicture>;

  Shared left(const SharedView& view);         ///< with outlined damage
  Shared transformed(const SharedView& view);  ///< coloured

 private:
  enum class Kind { left, transformed };
  struct Place {
    SharedView view;
    Kind kind = Kind::left;
    std::mutex mutex;  ///< held while it is made: others wait for it instead of making it, too
    Shared picture;
  };

  std::shared_ptr<Place> place_of(const SharedView& view, Kind kind);
  Shared get(const SharedView& view, Kind kind);

  std::mutex mutex_;
  std::deque<std::shared_ptr<Place>> places_;  ///< newest first
};

}  // namespace roadstereo::cli
