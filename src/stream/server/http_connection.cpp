// SPDX-License-Identifier: Apache-2.0
#include "stream/server/http_connection.h"

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "stream/server/responses.h"
#include "stream/server/web_socket.h"

namespace lambent::stream {

namespace {

/// Reads the first request of a connection and answers it. Pending operations own the object.
class HttpConnection : public OpenConnection, public std::enable_shared_from_this<HttpConnection> {
 public:
  using ErrorCode = boost::beast::error_code;

  HttpConnection(ConnectionContext& context, ByteStream&& stream)
      : context_(context), count_(context), stream_(std::move(stream)), buffer_(kMaxHeaderBytes) {}

  void start() {
    context_.open_connections.push_back(weak_from_this());
    stream_.expires_after(context_.settings.hello_timeout);
    stream_.async_handshake(boost::beast::role_type::server,
                            [self = shared_from_this()](ErrorCode error) {
                              if (!error) self->read();
                            });
  }

  void refuse(Refusal /*refusal*/) override { give_way(); }

  bool give_way() override {
    if (!std::exchange(waits_, false)) return false;
    stream_.close();
    return true;
  }

  void tick() override {}

 private:
  // Largest request line with headers [bytes].
  static constexpr std::uint32_t kMaxHeaderBytes = 8192;
  // Slower readers of an answer are disconnected: 1 Mbit/s.
  static constexpr std::size_t kLeastBytesPerSecond = 125'000;

  std::string_view header(boost::beast::http::field name) const {
    const auto value = parser_.get()[name];
    return {value.data(), value.size()};
  }

  void read() {
    parser_.header_limit(kMaxHeaderBytes);
    parser_.body_limit(std::uint64_t{0});
    boost::beast::http::async_read(
        stream_, buffer_, parser_, [self = shared_from_this()](ErrorCode error, std::size_t) {
          if (!error) {
            self->answer();
          } else if (self->waits_ && error != boost::beast::http::error::end_of_stream) {
            self->context_.count_refused();
          }
        });
  }

  void answer() {
    namespace http = boost::beast::http;
    waits_ = false;
    const auto& request = parser_.get();
    const std::string_view host = header(http::field::host);
    if (!context_.hosts.may_be_asked_as(host)) {
      return respond({.status = 421, .body = "This server does not go by that name.\n"});
    }
    const std::string_view target(request.target().data(), request.target().size());
    if (boost::beast::websocket::is_upgrade(request) && target == kStreamTarget) {
      if (!context_.hosts.may_connect(header(http::field::origin), host, context_.tls != nullptr)) {
        return respond({.status = 403, .body = "Pages from elsewhere may not connect.\n"});
      }
      return accept_web_socket(context_, std::move(stream_), std::move(count_), request);
    }
    const std::string_view token = bearer_token(header(http::field::authorization));
    const bool authorized = context_.access.admit(token, unix_time_s()).has_value();
    const auto method = request.method_string();
    respond(respond_to({method.data(), method.size()}, target, authorized, context_.hub,
                       context_.settings.scene.get()));
  }

  void respond(Response response) {
    namespace http = boost::beast::http;
    if (response.status == 421 || response.status == 403) context_.count_refused();
    answer_.result(response.status);
    answer_.version(11);
    answer_.keep_alive(false);
    answer_.set(http::field::content_type, {response.type.data(), response.type.size()});
    if (!response.header.empty()) {
      answer_.set({response.header.data(), response.header.size()},
                  {response.header_value.data(), response.header_value.size()});
    }
    answer_.set(http::field::cache_control, "no-store");
    answer_.set("Content-Security-Policy",
                "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; "
                "connect-src 'self' blob:; img-src blob:; "
                "base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
    answer_.set("X-Content-Type-Options", "nosniff");
    answer_.set("Referrer-Policy", "no-referrer");
    body_ = std::move(response.body);
    const std::string_view bytes = response.kept.empty() ? body_ : response.kept;
    answer_.body() = {bytes.data(), bytes.size()};
    answer_.prepare_payload();
    if (parser_.get().method() == http::verb::head) answer_.body() = {};
    const std::chrono::seconds slowest(bytes.size() / kLeastBytesPerSecond);
    stream_.expires_after(context_.settings.hello_timeout + slowest);
    http::async_write(stream_, answer_, [self = shared_from_this()](ErrorCode error, std::size_t) {
      if (!error) self->end();
    });
  }

  void end() {
    stream_.async_shutdown([self = shared_from_this()](ErrorCode) {});
  }

  ConnectionContext& context_;
  ConnectionCount count_;
  ByteStream stream_;
  boost::beast::flat_buffer buffer_;
  boost::beast::http::request_parser<boost::beast::http::empty_body> parser_;
  bool waits_ = true;  // for the request
  std::string body_;   // body of an answer that does not refer to the server's data
  boost::beast::http::response<boost::beast::http::span_body<const char>> answer_;
};

}  // namespace

void answer_connection(ConnectionContext& context, ByteStream&& stream) {
  std::make_shared<HttpConnection>(context, std::move(stream))->start();
}

}  // namespace lambent::stream
