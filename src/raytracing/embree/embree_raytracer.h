// SPDX-License-Identifier: Apache-2.0
// The processor's ray tracer.
#ifndef LAMBENT_RAYTRACING_EMBREE_EMBREE_RAYTRACER_H
#define LAMBENT_RAYTRACING_EMBREE_EMBREE_RAYTRACER_H

#include <atomic>
#include <vector>

#include "core/stopwatch.h"
#include "raytracing/embree/geometry.h"
#include "raytracing/raytracer.h"

namespace lambent {

/// All geometry is in one hierarchy while nothing moves, which is fastest to traverse. Once
/// something moves, there are two levels: static geometry in a hierarchy of its own, and each
/// moving instance beside it. Moving an instance then costs no more than rebuilding the upper
/// level.
class EmbreeRayTracer final : public RayTracer {
 public:
  explicit EmbreeRayTracer(const Scene& scene);

  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits) const override;
  void occlusions(std::span<const Ray> rays, std::span<std::uint8_t> occluded) const override;
  void transmittances(std::span<const Ray> rays, std::span<glm::vec3> through) const override;
  bool has_glass() const override { return has_glass_; }
  bool dims_shadows() const override { return dims_shadows_; }
  AccelerationStatistics statistics() const override { return statistics_; }
  void update(const GeometryEdits& edits) override;

 private:
  /// An instance of the scene in Embree.
  struct Placement {
    embree::Geometry geometry;
    std::uint32_t mask = kRayMeetsAll;
    bool moves = false;     // an instance of its own in the upper level
    bool baked = false;     // its vertices are in world space
    bool mirrored = false;  // its transform flips faces
    bool used = false;
  };
  /// The hierarchy of one mesh, for instances that are not baked.
  struct MeshScene {
    embree::SceneHandle scene;
    embree::Geometry geometry;
    float half_area = 0.0f;  // when built [m^2]
    bool deforms = false;
  };

  Hit hit_of(const Ray& ray, const RTCRayHit& found) const;
  /// The nearest hit but for blended surfaces up to the distance `passed` [m].
  Hit closest_beyond(const Ray& ray, float passed) const;
  /// Where the ray of a pixel's sample ends that meets its first surface at `hit`.
  Hit end_of_sample(const Ray& ray, Hit hit) const;
  bool follow_list(const GeometryEdits& edits);
  void build();
  void make_mesh_scene(std::size_t mesh);
  void place(std::uint32_t slot, RTCScene into);
  void refit(const GeometryEdits& edits, const std::vector<std::uint8_t>& bent);
  void finish(double* ms, Stopwatch& watch);
  const Instance& instance_at(std::uint32_t slot) const {
    return slots_.scene->instances[slots_.instance_of[slot]];
  }
  void check_masks() const;
  [[noreturn]] static void fail_to_build();

  embree::Slots slots_;
  std::atomic<std::int64_t> bytes_ = 0;
  embree::Device device_;
  std::vector<MeshScene> meshes_;
  std::vector<Placement> placements_;   // by slot
  std::vector<std::uint32_t> slot_of_;  // by instance
  std::vector<std::uint32_t> free_slots_;
  embree::SceneHandle still_;  // static geometry, where something else moves
  embree::SceneHandle world_;
  bool two_levels_ = false;
  bool has_glass_ = false;
  bool dims_shadows_ = false;
  AccelerationStatistics statistics_;
};

}  // namespace lambent
#endif
