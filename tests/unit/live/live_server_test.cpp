// A flight served over real sockets: to clients that behave, that are slow or dead, and that attack.
#include <gtest/gtest.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <cstring>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "core_stack/common/error.h"
#include "sdk/live/live_flight.h"

namespace karst::live {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using core::RecordPart;
using namespace std::chrono_literals;
using nlohmann::json;

constexpr const char* kPose =
    "%d.0000 1.000000 2.000000 3.000000 0.00000000 0.00000000 0.00000000 1.00000000\n";

/// What the server logs.
class Log {
 public:
  void add(const std::string& text) {
    const std::lock_guard lock(mutex_);
    text_ += text + "\n";
  }
  bool has(const std::string& part, std::chrono::milliseconds patience = 10s) const {
    for (const auto end = std::chrono::steady_clock::now() + patience; std::chrono::steady_clock::now() < end;
         std::this_thread::sleep_for(10ms)) {
      const std::lock_guard lock(mutex_);
      if (text_.find(part) != std::string::npos) return true;
    }
    return false;
  }
  std::string text() const {
    const std::lock_guard lock(mutex_);
    return text_;
  }

 private:
  mutable std::mutex mutex_;
  std::string text_;
};

class Client {
 public:
  explicit Client(const Endpoint& at, const std::string& target = "/",
                  const std::string& subprotocol = "foxglove.websocket.v1") {
    ws_.next_layer().connect({asio::ip::make_address(at.address), at.port});
    ws_.set_option(websocket::stream_base::decorator([&](websocket::request_type& r) {
      if (!subprotocol.empty()) r.set(beast::http::field::sec_websocket_protocol, subprotocol);
    }));
    ws_.handshake(text_of(at), target);
  }
  json read_text() {
    for (;;) {
      const std::string bytes = read();
      if (ws_.got_text()) return json::parse(bytes);
    }
  }
  std::string read() {
    beast::flat_buffer buffer;
    ws_.read(buffer);
    return beast::buffers_to_string(buffer.data());
  }
  void write(const std::string& text) { ws_.write(asio::buffer(text)); }
  void write_binary(const std::string& bytes) {
    ws_.binary(true);
    ws_.write(asio::buffer(bytes));
  }
  /// Reads the greeting, and subscribes; a subscription's id is the channel's and 100.
  void follow(const std::string& topic) {
    read_text();
    const json channels = read_text()["channels"];
    for (const json& c : channels)
      if (c["topic"] == topic)
        write(json{{"op", "subscribe"},
                   {"subscriptions", {{{"id", c["id"].get<int>() + 100}, {"channelId", c["id"]}}}}}
                  .dump());
  }
  /// Once this returns, the server has taken what was asked before: it answers in order.
  void wait_until_taken() {
    write("garbage");
    while (read_text()["op"] != "status") {
    }
  }
  /// The time of the next message of a subscription.
  std::uint64_t next_message_ns() {
    for (;;) {
      const std::string bytes = read();
      if (ws_.got_text() || bytes[0] != 1) continue;
      std::uint64_t t = 0;
      std::memcpy(&t, bytes.data() + 5, sizeof t);
      return t;
    }
  }
  websocket::close_reason reason() const { return ws_.reason(); }
  tcp::socket& socket() { return ws_.next_layer(); }

 private:
  asio::io_context io_;
  websocket::stream<tcp::socket> ws_{io_};
};

class Live : public testing::Test {
 protected:
  LiveSetup setup() {
    LiveSetup s;
    s.endpoint.port = 0;
    s.name = "karst";
    s.session = "1";
    s.limits.farewell = 300ms;
    s.log = [this](const std::string& text) { log_.add(text); };
    return s;
  }
  void start(const LiveSetup& s) { flight_.emplace(s, 0.2); }
  void pose(int t_s) {
    std::array<char, 200> line;
    std::snprintf(line.data(), line.size(), kPose, t_s);
    flight_->listener().on_record(RecordPart::trajectory, line.data());
    // The feed hands a record on with the next where the reader is at work. In flight the next comes soon.
    for (int i = 0; i < 5; ++i, std::this_thread::sleep_for(5ms))
      flight_->listener().on_record(RecordPart::events, "{\"t\":0,\"kind\":\"unknown to viewers\"}\n");
  }
  Endpoint at() const { return flight_->endpoint(); }
  tcp::socket connected() {
    tcp::socket socket(io_);
    socket.connect({asio::ip::make_address(at().address), at().port});
    return socket;
  }
  /// What a server says to some bytes, until it closes.
  std::string answer_to(const std::string& bytes) {
    tcp::socket socket = connected();
    boost::system::error_code ignored;
    asio::write(socket, asio::buffer(bytes), ignored);
    std::string answer;
    asio::read(socket, asio::dynamic_buffer(answer), ignored);
    return answer;
  }

  Log log_;
  asio::io_context io_;
  std::optional<LiveFlight> flight_;
};

TEST_F(Live, AClientIsGreetedAndGetsWhatIsRecorded) {
  start(setup());
  Client client(at());
  EXPECT_EQ(client.read_text()["name"], "karst");
  const json channels = client.read_text()["channels"];
  EXPECT_EQ(channels.size(), flight_topics().size());
  const auto tf =
      std::find_if(channels.begin(), channels.end(), [](const json& c) { return c["topic"] == "/tf"; });
  ASSERT_NE(tf, channels.end());
  client.write(
      json{{"op", "subscribe"}, {"subscriptions", {{{"id", 7}, {"channelId", (*tf)["id"]}}}}}.dump());
  client.write("garbage");
  EXPECT_EQ(client.read_text()["level"], 2);  // so the subscription has been taken
  pose(3);
  EXPECT_EQ(client.next_message_ns(), 3'000'000'000u);
}

TEST_F(Live, WhoComesLaterGetsTheMapAtOnceAndAllGetTheEnd) {
  start(setup());
  std::array<std::int32_t, 4> cell{1, 2, 3, 1500};
  flight_->listener().on_record(RecordPart::map_growth,
                                {reinterpret_cast<const char*>(cell.data()), sizeof cell});
  pose(5);
  Client early(at());
  early.follow("/map");
  EXPECT_EQ(early.next_message_ns() % 1'000'000'000, 0u);
  pose(6);
  flight_->listener().on_close();
  std::uint64_t last = 0;
  std::thread end([&] { flight_.reset(); });
  try {
    for (;;) last = early.next_message_ns();
  } catch (const beast::system_error& e) {
    EXPECT_EQ(e.code(), websocket::error::closed) << e.what();
  }
  end.join();
  EXPECT_EQ(last, 6'000'000'000u);
  EXPECT_EQ(std::string(early.reason().reason.c_str()), "the flight is over");
}

TEST_F(Live, TheNewerSubprotocolIsSpokenTooAndNoneIsRefused) {
  start(setup());
  EXPECT_EQ(Client(at(), "/", "foxglove.sdk.v1").read_text()["op"], "serverInfo");
  EXPECT_THROW(Client(at(), "/", ""), beast::system_error);
  EXPECT_THROW(Client(at(), "/", "mqtt"), beast::system_error);
}

TEST_F(Live, ThePageIsServedAndNothingElse) {
  start(setup());
  const std::string page = answer_to("GET / HTTP/1.1\r\nHost: 127.0.0.1:1\r\n\r\n");
  EXPECT_TRUE(page.starts_with("HTTP/1.1 200")) << page.substr(0, 100);
  EXPECT_NE(page.find("<canvas"), std::string::npos);
  EXPECT_NE(page.find("Content-Security-Policy"), std::string::npos);
  EXPECT_TRUE(
      answer_to("GET /../../etc/passwd HTTP/1.1\r\nHost: 127.0.0.1:1\r\n\r\n").starts_with("HTTP/1.1 404"));
  EXPECT_TRUE(answer_to("DELETE / HTTP/1.1\r\nHost: 127.0.0.1:1\r\n\r\n").starts_with("HTTP/1.1 405"));
}

TEST_F(Live, BeyondTheLoopbackATokenIsNeeded) {
  LiveSetup open = setup();
  open.endpoint.address = "0.0.0.0";
  EXPECT_THROW(start(open), core::InputError);
  open.token = "short";
  EXPECT_THROW(start(open), core::InputError);
  open.token = "long.enough-token";
  start(open);
}

TEST_F(Live, AnAddressThatIsTakenIsNamed) {
  start(setup());
  LiveSetup same = setup();
  same.endpoint = at();
  try {
    LiveFlight second(same, 0.2);
    ADD_FAILURE() << "two servers at one address";
  } catch (const core::InputError& e) {
    EXPECT_NE(std::string(e.what()).find(text_of(at())), std::string::npos) << e.what();
  }
}

TEST_F(Live, WithATokenNobodyGetsAnythingWithoutIt) {
  LiveSetup secret = setup();
  secret.token = "long.enough-token";
  start(secret);
  for (const char* target : {"/", "/?token=", "/?token=long.enough-toke", "/?token=long.enough-tokeN"}) {
    EXPECT_THROW(Client(at(), target), beast::system_error) << target;
    EXPECT_TRUE(answer_to("GET " + std::string(target) + " HTTP/1.1\r\nHost: 127.0.0.1:1\r\n\r\n")
                    .starts_with("HTTP/1.1 401"));
  }
  EXPECT_EQ(Client(at(), "/?token=long.enough-token").read_text()["op"], "serverInfo");
  EXPECT_TRUE(
      answer_to("GET / HTTP/1.1\r\nHost: 127.0.0.1:1\r\nAuthorization: Bearer long.enough-token\r\n\r\n")
          .starts_with("HTTP/1.1 200"));
}

TEST_F(Live, GarbageHugeHeadersAndEndlessHandshakesAreClosed) {
  LiveSetup quick = setup();
  quick.limits.handshake = 200ms;
  start(quick);
  EXPECT_FALSE(
      answer_to(std::string("\x16\x03\x01\x00\xff garbage\r\n\r\n", 20)).starts_with("HTTP/1.1 200"));
  EXPECT_FALSE(answer_to("GET / HTTP/1.1\r\nX: " + std::string(100'000, 'x') + "\r\n\r\n")
                   .starts_with("HTTP/1.1 200"));
  EXPECT_FALSE(
      answer_to("POST / HTTP/1.1\r\nContent-Length: 99999999999\r\n\r\n").starts_with("HTTP/1.1 200"));
  EXPECT_EQ(answer_to("GET / HT"), "");  // closed after the time for it
  EXPECT_EQ(Client(at()).read_text()["op"], "serverInfo");
}

TEST_F(Live, AHugeFrameAndNonsenseEndTheConnectionWithTheReasonLogged) {
  start(setup());
  Client huge(at());
  huge.read_text();
  huge.read_text();
  try {
    huge.write(std::string(1 << 20, 'x'));
    for (;;) huge.read();
  } catch (const beast::system_error&) {
  }
  EXPECT_TRUE(log_.has("closed: The WebSocket message exceeded")) << log_.text();
  Client nonsense(at());
  try {
    for (int i = 0; i < 1000; ++i) nonsense.write("{\"op\":\"subscribe\",\"subscriptions\":7}");
    for (;;) nonsense.read();
  } catch (const beast::system_error&) {
  }
  EXPECT_TRUE(log_.has("make no sense")) << log_.text();
  EXPECT_EQ(Client(at()).read_text()["op"], "serverInfo");
}

TEST_F(Live, OfAThousandConnectionsAFewAreHeldAndTheRestClosed) {
  LiveSetup few = setup();
  few.limits.connections = 10;
  few.limits.clients = 2;
  few.limits.handshake = 300ms;
  start(few);
  {
    std::vector<tcp::socket> sockets;
    for (int i = 0; i < 1000; ++i) {
      tcp::socket socket(io_);
      boost::system::error_code error;
      socket.connect({asio::ip::make_address(at().address), at().port}, error);
      if (!error) sockets.push_back(std::move(socket));
      if (sockets.size() > 200) sockets.erase(sockets.begin());
    }
  }
  const auto follows = [this] {  // once those that ask for nothing have been closed
    for (int attempt = 0; attempt < 1000; ++attempt, std::this_thread::sleep_for(50ms)) try {
        return std::make_unique<Client>(at());
      } catch (const beast::system_error&) {
      }
    return std::unique_ptr<Client>();
  };
  const auto first = follows(), second = follows();
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->read_text()["op"], "serverInfo");
  EXPECT_THROW(Client third(at()), beast::system_error);  // as many follow as may
}

TEST_F(Live, AClientThatReadsNothingIsLeftAndTheOthersGoOn) {
  LiveSetup strict = setup();
  strict.limits.stuck = 400ms;
  start(strict);
  Client dead(at()), alive(at());
  dead.socket().set_option(asio::socket_base::receive_buffer_size(4096));
  dead.follow("/events");
  dead.wait_until_taken();
  alive.follow("/tf");
  alive.wait_until_taken();
  for (int i = 0; i < 200; ++i)
    flight_->listener().on_record(RecordPart::events,
                                  R"({"t":1.5,"kind":"log","text":")" + std::string(100'000, 'x') + "\"}\n");
  pose(2);
  EXPECT_EQ(alive.next_message_ns(), 2'000'000'000u);
  EXPECT_TRUE(log_.has("it takes no message")) << log_.text();
  EXPECT_TRUE(log_.has("messages were dropped")) << log_.text();
  pose(3);
  EXPECT_EQ(alive.next_message_ns(), 3'000'000'000u);
}

TEST_F(Live, ASlowClientIsToldWhatItMisses) {
  start(setup());
  Client slow(at()), other(at());
  slow.follow("/events");
  slow.wait_until_taken();
  other.follow("/tf");
  other.wait_until_taken();
  // 25 MB: more than the kernel and the outbox of a client hold, less than RecordFeed::kMaxBytes, so that the
  // feed hands on all of it.
  for (int i = 0; i < 250; ++i)
    flight_->listener().on_record(RecordPart::events,
                                  R"({"t":1.5,"kind":"log","text":")" + std::string(100'000, 'x') + "\"}\n");
  pose(2);
  other.next_message_ns();  // so all of them have been published, of which most found no room
  json told;
  do told = slow.read_text();
  while (!told.contains("id"));
  EXPECT_EQ(told["id"], "dropped");
  EXPECT_NE(told["message"].get<std::string>().find("of /events"), std::string::npos) << told;
}

TEST_F(Live, ARecordThatNoRecorderWritesIsLoggedAndTheRestServed) {
  start(setup());
  Client client(at());
  client.follow("/tf");
  client.wait_until_taken();
  flight_->listener().on_record(RecordPart::trajectory, "nonsense\n");
  pose(4);
  EXPECT_EQ(client.next_message_ns(), 4'000'000'000u);
  EXPECT_TRUE(log_.has("nonsense"));
}

}  // namespace
}  // namespace karst::live
