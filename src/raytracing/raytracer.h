// SPDX-License-Identifier: Apache-2.0
// The interface of ray tracers.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "lambent/scene.h"
#include "raytracing/ray_records.h"

namespace lambent {

inline constexpr float kInfiniteDistance = std::numeric_limits<float>::infinity();

/// The mask of rays that can hit an instance, from its flags and its material.
inline std::uint32_t instance_mask(const Scene& scene, const Instance& instance) {
  const Material& material = scene.materials[scene.meshes[instance.mesh].material];
  const bool moves = material.alpha_mode != AlphaMode::blend;
  const std::uint32_t all = moves ? kRayMeetsAll : kRayMeetsAll & ~kRayOfMotion;
  const std::uint32_t direct = all & ~(kRayGathers | kRayOfProbe);
  if (!instance.casts_gi) return direct;
  return instance.ignored_by_probes ? direct | kRayGathers : all;
}

struct Ray {
  glm::vec3 origin{0.0f};  ///< World space [m].
  float t_min = 0.0f;      ///< Hits nearer than this do not count [units of |direction|].
  glm::vec3 direction{0.0f, 0.0f, 1.0f};  ///< Unit length, so that distances are metres.
  float t_max = kInfiniteDistance;        ///< Hits farther than this do not count.
  std::uint32_t mask = kRayMeetsAll;      ///< Instances it can hit.
};

/// A ray's hit.
struct Hit {
  float distance =
      kInfiniteDistance;         ///< [m]; infinite: nothing was hit and the rest is undefined.
  std::uint32_t instance = 0;    ///< Index into Scene::instances.
  std::uint32_t triangle = 0;    ///< Index into the mesh's triangles.
  glm::vec2 barycentrics{0.0f};  ///< Weights of the triangle's second and third vertex.
  bool front_face = true;  ///< The ray hit the side from which the vertices run counter-clockwise.
  /// Weight among the samples of a pixel, also where nothing was hit; see weight_of_sample(). 1 for
  /// other rays.
  float sample_weight = 1.0f;

  bool missed() const { return distance == kInfiniteDistance; }
};

struct AccelerationStatistics {
  double build_ms = 0.0;      ///< Wall-clock time of the first build.
  double refit_ms = 0.0;      ///< Wall-clock time of the last update; 0: there was none.
  std::size_t bytes = 0;      ///< Memory held by the acceleration structures.
  std::size_t triangles = 0;  ///< Over all instances.
  std::size_t instances = 0;
};

/// Changes of a scene's geometry since a ray tracer was last updated.
struct GeometryEdits {
  static constexpr std::int32_t kNew = -1;
  /// For each instance, its previous index, or kNew. Indices that are absent have been removed.
  std::vector<std::int32_t> previous;
  std::vector<std::uint32_t> moved;     ///< Old instances whose transform differs.
  std::vector<std::uint32_t> masked;    ///< Old instances whose mask differs.
  std::vector<std::uint32_t> deformed;  ///< Meshes with the same numbers of vertices and triangles.
  /// Meshes to be rebuilt: other triangles, or from opaque to transparent or back.
  std::vector<std::uint32_t> remade;
};

/// Finds the hits of rays. Queries are const, single-threaded and safe to call from many threads at
/// once. Triangles of AlphaMode::mask let rays through where coverage is below the cutoff; those of
/// AlphaMode::blend let a ray through with probability 1 - coverage, decided by a hash of the hit,
/// or by the pixel whose sample the ray is (scene/coverage.h). Transmissive surfaces
/// (is_transmissive) stop rays, except those that cross glass (crosses_glass), which pass with a
/// probability, decided by a hash of the ray.
class RayTracer {
 public:
  virtual ~RayTracer() = default;

  /// The nearest hit of each ray. Both spans have the same length.
  virtual void closest_hits(std::span<const Ray> rays, std::span<Hit> hits) const = 0;

  /// 1 for each ray that hits an opaque surface between t_min and t_max, else 0.
  virtual void occlusions(std::span<const Ray> rays, std::span<std::uint8_t> occluded) const = 0;

  /// Share of the light along each ray, between t_min and t_max, that passes straight through the
  /// surfaces there, by color; 0 where one of them is opaque. For rays that cross glass, it is
  /// divided by the probability with which they do, so that t_max may end just before their hits.
  /// It is 0, too, where a ray stops_at_bends() and one of the surfaces scatters or refracts light.
  /// Of shadow rays, blended surfaces let 1 - coverage pass, without chance. Only for tracers that
  /// dims_shadows().
  virtual void transmittances(std::span<const Ray> /*rays*/,
                              std::span<glm::vec3> /*through*/) const {
    assert(!dims_shadows());
  }

  /// Whether light passes some surface in part, which occlusions() does not tell.
  virtual bool dims_shadows() const { return false; }

  /// Whether some surface transmits light.
  virtual bool has_glass() const { return false; }

  /// Number of rays that a batch should have where the caller can choose: each batch has a fixed
  /// cost, which is negligible on processors and a round trip on other devices.
  virtual std::size_t batch_rays() const { return 1; }

  virtual AccelerationStatistics statistics() const = 0;

  /// Updates to edits of the scene that it was built for, refitting or rebuilding only what they
  /// affect. Not to be called while rays are traced. Throws std::runtime_error where memory runs
  /// out.
  virtual void update(const GeometryEdits& edits) = 0;

  Hit closest_hit(const Ray& ray) const {
    Hit hit;
    closest_hits({&ray, 1}, {&hit, 1});
    return hit;
  }
  bool occluded(const Ray& ray) const {
    std::uint8_t result = 0;
    occlusions({&ray, 1}, {&result, 1});
    return result != 0;
  }
};

/// Light that arrives along shadow rays; reused between calls to save allocations.
class ShadowRays {
 public:
  /// Traces the rays and stores their results.
  void trace(const RayTracer& tracer, std::span<const Ray> rays) {
    occluded_.clear();
    through_.clear();
    if (tracer.dims_shadows()) {
      through_.resize(rays.size());
      tracer.transmittances(rays, through_);
    } else {
      occluded_.resize(rays.size());
      tracer.occlusions(rays, occluded_);
    }
  }
  /// Share of the light that arrives along a ray, by color.
  glm::vec3 share(std::size_t ray) const {
    if (!through_.empty()) return through_[ray];
    return glm::vec3(occluded_[ray] != 0 ? 0.0f : 1.0f);
  }

 private:
  std::vector<std::uint8_t> occluded_;
  std::vector<glm::vec3> through_;  // empty: no surface transmits light
};

/// Number of items, of `rays` rays each, that make a good batch for a ray tracer: at least `least`.
inline std::size_t batch_of(const RayTracer& tracer, std::size_t rays, std::size_t least) {
  return std::max(least, tracer.batch_rays() / std::max<std::size_t>(rays, 1));
}

/// A ray tracer on Embree, built for the present state of the scene, which must outlive it. After
/// edits of its geometry, `update` must be called before the next ray. Throws std::runtime_error
/// where Embree cannot start or runs out of memory.
std::unique_ptr<RayTracer> make_embree_raytracer(const Scene& scene);

}  // namespace lambent
