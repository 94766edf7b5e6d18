#include "live/http_server.hpp"

#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/v6_only.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <list>
#include <optional>
#include <thread>
#include <utility>  // missing in asio/awaitable.hpp of Boost 1.74

#include "live/clock.hpp"
#include "live/serving_threads.hpp"
#include "lower_priority.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::use_awaitable;
using asio::ip::tcp;
using Response = http::response<http::string_body>;
using Timer = asio::steady_timer;

constexpr int kernel_buffer_bytes = 16384;  // received and not yet read, per connection
constexpr double retry_pause_s = 0.01;      // after a failure for lack of memory or descriptors
constexpr double max_answer_s = 30;         // longer than any answer takes

/// Streams that wait for a head, oldest first.
using Waiting = std::list<beast::tcp_stream*>;

/// Entry of a stream in the list, as long as this lives.
class WaitingEntry {
 public:
  WaitingEntry(Waiting& list, beast::tcp_stream& stream) : list_(list), at_(list.insert(list.end(), &stream)) {
    if (list.size() > HttpServer::max_waiting) list.front()->close();  // its coroutine then ends
  }
  ~WaitingEntry() { list_.erase(at_); }
  WaitingEntry(const WaitingEntry&) = delete;
  WaitingEntry& operator=(const WaitingEntry&) = delete;

 private:
  Waiting& list_;
  Waiting::iterator at_;
};

/// Counts a request that is answered, as long as this lives.
class Serving {
 public:
  explicit Serving(std::size_t& count) : count_(++count) {}
  ~Serving() { --count_; }
  Serving(const Serving&) = delete;
  Serving& operator=(const Serving&) = delete;

 private:
  std::size_t& count_;
};

http::status status_of_error(const beast::error_code& error) {
  const bool too_long = error == http::error::header_limit || error == http::error::buffer_overflow;
  return too_long ? http::status::request_header_fields_too_large : http::status::bad_request;
}

Response response_of(HttpAnswer answer, bool keep) {
  constexpr unsigned http_1_1 = 11;
  Response response(http::int_to_status(static_cast<unsigned>(answer.status)), http_1_1);
  for (const auto& [name, value] : answer.headers) response.set(name, value);
  if (!answer.type.empty()) response.set(http::field::content_type, answer.type);
  response.body() = std::move(answer.body);
  response.keep_alive(keep);
  response.prepare_payload();
  return response;
}

/// Writes the last answer of a connection. Then reads what the client has still sent, up to a limit: closing with
/// unread bytes would take the answer back.
asio::awaitable<void> write_last(beast::tcp_stream& stream, const Response& response) {
  co_await http::async_write(stream, response, use_awaitable);
  stream.socket().shutdown(tcp::socket::shutdown_send);
  std::array<char, 1024> ignored{};
  for (std::size_t read = 0; read < RequestHead::max_bytes;) {
    read += co_await stream.async_read_some(asio::buffer(ignored), use_awaitable);  // throws at the end
  }
}

}  // namespace

struct HttpServer::State {
  State(Admit may_enter, Answer make) : admit(std::move(may_enter)), answer(std::move(make)) {}
  ~State();

  Admit admit;
  Answer answer;
  Waiting waiting;  // outlives the coroutines, which `io` owns
  std::size_t serving = 0;
  bool accepting = false;
  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  ServingThreads threads{max_serving};
  std::thread thread;

  void listen(const ServeAddress& address);
  void run();
  asio::awaitable<void> accept();
  asio::awaitable<void> serve(tcp::socket socket);
  asio::awaitable<bool> serve_next(beast::tcp_stream& stream, beast::flat_buffer& buffer);
  asio::awaitable<HttpAnswer> answer_on_thread(const HttpRequest& request);
};

HttpServer::State::~State() {
  io.stop();
  if (thread.joinable()) thread.join();
  threads.shutdown();  // before the coroutines that wait for them
}

void HttpServer::State::listen(const ServeAddress& address) {
  beast::error_code error;
  tcp::resolver resolver(io);
  const auto found = resolver.resolve(address.host, std::to_string(address.port), tcp::resolver::passive, error);
  if (!error) error = asio::error::host_not_found;
  for (const tcp::endpoint endpoint : found) {
    if (acceptor.is_open()) acceptor.close();
    acceptor.open(endpoint.protocol(), error);
    if (error) continue;
    // A port in TIME_WAIT is no error, but one in use is: SO_REUSEADDR without SO_REUSEPORT.
    acceptor.set_option(tcp::acceptor::reuse_address(true));
    if (endpoint.protocol() == tcp::v6()) acceptor.set_option(asio::ip::v6_only(false));
    acceptor.set_option(asio::socket_base::receive_buffer_size(kernel_buffer_bytes));
    acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
    if (!error) break;
  }
  if (!error) return;
  fail("cannot listen on ", url_host(address.host), ":", address.port, ": ", error.message(),
       "; the port may be in use or not allowed, or the address not local; port 0 selects a free port");
}

/// Runs the handlers, again after one has thrown for lack of memory.
void HttpServer::State::run() {
  lower_priority();
  while (!io.stopped()) {
    try {
      if (!accepting) {
        asio::co_spawn(io, accept(), [this](const std::exception_ptr& error) {
          accepting = false;
          if (error) std::rethrow_exception(error);
        });
        accepting = true;
      }
      io.run();
    } catch (const std::exception&) {
      std::this_thread::sleep_for(clock_span(retry_pause_s));
    }
  }
}

asio::awaitable<void> HttpServer::State::accept() {
  Timer pause(io);
  while (true) {
    beast::error_code error;
    tcp::socket socket = co_await acceptor.async_accept(asio::redirect_error(use_awaitable, error));
    if (error) {  // e.g. no descriptors are left
      if (!waiting.empty()) waiting.front()->close();
      pause.expires_after(clock_span(retry_pause_s));
      co_await pause.async_wait(use_awaitable);
      continue;
    }
    try {
      asio::co_spawn(io, serve(std::move(socket)), asio::detached);
    } catch (const std::exception&) {  // no memory for this connection
    }
  }
}

asio::awaitable<void> HttpServer::State::serve(tcp::socket socket) {
  try {
    socket.set_option(tcp::no_delay(true));
    beast::tcp_stream stream(std::move(socket));
    beast::flat_buffer buffer(RequestHead::max_bytes);
    while (co_await serve_next(stream, buffer)) {
    }
  } catch (const std::exception&) {  // the connection is closed
  }
}

/// Reads and answers one request. Returns whether the connection stays open.
asio::awaitable<bool> HttpServer::State::serve_next(beast::tcp_stream& stream, beast::flat_buffer& buffer) {
  RequestHead head;
  {
    const WaitingEntry entry(waiting, stream);
    stream.expires_after(clock_span(head_timeout_s));  // until another is set, whatever the number of reads
    beast::error_code error;
    co_await http::async_read_header(stream, buffer, head, asio::redirect_error(use_awaitable, error));
    if (error == http::error::end_of_stream || error == beast::error::timeout) co_return false;
    std::optional<http::status> refused;
    if (error) {
      refused = status_of_error(error);
    } else if (!admit(head.request())) {
      refused = http::status::forbidden;
    } else if (serving >= max_serving) {
      refused = http::status::service_unavailable;
    }
    if (refused) {
      // A value of its own: GCC 12 destroys temporaries of a co_await expression twice.
      HttpAnswer refusal;
      refusal.status = static_cast<int>(*refused);
      const Response response = response_of(std::move(refusal), false);
      co_await write_last(stream, response);
      co_return false;
    }
  }
  const bool keep = head.keep_alive() && head.is_done();  // a body is not read
  HttpAnswer made = co_await answer_on_thread(head.request());
  const Response response = response_of(std::move(made), keep);
  stream.expires_after(clock_span(answer_timeout_s));
  if (keep) {
    co_await http::async_write(stream, response, use_awaitable);
  } else {
    co_await write_last(stream, response);
  }
  co_return keep;
}

asio::awaitable<HttpAnswer> HttpServer::State::answer_on_thread(const HttpRequest& request) {
  struct Job {
    HttpRequest request;
    HttpAnswer answer;
    Timer done;
  };
  const auto job = std::make_shared<Job>(Job{request, {500, "", "", {}}, Timer(io, clock_span(max_answer_s))});
  const Serving entry(serving);
  threads.enqueue([this, job] {
    try {
      job->answer = answer(job->request);
    } catch (const std::exception&) {  // stays status 500
    }
    asio::post(io, [job] { job->done.cancel(); });
  });
  beast::error_code cancelled;
  co_await job->done.async_wait(asio::redirect_error(use_awaitable, cancelled));
  co_return cancelled ? std::move(job->answer) : HttpAnswer{500, "", "", {}};
}

HttpServer::HttpServer(const ServeAddress& address, Admit admit, Answer answer)
    : state_(std::make_unique<State>(std::move(admit), std::move(answer))) {
  state_->listen(address);
  state_->thread = std::thread([state = state_.get()] { state->run(); });
}

HttpServer::~HttpServer() = default;

int HttpServer::port() const {
  return state_->acceptor.local_endpoint().port();
}

}  // namespace roadstereo::cli
