// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "lambent/world.h"
#include "scenes/builtin.h"
#include "scenes/glb_writer.h"
#include "scenes/recipes.h"
#include "unit/gltf_checks.h"

namespace lambent::gltf_animation_test {
namespace {

using test::error_of;
using test::GltfBuilder;
using test::Json;
using test::loaded;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr float kNoise = 1e-5f;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Appends an animation of one channel; `target` is its whole target.
void animate_target(GltfBuilder& builder, Json target, int input, int output,
                    const char* interpolation = nullptr) {
  Json sampler = {{"input", input}, {"output", output}};
  if (interpolation != nullptr) sampler["interpolation"] = interpolation;
  builder.append("animations",
                 {{"samplers", Json::array({sampler})},
                  {"channels", Json::array({{{"sampler", 0}, {"target", std::move(target)}}})}});
}

Json node_target(int node, const char* path) {
  return {{"node", node}, {"path", path}};
}

Json pointer_target(const char* pointer) {
  Json target = {{"path", "pointer"}};
  target["extensions"]["KHR_animation_pointer"]["pointer"] = pointer;
  return target;
}

TEST(GltfAnimation, MovesANodeAndWhatHangsFromIt) {
  GltfBuilder builder;
  builder.show(builder.triangle());
  builder.root["nodes"][0]["translation"] = {1, 0, 0};
  builder.show_node({{"children", {0}}, {"rotation", {0, 0, 0, 1}}});
  builder.root["scenes"][0]["nodes"] = {1};
  const int times = builder.accessor<float>({0, 2}, "SCALAR");
  // Normalised integers stand for -1 to 1
  const int turns =
      builder.accessor<std::int16_t>({0, 0, 0, 32767, 0, 23170, 0, 23170}, "VEC4", true);
  animate_target(builder, node_target(1, "rotation"), times, turns);
  Scene scene = loaded(builder);
  EXPECT_THAT(scene.source.warnings, IsEmpty());
  EXPECT_TRUE(scene.instances[0].dynamic);
  EXPECT_EQ(glm::vec3(scene.instances[0].world_from_object[3]), glm::vec3(1, 0, 0));
  animate(scene, 0, 2.0f);
  EXPECT_LT(glm::distance(glm::vec3(scene.instances[0].world_from_object[3]), glm::vec3(0, 0, -1)),
            1e-4f);
  animate(scene, 0, 0.0f);
  EXPECT_LT(glm::distance(glm::vec3(scene.instances[0].world_from_object[3]), glm::vec3(1, 0, 0)),
            kNoise);
}

TEST(GltfAnimation, LeavesWhatStandsStillAsItIs) {
  GltfBuilder builder;
  const int mesh = builder.show(builder.triangle());
  builder.show_node({{"mesh", mesh}});
  animate_target(builder, node_target(0, "scale"), builder.accessor<float>({0, 1}, "SCALAR"),
                 builder.accessor<float>({1, 1, 1, 2, 2, 2}, "VEC3"));
  const Scene scene = loaded(builder);
  EXPECT_TRUE(scene.instances[0].dynamic);
  EXPECT_FALSE(scene.instances[1].dynamic);
  // Both share a mesh: it is moved, not bent
  EXPECT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.rig.instances.size(), 1u);
}

TEST(GltfAnimation, ReadsEveryInterpolation) {
  GltfBuilder builder;
  builder.show(builder.triangle());
  const int times = builder.accessor<float>({0, 2}, "SCALAR");
  const int two = builder.accessor<float>({0, 0, 0, 4, 0, 0}, "VEC3");
  const int spline =
      builder.accessor<float>({0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 0, 4, 0, 0, 0, 0, 0}, "VEC3");
  animate_target(builder, node_target(0, "translation"), times, two, "STEP");
  animate_target(builder, node_target(0, "translation"), times, two, "LINEAR");
  animate_target(builder, node_target(0, "translation"), times, two);
  animate_target(builder, node_target(0, "translation"), times, spline, "CUBICSPLINE");
  Scene scene = loaded(builder);
  ASSERT_EQ(scene.animations.size(), 4u);
  // The spline is t^2
  const float expected[] = {0.0f, 1.0f, 1.0f, 0.25f};
  for (int i = 0; i < 4; ++i) {
    animate(scene, i, 0.5f);
    EXPECT_NEAR(scene.instances[0].world_from_object[3].x, expected[i], kNoise) << i;
  }
}

TEST(GltfAnimation, MorphsAMeshOfEachNodeOnItsOwn) {
  GltfBuilder builder;
  Json primitive = builder.triangle();
  primitive["targets"] = {
      {{"POSITION", builder.accessor<float>({0, 0, 1, 0, 0, 2, 0, 0, 3}, "VEC3")}}};
  const int mesh = builder.show(primitive);
  builder.show_node({{"mesh", mesh}});
  const int times = builder.accessor<float>({0, 1}, "SCALAR");
  const int weights = builder.accessor<std::uint8_t>({0, 255}, "SCALAR", true);
  animate_target(builder, node_target(0, "weights"), times, weights);
  Scene scene = loaded(builder);
  EXPECT_THAT(scene.source.warnings, IsEmpty());
  ASSERT_EQ(scene.meshes.size(), 2u);
  animate(scene, -1, 0.5f);
  EXPECT_NEAR(scene.meshes[0].positions[2].z, 1.5f, kNoise);
  EXPECT_EQ(scene.meshes[1].positions[2].z, 0.0f);
  // The file has no normals: those of the bent triangle
  const Mesh& bent = scene.meshes[0];
  const glm::vec3 normal = glm::normalize(
      glm::cross(bent.positions[1] - bent.positions[0], bent.positions[2] - bent.positions[0]));
  EXPECT_LT(glm::distance(bent.normals[0], normal), kNoise);
  EXPECT_TRUE(validate(scene));
}

/// A triangle hung from one joint, node 1; node 0 shows it.
GltfBuilder skinned_triangle() {
  GltfBuilder builder;
  Json primitive = builder.triangle();
  primitive["attributes"]["JOINTS_0"] =
      builder.accessor<std::uint8_t>({0, 9, 0, 0, 0, 9, 0, 0, 0, 9, 0, 0}, "VEC4");
  primitive["attributes"]["WEIGHTS_0"] =
      builder.accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  builder.show(primitive);
  builder.show_node({{"translation", {0, 3, 0}}});
  const int bind = builder.append(
      "accessors",
      {{"bufferView", builder.view<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1})},
       {"componentType", 5126},
       {"count", 1},
       {"type", "MAT4"}});
  builder.append("skins", {{"joints", {1}}, {"inverseBindMatrices", bind}});
  builder.root["nodes"][0]["skin"] = 0;
  return builder;
}

TEST(GltfAnimation, CarriesASkinByItsJoints) {
  GltfBuilder builder = skinned_triangle();
  const Scene rest = loaded(builder);
  EXPECT_TRUE(rest.rig.meshes.empty());
  animate_target(builder, node_target(1, "translation"), builder.accessor<float>({0, 1}, "SCALAR"),
                 builder.accessor<float>({0, 3, 0, 0, 3, 8}, "VEC3"));
  Scene scene = loaded(builder);
  // The rest pose is what it is without the animation
  EXPECT_EQ(scene.meshes[0].positions, rest.meshes[0].positions);
  EXPECT_EQ(scene.meshes[0].normals, rest.meshes[0].normals);
  EXPECT_EQ(scene.meshes[0].positions[0], glm::vec3(0, 2, 0));
  ASSERT_EQ(scene.rig.meshes.size(), 1u);
  EXPECT_TRUE(scene.instances[0].dynamic);
  World world(scene);
  animate(scene, 0, 0.5f);
  EXPECT_LT(glm::distance(scene.meshes[0].positions[0], glm::vec3(0, 2, 4)), kNoise);
  EXPECT_EQ(scene.instances[0].world_from_object, glm::mat4(1.0f));
  const Expected<WorldChanges> changes = world.update();
  ASSERT_TRUE(changes);
  EXPECT_EQ(changes->moved.size(), 2u);
}

TEST(GltfAnimation, MovesLightsAndCamerasWithTheirNodes) {
  GltfBuilder builder;
  builder.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  Json node = {{"camera", 0}};
  node["extensions"]["KHR_lights_punctual"]["light"] = 0;
  builder.show_node(node);
  builder.append("cameras", Json::parse(R"({"type": "perspective",
      "perspective": {"yfov": 1.0, "znear": 0.1}})"));
  animate_target(builder, node_target(0, "translation"), builder.accessor<float>({0, 1}, "SCALAR"),
                 builder.accessor<float>({0, 0, 0, 0, 6, 0}, "VEC3"));
  Scene scene = loaded(builder);
  animate(scene, 0, 0.5f);
  EXPECT_EQ(scene.lights[0].position_ws, glm::vec3(0, 3, 0));
  EXPECT_EQ(glm::vec3(scene.cameras[0].world_from_view[3]), glm::vec3(0, 3, 0));
}

TEST(GltfAnimation, FollowsPointers) {
  GltfBuilder builder;
  Json primitive = builder.triangle();
  primitive["material"] = 0;
  builder.show(primitive);
  builder.append("materials", Json::parse(R"({"emissiveFactor": [1, 0.5, 0]})"));
  builder.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}}, {{"type", "spot"}, {"color", {0, 1, 0}}, {"spot", Json::object()}}};
  for (const int light : {1, 0, 1}) {
    Json node = Json::object();
    node["extensions"]["KHR_lights_punctual"]["light"] = light;
    builder.show_node(node);
  }
  builder.show_node({{"camera", 0}});
  builder.append("cameras", Json::parse(R"({"type": "perspective",
      "perspective": {"yfov": 1.0, "znear": 0.1}})"));
  const int times = builder.accessor<float>({0, 1}, "SCALAR");
  const int ten = builder.accessor<float>({0, 10}, "SCALAR");
  const int one = builder.accessor<float>({0, 1}, "SCALAR");
  const int red = builder.accessor<float>({0, 0, 0, 1, 0, 0}, "VEC3");
  const int base = builder.accessor<float>({0, 0, 0, 1, 1, 0.5f, 0, 1}, "VEC4");
  const std::string light = "/extensions/KHR_lights_punctual/lights/1";
  animate_target(builder, pointer_target((light + "/intensity").c_str()), times, ten);
  animate_target(builder, pointer_target((light + "/spot/outerConeAngle").c_str()), times, one);
  animate_target(builder, pointer_target("/materials/0/emissiveFactor"), times, red);
  animate_target(
      builder,
      pointer_target("/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength"),
      times, ten);
  animate_target(builder, pointer_target("/materials/0/pbrMetallicRoughness/baseColorFactor"),
                 times, base);
  animate_target(builder, pointer_target("/cameras/0/perspective/yfov"), times, one);
  animate_target(builder, pointer_target("/nodes/0/translation"), times, red);
  Scene scene = loaded(builder);
  EXPECT_THAT(scene.source.warnings, IsEmpty());
  animate(scene, -1, 0.5f);
  // Both nodes that show the second light, and no other
  EXPECT_EQ(scene.lights[0].intensity, glm::vec3(0, 5, 0));
  EXPECT_EQ(scene.lights[1].intensity, glm::vec3(1, 1, 1));
  EXPECT_EQ(scene.lights[2].intensity, glm::vec3(0, 5, 0));
  EXPECT_EQ(scene.lights[0].outer_cone_angle, 0.5f);
  EXPECT_EQ(scene.materials[0].emission, glm::vec3(2.5f, 0, 0));
  EXPECT_EQ(scene.materials[0].base_color, glm::vec4(0.5f, 0.25f, 0, 1));
  EXPECT_EQ(scene.cameras[0].vertical_fov, 0.5f);
  EXPECT_EQ(scene.instances[0].world_from_object[3].x, 0.5f);
  EXPECT_TRUE(validate(scene));
}

struct BadChannel {
  const char* name;
  void (*spoil)(GltfBuilder&);
  const char* warning;
};

class BadAnimation : public testing::TestWithParam<BadChannel> {};

TEST_P(BadAnimation, IsDroppedWithAWarning) {
  GltfBuilder builder;
  builder.show(builder.triangle());
  const int times = builder.accessor<float>({0, 1}, "SCALAR");
  const int values = builder.accessor<float>({0, 0, 0, 1, 0, 0}, "VEC3");
  animate_target(builder, node_target(0, "translation"), times, values);
  EXPECT_THAT(loaded(builder).source.warnings, IsEmpty());
  GetParam().spoil(builder);
  const Scene scene = loaded(builder);
  EXPECT_THAT(scene.source.warnings, Contains(HasSubstr(GetParam().warning)));
  EXPECT_EQ(scene.source.animations, 1);
  EXPECT_TRUE(scene.animations.empty());
  EXPECT_TRUE(scene.rig.nodes.empty());
  EXPECT_FALSE(scene.instances[0].dynamic);
}

Json& first(GltfBuilder& b) {
  return b.root["animations"][0];
}
INSTANTIATE_TEST_SUITE_P(
    Channels, BadAnimation,
    testing::Values(
        BadChannel{"without_channels", [](GltfBuilder& b) { first(b).erase("channels"); },
                   "animations[0] was dropped"},
        BadChannel{"without_samplers", [](GltfBuilder& b) { first(b).erase("samplers"); },
                   "animations[0] was dropped"},
        BadChannel{"sampler_out_of_range",
                   [](GltfBuilder& b) { first(b)["channels"][0]["sampler"] = 7; },
                   "sampler does not exist"},
        BadChannel{"negative_sampler",
                   [](GltfBuilder& b) { first(b)["channels"][0]["sampler"] = -1; },
                   "sampler does not exist"},
        BadChannel{"keys_out_of_range",
                   [](GltfBuilder& b) { first(b)["samplers"][0]["input"] = 99; }, "no keys"},
        BadChannel{"node_out_of_range",
                   [](GltfBuilder& b) { first(b)["channels"][0]["target"]["node"] = 9; },
                   "node does not exist"},
        BadChannel{"no_node",
                   [](GltfBuilder& b) { first(b)["channels"][0]["target"].erase("node"); },
                   "node does not exist"},
        BadChannel{"unknown_path",
                   [](GltfBuilder& b) { first(b)["channels"][0]["target"]["path"] = "color"; },
                   "not supported"},
        BadChannel{"unknown_interpolation",
                   [](GltfBuilder& b) { first(b)["samplers"][0]["interpolation"] = "BEZIER"; },
                   "interpolation"},
        BadChannel{"pointer_to_nothing",
                   [](GltfBuilder& b) {
                     first(b)["channels"][0]["target"] = pointer_target("/nodes/12/scale");
                   },
                   "target does not exist"},
        BadChannel{"no_pointer",
                   [](GltfBuilder& b) { first(b)["channels"][0]["target"]["path"] = "pointer"; },
                   "no pointer"},
        BadChannel{"weights_without_targets",
                   [](GltfBuilder& b) { first(b)["channels"][0]["target"]["path"] = "weights"; },
                   "no morph targets"},
        BadChannel{"rotation_of_three",
                   [](GltfBuilder& b) { first(b)["channels"][0]["target"]["path"] = "rotation"; },
                   "number of components"},
        BadChannel{
            "nan_keys",
            [](GltfBuilder& b) {
              first(b)["samplers"][0]["output"] = b.accessor<float>({0, 0, 0, 1, kNan, 0}, "VEC3");
            },
            "not finite"},
        BadChannel{"nan_times",
                   [](GltfBuilder& b) {
                     first(b)["samplers"][0]["input"] = b.accessor<float>({0, kNan}, "SCALAR");
                   },
                   "not finite"},
        BadChannel{"times_that_stand_still",
                   [](GltfBuilder& b) {
                     first(b)["samplers"][0]["input"] = b.accessor<float>({1, 1}, "SCALAR");
                   },
                   "do not ascend"},
        BadChannel{"too_few_values",
                   [](GltfBuilder& b) {
                     first(b)["samplers"][0]["output"] = b.accessor<float>({0, 0, 0}, "VEC3");
                   },
                   "one value a key"},
        BadChannel{"cubic_without_tangents",
                   [](GltfBuilder& b) { first(b)["samplers"][0]["interpolation"] = "CUBICSPLINE"; },
                   "one value a key"},
        BadChannel{"node_with_a_matrix",
                   [](GltfBuilder& b) {
                     b.root["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0,
                                                     0, 0, 1, 0, 0, 0, 0, 1};
                   },
                   "matrix"}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST(GltfAnimation, KeepsTheOtherChannelsOfABadOne) {
  GltfBuilder builder;
  builder.show(builder.triangle());
  const int times = builder.accessor<float>({0, 1}, "SCALAR");
  const int values = builder.accessor<float>({0, 0, 0, 1, 0, 0}, "VEC3");
  animate_target(builder, node_target(0, "translation"), times, values);
  builder.root["animations"][0]["channels"].push_back("nonsense");
  Scene scene = loaded(builder);
  EXPECT_THAT(scene.source.warnings, Contains(HasSubstr("animations[0].channels[1]")));
  EXPECT_EQ(scene.animations.at(0).channels.size(), 1u);
  builder.root["animations"] = "nonsense";
  EXPECT_THAT(loaded(builder).source.warnings, Contains(HasSubstr("not a list")));
}

TEST(GltfAnimation, OfABuiltInSceneIsTheSameFromItsFile) {
  const scenes::AnimatedScene made = scenes::make_atrium(16);
  const std::string path = testing::TempDir() + "lambent_animated_atrium.glb";
  ASSERT_TRUE(scenes::write_glb(made.scene, path, made.animations));
  Expected<Scene> from_file = load_scene(path);
  std::filesystem::remove(path);
  ASSERT_TRUE(from_file) << error_of(from_file);
  Scene direct = made.scene;
  scenes::add_rig(direct, made.animations);
  for (const float time : {0.0f, 7.3f, 20.0f}) {
    animate(*from_file, -1, time);
    animate(direct, -1, time);
    for (std::size_t i = 0; i < direct.instances.size(); ++i) {
      for (int c = 0; c < 4; ++c) {
        EXPECT_LT(glm::distance(direct.instances[i].world_from_object[c],
                                from_file->instances[i].world_from_object[c]),
                  2e-5f);
      }
    }
    EXPECT_LT(glm::distance(direct.lights[0].direction_ws, from_file->lights[0].direction_ws),
              kNoise);
  }
}

}  // namespace
}  // namespace lambent::gltf_animation_test
