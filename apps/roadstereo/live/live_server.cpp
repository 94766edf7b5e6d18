#include "live/live_server.hpp"

#include <atomic>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "json_text.hpp"
#include "live/access.hpp"
#include "live/http_server.hpp"
#include "live/page/page_files.hpp"
#include "live/status_json.hpp"
#include "live/view_pictures.hpp"

namespace roadstereo::cli {
namespace {

constexpr double max_poll_s = 1;
constexpr double shutdown_grace_s = 0.5;  // lets pages fetch the final state

const std::vector<std::pair<std::string, std::string>> safe_headers = {
    {"Content-Security-Policy",
     "default-src 'self'; img-src 'self' data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
    {"Cache-Control", "no-store"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"}};

/// Returns a query parameter as integer of at least 0; 0 if it is missing; nullopt if it is invalid.
std::optional<std::int64_t> number_of(const HttpRequest& request, const char* name) {
  const std::string_view text = request.parameter(name);
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
      : host(where.host),
        board(shown),
        token(where.loopback() ? "" : random_token()),
        files{{"/", {"text/html; charset=utf-8", with_query(page_files::page)}},
              {"/style.css", {"text/css; charset=utf-8", with_query(page_files::style)}},
              {"/script.js", {"text/javascript; charset=utf-8", with_query(page_files::script)}},
              {"/ramp.png", {"image/png", scale_ramp_png()}}},
        server(
            where, [this](const HttpRequest& request) { return admitted(request); },
            [this](const HttpRequest& request) { return answer(request); }) {}

  struct File {
    std::string type;
    std::string content;
  };

  std::string host;
  LiveBoard& board;
  std::string token;
  std::string session = random_token();  // lets the page recognise another run
  ViewPictures pictures;
  std::map<std::string, File, std::less<>> files;
  const Clock::time_point start = Clock::now();
  std::atomic<double> last_poll_s = -HUGE_VAL;  // since `start`
  HttpServer server;                            // last: its threads use the others

  std::string query() const { return token.empty() ? "" : "?token=" + token; }
  std::string with_query(std::string_view text) const;
  bool admitted(const HttpRequest& request) const;
  HttpAnswer answer(const HttpRequest& request);
  HttpAnswer content(const HttpRequest& request);
  HttpAnswer state(const HttpRequest& request);
  HttpAnswer picture(const HttpRequest& request, ViewPictures::Shared (ViewPictures::*make)(const SharedView&));
};

std::string LiveServer::State::with_query(std::string_view text) const {
  std::string whole(text);
  replace_all(whole, "{{query}}", query());
  return whole;
}

bool LiveServer::State::admitted(const HttpRequest& request) const {
  if (token.empty()) return names_this_machine(request.host);
  return equal_in_constant_time(request.parameter("token"), token);
}

HttpAnswer LiveServer::State::answer(const HttpRequest& request) {
  HttpAnswer answer = content(request);
  answer.headers.insert(answer.headers.end(), safe_headers.begin(), safe_headers.end());
  return answer;
}

HttpAnswer LiveServer::State::content(const HttpRequest& request) {
  if (request.method != "GET") return {405, "", "", {}};
  const std::string_view path = request.path();
  if (path == "/state") return state(request);
  if (path == "/left.jpg") return picture(request, &ViewPictures::left);
  if (path == "/transformed.jpg") return picture(request, &ViewPictures::transformed);
  const auto file = files.find(path);
  if (file == files.end()) return {404, "", "", {}};
  return {200, file->second.type, file->second.content, {}};
}

HttpAnswer LiveServer::State::state(const HttpRequest& request) {
  const std::optional<std::int64_t> after = number_of(request, "after");
  if (!after) return {400, "", "", {}};
  last_poll_s = seconds_between(start, Clock::now());
  nlohmann::ordered_json json = status_json(board.wait_for_news(*after, max_poll_s), board.max_age_s());
  json["session"] = session;
  return {200, "application/json", json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace), {}};
}

HttpAnswer LiveServer::State::picture(const HttpRequest& request,
                                      ViewPictures::Shared (ViewPictures::*make)(const SharedView&)) {
  const std::optional<std::int64_t> number = number_of(request, "frame");
  const SharedView view = number ? board.view(*number) : nullptr;
  if (!view) return {number ? 404 : 400, "", "", {}};
  const ViewPictures::Shared picture = (pictures.*make)(view);
  return {200,
          "image/jpeg",
          picture->jpeg,
          {{"Frame", std::to_string(view->number)}, {"Colour-Range", std::to_string(picture->half_range_px)}}};
}

LiveServer::LiveServer(const ServeAddress& address, LiveBoard& board)
    : state_(std::make_unique<State>(address, board)) {}

LiveServer::~LiveServer() {
  const bool watched = seconds_between(state_->start, Clock::now()) - state_->last_poll_s < 2 * max_poll_s;
  if (watched) std::this_thread::sleep_for(clock_span(shutdown_grace_s));
}

std::string LiveServer::url() const {
  const std::string& host = state_->host;
  const bool everywhere = host == "0.0.0.0" || host == "::";
  return "http://" + url_host(everywhere ? outside_address() : host) + ":" + std::to_string(port()) + "/" +
         state_->query();
}

int LiveServer::port() const {
  return state_->server.port();
}

const std::string& LiveServer::token() const {
  return state_->token;
}

}  // namespace roadstereo::cli
