// SPDX-License-Identifier: Apache-2.0
// A connection's bytes, plain or encrypted. Boost.Beast's protocols are templates over the type of
// their stream, and each instance takes about a minute to compile. With this one type for both
// kinds of connection there is one instance. Included only by files that use Boost.Beast.
#pragma once

#include <array>
#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/role.hpp>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

namespace boost::asio::ssl {
class context;
}

namespace lambent::stream {

/// The first buffers of a sequence that are not empty. To read or write *some* bytes may leave the
/// others for the next time.
template <class Buffer>
class FirstBuffers {
 public:
  using value_type = Buffer;
  using const_iterator = const Buffer*;

  template <class Sequence>
  explicit FirstBuffers(const Sequence& sequence) {
    const auto end = boost::asio::buffer_sequence_end(sequence);
    for (auto at = boost::asio::buffer_sequence_begin(sequence);
         at != end && count_ < buffers_.size(); ++at) {
      const Buffer buffer(*at);
      if (buffer.size() > 0) buffers_[count_++] = buffer;
    }
  }

  const_iterator begin() const { return buffers_.data(); }
  const_iterator end() const { return buffers_.data() + count_; }

 private:
  // A WebSocket's frame is a header and its payload, an HTTP answer a few lines and its body.
  std::array<Buffer, 8> buffers_;
  std::size_t count_ = 0;
};

/// A TCP connection with or without TLS: an AsyncStream of Boost.Beast. Its functions are called on
/// the thread of its executor, which also calls the handlers.
class ByteStream {
 public:
  using executor_type = boost::asio::any_io_executor;
  using ErrorCode = boost::system::error_code;
  using Socket = boost::asio::ip::tcp::socket;
  using Done = std::function<void(ErrorCode)>;
  using SomeDone = std::function<void(ErrorCode, std::size_t)>;

  /// `tls` are the settings of an encrypted connection, and must outlive it; null: a plain one.
  ByteStream(Socket&& socket, boost::asio::ssl::context* tls);
  ByteStream(ByteStream&&) noexcept;
  ByteStream& operator=(ByteStream&&) = delete;
  ~ByteStream();

  executor_type get_executor() const;
  Socket& socket();

  /// Closes the socket if what is begun from now on takes longer than `time`.
  void expires_after(std::chrono::nanoseconds time);
  void expires_never();
  /// Closes the socket at once.
  void close();

  /// Connects to the first of the addresses that answers.
  void async_connect(const boost::asio::ip::tcp::resolver::results_type& addresses, Done done);
  /// A client's handshake will ask for the server of this name, and fail where its certificate is
  /// not trusted or not for that name. False where servers cannot be called so. Does nothing
  /// without TLS.
  bool expect_server(const std::string& name);
  /// The handshake of TLS; without TLS `done` is called at once.
  void async_handshake(boost::beast::role_type role, Done done);
  /// Says that nothing more is sent.
  void async_shutdown(Done done);
  /// Ends the connection as WebSocket has it (RFC 6455, 7.1.1).
  void async_tear_down(boost::beast::role_type role, Done done);

  template <class Buffers, class Handler>
  void async_read_some(const Buffers& buffers, Handler&& handler) {
    read_some(FirstBuffers<boost::asio::mutable_buffer>(buffers),
              call_once(std::forward<Handler>(handler)));
  }
  template <class Buffers, class Handler>
  void async_write_some(const Buffers& buffers, Handler&& handler) {
    write_some(FirstBuffers<boost::asio::const_buffer>(buffers),
               call_once(std::forward<Handler>(handler)));
  }

  /// What differs between plain and encrypted connections.
  class Channel;

 private:
  void read_some(const FirstBuffers<boost::asio::mutable_buffer>& buffers, SomeDone done);
  void write_some(const FirstBuffers<boost::asio::const_buffer>& buffers, SomeDone done);

  /// A copyable function that calls `handler`, which need not be, once.
  template <class Handler>
  static auto call_once(Handler&& handler) {
    return [kept = std::make_shared<std::decay_t<Handler>>(std::forward<Handler>(handler))](
               auto... results) {
      // What the handler holds is freed before it is called: it may begin the next operation
      auto called = std::move(*kept);
      called(results...);
    };
  }

  std::unique_ptr<Channel> channel_;

  // What Boost.Beast's WebSocket asks of its stream, found by the stream's namespace
  template <class Handler>
  friend void async_teardown(boost::beast::role_type role, ByteStream& stream, Handler&& handler) {
    stream.async_tear_down(role, call_once(std::forward<Handler>(handler)));
  }
  friend void beast_close_socket(ByteStream& stream) { stream.close(); }
};

}  // namespace lambent::stream
