#include "live/live_server.hpp"

#include <httplib.h>
#include <sys/socket.h>

#include <atomic>
#include <charconv>
#include <cmath>
#include <optional>
#include <thread>

#include "json_text.hpp"
#include "live/access.hpp"
#include "live/page/page_files.hpp"
#include "live/serving_threads.hpp"
#include "live/status_json.hpp"
#include "live/view_pictures.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

using httplib::Request;
using httplib::Response;

constexpr std::size_t max_connections = 48;  // served at the same time
constexpr int timeout_s = 2;                 // of idle clients
constexpr double max_poll_s = 1;
constexpr double shutdown_grace_s = 0.5;  // lets pages fetch the final state

/// A port in use is an error, but not one in TIME_WAIT.
void share_no_port(socket_t socket) {
  const int yes = 1;
  (void)setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
}

httplib::Headers safe_headers() {
  return {{"Content-Security-Policy",
           "default-src 'self'; img-src 'self' data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
          {"Cache-Control", "no-store"},
          {"X-Content-Type-Options", "nosniff"},
          {"Referrer-Policy", "no-referrer"},
          {"Cross-Origin-Resource-Policy", "same-origin"}};
}

/// Returns a query parameter as integer of at least 0; 0 if it is missing; nullopt if it is invalid.
std::optional<std::int64_t> number_of(const Request& request, const char* name) {
  const std::string text = request.get_param_value(name);
  if (text.empty()) return 0;
  std::int64_t number = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size() || number < 0) return std::nullopt;
  return number;
}

void replace_all(std::string& text, const std::string& mark, const std::string& with) {
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + with.size())) {
    text.replace(at, mark.size(), with);
  }
}

}  // namespace

struct LiveServer::State {
  State(const ServeAddress& where, LiveBoard& shown)
      : address(where), board(shown), token(where.loopback() ? "" : random_token()) {}

  ServeAddress address;
  LiveBoard& board;
  std::string token;
  std::string session = random_token();  // lets the page recognise another run
  httplib::Server server;
  ViewPictures pictures;
  std::string ramp = scale_ramp_png();
  std::thread thread;
  std::atomic<bool> ended = false;
  std::atomic<double> last_poll_s = -HUGE_VAL;  // since `start`
  const Clock::time_point start = Clock::now();

  bool admitted(const Request& request) const;
  httplib::Server::HandlerResponse check(const Request& request, Response& response) const;
  std::string query() const { return token.empty() ? "" : "?token=" + token; }
  void send_file(const std::string& path, std::string_view content, const char* type);
  void send_state(const Request& request, Response& response);
  void send_picture(const Request& request, Response& response,
                    ViewPictures::Shared (ViewPictures::*make)(const SharedView&));
  void route();
  void listen();
};

bool LiveServer::State::admitted(const Request& request) const {
  if (token.empty()) return names_this_machine(request.get_header_value("Host"));
  return equal_in_constant_time(request.get_param_value("token"), token);
}

httplib::Server::HandlerResponse LiveServer::State::check(const Request& request, Response& response) const {
  using httplib::Server;
  response.status = 403;
  if (!admitted(request)) return Server::HandlerResponse::Handled;
  response.status = 405;
  if (request.method != "GET") return Server::HandlerResponse::Handled;
  response.status = -1;
  return Server::HandlerResponse::Unhandled;
}

void LiveServer::State::send_file(const std::string& path, std::string_view content, const char* type) {
  std::string text(content);
  replace_all(text, "{{query}}", query());
  server.Get(path, [text, type](const Request&, Response& response) { response.set_content(text, type); });
}

void LiveServer::State::send_state(const Request& request, Response& response) {
  const std::optional<std::int64_t> after = number_of(request, "after");
  if (!after) {
    response.status = 400;
    return;
  }
  last_poll_s = seconds_between(start, Clock::now());
  nlohmann::ordered_json json = status_json(board.wait_for_news(*after, max_poll_s), board.max_age_s());
  json["session"] = session;
  response.set_content(json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace), "application/json");
}

void LiveServer::State::send_picture(const Request& request, Response& response,
                                     ViewPictures::Shared (ViewPictures::*make)(const SharedView&)) {
  const std::optional<std::int64_t> number = number_of(request, "frame");
  const SharedView view = number ? board.view(*number) : nullptr;
  if (!view) {
    response.status = number ? 404 : 400;
    return;
  }
  response.set_header("Frame", std::to_string(view->number));
  const ViewPictures::Shared picture = (pictures.*make)(view);
  response.set_header("Colour-Range", std::to_string(picture->half_range_px));
  response.set_content(picture->jpeg, "image/jpeg");
}

void LiveServer::State::route() {
  server.set_pre_routing_handler(
      [this](const Request& request, Response& response) { return check(request, response); });
  server.set_exception_handler([](const Request&, Response& response, const auto&) { response.status = 500; });
  send_file("/", page_files::page, "text/html; charset=utf-8");
  send_file("/style.css", page_files::style, "text/css; charset=utf-8");
  send_file("/script.js", page_files::script, "text/javascript; charset=utf-8");
  send_file("/ramp.png", ramp, "image/png");
  server.Get("/state", [this](const Request& request, Response& response) { send_state(request, response); });
  server.Get("/left\\.jpg", [this](const Request& request, Response& response) {
    send_picture(request, response, &ViewPictures::left);
  });
  server.Get("/transformed\\.jpg", [this](const Request& request, Response& response) {
    send_picture(request, response, &ViewPictures::transformed);
  });
}

void LiveServer::State::listen() {
  server.new_task_queue = [] { return new ServingThreads(max_connections); };
  server.set_socket_options(share_no_port);
  server.set_tcp_nodelay(true);
  server.set_default_headers(safe_headers());
  server.set_keep_alive_timeout(1);
  server.set_keep_alive_max_count(100000);
  server.set_read_timeout(timeout_s);
  server.set_write_timeout(timeout_s);
  server.set_payload_max_length(1024);
  const int bound = address.port == 0 ? server.bind_to_any_port(address.host)
                                      : (server.bind_to_port(address.host, address.port) ? address.port : -1);
  if (bound < 0) {
    fail("cannot listen on ", url_host(address.host), ":", address.port,
         ": the port is in use or not allowed, or the address is not local; port 0 selects a free port");
  }
  address.port = bound;
  thread = std::thread([this] {
    server.listen_after_bind();
    ended = true;
  });
}

LiveServer::LiveServer(const ServeAddress& address, LiveBoard& board)
    : state_(std::make_unique<State>(address, board)) {
  state_->route();
  state_->listen();
}

LiveServer::~LiveServer() {
  const bool watched = seconds_between(state_->start, Clock::now()) - state_->last_poll_s < 2 * max_poll_s;
  if (watched) std::this_thread::sleep_for(clock_span(shutdown_grace_s));
  while (!state_->server.is_running() && !state_->ended)
    std::this_thread::yield();  // a stop before the start has no effect
  state_->server.stop();
  state_->thread.join();
}

std::string LiveServer::url() const {
  const std::string& host = state_->address.host;
  const bool everywhere = host == "0.0.0.0" || host == "::";
  return "http://" + url_host(everywhere ? outside_address() : host) + ":" + std::to_string(port()) + "/" +
         state_->query();
}

int LiveServer::port() const {
  return state_->address.port;
}

const std::string& LiveServer::token() const {
  return state_->token;
}

}  // namespace roadstereo::cli
