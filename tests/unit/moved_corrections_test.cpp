// SPDX-License-Identifier: Apache-2.0
// Corrections of lookups around things that move.
#include "field/edits/moved_corrections.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "field/correction/correction_math.h"
#include "field/field_access.h"
#include "field/field_state.h"
#include "lambent/field.h"
#include "lambent/world.h"
#include "support/box_scenes.h"
#include "support/edited_field.h"

namespace lambent::moved_corrections_test {
namespace {

// Sides of the shade over the distance between probes: it has room for one of them, as that of a
// desk lamp has.
constexpr float kShadeOverSpacing = 1.2f;

/// A white shade that is open below, a bulb in it, and a grey room of 2 m around both. Instance 0
/// is the room.
Scene lampshade_in_a_room(float side) {
  Mesh shade = test::box_mesh(glm::vec3(-0.5f * side), glm::vec3(0.5f * side), true);
  shade.triangles.erase(shade.triangles.begin() + 4, shade.triangles.begin() + 6);
  shade.material = 1;
  Mesh bulb = test::box_mesh(glm::vec3(-0.1f * side), glm::vec3(0.1f * side));
  bulb.material = 2;
  Scene scene = test::scene_of(
      {test::box_mesh(glm::vec3(-1.0f), glm::vec3(1.0f), true), std::move(shade), std::move(bulb)});
  Material white = scene.materials[0];
  white.base_color = glm::vec4(0.9f, 0.9f, 0.9f, 1.0f);
  white.double_sided = true;
  scene.materials.push_back(white);
  white.emission = glm::vec3(100.0f);
  scene.materials.push_back(white);
  return scene;
}

void move_lamp(const glm::vec3& place, Scene& scene) {
  for (const int i : {1, 2}) scene.instances[i].world_from_object[3] = glm::vec4(place, 1.0f);
}

/// Sums of the samples of corrections in the eight cells around a probe, and in all others.
struct SampleSums {
  float near = 0.0f, far = 0.0f;
};

SampleSums corrections_around(const glm::vec3& probe, const IrradianceField& field) {
  const ProbeData& data = FieldAccess::state_of(field).data;
  const ProbeGrid& grid = data.store.grids()[0];
  SampleSums sums;
  for (const CorrectionBlock& block : data.correction.blocks()) {
    const glm::vec3 cells = glm::abs(block_centre(grid, block.key) - probe) / grid.spacing;
    const bool is_near = std::max({cells.x, cells.y, cells.z}) < 0.99f;
    for (const LearnedCorrection& cell : block.cells) {
      (is_near ? sums.near : sums.far) += cell.samples;
    }
  }
  return sums;
}

// Lookups within a shade that moved read corrections that were learned where it stood before.
// Those of a desk lamp returned more light than arrived, and a picture flashed.
TEST(MovedCorrections, AreForgottenWithinTheThing) {
  const FieldSettings settings = test::Edited::few();
  const Scene any = lampshade_in_a_room(0.1f);
  const FieldGrid grid = IrradianceField::make(settings, open_bounds(World(any)))->grids()[0];
  const float spacing = grid.spacing.x;
  const glm::vec3 probe = grid.origin + grid.spacing * 2.0f;
  Scene scene = lampshade_in_a_room(kShadeOverSpacing * spacing);
  move_lamp(probe + glm::vec3(0.3f * spacing, 0.0f, 0.0f), scene);
  test::Edited edited(std::move(scene), settings, 6);
  const SampleSums before = corrections_around(probe, edited.field);
  ASSERT_GT(before.near, 0.0f);
  move_lamp(probe + glm::vec3(0.25f * spacing, 0.0f, 0.0f), edited.scene);
  ASSERT_TRUE(edited.world.update().has_value());
  edited.field.update(edited.world);
  const SampleSums after = corrections_around(probe, edited.field);
  EXPECT_EQ(after.near, 0.0f);
  EXPECT_GT(after.far, 0.0f);
}

TEST(MovedCorrections, AreKeptWhereNothingMoved) {
  const Scene scene = lampshade_in_a_room(0.1f);
  const IrradianceField field =
      IrradianceField::make(test::Edited::few(), open_bounds(World(scene))).value();
  WorldChanges relit;
  relit.emission = true;
  EXPECT_TRUE(corrections_kept_by_moves({&relit, 1}, store_of(field)).empty());
}

}  // namespace
}  // namespace lambent::moved_corrections_test
