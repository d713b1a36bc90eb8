// SPDX-License-Identifier: Apache-2.0
#include "lambent/world.h"

#include <deque>
#include <stdexcept>
#include <utility>

#include "core/stopwatch.h"
#include "raytracing/light_visibility/learn_light_visibility.h"
#include "raytracing/motion/scene_pose.h"
#include "raytracing/raytracer.h"
#include "raytracing/scene_snapshot.h"
#include "raytracing/world_access.h"
#include "scene/light_sampling.h"
#include "scene/light_tree/light_tree.h"
#include "scene/sky/sky_levels.h"
#if LAMBENT_VULKAN
#include "raytracing/vulkan/device_world.h"
#endif

namespace lambent {
namespace {

#if LAMBENT_VULKAN

std::shared_ptr<DeviceWorld> make_device_world(const Scene& scene,
                                               const EmissiveTriangles& emissive,
                                               const LightTree& lights,
                                               std::shared_ptr<vulkan::Device> device) {
  if (device == nullptr) return nullptr;
  return std::make_shared<DeviceWorld>(scene, emissive, lights, std::move(device));
}

std::shared_ptr<RayTracer> shared_tracer(const std::shared_ptr<DeviceWorld>& world) {
  return {world, &world->tracer()};
}

std::shared_ptr<vulkan::Device> shared_device(const DeviceWorld& world) {
  return world.shared_device();
}

void update_tracer(DeviceWorld* on_device, RayTracer& tracer, const SceneEdits& edits,
                   const EmissiveTriangles& emissive, const LightTree& lights) {
  if (on_device != nullptr) {
    on_device->update(edits, emissive, lights);
  } else if (edits.geometry_differs) {
    tracer.update(edits.geometry);
  }
}

void upload_visibility(DeviceWorld* on_device, const LightTree& lights) {
  if (on_device != nullptr) on_device->update_light_visibility(lights.visibility());
}

#else

// Without Vulkan, no device can be opened
std::shared_ptr<DeviceWorld> make_device_world(const Scene&, const EmissiveTriangles&,
                                               const LightTree&, std::shared_ptr<vulkan::Device>) {
  return nullptr;
}
std::shared_ptr<RayTracer> shared_tracer(const std::shared_ptr<DeviceWorld>&) {
  return nullptr;
}
std::shared_ptr<vulkan::Device> shared_device(const DeviceWorld&) {
  return nullptr;
}
void update_tracer(DeviceWorld*, RayTracer& tracer, const SceneEdits& edits,
                   const EmissiveTriangles&, const LightTree&) {
  if (edits.geometry_differs) tracer.update(edits.geometry);
}
void upload_visibility(DeviceWorld*, const LightTree&) {}

#endif

}  // namespace

struct World::State::History {
  SceneSnapshot snapshot;
  std::uint64_t revision = 0;
  std::deque<WorldChanges> log;  // the most recent changes
};

World::State::State(const Scene& scene, std::shared_ptr<vulkan::Device> lent)
    : emissive(std::make_unique<EmissiveTriangles>(scene)),
      lights(std::make_unique<LightTree>(scene, *emissive)),
      sky(std::make_unique<SkyLevels>(scene.environment)),
      on_device(make_device_world(scene, *emissive, *lights, std::move(lent))),
      tracer(on_device != nullptr ? shared_tracer(on_device) : make_embree_raytracer(scene)),
      history(std::make_unique<History>()),
      pose(first_pose(scene)) {
  history->snapshot = take_snapshot(scene, nullptr);
}

World::State::~State() = default;

void World::State::set_light_visibility(LightVisibility visibility) {
  lights->set_visibility(std::move(visibility));
  upload_visibility(on_device.get(), *lights);
}

void World::State::follow_light_visibility(const World& world, const SceneEdits& edits,
                                           int builds_before) {
  if (lights->builds() != builds_before) {
    set_light_visibility(learn_of_new_lights(world));
    return;
  }
  const WorldChanges& changes = edits.changes;
  const bool differs =
      edits.geometry_differs || !changes.lights.empty() || !changes.materials.empty();
  if (!differs || lights->visibility().empty()) return;
  LightVisibility visibility = lights->visibility();
  renew_light_visibility(world, visibility);
  set_light_visibility(std::move(visibility));
}

World::World(const Scene& scene, std::shared_ptr<vulkan::Device> device) : scene_(&scene) {
  if (const Expected<void> fine = validate(scene); !fine) {
    throw std::invalid_argument(fine.error().message());
  }
  state_ = std::make_unique<State>(scene, std::move(device));
  state_->set_light_visibility(learn_light_visibility(*this));
}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

Expected<WorldChanges> World::update() {
  Stopwatch watch;
  State::History& history = *state_->history;
  if (Expected<void> fine = validate_edits(*scene_, history.snapshot); !fine) {
    return tl::unexpected(std::move(fine).error());
  }
  SceneSnapshot now = take_snapshot(*scene_, &history.snapshot);
  SceneEdits edits = compare(history.snapshot, now);
  if (edits.emitters_differ) state_->emissive = std::make_unique<EmissiveTriangles>(*scene_);
  const int builds = state_->lights->builds();
  if (edits.emitters_differ || !edits.changes.lights.empty()) {
    state_->lights->update(*scene_, *state_->emissive);
  }
  state_->sky->update();
  update_tracer(state_->on_device.get(), *state_->tracer, edits, *state_->emissive,
                *state_->lights);
  if (edits.geometry_differs) {
    state_->pose = next_pose(*scene_, edits.geometry, *state_->pose);
  }
  history.snapshot = std::move(now);

  edits.changes.revision = history.revision;
  if (!edits.changes.any()) return std::move(edits.changes);
  edits.changes.revision = ++history.revision;
  state_->follow_light_visibility(*this, edits, builds);
  edits.changes.refit_ms = watch.lap();
  if (history.log.size() == kLogLength) history.log.pop_front();
  history.log.push_back(edits.changes);
  return std::move(edits.changes);
}

std::uint64_t World::revision() const {
  return state_->history->revision;
}

std::optional<std::vector<WorldChanges>> World::changes_since(std::uint64_t revision) const {
  const State::History& history = *state_->history;
  if (revision > history.revision) return std::nullopt;
  const std::uint64_t missed = history.revision - revision;
  if (missed > history.log.size()) return std::nullopt;
  return std::vector<WorldChanges>(history.log.end() - static_cast<std::ptrdiff_t>(missed),
                                   history.log.end());
}

Bounds World::instance_bounds(int instance) const {
  const SceneSnapshot& snapshot = state_->history->snapshot;
  return world_box(snapshot, snapshot.placements[instance]);
}

std::shared_ptr<vulkan::Device> World::device() const {
  return state_->on_device != nullptr ? shared_device(*state_->on_device) : nullptr;
}

double World::build_ms() const {
  return tracer_of(*this).statistics().build_ms;
}
std::size_t World::bytes() const {
  return tracer_of(*this).statistics().bytes;
}
double World::refit_ms() const {
  return tracer_of(*this).statistics().refit_ms;
}

}  // namespace lambent
