#pragma once

#include <boost/beast/http/basic_parser.hpp>
#include <cstddef>
#include <string>
#include <string_view>

namespace roadstereo::cli {

/// What the live page needs to know of a request.
struct HttpRequest {
  std::string method;
  std::string target;  ///< path and query
  std::string host;    ///< Host header

  std::string_view path() const;

  /// Returns the first query parameter of that name, not decoded; empty if it is missing.
  std::string_view parameter(std::string_view name) const;
};

/// Incremental parser of the head of an HTTP request. Stores nothing but HttpRequest; fails if the request line, a
/// header line, their number or the whole head exceed the limits.
class RequestHead final : public boost::beast::http::basic_parser<true> {
 public:
  static constexpr std::size_t max_bytes = 16384;
  static constexpr std::size_t max_target_bytes = 1024;
  static constexpr std::size_t max_line_bytes = 8192;
  static constexpr int max_lines = 100;

  RequestHead();

  const HttpRequest& request() const { return request_; }

 private:
  using Code = boost::beast::error_code;
  using Text = boost::beast::string_view;
  using Verb = boost::beast::http::verb;
  using Field = boost::beast::http::field;
  using Length = boost::optional<std::uint64_t>;

  void on_request_impl(Verb verb, Text method, Text target, int version, Code& error) override;
  void on_field_impl(Field field, Text name, Text value, Code& error) override;
  void on_response_impl(int, Text, int, Code&) override {}
  void on_header_impl(Code&) override {}
  void on_body_init_impl(const Length&, Code&) override {}
  std::size_t on_body_impl(Text body, Code&) override { return body.size(); }
  void on_chunk_header_impl(std::uint64_t, Text, Code&) override {}
  std::size_t on_chunk_body_impl(std::uint64_t, Text body, Code&) override { return body.size(); }
  void on_finish_impl(Code&) override {}

  HttpRequest request_;
  int lines_ = 0;
};

}  // namespace roadstereo::cli
