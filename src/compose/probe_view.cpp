// SPDX-License-Identifier: Apache-2.0
#include "compose/probe_view.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/image/color_map.h"
#include "core/image/exposure.h"
#include "core/parallel.h"
#include "field/field_access.h"
#include "field/probes/probe_store.h"
#include "field/schedule/schedule.h"
#include "raytracing/camera_rays.h"
#include "raytracing/raytracer.h"
#include "raytracing/world_access.h"
#include "shared/color.h"
#include "shared/constants.h"

namespace lambent {
namespace {

constexpr std::size_t kRowsPerTask = 4;

// Side of the square of rays through a pixel, for smooth edges.
constexpr int kSamplesAcross = 2;

// Share of a sphere's colour that is left at its rim, so that a sphere of uniform colour looks
// round.
constexpr float kRim = 0.4f;

// Position of the newest age in the colour map, whose beginning is too dark to see.
constexpr float kYoungest = 0.2f;

/// A ray's hit on a probe's sphere.
struct SphereHit {
  float distance;  // [m]
  int probe;
  vec3 normal_ws;
};

/// Finds the nearest sphere of a volume along a ray by walking through the cells of its grid. A
/// relocated probe is less than a cell from its grid point, in one of the eight cells around that.
class SphereFinder {
 public:
  SphereFinder(const ProbeStore& store, int volume, float radius)
      : store_(store),
        volume_(volume),
        grid_(store.grid(volume)),
        radius_(radius * smallest_spacing(grid_)) {
    assert(radius > 0.0f && radius <= 0.5f);
  }

  std::optional<SphereHit> nearest(const Ray& ray) const {
    // Clip the ray to the grid, enlarged by one cell on each side; in units of cells
    const vec3 origin = grid_coords(grid_, ray.origin);
    const vec3 per_metre = (ray.direction * grid_.axes) / grid_.spacing;
    const vec3 last(grid_.count);
    float enter = 0.0f, leave = ray.t_max;
    for (int axis = 0; axis < 3; ++axis) {
      if (per_metre[axis] == 0.0f) {
        if (origin[axis] < -1.0f || origin[axis] > last[axis]) return std::nullopt;
        continue;
      }
      const float a = (-1.0f - origin[axis]) / per_metre[axis];
      const float b = (last[axis] - origin[axis]) / per_metre[axis];
      enter = max(enter, min(a, b));
      leave = min(leave, max(a, b));
    }
    if (!(enter < leave)) return std::nullopt;

    // Walk from cell to cell (Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray
    // Tracing", Eurographics 1987)
    const vec3 start = origin + enter * per_metre;
    ivec3 cell = clamp(ivec3(floor(start)), ivec3(-1), grid_.count - 1);
    ivec3 step(0);
    vec3 next(std::numeric_limits<float>::infinity()), stride(0.0f);
    for (int axis = 0; axis < 3; ++axis) {
      if (per_metre[axis] == 0.0f) continue;
      step[axis] = per_metre[axis] > 0.0f ? 1 : -1;
      stride[axis] = std::abs(1.0f / per_metre[axis]);
      const int face = cell[axis] + (step[axis] > 0 ? 1 : 0);
      next[axis] = (static_cast<float>(face) - origin[axis]) / per_metre[axis];
    }
    SphereHit best{leave, -1, vec3(0.0f)};
    while (true) {
      test_cell(ray, cell, best);
      const int axis = next.x < next.y ? (next.x < next.z ? 0 : 2) : (next.y < next.z ? 1 : 2);
      if (next[axis] >= best.distance) break;
      cell[axis] += step[axis];
      if (cell[axis] < -1 || cell[axis] >= grid_.count[axis]) break;
      next[axis] += stride[axis];
    }
    return best.probe < 0 ? std::nullopt : std::optional(best);
  }

 private:
  /// Tests the spheres of a cell's corners.
  void test_cell(const Ray& ray, const ivec3& cell, SphereHit& best) const {
    for (int corner = 0; corner < 8; ++corner) {
      const ivec3 coords = cell + cell_corner(corner);
      if (glm::any(glm::lessThan(coords, ivec3(0))) ||
          glm::any(glm::greaterThanEqual(coords, grid_.count))) {
        continue;
      }
      const int probe = probe_index(grid_, coords);
      const vec3 centre = store_.probe_position_ws(probe);
      const vec3 to_centre = centre - ray.origin;
      const float along = dot(to_centre, ray.direction);
      const vec3 off = to_centre - along * ray.direction;
      const float square = radius_ * radius_ - dot(off, off);
      if (square <= 0.0f) continue;
      const float distance = along - std::sqrt(square);
      // A ray that starts inside a sphere passes through it
      if (distance <= ray.t_min || distance >= best.distance) continue;
      if (is_covered_by_earlier_volume(store_.probe_grid_position_ws(probe))) continue;
      best = {distance, probe, (ray.origin + distance * ray.direction - centre) / radius_};
    }
  }

  /// Whether an earlier volume alone answers lookups at a place, so that this volume's probe there
  /// is not used.
  bool is_covered_by_earlier_volume(const vec3& place_ws) const {
    for (int earlier = 0; earlier < volume_; ++earlier) {
      if (volume_blend_weight(store_.grid(earlier), place_ws) >= 1.0f) return true;
    }
    return false;
  }

  const ProbeStore& store_;
  int volume_;
  ProbeGrid grid_;
  float radius_;  // [m]
};

/// Age of a probe, 0 for new to 1 for the oldest that the schedule allows, logarithmic.
float age_share(const IrradianceField& field, const ProbeStatus& record) {
  if (record.last_traced == 0) return 1.0f;
  const auto age = static_cast<float>(field.updates()) - static_cast<float>(record.last_traced);
  return std::log2(1.0f + max(age, 0.0f)) / std::log2(1.0f + static_cast<float>(kMaxProbeAge));
}

vec3 color_of(const IrradianceField& field, ProbeAspect aspect, const SphereHit& hit,
              const vec3& to_viewer_ws) {
  const ProbeStore& store = store_of(field);
  const ProbeStatus& record = statuses_of(field)[hit.probe];
  const float round = mix(kRim, 1.0f, max(dot(hit.normal_ws, to_viewer_ws), 0.0f));
  switch (aspect) {
    case ProbeAspect::irradiance:
      return store.irradiance(hit.probe, hit.normal_ws) * kInvPi;
    case ProbeAspect::distance: {
      const float seen = store.moments(hit.probe, hit.normal_ws).x;
      return linear_from_srgb(
          sequential_color(seen / max_probe_distance(store.grid_of(hit.probe))));
    }
    case ProbeAspect::state:
      return round * probe_state_color(record.state);
    case ProbeAspect::age:
      break;
  }
  return round * linear_from_srgb(sequential_color(mix(kYoungest, 1.0f, age_share(field, record))));
}

}  // namespace

vec3 probe_state_color(ProbeState state) {
  switch (state) {
    case ProbeState::off:
      return vec3(0.08f);
    case ProbeState::sleeping:
      return {0.03f, 0.08f, 0.6f};
    case ProbeState::newly_awake:
      return {0.9f, 0.7f, 0.02f};
    case ProbeState::awake:
      return {0.8f, 0.05f, 0.03f};
    case ProbeState::newly_vigilant:
      return {0.05f, 0.6f, 0.55f};
    case ProbeState::vigilant:
      break;
  }
  return {0.05f, 0.5f, 0.05f};
}

void draw_probes(const World& world, const IrradianceField& field, const Camera& camera,
                 const ProbeViewSettings& settings, LayeredImage& frame) {
  Image& probes = frame.require("probes", 4);
  Image& picture = *frame.find("");
  std::vector<SphereFinder> finders;
  finders.reserve(static_cast<std::size_t>(store_of(field).volumes()));
  for (int volume = 0; volume < store_of(field).volumes(); ++volume) {
    finders.emplace_back(store_of(field), volume, settings.radius);
  }
  const float brightness =
      settings.aspect == ProbeAspect::irradiance ? 1.0f : std::exp2(-display_stops(frame));
  const auto width = static_cast<std::size_t>(frame.width);
  constexpr float kShare = 1.0f / (kSamplesAcross * kSamplesAcross);

  const auto draw_row = [&](int y, std::vector<Ray>& rays, std::vector<Hit>& hits) {
    for (int sample = 0; sample < kSamplesAcross * kSamplesAcross; ++sample) {
      const float dx = (static_cast<float>(sample % kSamplesAcross) + 0.5f) / kSamplesAcross;
      const float dy = (static_cast<float>(sample / kSamplesAcross) + 0.5f) / kSamplesAcross;
      for (int x = 0; x < frame.width; ++x) {
        rays[x] = camera_ray(camera, frame.width, frame.height, static_cast<float>(x) + dx,
                             static_cast<float>(y) + dy);
      }
      tracer_of(world).closest_hits(rays, hits);
      for (int x = 0; x < frame.width; ++x) {
        rays[x].t_max = min(rays[x].t_max, hits[x].distance);
        std::optional<SphereHit> hit;
        for (const SphereFinder& finder : finders) {
          const std::optional<SphereHit> found = finder.nearest(rays[x]);
          if (!found) continue;
          hit = found;
          rays[x].t_max = found->distance;
        }
        if (!hit) continue;
        const vec3 color = color_of(field, settings.aspect, *hit, -rays[x].direction);
        float* pixel = probes.at(x, y);
        for (int c = 0; c < 3; ++c) pixel[c] += kShare * color[c];
        pixel[3] += kShare;
      }
    }
    for (int x = 0; x < frame.width; ++x) {
      const float* over = probes.at(x, y);
      float* under = picture.at(x, y);
      for (int c = 0; c < 3; ++c) under[c] = (1.0f - over[3]) * under[c] + brightness * over[c];
    }
  };
  parallel_chunks(static_cast<std::size_t>(frame.height), kRowsPerTask,
                  [&](std::size_t begin, std::size_t end) {
                    std::vector<Ray> rays(width);
                    std::vector<Hit> hits(width);
                    for (std::size_t y = begin; y < end; ++y) {
                      draw_row(static_cast<int>(y), rays, hits);
                    }
                  });
}

}  // namespace lambent
