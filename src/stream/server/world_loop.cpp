// SPDX-License-Identifier: Apache-2.0
#include "stream/server/world_loop.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/stopwatch.h"
#include "stream/textures/h265.h"

namespace lambent::stream {
namespace {

// Relative change of light in an update that counts as visible, as in settle_field.
constexpr double kSeenChange = 0.002;
// Longest wait between two calls of `stop`.
constexpr std::chrono::milliseconds kLongestWait{50};
constexpr std::chrono::seconds kStatsInterval{1};

}  // namespace

WorldLoop::WorldLoop(const ServedWorld& served, const WorldSettings& settings, Hub& hub)
    : WorldLoop(Served{served.scene, served.world, &served.field, served.camera}, settings, hub) {}

WorldLoop::WorldLoop(const RelayedWorld& relayed, const WorldSettings& settings, Hub& hub,
                     const std::function<void(const std::string&)>& log)
    : WorldLoop(Served{relayed.scene, relayed.world, nullptr, relayed.camera}, settings, hub) {
  upstream_ = &relayed.light;
  relayed_.emplace(relayed.scene, relayed.world, relayed.light, log);
}

WorldLoop::WorldLoop(const Served& served, const WorldSettings& settings, Hub& hub)
    : served_(served), settings_(settings), hub_(hub), editor_(served.scene, served.world) {
  for (const Animation& animation : served.scene.animations) {
    duration_s_ = std::max(duration_s_, duration(animation));
  }
  welcome();
}

/// The field for pictures; null if there is no light yet.
const IrradianceField* WorldLoop::field() const {
  return relayed_ ? relayed_->field() : served_.field;
}

std::vector<ClientLink*> WorldLoop::light_clients() const {
  std::vector<ClientLink*> clients;
  for (const Viewer& viewer : viewers_) {
    if (viewer.link->wants_light()) clients.push_back(viewer.link.get());
  }
  return clients;
}

void WorldLoop::welcome() {
  Welcome told;
  told.offers = kWantsPicture | kWantsLight;
  if (!upstream_ && has_h265()) told.offers |= kWantsTextures;
  told.max_size = settings_.pictures.limits.size;
  told.rate = settings_.rate;
  told.camera = input_of(served_.camera);
  const Bounds bounds = world_bounds(served_.scene);
  told.min_ws = bounds.min;
  told.max_ws = bounds.max;
  told.instances = static_cast<std::uint32_t>(served_.scene.instances.size());
  for (const Light& light : served_.scene.lights) {
    if (told.lights.size() == kMaxToldLights) break;
    told.lights.push_back({light.type, light.intensity, light.position_ws, light.direction_ws});
  }
  hub_.set_welcome(told);
}

/// Adds new clients, and removes those that have left. Returns the new ones.
std::vector<ClientLink*> WorldLoop::meet_clients() {
  std::vector<ClientLink*> newcomers;
  const std::uint64_t membership = hub_.membership();
  if (membership == met_) return newcomers;
  met_ = membership;
  std::erase_if(viewers_, [](const Viewer& viewer) { return viewer.link->gone(); });
  for (const auto& link : hub_.clients()) {
    const bool known = std::any_of(viewers_.begin(), viewers_.end(),
                                   [&](const Viewer& viewer) { return viewer.link == link; });
    if (known || link->gone()) continue;
    viewers_.push_back({link, nullptr, link->wants(kWantsPicture)});
    newcomers.push_back(link.get());
    // Clear data of an earlier client at the same address
    (relayed_ ? relayed_->regions() : light_->regions()).set_surroundings(*link, std::nullopt);
  }
  return newcomers;
}

/// Sends newcomers the current light, even if an update is due, which would take longer.
void WorldLoop::greet(std::span<ClientLink* const> newcomers) {
  if (newcomers.empty() || relayed_) return;
  const auto sent = light_->greet(*served_.field, time_s_, newcomers);
  hub_.edit_stats([&](HubStats& stats) { stats.light_bytes = light_->bytes_sent(); });
  if (sent) return;
  for (ClientLink* client : newcomers) {
    client->put_notice(Refusal{Refusal::Code::failed, sent.error().message()});
  }
}

/// Starts the pictures of clients that waited for the first light.
void WorldLoop::begin_pictures() {
  if (field() == nullptr) return;
  for (Viewer& viewer : viewers_) {
    if (!std::exchange(viewer.waits_for_light, false)) continue;
    viewer.pictures =
        std::make_unique<PictureMaker>(served_.world, *field(), settings_.pictures, served_.camera,
                                       viewer.link->hello(), ms_a_pixel_);
    viewer.pictures->follow(viewer.first_inputs);
  }
}

/// Updates the surroundings of a client that gets light by regions.
void WorldLoop::follow_interest(Viewer& viewer, const ClientInputs& inputs) {
  if (inputs.camera) viewer.camera = inputs.camera;
  if (inputs.interest) viewer.radius = inputs.interest->radius;
  if (!viewer.link->wants(kWantsLight) || (!inputs.camera && !inputs.interest)) return;
  RegionSender& regions = relayed_ ? relayed_->regions() : light_->regions();
  if (viewer.radius <= 0.0f) return regions.set_surroundings(*viewer.link, std::nullopt);
  const Camera camera = viewer.camera ? camera_of(*viewer.camera) : served_.camera;
  // Pictures are less than twice as wide as high, so that this cone contains their corners
  constexpr float kOfHeight = 2.3f;
  Surroundings where;
  where.position_ws = glm::vec3(camera.world_from_view[3]);
  where.forward_ws = -glm::normalize(glm::vec3(camera.world_from_view[2]));
  where.half_view = std::atan(kOfHeight * std::tan(0.5f * camera.vertical_fov));
  where.radius = viewer.radius;
  regions.set_surroundings(*viewer.link, where);
}

/// Forwards a client's edits to the server that computes the light, and sets which of its inputs
/// pictures show.
void WorldLoop::forward(ClientLink& link, ClientInputs& inputs) {
  const auto shared = link.shared_from_this();
  if (const auto refusal = relayed_->forward(inputs.edits, shared)) {
    link.put_notice(*refusal);
    tell_applied(link, inputs);
  }
  inputs.last_input = relayed_->shown(link, inputs.last_input);
}

/// Tells a client of light that its edits have been applied or refused.
void WorldLoop::tell_applied(ClientLink& link, const ClientInputs& inputs) {
  if (inputs.edits.empty() || inputs.last_input == 0 || !link.wants_light()) return;
  const std::uint64_t next = relayed_ ? relayed_->update() : light_->next_update(link);
  link.put_notice(InputsApplied{inputs.last_input, next});
}

/// Applies the inputs of clients. With `with_edits`, also their edits of the shared world, right
/// before its update.
Expected<void> WorldLoop::follow_clients(bool with_edits) {
  std::vector<Edit> edits;
  std::vector<ClientLink*> senders;
  std::vector<std::pair<ClientLink*, ClientInputs>> edited;
  for (Viewer& viewer : viewers_) {
    ClientInputs inputs = viewer.link->take_inputs(with_edits || relayed_.has_value());
    follow_interest(viewer, inputs);
    if (relayed_) forward(*viewer.link, inputs);
    if (viewer.pictures) viewer.pictures->follow(inputs);
    if (viewer.waits_for_light) {
      if (inputs.camera) viewer.first_inputs.camera = inputs.camera;
      if (inputs.request) viewer.first_inputs.request = inputs.request;
    }
    if (relayed_) continue;
    if (!inputs.edits.empty()) edited.emplace_back(viewer.link.get(), inputs);
    edits.insert(edits.end(), inputs.edits.begin(), inputs.edits.end());
    senders.resize(edits.size(), viewer.link.get());
  }
  if (edits.empty()) return {};
  const auto refused = editor_.apply(edits);
  if (!refused) return tl::unexpected(refused.error());
  std::vector<bool> accepted(edits.size(), true);
  for (const SceneEditor::Refused& one : *refused) {
    accepted[one.edit] = false;
    std::string why = one.why.substr(0, kMaxErrorBytes);
    senders[one.edit]->put_notice(Refusal{Refusal::Code::refused_input, std::move(why)});
  }
  for (std::size_t i = 0; i < edits.size(); ++i) {
    if (accepted[i]) light_->add_edit(edits[i]);
  }
  for (const auto& [link, inputs] : edited) tell_applied(*link, inputs);
  if (refused->size() == edits.size()) return {};
  welcome();
  state_.last_change = state_.updates + 1;
  return {};
}

/// Poses the scene at the current time of its animations, which restart when the longest has ended.
Expected<void> WorldLoop::play() {
  if (!settings_.play) return {};
  const double now_s = std::chrono::duration<double>(Clock::now() - start_).count();
  const auto period_s = static_cast<double>(duration_s_);
  time_s_ = static_cast<float>(period_s > 0.0 ? std::fmod(now_s, period_s) : now_s);
  animate(served_.scene, -1, time_s_);
  const auto moved = served_.world.update();
  if (!moved) return tl::unexpected(moved.error());
  if (moved->any()) state_.last_change = state_.updates + 1;
  return {};
}

void WorldLoop::update_light() {
  constexpr double kMsOfSecond = 1000.0;
  const double interval_ms = kMsOfSecond / static_cast<double>(settings_.rate);
  UpdateRequest request;
  request.time_budget_ms = interval_ms * static_cast<double>(settings_.update_share);
  request.viewer_ws = glm::vec3(served_.camera.world_from_view[3]);
  Stopwatch watch;
  const UpdateStatistics done = served_.field->update(served_.world, request);
  const double update_ms = watch.lap();
  ++state_.updates;
  ++updates_since_stats_;
  if (done.change > kSeenChange) state_.last_change = state_.updates;
  hub_.edit_stats([&](HubStats& stats) {
    stats.state = state_.updates;
    stats.update_ms = update_ms;
    stats.probes_stale = done.probes_stale;
  });
  // Missed updates are skipped
  const auto interval = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double, std::milli>(interval_ms));
  next_update_ = std::max(next_update_ + interval, Clock::now());
}

/// Sends the updated light to clients of light.
void WorldLoop::send_light() {
  const std::vector<ClientLink*> clients = light_clients();
  const auto sent = light_->send(*served_.field, time_s_, clients);
  hub_.edit_stats([&](HubStats& stats) { stats.light_bytes = light_->bytes_sent(); });
  if (sent) return;
  for (ClientLink* client : clients) {
    client->put_notice(Refusal{Refusal::Code::failed, sent.error().message()});
  }
}

/// Applies the light that was received from its server.
Expected<void> WorldLoop::follow_relayed() {
  Stopwatch watch;
  const auto followed = relayed_->follow(light_clients());
  if (!followed) return tl::unexpected(followed.error());
  const double took_ms = watch.lap();
  if (followed->moved) welcome();
  if (followed->moved || followed->change > kSeenChange) ++state_.last_change;
  state_.updates = relayed_->update();
  updates_since_stats_ += followed->updates;
  const UpstreamStatus status = upstream_->status();
  hub_.edit_stats([&](HubStats& stats) {
    stats.state = state_.updates;
    stats.light_bytes = relayed_->bytes_sent();
    if (followed->updates > 0) stats.update_ms = took_ms;
    stats.light_from = LightFrom{status.connected, status.connections, status.lost_because};
  });
  return {};
}

/// Renders one picture for each client that is due and keeps up, until an update is due. Returns
/// whether there was any.
bool WorldLoop::make_pictures() {
  bool any = false;
  for (std::size_t i = 0; i < viewers_.size(); ++i) {
    const Clock::time_point now = Clock::now();
    if (any && !relayed_ && now >= next_update_) return any;
    const std::size_t index = (first_viewer_ + i) % viewers_.size();
    Viewer& viewer = viewers_[index];
    if (!viewer.pictures || !viewer.link->ready_for_picture()) continue;
    const auto due = viewer.pictures->due(state_);
    if (!due || *due > now) continue;
    const auto picture = viewer.pictures->make(state_, now);
    if (!picture) {
      viewer.link->put_notice(Refusal{Refusal::Code::failed, picture.error().message()});
      viewer.pictures.reset();
    } else if (*picture) {
      ms_a_pixel_ = viewer.pictures->pace().ms_a_pixel();
      viewer.link->put_picture(**picture);
      hub_.edit_stats([&](HubStats& stats) {
        ++stats.pictures;
        stats.picture_ms =
            static_cast<double>((*picture)->render_ms) + static_cast<double>((*picture)->encode_ms);
      });
    }
    any = true;
    first_viewer_ = index + 1;
  }
  return any;
}

void WorldLoop::tell_stats(Clock::time_point now) {
  if (now < next_stats_) return;
  const std::chrono::duration<double> since = now - (next_stats_ - kStatsInterval);
  const double rate = static_cast<double>(std::exchange(updates_since_stats_, 0)) / since.count();
  next_stats_ = now + kStatsInterval;
  hub_.edit_stats([&](HubStats& stats) { stats.rate = rate; });
  const HubStats stats = hub_.stats();
  for (const Viewer& viewer : viewers_) {
    ServerStats told;
    told.state = stats.state;
    told.update_ms = static_cast<float>(stats.update_ms);
    told.rate = static_cast<float>(stats.rate);
    told.clients = static_cast<std::uint32_t>(viewers_.size());
    if (viewer.pictures) {
      told.bitrate = viewer.pictures->pace().bitrate();
      told.round_trip_ms = static_cast<float>(viewer.pictures->pace().round_trip_ms());
    }
    viewer.link->put_notice(told);
  }
}

/// Time of the next work, unless a client sends something before.
Clock::time_point WorldLoop::next_work() const {
  Clock::time_point next = Clock::now() + kLongestWait;
  if (!relayed_) next = std::min(next, next_update_);
  for (const Viewer& viewer : viewers_) {
    if (!viewer.pictures || !viewer.link->ready_for_picture()) continue;
    if (const auto due = viewer.pictures->due(state_)) next = std::min(next, *due);
  }
  return next;
}

Expected<void> WorldLoop::run(const std::function<bool()>& stop) {
  if (!relayed_) {
    auto light = LightSender::make(settings_.light);
    if (!light) return tl::unexpected(light.error());
    light_.emplace(std::move(*light));
  }
  start_ = next_update_ = Clock::now();
  next_stats_ = next_update_ + kStatsInterval;
  while (!stop()) {
    greet(meet_clients());
    begin_pictures();
    if (relayed_) {
      if (const auto done = follow_relayed(); !done) return done;
    }
    const bool update_is_due = !relayed_ && Clock::now() >= next_update_;
    if (const auto done = follow_clients(update_is_due); !done) return done;
    if (update_is_due) {
      if (const auto done = play(); !done) return done;
      update_light();
      send_light();
    }
    const bool busy = make_pictures();
    tell_stats(Clock::now());
    if (!busy) hub_.wait_until(next_work());
  }
  return {};
}

}  // namespace lambent::stream
