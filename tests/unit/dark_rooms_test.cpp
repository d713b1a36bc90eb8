// SPDX-License-Identifier: Apache-2.0
// Rooms in which no light is on, until one is, or a door opens; and walls in a layer of probes.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "field/edits/history_ratio_math.h"
#include "lambent/field.h"
#include "lambent/world.h"
#include "support/box_scenes.h"
#include "support/hand_made.h"

namespace lambent::dark_rooms_test {
namespace {

using test::box_mesh;
using test::scene_of;

Light lamp_at(const glm::vec3& position_ws) {
  return test::point_light(glm::vec3(10.0f), position_ws);
}

/// Irradiance of a surface at a point with this normal.
float light_on(const IrradianceField& field, const glm::vec3& position_ws,
               const glm::vec3& normal_ws = glm::vec3(0, 1, 0)) {
  const FieldQuery query{position_ws, normal_ws, normal_ws};
  glm::vec3 light(0.0f);
  field.irradiance({&query, 1}, {&light, 1});
  return light.y;
}

FieldSettings few_probes() {
  FieldSettings settings;
  settings.probe_spacing = 0.5f;
  return settings;
}

/// A field over a scene that may be edited.
struct Place {
  explicit Place(Scene made) : scene(std::move(made)), world(scene), field(fresh(world)) {
    update(8);
  }
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

  static IrradianceField fresh(const World& world) {
    return IrradianceField::make(few_probes(), open_bounds(world)).value();
  }
  void update(int times) {
    for (int i = 0; i < times; ++i) field.update(world);
  }
  void apply_edits() { ASSERT_TRUE(world.update()); }
  /// A field that has always known the scene as it is.
  IrradianceField settled() const {
    const World now(scene);
    IrradianceField made = fresh(now);
    for (int i = 0; i < 16; ++i) made.update(now);
    return made;
  }

  Scene scene;
  World world;
  IrradianceField field;
};

const glm::vec3 kDarkFloor(0.3f, 0.0f, 0.2f), kDarkCeiling(0.3f, 3.0f, 0.2f);

/// Two storeys with a thin ceiling between them, and a lamp in the upper one.
Scene two_storeys() {
  Scene scene = scene_of({box_mesh({-2, 0, -2}, {2, 3, 2}, /*inwards=*/true),
                          box_mesh({-2, 3.1f, -2}, {2, 6.1f, 2}, /*inwards=*/true)});
  scene.lights = {lamp_at({0.5f, 4.1f, 0.3f})};
  return scene;
}

TEST(DarkRoom, BesideALitOneStaysDark) {
  // The probes of what counted as solid matter were off, and lookups at its edges read those behind
  // the ceiling
  const Place place(two_storeys());
  EXPECT_GT(light_on(place.field, {0.3f, 3.1f, 0.2f}), 1.0f);
  EXPECT_LT(light_on(place.field, kDarkCeiling, {0, -1, 0}), 1e-3f);
  EXPECT_LT(light_on(place.field, kDarkFloor), 1e-3f);
}

TEST(DarkRoom, IsLitInTheUpdateAfterALampComesOn) {
  Place place(two_storeys());
  place.scene.lights.push_back(lamp_at({0.5f, 1.0f, 0.3f}));
  place.apply_edits();
  place.update(1);
  const float settled = light_on(place.settled(), kDarkFloor);
  EXPECT_NEAR(light_on(place.field, kDarkFloor) / settled, 1.0f, 0.15f);
  // It went on to 2 of what is right, as corrections were learned from old light
  place.update(4);
  EXPECT_NEAR(light_on(place.field, kDarkFloor) / settled, 1.0f, 0.1f);
}

/// Carries the lamp of two storeys down, and expects the upper one to be dark then.
void expect_lamp_takes_its_light_along(Scene storeys) {
  Place place(std::move(storeys));
  place.scene.lights[0].position_ws = {0.5f, 1.0f, 0.3f};
  place.apply_edits();
  place.update(5);
  EXPECT_LT(light_on(place.field, {0.3f, 3.1f, 0.2f}), 0.02f);
  EXPECT_NEAR(light_on(place.field, kDarkFloor) / light_on(place.settled(), kDarkFloor), 1.0f,
              0.1f);
}

TEST(DarkRoom, IsDarkAgainOnceItsLampIsCarriedAway) {
  expect_lamp_takes_its_light_along(two_storeys());
}

// The door is the last instance; moved by this, it is open.
const glm::vec3 kToOpen(0.0f, 0.0f, 1.1f);

/// A room without the side of this index, see box_mesh().
Mesh open_room(const glm::vec3& low, const glm::vec3& high, int side) {
  Mesh mesh = box_mesh(low, high, /*inwards=*/true);
  mesh.triangles.erase(mesh.triangles.begin() + 2 * side, mesh.triangles.begin() + 2 * side + 2);
  return mesh;
}

/// Two rooms, a lamp in one, and between them a wall with a door, which is shut.
Scene rooms_with_a_door() {
  Scene scene =
      scene_of({open_room({-2, 0, -2}, {2, 3, 2}, 1), open_room({2.2f, 0, -2}, {6.2f, 3, 2}, 0),
                box_mesh({2, 0, -2}, {2.2f, 3, -0.5f}), box_mesh({2, 0, 0.5f}, {2.2f, 3, 2}),
                box_mesh({2, 2, -0.5f}, {2.2f, 3, 0.5f}), box_mesh({2, -0.1f, -2}, {2.2f, 0, 2}),
                box_mesh({2.05f, 0.0f, -0.505f}, {2.15f, 2.005f, 0.505f})});
  scene.lights = {lamp_at({0.5f, 2.0f, 0.3f})};
  return scene;
}

void move_door(Place& place, const glm::vec3& by) {
  place.scene.instances.back().world_from_object[3] += glm::vec4(by, 0.0f);
  place.apply_edits();
}

/// The mean irradiance of the floor behind the door.
float light_behind_door(const IrradianceField& field) {
  float sum = 0.0f;
  for (int i = 0; i < 25; ++i) {
    sum += light_on(field, {3.4f + 0.4f * static_cast<float>(i % 5), 0.0f,
                            -0.8f + 0.4f * static_cast<float>(i / 5)});
  }
  return sum / 25.0f;
}

/// Opens the door, and expects the light behind it to be right from the next update on.
void expect_light_through_the_door(Place& place) {
  move_door(place, kToOpen);
  const float settled = light_behind_door(place.settled());
  EXPECT_GT(settled, 0.05f);
  for (int i = 0; i < 3; ++i) {
    place.update(1);
    EXPECT_NEAR(light_behind_door(place.field) / settled, 1.0f, 0.25f) << "update " << i;
  }
  place.update(13);
  EXPECT_NEAR(light_behind_door(place.field) / settled, 1.0f, 0.15f);
}

TEST(SolidMatter, OfAFineMeshThatIsWoundTheWrongWayIsNoRoom) {
  // Each of its triangles is seen too seldom to tell; all together they show their backs
  Scene scene = scene_of({box_mesh({-2, 0, -2}, {2, 3, 2}, /*inwards=*/true)});
  test::add(scene, test::sphere(0.9f, 48, 0),
            glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, 1.5f, 0.0f)));
  scene.lights = {lamp_at({1.5f, 2.5f, 1.5f})};
  const World world(scene);
  IrradianceField field = Place::fresh(world);
  const int off = field.update(world).states.off;
  for (glm::uvec3& triangle : scene.meshes[1].triangles) std::swap(triangle.y, triangle.z);
  const World turned(scene);
  IrradianceField other = Place::fresh(turned);
  EXPECT_GT(off, 0);
  EXPECT_EQ(other.update(turned).states.off, off);
}

TEST(DarkRoom, IsLitThroughADoorThatOpens) {
  for (const bool dynamic : {false, true}) {
    SCOPED_TRACE(dynamic);
    Scene scene = rooms_with_a_door();
    scene.instances.back().dynamic = dynamic;
    Place place(std::move(scene));
    EXPECT_LT(light_behind_door(place.field), 1e-3f);
    expect_light_through_the_door(place);
  }
}

TEST(DarkRoom, DoesNotFlashWhenItsDoorOpensAgain) {
  // Its light was 5.1 times what is right while what others reflect counted as its own light
  Scene scene = rooms_with_a_door();
  scene.instances.back().world_from_object[3] += glm::vec4(kToOpen, 0.0f);
  Place place(std::move(scene));
  move_door(place, -kToOpen);
  place.update(20);
  EXPECT_LT(light_behind_door(place.field), 5e-3f);
  expect_light_through_the_door(place);
}

// Of two-sided materials nothing tells a dark room from solid matter, until light gets in. Probes
// then find their places in one update, and light in the next.
TEST(DarkRoomOfTwoSidedMaterial, IsLitTwoUpdatesAfterALampComesOn) {
  Scene scene = two_storeys();
  scene.materials[0].double_sided = true;
  Place place(std::move(scene));
  place.scene.lights.push_back(lamp_at({0.5f, 1.0f, 0.3f}));
  place.apply_edits();
  place.update(2);
  const float settled = light_on(place.settled(), kDarkFloor);
  EXPECT_NEAR(light_on(place.field, kDarkFloor) / settled, 1.0f, 0.15f);
  place.update(4);
  EXPECT_NEAR(light_on(place.field, kDarkFloor) / settled, 1.0f, 0.1f);
}

TEST(DarkRoomOfTwoSidedMaterial, StaysARoomWhenItsLampIsCarriedAway) {
  // What is solid is found anew, as the lamp shines where all was closed. The room that it leaves
  // would be closed: the probes of its walls would be off, and it would glow
  Scene scene = two_storeys();
  scene.materials[0].double_sided = true;
  expect_lamp_takes_its_light_along(std::move(scene));
}

TEST(DarkRoomOfTwoSidedMaterial, IsFoundAgainAfterAReset) {
  Scene scene = two_storeys();
  scene.materials[0].double_sided = true;
  Place place(std::move(scene));
  place.scene.lights.push_back(lamp_at({0.5f, 1.0f, 0.3f}));
  place.apply_edits();
  place.field.reset();
  place.update(4);
  EXPECT_NEAR(light_on(place.field, kDarkFloor) / light_on(place.settled(), kDarkFloor), 1.0f,
              0.1f);
}

TEST(DarkRoomOfTwoSidedMaterial, IsLitTwoUpdatesAfterItsCeilingGlows) {
  Scene scene = two_storeys();
  scene.materials[0].double_sided = true;
  scene.materials.push_back(scene.materials[0]);
  test::add(scene, test::quad({-0.5f, 2.9f, -0.5f}, {1, 0, 0}, {0, 0, 1}, 1));
  Place place(std::move(scene));
  place.scene.materials[1].emission = glm::vec3(10.0f);
  place.apply_edits();
  place.update(2);
  EXPECT_NEAR(light_on(place.field, kDarkFloor) / light_on(place.settled(), kDarkFloor), 1.0f,
              0.2f);
}

TEST(DarkRoomOfTwoSidedMaterial, IsLitThroughADoorThatOpens) {
  for (const bool dynamic : {false, true}) {
    SCOPED_TRACE(dynamic);
    Scene scene = rooms_with_a_door();
    scene.materials[0].double_sided = true;
    scene.instances.back().dynamic = dynamic;
    Place place(std::move(scene));
    move_door(place, kToOpen);
    place.update(2);
    const float settled = light_behind_door(place.settled());
    EXPECT_NEAR(light_behind_door(place.field) / settled, 1.0f, 0.25f);
  }
}

TEST(HistoryShare, IsThatOfTheLightThatWasThere) {
  const ProbeAtEdit mean = {1.0f, 1.0f, 1.0f};
  // As bright as before: all of it
  EXPECT_EQ(history_share({1.0f, 1.0f, 1.0f}, mean), 1.0f);
  // Forty times the direct light, beside a tenth that others reflect: 4 * 1.1 of 40.1
  EXPECT_NEAR(history_share({1.0f, 1.0f, 40.0f}, mean), 4.4f / 40.1f, 1e-5f);
  // The first light of a dark room: next to nothing
  EXPECT_LT(history_share({1e-4f, 0.0f, 0.1f}, mean), 0.01f);
  EXPECT_EQ(history_share({0.0f, 0.0f, 0.1f}, mean), 0.0f);
  // No light anywhere
  EXPECT_EQ(history_share({0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}), 1.0f);
}

TEST(ProbesInAPlane, LightBothSidesOfASheet) {
  // All probes of the layer stayed in the sheet, saw nothing from there, and both sides were black
  Scene scene = scene_of({box_mesh({-2, 0, -2}, {2, 3, 2}, /*inwards=*/true)});
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].double_sided = true;
  test::add(scene, test::quad({0, 0, -1}, {0, 2, 0}, {0, 0, 2}, 1));
  scene.lights = {lamp_at({1.0f, 2.0f, 0.3f})};
  Place place(scene);
  place.update(24);
  ASSERT_EQ(place.field.grids()[0].count.x % 2, 1);
  // A sheet a little off the layer has always been right
  for (glm::vec3& position : scene.meshes[1].positions) position.x += 0.03f;
  Place beside(scene);
  beside.update(24);
  for (const float side : {-1.0f, 1.0f}) {
    for (float y = 0.25f; y < 1.9f; y += 0.5f) {
      const glm::vec3 normal(side, 0, 0);
      const float light = light_on(place.field, {0, y, 0.1f}, normal);
      const float right = light_on(beside.field, {0.03f, y, 0.1f}, normal);
      EXPECT_NEAR(light / right, 1.0f, 0.2f) << "side " << side << ", height " << y;
    }
  }
}

TEST(ProbesInAPlane, LightGroundUnderASky) {
  // A plain at a height of 0, a layer of probes at the same height: it was black
  Scene scene = scene_of({test::quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, 0)});
  scene.environment.radiance = glm::vec3(1.0f);
  Place place(std::move(scene));
  ASSERT_EQ(place.field.grids()[0].count.y % 2, 1);
  for (float x = -3.0f; x <= 3.0f; x += 1.0f) {
    EXPECT_NEAR(light_on(place.field, {x, 0.0f, 0.2f}), 3.1416f, 0.16f) << x;
  }
}

}  // namespace
}  // namespace lambent::dark_rooms_test
