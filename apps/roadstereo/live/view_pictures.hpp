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

/// An encoded image of a view.
struct ViewPicture {
  std::string jpeg;
  double half_range_px = 0;  ///< of a transformed map: its colours show ± this around the road
};

/// Returns the colour scale as PNG, lowest value first.
std::string scale_ramp_png();

/// JPEGs of the latest views, encoded on request, once for all clients.
class ViewPictures {
 public:
  using Shared = std::shared_ptr<const ViewPicture>;

  Shared left(const SharedView& view);         ///< with outlined damage
  Shared transformed(const SharedView& view);  ///< coloured

 private:
  enum class Kind { left, transformed };
  struct Entry {
    SharedView view;
    Kind kind = Kind::left;
    std::mutex mutex;  ///< held while encoding: other clients wait for the result
    Shared picture;
  };

  std::shared_ptr<Entry> entry_of(const SharedView& view, Kind kind);
  Shared get(const SharedView& view, Kind kind);

  std::mutex mutex_;
  std::deque<std::shared_ptr<Entry>> entries_;  ///< newest first
};

}  // namespace roadstereo::cli
