// SPDX-License-Identifier: Apache-2.0
#include "stream/transport/byte_stream.h"

#include <boost/asio/ssl.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/ssl.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <boost/beast/websocket/teardown.hpp>
#include <type_traits>

namespace lambent::stream {

class ByteStream::Channel {
 public:
  virtual ~Channel() = default;
  virtual boost::beast::tcp_stream& tcp() = 0;
  virtual void read_some(const FirstBuffers<boost::asio::mutable_buffer>& buffers,
                         SomeDone done) = 0;
  virtual void write_some(const FirstBuffers<boost::asio::const_buffer>& buffers,
                          SomeDone done) = 0;
  virtual bool expect_server(const std::string& name) = 0;
  virtual void handshake(boost::beast::role_type role, Done done) = 0;
  virtual void shut_down(Done done) = 0;
  virtual void tear_down(boost::beast::role_type role, Done done) = 0;
};

namespace {

using PlainStream = boost::beast::tcp_stream;
using TlsStream = boost::beast::ssl_stream<PlainStream>;

/// A connection over a PlainStream or a TlsStream.
template <class Stream>
class ChannelOver final : public ByteStream::Channel {
 public:
  static constexpr bool kTls = std::is_same_v<Stream, TlsStream>;
  using Done = ByteStream::Done;
  using SomeDone = ByteStream::SomeDone;

  template <class... Arguments>
  explicit ChannelOver(Arguments&&... arguments) : stream_(std::forward<Arguments>(arguments)...) {}

  PlainStream& tcp() override { return boost::beast::get_lowest_layer(stream_); }

  void read_some(const FirstBuffers<boost::asio::mutable_buffer>& buffers, SomeDone done) override {
    stream_.async_read_some(buffers, std::move(done));
  }

  void write_some(const FirstBuffers<boost::asio::const_buffer>& buffers, SomeDone done) override {
    stream_.async_write_some(buffers, std::move(done));
  }

  bool expect_server([[maybe_unused]] const std::string& name) override {
    if constexpr (kTls) {
      namespace ssl = boost::asio::ssl;
      stream_.set_verify_mode(ssl::verify_peer);
      stream_.set_verify_callback(ssl::host_name_verification(name));
      return SSL_set_tlsext_host_name(stream_.native_handle(), name.c_str()) == 1;
    } else {
      return true;
    }
  }

  void handshake([[maybe_unused]] boost::beast::role_type role, Done done) override {
    if constexpr (kTls) {
      using Handshake = boost::asio::ssl::stream_base;
      const bool serves = role == boost::beast::role_type::server;
      stream_.async_handshake(serves ? Handshake::server : Handshake::client, std::move(done));
    } else {
      done({});
    }
  }

  void shut_down(Done done) override {
    if constexpr (kTls) {
      stream_.async_shutdown(std::move(done));
    } else {
      ByteStream::ErrorCode error;
      stream_.socket().shutdown(ByteStream::Socket::shutdown_send, error);
      done(error);
    }
  }

  void tear_down(boost::beast::role_type role, Done done) override {
    using boost::beast::websocket::async_teardown;
    if constexpr (kTls) {
      async_teardown(role, stream_, std::move(done));
    } else {
      async_teardown(role, stream_.socket(), std::move(done));
    }
  }

 private:
  Stream stream_;
};

}  // namespace

ByteStream::ByteStream(Socket&& socket, boost::asio::ssl::context* tls) {
  if (tls != nullptr) {
    channel_ = std::make_unique<ChannelOver<TlsStream>>(PlainStream(std::move(socket)), *tls);
  } else {
    channel_ = std::make_unique<ChannelOver<PlainStream>>(std::move(socket));
  }
}
ByteStream::ByteStream(ByteStream&&) noexcept = default;
ByteStream::~ByteStream() = default;

ByteStream::executor_type ByteStream::get_executor() const {
  return channel_->tcp().get_executor();
}
ByteStream::Socket& ByteStream::socket() {
  return channel_->tcp().socket();
}
void ByteStream::expires_after(std::chrono::nanoseconds time) {
  channel_->tcp().expires_after(time);
}
void ByteStream::expires_never() {
  channel_->tcp().expires_never();
}
void ByteStream::close() {
  channel_->tcp().close();
}

void ByteStream::async_connect(const boost::asio::ip::tcp::resolver::results_type& addresses,
                               Done done) {
  channel_->tcp().async_connect(
      addresses, [done = std::move(done)](ErrorCode error, const boost::asio::ip::tcp::endpoint&) {
        done(error);
      });
}
bool ByteStream::expect_server(const std::string& name) {
  return channel_->expect_server(name);
}
void ByteStream::async_handshake(boost::beast::role_type role, Done done) {
  channel_->handshake(role, std::move(done));
}
void ByteStream::async_shutdown(Done done) {
  channel_->shut_down(std::move(done));
}
void ByteStream::async_tear_down(boost::beast::role_type role, Done done) {
  channel_->tear_down(role, std::move(done));
}
void ByteStream::read_some(const FirstBuffers<boost::asio::mutable_buffer>& buffers,
                           SomeDone done) {
  channel_->read_some(buffers, std::move(done));
}
void ByteStream::write_some(const FirstBuffers<boost::asio::const_buffer>& buffers, SomeDone done) {
  channel_->write_some(buffers, std::move(done));
}

}  // namespace lambent::stream
