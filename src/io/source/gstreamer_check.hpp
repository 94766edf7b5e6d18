#pragma once

#include <string>

namespace roadstereo::io {

/// Asks GStreamer whether the text is a pipeline; nothing is opened. OpenCV would wait for ever for one of which an
/// element is missing. Throws Error that begins with `source` and ends with what GStreamer says.
void check_pipeline(const std::string& source, const std::string& pipeline);

}  // namespace roadstereo::io
