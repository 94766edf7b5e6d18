#include "live/request_head.hpp"

#include <algorithm>
#include <boost/beast/http/error.hpp>

namespace roadstereo::cli {

namespace http = boost::beast::http;

std::string_view HttpRequest::path() const {
  return std::string_view(target).substr(0, target.find('?'));
}

std::string_view HttpRequest::parameter(std::string_view name) const {
  std::string_view rest(target);
  rest.remove_prefix(std::min(path().size() + 1, rest.size()));
  while (!rest.empty()) {
    const std::string_view part = rest.substr(0, rest.find('&'));
    rest.remove_prefix(std::min(part.size() + 1, rest.size()));
    const std::size_t equals = std::min(part.find('='), part.size());
    if (part.substr(0, equals) == name) return part.substr(std::min(equals + 1, part.size()));
  }
  return {};
}

RequestHead::RequestHead() {
  header_limit(max_bytes);
}

void RequestHead::on_request_impl(Verb, Text method, Text target, int, Code& error) {
  if (target.size() > max_target_bytes) {
    error = http::error::bad_target;
    return;
  }
  request_.method.assign(method.data(), method.size());
  request_.target.assign(target.data(), target.size());
}

void RequestHead::on_field_impl(Field field, Text name, Text value, Code& error) {
  if (++lines_ > max_lines || name.size() + value.size() > max_line_bytes) {
    error = http::error::header_limit;
  } else if (field == Field::host) {
    if (!request_.host.empty()) error = http::error::bad_field;  // two would be ambiguous
    request_.host.assign(value.data(), value.size());
  }
}

}  // namespace roadstereo::cli
