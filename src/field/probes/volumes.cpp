// SPDX-License-Identifier: Apache-2.0
#include "field/probes/volumes.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "raytracing/boxes.h"
#include "scene/validate.h"

namespace lambent {
namespace {

// The default number of probes of a cascade. It is wide rather than high, as most scenes are
// (McGuire, "Dynamic diffuse global illumination with ray-traced irradiance fields", GDC 2019).
const ivec3 kCascadeProbes(32, 4, 32);
constexpr float kFinestSpacing = 1.0f;  // [m]

// A volume scrolls when the viewer is more than this many cells off its middle. This is more than
// half a cell, so that small movements back and forth do not scroll the volume each time.
constexpr float kScrollSlack = 0.75f;
// A viewer this far off [cells] was teleported, and the volume is moved in one step.
constexpr float kTeleportDistance = 2.0f;
// Along axes with fewer probes, kScrollSlack would make the box in which the volume has a weight
// too small.
constexpr int kLongAxis = 8;
// How far the sides of the box in which a volume has a weight move per update [cells], where they
// do not move with the viewer: a cell takes half a second at 60 Hz.
constexpr float kFadeRate = 1.0f / 32.0f;
// For each cell that the viewer is off beyond kScrollSlack, the rate grows by this many times
// kFadeRate.
constexpr float kFadeCatchUp = 8.0f;

// The farthest place of a probe from the world's origin [cells]: floats count cells up to there.
constexpr float kFarthestCell = 4194304.0f;
// With fewer probes along an axis, the box in which a cascade has a weight would be empty.
constexpr int kMinCascadeProbes = 4;

// The most probes of a volume for which neither count nor spacing is given.
constexpr int kVolumeBudget = 512;

// Volumes fade into the next one across this many cells, beginning one cell beyond their probes.
constexpr float kFadeCells = 1.0f;
// Cascades fade across at least this fraction of their probes along an axis, so that a walking
// viewer does not notice.
constexpr float kFadeShare = 0.125f;

// The largest error of a column of a matrix that still counts as a rotation.
constexpr float kRotationSlack = 1e-3f;

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
  if (const char* flaw = flaw_of(asked)) return bad_volume(asked, flaw);
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

float finest_spacing(const FieldSettings& settings) {
  return settings.probe_spacing > 0.0f ? settings.probe_spacing : kFinestSpacing;
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
  const float finest = finest_spacing(settings);
  const float coarsest = std::ldexp(finest, settings.cascades - 1);
  // Written so that NaN fails
  if (!(settings.probe_spacing >= 0.0f) || finest < kMinSpacing || coarsest > kMaxSpacing) {
    return fail("", "probe spacing", "must be 1e-15 m to 1e9 m, also of the coarsest cascade");
  }
  return {};
}

/// The range along one axis in which a volume has a weight [cells from probe 0].
struct Range {
  float low, high;
};

float approach(float value, float target, float rate) {
  const float way = target - value;
  return std::abs(way) <= rate ? target : value + std::copysign(rate, way);
}

/// How many cells a volume scrolls along one axis, and the range in which it has a weight
/// afterwards.
struct Step {
  int cells;
  Range counts;
};

/// The next step of a volume with `count` probes along an axis, where the viewer is `off` its
/// middle [cells].
///
/// Along a long axis, the range is centred on the viewer and excludes the slabs that are recycled.
/// Along a short axis, such a range would be too small. There the range extends a cell beyond the
/// probes, like that of a volume that does not scroll, and excludes a slab only when the volume is
/// about to scroll.
Step scroll_along(float off, const Range& counts, int count) {
  const float last = static_cast<float>(count - 1);
  const int cells = static_cast<int>(std::round(off));
  if (count >= kLongAxis) {
    const int moved = std::abs(off) > kScrollSlack ? cells : 0;
    const float ahead = off - static_cast<float>(moved);
    return {moved, {ahead + kScrollSlack, ahead + last - kScrollSlack}};
  }
  const Range whole = {-kFadeCells, last + kFadeCells};
  if (std::abs(off) > kTeleportDistance) return {cells, whole};

  // Neither the slab that is about to be recycled nor its new place may have a weight
  const int wants = std::abs(off) <= kScrollSlack ? 0 : off > 0.0f ? 1 : -1;
  const Range target = wants == 0  ? whole
                       : wants > 0 ? Range{1.0f, last}
                                   : Range{0.0f, last - 1.0f};
  // Move faster, the farther off the viewer is
  const float late = max(std::abs(off) - kScrollSlack, 0.0f);
  const float rate = kFadeRate * (1.0f + kFadeCatchUp * late);
  const Range next = {approach(counts.low, target.low, rate),
                      approach(counts.high, target.high, rate)};
  if (wants == 0 || next.low != target.low || next.high != target.high) return {0, next};
  const float moved = static_cast<float>(wants);
  return {wants, {next.low - moved, next.high - moved}};
}

Volume plan_cascade(const FieldSettings& settings, int level, const vec3& middle) {
  FieldGrid grid;
  grid.count = settings.probe_count != ivec3(0) ? settings.probe_count : kCascadeProbes;
  grid.spacing = vec3(std::ldexp(finest_spacing(settings), level));
  return {centred(still_grid(grid), middle), {true, level}};
}

}  // namespace

bool is_finite(const vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool is_rotation(const mat3& axes) {
  const mat3 product = glm::transpose(axes) * axes;
  for (int c = 0; c < 3; ++c) {
    const vec3 off = product[c] - mat3(1.0f)[c];
    // Written so that NaN fails
    if (!(length(off) <= kRotationSlack)) return false;
  }
  return glm::determinant(axes) > 0.0f;
}

std::vector<VolumeRole> roles_of(std::span<const Volume> volumes) {
  std::vector<VolumeRole> roles;
  for (const Volume& volume : volumes) roles.push_back(volume.role);
  return roles;
}

std::vector<ProbeGrid> grids_of(std::span<const Volume> volumes) {
  std::vector<ProbeGrid> grids;
  for (const Volume& volume : volumes) grids.push_back(volume.grid);
  return grids;
}

ProbeGrid still_grid(const FieldGrid& grid) {
  const vec3 half = 0.5f * vec3(grid.count - 1);
  return {grid.origin, grid.spacing, grid.axes,         grid.count,      ivec3(0),
          0,           half,         half + kFadeCells, vec3(kFadeCells)};
}

std::vector<ProbeGrid> still_grids(std::span<const FieldGrid> grids) {
  std::vector<ProbeGrid> still;
  for (const FieldGrid& grid : grids) still.push_back(still_grid(grid));
  return still;
}

FieldGrid field_grid(const ProbeGrid& grid) {
  return {grid.origin_ws, grid.spacing, grid.count, grid.axes};
}

bool can_scroll(const ProbeGrid& grid) {
  const vec3 place = grid.origin_ws / grid.spacing;
  return grid.axes == mat3(1.0f) &&
         glm::all(glm::greaterThanEqual(grid.count, ivec3(kMinCascadeProbes))) &&
         glm::all(glm::lessThanEqual(abs(place), vec3(2.0f * kFarthestCell))) &&
         glm::round(place) * grid.spacing == grid.origin_ws;
}

ProbeGrid centred(const ProbeGrid& grid, const vec3& viewer_ws) {
  // Scroll from so far away that the volume moves in one step
  ProbeGrid away = grid;
  const vec3 viewer = clamp(viewer_ws / grid.spacing, vec3(-kFarthestCell), vec3(kFarthestCell));
  away.origin_ws = (floor(viewer) - 2.0f * vec3(grid.count)) * grid.spacing;
  return scrolled(away, viewer_ws);
}

ProbeGrid scrolled(const ProbeGrid& grid, const vec3& viewer_ws) {
  ProbeGrid next = grid;
  // The place of probe 0 in cells from the world's origin
  ivec3 place = ivec3(glm::round(grid.origin_ws / grid.spacing));
  for (int axis = 0; axis < 3; ++axis) {
    const int count = grid.count[axis];
    const float viewer = clamp(viewer_ws[axis] / grid.spacing[axis], -kFarthestCell, kFarthestCell);
    const float off =
        viewer - static_cast<float>(place[axis]) - 0.5f * static_cast<float>(count - 1);
    const Range counts = {grid.fade_centre[axis] - grid.fade_half[axis],
                          grid.fade_centre[axis] + grid.fade_half[axis]};
    const Step step = scroll_along(off, counts, count);
    next.fade_centre[axis] = 0.5f * (step.counts.low + step.counts.high);
    next.fade_half[axis] = 0.5f * (step.counts.high - step.counts.low);
    next.fade_cells[axis] = max(kFadeCells, kFadeShare * static_cast<float>(count));
    place[axis] += step.cells;
    const int scroll = (grid.scroll[axis] + step.cells) % count;
    next.scroll[axis] = scroll < 0 ? scroll + count : scroll;
  }
  next.origin_ws = vec3(place) * grid.spacing;
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

ScrolledVolumes scroll_volumes(std::span<const ProbeGrid> grids, std::span<const VolumeRole> roles,
                               const vec3& viewer_ws, bool at_once) {
  ScrolledVolumes scrolling{{grids.begin(), grids.end()}, {}};
  for (std::size_t volume = 0; volume < grids.size(); ++volume) {
    if (!roles[volume].follows_viewer) continue;
    ProbeGrid& next = scrolling.grids[volume];
    next = at_once ? centred(next, viewer_ws) : scrolled(next, viewer_ws);
    const std::vector<int> probes = recycled_probes(grids[volume], next);
    scrolling.recycled.insert(scrolling.recycled.end(), probes.begin(), probes.end());
  }
  return scrolling;
}

Expected<std::vector<Volume>> plan_volumes(const FieldSettings& settings,
                                           const Bounds& scene_bounds) {
  if (!scene_bounds.empty() && (!is_in_reach(scene_bounds.min) || !is_in_reach(scene_bounds.max))) {
    return fail("", "scene bounds", "must be within 1e9 m of the origin");
  }
  // Sort authored volumes by priority, and those of equal priority with the finest first
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
  volumes.reserve(asked.size());
  for (const Asked& one : asked) volumes.push_back(one.volume);

  // Add the volume or the cascades that cover everything
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

  if (volumes.size() > kMaxVolumes) {
    return fail("", "volumes", "are more than 64 in all");
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
