// SPDX-License-Identifier: Apache-2.0
// Grounds with things on them: gardens, landscapes, houses in their grounds.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "first_picture/subject.h"

namespace lambent {

// Grounds and what stands on them are at least this wide [m]: a smaller scene is a model of a
// place.
constexpr float kMinSiteWidth = 15.0f;

/// A ground of a human scale with things on it.
struct Site {
  std::vector<bool> is_ground;        ///< For each instance of the scene.
  std::vector<std::uint32_t> things;  ///< Instances of the subject that are on the ground.
  std::vector<bool> is_high;  ///< For each instance of the scene: a thing of at least 0.5 m.
  /// For each instance of the scene that is a thing: its mesh, or the first of many meshes that are
  /// alike, as each tree of a wood may be one.
  std::vector<int> kind;
  std::size_t kinds = 0;  ///< Number of different kinds among the things.
};

/// The site that a subject is, if it is one. Grounds that dwarf the subject count, too.
std::optional<Site> find_site(const World& world, const Subject& subject);

/// Whether a site's ground is a sheet, as terrains are: what has an underside may be a thing, such
/// as a circuit board.
bool is_sheet(const World& world, const Subject& subject, const Site& site);

/// The small part of a site that holds most kinds of its things, such as a furnished house among
/// trees, if there is one.
std::optional<Subject> find_heart(const World& world, const Subject& subject, const Site& site);

}  // namespace lambent
