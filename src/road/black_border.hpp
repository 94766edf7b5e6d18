#pragma once

#include <cstdint>

#include "core/scratch.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo {

/// The mask of an image (empty, or of its size; not 0 where pixels are left out) together with what lies outside of the
/// picture: what is black from a side of the image on, as rectification, letterboxes and pillarboxes leave it. Its edge
/// is at the same place in both images and would match there, at a disparity of 0. Nothing is black where less than one
/// in 50 pixels of the sides, or in 500 of the image, is. Rows and columns at the sides that repeat the picture lie
/// outside, too (`find_repeated_border`). In scratch memory.
class PictureMask {
 public:
  PictureMask(ImageView<const std::int16_t> grey, ImageView<const std::uint8_t> mask);
  PictureMask(const PictureMask&) = delete;
  PictureMask& operator=(const PictureMask&) = delete;

  ImageView<const std::uint8_t> view() const { return view_; }

 private:
  ScratchVector<std::uint8_t> outside_;
  ImageView<const std::uint8_t> view_;
};

}  // namespace roadstereo
