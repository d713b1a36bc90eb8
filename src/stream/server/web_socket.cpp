// SPDX-License-Identifier: Apache-2.0
#include "stream/server/web_socket.h"

#include <boost/asio/post.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "stream/protocol/hello_header.h"
#include "stream/server/rate_limit.h"

namespace lambent::stream {
namespace {

/// Reads messages of a client, and writes those of its link, one at a time.
class WebSocket : public OpenConnection, public std::enable_shared_from_this<WebSocket> {
 public:
  using ErrorCode = boost::beast::error_code;

  WebSocket(ConnectionContext& context, ByteStream&& stream, ConnectionCount&& count)
      : context_(context),
        count_(std::move(count)),
        socket_(std::move(stream)),
        buffer_(kMaxClientMessageBytes),
        rate_(context.settings.max_message_rate, 2.0 * context.settings.max_message_rate,
              Clock::now()),
        hello_deadline_(Clock::now() + context.settings.hello_timeout) {}

  ~WebSocket() override { leave(); }

  void accept(const WebSocketRequest& request) {
    namespace websocket = boost::beast::websocket;
    context_.open_connections.push_back(weak_from_this());
    // From here on, the WebSocket has its own timeouts
    socket_.next_layer().expires_never();
    websocket::stream_base::timeout timeouts{};
    timeouts.handshake_timeout = context_.settings.hello_timeout;
    timeouts.idle_timeout = context_.settings.idle_timeout;
    timeouts.keep_alive_pings = true;
    socket_.set_option(timeouts);
    socket_.read_message_max(kMaxClientMessageBytes);
    socket_.auto_fragment(false);
    socket_.binary(true);
    const auto hello = request[kHelloField];
    if (!hello.empty()) {
      socket_.set_option(websocket::stream_base::decorator(
          [](websocket::response_type& response) { response.set(kHelloField, kHelloTaken); }));
    }
    // Messages wait until the handshake's answer was sent
    socket_.async_accept(request, [self = shared_from_this()](ErrorCode error) {
      if (error) return self->leave();
      self->open_ = true;
      self->read();
      self->pump();
    });
    if (!hello.empty()) take_header({hello.data(), hello.size()});
  }

  void refuse(Refusal refusal) override {
    if (farewell_ || closing_) return;
    if (refusal.code != Refusal::Code::shutting_down) context_.count_refused();
    // If the client does not read it, the connection is closed at the deadline
    farewell_ = write_message(std::move(refusal));
    close_deadline_ = Clock::now() + kCloseTimeout;
    pump();
  }

  bool give_way() override {
    if (link_ || farewell_ || closing_) return false;
    closing_ = true;
    socket_.next_layer().close();
    return true;
  }

  void tick() override {
    const Clock::time_point now = Clock::now();
    const bool stuck = (writing_since_ && now > *writing_since_ + context_.settings.write_timeout);
    if (stuck || (close_deadline_ && now > *close_deadline_)) {
      socket_.next_layer().close();
      leave();
      return;
    }
    if (!link_ && now > hello_deadline_) {
      refuse({Refusal::Code::bad_message, "a hello was expected"});
    } else if (admission_ && !context_.access.still_good(*admission_, unix_time_s())) {
      refuse({Refusal::Code::bad_token, "the token has expired or was revoked"});
    }
  }

 private:
  static constexpr std::chrono::seconds kCloseTimeout{2};

  void leave() {
    if (!link_) return;
    context_.hub.leave(link_);
    link_.reset();
    context_.record(session_client_, std::nullopt);
  }

  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](ErrorCode error, std::size_t) {
      if (error) {
        if (error == boost::beast::websocket::error::message_too_big)
          self->context_.count_refused();
        self->leave();
        return;
      }
      if (!self->farewell_ && !self->closing_) self->take_message();
      self->buffer_.consume(self->buffer_.size());
      self->read();
    });
  }

  /// Handles a Hello in the request's header.
  void take_header(std::string_view digits) {
    const auto message = read_hello_header(digits);
    if (!message) return refuse({Refusal::Code::bad_message, message.error().message()});
    greet(*message);
  }

  void take_message() {
    const Clock::time_point now = Clock::now();
    if (!rate_.pass(now)) return refuse({Refusal::Code::too_many, "too many messages a second"});
    if (!socket_.got_binary()) {
      return refuse({Refusal::Code::bad_message, "messages are binary"});
    }
    const auto data = buffer_.cdata();
    const auto message =
        parse_message({static_cast<const std::byte*>(data.data()), data.size()}, Sender::client);
    if (!message) return refuse({Refusal::Code::bad_message, message.error().message()});
    if (!link_) return greet(*message);
    if (auto refusal = link_->receive(*message, now, path_time())) {
      refuse(std::move(*refusal));
    } else if (belongs_to_session(*message)) {
      context_.record(session_client_, *message);
    }
  }

  void greet(const Message& message) {
    const Hello* hello = std::get_if<Hello>(&message);
    if (hello == nullptr) return refuse({Refusal::Code::bad_message, "a hello was expected"});
    if (hello->version != kProtocolVersion) {
      return refuse({Refusal::Code::other_version,
                     "this server speaks version " + std::to_string(kProtocolVersion)});
    }
    admission_ = context_.access.admit(hello->token, unix_time_s());
    if (!admission_) return refuse({Refusal::Code::bad_token, "the token is not known here"});
    const Welcome welcome = context_.hub.welcome(admission_->role);
    if ((hello->wants & ~welcome.offers & kWantsTextures) != 0) {
      return refuse({Refusal::Code::bad_message, "this server sends no light through H.265"});
    }
    constexpr std::uint32_t kBothCodecs = kWantsLight | kWantsTextures;
    if ((hello->wants & kBothCodecs) == kBothCodecs) {
      return refuse({Refusal::Code::bad_message, "light is wanted in two codecs"});
    }
    if ((hello->wants & ~welcome.offers) != 0) {
      return refuse({Refusal::Code::bad_message, "this server does not offer what is wanted"});
    }
    Hello kept = *hello;
    kept.token.clear();
    link_ = context_.hub.join(kept, admission_->role, [&io = context_.io, weak = weak_from_this()] {
      boost::asio::post(io, [weak] {
        if (const auto self = weak.lock()) self->pump();
      });
    });
    if (!link_) return refuse({Refusal::Code::too_many, "there are as many clients as may be"});
    link_->put_notice(welcome);
    session_client_ = ++context_.session_clients;
    context_.record(session_client_, kept);
  }

  /// The path time, for clients of pictures, whose pace depends on it.
  std::optional<PathTime> path_time() {
    if (!link_->wants(kWantsPicture)) return std::nullopt;
    return path_time_of(socket_.next_layer().socket().native_handle());
  }

  /// Writes the next message, unless a write is in progress.
  void pump() {
    if (!open_ || writing_since_ || closing_) return;
    if (farewell_) {
      outgoing_ = std::make_shared<const std::vector<std::byte>>(std::move(*farewell_));
      closing_ = true;
    } else if (link_) {
      outgoing_ = link_->next(Clock::now(), path_time());
      if (!outgoing_) return;
    } else {
      return;
    }
    writing_since_ = Clock::now();
    socket_.async_write(
        boost::asio::buffer(*outgoing_),
        [self = shared_from_this()](ErrorCode error, std::size_t) { self->written(error); });
  }

  void written(ErrorCode error) {
    writing_since_.reset();
    if (error) return leave();
    if (!closing_) return pump();
    leave();
    const boost::beast::websocket::close_reason reason(
        boost::beast::websocket::close_code::policy_error);
    socket_.async_close(reason, [self = shared_from_this()](ErrorCode) {});
  }

  ConnectionContext& context_;
  ConnectionCount count_;
  boost::beast::websocket::stream<ByteStream> socket_;
  boost::beast::flat_buffer buffer_;
  RateLimit rate_;
  Clock::time_point hello_deadline_;
  std::optional<Clock::time_point> writing_since_, close_deadline_;
  std::optional<Admission> admission_;
  std::shared_ptr<ClientLink> link_;
  std::uint32_t session_client_ = 0;
  SharedBytes outgoing_;
  std::optional<std::vector<std::byte>> farewell_;
  bool open_ = false, closing_ = false;
};

}  // namespace

void accept_web_socket(ConnectionContext& context, ByteStream&& stream, ConnectionCount&& count,
                       const WebSocketRequest& request) {
  std::make_shared<WebSocket>(context, std::move(stream), std::move(count))->accept(request);
}

}  // namespace lambent::stream
