// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "lambent/world.h"
#include "scenes/builtin.h"
#include "scenes/recipes.h"
#include "support/hand_made.h"

namespace lambent::animation_test {
namespace {

using testing::HasSubstr;

constexpr float kNoise = 1e-5f;

Curve curve(Interpolation interpolation, int components, std::vector<float> times,
            std::vector<float> values) {
  return {interpolation, components, std::move(times), std::move(values)};
}

float value_at(const Curve& c, float time) {
  float value = 0.0f;
  evaluate(c, time, false, &value);
  return value;
}

TEST(Curve, StaysAtItsEndsBeyondThem) {
  for (const Interpolation kind : {Interpolation::step, Interpolation::linear}) {
    const Curve c = curve(kind, 1, {1.0f, 3.0f}, {5.0f, 9.0f});
    EXPECT_EQ(value_at(c, -4.0f), 5.0f);
    EXPECT_EQ(value_at(c, 1.0f), 5.0f);
    EXPECT_EQ(value_at(c, 3.0f), 9.0f);
    EXPECT_EQ(value_at(c, 70.0f), 9.0f);
  }
  const Curve one = curve(Interpolation::cubic, 1, {2.0f}, {100.0f, 7.0f, 100.0f});
  for (const float time : {0.0f, 2.0f, 3.0f}) EXPECT_EQ(value_at(one, time), 7.0f);
}

TEST(Curve, StepsHoldUntilTheNextKey) {
  const Curve c = curve(Interpolation::step, 1, {0.0f, 1.0f, 2.0f}, {1.0f, 2.0f, 3.0f});
  EXPECT_EQ(value_at(c, 0.999f), 1.0f);
  EXPECT_EQ(value_at(c, 1.0f), 2.0f);
  EXPECT_EQ(value_at(c, 1.5f), 2.0f);
}

TEST(Curve, LinearOnesGoStraight) {
  const Curve c = curve(Interpolation::linear, 2, {1.0f, 3.0f, 4.0f}, {0, 10, 4, 20, 4, 0});
  std::array<float, 2> value{};
  evaluate(c, 1.5f, false, value.data());
  EXPECT_FLOAT_EQ(value[0], 1.0f);
  EXPECT_FLOAT_EQ(value[1], 12.5f);
  evaluate(c, 3.25f, false, value.data());
  EXPECT_FLOAT_EQ(value[0], 4.0f);
  EXPECT_FLOAT_EQ(value[1], 15.0f);
}

TEST(Curve, CubicOnesScaleTheirTangentsByTheTimeBetweenKeys) {
  // x^2 has the derivatives 2 x: the spline is exact, whatever the distance of the keys
  for (const float end : {0.5f, 1.0f, 4.0f}) {
    const Curve c = curve(Interpolation::cubic, 1, {0.0f, end},
                          {99.0f, 0.0f, 0.0f, 2.0f * end, end * end, 99.0f});
    for (const float share : {0.1f, 0.5f, 0.9f}) {
      const float x = share * end;
      EXPECT_NEAR(value_at(c, x), x * x, kNoise);
    }
  }
  // The same of x^3
  const Curve cube = curve(Interpolation::cubic, 1, {1.0f, 3.0f}, {0, 1, 3, 27, 27, 0});
  EXPECT_NEAR(value_at(cube, 2.0f), 8.0f, kNoise);
  EXPECT_NEAR(value_at(cube, 2.5f), 15.625f, kNoise);
}

glm::quat rotation_at(const Curve& c, float time) {
  std::array<float, 4> q{};
  evaluate(c, time, true, q.data());
  return {q[3], q[0], q[1], q[2]};
}

Curve turn(Interpolation kind, float from_degrees, float to_degrees, float sign = 1.0f) {
  const auto about_y = [](float degrees) {
    return glm::angleAxis(glm::radians(degrees), glm::vec3(0, 1, 0));
  };
  const glm::quat a = about_y(from_degrees), b = about_y(to_degrees) * sign;
  return curve(kind, 4, {0.0f, 2.0f}, {a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w});
}

TEST(Curve, RotationsGoAroundAtAConstantRateOnTheShorterWay) {
  for (const float sign : {1.0f, -1.0f}) {
    const Curve c = turn(Interpolation::linear, 10.0f, 130.0f, sign);
    for (const float time : {0.25f, 0.5f, 1.0f, 1.7f}) {
      const glm::vec3 x = rotation_at(c, time) * glm::vec3(1, 0, 0);
      const float angle = glm::degrees(std::atan2(-x.z, x.x));
      EXPECT_NEAR(angle, 10.0f + 60.0f * time, 1e-3f);
    }
  }
  // So close that the arc is a line
  const glm::vec3 x =
      rotation_at(turn(Interpolation::linear, 0.0f, 0.2f), 1.0f) * glm::vec3(1, 0, 0);
  EXPECT_NEAR(glm::degrees(std::atan2(-x.z, x.x)), 0.1f, 1e-4f);
}

TEST(Curve, RotationsAreUnitEvenWhereTheirKeysAreNot) {
  const Curve long_ones = curve(Interpolation::step, 4, {0.0f}, {0, 3, 0, 4});
  EXPECT_NEAR(glm::length(rotation_at(long_ones, 0.0f)), 1.0f, kNoise);
  const Curve none = curve(Interpolation::step, 4, {0.0f}, {0, 0, 0, 0});
  EXPECT_EQ(rotation_at(none, 0.0f), glm::quat(1, 0, 0, 0));
  const Curve cubic =
      curve(Interpolation::cubic, 4, {0.0f, 1.0f}, {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0,  //
                                                    0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0});
  EXPECT_NEAR(glm::length(rotation_at(cubic, 0.5f)), 1.0f, kNoise);
  EXPECT_NEAR(rotation_at(cubic, 0.5f).y, std::sqrt(0.5f), kNoise);
}

/// One triangle whose node hangs from another that stands at x = 10; a light, a camera.
Scene rigged() {
  Scene scene;
  scene.materials.push_back(test::lambert(glm::vec3(0.5f)));
  test::add(scene, test::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0));
  scene.lights.push_back(test::point_light(glm::vec3(2.0f), {7, 7, 7}));
  scene.cameras.push_back(look_at({0, 0, 5}, {0, 0, 0}, 1.0f));
  RigNode parent, child;
  parent.translation = {10, 0, 0};
  child.parent = 0;
  scene.rig.nodes = {parent, child};
  scene.animations.emplace_back();
  return scene;
}

Channel drive(Channel::Target target, int index, int components, std::vector<float> from,
              const std::vector<float>& to) {
  from.insert(from.end(), to.begin(), to.end());
  return {target, index, curve(Interpolation::linear, components, {0.0f, 1.0f}, std::move(from))};
}

TEST(Animate, MovesInstancesWithTheParentsOfTheirNodes) {
  Scene scene = rigged();
  scene.rig.instances.push_back({0, 1, glm::mat4(1.0f)});
  scene.animations[0].channels = {
      drive(Channel::Target::node_translation, 0, 3, {10, 0, 0}, {10, 2, 0}),
      drive(Channel::Target::node_scale, 1, 3, {1, 1, 1}, {3, 1, 1})};
  ASSERT_TRUE(validate(scene));
  animate(scene, 0, 0.5f);
  const glm::vec4 corner = scene.instances[0].world_from_object * glm::vec4(1, 0, 0, 1);
  EXPECT_NEAR(corner.x, 12.0f, kNoise);
  EXPECT_NEAR(corner.y, 1.0f, kNoise);
  // What is scaled to nothing can still be traced
  scene.animations[0].channels[1] = drive(Channel::Target::node_scale, 1, 3, {1, 1, 1}, {0, 0, 0});
  animate(scene, -1, 1.0f);
  EXPECT_TRUE(validate(scene));
  EXPECT_NEAR(scene.instances[0].world_from_object[3].y, 2.0f, kNoise);
}

TEST(Animate, LeavesAloneWhatNothingDrives) {
  Scene scene = rigged();
  scene.rig.instances.push_back({0, 1, glm::mat4(1.0f)});
  scene.rig.lights.push_back({0, -1, glm::vec3(1.0f), 2.0f});
  scene.animations[0].channels = {drive(Channel::Target::light_intensity, 0, 1, {2}, {4})};
  const glm::mat4 place = scene.instances[0].world_from_object;
  animate(scene, 0, 0.5f);
  EXPECT_EQ(scene.instances[0].world_from_object, place);
  EXPECT_EQ(scene.lights[0].position_ws, glm::vec3(7.0f));
  EXPECT_EQ(scene.lights[0].intensity, glm::vec3(3.0f));
}

TEST(Animate, GoesToTheRestValueOfWhatAnotherAnimationDrives) {
  Scene scene = rigged();
  scene.rig.instances.push_back({0, 0, glm::mat4(1.0f)});
  scene.animations.resize(2);
  scene.animations[0].channels = {
      drive(Channel::Target::node_translation, 0, 3, {0, 0, 0}, {0, 4, 0})};
  animate(scene, 0, 1.0f);
  EXPECT_EQ(glm::vec3(scene.instances[0].world_from_object[3]), glm::vec3(0, 4, 0));
  animate(scene, 1, 1.0f);
  EXPECT_EQ(glm::vec3(scene.instances[0].world_from_object[3]), glm::vec3(10, 0, 0));
}

TEST(Animate, GoesBackToRest) {
  Scene scene = rigged();
  scene.rig.instances.push_back({0, 0, glm::mat4(1.0f)});
  scene.rig.lights.push_back({0, -1, glm::vec3(1.0f), 2.0f});
  scene.animations[0].channels = {
      drive(Channel::Target::node_translation, 0, 3, {0, 0, 0}, {0, 4, 0}),
      drive(Channel::Target::light_intensity, 0, 1, {5}, {9})};
  animate(scene, -1, 1.0f);
  EXPECT_EQ(glm::vec3(scene.instances[0].world_from_object[3]), glm::vec3(0, 4, 0));
  EXPECT_EQ(scene.lights[0].intensity, glm::vec3(9.0f));
  rest(scene);
  EXPECT_EQ(glm::vec3(scene.instances[0].world_from_object[3]), glm::vec3(10, 0, 0));
  EXPECT_EQ(scene.lights[0].intensity, glm::vec3(2.0f));
}

TEST(Animate, DrivesLightsCamerasAndMaterials) {
  using Target = Channel::Target;
  Scene scene = rigged();
  scene.lights[0].type = Light::Type::spot;
  scene.lights[0].direction_ws = {0, 0, -1};
  scene.rig.lights.push_back({0, 0, glm::vec3(1.0f), 2.0f});
  scene.rig.cameras.push_back({0, 1});
  scene.rig.materials.push_back({0, glm::vec4(1.0f), 0.0f, 1.0f, glm::vec3(1, 0, 0), 4.0f});
  const float half = std::sqrt(0.5f);
  scene.animations[0].channels = {
      drive(Target::node_rotation, 0, 4, {0, 0, 0, 1}, {0, half, 0, half}),
      drive(Target::light_color, 0, 3, {1, 1, 1}, {0, 0.5f, 1}),
      drive(Target::light_range, 0, 1, {0}, {8}),
      drive(Target::light_inner_cone_angle, 0, 1, {0}, {2}),
      drive(Target::light_outer_cone_angle, 0, 1, {1}, {0.5f}),
      drive(Target::camera_vertical_fov, 0, 1, {1}, {2}),
      drive(Target::material_base_color, 0, 4, {0, 0, 0, 1}, {1, 2, 0.5f, 1}),
      drive(Target::material_roughness, 0, 1, {0}, {0.5f}),
      drive(Target::material_emissive_strength, 0, 1, {0}, {10})};
  ASSERT_TRUE(validate(scene));
  animate(scene, -1, 1.0f);
  ASSERT_TRUE(validate(scene));
  const Light& light = scene.lights[0];
  EXPECT_LT(glm::distance(light.direction_ws, glm::vec3(-1, 0, 0)), kNoise);
  EXPECT_EQ(light.position_ws, glm::vec3(10, 0, 0));
  EXPECT_EQ(light.intensity, glm::vec3(0, 1, 2));
  EXPECT_EQ(light.range, 8.0f);
  EXPECT_EQ(light.outer_cone_angle, 0.5f);
  EXPECT_EQ(light.inner_cone_angle, 0.5f);  // cut to the outer one
  EXPECT_EQ(scene.cameras[0].vertical_fov, 2.0f);
  EXPECT_LT(glm::distance(glm::vec3(scene.cameras[0].world_from_view[2]), glm::vec3(1, 0, 0)),
            kNoise);
  EXPECT_EQ(scene.materials[0].base_color, glm::vec4(1, 1, 0.5f, 1));
  EXPECT_EQ(scene.materials[0].roughness, 0.5f);
  EXPECT_EQ(scene.materials[0].emission, glm::vec3(10, 0, 0));
}

/// The quad as a mesh that bends, in the rig's first node.
Scene with_rig_mesh() {
  Scene scene = rigged();
  RigMesh mesh;
  mesh.positions = scene.meshes[0].positions;
  mesh.normals = scene.meshes[0].normals;
  scene.rig.meshes.push_back(mesh);
  return scene;
}

TEST(Animate, MorphsByTheWeightedSumOfTheTargets) {
  Scene scene = with_rig_mesh();
  RigMesh& mesh = scene.rig.meshes[0];
  mesh.targets.resize(2);
  mesh.targets[0].positions.assign(4, {0, 0, 2});
  mesh.targets[1].positions = {{0, 0, 0}, {4, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  mesh.targets[1].normals.assign(4, {1, 0, 0});
  scene.animations[0].channels = {drive(Channel::Target::node_weights, 0, 2, {0, 0}, {0.5f, 1})};
  ASSERT_TRUE(validate(scene));
  const std::uint32_t revision = scene.meshes[0].revision;
  animate(scene, 0, 0.0f);
  EXPECT_EQ(scene.meshes[0].revision, revision);  // nothing moved yet
  animate(scene, 0, 0.5f);
  EXPECT_GT(scene.meshes[0].revision, revision);
  EXPECT_LT(glm::distance(scene.meshes[0].positions[1], glm::vec3(3, 0, 0.5f)), kNoise);
  EXPECT_LT(glm::distance(scene.meshes[0].positions[3], glm::vec3(0, 1, 0.5f)), kNoise);
  const glm::vec3 normal = glm::normalize(glm::vec3(0.5f, 0, 1));
  EXPECT_LT(glm::distance(scene.meshes[0].normals[0], normal), kNoise);
}

TEST(Animate, CarriesVerticesByTheirJoints) {
  Scene scene = with_rig_mesh();
  RigNode joint;
  joint.translation = {0, 5, 0};
  scene.rig.nodes.push_back(joint);
  scene.rig.skins.push_back({{0, 2}, {glm::mat4(1.0f), glm::mat4(1.0f)}});
  RigMesh& mesh = scene.rig.meshes[0];
  mesh.skin = 0;
  mesh.influences = 2;
  mesh.joints = {0, 1, 0, 1, 0, 1, 0, 1};
  mesh.weights = {1, 0, 0, 1, 1, 3, 0, 0};
  const float half = std::sqrt(0.5f);
  // The second joint turns by 90 degrees about y: x goes to -z
  scene.animations[0].channels = {
      drive(Channel::Target::node_rotation, 2, 4, {0, 0, 0, 1}, {0, half, 0, half})};
  ASSERT_TRUE(validate(scene));
  animate(scene, 0, 1.0f);
  const Mesh& bent = scene.meshes[0];
  EXPECT_LT(glm::distance(bent.positions[0], glm::vec3(10, 0, 0)), kNoise);
  EXPECT_LT(glm::distance(bent.positions[1], glm::vec3(0, 5, -1)), kNoise);
  // (1, 1, 0): a quarter of (11, 1, 0) and three quarters of (0, 6, -1)
  EXPECT_LT(glm::distance(bent.positions[2], glm::vec3(2.75f, 4.75f, -0.75f)), kNoise);
  // Without weights it follows the first joint
  EXPECT_LT(glm::distance(bent.positions[3], glm::vec3(10, 1, 0)), kNoise);
  EXPECT_LT(glm::distance(bent.normals[1], glm::vec3(1, 0, 0)), kNoise);
  EXPECT_TRUE(validate(scene));
}

TEST(Animate, GivesFlatNormalsToWhatHasNone) {
  Scene scene = with_rig_mesh();
  RigMesh& mesh = scene.rig.meshes[0];
  mesh.normals.clear();
  mesh.targets.resize(1);
  mesh.targets[0].positions = {{0, 0, 0}, {0, 0, 1}, {0, 0, 1}, {0, 0, 0}};  // tilts about y
  scene.animations[0].channels = {drive(Channel::Target::node_weights, 0, 1, {0}, {1})};
  animate(scene, 0, 1.0f);
  const glm::vec3 tilted = glm::normalize(glm::vec3(-1, 0, 1));
  for (const glm::vec3& n : scene.meshes[0].normals) EXPECT_LT(glm::distance(n, tilted), kNoise);
}

TEST(Animate, WorldFollowsWhatItMoves) {
  scenes::AnimatedScene made = scenes::make_atrium(16);
  Scene& scene = made.scene;
  scenes::add_rig(scene, made.animations);
  ASSERT_EQ(scene.animations.size(), 2u);
  EXPECT_NEAR(duration(scene.animations[0]), 20.0f, kNoise);
  World world(scene);
  animate(scene, -1, 10.0f);
  const Expected<WorldChanges> changes = world.update();
  ASSERT_TRUE(changes);
  EXPECT_EQ(changes->moved.size(), 4u);  // leaf and iron of the door
  ASSERT_EQ(changes->lights.size(), 1u);
  EXPECT_NEAR(glm::length(changes->lights[0].after->direction_ws), 1.0f, kNoise);
  EXPECT_GT(glm::distance(changes->lights[0].after->direction_ws,
                          changes->lights[0].before->direction_ws),
            0.3f);
  // One of the two alone: the sun stays, the door goes back
  animate(scene, 1, 0.0f);
  EXPECT_LT(glm::distance(scene.lights[0].direction_ws, changes->lights[0].before->direction_ws),
            1.0f);
}

TEST(Validate, NamesWhatIsWrongWithAnAnimation) {
  const auto error = [](auto spoil) {
    Scene scene = with_rig_mesh();
    scene.animations[0].channels = {
        drive(Channel::Target::node_translation, 0, 3, {0, 0, 0}, {0, 4, 0})};
    EXPECT_TRUE(validate(scene));
    spoil(scene);
    const Expected<void> result = validate(scene);
    return result ? std::string() : result.error().message();
  };
  const auto of_curve = [&](auto spoil) {
    return error([&](Scene& s) { spoil(s.animations[0].channels[0].curve); });
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(of_curve([](Curve& c) { c.times.clear(); }), HasSubstr("animations[0].channels[0]"));
  EXPECT_THAT(of_curve([](Curve& c) { c.times[1] = 0.0f; }), HasSubstr("do not ascend"));
  EXPECT_THAT(of_curve([](Curve& c) { c.times[1] = kNan; }), HasSubstr("finite"));
  EXPECT_THAT(of_curve([](Curve& c) { c.values[1] = kNan; }), HasSubstr("finite"));
  EXPECT_THAT(of_curve([](Curve& c) { c.values.pop_back(); }), HasSubstr("one value a key"));
  EXPECT_THAT(error([](Scene& s) { s.animations[0].channels[0].index = 2; }),
              HasSubstr("does not exist"));
  EXPECT_THAT(
      error([](Scene& s) { s.animations[0].channels[0].target = Channel::Target::light_color; }),
      HasSubstr("does not exist"));
  EXPECT_THAT(error([](Scene& s) { s.rig.nodes[0].parent = 0; }), HasSubstr("rig.nodes[0]"));
  EXPECT_THAT(error([](Scene& s) {
                s.rig.instances.push_back({9, 0, glm::mat4(1.0f)});
              }),
              HasSubstr("rig.instances[0]"));
  EXPECT_THAT(error([](Scene& s) { s.rig.meshes[0].positions.pop_back(); }),
              HasSubstr("rig.meshes[0]"));
  EXPECT_THAT(error([](Scene& s) { s.rig.meshes[0].skin = 0; }), HasSubstr("skin"));
  EXPECT_THAT(error([](Scene& s) { s.rig.skins.push_back({{}, {}}); }), HasSubstr("no joints"));
  EXPECT_THAT(error([](Scene& s) { s.rig.lights.push_back({5, -1}); }), HasSubstr("rig.lights[0]"));
}

}  // namespace
}  // namespace lambent::animation_test
