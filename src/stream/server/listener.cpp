// SPDX-License-Identifier: Apache-2.0
#include "stream/server/listener.h"

#include <netinet/tcp.h>

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <exception>
#include <thread>
#include <utility>

#include "stream/server/connections.h"
#include "stream/server/http_connection.h"
#include "stream/transport/host_and_port.h"

namespace lambent::stream {
namespace {

using boost::asio::ip::tcp;
using ErrorCode = boost::system::error_code;

// Interval at which deadlines and tokens are checked.
constexpr std::chrono::milliseconds kTick{250};
// Time for connections to close.
constexpr std::chrono::seconds kDrainTimeout{2};

/// Settings of TLS 1.2 and 1.3, with the certificate of the files.
Expected<std::unique_ptr<boost::asio::ssl::context>> make_tls(const ListenSettings& settings) {
  namespace ssl = boost::asio::ssl;
  auto tls = std::make_unique<ssl::context>(ssl::context::tls_server);
  ErrorCode error;
  tls->set_options(ssl::context::default_workarounds | ssl::context::no_tlsv1 |
                       ssl::context::no_tlsv1_1 | ssl::context::single_dh_use,
                   error);
  if (!error) tls->use_certificate_chain_file(settings.certificate, error);
  if (error) {
    return fail(settings.certificate, "", "is no certificate that can be used: " + error.message());
  }
  tls->use_private_key_file(settings.key, ssl::context::pem, error);
  if (error) {
    return fail(settings.key, "", "is no key of that certificate: " + error.message());
  }
  return tls;
}

Expected<tcp::endpoint> resolve(boost::asio::io_context& io, const ListenSettings& settings) {
  tcp::resolver resolver(io);
  ErrorCode error;
  const auto found =
      resolver.resolve(settings.host, std::to_string(settings.port),
                       tcp::resolver::passive | tcp::resolver::numeric_service, error);
  if (error || found.empty()) {
    return fail("", settings.host, "is no address of this machine: " + error.message());
  }
  return found.begin()->endpoint();
}

Expected<void> listen_at(boost::asio::io_context& io, const ListenSettings& settings,
                         tcp::acceptor& acceptor) {
  const auto endpoint = resolve(io, settings);
  if (!endpoint) return tl::unexpected(endpoint.error());
  ErrorCode error;
  acceptor.open(endpoint->protocol(), error);
  if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor.bind(*endpoint, error);
  if (!error) acceptor.listen(tcp::acceptor::max_listen_connections, error);
  const std::string at = host_and_port(settings.host, settings.port);
  if (error == boost::asio::error::address_in_use) {
    return fail("", at, "the port is in use by another program", Error::Kind::failed);
  }
  if (error) {
    return fail("", at, "cannot be listened at: " + error.message(), Error::Kind::failed);
  }
  return {};
}

/// Limits the system's queue of unsent bytes, so that later messages of higher priority can go
/// first.
void keep_short([[maybe_unused]] tcp::socket& socket) {
#ifdef TCP_NOTSENT_LOWAT
  constexpr int kUnsentBytes = 131'072;  // enough between two polls of the socket at 1 Gbit/s
  ::setsockopt(socket.native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kUnsentBytes,
               sizeof(kUnsentBytes));
#endif
}

class BeastListener : public Listener {
 public:
  BeastListener(const ListenSettings& settings, Hub& hub, Access access)
      : context_(settings, hub, std::move(access)), acceptor_(context_.io), timer_(context_.io) {}

  // If there is no memory to post the end to the thread, terminating the program is the only option
  ~BeastListener() override {  // NOLINT(bugprone-exception-escape)
    if (thread_.joinable()) drain();
  }

  Expected<void> start() {
    if (!context_.settings.certificate.empty()) {
      auto tls = make_tls(context_.settings);
      if (!tls) return tl::unexpected(tls.error());
      context_.tls = std::move(*tls);
    }
    if (!context_.settings.record.empty()) {
      auto session = SessionWriter::create(context_.settings.record);
      if (!session) return tl::unexpected(session.error());
      context_.session.emplace(std::move(*session));
    }
    const auto listening = listen_at(context_.io, context_.settings, acceptor_);
    if (!listening) return listening;
    port_ = acceptor_.local_endpoint().port();
    accept();
    tick();
    thread_ = std::thread([this] { serve(); });
    return {};
  }

  std::uint16_t port() const override { return port_; }

  std::string url() const override {
    const std::string& host = context_.settings.host;
    const std::string name = host == "127.0.0.1" ? "localhost" : host;
    return (context_.tls ? "https://" : "http://") + host_and_port(name, port_) + "/";
  }

  void drain() override {
    boost::asio::post(context_.io, [this] {
      ErrorCode ignored;
      acceptor_.close(ignored);
      ending_ = Clock::now() + kDrainTimeout;
      for (const auto& weak : context_.open_connections) {
        if (const auto connection = weak.lock()) {
          connection->refuse({Refusal::Code::shutting_down, "the server ends"});
        }
      }
    });
    thread_.join();
  }

 private:
  void serve() {
    for (bool done = false; !done;) {
      try {
        context_.io.run();
        done = true;
      } catch (const std::exception& failure) {
        // The failure of one connection, such as lack of memory, must not end the others
        context_.settings.log(std::string("a connection failed: ") + failure.what());
      }
    }
  }

  void accept() {
    acceptor_.async_accept([this](ErrorCode error, tcp::socket socket) {
      if (error == boost::asio::error::operation_aborted || !acceptor_.is_open()) return;
      if (!error) take(std::move(socket));
      accept();
    });
  }

  void take(tcp::socket socket) {
    if (context_.connections >= context_.settings.max_connections) {
      context_.count_refused();
      // The connection that has waited longest without asking for anything gives way
      const bool has_room = std::ranges::any_of(context_.open_connections, [](const auto& weak) {
        const auto connection = weak.lock();
        return connection && connection->give_way();
      });
      if (!has_room) return;  // which closes the socket
    }
    ErrorCode ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    keep_short(socket);
    answer_connection(context_, ByteStream(std::move(socket), context_.tls.get()));
  }

  /// Checks deadlines and tokens, and completes `drain`.
  void tick() {
    std::erase_if(context_.open_connections, [](const auto& weak) { return weak.expired(); });
    if (ending_ && (context_.connections == 0 || Clock::now() > *ending_)) {
      context_.io.stop();
      return;
    }
    if (const auto fresh = context_.access.refresh(); !fresh) {
      context_.settings.log("no token is good now: " + fresh.error().message());
      tokens_lost_ = true;
    } else if (tokens_lost_ && context_.access.has_tokens()) {
      context_.settings.log("the tokens of " + context_.settings.tokens + " are good again");
      tokens_lost_ = false;
    }
    for (const auto& weak : context_.open_connections) {
      if (const auto connection = weak.lock()) connection->tick();
    }
    timer_.expires_after(ending_ ? kTick / 10 : kTick);
    timer_.async_wait([this](ErrorCode error) {
      if (!error) tick();
    });
  }

  ConnectionContext context_;
  tcp::acceptor acceptor_;
  boost::asio::steady_timer timer_;
  std::uint16_t port_ = 0;
  bool tokens_lost_ = false;  // since the file was broken
  std::optional<Clock::time_point> ending_;
  std::thread thread_;
};

}  // namespace

Expected<void> Listener::check(const ListenSettings& settings) {
  if (!settings.certificate.empty()) {
    if (const auto tls = make_tls(settings); !tls) return tl::unexpected(tls.error());
  }
  if (!settings.tokens.empty()) {
    if (const auto access = Access::open(settings.tokens); !access) {
      return tl::unexpected(access.error());
    }
  }
  boost::asio::io_context io;
  tcp::acceptor acceptor(io);
  return listen_at(io, settings, acceptor);
}

Expected<std::unique_ptr<Listener>> Listener::open(const ListenSettings& settings, Hub& hub) {
  if (settings.certificate.empty() != settings.key.empty()) {
    return fail("", "", "a certificate and its key go together");
  }
  if (settings.tokens.empty() && !is_loopback(settings.host)) {
    return fail("", settings.host,
                "can be reached from other machines: a file of tokens is needed there");
  }
  Access access;
  if (!settings.tokens.empty()) {
    Expected<Access> read = Access::open(settings.tokens);
    if (!read) return tl::unexpected(read.error());
    access = std::move(*read);
  }
  auto listener = std::make_unique<BeastListener>(settings, hub, std::move(access));
  if (const auto started = listener->start(); !started) return tl::unexpected(started.error());
  return listener;
}

}  // namespace lambent::stream
