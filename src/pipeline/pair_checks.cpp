#include "pipeline/pair_checks.hpp"

#include "roadstereo/error.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo {
namespace {

void require_picture(const ImageContents& image, const char* name) {
  if (image.has_contrast) return;
  fail("the ", name, " image shows nothing: every pixel has the grey level ",
       static_cast<double>(image.first) / grey_scale, " of 255");
}

}  // namespace

void require_pair(const PairContents& contents) {
  require_picture(contents.left, "left");
  require_picture(contents.right, "right");
  if (contents.equal) fail("left and right are the same image");
}

}  // namespace roadstereo
