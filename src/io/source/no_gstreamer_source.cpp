#include "io/source/sources.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {

std::unique_ptr<FrameSource> open_gstreamer(const std::string& pipeline, const SourceOptions&) {
  fail("the pipeline \"", pipeline,
       "\": this program was built without GStreamer; Debian's libgstreamer-plugins-base1.0-dev is needed when it is ",
       "built");
}

}  // namespace roadstereo::io
