// SPDX-License-Identifier: Apache-2.0
// The volumes of a field: which there are, and how they follow the viewer.
#pragma once

#include <cstdint>
#include <vector>

#include "field/probes/probe_grid.h"
#include "lambent/error.h"
#include "lambent/field.h"
#include "scene/limits.h"

namespace lambent {

inline constexpr int kMaxCascades = 16;
// Volumes of one field: more are a typing error or a broken file.
inline constexpr std::uint32_t kMaxVolumes = 64;

// Spacings below the first [m] have cells whose squared size is no number; none is wider than the
// range of coordinates.
inline constexpr float kMinSpacing = 1e-15f, kMaxSpacing = kMaxCoordinate;

// No volume starts farther from the world's origin along an axis [m]: some millions of the widest
// cells, which is how far cascades follow a viewer.
inline constexpr float kMaxOrigin = 1e16f;

/// Whether all three coordinates are numbers.
bool is_finite(const vec3& v);

/// Whether the columns are unit and orthogonal.
bool is_rotation(const mat3& axes);

/// What is known of a volume besides its grid.
struct VolumeRole {
  bool follows_viewer = false;
  int level = 0;  ///< Of a cascade: 0 the finest. Volumes of level L are updated every 2^L updates.
};

/// A volume as it is asked for.
struct Volume {
  ProbeGrid grid;
  VolumeRole role;
};

/// The grid of a volume that stays where it is. It counts within its box and, fading, a cell
/// around.
ProbeGrid still_grid(const FieldGrid& grid);

/// Where the probes of a volume belong.
FieldGrid field_grid(const ProbeGrid& grid);

/// The volumes that the settings ask for, in the order in which points ask them. Cascades lie
/// around the middle of the bounds. Fails as IrradianceField::make does.
Expected<std::vector<Volume>> plan_volumes(const FieldSettings& settings,
                                           const Bounds& scene_bounds);

/// Whether all but the volumes is within the range that FieldSettings says.
Expected<void> check_settings(const FieldSettings& settings);

/// Whether a volume is one that can follow: straight, of enough probes, and in place.
bool can_scroll(const ProbeGrid& grid);

/// A volume that follows the viewer, put around one.
ProbeGrid centred(const ProbeGrid& grid, const vec3& viewer_ws);

/// The same volume an update later, once it has followed the viewer: in whole cells, and not before
/// the viewer is most of a cell off its middle. Who walks does not see it move: the box in which it
/// counts changes smoothly, and holds neither slabs about to go nor slabs that have just come.
ProbeGrid scrolled(const ProbeGrid& grid, const vec3& viewer_ws);

/// Probes of `next` that belong where `before`, the same volume earlier, had none.
std::vector<int> recycled_probes(const ProbeGrid& before, const ProbeGrid& next);

}  // namespace lambent
