#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "io/flight/frame_fields.hpp"
#include "io/json_number.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

using Json = nlohmann::ordered_json;

/// Writes fields to a document.
class Writer {
 public:
  Json take() { return std::move(document_); }

  void operator()(const char* name, double value) { document_[name] = json_number(value); }
  template <class Value>
  void operator()(const char* name, const Value& value) {
    document_[name] = written(value);
  }

 private:
  template <class Value>
  static Json written(const Value& value);

  Json document_ = Json::object();
};

/// Reads fields from a document.
class Reader {
 public:
  explicit Reader(const Json& document) : document_(document) {}

  void operator()(const char* name, double& value) {
    const Json& field = document_.at(name);
    value = field.is_null() ? std::numeric_limits<double>::quiet_NaN() : field.get<double>();
  }
  template <class Value>
  void operator()(const char* name, Value& value) {
    read(document_.at(name), value);
  }

 private:
  template <class Value>
  static void read(const Json& field, Value& value);

  const Json& document_;
};

template <class Value>
struct is_list : std::false_type {};
template <class Item>
struct is_list<std::vector<Item>> : std::true_type {};
template <class Item, std::size_t N>
struct is_list<std::array<Item, N>> : std::true_type {};

template <class Value>
struct is_optional : std::false_type {};
template <class Item>
struct is_optional<std::optional<Item>> : std::true_type {};

template <class Value>
constexpr bool is_plain = std::is_arithmetic_v<Value> || std::is_same_v<Value, std::string>;

template <class Value>
Json Writer::written(const Value& value) {
  if constexpr (std::is_enum_v<Value>) {
    return static_cast<int>(value);
  } else if constexpr (is_plain<Value>) {
    return value;
  } else if constexpr (is_optional<Value>::value) {
    return value ? written(*value) : Json(nullptr);
  } else if constexpr (is_list<Value>::value) {
    Json list = Json::array();
    for (const auto& item : value) list.push_back(written(item));
    return list;
  } else {
    Writer part;
    each_field(const_cast<Value&>(value), part);  // the visitor only reads
    return part.take();
  }
}

/// Reads an integer; a conversion of other numbers could overflow.
template <class Integer>
Integer integer_of(const Json& field) {
  const bool is_signed = field.is_number_integer() && !field.is_number_unsigned();
  const bool fits = is_signed ? std::in_range<Integer>(field.get<std::int64_t>())
                              : field.is_number_unsigned() && std::in_range<Integer>(field.get<std::uint64_t>());
  if (!fits) fail("this is not a frame record: ", field.dump(), " is not an integer in range");
  return field.get<Integer>();
}

template <class Value>
void Reader::read(const Json& field, Value& value) {
  if constexpr (std::is_enum_v<Value>) {
    value = static_cast<Value>(integer_of<int>(field));
  } else if constexpr (std::is_integral_v<Value> && !std::is_same_v<Value, bool>) {
    value = integer_of<Value>(field);
  } else if constexpr (is_plain<Value>) {
    value = field.get<Value>();
  } else if constexpr (is_optional<Value>::value) {
    value.reset();
    if (!field.is_null()) read(field, value.emplace());
  } else if constexpr (is_list<Value>::value) {
    if constexpr (requires { value.resize(field.size()); }) value.resize(field.size());
    for (std::size_t i = 0; i < value.size(); ++i) read(field.at(i), value[i]);
  } else {
    Reader part(field);
    each_field(value, part);
  }
}

}  // namespace

const char* name_of(FrameStatus status) {
  switch (status) {
    case FrameStatus::good:
      return "good";
    case FrameStatus::rejected:
      return "rejected";
    case FrameStatus::failed:
      return "failed";
  }
  return "unknown";
}

std::string valid_utf8(const std::string& text) {
  const std::string quoted = Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
  return Json::parse(quoted).get<std::string>();
}

std::string flight_frame_json(const FlightFrame& frame) {
  Writer writer;
  each_field(const_cast<FlightFrame&>(frame), writer);  // the visitor only reads
  return writer.take().dump(-1, ' ', false, Json::error_handler_t::replace);
}

FlightFrame read_flight_frame(const std::string& json) {
  try {
    const Json document = Json::parse(json);
    FlightFrame frame;
    Reader reader(document);
    each_field(frame, reader);
    return frame;
  } catch (const Json::exception& error) {
    fail("this is not a frame record: ", error.what());
  }
}

}  // namespace roadstereo::io
