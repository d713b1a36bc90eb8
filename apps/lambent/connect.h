// SPDX-License-Identifier: Apache-2.0
// The options of `lambent connect`.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "lambent/error.h"
#include "lambent/scene_options.h"
#include "lambent/server_session.h"
#include "lambent/world.h"
#include "stream/client/client.h"

namespace lambent::cli {

struct ConnectOptions {
  stream::ConnectSettings connect;
  std::string server;
  std::string output;
  std::string token_file;
  std::string size = "640x360";
  std::string eye, target;
  float fov_degrees = 45.0f;
  double timeout_s = 10.0;
  float rate = 30.0f;
  int frames = 1;
  SceneOptions scene;  // with an empty scene, the server sends pictures
  std::string quality = "interactive";
  std::string exposure = "auto";
  std::string tone_map = "aces";
  bool layers = false;
  std::string codec = "lambent";  // of light
  float interest = 0.0f;  // radius within which light comes with each update [m]; 0: all light
};

/// The number of the only input that is sent.
inline constexpr std::uint32_t kCameraInput = 1;

/// The path of a frame.
std::string name_of_frame(const ConnectOptions& options, std::size_t frame);

/// A copy of the server's scene, which is opened before the server is joined: a server ends
/// connections that say nothing, and large scenes take long to read.
struct LocalScene {
  OpenedScene opened;
  World world;

  explicit LocalScene(OpenedScene scene) : opened(std::move(scene)), world(opened.scene) {}
};
/// Opens the options' scene.
Expected<std::unique_ptr<LocalScene>> open_local_scene(const ConnectOptions& options);

/// Renders that scene in the light of a server, one picture for each update of the light, until
/// there are enough or there is an interrupt. Opens the scene again where a server has restarted
/// with another camera. `camera` replaces the server's camera.
Expected<void> render_by_stream(const ConnectOptions& options, std::unique_ptr<LocalScene>& local,
                                ServerSession& session,
                                const std::optional<stream::CameraInput>& camera,
                                const InterruptGuard& guard);

}  // namespace lambent::cli
