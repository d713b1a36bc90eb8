// SPDX-License-Identifier: Apache-2.0
#include "field/edits/invalidation.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <utility>

#include "core/parallel.h"
#include "field/probes/moments_encoding.h"
#include "field/transport/distances.h"
#include "raytracing/boxes.h"
#include "raytracing/world_access.h"
#include "scene/environment_sampling.h"
#include "scene/light_sampling.h"
#include "shared/color.h"

namespace lambent {
namespace {

constexpr std::size_t kProbesPerTask = 8;

// Boxes are enlarged by this fraction of their size, so that surfaces on their faces stay inside
// despite rounding.
constexpr float kBoxSlack = 1e-4f;

/// Everything that some edits changed, in the form in which rays and surfels are tested against it.
struct Edits {
  Edits(const World& world, std::span<const WorldChanges> changes) {
    std::vector<std::uint8_t> differs(world.scene().materials.size(), 0);
    for (const WorldChanges& change : changes) {
      for (Bounds box : change.moved) {
        const vec3 slack = kBoxSlack * (box.max - box.min);
        boxes.add({box.min - slack, box.max + slack});
      }
      for (const WorldChanges::LightChange& light : change.lights) {
        if (light.before) lights.push_back(*light.before);
        if (light.after) lights.push_back(*light.after);
      }
      for (const int material : change.materials) differs[material] = 1;
      emission = emission || change.emission;
      sky = sky || change.environment;
    }
    materials = std::move(differs);
  }

  Boxes boxes;
  std::vector<Light> lights;            // edited lights, both before and after the edit
  std::vector<std::uint8_t> materials;  // one per material of the scene; 1 where it was edited
  bool emission = false;
  bool sky = false;
};

/// Whether an unoccluded light would illuminate a surfel.
bool reaches(const Light& light, const LitPoint& point, PunctualSample& sample) {
  sample = sample_punctual(light, point.position_ws);
  return sample.irradiance != vec3(0.0f) && dot(point.normal_ws, sample.to_light) > 0.0f;
}

/// Whether the edits may have changed the direct light at a surfel. Errs on the side of yes.
bool may_change_light(const World& world, const Edits& edits, const LitPoint& point) {
  if (edits.emission) return true;
  PunctualSample sample;
  for (const Light& light : edits.lights) {
    if (reaches(light, point, sample)) return true;
  }
  if (edits.boxes.empty()) return false;
  for (const Light& light : world.scene().lights) {
    if (reaches(light, point, sample) &&
        edits.boxes.crossed_by(point.position_ws, sample.to_light, sample.distance)) {
      return true;
    }
  }
  // Light from an emissive surface crosses the hull of the point and the surface's box
  for (Bounds shaft : emissive_of(world).bounds()) {
    shaft.add(point.position_ws);
    if (edits.boxes.overlapped_by(shaft)) return true;
  }
  return false;
}

/// Brings the surfels of one probe after another up to date. Each task has its own object.
class SurfelInvalidation {
 public:
  SurfelInvalidation(const World& world, const SolidSides& solid_sides, const Edits& edits,
                     const FieldSettings& settings)
      : world_(world), solid_sides_(solid_sides), edits_(edits), settings_(settings) {}

  std::uint64_t probe_rays = 0, shadow_rays = 0;

  /// What changed at a probe besides the light of its surfels.
  struct Outcome {
    bool other_surfaces = false;  // some surfels now need other lookups
    bool moved = false;           // some rays have other hits, so that distances changed
  };
  /// Traces and shades those surfels of a probe again that the edits may have changed.
  Outcome update_probe(int probe, const vec3& origin, ProbeTrace& trace) {
    Outcome outcome;
    retraced_.assign(trace.surfels.size(), 0);
    changed_.assign(trace.surfels.size(), 0);
    retrace(probe, origin, trace, outcome);
    reshade_direct(probe, trace);
    return outcome;
  }
  /// Flags the surfels of the last probe that need other lookups.
  const SurfelFlags& changed() const { return changed_; }

 private:
  void retrace(int probe, const vec3& origin, ProbeTrace& trace, Outcome& outcome);
  void reshade_direct(int probe, ProbeTrace& trace);

  const World& world_;
  const SolidSides& solid_sides_;
  const Edits& edits_;
  const FieldSettings& settings_;
  ShadeHitsScratch scratch_;
  SurfelFlags retraced_, changed_;
  std::vector<DirectLightQuery> queries_;
  std::vector<int> places_;
  std::vector<vec3> direct_;
};

/// Traces the rays again whose hits the edits may have changed.
void SurfelInvalidation::retrace(int probe, const vec3& origin, ProbeTrace& trace,
                                 Outcome& outcome) {
  ShadeHitsSettings shading = surfel_shading(settings_, *trace.rays, &solid_sides_);
  for (std::size_t i = 0; i < trace.surfels.size(); ++i) {
    Surfel& surfel = trace.surfels[i];
    const vec3& direction = trace.rays->directions[i];
    const bool sky = surfel.kind == SurfelKind::sky;
    // The ray may have reached the sky through glass, which tints the surfel's light
    const bool other_sky = sky && edits_.sky;
    const bool tinted = other_sky && tracer_of(world_).has_glass();
    if (other_sky && !tinted) {
      surfel.light = sky_radiance(world_.scene().environment, direction);
    }
    const float distance = surfel.distance_from(origin);
    const bool other_material = !sky && edits_.materials[surfel.material] != 0;
    // The mirror's place and material are not stored: the edits may concern them
    const bool mirrored = surfel.mirror_distance > 0.0f;
    if (!other_material && !tinted && !mirrored &&
        !edits_.boxes.crossed_by(origin, direction, distance)) {
      continue;
    }

    const Ray ray = probe_ray(origin, direction);
    const Hit hit = tracer_of(world_).closest_hit(ray);
    ShadedHit shaded;
    shadow_rays += shade_hits(world_, {&ray, 1}, {&hit, 1}, shading, first_ray_index(probe) + i,
                              scratch_, {&shaded, 1});
    const Surfel found = make_surfel(shaded);
    retraced_[i] = 1;
    ++probe_rays;
    if (found == surfel) continue;
    const bool moved = found.position_ws != surfel.position_ws || found.kind != surfel.kind ||
                       found.mirror_distance != surfel.mirror_distance;
    outcome.moved =
        outcome.moved || found.distance_from(origin) != distance || found.kind != surfel.kind;
    // Lookups depend on the position, the normal, and whether the surfel reflects the field's light
    const bool other = moved || found.normal_ws != surfel.normal_ws ||
                       found.gi_share != surfel.gi_share || found.reflects() != surfel.reflects();
    outcome.other_surfaces = outcome.other_surfaces || other;
    changed_[i] = other ? 1 : 0;
    surfel = found;
  }
}

/// Shades the direct light of surfels again that the edits may have changed.
void SurfelInvalidation::reshade_direct(int probe, ProbeTrace& trace) {
  queries_.clear();
  places_.clear();
  for (std::size_t i = 0; i < trace.surfels.size(); ++i) {
    const Surfel& surfel = trace.surfels[i];
    if (!surfel.reflects() || retraced_[i] != 0) continue;
    LitPoint point = {surfel.position_ws, decode_unit_vector(surfel.normal_ws),
                      decode_unit_vector(surfel.geometric_normal_ws), surfel.albedo_shape,
                      -trace.rays->directions[i]};
    point.mean_normal_length =
        mean_length_of_share(surfel.gi_share, dot(point.normal_ws, point.geometric_normal_ws));
    if (!may_change_light(world_, edits_, point)) continue;
    queries_.push_back({point, first_ray_index(probe) + i});
    places_.push_back(static_cast<int>(i));
  }
  direct_.resize(queries_.size());
  shadow_rays += direct_irradiance(
      world_, queries_, surfel_shading(settings_, *trace.rays, &solid_sides_), scratch_, direct_);
  for (std::size_t i = 0; i < queries_.size(); ++i) {
    trace.surfels[places_[i]].light = direct_[i];
  }
}

/// Computes the distances of a probe's rays from its surfels.
void ray_distances(const ProbeTrace& trace, const vec3& origin, std::vector<RayDistance>& seen) {
  seen.resize(trace.surfels.size());
  for (std::size_t i = 0; i < trace.surfels.size(); ++i) {
    const Surfel& surfel = trace.surfels[i];
    seen[i] = {surfel.distance_from(origin), surfel.kind == SurfelKind::solid_side};
  }
}

bool all_zero(std::span<const vec2> moments) {
  return std::all_of(moments.begin(), moments.end(), [](const vec2& m) { return m == vec2(0.0f); });
}

/// Shifts a probe's stored moments by the change in the moments of its rays.
void move_moments(int probe, std::span<const vec2> before, std::span<const vec2> after,
                  uint dither_seed, ProbeStore& store) {
  const int edge = store.distance_texels();
  const bool has_history = !all_zero(before) && !all_zero(after);
  std::vector<vec2> moments(after.size());
  for (std::size_t t = 0; t < moments.size(); ++t) {
    const ivec2 texel(static_cast<int>(t) % edge, static_cast<int>(t) / edge);
    const vec2 held = store.moments_texel(probe, texel + 1);
    moments[t] = shifted_moments(held, before[t], after[t], has_history);
  }
  store.blend_moments(probe, moments, 1.0f, dither_seed);
}

/// A probe whose rays have other distances than before, and their distances before.
struct MovedProbe {
  int probe;
  std::vector<RayDistance> before;
};

/// A probe of which some surfels need other lookups.
struct OtherSurfaces {
  int probe;
  SurfelFlags surfels;
};

/// The results of one task.
struct Part {
  std::uint64_t probe_rays = 0, shadow_rays = 0;
  std::vector<OtherSurfaces> other_surfaces;
  std::vector<MovedProbe> moved;
  std::vector<RayDistance> seen;  // scratch
  std::vector<float> lights;      // scratch
};

/// Stores the new distances of the moved probes.
void move_distances(const FieldSettings& settings, std::span<const MovedProbe> moved,
                    std::span<const ProbeTrace> traces, uint dither_seed, ProbeStore& store) {
  // Probes that were traced together share one matrix of ray weights
  std::map<const RaySet*, std::unique_ptr<const DistanceBlend>> blends;
  for (const MovedProbe& probe : moved) {
    const RaySet* rays = traces[probe.probe].rays.get();
    std::unique_ptr<const DistanceBlend>& blend = blends[rays];
    if (!blend) blend = std::make_unique<const DistanceBlend>(settings, rays->directions);
  }
  parallel_chunks(moved.size(), kProbesPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<RayDistance> after;
    for (std::size_t k = begin; k < end; ++k) {
      const int probe = moved[k].probe;
      const DistanceBlend& blend = *blends.at(traces[probe].rays.get());
      std::vector<vec2> moments_before(blend.texels()), moments_after(blend.texels());
      const float farthest = max_probe_distance(store.grid_of(probe));
      ray_distances(traces[probe], store.probe_position_ws(probe), after);
      blend.moments(moved[k].before, farthest, moments_before);
      blend.moments(after, farthest, moments_after);
      move_moments(probe, moments_before, moments_after, dither_seed, store);
    }
  });
}

/// Copies the direct light along a probe's rays.
void ray_lights(const ProbeTrace& trace, std::vector<float>& lights) {
  lights.clear();
  for (const Surfel& surfel : trace.surfels) lights.push_back(ray_light(surfel));
}

/// Compares the direct light along a probe's rays with that before an edit.
EditedLight compare_light(std::span<const float> before, const ProbeTrace& trace) {
  EditedLight sums{};
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Surfel& surfel = trace.surfels[i];
    sums = add_ray(sums, static_cast<uint>(surfel.kind), before[i], ray_light(surfel));
  }
  return sums;
}

/// Recomputes lookups that may have changed: those of changed surfels, and those that read a probe
/// with other distances. Returns the number of rays traced.
std::uint64_t renew_lookups(std::vector<OtherSurfaces> other_surfaces, std::span<const int> moved,
                            std::span<const int> all, const VisibilityRays& by,
                            const ProbeStore& store, std::span<ProbeTrace> traces) {
  std::sort(other_surfaces.begin(), other_surfaces.end(),
            [](const OtherSurfaces& a, const OtherSurfaces& b) { return a.probe < b.probe; });
  std::vector<int> others;
  others.reserve(other_surfaces.size());
  for (const OtherSurfaces& probe : other_surfaces) others.push_back(probe.probe);
  const std::vector<int> readers = probes_reading(moved, all, store, traces);
  std::vector<int> asking;
  std::set_union(readers.begin(), readers.end(), others.begin(), others.end(),
                 std::back_inserter(asking));
  // Where volumes blend, the weight of one depends on the visibility of the probes of others
  if (store.volumes() > 1) return find_surfel_lookups(store, by, asking, traces);
  std::vector<SurfelFlags> flagged(asking.size());
  std::size_t next = 0;
  for (std::size_t k = 0; k < asking.size() && next < other_surfaces.size(); ++k) {
    if (asking[k] == other_surfaces[next].probe) {
      flagged[k] = std::move(other_surfaces[next++].surfels);
    }
  }
  flag_readers(moved, asking, store, traces, flagged);
  return find_surfel_lookups(store, by, asking, flagged, traces);
}

}  // namespace

InvalidationResult invalidate_surfels(const World& world, const SolidSides& solid_sides,
                                      std::span<const WorldChanges> changes,
                                      const FieldSettings& settings, std::span<const int> probes,
                                      std::span<const int> all, const VisibilityRays& by,
                                      ProbeStore& store, std::span<ProbeTrace> traces,
                                      uint dither_seed) {
  const Edits edits(world, changes);
  const std::size_t tasks = (probes.size() + kProbesPerTask - 1) / kProbesPerTask;
  std::vector<Part> parts(tasks);
  InvalidationResult result;
  result.light.resize(probes.size());
  parallel_chunks(probes.size(), kProbesPerTask, [&](std::size_t begin, std::size_t end) {
    Part& part = parts[begin / kProbesPerTask];
    SurfelInvalidation invalidation(world, solid_sides, edits, settings);
    for (std::size_t k = begin; k < end; ++k) {
      const int probe = probes[k];
      const vec3 origin = store.probe_position_ws(probe);
      // Materials that become mirrors, or no longer are, change distances by rounding
      ray_distances(traces[probe], origin, part.seen);
      ray_lights(traces[probe], part.lights);
      const SurfelInvalidation::Outcome outcome =
          invalidation.update_probe(probe, origin, traces[probe]);
      result.light[k] = compare_light(part.lights, traces[probe]);
      if (outcome.other_surfaces) part.other_surfaces.push_back({probe, invalidation.changed()});
      if (outcome.moved) part.moved.push_back({probe, part.seen});
    }
    part.probe_rays = invalidation.probe_rays;
    part.shadow_rays = invalidation.shadow_rays;
  });

  std::vector<MovedProbe> moved;
  std::vector<OtherSurfaces> other_surfaces;
  for (Part& part : parts) {
    result.probe_rays += part.probe_rays;
    result.shadow_rays += part.shadow_rays;
    for (OtherSurfaces& probe : part.other_surfaces) other_surfaces.push_back(std::move(probe));
    for (MovedProbe& probe : part.moved) moved.push_back(std::move(probe));
  }
  move_distances(settings, moved, traces, dither_seed, store);
  for (const MovedProbe& probe : moved) result.moved.push_back(probe.probe);
  if (!other_surfaces.empty()) {
    result.shadow_rays +=
        renew_lookups(std::move(other_surfaces), result.moved, all, by, store, traces);
  }
  return result;
}

}  // namespace lambent
