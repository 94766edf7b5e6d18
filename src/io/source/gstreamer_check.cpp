#include "io/source/gstreamer_check.hpp"

#include <gst/gst.h>

#include <memory>

#include "roadstereo/error.hpp"

namespace roadstereo::io {

void check_pipeline(const std::string& source, const std::string& pipeline) {
  GError* raw_error = nullptr;
  GstElement* parsed = nullptr;
  if (gst_init_check(nullptr, nullptr, &raw_error) == TRUE) {
    parsed = gst_parse_launch_full(pipeline.c_str(), nullptr, GST_PARSE_FLAG_FATAL_ERRORS, &raw_error);
  }
  if (parsed != nullptr) gst_object_unref(gst_object_ref_sink(parsed));
  const std::unique_ptr<GError, decltype(&g_error_free)> error(raw_error, &g_error_free);
  if (error != nullptr) fail(source, " is refused by GStreamer: ", error->message);
  if (parsed == nullptr) fail(source, " is refused by GStreamer");
}

}  // namespace roadstereo::io
