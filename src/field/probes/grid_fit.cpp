// SPDX-License-Identifier: Apache-2.0
// The grid of probes that is fitted to a scene.
#include <algorithm>
#include <cmath>

#include "field/probes/volumes.h"
#include "lambent/field.h"
#include "scene/limits.h"

namespace lambent {
namespace {

// The outermost probes stand this fraction of a cell inside the bounds, so that the bounding
// surfaces are lit by probes just in front of them, and not by probes half a cell away
// (docs/math.md, "Probes belong at surfaces").
constexpr float kBoundaryMargin = 0.07f;

constexpr int kMinProbesPerAxis = 2;
// The coarsest grid, of one cell.
constexpr int kMinProbes = kMinProbesPerAxis * kMinProbesPerAxis * kMinProbesPerAxis;
// An extent gets another cell only if it exceeds whole cells by this fraction of one, which leaves
// room for rounding in the quotient.
constexpr float kCellRounding = 1e-4f;
// This many cells along an axis are more than any budget allows, and still fit into an int.
constexpr float kUncountableCells = 1e6f;
// No side of the volume is shorter than this fraction of the longest, so that flat scenes get a
// volume, too.
constexpr float kMinThickness = 1e-2f;
// A scene without extent gets a cell of this size [m].
constexpr float kSmallestScene = 1e-3f;

tl::unexpected<Error> bad_setting(const char* setting, std::string cause) {
  return fail("", setting, std::move(cause));
}

/// The least number of probes along each axis for a spacing.
glm::ivec3 count_for_spacing(const glm::vec3& extent, float spacing) {
  const glm::vec3 cells = glm::ceil(extent / spacing - kCellRounding);
  return glm::max(glm::ivec3(cells) + 1, glm::ivec3(kMinProbesPerAxis));
}

double product(const glm::ivec3& count) {
  return static_cast<double>(count.x) * count.y * count.z;
}

/// The most even grid of at most `budget` probes: the smallest spacing that fits, by bisection.
glm::ivec3 count_for_budget(const glm::vec3& extent, int budget) {
  float too_small = 0.0f;
  float fits = std::max(extent.x, std::max(extent.y, extent.z));
  constexpr int kBisections = 40;
  for (int i = 0; i < kBisections; ++i) {
    const float spacing = 0.5f * (too_small + fits);
    const bool countable = glm::all(glm::lessThan(extent / spacing, glm::vec3(kUncountableCells)));
    if (countable && product(count_for_spacing(extent, spacing)) <= budget) {
      fits = spacing;
    } else {
      too_small = spacing;
    }
  }
  return count_for_spacing(extent, fits);
}

}  // namespace

Expected<FieldGrid> fit_grid(const FieldSettings& settings, const Bounds& scene_bounds) {
  const bool given = settings.volume != Bounds{};
  Bounds bounds = given ? settings.volume : scene_bounds;
  if (!given && bounds.empty()) bounds = {glm::vec3(0.0f), glm::vec3(kSmallestScene)};
  if (!is_in_reach(bounds.min) || !is_in_reach(bounds.max)) {
    return bad_setting("volume", "the corners must be within 1e9 m of the origin");
  }
  const glm::vec3 size = bounds.max - bounds.min;
  if (glm::any(glm::lessThan(size, glm::vec3(0.0f)))) {
    return bad_setting("volume", "its upper corner lies below its lower corner");
  }
  const bool counted = settings.probe_count != glm::ivec3(0);
  if (counted && glm::any(glm::lessThan(settings.probe_count, glm::ivec3(kMinProbesPerAxis)))) {
    return bad_setting("probes", "a field needs at least 2 probes along each axis");
  }
  if (!(settings.probe_spacing >= 0.0f && settings.probe_spacing <= kMaxCoordinate)) {
    return bad_setting("probe spacing", "must be above 0 and at most 1e9 m");
  }
  if (settings.probe_budget < kMinProbes) return bad_setting("probe budget", "must be at least 8");

  // Give flat and empty boxes some thickness
  const float longest = std::max({size.x, size.y, size.z, kSmallestScene});
  const glm::vec3 extent = glm::max(size, glm::vec3(kMinThickness * longest));
  const glm::vec3 low = bounds.min - 0.5f * (extent - size);

  FieldGrid grid;
  if (counted) {
    grid.count = settings.probe_count;
  } else if (settings.probe_spacing > 0.0f) {
    if (longest / settings.probe_spacing > kMaxProbes) {
      return bad_setting("probe spacing", "is so small that probes could not be counted");
    }
    grid.count = count_for_spacing(extent, settings.probe_spacing);
  } else {
    grid.count = count_for_budget(extent, settings.probe_budget);
  }
  if (product(grid.count) > kMaxProbes) {
    return bad_setting("probes", "more than 1,048,576 probes; ask for a larger spacing");
  }

  // Place the outermost probes just inside: cells + 2 margins span the extent
  const glm::vec3 cells(grid.count - 1);
  const float margin = given ? 0.0f : kBoundaryMargin;
  grid.spacing = extent / (cells + 2.0f * margin);
  grid.origin = low + margin * grid.spacing;
  return grid;
}

}  // namespace lambent
