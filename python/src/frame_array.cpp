#include "frame_array.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "roadstereo/error.hpp"
#include "type_name.hpp"

namespace roadstereo::python {
namespace {

namespace py = pybind11;

std::ptrdiff_t size_of(SampleType sample) {
  return sample == SampleType::u16 ? 2 : 1;
}

SampleType sample_type(const py::array& array, const std::string& name) {
  const py::dtype type = array.dtype();
  const bool native = type.attr("isnative").cast<bool>();
  if (type.kind() != 'u' || type.itemsize() > 2 || !native) {
    throw py::type_error(name + " has samples of type " + py::str(py::handle(type)).cast<std::string>() +
                         (native ? "" : " (swapped bytes)") + "; they must be uint8 or uint16");
  }
  return type.itemsize() == 2 ? SampleType::u16 : SampleType::u8;
}

/// 1, 3 or 4.
int channels_of(const py::array& array, const std::string& name) {
  const py::ssize_t channels = array.ndim() == 3 ? array.shape(2) : 1;
  if (array.ndim() < 2 || array.ndim() > 3 || (channels != 1 && channels != 3 && channels != 4)) {
    fail(name, " has the shape ", py::str(array.attr("shape")).cast<std::string>(),
         "; it must be (height, width), or (height, width, 3 or 4) in colour");
  }
  return static_cast<int>(channels);
}

ChannelOrder channel_order(int channels, bool blue_first) {
  if (channels == 3) return blue_first ? ChannelOrder::bgr : ChannelOrder::rgb;
  if (channels == 4) return blue_first ? ChannelOrder::bgra : ChannelOrder::rgba;
  return ChannelOrder::grey;
}

bool begins_with_blue(const std::string& order) {
  if (order != "bgr" && order != "rgb") fail("order is '", order, "'; it must be 'bgr' or 'rgb'");
  return order == "bgr";
}

/// Sizes beyond an int are beyond every image, too.
int pixels(py::ssize_t size) {
  return static_cast<int>(std::min<py::ssize_t>(size, std::numeric_limits<int>::max()));
}

py::array as_array(const py::object& object, const std::string& name) {
  if (!py::isinstance<py::array>(object)) {
    throw py::type_error(name + " is of type " + type_name(object) + "; it must be a numpy array of uint8 or uint16");
  }
  return py::reinterpret_borrow<py::array>(object);
}

/// Exchanges blue and red.
template <class Sample>
void swap_channels(std::vector<std::uint8_t>& bytes) {
  auto* samples = reinterpret_cast<Sample*>(bytes.data());
  for (std::size_t i = 0; i + 3 < bytes.size() / sizeof(Sample); i += 4) std::swap(samples[i], samples[i + 2]);
}

void order_rgba_as_bgra(Frame& frame) {
  if (frame.order != ChannelOrder::rgba) return;
  frame.sample == SampleType::u16 ? swap_channels<std::uint16_t>(frame.bytes)
                                  : swap_channels<std::uint8_t>(frame.bytes);
  frame.order = ChannelOrder::bgra;
}

}  // namespace

FrameView frame_view(const py::object& object, const std::string& name, const std::string& order) {
  const py::array array = as_array(object, name);
  const SampleType sample = sample_type(array, name);
  const int channels = channels_of(array, name);
  const std::ptrdiff_t sample_bytes = size_of(sample);
  const std::ptrdiff_t channel_step = channels > 1 ? array.strides(2) : sample_bytes;
  const bool reversed = channels == 3 && channel_step == -sample_bytes;
  if (array.strides(1) != channels * sample_bytes || (channel_step != sample_bytes && !reversed)) {
    fail(name, " has the strides ", py::str(array.attr("strides")).cast<std::string>(),
         " bytes; the pixels of a row must be adjacent (numpy.ascontiguousarray copies them so)");
  }
  const auto* data = static_cast<const std::uint8_t*>(array.data());
  return {reversed ? data - 2 * sample_bytes : data,
          pixels(array.shape(1)),
          pixels(array.shape(0)),
          array.strides(0),
          sample,
          channel_order(channels, begins_with_blue(order) != reversed)};
}

Frame copy_frame(const py::object& object, const std::string& name, const std::string& order) {
  const py::object adjacent = py::module_::import("numpy").attr("ascontiguousarray")(as_array(object, name));
  const FrameView view = frame_view(adjacent, name, order);
  Frame frame{{}, view.width, view.height, view.sample, view.order};
  const auto* data = static_cast<const std::uint8_t*>(view.data);
  frame.bytes.assign(data, data + view.height * view.stride_bytes);
  return frame;
}

py::array frame_array(Frame frame) {
  order_rgba_as_bgra(frame);
  auto owned = std::make_unique<Frame>(std::move(frame));
  const FrameView view = owned->view();
  const std::ptrdiff_t bytes = size_of(view.sample);
  const int channels = channel_count(view.order);
  std::uint8_t* first = owned->bytes.data();
  const bool reversed = view.order == ChannelOrder::rgb;
  std::vector<py::ssize_t> shape{view.height, view.width};
  std::vector<py::ssize_t> strides{view.stride_bytes, channels * bytes};
  if (channels > 1) {
    shape.push_back(channels);
    strides.push_back(reversed ? -bytes : bytes);
  }
  const py::capsule owner(owned.get(), [](void* taken) { delete static_cast<Frame*>(taken); });
  static_cast<void>(owned.release());
  const auto type = view.sample == SampleType::u16 ? py::dtype::of<std::uint16_t>() : py::dtype::of<std::uint8_t>();
  return py::array(type, std::move(shape), std::move(strides), first + (reversed ? 2 * bytes : 0), owner);
}

}  // namespace roadstereo::python
