#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "live/request_head.hpp"
#include "live/serve_address.hpp"

namespace roadstereo::cli {

struct HttpAnswer {
  int status = 200;
  std::string type;  ///< Content-Type; empty without a body
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers;
};

/// HTTP server for few clients among many strangers. One thread reads the heads of requests, bounded in bytes and time
/// before anything is stored; only admitted requests reach a thread of their own. Of the connections that wait for a
/// head, the oldest is closed when there are too many, so that strangers cannot keep a client out.
class HttpServer {
 public:
  using Admit = std::function<bool(const HttpRequest&)>;
  using Answer = std::function<HttpAnswer(const HttpRequest&)>;

  static constexpr std::size_t max_waiting = 256;  ///< connections without an admitted request
  static constexpr std::size_t max_serving = 48;   ///< admitted requests at the same time; status 503 above
  static constexpr double head_timeout_s = 2;      ///< for the whole head
  static constexpr double answer_timeout_s = 10;   ///< for the client to read an answer

  /// Listens at an address. `admit` must return at once; requests that it rejects are answered with status 403.
  /// `answer` may block; it is called by several threads. An exception of either is status 500. Throws Error naming the
  /// address if it cannot be listened on.
  HttpServer(const ServeAddress& address, Admit admit, Answer answer);

  /// Closes all connections; waits for running answers.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  int port() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roadstereo::cli
