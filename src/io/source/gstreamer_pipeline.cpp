#include "io/source/gstreamer_pipeline.hpp"

#include <gst/gst.h>
#include <gst/video/video.h>

#include <chrono>
#include <limits>

#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

constexpr GstClockTime slice = 100 * GST_MSECOND;  // between checks of the message bus
constexpr int max_slices = 100;

struct ErrorFree {
  void operator()(GError* error) const { g_error_free(error); }
};
struct SampleUnref {
  void operator()(GstSample* sample) const { gst_sample_unref(sample); }
};

GstElement* find_sink(GstElement* pipeline) {
  GstIterator* elements = gst_bin_iterate_all_by_element_factory_name(GST_BIN(pipeline), "appsink");
  GValue item = G_VALUE_INIT;
  GstElement* sink = nullptr;
  if (gst_iterator_next(elements, &item) == GST_ITERATOR_OK) {
    sink = GST_ELEMENT(g_value_dup_object(&item));
    g_value_unset(&item);
  }
  gst_iterator_free(elements);
  return sink;
}

/// Copies the image; empty if it is none.
cv::Mat copy_samples(GstSample* sample) {
  GstVideoInfo info;
  const GstCaps* caps = gst_sample_get_caps(sample);
  if (caps == nullptr || gst_video_info_from_caps(&info, caps) == FALSE) return {};
  GstVideoFrame frame;
  if (gst_video_frame_map(&frame, &info, gst_sample_get_buffer(sample), GST_MAP_READ) == FALSE) return {};
  const int type = GST_VIDEO_INFO_FORMAT(&info) == GST_VIDEO_FORMAT_GRAY8 ? CV_8UC1 : CV_8UC3;
  const cv::Mat samples(GST_VIDEO_INFO_HEIGHT(&info), GST_VIDEO_INFO_WIDTH(&info), type,
                        GST_VIDEO_FRAME_PLANE_DATA(&frame, 0),
                        static_cast<std::size_t>(GST_VIDEO_FRAME_PLANE_STRIDE(&frame, 0)));
  cv::Mat copy = samples.clone();
  gst_video_frame_unmap(&frame);
  return copy;
}

}  // namespace

void GStreamerPipeline::Stop::operator()(GstElement* pipeline) const {
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(pipeline);
}

void GStreamerPipeline::Unref::operator()(void* object) const {
  gst_object_unref(object);
}

GStreamerPipeline::GStreamerPipeline(const std::string& text) : name_("the pipeline \"" + text + "\"") {
  const bool has_sink = text.find("appsink") != std::string::npos;
  parse(has_sink ? text : text + " ! videoconvert ! appsink max-buffers=2 sync=false");
  start(!has_sink);
}

void GStreamerPipeline::parse(const std::string& text) {
  GError* raw_error = nullptr;
  GstElement* parsed = nullptr;
  if (gst_init_check(nullptr, nullptr, &raw_error) == TRUE) {
    parsed = gst_parse_launch_full(text.c_str(), nullptr, GST_PARSE_FLAG_FATAL_ERRORS, &raw_error);
  }
  if (parsed != nullptr) pipeline_.reset(GST_ELEMENT(gst_object_ref_sink(parsed)));
  const std::unique_ptr<GError, ErrorFree> error(raw_error);
  if (error != nullptr) fail(name_, " is rejected by GStreamer: ", error->message);
  if (pipeline_ == nullptr || !GST_IS_BIN(pipeline_.get())) fail(name_, " is not a GStreamer pipeline");
  GstElement* sink = find_sink(pipeline_.get());
  if (sink == nullptr) fail(name_, " contains the word appsink, but has no such element");
  sink_.reset(GST_APP_SINK(sink));
  GstCaps* caps = gst_caps_from_string("video/x-raw, format=(string){ BGR, GRAY8 }");
  gst_app_sink_set_caps(sink_.get(), caps);
  gst_caps_unref(caps);
}

/// Pauses first: only then GStreamer reports whether the pipeline is live, i.e. has no preroll.
void GStreamerPipeline::start(bool drop_when_live) {
  gst_element_set_state(pipeline_.get(), GST_STATE_PAUSED);
  GstStateChangeReturn state = GST_STATE_CHANGE_ASYNC;
  for (int i = 0; i < max_slices && state == GST_STATE_CHANGE_ASYNC; ++i) {
    state = gst_element_get_state(pipeline_.get(), nullptr, nullptr, slice);
    throw_failure();
  }
  if (state == GST_STATE_CHANGE_ASYNC) fail(name_, " delivers no image within ten seconds");
  live_ = state == GST_STATE_CHANGE_NO_PREROLL;
  if (drop_when_live) gst_app_sink_set_drop(sink_.get(), live_ ? TRUE : FALSE);
  const bool failed = state == GST_STATE_CHANGE_FAILURE ||
                      gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING) == GST_STATE_CHANGE_FAILURE;
  throw_failure();
  if (failed) fail(name_, " cannot be started");
}

void GStreamerPipeline::throw_failure() const {
  GstBus* bus = gst_element_get_bus(pipeline_.get());
  GstMessage* message = gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR);
  gst_object_unref(bus);
  if (message == nullptr) return;
  GError* raw_error = nullptr;
  gst_message_parse_error(message, &raw_error, nullptr);
  const std::string element = GST_OBJECT_NAME(GST_MESSAGE_SRC(message));
  gst_message_unref(message);
  const std::unique_ptr<GError, ErrorFree> error(raw_error);
  fail(name_, " has failed: ", element, ": ", error->message);
}

double GStreamerPipeline::taken_at(const GstBuffer* buffer) const {
  constexpr double never = std::numeric_limits<double>::quiet_NaN();
  // A recording has its own times, which begin at 0.
  if (!live_) return GST_BUFFER_PTS_IS_VALID(buffer) ? 1e-9 * static_cast<double>(GST_BUFFER_PTS(buffer)) : never;
  const double now_s = std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  GstClock* clock = gst_element_get_clock(pipeline_.get());
  if (clock == nullptr) return now_s;
  const GstClockTime now = gst_clock_get_time(clock);
  gst_object_unref(clock);
  if (!GST_BUFFER_PTS_IS_VALID(buffer)) return now_s;
  const GstClockTime taken = gst_element_get_base_time(pipeline_.get()) + GST_BUFFER_PTS(buffer);
  return taken < now ? now_s - 1e-9 * static_cast<double>(now - taken) : now_s;
}

std::optional<PipelinePicture> GStreamerPipeline::pull() {
  for (int i = 0; i < max_slices; ++i) {
    const std::unique_ptr<GstSample, SampleUnref> sample(gst_app_sink_try_pull_sample(sink_.get(), slice));
    if (sample != nullptr)
      return PipelinePicture{copy_samples(sample.get()), taken_at(gst_sample_get_buffer(sample.get()))};
    const bool ended =
        gst_app_sink_is_eos(sink_.get()) == TRUE;  // checked before the errors, because an error is followed by an end
    throw_failure();
    if (ended) return std::nullopt;
  }
  fail(name_, " has delivered no image for ten seconds");
}

}  // namespace roadstereo::io
