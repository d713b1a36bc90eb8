// SPDX-License-Identifier: Apache-2.0
#include "lambent/world.h"

#include <cassert>
#include <deque>
#include <utility>

#include "core/stopwatch.h"
#include "raytracing/raytracer.h"
#include "raytracing/scene_snapshot.h"
#include "scene/light_sampling.h"
#if LAMBENT_VULKAN
#include "raytracing/vulkan/device_world.h"
#endif

namespace lambent {
namespace {

#if LAMBENT_VULKAN

std::shared_ptr<DeviceWorld> make_device_world(const Scene& scene,
                                               const EmissiveTriangles& emissive,
                                               std::shared_ptr<vulkan::Device> device) {
  if (device == nullptr) return nullptr;
  return std::make_shared<DeviceWorld>(scene, emissive, std::move(device));
}

std::shared_ptr<RayTracer> tracer_of(const std::shared_ptr<DeviceWorld>& world) {
  return {world, &world->tracer()};
}

void update_tracer(DeviceWorld* on_device, RayTracer& tracer, const SceneEdits& edits,
                   const EmissiveTriangles& emissive) {
  if (on_device != nullptr) {
    on_device->update(edits, emissive);
  } else if (edits.geometry_differs) {
    tracer.update(edits.geometry);
  }
}

#else

// No device can be opened then
std::shared_ptr<DeviceWorld> make_device_world(const Scene&, const EmissiveTriangles&,
                                               std::shared_ptr<vulkan::Device>) {
  return nullptr;
}
std::shared_ptr<RayTracer> tracer_of(const std::shared_ptr<DeviceWorld>&) {
  return nullptr;
}
void update_tracer(DeviceWorld*, RayTracer& tracer, const SceneEdits& edits,
                   const EmissiveTriangles&) {
  if (edits.geometry_differs) tracer.update(edits.geometry);
}

#endif

}  // namespace

struct World::History {
  SceneSnapshot snapshot;
  std::uint64_t revision = 0;
  std::deque<WorldChanges> log;  // the last of them
};

World::World(const Scene& scene, std::shared_ptr<vulkan::Device> device)
    : scene_(&scene),
      emissive_(std::make_unique<EmissiveTriangles>(scene)),
      device_(make_device_world(scene, *emissive_, std::move(device))),
      tracer_(device_ != nullptr ? tracer_of(device_) : make_embree_raytracer(scene)),
      history_(std::make_unique<History>()) {
  assert(validate(scene));
  history_->snapshot = take_snapshot(scene, nullptr);
}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

Expected<WorldChanges> World::update() {
  Stopwatch watch;
  History& history = *history_;
  if (Expected<void> fine = validate_edits(*scene_, history.snapshot); !fine) {
    return tl::unexpected(std::move(fine).error());
  }
  SceneSnapshot now = take_snapshot(*scene_, &history.snapshot);
  SceneEdits edits = compare(history.snapshot, now);
  if (edits.emitters_differ) emissive_ = std::make_unique<EmissiveTriangles>(*scene_);
  update_tracer(device_.get(), *tracer_, edits, *emissive_);
  history.snapshot = std::move(now);

  edits.changes.revision = history.revision;
  if (!edits.changes.any()) return std::move(edits.changes);
  edits.changes.revision = ++history.revision;
  edits.changes.refit_ms = watch.lap();
  if (history.log.size() == kLogLength) history.log.pop_front();
  history.log.push_back(edits.changes);
  return std::move(edits.changes);
}

std::uint64_t World::revision() const {
  return history_->revision;
}

std::optional<std::vector<WorldChanges>> World::changes_since(std::uint64_t revision) const {
  const History& history = *history_;
  if (revision > history.revision) return std::nullopt;
  const std::uint64_t missed = history.revision - revision;
  if (missed > history.log.size()) return std::nullopt;
  return std::vector<WorldChanges>(history.log.end() - static_cast<std::ptrdiff_t>(missed),
                                   history.log.end());
}

Bounds World::instance_bounds(int instance) const {
  const SceneSnapshot& snapshot = history_->snapshot;
  return world_box(snapshot, snapshot.placements[instance]);
}

double World::build_ms() const {
  return tracer_->statistics().build_ms;
}
std::size_t World::bytes() const {
  return tracer_->statistics().bytes;
}
double World::refit_ms() const {
  return tracer_->statistics().refit_ms;
}

}  // namespace lambent
