// SPDX-License-Identifier: Apache-2.0
// The one shared world: its light is updated at a steady rate, edits of clients are applied between
// updates, and each client is made pictures of its own camera in what time is left.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lambent/field.h"
#include "lambent/world.h"
#include "stream/edits/edits.h"
#include "stream/server/hub.h"
#include "stream/server/light_sender.h"
#include "stream/server/picture_maker.h"
#include "stream/server/relayed_light.h"

namespace lambent::stream {

struct WorldSettings {
  float rate = 10.0f;  ///< Updates of the light a second, > 0.
  /// Share of an update's interval that it may take, above 0 to 1; the rest is for pictures.
  float update_share = 0.5f;
  bool play = false;  ///< Play the scene's animations, of which there are some, over and over.
  PictureSettings pictures;
  LightEncoderSettings light;  ///< But for the stream, which is drawn anew.
};

/// What is served. All is kept by somebody else, outlives the loop, and is used by nobody else
/// while that runs.
struct ServedWorld {
  Scene& scene;
  World& world;
  IrradianceField& field;
  Camera camera;  ///< Where clients begin.
};

/// The same where another server computes the light.
struct RelayedWorld {
  Scene& scene;  ///< A copy of that server's.
  World& world;
  Upstream& light;
  Camera camera;
};

class WorldLoop {
 public:
  WorldLoop(const ServedWorld& served, const WorldSettings& settings, Hub& hub);
  /// `log` is told where the light's server goes and comes.
  WorldLoop(const RelayedWorld& relayed, const WorldSettings& settings, Hub& hub,
            const std::function<void(const std::string&)>& log);

  /// Runs until `stop` says so, which is asked some ten times a second or more. Fails where the
  /// world cannot go on. Throws std::bad_alloc where memory runs out.
  Expected<void> run(const std::function<bool()>& stop);

 private:
  struct Viewer {
    std::shared_ptr<ClientLink> link;
    std::unique_ptr<PictureMaker> pictures;  // null: asked for none, or waits
    bool waits_for_light = false;            // pictures are made as soon as there is any
    std::optional<CameraInput> camera{};     // of who gets light by regions
    float radius = 0.0f;                     // that it cares about [m]; 0: all
    ClientInputs first_inputs{};             // that came until then
  };
  struct Served {
    Scene& scene;
    World& world;
    IrradianceField* field;  // null: another server has it
    Camera camera;
  };
  WorldLoop(const Served& served, const WorldSettings& settings, Hub& hub);
  const IrradianceField* field() const;
  std::vector<ClientLink*> light_clients() const;
  void tell_applied(ClientLink& link, const ClientInputs& inputs);
  void follow_interest(Viewer& viewer, const ClientInputs& inputs);
  void forward(ClientLink& link, ClientInputs& inputs);
  Expected<void> follow_relayed();
  void welcome();
  std::vector<ClientLink*> meet_clients();
  void greet(std::span<ClientLink* const> newcomers);
  void begin_pictures();
  Expected<void> follow_clients(bool with_edits);
  Expected<void> play();
  void update_light();
  void send_light();
  bool make_pictures();
  void tell_stats(Clock::time_point now);
  Clock::time_point next_work() const;

  Served served_;
  WorldSettings settings_;
  Hub& hub_;
  SceneEditor editor_;
  std::optional<LightSender> light_;  // while it runs, unless it is relayed
  std::optional<RelayedLight> relayed_;
  Upstream* upstream_ = nullptr;  // null: none
  std::vector<Viewer> viewers_;
  std::uint64_t met_ = 0;         // Hub::membership of these
  std::size_t first_viewer_ = 0;  // who is made a picture first: one after the other
  WorldState state_;
  Clock::time_point start_;
  float duration_s_ = 0.0f;  // of the longest animation
  float time_s_ = -1.0f;     // of the animations; below 0: none is played
  Clock::time_point next_update_, next_stats_;
  std::uint64_t updates_since_stats_ = 0;
};

}  // namespace lambent::stream
