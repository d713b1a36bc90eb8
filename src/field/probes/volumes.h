// SPDX-License-Identifier: Apache-2.0
// The volumes of a field, and how they scroll with the viewer.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "field/probes/probe_grid.h"
#include "lambent/error.h"
#include "lambent/field.h"
#include "scene/limits.h"

namespace lambent {

inline constexpr int kMaxCascades = 16;
// The most volumes of a field. More are most likely a typing error or a broken file.
inline constexpr std::uint32_t kMaxVolumes = 64;

// Below the first of these spacings [m], the square of a cell's size underflows. The second is as
// wide as the range of coordinates.
inline constexpr float kMinSpacing = 1e-15f, kMaxSpacing = kMaxCoordinate;

// The largest distance of a volume from the world's origin along an axis [m]: some millions of the
// widest cells, which is how far cascades scroll with a viewer.
inline constexpr float kMaxOrigin = 1e16f;

/// Whether all three coordinates are numbers.
bool is_finite(const vec3& v);

/// Whether the columns are unit and orthogonal.
bool is_rotation(const mat3& axes);

/// The role of a volume in a field.
struct VolumeRole {
  bool follows_viewer = false;
  int level =
      0;  ///< Cascade level, 0 the finest. Volumes of level L are updated every 2^L updates.
};

/// A volume that the settings request.
struct Volume {
  ProbeGrid grid;
  VolumeRole role;
};

std::vector<VolumeRole> roles_of(std::span<const Volume> volumes);
std::vector<ProbeGrid> grids_of(std::span<const Volume> volumes);

/// The grid of a volume that does not scroll. Its weight falls from 1 to 0 across a cell around its
/// probes.
ProbeGrid still_grid(const FieldGrid& grid);

/// The grids of a field's volumes as if none of them scrolled: in the same places, but not in the
/// same order in memory, and with weights that fall to 0 outside of the probes.
std::vector<ProbeGrid> still_grids(std::span<const FieldGrid> grids);

/// The grid of a volume, for the public interface.
FieldGrid field_grid(const ProbeGrid& grid);

/// The volumes that the settings request, in the order in which lookups use them. Cascades are
/// centred on the bounds. Fails as IrradianceField::make does.
Expected<std::vector<Volume>> plan_volumes(const FieldSettings& settings,
                                           const Bounds& scene_bounds);

/// Checks the settings, except those of volumes, against the ranges that FieldSettings states.
Expected<void> check_settings(const FieldSettings& settings);

/// Whether a volume can scroll: it is axis-aligned, has enough probes, and its origin is a whole
/// number of cells from the world's origin.
bool can_scroll(const ProbeGrid& grid);

/// The volume, moved in one step so that it is centred on the viewer.
ProbeGrid centred(const ProbeGrid& grid, const vec3& viewer_ws);

/// The volume after an update's scrolling. It scrolls in whole cells, and only when the viewer is
/// most of a cell off its middle. A walking viewer does not notice this: the box in which the
/// volume has a weight changes smoothly, and contains neither slabs that are about to be recycled
/// nor slabs that have just been recycled.
ProbeGrid scrolled(const ProbeGrid& grid, const vec3& viewer_ws);

/// The probes of `next` whose places are outside `before`, the same volume before scrolling.
std::vector<int> recycled_probes(const ProbeGrid& before, const ProbeGrid& next);

/// The volumes of a field after an update's scrolling, and the probes that have new places.
struct ScrolledVolumes {
  std::vector<ProbeGrid> grids;
  std::vector<int> recycled;
};

/// Scrolls those volumes that follow the viewer; with `at_once`, they are centred on the viewer.
/// `roles` has one entry per volume.
ScrolledVolumes scroll_volumes(std::span<const ProbeGrid> grids, std::span<const VolumeRole> roles,
                               const vec3& viewer_ws, bool at_once);

}  // namespace lambent
