// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "field/field_access.h"
#include "field/probes/probe_store.h"
#include "fog/ambient.h"
#include "fog/fog.h"
#include "raytracing/direct_light.h"

namespace lambent {
namespace {

constexpr std::size_t kColumnsPerTask = 8;
constexpr std::size_t kFroxelsPerTask = 4096;

// Reach of columns from a pixel: the two that it lies between, and those that these are filtered
// with.
constexpr int kReach = 2;

/// What froxels.inl.h requires of its includer.
using FroxelsRef = const std::vector<vec4>&;
inline const vec4& fetch_froxel(FroxelsRef froxels, uint index) {
  return froxels[index];
}

#include "fog/froxels.inl.h"

/// A field's probes, as ambient.inl.h reads them.
struct AmbientLookup {
  explicit AmbientLookup(const ProbeStore& from) : store(from) {}
  ProbeGrid fetch_grid(int volume) const { return store.grid(volume); }
  vec2 fetch_moments(int probe, const vec3& direction) const {
    const float unit = distance_unit(store.grid_of(probe));
    return store.moments(probe, direction) / vec2(unit, unit * unit);
  }
  vec3 fetch_offset(int probe) const { return store.probe_offset(probe); }
  vec3 fetch_irradiance(int probe, const vec3& direction) const {
    return store.irradiance(probe, direction);
  }

#include "fog/ambient.inl.h"

  const ProbeStore& store;
};

/// Multi-bounce radiance that fog at a point sends against a ray, divided by its extinction.
vec3 ambient_source_of(const Media& media, const AmbientIrradiance& ambient,
                       const vec3& position_ws) {
  vec3 sum(0.0f);
  float total = 0.0f;
  for (const MediumRecord& medium : media.records()) {
    const float density = medium_density(medium, position_ws);
    sum += medium.albedo * density * ambient_source(ambient, medium.anisotropy);
    total += density;
  }
  return total > 0.0f ? sum / total : vec3(0.0f);
}

/// Light that a froxel receives if a shadow ray is unoccluded.
struct PendingFogLight {
  std::size_t froxel;
  vec3 light;
};

Ray ray_through(const CameraRecord& camera, const vec2& pixel) {
  const CameraRay through = camera_ray(camera, pixel);
  Ray ray;
  ray.origin = through.origin_ws;
  ray.direction = through.direction_ws;
  return ray;
}

}  // namespace

/// A sample of a froxel: a point of a ray, and its weight.
struct FroxelFog::FroxelSample {
  const Ray& ray;
  FroxelSegment segment;
  FroxelPoint point;
  float u;      // uniform number that the point was drawn with
  float share;  // weight among the froxel's samples
  std::size_t froxel;
};

/// Memory of columns that are lit together.
struct FroxelFog::Columns {
  std::size_t begin = 0, end = 0;  // range among all columns
  // The column being lit
  vec2 middle_pixel{0.0f};
  CameraRay middle = {};
  std::vector<Ray> rays;
  std::vector<Ray> shadows;
  std::vector<PendingFogLight> pending;
  std::vector<std::uint8_t> occluded;
};

std::uint64_t FroxelFog::find_light(const FogRequest& request, bool continues) {
  const FogSettings& settings = request.settings;
  const FroxelGrid before = grid_;
  media_ = Media(request.world.scene().fog);
  const auto across = [&](int pixels) {
    return static_cast<uint>((pixels + settings.froxel_pixels - 1) / settings.froxel_pixels);
  };
  grid_.camera = request.camera;
  grid_.columns = across(request.width);
  grid_.rows = across(request.height);
  grid_.slices = static_cast<uint>(settings.slices);
  grid_.pixels = static_cast<float>(settings.froxel_pixels);
  grid_.first_row =
      static_cast<uint>(std::max(0, request.first_row / settings.froxel_pixels - kReach));
  grid_.end_row = std::min(grid_.rows, across(request.first_row + request.rows) + kReach);

  std::uint64_t rays = trace_columns(request);
  place_slices(request);
  const std::size_t count =
      std::size_t{grid_.columns} * (grid_.end_row - grid_.first_row) * grid_.slices;
  const bool keeps = request.averaged_frames > 1;
  const bool has_history = keeps && continues && averaged_.size() == count &&
                           before.columns == grid_.columns && before.slices == grid_.slices;
  lit_.assign(count, vec4(0.0f));
  const ProbeStore* store = request.field != nullptr ? &store_of(*request.field) : nullptr;
  std::atomic<std::uint64_t> shadow_rays = 0;
  const std::size_t first = std::size_t{grid_.first_row} * grid_.columns;
  const std::size_t end = std::size_t{grid_.end_row} * grid_.columns;
  parallel_chunks(end - first, batch_of(tracer_of(request.world), grid_.slices, kColumnsPerTask),
                  [&](std::size_t chunk_begin, std::size_t chunk_end) {
                    Columns columns;
                    columns.begin = first + chunk_begin;
                    columns.end = first + chunk_end;
                    light_columns(request, store, columns);
                    shadow_rays += columns.shadows.size();
                  });
  if (has_history) average(before, request.averaged_frames);
  smooth();
  if (keeps) {
    averaged_.swap(lit_);
  } else {
    averaged_.clear();
  }
  return rays + shadow_rays;
}

/// Finds the ends of the rays of all columns. Fog behind them is hidden, and its light must not
/// leak into fog in front.
std::uint64_t FroxelFog::trace_columns(const FogRequest& request) {
  const auto samples = static_cast<std::size_t>(request.settings.samples);
  const std::size_t columns = std::size_t{grid_.columns} * grid_.rows;
  ray_ends_.resize(columns * samples);
  const RayTracer& tracer = tracer_of(request.world);
  parallel_chunks(columns, batch_of(tracer, samples, kFroxelsPerTask / samples + 1),
                  [&](std::size_t begin, std::size_t end) {
                    std::vector<Ray> rays;
                    for (std::size_t column = begin; column < end; ++column) {
                      const uint x = static_cast<uint>(column % grid_.columns);
                      const uint y = static_cast<uint>(column / grid_.columns);
                      for (uint s = 0; s < samples; ++s) {
                        const vec2 point =
                            column_point(grid_, x, y, s, request.frame, request.seed);
                        rays.push_back(ray_through(grid_.camera, point));
                      }
                    }
                    std::vector<Hit> hits(rays.size());
                    tracer.closest_hits(rays, hits);
                    for (std::size_t i = 0; i < hits.size(); ++i) {
                      ray_ends_[begin * samples + i] = hits[i].distance;
                    }
                  });
  return columns * samples;
}

/// Places the slices between the nearest and the farthest visible fog.
void FroxelFog::place_slices(const FogRequest& request) {
  const auto samples = static_cast<std::size_t>(request.settings.samples);
  float nearest = std::numeric_limits<float>::max(), farthest = 0.0f;
  for (std::size_t i = 0; i < ray_ends_.size(); ++i) {
    const auto column = static_cast<uint>(i / samples);
    const vec2 point = column_point(grid_, column % grid_.columns, column / grid_.columns,
                                    static_cast<uint>(i % samples), request.frame, request.seed);
    const Ray ray = ray_through(grid_.camera, point);
    const vec2 range = fog_range(media_, ray.origin, ray.direction, ray_ends_[i]);
    if (!(range.y > range.x)) continue;
    nearest = std::min(nearest, range.x);
    farthest = std::max(farthest, range.y);
  }
  // Without visible fog, any range will do
  grid_.nearest = farthest > nearest ? nearest : 0.0f;
  grid_.farthest = farthest > nearest ? farthest : 1.0f;
}

/// Queues the direct light at a point of a froxel. Lamps near the froxel are sampled at points of
/// their own.
void FroxelFog::queue_light(const FogRequest& request, const FroxelSample& sample,
                            RandomStream random, Columns& columns) const {
  const LightDraws draws{request.world, request.tree_samples};
  const FogReceiver fog{media_, sample.ray.direction};
  const auto place = [&](float distance) {
    return sample.ray.origin + distance * sample.ray.direction;
  };
  const vec3 position_ws = place(sample.point.distance);
  const uint slots = slot_count(draws);
  LightPicks picks;
  for (uint slot = 0; slot < slots; ++slot) {
    LightReceiver receiver{{position_ws, vec3(0.0f), vec3(0.0f)}, nullptr, &fog};
    float weight = sample.point.weight;
    if (slot < enumerated_lights(draws)) {
      const LightRecord light = fetch_light(draws, fetch_enumerated(draws, slot));
      if (light.type != kLightDirectional) {
        const FroxelPoint near_lamp = lamp_point(
            media_, {sample.ray.origin, sample.ray.direction}, sample.segment, sample.point,
            light.position_ws,
            lamp_height(grid_, columns.middle, columns.middle_pixel, light.position_ws), sample.u);
        receiver.point.position_ws = place(near_lamp.distance);
        weight = near_lamp.weight;
      }
    }
    const vec3& at_ws = receiver.point.position_ws;
    const LightCandidate candidate = candidate_of_slot(draws, receiver, slot, picks, random);
    if (candidate.perpendicular_irradiance == vec3(0.0f)) continue;
    const float passed = transmittance(media_, at_ws, candidate.to_light, candidate.distance);
    const vec3 light = scattered_light(fog, at_ws, candidate) * (weight * sample.share * passed);
    if (light == vec3(0.0f)) continue;
    columns.pending.push_back({sample.froxel, light});
    columns.shadows.push_back(shadow_ray(at_ws, vec3(0.0f), candidate));
  }
}

/// Queues the direct light of a froxel, and adds the multi-bounce light.
void FroxelFog::light_froxel(const FogRequest& request, const ProbeStore* store,
                             const glm::uvec3& at, Columns& columns) {
  const auto samples = static_cast<uint>(request.settings.samples);
  const std::size_t column = std::size_t{at.y} * grid_.columns + at.x;
  const std::size_t froxel = froxel_index(grid_, at.x, at.y, at.z);
  vec4& sum = lit_[froxel];
  vec3 ambient_at(0.0f), ambient_along(0.0f);
  for (uint s = 0; s < samples; ++s) {
    const Ray& ray = columns.rays[s];
    FroxelSample sample{ray, {}, {}, 0.0f, 1.0f / static_cast<float>(samples), froxel};
    sample.u = depth_number(grid_, at.x, at.y, at.z, s, samples, request.frame, request.seed);
    sample.segment = froxel_segment(grid_, media_, ray.origin, ray.direction,
                                    ray_ends_[column * samples + s], at.z);
    sample.point = froxel_point(media_, ray.origin, ray.direction, sample.segment, sample.u);
    if (!(sample.point.weight > kLeastFroxelWeight)) continue;
    if (sum.w == 0.0f) {
      ambient_at = ray.origin + sample.point.distance * ray.direction;
      ambient_along = ray.direction;
    }
    sum.w += sample.share * sample.point.weight;
    queue_light(request, sample,
                make_random_stream(static_cast<uint>(froxel), request.frame * samples + s,
                                   request.seed ^ kFroxelSalt),
                columns);
  }
  if (store == nullptr || sum.w == 0.0f) return;
  // Multi-bounce light varies little: one point of the froxel is enough
  AmbientLookup lookup(*store);
  const AmbientIrradiance ambient =
      lookup.ambient_irradiance(store->volumes(), ambient_at, ambient_along);
  sum += vec4(sum.w * ambient_source_of(media_, ambient, ambient_at), 0.0f);
}

void FroxelFog::light_columns(const FogRequest& request, const ProbeStore* store,
                              Columns& columns) {
  const auto samples = static_cast<uint>(request.settings.samples);
  columns.rays.resize(samples);
  for (std::size_t column = columns.begin; column < columns.end; ++column) {
    const uint x = static_cast<uint>(column % grid_.columns);
    const uint y = static_cast<uint>(column / grid_.columns);
    columns.middle_pixel =
        grid_.pixels * vec2(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
    columns.middle = camera_ray(grid_.camera, columns.middle_pixel);
    for (uint s = 0; s < samples; ++s) {
      columns.rays[s] =
          ray_through(grid_.camera, column_point(grid_, x, y, s, request.frame, request.seed));
    }
    for (uint slice = 0; slice < grid_.slices; ++slice) {
      light_froxel(request, store, {x, y, slice}, columns);
    }
  }
  columns.occluded.resize(columns.shadows.size());
  tracer_of(request.world).occlusions(columns.shadows, columns.occluded);
  for (std::size_t i = 0; i < columns.pending.size(); ++i) {
    const PendingFogLight& pending = columns.pending[i];
    if (columns.occluded[i] == 0) lit_[pending.froxel] += vec4(pending.light, 0.0f);
  }
}

/// Coordinates of the froxel at an index.
glm::uvec3 FroxelFog::froxel_at(std::size_t index) const {
  const auto column = static_cast<uint>(index / grid_.slices);
  return {column % grid_.columns, grid_.first_row + column / grid_.columns,
          static_cast<uint>(index % grid_.slices)};
}

/// Adds the previous frame's average, times 1 - 1 / frames, so that older frames fade.
void FroxelFog::average(const FroxelGrid& before, int frames) {
  const float kept = 1.0f - 1.0f / static_cast<float>(frames);
  parallel_chunks(lit_.size(), kFroxelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const glm::uvec3 at = froxel_at(i);
      const vec2 middle(static_cast<float>(at.x) + 0.5f, static_cast<float>(at.y) + 0.5f);
      const Ray ray = ray_through(grid_.camera, middle * grid_.pixels);
      const float distance = 0.5f * (slice_begin(grid_, at.z) + slice_begin(grid_, at.z + 1));
      lit_[i] += kept * froxel_before(before, averaged_, ray.origin + distance * ray.direction);
    }
  });
}

void FroxelFog::smooth() {
  smoothed_.resize(lit_.size());
  parallel_chunks(lit_.size(), kFroxelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const glm::uvec3 at = froxel_at(i);
      smoothed_[i] = smoothed_froxel(grid_, lit_, at.x, at.y, at.z);
    }
  });
}

vec4 FroxelFog::along(const glm::vec2& pixel, const glm::vec3& origin_ws,
                      const glm::vec3& direction_ws, float ray_end) const {
  return fog_along(grid_, media_, smoothed_, pixel, origin_ws, direction_ws, ray_end);
}

}  // namespace lambent
