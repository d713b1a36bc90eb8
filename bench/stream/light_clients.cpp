// SPDX-License-Identifier: Apache-2.0
#include "bench/stream/light_clients.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/ssl.hpp>
#include <boost/beast/websocket.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <deque>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>

#include "core/little_endian.h"
#include "lambent/stream.h"
#include "stream/protocol/hello_header.h"

namespace lambent::stream_load {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;
namespace ssl = boost::asio::ssl;
using boost::asio::ip::tcp;
using Clock = std::chrono::steady_clock;
using PlainStream = beast::tcp_stream;
using TlsStream = beast::ssl_stream<PlainStream>;
using stream::LightMessageKind;

// Types and offsets in messages of light that clients without a decoder read: docs/protocol.md and
// docs/stream-light.md.
constexpr std::uint32_t kLightType = 67, kWelcomeType = 65;
constexpr std::size_t kKindAt = 8, kPayloadAt = 28, kGeometryAt = kPayloadAt + 24;

// Number of clients that connect at a time: more would wait in the server's backlog, which would
// affect the measurement.
constexpr int kConnecting = 32;

struct Shared {
  boost::asio::io_context io{1};
  ssl::context tls{ssl::context::tls_client};
  tcp::endpoint server;
  std::string host, token;
  LightClients::OnLight on_light;
  Seen seen;
  int connecting = 0;
};

template <class Stream>
class OneClient {
 public:
  OneClient(Shared& shared, std::size_t number, bool decodes)
      : shared_(shared), number_(number), socket_([&shared] {
          if constexpr (std::is_same_v<Stream, TlsStream>) {
            return websocket::stream<Stream>(shared.io, shared.tls);
          } else {
            return websocket::stream<Stream>(shared.io);
          }
        }()) {
    if (decodes) decoder_.emplace();
  }

  void start() {
    ++shared_.connecting;
    started_ = Clock::now();
    beast::get_lowest_layer(socket_).async_connect(shared_.server, [this](beast::error_code error) {
      if (error) return fail();
      tell("connected");
      beast::get_lowest_layer(socket_).socket().set_option(tcp::no_delay(true), error);
      if constexpr (std::is_same_v<Stream, TlsStream>) {
        socket_.next_layer().async_handshake(ssl::stream_base::client,
                                             [this](beast::error_code done) { upgrade(done); });
      } else {
        upgrade({});
      }
    });
  }

 private:
  void upgrade(beast::error_code error) {
    if (error) return fail();
    socket_.read_message_max(stream::kHeaderBytes + stream::kMaxLightBytes);
    socket_.binary(true);
    stream::Hello hello;
    hello.wants = stream::kWantsLight;
    hello.token = shared_.token;
    socket_.set_option(websocket::stream_base::decorator(
        [field = stream::hello_header(hello)](websocket::request_type& request) {
          request.set(stream::kHelloField, field);
        }));
    socket_.async_handshake(shared_.host, "/stream", [this](beast::error_code done) {
      if (done) return fail();
      tell("WebSocket open");
      read();
    });
  }

  void read() {
    socket_.async_read(buffer_, [this](beast::error_code error, std::size_t) {
      if (error) return fail();
      const auto data = buffer_.cdata();
      take({static_cast<const std::byte*>(data.data()), data.size()});
      buffer_.consume(buffer_.size());
      if (!joined_) buffer_.shrink_to_fit();
      read();
    });
  }

  void take(std::span<const std::byte> message) {
    const std::uint32_t type = ByteReader(message).u32();
    if (type == kWelcomeType) tell("welcome", message.size());
    if (message.size() < kGeometryAt + sizeof(std::uint64_t) || type != kLightType) return;
    ByteReader light(message.subspan(kKindAt));
    const auto kind = static_cast<LightMessageKind>(light.u32());
    const std::uint64_t update = light.u64();
    // The geometry of corrections is the one with which they appeared, so skip them
    if (kind != LightMessageKind::corrections) {
      geometry_ = ByteReader(message.subspan(kGeometryAt)).u64();
    }
    bool needs_key = false;
    if (!joined_) tell(kind == LightMessageKind::geometry ? "geometry" : "key", message.size());
    if (decoder_) {
      if (!decoder_->receive(message.subspan(kPayloadAt))) ++shared_.seen.broken;
      geometry_ = decoder_->geometry();
      needs_key = decoder_->needs_key() && kind != LightMessageKind::geometry;
    }
    const bool is_light =
        kind != LightMessageKind::geometry && kind != LightMessageKind::corrections;
    if (is_light) count(kind, update);
    if (kind == LightMessageKind::corrections) tell("corrections", message.size());
    send(stream::LightReceived{update, geometry_, needs_key ? 1u : 0u});
  }

  void count(LightMessageKind kind, std::uint64_t update) {
    Seen& seen = shared_.seen;
    ++seen.updates;
    if (kind == LightMessageKind::key) {
      ++seen.keys;
    } else if (update != update_ + 1) {
      ++seen.missed;
    }
    update_ = update;
    if (shared_.on_light) shared_.on_light(number_, update);
    if (joined_) return;
    joined_ = true;
    tell("first light, decoded");
    ++seen.joined;
    --shared_.connecting;
    seen.join_ms.push_back(since_start_ms());
  }

  /// Records a milestone of the first client.
  void tell(const char* what, std::size_t bytes = 0) {
    constexpr std::size_t kMost = 64;
    if (number_ != 0 || shared_.seen.first_join.size() >= kMost) return;
    shared_.seen.first_join.push_back({what, since_start_ms(), bytes});
  }
  double since_start_ms() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - started_).count();
  }

  void send(const stream::Message& message) {
    outgoing_.push_back(stream::write_message(message));
    if (outgoing_.size() == 1) write();
  }
  void write() {
    const auto& bytes = outgoing_.front();
    socket_.async_write(boost::asio::buffer(bytes.data(), bytes.size()),
                        [this](beast::error_code error, std::size_t) {
                          if (error) return;  // reading then fails, too
                          outgoing_.pop_front();
                          if (!outgoing_.empty()) write();
                        });
  }

  void fail() {
    if (failed_) return;
    failed_ = true;
    ++shared_.seen.failed;
    if (!joined_) --shared_.connecting;
  }

  Shared& shared_;
  const std::size_t number_;
  websocket::stream<Stream> socket_;
  beast::flat_buffer buffer_;
  std::deque<std::vector<std::byte>> outgoing_;
  std::optional<stream::LightDecoder> decoder_;
  Clock::time_point started_;
  std::uint64_t update_ = 0, geometry_ = 0;
  bool joined_ = false, failed_ = false;
};

template <class Stream>
class Clients : public LightClients {
 public:
  Clients(const Address& address, int decode_every, OnLight on_light)
      : decode_every_(decode_every) {
    shared_.on_light = std::move(on_light);
    shared_.token = address.token;
    shared_.server = {boost::asio::ip::make_address(address.host), address.port};
    shared_.host = address.host + ":" + std::to_string(address.port);
    shared_.tls.set_verify_mode(ssl::verify_none);
  }

  void add(int count) override { waiting_ += count; }

  void run_for(std::chrono::milliseconds time) override {
    constexpr std::chrono::milliseconds kSlice{5};
    const auto end = Clock::now() + time;
    while (Clock::now() < end) {
      for (; waiting_ > 0 && shared_.connecting < kConnecting; --waiting_) {
        const bool decodes =
            decode_every_ > 0 && clients_.size() % static_cast<std::size_t>(decode_every_) == 0;
        clients_.push_back(std::make_unique<OneClient<Stream>>(shared_, clients_.size(), decodes));
        clients_.back()->start();
      }
      shared_.io.restart();
      shared_.io.run_for(kSlice);
    }
  }

  const Seen& seen() const override { return shared_.seen; }

 private:
  Shared shared_;  // outlives the clients: it may still contain their handlers, but never runs them
  const int decode_every_;
  int waiting_ = 0;
  std::vector<std::unique_ptr<OneClient<Stream>>> clients_;
};

}  // namespace

void print_timeline(const Seen& seen) {
  std::printf("| what came | ms | bytes |\n|---|---|---|\n");
  for (const Milestone& one : seen.first_join) {
    std::printf("| %s | %.0f | %zu |\n", one.what.c_str(), one.ms, one.bytes);
  }
}

std::unique_ptr<LightClients> LightClients::make(const Address& address, int decode_every,
                                                 OnLight on_light) {
  if (address.tls) {
    return std::make_unique<Clients<TlsStream>>(address, decode_every, std::move(on_light));
  }
  return std::make_unique<Clients<PlainStream>>(address, decode_every, std::move(on_light));
}

}  // namespace lambent::stream_load
