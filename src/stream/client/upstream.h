// SPDX-License-Identifier: Apache-2.0
// A server of light that another server gets its light from: a connection that is made again
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
  /// A server that is lost is looked for again so long after each attempt.
  std::chrono::milliseconds retry{250};
  /// A server tells how it fares each second; one that says nothing for so long is lost.
  std::chrono::milliseconds silence{5'000};
};

/// How the connection fares.
struct UpstreamStatus {
  bool connected = false;
  std::uint64_t connections = 0;  ///< So far.
  std::string lost_because;       ///< Why it ended last, or could not be made again; empty: never.
};

/// Receives on a thread of its own. All functions may be called from any thread.
class Upstream {
 public:
  /// Joins the server. Fails where that fails the first time.
  static Expected<std::unique_ptr<Upstream>> open(const UpstreamSettings& settings);
  ~Upstream();

  /// Of the first connection.
  const Welcome& welcome() const { return first_welcome_; }
  /// `wake` is called whenever there is something to take; it may not call back. Null: nothing is.
  void on_arrival(std::function<void()> wake);
  /// What has come since, in its order; a Welcome where a connection begins, the first included.
  std::vector<Message> take();
  /// To be sent soon; forgotten where there is no connection, or it takes nothing.
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
  std::string said_;  // by the server, of why it ends the connection

  std::thread thread_;  // last: it uses all others
};

}  // namespace lambent::stream
