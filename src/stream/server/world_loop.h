// SPDX-License-Identifier: Apache-2.0
// The loop of the shared world: it updates the light at a steady rate, applies edits of clients
// between updates, and renders pictures for each client's camera in the remaining time.
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
  float rate = 10.0f;  ///< Updates of the light per second, > 0.
  /// Share of an update's interval that the update may take, above 0 to 1; the rest is for
  /// pictures.
  float update_share = 0.5f;
  bool play = false;  ///< Play the scene's animations in a loop; there must be some.
  PictureSettings pictures;
  LightEncoderSettings light;  ///< The number of the stream is ignored, and chosen at random.
};

/// The served world. The caller owns all of it; it must outlive the loop, and must not be used by
/// others while that runs.
struct ServedWorld {
  Scene& scene;
  World& world;
  IrradianceField& field;
  Camera camera;  ///< Initial camera of clients.
};

/// A world whose light another server computes.
struct RelayedWorld {
  Scene& scene;  ///< A copy of that server's.
  World& world;
  Upstream& light;
  Camera camera;
};

class WorldLoop {
 public:
  WorldLoop(const ServedWorld& served, const WorldSettings& settings, Hub& hub);
  /// `log` is called when the connection to the light's server is lost or restored.
  WorldLoop(const RelayedWorld& relayed, const WorldSettings& settings, Hub& hub,
            const std::function<void(const std::string&)>& log);

  /// Runs until `stop` returns true, which is called at least about ten times a second. Fails where
  /// the world cannot continue. Throws std::bad_alloc where memory runs out.
  Expected<void> run(const std::function<bool()>& stop);

 private:
  struct Viewer {
    std::shared_ptr<ClientLink> link;
    std::unique_ptr<PictureMaker> pictures;  // null: none requested, or no light yet
    bool waits_for_light = false;            // pictures begin with the first light
    std::optional<CameraInput> camera{};     // of clients that get light by regions
    float radius = 0.0f;                     // Interest::radius [m]; 0: all
    ClientInputs first_inputs{};             // inputs received until then
  };
  struct Served {
    Scene& scene;
    World& world;
    IrradianceField* field;  // null: another server computes the light
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
  std::optional<LightSender> light_;  // set while it runs, unless light is relayed
  std::optional<RelayedLight> relayed_;
  Upstream* upstream_ = nullptr;  // null: none
  std::vector<Viewer> viewers_;
  std::uint64_t met_ = 0;                          // Hub::membership of viewers_
  std::size_t first_viewer_ = 0;                   // whose picture is rendered first, in turn
  double ms_a_pixel_ = Pace::kUnmeasuredMsAPixel;  // of the last picture's client
  WorldState state_;
  Clock::time_point start_;
  float duration_s_ = 0.0f;  // duration of the longest animation
  float time_s_ = -1.0f;     // time of the animations; below 0: none is played
  Clock::time_point next_update_, next_stats_;
  std::uint64_t updates_since_stats_ = 0;
};

}  // namespace lambent::stream
