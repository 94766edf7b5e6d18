// The HTTP server against those who do not behave: bytes, time, connections and exceptions.
#include <gtest/gtest.h>
#include <httplib.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <memory>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include "live/http_server.hpp"

namespace roadstereo::cli {
namespace {

using namespace std::chrono_literals;

/// A connection that sends what it is told to.
class RawClient {
 public:
  explicit RawClient(int port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
  }
  ~RawClient() { ::close(socket_); }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  bool connected() const { return connected_; }

  /// Returns the bytes that the system took within that time.
  std::size_t send(const std::string& text, int wait_ms = 0) const {
    std::size_t sent = 0;
    while (sent < text.size()) {
      pollfd writable{socket_, POLLOUT, 0};
      if (::poll(&writable, 1, wait_ms) != 1 || (writable.revents & POLLERR) != 0) break;
      const ssize_t part = ::send(socket_, text.data() + sent, text.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
      if (part <= 0) break;
      sent += static_cast<std::size_t>(part);
    }
    return sent;
  }

  /// Whether the server has closed the connection within that time; reads what it has sent before.
  bool closed(int wait_ms, std::string* received = nullptr) const {
    std::array<char, 4096> bytes{};
    while (true) {
      pollfd readable{socket_, POLLIN, 0};
      if (::poll(&readable, 1, wait_ms) != 1) return false;
      const ssize_t part = ::recv(socket_, bytes.data(), bytes.size(), 0);
      if (part <= 0) return true;
      if (received != nullptr) received->append(bytes.data(), static_cast<std::size_t>(part));
    }
  }

 private:
  int socket_;
  bool connected_ = false;
};

std::size_t resident_bytes() {
  std::size_t pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

HttpAnswer body(const std::string& text) {
  return {200, "text/plain", text, {}};
}

/// A server that admits "/in" only.
struct Bench {
  HttpServer server{{"0.0.0.0", 0},
                    [](const HttpRequest& request) { return request.path() == "/in"; },
                    [](const HttpRequest& request) {
                      if (request.parameter("throw") == "1") throw std::bad_alloc();
                      return body(std::string(request.parameter("text")));
                    }};

  int status(const std::string& head) const {
    const RawClient client(server.port());
    client.send(head, 1000);
    std::string answer;
    EXPECT_TRUE(client.closed(5000, &answer));
    return answer.size() < 12 ? 0 : std::stoi(answer.substr(9, 3));
  }
};

TEST(HttpRequest, ParsesPathAndParameters) {
  const HttpRequest request{"GET", "/in?a=1&bb=2=3&c&a=4", ""};
  EXPECT_EQ(request.path(), "/in");
  EXPECT_EQ(request.parameter("a"), "1");
  EXPECT_EQ(request.parameter("bb"), "2=3");
  for (const char* missing : {"c", "b", "", "in"}) EXPECT_EQ(request.parameter(missing), "") << missing;
  EXPECT_EQ((HttpRequest{"GET", "/in", ""}.parameter("a")), "");
}

TEST(HttpServer, BoundsHead) {
  const Bench bench;
  const std::string close = "Connection: close\r\n\r\n";
  EXPECT_EQ(bench.status("GET /in HTTP/1.1\r\n" + close), 200);
  EXPECT_EQ(bench.status("GET /in?text=" + std::string(1000, 'x') + " HTTP/1.1\r\n" + close), 200);
  EXPECT_EQ(bench.status("GET /in?text=" + std::string(1100, 'x') + " HTTP/1.1\r\n" + close), 400);
  EXPECT_EQ(bench.status("GET /in HTTP/1.1\r\nA: " + std::string(8000, 'x') + "\r\n" + close), 200);
  EXPECT_EQ(bench.status("GET /in HTTP/1.1\r\nA: " + std::string(8300, 'x') + "\r\n" + close), 431);
  std::string lines = "GET /in HTTP/1.1\r\n";
  for (int i = 0; i < 99; ++i) lines += "A: b\r\n";
  EXPECT_EQ(bench.status(lines + close), 200);
  EXPECT_EQ(bench.status(lines + "A: b\r\n" + close), 431);
  EXPECT_EQ(bench.status("GET /in HTTP/1.1\r\nHost: a\r\nHost: b\r\n" + close), 400);
  EXPECT_EQ(bench.status("GET /out HTTP/1.1\r\n" + close), 403);
  EXPECT_EQ(bench.status("hello\r\n\r\n"), 400);
}

TEST(HttpServer, EndlessHeadIsCutOff) {
  const Bench bench;
  std::string lines = "GET /in HTTP/1.1\r\n";
  while (lines.size() < (32U << 20U)) lines += "A: b\r\n";
  for (const std::string& text : {lines, "GET /" + std::string(32U << 20U, 'x'), std::string(32U << 20U, '\n')}) {
    const RawClient client(bench.server.port());
    const auto start = std::chrono::steady_clock::now();
    EXPECT_LT(client.send(text, 500), 8U << 20U) << "what the buffers of two sockets hold";
    EXPECT_TRUE(client.closed(2500));
    EXPECT_LT(std::chrono::steady_clock::now() - start, 3500ms);
  }
}

TEST(HttpServer, StrangersTakeLessThan64KBytes) {
  const Bench bench;
  EXPECT_EQ(bench.status("GET /in HTTP/1.1\r\nConnection: close\r\n\r\n"), 200);
  const std::string unfinished =
      "GET /in HTTP/1.1\r\nA: " + std::string(8000, 'x') + "\r\nB: " + std::string(8000, 'x');
  constexpr std::size_t count = 200;
  std::vector<std::unique_ptr<RawClient>> clients;
  const std::size_t before = resident_bytes();
  for (std::size_t i = 0; i < count; ++i) {
    clients.push_back(std::make_unique<RawClient>(bench.server.port()));
    EXPECT_EQ(clients.back()->send(unfinished, 1000), unfinished.size());
  }
  std::this_thread::sleep_for(500ms);
  const std::size_t after = resident_bytes();
  const std::size_t each = (std::max(before, after) - before) / count;
  RecordProperty("bytes_each", static_cast<int>(each));
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  EXPECT_LT(each, 131072U);  // with what the sanitizers keep of every allocation
#else
  EXPECT_LT(each, 65536U);
#endif
  for (const auto& client : clients) EXPECT_TRUE(client->closed(2500));
}

TEST(HttpServer, TrickledHeadEndsInTwoSeconds) {
  const Bench bench;
  const RawClient client(bench.server.port());
  const auto start = std::chrono::steady_clock::now();
  bool closed = false;
  for (int i = 0; i < 60 && !closed; ++i) {
    client.send("G");
    closed = client.closed(100);
  }
  EXPECT_TRUE(closed);
  EXPECT_LT(std::chrono::steady_clock::now() - start, 2500ms);
}

/// Asks as often as a page does; returns the longest wait.
double longest_wait_s(int port, int requests) {
  double longest = 0;
  for (int i = 0; i < requests; ++i) {
    const auto start = std::chrono::steady_clock::now();
    httplib::Client viewer("127.0.0.1", port);
    const auto answer = viewer.Get("/in?text=yes");
    EXPECT_TRUE(answer && answer->status == 200 && answer->body == "yes");
    longest = std::max(longest, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    std::this_thread::sleep_for(50ms);
  }
  return longest;
}

TEST(HttpServer, ViewerIsServedAmongStrangersThreadsSlow) {
  const Bench bench;
  std::vector<std::unique_ptr<RawClient>> strangers;
  for (int i = 0; i < 500; ++i) strangers.push_back(std::make_unique<RawClient>(bench.server.port()));
  EXPECT_LT(longest_wait_s(bench.server.port(), 5), 1) << "500 that hold connections";
  std::jthread trickle([&strangers, port = bench.server.port()](const std::stop_token& stop) {
    for (std::size_t i = 0; !stop.stop_requested(); i = (i + 1) % strangers.size()) {  // each byte renews those closed
      if (strangers[i]->send("G") == 0 || strangers[i]->closed(0)) strangers[i] = std::make_unique<RawClient>(port);
      std::this_thread::sleep_for(1ms);
    }
  });
  const double longest = longest_wait_s(bench.server.port(), 60);
  RecordProperty("longest_wait_ms", static_cast<int>(1000 * longest));
  EXPECT_LT(longest, 1) << "500 that trickle";
}

TEST(HttpServer, ExceptionIsStatus500) {
  const Bench bench;
  EXPECT_EQ(bench.status("GET /in?throw=1 HTTP/1.1\r\nConnection: close\r\n\r\n"), 500);
  EXPECT_EQ(bench.status("GET /in HTTP/1.1\r\nConnection: close\r\n\r\n"), 200);
}

TEST(HttpServer, IgnoresRanges) {
  const Bench bench;
  std::string ranges = "bytes=0-";
  for (int i = 0; i < 1500; ++i) ranges += ",0-";
  httplib::Client client("127.0.0.1", bench.server.port());
  const auto answer = client.Get("/in?text=0123456789", {{"Range", ranges}});
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 200);
  EXPECT_EQ(answer->body, "0123456789");
}

TEST(HttpServer, KeepsConnectionsOpen) {
  const Bench bench;
  httplib::Client client("127.0.0.1", bench.server.port());
  client.set_keep_alive(true);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(client.Get("/in?text=" + std::to_string(i))->body, std::to_string(i));
  EXPECT_EQ(client.is_socket_open(), 1U);
}

}  // namespace
}  // namespace roadstereo::cli
