// SPDX-License-Identifier: Apache-2.0
// Materials whose reflectance at normal incidence is a color of its own, up to that of metals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "raytracing/surface_math.h"
#include "unit/gltf_builder.h"

namespace lambent::gltf_specular_glossiness_test {
namespace {

using test::error_of;
using test::GltfBuilder;
using test::Json;
using testing::SizeIs;

GltfBuilder builder_with(const Json& material) {
  GltfBuilder builder;
  builder.show(builder.triangle());
  builder.append("materials", material);
  return builder;
}

/// The material as it is imported, which reads the older model as the newer one.
Material converted_material(const Json& material) {
  const Expected<Scene> scene = builder_with(material).load();
  EXPECT_TRUE(scene) << error_of(scene);
  return scene ? scene->materials.at(0) : Material{};
}

Reflectance reflectance_of(const Material& m) {
  return coated_reflectance(glm::vec3(m.base_color), m.metallic, m.roughness, m.specular,
                            m.specular_color, m.ior);
}

TEST(GltfSpecularGlossiness, ReflectsTheSpecularColor) {
  const Material m = converted_material(Json::parse(R"({
    "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1], "metallicFactor": 1},
    "extensions": {"KHR_materials_pbrSpecularGlossiness": {
      "diffuseFactor": [0.125, 0.25, 0.5, 0.75], "specularFactor": [0.5, 0.25, 0.04],
      "glossinessFactor": 0.75}}})"));
  EXPECT_EQ(m.base_color, glm::vec4(0.125f, 0.25f, 0.5f, 0.75f));
  EXPECT_EQ(m.roughness, 0.25f);
  const Reflectance r = reflectance_of(m);
  EXPECT_EQ(r.diffuse, glm::vec3(m.base_color));
  EXPECT_LT(glm::length(r.f0 - glm::vec3(0.5f, 0.25f, 0.04f)), 1e-5f);
  EXPECT_EQ(r.f90, 1.0f);

  // The defaults are white, as smooth as can be
  const Material plain = converted_material(
      Json::parse(R"({"extensions": {"KHR_materials_pbrSpecularGlossiness": {}}})"));
  EXPECT_EQ(plain.base_color, glm::vec4(1.0f));
  EXPECT_EQ(plain.specular_color, glm::vec3(1.0f));
  EXPECT_EQ(plain.roughness, 0.0f);
  EXPECT_EQ(plain.metallic, 0.0f);
}

TEST(GltfSpecularGlossiness, HasItsGlossinessInTheAlphaOfATexture) {
  GltfBuilder builder = builder_with(Json::parse(R"({"extensions": {
    "KHR_materials_pbrSpecularGlossiness": {
      "glossinessFactor": 0.5, "diffuseTexture": {"index": 0},
      "specularGlossinessTexture": {"index": 0, "texCoord": 1}}}})"));
  const auto image = test::png_of(2, 1, {188, 0, 0, 255, 188, 0, 0, 51});
  builder.append("images", {{"bufferView", builder.view(image)}});
  builder.append("textures", {{"source", 0}});
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_TRUE(scene->source.warnings.empty());
  const Material& m = scene->materials.at(0);
  ASSERT_THAT(scene->textures, SizeIs(2));
  EXPECT_EQ(m.base_color_texture.texture, m.specular_color_texture.texture);
  EXPECT_EQ(m.specular_color_texture.uv_set, 1);
  EXPECT_EQ(m.metallic_roughness_texture.uv_set, 1);
  EXPECT_EQ(m.roughness, 1.0f);
  EXPECT_EQ(m.metallic, 0.0f);
  // Roughness is 1 - 0.5 * 1 and 1 - 0.5 * 0.2
  const Texture& made = scene->textures.at(m.metallic_roughness_texture.texture);
  EXPECT_FALSE(made.srgb);
  EXPECT_EQ(made.levels.at(0).rgba.at(1), 128);
  EXPECT_EQ(made.levels.at(0).rgba.at(5), 230);
  const Texture& color = scene->textures.at(m.base_color_texture.texture);
  EXPECT_TRUE(color.srgb);
  EXPECT_EQ(color.levels.at(0).rgba.at(7), 51);
}

TEST(GltfMaterials, WithAnIndexOfRefractionOfZeroReflectAllLight) {
  const Material m = converted_material(Json::parse(R"({
    "pbrMetallicRoughness": {"metallicFactor": 0},
    "extensions": {"KHR_materials_ior": {"ior": 0},
                   "KHR_materials_specular": {"specularColorFactor": [0.5, 0.25, 0.125]}}})"));
  const Reflectance r = reflectance_of(m);
  EXPECT_LT(glm::length(r.f0 - glm::vec3(0.5f, 0.25f, 0.125f)), 1e-5f);
}

}  // namespace
}  // namespace lambent::gltf_specular_glossiness_test
