// Head of a request to the live page, in pieces as a connection delivers it.
#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/beast/http/error.hpp>
#include <cstdint>

#include "live/request_head.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::size_t piece = 1 + data[0];
  roadstereo::cli::RequestHead head;
  boost::beast::error_code error;
  std::size_t taken = 1;
  for (std::size_t end = 1; end < size && !error && !head.is_header_done();) {
    end = std::min(size, end + piece);
    taken += head.put(boost::asio::const_buffer(data + taken, end - taken), error);
    if (error == boost::beast::http::error::need_more) error = {};
  }
  const roadstereo::cli::HttpRequest& request = head.request();
  if (request.target.size() > roadstereo::cli::RequestHead::max_target_bytes) __builtin_trap();
  if (request.host.size() > roadstereo::cli::RequestHead::max_line_bytes) __builtin_trap();
  for (const char* name : {"token", "after", "frame"}) (void)request.parameter(name);
  return 0;
}
