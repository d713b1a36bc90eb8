// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cassert>
#include <stdexcept>
#include <string>
#include <vector>

#include "raytracing/embree/embree_raytracer.h"
#include "raytracing/refit.h"
#include "raytracing/surface_math.h"
#include "scene/transmission.h"

namespace lambent {
namespace {

using embree::Geometry;

bool count_bytes(void* total, ssize_t bytes, bool /*post*/) {
  *static_cast<std::atomic<std::int64_t>*>(total) += bytes;
  return true;
}

}  // namespace

EmbreeRayTracer::EmbreeRayTracer(const Scene& scene) {
  Stopwatch watch;
  slots_.scene = &scene;
  device_.reset(rtcNewDevice(nullptr));
  if (!device_) throw std::runtime_error("Embree cannot start: this processor lacks SSE2");
  rtcSetDeviceMemoryMonitorFunction(device_.get(), count_bytes, &bytes_);
  GeometryEdits all_new;
  all_new.previous.assign(scene.instances.size(), GeometryEdits::kNew);
  follow_list(all_new);
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    placements_[slot_of_[i]].moves = scene.instances[i].dynamic;
  }
  build();
  finish(&statistics_.build_ms, watch);
}

void EmbreeRayTracer::fail_to_build() {
  throw std::runtime_error(
      "Embree failed while building the acceleration structure (out of memory?)");
}

void EmbreeRayTracer::check_masks() const {
  if (rtcGetDeviceProperty(device_.get(), RTC_DEVICE_PROPERTY_RAY_MASK_SUPPORTED) != 0) return;
  for (const Placement& placement : placements_) {
    // Without masks, rays of motion hit blended surfaces, whose motion is then unknown: no error
    if (placement.used && (placement.mask | kRayOfMotion) != kRayMeetsAll) {
      throw std::runtime_error(
          "this Embree was built without ray masks, which instances that cast no GI or that probes "
          "ignore need");
    }
  }
}

void EmbreeRayTracer::finish(double* ms, Stopwatch& watch) {
  if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE) fail_to_build();
  check_masks();
  const Scene& scene = *slots_.scene;
  has_glass_ = std::any_of(scene.materials.begin(), scene.materials.end(),
                           [](const Material& material) { return is_transmissive(material); });
  dims_shadows_ = std::any_of(scene.materials.begin(), scene.materials.end(), dims_light);
  statistics_.triangles = triangle_count(scene);
  statistics_.instances = scene.instances.size();
  statistics_.bytes = static_cast<std::size_t>(std::max<std::int64_t>(bytes_, 0));
  *ms = watch.lap();
}

/// Assigns slots to the scene's instances: their old ones to those that remain, free ones to new
/// ones. Removed instances are detached from the upper level. Returns whether updating the upper
/// level completes the change: false where static geometry is removed.
bool EmbreeRayTracer::follow_list(const GeometryEdits& edits) {
  const std::vector<std::uint32_t> old_slots = std::move(slot_of_);
  std::vector<std::uint8_t> stays(placements_.size(), 0);
  slot_of_.clear();
  for (const std::int32_t before : edits.previous) {
    if (before == GeometryEdits::kNew) {
      slot_of_.push_back(0);  // assigned below
      continue;
    }
    slot_of_.push_back(old_slots[before]);
    stays[old_slots[before]] = 1;
  }
  bool upper_level_alone = true;
  for (std::uint32_t slot = 0; slot < stays.size(); ++slot) {
    Placement& placement = placements_[slot];
    if (stays[slot] != 0 || !placement.used) continue;
    if (!placement.baked) rtcDetachGeometry(world_.get(), embree::id_of_slot(slot));
    upper_level_alone = upper_level_alone && !placement.baked;
    placement = {};
    free_slots_.push_back(slot);
  }
  for (std::uint32_t i = 0; i < slot_of_.size(); ++i) {
    if (edits.previous[i] == GeometryEdits::kNew) {
      if (free_slots_.empty()) {
        free_slots_.push_back(static_cast<std::uint32_t>(placements_.size()));
        placements_.emplace_back();
      }
      slot_of_[i] = free_slots_.back();
      free_slots_.pop_back();
      placements_[slot_of_[i]].used = true;
      // An instance that was added later is likely to be removed or moved again
      placements_[slot_of_[i]].moves = true;
    }
  }
  slots_.instance_of.assign(placements_.size(), 0);
  for (std::uint32_t i = 0; i < slot_of_.size(); ++i) slots_.instance_of[slot_of_[i]] = i;
  return upper_level_alone;
}

void EmbreeRayTracer::make_mesh_scene(std::size_t mesh) {
  MeshScene& made = meshes_[mesh];
  made.geometry = embree::make_mesh(device_.get(), slots_.scene->meshes[mesh], slots_, nullptr);
  if (!made.geometry) fail_to_build();
  made.scene.reset(rtcNewScene(device_.get()));
  rtcSetSceneFlags(made.scene.get(), made.deforms ? RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC
                                                  : RTC_SCENE_FLAG_ROBUST);
  if (made.deforms) {
    rtcSetGeometryBuildQuality(made.geometry.get(), RTC_BUILD_QUALITY_REFIT);
    made.half_area = half_area(slots_.scene->meshes[mesh]);
  }
  rtcCommitGeometry(made.geometry.get());
  rtcAttachGeometry(made.scene.get(), made.geometry.get());
  rtcCommitScene(made.scene.get());
}

/// Creates a slot's geometry and attaches it.
void EmbreeRayTracer::place(std::uint32_t slot, RTCScene into) {
  Placement& placement = placements_[slot];
  const Instance& instance = instance_at(slot);
  placement.mask = instance_mask(*slots_.scene, instance);
  placement.mirrored = glm::determinant(glm::mat3(instance.world_from_object)) < 0.0f;
  if (placement.baked) {
    placement.geometry = embree::make_mesh(device_.get(), slots_.scene->meshes[instance.mesh],
                                           slots_, &instance.world_from_object);
    if (!placement.geometry) fail_to_build();
    rtcSetGeometryMask(placement.geometry.get(), placement.mask);
    rtcCommitGeometry(placement.geometry.get());
  } else {
    if (!meshes_[instance.mesh].scene) make_mesh_scene(instance.mesh);
    placement.geometry = embree::make_instance(device_.get(), meshes_[instance.mesh].scene.get(),
                                               instance.world_from_object, placement.mask);
  }
  rtcAttachGeometryByID(into, placement.geometry.get(), embree::id_of_slot(slot));
}

/// Builds all levels, reusing the hierarchies of meshes.
void EmbreeRayTracer::build() {
  const Scene& scene = *slots_.scene;
  meshes_.resize(scene.meshes.size());
  std::vector<int> uses(scene.meshes.size(), 0);
  for (const Instance& instance : scene.instances) ++uses[instance.mesh];

  // Meshes of one static instance go into the static hierarchy; the others are built once and
  // instanced
  two_levels_ = false;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    Placement& placement = placements_[slot_of_[i]];
    const int mesh = scene.instances[i].mesh;
    placement.moves = placement.moves || meshes_[mesh].deforms;
    placement.baked = !placement.moves && uses[mesh] < 2;
    two_levels_ = two_levels_ || placement.moves;
  }

  // Robust traversal leaves no cracks between neighbouring triangles, so that closed rooms stay
  // dark.
  world_.reset(rtcNewScene(device_.get()));
  rtcSetSceneFlags(world_.get(), RTC_SCENE_FLAG_ROBUST);
  still_.reset(two_levels_ ? rtcNewScene(device_.get()) : nullptr);
  bool any_baked = false;
  if (still_) rtcSetSceneFlags(still_.get(), RTC_SCENE_FLAG_ROBUST);
  for (const std::uint32_t slot : slot_of_) {
    const bool baked = placements_[slot].baked;
    any_baked = any_baked || baked;
    place(slot, still_ && baked ? still_.get() : world_.get());
  }
  if (still_ && any_baked) {
    rtcCommitScene(still_.get());
    const Geometry all =
        embree::make_instance(device_.get(), still_.get(), glm::mat4(1.0f), kRayMeetsAll);
    rtcAttachGeometryByID(world_.get(), all.get(), embree::kStillId);
  }
  rtcCommitScene(world_.get());
}

void EmbreeRayTracer::update(const GeometryEdits& edits) {
  Stopwatch watch;
  bool in_place = follow_list(edits) && two_levels_;
  meshes_.resize(slots_.scene->meshes.size());

  // Find what changed. What has moved once stays movable, so that a second move needs no rebuild
  std::vector<std::uint8_t> bent(meshes_.size(), 0);
  for (const std::uint32_t mesh : edits.deformed) {
    bent[mesh] = 1;
    if (!meshes_[mesh].deforms) meshes_[mesh].scene.reset();
    meshes_[mesh].deforms = true;
  }
  for (const std::uint32_t mesh : edits.remade) {
    bent[mesh] = 1;
    meshes_[mesh].scene.reset();
  }
  const auto touch = [&](std::uint32_t slot) {
    in_place = in_place && !placements_[slot].baked;
    placements_[slot].moves = true;
  };
  for (const std::uint32_t i : edits.moved) touch(slot_of_[i]);
  for (const std::uint32_t i : edits.masked) touch(slot_of_[i]);
  for (const std::uint32_t slot : slot_of_) {
    if (bent[instance_at(slot).mesh] != 0) touch(slot);
  }

  if (in_place) {
    refit(edits, bent);
  } else {
    // Reuse the hierarchies of meshes, except those whose vertices changed
    for (const std::uint32_t mesh : edits.deformed) meshes_[mesh].scene.reset();
    build();
  }
  finish(&statistics_.refit_ms, watch);
}

/// Updates the meshes that were deformed, and the upper level.
void EmbreeRayTracer::refit(const GeometryEdits& edits, const std::vector<std::uint8_t>& bent) {
  for (const std::uint32_t mesh : edits.deformed) {
    MeshScene& deforming = meshes_[mesh];
    if (!deforming.scene) continue;
    const Mesh& source = slots_.scene->meshes[mesh];
    const float area = half_area(source);
    if (outgrown(deforming.half_area, area) ||
        !embree::has_triangles_of(deforming.geometry.get(), source)) {
      deforming.scene.reset();
      continue;
    }
    embree::move_vertices(deforming.geometry.get(), source);
    rtcCommitScene(deforming.scene.get());
  }

  std::vector<std::uint8_t> stale(slot_of_.size(), 0);
  for (const std::uint32_t i : edits.moved) stale[i] = 1;
  for (const std::uint32_t i : edits.masked) stale[i] = 1;
  for (std::uint32_t i = 0; i < slot_of_.size(); ++i) {
    const int mesh = slots_.scene->instances[i].mesh;
    if (stale[i] == 0 && bent[mesh] == 0 && edits.previous[i] != GeometryEdits::kNew) continue;
    if (edits.previous[i] != GeometryEdits::kNew) {
      rtcDetachGeometry(world_.get(), embree::id_of_slot(slot_of_[i]));
    }
    place(slot_of_[i], world_.get());
  }
  rtcCommitScene(world_.get());
}

std::unique_ptr<RayTracer> make_embree_raytracer(const Scene& scene) {
  return std::make_unique<EmbreeRayTracer>(scene);
}

}  // namespace lambent
