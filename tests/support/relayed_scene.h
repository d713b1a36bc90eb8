// SPDX-License-Identifier: Apache-2.0
// A picture server of ServedScene's scene, in this process, in the light of another server.
#pragma once

#include <memory>
#include <thread>

#include "stream/client/upstream.h"
#include "support/served_scene.h"

namespace lambent::test {

class RelayedScene {
 public:
  /// Gets its light from there.
  explicit RelayedScene(const stream::UpstreamSettings& from,
                        const stream::ServerSettings& settings = ServedScene::small_settings())
      : scene_(*scenes::make("cornell-spot")), world_(scene_) {
    auto upstream = stream::Upstream::open(from);
    if (!upstream) {
      ADD_FAILURE() << upstream.error().message();
      return;
    }
    upstream_ = std::move(*upstream);
    auto server = stream::Server::open(
        stream::RelayedWorld{scene_, world_, *upstream_, scene_.cameras.front()}, settings);
    if (!server) {
      ADD_FAILURE() << server.error().message();
      return;
    }
    server_ = std::move(*server);
    thread_ = std::thread([this] { result_ = server_->run([this] { return stop_.load(); }); });
  }
  explicit RelayedScene(const stream::ConnectSettings& from)
      : RelayedScene(stream::UpstreamSettings{.connect = from, .token = {}}) {}
  ~RelayedScene() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    EXPECT_TRUE(result_);
  }

  // A relay that could not start has no address, and no counts
  stream::HubStats stats() const { return server_ ? server_->stats() : stream::HubStats{}; }
  stream::ConnectSettings address() const {
    stream::ConnectSettings settings;
    settings.host = "127.0.0.1";
    settings.port = server_ ? server_->port() : 0;
    return settings;
  }

 private:
  Scene scene_;
  World world_;
  std::unique_ptr<stream::Upstream> upstream_;
  std::unique_ptr<stream::Server> server_;
  std::atomic<bool> stop_ = false;
  Expected<void> result_;
  std::thread thread_;
};

/// Whether something becomes true in time.
template <class Condition>
bool becomes_true(const Condition& condition) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

}  // namespace lambent::test
