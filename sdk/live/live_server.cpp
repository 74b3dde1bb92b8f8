#include "sdk/live/live_server.h"

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <optional>
#include <set>
#include <utility>

#include "core_stack/common/error.h"
#include "sdk/live/client_session.h"
#include "sdk/live/live_page.h"

namespace karst::live {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using Clock = std::chrono::steady_clock;
using boost::system::error_code;

constexpr std::chrono::milliseconds kTick{50};
constexpr std::size_t kMaxLines = 20;  // of the log, at once; then one a second
constexpr int kSendBuffer = 1 << 18;   // of the kernel, for each client; more waits in the outbox

using HttpRequest = http::request<http::empty_body>;
using HttpResponse = http::response<http::string_body>;

std::string_view view(beast::string_view s) { return {s.data(), s.size()}; }

HttpResponse response_of(http::status code, std::string_view type, std::string_view body) {
  HttpResponse out{code, 11};
  out.set(http::field::content_type, beast::string_view(type.data(), type.size()));
  out.set(http::field::cache_control, "no-store");
  out.set("X-Content-Type-Options", "nosniff");
  out.set("Referrer-Policy", "no-referrer");  // the address may hold the token
  out.set("Content-Security-Policy",
          "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; connect-src ws: wss:; "
          "base-uri 'none'; frame-ancestors 'none'");
  out.keep_alive(false);
  out.body() = body;
  out.prepare_payload();
  return out;
}

}  // namespace

/// All connections, on one thread.
class LiveServer::Network {
 public:
  class Connection;

  Network(LiveSetup setup, Retained topics)
      : setup_(std::move(setup)), retained_(std::move(topics)), acceptor_(io_), again_(io_), timer_(io_) {
    error_code error;
    const auto address = asio::ip::make_address(setup_.endpoint.address, error);
    const tcp::endpoint at(address, setup_.endpoint.port);
    if (!error) acceptor_.open(at.protocol(), error);
    if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor_.bind(at, error);
    if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
    if (error)
      throw core::InputError("karst fly", "--live=" + text_of(setup_.endpoint),
                             "cannot be served: " + error.message());
    setup_.endpoint.port = acceptor_.local_endpoint().port();
  }

  void run(const std::function<bool()>& tick);
  void publish(const LiveMessage& message);
  template <class F>
  void for_each_client(const F& f);

  const LiveSetup& setup() const { return setup_; }
  const Retained& retained() const { return retained_; }
  bool has_room() const { return clients_ < setup_.limits.clients; }
  std::size_t clients() const { return clients_; }
  void log(const std::string& text);
  void log_more();
  void forget(const std::shared_ptr<Connection>& connection);
  void count_client(int change) { clients_ += static_cast<std::size_t>(change); }

 private:
  void accept();
  void tick_each(const std::function<bool()>& tick);
  bool all_idle() const;
  void say_farewell();

  LiveSetup setup_;
  Retained retained_;
  asio::io_context io_{1};
  tcp::acceptor acceptor_;
  asio::steady_timer again_, timer_;
  std::set<std::shared_ptr<Connection>> connections_;
  std::size_t clients_ = 0;
  Clock::time_point next_second_ = Clock::now();
  std::optional<Clock::time_point> farewell_until_;
  std::size_t lines_ = kMaxLines, unlogged_ = 0;
};

/// One connection: an HTTP request, and what it asks for: the page, or a WebSocket.
class LiveServer::Network::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, Network& network) : network_(network), ws_(std::move(socket)) {
    error_code ignored;
    const tcp::endpoint peer = lowest().socket().remote_endpoint(ignored);
    peer_ = peer.address().to_string(ignored) + ":" + std::to_string(peer.port());
    lowest().socket().set_option(asio::socket_base::send_buffer_size(kSendBuffer), ignored);
    lowest().socket().set_option(tcp::no_delay(true), ignored);
  }

  void start() {
    parser_.header_limit(static_cast<std::uint32_t>(network_.setup().limits.header_bytes));
    parser_.body_limit(std::uint64_t{0});
    lowest().expires_after(network_.setup().limits.handshake);
    http::async_read(lowest(), buffer_, parser_,
                     [self = shared_from_this()](error_code error, std::size_t) { self->on_request(error); });
  }

  bool is_client() const { return session_.has_value(); }
  ClientSession& session() { return *session_; }

  void send_next() {
    if (writing_ || !session_ || closing_) return;
    if (!session_->complaint().empty()) return leave(session_->complaint());
    std::optional<Frame> frame = session_->next();
    if (!frame) return;
    writing_ = std::move(frame);
    writing_since_ = Clock::now();
    ws_.binary(writing_->binary);
    const std::string& bytes = *writing_->bytes;
    const auto on_written = [self = shared_from_this()](error_code error, std::size_t) {
      self->writing_.reset();
      if (error) return self->end(error);
      self->send_next();
    };
    if (writing_->head)
      ws_.async_write(std::array<asio::const_buffer, 2>{asio::buffer(*writing_->head), asio::buffer(bytes)},
                      on_written);
    else
      ws_.async_write(asio::buffer(bytes), on_written);
  }

  bool is_idle() const { return !session_ || (!writing_ && session_->idle()); }
  void check_progress() {
    if (writing_ && Clock::now() - writing_since_ > network_.setup().limits.stuck)
      cut_off("it takes no message");
  }

  /// By the protocol, if the client takes part in it; else it is cut off after the idle time.
  void leave(const std::string& why, websocket::close_code code = websocket::close_code::policy_error) {
    if (closing_) return;
    if (!session_ || writing_) return cut_off(why);
    closing_ = true;
    reason_ = why;
    websocket::close_reason reason(code);
    reason.reason = beast::string_view(why.data(), std::min<std::size_t>(why.size(), 120));
    ws_.async_close(reason, [self = shared_from_this()](error_code error) { self->end(error); });
  }

  /// At once. Nothing need be under way whose end would tell of it.
  void cut_off(const std::string& why) { end(why); }

 private:
  beast::tcp_stream& lowest() { return beast::get_lowest_layer(ws_); }

  void on_request(error_code error) {
    if (error == http::error::end_of_stream || error == asio::error::eof) return end(error);
    if (error == beast::error::timeout) return end("no request within the time for it");
    if (error) return answer(http::status::bad_request, "no request: " + error.message());
    request_ = HttpRequest(parser_.release());
    const std::string_view target = view(request_.target());
    const std::string_view token = token_of(target, view(request_[http::field::authorization]));
    if (!network_.setup().token.empty() && !same_token(token, network_.setup().token))
      return answer(http::status::unauthorized, "the token is missing, or another: /?token=...");
    if (network_.setup().token.empty() &&
        !is_from_here(view(request_[http::field::host]), view(request_[http::field::origin])))
      return answer(http::status::forbidden, "a page of another site needs a token: --live-token");
    if (request_.method() != http::verb::get)
      return answer(http::status::method_not_allowed, "this server only answers GET");
    if (target.substr(0, target.find('?')) != "/") return answer(http::status::not_found, "there is / alone");
    if (websocket::is_upgrade(request_)) return upgrade();
    send(response_of(http::status::ok, "text/html; charset=utf-8", live_page()));
  }

  void upgrade() {
    const std::string_view chosen = chosen_subprotocol(view(request_[http::field::sec_websocket_protocol]));
    if (chosen.empty())
      return answer(http::status::bad_request, "offer the subprotocol " + std::string(kSubprotocols.front()));
    if (!network_.has_room())
      return answer(http::status::service_unavailable, "as many clients follow the flight as may");
    const LiveLimits& limits = network_.setup().limits;
    lowest().expires_never();
    ws_.set_option(websocket::stream_base::timeout{limits.handshake, limits.idle, true});
    ws_.set_option(websocket::stream_base::decorator([chosen](websocket::response_type& response) {
      response.set(http::field::sec_websocket_protocol, beast::string_view(chosen.data(), chosen.size()));
    }));
    ws_.read_message_max(limits.request_bytes);
    ws_.auto_fragment(false);
    session_.emplace(network_.retained(),
                     server_info(network_.setup().name, network_.setup().session, network_.setup().metadata));
    network_.count_client(+1);
    buffer_.clear();
    ws_.async_accept(request_, [self = shared_from_this()](error_code error) {
      if (error) return self->end(error);
      self->network_.log(self->peer_ + " follows the flight");
      self->read();
      self->send_next();
    });
  }

  void read() {
    ws_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) return self->end(error);
      if (self->ws_.got_text())
        self->session_->receive(
            {static_cast<const char*>(self->buffer_.data().data()), self->buffer_.size()});
      else
        self->session_->receive_binary();
      self->buffer_.clear();
      self->send_next();
      if (self->session_->complaint().empty())
        self->read();
      else
        self->leave(self->session_->complaint());
    });
  }

  void answer(http::status code, const std::string& why) {
    reason_ = why;
    send(response_of(code, "text/plain; charset=utf-8", why + "\n"));
  }

  void send(HttpResponse response) {
    response_ = std::move(response);
    lowest().expires_after(network_.setup().limits.handshake);
    http::async_write(lowest(), response_, [self = shared_from_this()](error_code error, std::size_t) {
      error_code ignored;
      self->lowest().socket().shutdown(tcp::socket::shutdown_send, ignored);
      self->end(error);
    });
  }

  void end(error_code error) {
    if (error == websocket::error::closed)
      end("it has closed the connection");
    else if (error == beast::error::timeout)
      end("it answers no ping");
    else if (error == asio::error::eof || error == asio::error::connection_reset ||
             error == asio::error::not_connected || error == asio::error::broken_pipe)
      end("it is gone");
    else
      end(error ? error.message() : "");
  }
  void end(const std::string& why) {
    if (ended_) return;
    ended_ = true;
    closing_ = true;
    lowest().close();
    const std::string& reason = reason_.empty() ? why : reason_;
    if (session_ || !reason_.empty())
      network_.log(peer_ + " closed: " + reason +
                   (session_ && session_->dropped() > 0
                        ? "; " + std::to_string(session_->dropped()) + " messages were dropped"
                        : ""));
    if (session_) network_.count_client(-1);
    network_.forget(shared_from_this());
  }

  Network& network_;
  websocket::stream<beast::tcp_stream, false> ws_;
  beast::flat_buffer buffer_{65536 + 8192};
  http::request_parser<http::empty_body> parser_;
  HttpRequest request_;
  HttpResponse response_;
  std::optional<ClientSession> session_;  // once it is a WebSocket
  std::optional<Frame> writing_;
  Clock::time_point writing_since_;
  bool closing_ = false, ended_ = false;
  std::string peer_, reason_;
};

template <class F>
void LiveServer::Network::for_each_client(const F& f) {
  for (const auto& c : std::set(connections_))  // f may end it
    if (c->is_client()) f(*c);
}

void LiveServer::Network::publish(const LiveMessage& message) {
  retained_.keep(message);
  for_each_client([&](Connection& c) { c.session().publish(message); });
}

void LiveServer::Network::log(const std::string& text) {
  if (lines_ == 0) {
    ++unlogged_;
    return;
  }
  --lines_;
  setup_.log(text);
}

/// Each second there is room for one more line.
void LiveServer::Network::log_more() {
  lines_ = std::min(lines_ + 1, kMaxLines);
  if (unlogged_ > 0) log(std::to_string(std::exchange(unlogged_, 0)) + " more such lines are left out");
}

void LiveServer::Network::forget(const std::shared_ptr<Connection>& connection) {
  connections_.erase(connection);
}

void LiveServer::Network::accept() {
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (error) {  // such as no descriptor left: not at once again
      again_.expires_after(std::chrono::milliseconds(100));
      again_.async_wait([this](error_code aborted) {
        if (!aborted) accept();
      });
      return;
    }
    if (connections_.size() < setup_.limits.connections) {
      const auto connection = std::make_shared<Connection>(std::move(socket), *this);
      connections_.insert(connection);
      connection->start();
    } else {
      error_code ignored;
      socket.close(ignored);
      log("a connection is closed: there are " + std::to_string(connections_.size()) + " already");
    }
    accept();
  });
}

bool LiveServer::Network::all_idle() const {
  return std::all_of(connections_.begin(), connections_.end(), [](const auto& c) { return c->is_idle(); });
}

void LiveServer::Network::say_farewell() {
  for (const auto& c : std::set(connections_))
    c->leave("the flight is over", websocket::close_code::going_away);
}

void LiveServer::Network::tick_each(const std::function<bool()>& tick) {
  timer_.expires_after(kTick);
  timer_.async_wait([this, tick](error_code error) {
    if (error) return;
    const auto now = Clock::now();
    if (!farewell_until_ && !tick()) {
      acceptor_.close();
      farewell_until_ = now + setup_.limits.farewell;
    }
    const bool second = now >= next_second_;
    if (second) {
      next_second_ = now + std::chrono::seconds(1);
      log_more();
    }
    for_each_client([&](Connection& c) {
      if (second || farewell_until_) c.session().tell_dropped();
      c.send_next();
      c.check_progress();
    });
    if (farewell_until_ && (all_idle() || now >= *farewell_until_)) {
      say_farewell();
      timer_.expires_after(std::chrono::milliseconds(300));  // for the clients' own closing frames
      timer_.async_wait([this](error_code) { io_.stop(); });
      return;
    }
    tick_each(tick);
  });
}

void LiveServer::Network::run(const std::function<bool()>& tick) {
  accept();
  tick_each(tick);
  io_.run();
  for (const auto& c : std::set(connections_)) c->cut_off("the flight is over");
  io_.restart();
  io_.poll();
}

LiveServer::LiveServer(LiveSetup setup, Retained topics)
    : network_(std::make_unique<Network>(std::move(setup), std::move(topics))) {}
LiveServer::~LiveServer() = default;

Endpoint LiveServer::endpoint() const { return network_->setup().endpoint; }
void LiveServer::run(const std::function<bool()>& tick) { network_->run(tick); }
void LiveServer::publish(const LiveMessage& message) { network_->publish(message); }
void LiveServer::tell_time(std::uint64_t time_ns) {
  network_->for_each_client([&](Network::Connection& c) { c.session().tell_time(time_ns); });
}
void LiveServer::tell(StatusLevel level, const std::string& text, const std::string& id) {
  network_->for_each_client([&](Network::Connection& c) { c.session().tell(level, text, id); });
}
std::size_t LiveServer::clients() const { return network_->clients(); }

}  // namespace karst::live
