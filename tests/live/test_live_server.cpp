// The server of `live`: who is let in, what is answered, and that nobody is kept waiting by others.
#include <gtest/gtest.h>
#include <httplib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <fstream>
#include <future>
#include <new>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "live/access.hpp"
#include "live/live_server.hpp"
#include "live/serving_threads.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/image_file.hpp"

namespace roadstereo::cli {
namespace {

TEST(ServeAddress, ParsesHostAndPort) {
  const ServeAddress bare = serve_address("8080");
  EXPECT_EQ(bare.host, "127.0.0.1");
  EXPECT_EQ(bare.port, 8080);
  EXPECT_EQ(serve_address("0.0.0.0:0").host, "0.0.0.0");
  EXPECT_EQ(serve_address("[::]:81").host, "::");
  EXPECT_EQ(serve_address("[::]:81").port, 81);
  EXPECT_EQ(serve_address("road.local:81").host, "road.local");
  EXPECT_EQ(url_host(serve_address("[fe80::1]:81").host), "[fe80::1]");
  for (const char* wrong : {"", "x", ":", ":80", "host:", "1.2.3.4:65536", "80x", "-1", "fe80::1:81", "[::1]"}) {
    EXPECT_THROW(serve_address(wrong), Error) << wrong;
  }
}

TEST(ServeAddress, OnlyLoopbackIsLocal) {
  for (const char* host : {"127.0.0.1", "127.9.8.7", "localhost", "::1"}) {
    EXPECT_TRUE((ServeAddress{host, 0}.loopback())) << host;
  }
  for (const char* host : {"0.0.0.0", "::", "192.168.1.7", "128.0.0.1", "localhost.evil.com", "127.0.0.1.evil.com"}) {
    EXPECT_FALSE((ServeAddress{host, 0}.loopback())) << host;
  }
}

TEST(Access, RejectsForeignHostHeader) {
  for (const char* header : {"localhost", "LocalHost:8080", "127.0.0.1:1", "127.0.0.1", "[::1]:8080", "[::1]"}) {
    EXPECT_TRUE(names_this_machine(header)) << header;
  }
  for (const char* header : {"", "evil.com", "evil.com:8080", "localhost.evil.com:80", "127.0.0.1.evil.com", "[::2]:80",
                             "0.0.0.0", "192.168.0.2:80", "localhost:evil", "localhost:123456"}) {
    EXPECT_FALSE(names_this_machine(header)) << header;
  }
}

TEST(Access, TokensAreLongAndUnique) {
  const std::string one = random_token(), other = random_token();
  EXPECT_EQ(one.size(), 32U);
  EXPECT_EQ(one.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(one, other);
  EXPECT_TRUE(equal_in_constant_time(one, one));
  EXPECT_FALSE(equal_in_constant_time(other, one));
  EXPECT_FALSE(equal_in_constant_time("", one));
  EXPECT_FALSE(equal_in_constant_time(one.substr(0, 31), one));
  EXPECT_FALSE(equal_in_constant_time(one + "0", one));
}

LiveView small_view(int width = 64) {
  LiveView view;
  view.arrival = Clock::now();
  view.left = {std::vector<std::uint8_t>(static_cast<std::size_t>(width) * 40, 90), width, 40, SampleType::u8,
               ChannelOrder::grey};
  view.transformed.assign(width, 40, 12);
  view.transformed(3, 3) = 9;
  view.delta_t = 12;
  view.ids.assign(width, 40, 0);
  Damage damage;
  damage.id = 1;
  damage.pixels = 42;
  damage.centroid_px = {20, 20};
  damage.box_px = {15, 15, 25, 25};
  damage.max_depth_px = {2.5, 0.25};
  view.damages = {damage};
  return view;
}

/// A server on this machine, and one who asks.
struct Bench {
  LiveBoard board{1000};
  LiveServer server{{"127.0.0.1", 0}, board};
  httplib::Client client{"127.0.0.1", server.port()};

  nlohmann::json state(const std::string& query) {
    const auto answer = client.Get("/state" + query);
    return answer && answer->status == 200 ? nlohmann::json::parse(answer->body) : nlohmann::json();
  }
};

TEST(LiveServer, ServesPageWithSafeHeaders) {
  Bench bench;
  EXPECT_EQ(bench.server.url(), "http://127.0.0.1:" + std::to_string(bench.server.port()) + "/");
  EXPECT_EQ(bench.server.token(), "");
  const auto page = bench.client.Get("/");
  ASSERT_TRUE(page);
  EXPECT_EQ(page->status, 200);
  EXPECT_EQ(page->get_header_value("Content-Type"), "text/html; charset=utf-8");
  EXPECT_EQ(page->get_header_value("Content-Security-Policy").rfind("default-src 'self';", 0), 0U);
  EXPECT_EQ(page->get_header_value("Cache-Control"), "no-store");
  EXPECT_EQ(page->get_header_value("X-Content-Type-Options"), "nosniff");
  EXPECT_EQ(page->body.find("{{"), std::string::npos);
  for (const char* path : {"/style.css", "/script.js", "/ramp.png"}) {
    EXPECT_NE(page->body.find(std::string("\"") + path + "\""), std::string::npos) << path;
    const auto file = bench.client.Get(path);
    ASSERT_TRUE(file);
    EXPECT_EQ(file->status, 200) << path;
    EXPECT_GT(file->body.size(), 100U) << path;
  }
  for (const char* absent : {"/secret", "/styleXcss", "/rampXpng"}) {
    EXPECT_EQ(bench.client.Get(absent)->status, 404) << absent;
  }
}

TEST(LiveServer, StateHasNewestView) {
  Bench bench;
  EXPECT_EQ(bench.state("?after=0")["state"], "starting") << "after at most a second";
  bench.board.publish(small_view());
  nlohmann::json state = bench.state("?after=0");
  EXPECT_EQ(state["state"], "live");
  EXPECT_EQ(state["frame"], 1);
  EXPECT_EQ(state["view"]["width"], 64);
  EXPECT_EQ(state["view"]["roll"], nullptr);
  EXPECT_EQ(state["recording"], nullptr);
  ASSERT_EQ(state["damages"].size(), 1U);
  EXPECT_EQ(state["damages"][0]["depth"], nlohmann::json({{"value", 2.5}, {"error", 0.25}, {"unit", "px"}}));
  EXPECT_EQ(state["damages"][0]["area"]["value"], 42);
  bench.board.publish(small_view());
  state = bench.state("?after=1");
  EXPECT_EQ(state["frame"], 2);
  EXPECT_EQ(state["damages"].size(), 0U) << "the second view told nothing new of it";
  EXPECT_EQ(bench.state("?after=0")["damages"].size(), 1U);
}

TEST(LiveServer, StateHasHealthOfLastPairs) {
  Bench bench;
  for (int i = 0; i < 20; ++i) {
    LiveView view = small_view();
    view.health.row_offset_px = i % 2;
    bench.board.publish(std::move(view));
  }
  const nlohmann::json view = bench.state("?after=0")["view"];
  ASSERT_EQ(view["health"]["findings"].size(), 1U);
  EXPECT_EQ(view["health"]["findings"][0]["id"], "vibration");
  EXPECT_EQ(view["health"]["findings"][0]["limit"], 0.5);
  EXPECT_NEAR(view["health"]["vibration_px"], 1.4826 / std::sqrt(2.0), 1e-9);
  EXPECT_EQ(view["health"]["lost_share"], nullptr);
  ASSERT_EQ(view["warnings"].size(), 1U) << "the page shows them";
  EXPECT_EQ(view["warnings"][0].get<std::string>().rfind("vibration: the offset of the rows", 0), 0U);
}

TEST(LiveServer, StateWaitsForNextView) {
  Bench bench;
  bench.board.publish(small_view());
  auto waiting = std::async(std::launch::async, [&bench] { return bench.state("?after=1"); });
  bench.board.publish(small_view());
  EXPECT_EQ(waiting.get()["frame"], 2);
}

void expect_jpeg(const httplib::Result& answer, int width) {
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->status, 200);
  EXPECT_EQ(answer->get_header_value("Content-Type"), "image/jpeg");
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("roadstereo_live_" + std::to_string(getpid()) + ".jpg");
  std::ofstream(file, std::ios::binary) << answer->body;
  const Frame picture = io::read_frame(file.string());
  std::filesystem::remove(file);
  EXPECT_EQ(picture.width, width);
  EXPECT_EQ(picture.height, 40);
}

TEST(LiveServer, ServesPicturesOfViewOrNewest) {
  Bench bench;
  EXPECT_EQ(bench.client.Get("/left.jpg?frame=1")->status, 404);
  bench.board.publish(small_view(64));
  bench.board.publish(small_view(96));
  for (const std::string name : {"left", "transformed"}) {
    expect_jpeg(bench.client.Get("/" + name + ".jpg?frame=1"), 64);
    expect_jpeg(bench.client.Get("/" + name + ".jpg?frame=2"), 96);
    expect_jpeg(bench.client.Get("/" + name + ".jpg?frame=77"), 96);
  }
  const auto transformed = bench.client.Get("/transformed.jpg?frame=1");
  EXPECT_EQ(transformed->get_header_value("Frame"), "1");
  EXPECT_EQ(std::stod(transformed->get_header_value("Colour-Range")), 1) << "flat but for one pixel";
}

TEST(LiveServer, RejectsBadRequests) {
  Bench bench;
  EXPECT_EQ(bench.client.Post("/", "x", "text/plain")->status, 405);
  EXPECT_EQ(bench.client.Delete("/state")->status, 405);
  for (const char* wrong :
       {"/state?after=x", "/state?after=-1", "/state?after=1e3", "/left.jpg?frame=99999999999999999999"}) {
    EXPECT_EQ(bench.client.Get(wrong)->status, 400) << wrong;
  }
  const httplib::Headers elsewhere{{"Host", "evil.com"}};
  for (const char* path : {"/", "/state", "/left.jpg", "/secret"}) {
    const auto answer = bench.client.Get(path, elsewhere);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 403) << path;
    EXPECT_EQ(answer->body, "") << path;
  }
}

TEST(LiveServer, RemoteAccessNeedsToken) {
  LiveBoard board(1000);
  board.publish(small_view());
  const LiveServer server({"0.0.0.0", 0}, board);
  ASSERT_EQ(server.token().size(), 32U);
  EXPECT_NE(server.url().find("/?token=" + server.token()), std::string::npos);
  httplib::Client client("127.0.0.1", server.port());
  std::string wrong = server.token();
  wrong.back() = wrong.back() == '0' ? '1' : '0';
  for (const std::string path : {"/", "/state", "/left.jpg", "/style.css", "/secret"}) {
    for (const std::string& query : std::vector<std::string>{"", "?token=", "?token=" + wrong}) {
      const auto answer = client.Get(path + query);
      ASSERT_TRUE(answer);
      EXPECT_EQ(answer->status, 403) << path << query;
      EXPECT_EQ(answer->body, "");
    }
  }
  const auto page = client.Get("/?token=" + server.token(), {{"Host", "road.local"}});
  ASSERT_TRUE(page);
  EXPECT_EQ(page->status, 200);
  EXPECT_NE(page->body.find("/script.js?token=" + server.token()), std::string::npos);
  EXPECT_EQ(client.Get("/left.jpg?frame=1&token=" + server.token())->status, 200);
}

TEST(LiveServer, ErrorNamesPortInUse) {
  Bench bench;
  try {
    const LiveServer other({"127.0.0.1", bench.server.port()}, bench.board);
    FAIL() << "two servers at one port";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(std::to_string(bench.server.port())), std::string::npos);
  }
}

/// A connection of somebody who does not behave.
class HungClient {
 public:
  HungClient(int port, const std::string& sent) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0 &&
                 ::send(socket_, sent.data(), sent.size(), 0) == static_cast<ssize_t>(sent.size());
  }
  ~HungClient() { ::close(socket_); }
  HungClient(const HungClient&) = delete;
  HungClient& operator=(const HungClient&) = delete;
  bool connected() const { return connected_; }

 private:
  int socket_;
  bool connected_ = false;
};

TEST(LiveServer, HungClientsDoNotBlockOthers) {
  Bench bench;
  bench.board.publish(small_view());
  std::vector<std::unique_ptr<HungClient>> clients;
  std::string greedy;  // asks for more than the connection holds, and reads nothing
  for (int i = 0; i < 3000; ++i) greedy += "GET /script.js HTTP/1.1\r\nHost: localhost\r\n\r\n";
  for (int i = 0; i < 10; ++i) {
    clients.push_back(std::make_unique<HungClient>(bench.server.port(), "GET /state?after=0 HTTP/1.1\r\nHo"));
    clients.push_back(std::make_unique<HungClient>(bench.server.port(), i == 0 ? greedy : ""));
  }
  for (const auto& client : clients) EXPECT_TRUE(client->connected());
  for (int i = 0; i < 20; ++i) {
    bench.board.publish(small_view());
    EXPECT_EQ(bench.client.Get("/left.jpg?frame=0")->status, 200);
    EXPECT_EQ(bench.state("?after=0")["frame"], 2 + i);
  }
}

TEST(ServingThreads, NeverExceedLimit) {
  constexpr std::size_t most = 3;
  ServingThreads threads(most);
  std::promise<void> freed;
  const std::shared_future<void> wait = freed.get_future().share();
  std::atomic<int> done = 0, running = 0, largest = 0;
  for (int i = 0; i < 20; ++i) {
    threads.enqueue([&] {
      int now = ++running, seen = largest;
      while (now > seen && !largest.compare_exchange_weak(seen, now)) {
      }
      wait.wait();
      --running;
      ++done;
    });
  }
  threads.enqueue([] { throw std::bad_alloc(); });
  freed.set_value();
  threads.shutdown();
  EXPECT_EQ(done, 20) << "those that wait are served, too";
  EXPECT_LE(largest, 3);
}

}  // namespace
}  // namespace roadstereo::cli
