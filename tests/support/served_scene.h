// SPDX-License-Identifier: Apache-2.0
// A server of a small scene, in this process, and what a client does there.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "lambent/field.h"
#include "lambent/world.h"
#include "scenes/builtin.h"
#include "stream/client/client.h"
#include "stream/picture/h264.h"
#include "stream/server/server.h"

namespace lambent::test {

// What a machine under load needs at most; tests end as soon as what they wait for is there.
inline constexpr std::chrono::seconds kPatience{30};

/// The Cornell box with a spot light, small pictures and few probes, on a free port of loopback.
class ServedScene {
 public:
  explicit ServedScene(const stream::ServerSettings& settings = small_settings(),
                       const std::string& scene = "cornell-spot",
                       const FieldSettings& field = small_field())
      : scene_(*scenes::make(scene)),
        world_(scene_),
        field_(*IrradianceField::make(field, open_bounds(world_))) {
    field_.update(world_);
    auto server = stream::Server::open({scene_, world_, field_, scene_.cameras.front()}, settings);
    if (!server) {
      ADD_FAILURE() << server.error().message();
      return;
    }
    server_ = std::move(*server);
    port_ = server_->port();
    thread_ = std::thread([this] { result_ = server_->run([this] { return stop_.load(); }); });
  }
  ~ServedScene() { stop(); }

  static FieldSettings small_field() {
    FieldSettings settings;
    settings.probe_count = glm::ivec3(3);
    settings.rays_per_probe = 32;
    settings.corrections = false;
    return settings;
  }

  static FieldSettings corrected_field() {
    FieldSettings settings = small_field();
    settings.corrections = true;
    return settings;
  }

  static stream::ServerSettings small_settings() {
    stream::ServerSettings settings;
    settings.listen.port = 0;
    settings.world.rate = 20.0f;
    settings.world.pictures.frame = quality_settings(Quality::draft);
    settings.world.pictures.frame.samples = 1;
    settings.world.pictures.limits.size = {320, 240};
    settings.world.pictures.exposure_stops = 0.0f;
    // However busy this machine is
    settings.world.pictures.limits.picture_ms = 1e9;
    return settings;
  }

  /// Ends the server; whether it ended well.
  bool stop() {
    if (!thread_.joinable()) return true;
    stop_ = true;
    thread_.join();
    return result_.has_value();
  }

  std::uint16_t port() const { return port_; }
  stream::HubStats stats() const { return server_->stats(); }
  const Scene& scene() const { return scene_; }
  stream::ConnectSettings address() const {
    stream::ConnectSettings settings;
    settings.host = "127.0.0.1";
    settings.port = port_;
    return settings;
  }

 private:
  Scene scene_;
  World world_;
  IrradianceField field_;
  std::unique_ptr<stream::Server> server_;
  std::uint16_t port_ = 0;
  std::atomic<bool> stop_ = false;
  Expected<void> result_;
  std::thread thread_;
};

inline stream::Hello small_hello(const std::string& token = "") {
  stream::Hello hello;
  hello.size = {64, 64};
  hello.token = token;
  return hello;
}

/// The next message of a type, others left out; none where the connection ends or nothing comes.
template <class T>
std::optional<T> next(stream::Client& client) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < end) {
    auto message = client.receive(std::chrono::milliseconds(100));
    if (!message) return std::nullopt;
    if (*message && std::holds_alternative<T>(**message)) return std::get<T>(std::move(**message));
  }
  return std::nullopt;
}

/// Reads on until the connection ends; whether it does.
inline bool is_closed(stream::Client& client) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < end) {
    if (!client.receive(std::chrono::milliseconds(100))) return true;
  }
  return false;
}

/// A client that shows what it is sent.
class Watcher {
 public:
  Watcher(const stream::ConnectSettings& address, const stream::Hello& hello)
      : decoder_(*stream::PictureDecoder::make()) {
    auto joined = stream::join(address, hello);
    if (!joined) {
      ADD_FAILURE() << joined.error().message();
      return;
    }
    client_ = std::move(joined->client);
    welcome_ = joined->welcome;
  }

  stream::Client& client() { return *client_; }
  const stream::Welcome& welcome() const { return welcome_; }

  /// The next picture that shows an input, decoded; empty where none comes.
  Image picture(std::uint32_t input = 0) {
    for (;;) {
      const auto picture = next<stream::Picture>(*client_);
      if (!picture) return {};
      Image shown = show(*picture);
      if (shown.empty() || picture->input >= input) return shown;
    }
  }

  /// What the server refuses next; pictures that come before are shown. None where nothing comes.
  std::optional<stream::Refusal> refusal() {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (std::chrono::steady_clock::now() < end) {
      const auto message = client_->receive(std::chrono::milliseconds(100));
      if (!message) return std::nullopt;
      if (!*message) continue;
      if (const auto* refusal = std::get_if<stream::Refusal>(&**message)) return *refusal;
      if (const auto* picture = std::get_if<stream::Picture>(&**message)) show(*picture);
    }
    return std::nullopt;
  }

  /// The update of the world that the last picture showed.
  std::uint64_t state() const { return state_; }

 private:
  /// Decodes a picture, and tells the server; empty where either fails.
  Image show(const stream::Picture& picture) {
    EXPECT_EQ(picture.number, last_ + 1) << "pictures are left out";
    last_ = picture.number;
    const auto decoded = decoder_.decode(picture.bytes);
    if (!decoded) {
      ADD_FAILURE() << decoded.error().message();
      return {};
    }
    if (!client_->send(stream::Received{picture.number, 0.0f})) return {};
    state_ = picture.state;
    return stream::to_display(*decoded);
  }

  stream::PictureDecoder decoder_;
  std::unique_ptr<stream::Client> client_;
  stream::Welcome welcome_;
  std::uint32_t last_ = 0;
  std::uint64_t state_ = 0;
};

}  // namespace lambent::test
