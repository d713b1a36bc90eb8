// SPDX-License-Identifier: Apache-2.0
#include "field/volumes.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "raytracing/boxes.h"

namespace lambent {
namespace {

// Wide rather than high, as most places are (McGuire, "Dynamic diffuse global illumination with
// ray-traced irradiance fields", GDC 2019).
const ivec3 kCascadeProbes(32, 4, 32);
constexpr float kFinestSpacing = 1.0f;  // [m]

// Cells that the viewer may be off a volume's middle before that follows: more than half of one, so
// that who moves to and fro does not drag it along.
constexpr float kScrollSlack = 0.75f;
// With fewer probes along an axis nothing is left to count once the slack is taken off.
constexpr int kMinCascadeProbes = 4;

// Probes of a volume for which neither count nor spacing is given.
constexpr int kVolumeBudget = 512;

// Columns of a rotation are unit and orthogonal to within this.
constexpr float kRotationSlack = 1e-3f;

bool is_finite(const vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

tl::unexpected<Error> bad_volume(const ProbeVolume& volume, std::string cause) {
  return fail("", volume.name.empty() ? "volume" : "volume '" + volume.name + "'",
              std::move(cause));
}

/// World-space box around a volume.
Bounds bounds_of(const ProbeVolume& volume) {
  const mat3& axes = volume.axes;
  const vec3 half = 0.5f * (mat3(abs(axes[0]), abs(axes[1]), abs(axes[2])) * volume.size);
  return {volume.centre - half, volume.centre + half};
}

Expected<Volume> plan_volume(const ProbeVolume& asked, const Bounds& scene_bounds) {
  if (!is_finite(asked.centre) || !is_finite(asked.size)) {
    return bad_volume(asked, "its place and size must be finite numbers");
  }
  if (!is_rotation(asked.axes)) return bad_volume(asked, "its axes are no rotation");
  if (!scene_bounds.empty() && !overlap(bounds_of(asked), scene_bounds)) {
    return bad_volume(asked, "lies outside the scene");
  }
  FieldSettings settings;
  settings.probe_count = asked.probe_count;
  settings.probe_spacing = asked.probe_spacing;
  settings.probe_budget = kVolumeBudget;
  settings.volume = {-0.5f * asked.size, 0.5f * asked.size};
  Expected<FieldGrid> grid = fit_grid(settings, {});
  if (!grid) return bad_volume(asked, grid.error().place + ": " + grid.error().cause);
  grid->axes = asked.axes;
  grid->origin = asked.centre + asked.axes * grid->origin;
  return Volume{still_grid(*grid), {}};
}

Expected<void> check_cascades(const FieldSettings& settings) {
  if (settings.cascades < 0 || settings.cascades > kMaxCascades) {
    return fail("", "cascades", "must be 0 to 16");
  }
  if (settings.cascades == 0) return {};
  if (settings.volume != Bounds{}) {
    return fail("", "cascades", "follow the viewer: no volume can be given with them");
  }
  if (settings.probe_count != ivec3(0) &&
      glm::any(glm::lessThan(settings.probe_count, ivec3(kMinCascadeProbes)))) {
    return fail("", "probes", "a cascade needs at least 4 probes along each axis");
  }
  if (!std::isfinite(settings.probe_spacing) || settings.probe_spacing < 0.0f) {
    return fail("", "probe spacing", "must be a finite number of metres above 0");
  }
  return {};
}

Volume plan_cascade(const FieldSettings& settings, int level, const vec3& middle) {
  const float finest = settings.probe_spacing > 0.0f ? settings.probe_spacing : kFinestSpacing;
  FieldGrid grid;
  grid.count = settings.probe_count != ivec3(0) ? settings.probe_count : kCascadeProbes;
  grid.spacing = vec3(std::ldexp(finest, level));
  // Far away from anywhere, so that it follows
  grid.origin = floor(middle / grid.spacing - vec3(grid.count)) * grid.spacing;
  return {following(still_grid(grid), middle), {true, level}};
}

}  // namespace

bool is_rotation(const mat3& axes) {
  const mat3 product = glm::transpose(axes) * axes;
  for (int c = 0; c < 3; ++c) {
    const vec3 off = product[c] - mat3(1.0f)[c];
    // Written so that NaN fails
    if (!(length(off) <= kRotationSlack)) return false;
  }
  return true;
}

ProbeGrid still_grid(const FieldGrid& grid) {
  const vec3 half = 0.5f * vec3(grid.count - 1);
  return {grid.origin, grid.spacing, grid.axes, grid.count, ivec3(0), 0, half, half + kFadeCells};
}

FieldGrid field_grid(const ProbeGrid& grid) {
  return {grid.origin_ws, grid.spacing, grid.count, grid.axes};
}

ProbeGrid following(const ProbeGrid& grid, const vec3& viewer_ws) {
  ProbeGrid next = grid;
  const vec3 half = 0.5f * vec3(grid.count - 1);
  const vec3 ideal = viewer_ws / grid.spacing - half;
  // Of probe 0, counted in cells from the world's origin
  const ivec3 before = ivec3(glm::round(grid.origin_ws / grid.spacing));
  ivec3 place = before;
  for (int axis = 0; axis < 3; ++axis) {
    const float off = ideal[axis] - static_cast<float>(place[axis]);
    if (std::abs(off) > kScrollSlack) place[axis] = static_cast<int>(std::round(ideal[axis]));
  }
  for (int axis = 0; axis < 3; ++axis) {
    const int scroll = (grid.scroll[axis] + place[axis] - before[axis]) % grid.count[axis];
    next.scroll[axis] = scroll < 0 ? scroll + grid.count[axis] : scroll;
  }
  next.origin_ws = vec3(place) * grid.spacing;
  next.fade_centre = viewer_ws / grid.spacing - vec3(place);
  next.fade_half = half - kScrollSlack;
  return next;
}

std::vector<int> recycled_probes(const ProbeGrid& before, const ProbeGrid& next) {
  const ivec3 moved = ivec3(glm::round((next.origin_ws - before.origin_ws) / next.spacing));
  std::vector<int> recycled;
  if (moved == ivec3(0)) return recycled;
  for (int i = 0; i < probe_count(next); ++i) {
    const int probe = next.first + i;
    const ivec3 was = probe_coords(next, probe) + moved;
    if (glm::any(glm::lessThan(was, ivec3(0))) ||
        glm::any(glm::greaterThanEqual(was, next.count))) {
      recycled.push_back(probe);
    }
  }
  return recycled;
}

Expected<std::vector<Volume>> plan_volumes(const FieldSettings& settings,
                                           const Bounds& scene_bounds) {
  // Authored volumes by priority, finest first
  struct Asked {
    int priority;
    Volume volume;
  };
  std::vector<Asked> asked;
  for (const ProbeVolume& volume : settings.volumes) {
    Expected<Volume> planned = plan_volume(volume, scene_bounds);
    if (!planned) return tl::unexpected(planned.error());
    asked.push_back({volume.priority, *planned});
  }
  std::stable_sort(asked.begin(), asked.end(), [](const Asked& a, const Asked& b) {
    if (a.priority != b.priority) return a.priority > b.priority;
    return smallest_spacing(a.volume.grid) < smallest_spacing(b.volume.grid);
  });
  std::vector<Volume> volumes;
  for (const Asked& one : asked) volumes.push_back(one.volume);

  // Then what answers for everywhere
  if (const Expected<void> fine = check_cascades(settings); !fine) {
    return tl::unexpected(fine.error());
  }
  if (settings.cascades > 0) {
    const vec3 middle =
        scene_bounds.empty() ? vec3(0.0f) : 0.5f * (scene_bounds.min + scene_bounds.max);
    for (int level = 0; level < settings.cascades; ++level) {
      volumes.push_back(plan_cascade(settings, level, middle));
    }
  } else {
    const Expected<FieldGrid> grid = fit_grid(settings, scene_bounds);
    if (!grid) return tl::unexpected(grid.error());
    if (settings.volume != Bounds{} && !scene_bounds.empty() &&
        !overlap(settings.volume, scene_bounds)) {
      return fail("", "volume", "lies outside the scene");
    }
    volumes.push_back({still_grid(*grid), {}});
  }

  double probes = 0.0;
  for (const Volume& volume : volumes) {
    const vec3 count(volume.grid.count);
    probes += static_cast<double>(count.x) * count.y * count.z;
  }
  if (probes > kMaxProbes) {
    return fail("", "probes",
                "more than 1,048,576 probes in all volumes; ask for a larger spacing");
  }
  return volumes;
}

}  // namespace lambent
