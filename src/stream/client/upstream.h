// SPDX-License-Identifier: Apache-2.0
// A connection to the server from which another server gets its light. It is re-established
// whenever it ends.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "stream/client/client.h"
#include "stream/protocol/messages.h"

namespace lambent::stream {

struct UpstreamSettings {
  ConnectSettings connect;
  std::string token;  ///< For the server; empty: none.
  /// Time between attempts to reconnect to a lost server.
  std::chrono::milliseconds retry{250};
  /// Servers send statistics each second; after this time without a message, the connection counts
  /// as lost.
  std::chrono::milliseconds silence{5'000};
};

/// Status of the connection.
struct UpstreamStatus {
  bool connected = false;
  std::uint64_t connections = 0;  ///< So far.
  /// Why it has ended or could not be re-established; empty while there is one.
  std::string lost_because;
};

/// Receives on a thread of its own. All functions may be called from any thread.
class Upstream {
 public:
  /// Joins the server. Fails where that fails the first time.
  static Expected<std::unique_ptr<Upstream>> open(const UpstreamSettings& settings);
  ~Upstream();

  /// The welcome of the first connection.
  const Welcome& welcome() const { return first_welcome_; }
  /// Sets the function that is called whenever messages have arrived; it must not call this object.
  /// Null: none.
  void on_arrival(std::function<void()> wake);
  /// Returns the messages since the last call, in order. Each connection, including the first,
  /// begins with a Welcome.
  std::vector<Message> take();
  /// Queues a message to be sent; it is dropped if there is no connection, or if that accepts
  /// nothing.
  void send(Message message);
  UpstreamStatus status() const;

 private:
  Upstream(const UpstreamSettings& settings, Joined joined);
  void run();
  void follow_connection();
  void reconnect();
  bool send_waiting();
  bool arrived(Message message);
  void lost(const std::string& why);
  bool ending() const;

  const UpstreamSettings settings_;
  const Welcome first_welcome_;

  mutable std::mutex mutex_;
  std::condition_variable ends_;
  bool ending_ = false;
  std::shared_ptr<Client> client_;  // null while there is no connection
  std::deque<Message> waiting_;
  std::vector<Message> arrived_;
  std::size_t arrived_bytes_ = 0;
  std::function<void()> wake_;
  UpstreamStatus status_;
  std::string said_;  // the server's reason for ending the connection

  std::thread thread_;  // last: it uses all others
};

}  // namespace lambent::stream
