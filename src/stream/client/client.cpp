// SPDX-License-Identifier: Apache-2.0
#include "stream/client/client.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/error.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <utility>

#include "stream/broker/broker.h"
#include "stream/protocol/hello_header.h"
#include "stream/transport/byte_stream.h"
#include "stream/transport/host_and_port.h"

namespace lambent::stream {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;
using boost::asio::ip::tcp;

/// The parts that outlive the stream.
struct Base {
  boost::asio::io_context io{1};
  boost::asio::ssl::context tls{boost::asio::ssl::context::tls_client};
};

class BeastClient : private Base, public Client {
 public:
  explicit BeastClient(const ConnectSettings& settings)
      : settings_(settings), socket_(ByteStream(tcp::socket(io), settings.tls ? &tls : nullptr)) {}

  Expected<void> open(const std::optional<Hello>& hello) {
    if (settings_.tls) {
      if (const auto trusted = trust(); !trusted) return trusted;
    }
    tcp::resolver resolver(io);
    beast::error_code error;
    const auto found = resolver.resolve(settings_.host, std::to_string(settings_.port), error);
    if (error) return failed("has no address", error);
    ByteStream& stream = socket_.next_layer();
    stream.expires_after(settings_.timeout);
    error = wait([&](auto done) { stream.async_connect(found, done); });
    if (error) return failed("does not answer", error);
    stream.socket().set_option(tcp::no_delay(true), error);
    error = wait([&](auto done) { stream.async_handshake(beast::role_type::client, done); });
    if (settings_.tls && error == boost::asio::ssl::error::stream_truncated) {
      return failed("ends the connection: it may not speak TLS, and want no https://", error,
                    Error::Kind::bad_input);
    }
    if (error == beast::error::timeout) return failed("does not answer", error);
    if (error) return failed("cannot be trusted", error, Error::Kind::bad_input);
    socket_.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
      if (!settings_.origin.empty()) request.set(beast::http::field::origin, settings_.origin);
      if (hello) request.set(kHelloField, hello_header(*hello));
    }));
    socket_.read_message_max(kHeaderBytes + kMaxLightBytes + kMaxPictureBytes);
    socket_.auto_fragment(false);
    websocket::response_type answer;
    error = wait([&](auto done) { socket_.async_handshake(answer, name(), "/stream", done); });
    if (error == beast::http::error::end_of_stream && !settings_.tls) {
      return failed("ends the connection: it may speak TLS alone, and want https://", error,
                    Error::Kind::bad_input);
    }
    if (error) return failed("refused the connection", error);
    stream.expires_never();
    // A server or a proxy may not support the header field
    if (hello && answer[kHelloField] != kHelloTaken) return send(*hello);
    return {};
  }

  Expected<void> send(const Message& message) override {
    return send_bytes(write_message(message), true);
  }

  Expected<void> send_bytes(std::span<const std::byte> bytes, bool binary) override {
    socket_.binary(binary);
    bool written = false;
    beast::error_code result;
    socket_.async_write(boost::asio::buffer(bytes.data(), bytes.size()),
                        [&](beast::error_code error, std::size_t) {
                          result = error;
                          written = true;
                        });
    run_until(written, settings_.timeout);
    if (!written) {
      // The write must not access the bytes after this function has returned
      socket_.next_layer().close();
      run_until(written, settings_.timeout);
      return fail("", name(), "does not read what it is sent", Error::Kind::failed);
    }
    if (result) return failed("has ended the connection", result);
    return {};
  }

  Expected<std::optional<Message>> receive(std::chrono::milliseconds timeout) override {
    if (ended_) return failed("has ended the connection", ended_);
    if (!reading_) {
      reading_ = true;
      arrived_ = false;
      socket_.async_read(buffer_, [this](beast::error_code error, std::size_t) {
        ended_ = error;
        arrived_ = true;
      });
    }
    wait_for_message(timeout);
    if (!arrived_) return std::nullopt;
    reading_ = false;
    if (ended_) return failed("has ended the connection", ended_);
    const auto data = buffer_.cdata();
    auto message =
        parse_message({static_cast<const std::byte*>(data.data()), data.size()}, Sender::server);
    buffer_.consume(buffer_.size());
    if (!message) return tl::unexpected(message.error());
    return std::optional<Message>(std::move(*message));
  }

  void wake() override {
    boost::asio::post(io, [this] { woken_ = true; });
  }

  void close() override {
    if (ended_) return;
    bool closed = false;
    socket_.async_close(websocket::close_code::normal, [&](beast::error_code) { closed = true; });
    run_until(closed, settings_.timeout);
    if (!closed) {
      socket_.next_layer().close();
      run_until(closed, settings_.timeout);
    }
    ended_ = websocket::error::closed;
  }

 private:
  std::string name() const { return host_and_port(settings_.host, settings_.port); }

  tl::unexpected<Error> failed(const char* how, beast::error_code error,
                               Error::Kind kind = Error::Kind::failed) const {
    return fail("", name(), std::string(how) + ": " + error.message(), kind);
  }

  /// Requires a trusted certificate for the host's name.
  Expected<void> trust() {
    beast::error_code error;
    tls.set_default_verify_paths(error);
    if (!settings_.authority.empty()) {
      tls.load_verify_file(settings_.authority, error);
      if (error) return fail(settings_.authority, "", "cannot be read: " + error.message());
    }
    if (!socket_.next_layer().expect_server(settings_.host)) {
      return fail("", settings_.host, "is no name of a host");
    }
    return {};
  }

  void run_until(const bool& done, std::chrono::milliseconds timeout) {
    const auto end = std::chrono::steady_clock::now() + timeout;
    io.restart();
    while (!done && io.run_one_until(end) > 0) {
    }
  }

  /// Like run_until(arrived_), but `wake` ends it.
  void wait_for_message(std::chrono::milliseconds timeout) {
    const auto end = std::chrono::steady_clock::now() + timeout;
    io.restart();
    while (!arrived_ && !woken_ && io.run_one_until(end) > 0) {
    }
    woken_ = false;
  }

  /// Starts an operation that is limited by the stream's timeout, and waits for it.
  template <class Start>
  beast::error_code wait(const Start& start) {
    bool done = false;
    beast::error_code result;
    start([&](beast::error_code error) {
      result = error;
      done = true;
    });
    io.restart();
    while (!done && io.run_one() > 0) {
    }
    return result;
  }

  const ConnectSettings settings_;
  beast::flat_buffer buffer_;
  websocket::stream<ByteStream> socket_;
  bool reading_ = false, arrived_ = false, woken_ = false;
  beast::error_code ended_;
};

}  // namespace

Expected<std::unique_ptr<Client>> Client::connect(const ConnectSettings& settings,
                                                  const std::optional<Hello>& hello) {
  auto client = std::make_unique<BeastClient>(settings);
  if (const auto opened = client->open(hello); !opened) return tl::unexpected(opened.error());
  return client;
}

Expected<Joined> join(const ConnectSettings& settings, const Hello& hello) {
  if (!settings.broker.name.empty()) return join_through_broker(settings, hello);
  auto client = Client::connect(settings, hello);
  if (!client) return tl::unexpected(client.error());
  const auto answer = (*client)->receive(settings.timeout);
  if (!answer) return tl::unexpected(answer.error());
  if (*answer) {
    if (auto* welcome = std::get_if<Welcome>(&**answer))
      return Joined{std::move(*client), *welcome};
    if (auto* refusal = std::get_if<Refusal>(&**answer)) {
      const bool for_now = refusal->code == Refusal::Code::too_many;
      return fail("", host_and_port(settings.host, settings.port), "refuses: " + refusal->text,
                  for_now ? Error::Kind::failed : Error::Kind::bad_input);
    }
  }
  return fail("", host_and_port(settings.host, settings.port),
              "does not answer as a server of lambent's", Error::Kind::failed);
}

}  // namespace lambent::stream
