// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <webp/encode.h>

#include <cmath>

#include "scene/texture.h"
#include "unit/gltf_builder.h"

namespace lambent::gltf_materials_test {
namespace {

using test::error_of;
using test::GltfBuilder;
using test::Json;
using testing::Contains;
using testing::HasSubstr;
using testing::SizeIs;

const std::vector<std::uint8_t> kGrey = {188, 188, 188, 255};

// A builder whose images, textures and samplers are asked for by the materials of a test.
GltfBuilder with_image(const std::vector<std::uint8_t>& file) {
  GltfBuilder builder;
  builder.show(builder.triangle());
  builder.append("images", {{"bufferView", builder.view(file)}});
  builder.append("textures", {{"source", 0}});
  return builder;
}

Material only_material(const Json& material) {
  GltfBuilder builder;
  builder.append("materials", material);
  const Expected<Scene> scene = builder.load();
  EXPECT_TRUE(scene) << error_of(scene);
  return scene ? scene->materials.at(0) : Material{};
}

TEST(GltfMaterials, HaveTheDefaultsOfTheSpecification) {
  const Material m = only_material(Json::object());
  EXPECT_EQ(m.base_color, glm::vec4(1.0f));
  EXPECT_EQ(m.metallic, 1.0f);
  EXPECT_EQ(m.roughness, 1.0f);
  EXPECT_EQ(m.emission, glm::vec3(0.0f));
  EXPECT_EQ(m.alpha_mode, AlphaMode::opaque);
  EXPECT_EQ(m.alpha_cutoff, 0.5f);
  EXPECT_EQ(m.ior, 1.5f);
  EXPECT_FALSE(m.double_sided);
  EXPECT_FALSE(m.unlit);
}

TEST(GltfMaterials, ReadLayersAndTheirTextures) {
  GltfBuilder builder = with_image(test::png_of(1, 1, kGrey));
  builder.append("materials", Json::parse(R"({"extensions": {
    "KHR_materials_clearcoat": {
      "clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.25,
      "clearcoatTexture": {"index": 0, "texCoord": 1},
      "clearcoatRoughnessTexture": {"index": 0},
      "clearcoatNormalTexture": {"index": 0, "scale": 0.75}},
    "KHR_materials_sheen": {
      "sheenColorFactor": [0.125, 0.25, 2], "sheenRoughnessFactor": 0.375,
      "sheenColorTexture": {"index": 0}, "sheenRoughnessTexture": {"index": 0}}}})"));
  builder.append("materials", Json::parse(R"({"extensions": {
    "KHR_materials_clearcoat": {}, "KHR_materials_sheen": {}}})"));
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  const Material& m = scene->materials.at(0);
  EXPECT_EQ(m.clearcoat, 0.5f);
  EXPECT_EQ(m.clearcoat_roughness, 0.25f);
  EXPECT_EQ(m.clearcoat_normal_scale, 0.75f);
  EXPECT_EQ(m.sheen_color, glm::vec3(0.125f, 0.25f, 1.0f));
  EXPECT_EQ(m.sheen_roughness, 0.375f);
  EXPECT_EQ(m.clearcoat_texture.uv_set, 1);
  // Colors are read as sRGB, all else as numbers
  const int data = m.clearcoat_texture.texture;
  ASSERT_GE(data, 0);
  EXPECT_FALSE(scene->textures.at(data).srgb);
  EXPECT_EQ(m.clearcoat_roughness_texture.texture, data);
  // A normal map has MIPs of its own kind
  ASSERT_GE(m.clearcoat_normal_texture.texture, 0);
  EXPECT_NE(m.clearcoat_normal_texture.texture, data);
  EXPECT_FALSE(scene->textures.at(m.clearcoat_normal_texture.texture).srgb);
  EXPECT_EQ(m.sheen_roughness_texture.texture, data);
  ASSERT_GE(m.sheen_color_texture.texture, 0);
  EXPECT_TRUE(scene->textures.at(m.sheen_color_texture.texture).srgb);
  EXPECT_THAT(scene->source.warnings, Contains(HasSubstr("sheen colors were clamped")));
  const Material& none = scene->materials.at(1);
  EXPECT_EQ(none.clearcoat, 0.0f);
  EXPECT_EQ(none.clearcoat_roughness, 0.0f);
  EXPECT_EQ(none.sheen_color, glm::vec3(0.0f));
  EXPECT_EQ(none.sheen_roughness, 0.0f);
}

TEST(GltfMaterials, ReadThinFilmsAndTheirTextures) {
  GltfBuilder builder = with_image(test::png_of(1, 1, kGrey));
  builder.append("materials", Json::parse(R"({"extensions": {
    "KHR_materials_iridescence": {
      "iridescenceFactor": 0.5, "iridescenceIor": 1.75, "iridescenceThicknessMinimum": 250,
      "iridescenceThicknessMaximum": 200, "iridescenceTexture": {"index": 0, "texCoord": 1},
      "iridescenceThicknessTexture": {"index": 0}}}})"));
  builder.append("materials", Json::parse(R"({"extensions": {"KHR_materials_iridescence": {}}})"));
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_TRUE(scene->source.warnings.empty());
  const Material& m = scene->materials.at(0);
  EXPECT_EQ(m.iridescence, 0.5f);
  EXPECT_EQ(m.iridescence_ior, 1.75f);
  EXPECT_EQ(m.iridescence_thickness_min, 250.0f);
  EXPECT_EQ(m.iridescence_thickness_max, 200.0f);
  EXPECT_EQ(m.iridescence_texture.uv_set, 1);
  ASSERT_GE(m.iridescence_texture.texture, 0);
  EXPECT_EQ(m.iridescence_thickness_texture.texture, m.iridescence_texture.texture);
  const Material& none = scene->materials.at(1);
  EXPECT_EQ(none.iridescence, 0.0f);
  EXPECT_EQ(none.iridescence_ior, 1.3f);
  EXPECT_EQ(none.iridescence_thickness_min, 100.0f);
  EXPECT_EQ(none.iridescence_thickness_max, 400.0f);
}

TEST(GltfMaterials, ReadEveryFactor) {
  const Material m = only_material(Json::parse(R"({
    "name": "m", "doubleSided": true, "alphaMode": "MASK", "alphaCutoff": 0.25,
    "emissiveFactor": [0.5, 0.25, 0],
    "pbrMetallicRoughness": {
      "baseColorFactor": [0.125, 0.25, 0.5, 0.75], "metallicFactor": 0.5, "roughnessFactor": 0.25},
    "extensions": {
      "KHR_materials_emissive_strength": {"emissiveStrength": 8},
      "KHR_materials_ior": {"ior": 1.25},
      "KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [1, 0.5, 2]},
      "KHR_materials_unlit": {}}})"));
  EXPECT_EQ(m.name, "m");
  EXPECT_TRUE(m.double_sided);
  EXPECT_EQ(m.alpha_mode, AlphaMode::mask);
  EXPECT_EQ(m.alpha_cutoff, 0.25f);
  EXPECT_EQ(m.emission, glm::vec3(4, 2, 0));
  EXPECT_EQ(m.base_color, glm::vec4(0.125f, 0.25f, 0.5f, 0.75f));
  EXPECT_EQ(m.metallic, 0.5f);
  EXPECT_EQ(m.roughness, 0.25f);
  EXPECT_EQ(m.ior, 1.25f);
  EXPECT_EQ(m.specular, 0.5f);
  EXPECT_EQ(m.specular_color, glm::vec3(1, 0.5f, 2));
  EXPECT_TRUE(m.unlit);
}

TEST(GltfMaterials, ReadGlass) {
  const Material pane = only_material(Json::parse(R"({"extensions": {
      "KHR_materials_transmission": {"transmissionFactor": 0.75},
      "KHR_materials_volume": {"thicknessFactor": 0, "attenuationDistance": 0.5,
                               "attenuationColor": [1, 0.5, 0.25]}}})"));
  EXPECT_EQ(pane.transmission, 0.75f);
  EXPECT_FALSE(pane.bounds_volume);
  EXPECT_EQ(pane.absorption, glm::vec3(0.0f));

  const Material body = only_material(Json::parse(R"({"extensions": {
      "KHR_materials_transmission": {"transmissionFactor": 1},
      "KHR_materials_volume": {"thicknessFactor": 0.1, "attenuationDistance": 0.5,
                               "attenuationColor": [1, 0.5, 0]}}})"));
  EXPECT_TRUE(body.bounds_volume);
  EXPECT_NEAR(body.absorption.x, 0.0f, 1e-6f);
  EXPECT_NEAR(body.absorption.y, 2.0f * std::log(2.0f), 1e-5f);
  EXPECT_EQ(body.absorption.z, 1e6f);
}

TEST(GltfMaterials, OfPrimitivesWithoutOneAreTheDefault) {
  GltfBuilder builder;
  builder.show(builder.triangle());
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  ASSERT_THAT(scene->materials, SizeIs(1));
  EXPECT_EQ(scene->meshes.at(0).material, 0);
}

TEST(GltfMaterials, LambertIsSetOnEach) {
  GltfBuilder builder;
  builder.append("materials", Json::object());
  builder.show(builder.triangle());
  LoadOptions options;
  options.lambert = true;
  const Expected<Scene> scene = builder.load(options);
  ASSERT_TRUE(scene) << error_of(scene);
  ASSERT_THAT(scene->materials, SizeIs(2));
  for (const Material& material : scene->materials) EXPECT_TRUE(material.lambert);
}

TEST(GltfTextures, ShareAnImageUsedAlikeAndSplitColorFromData) {
  GltfBuilder builder = with_image(test::png_of(1, 1, kGrey));
  builder.append("textures", {{"source", 0}});
  builder.append("materials", Json::parse(R"({
    "pbrMetallicRoughness": {
      "baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 0}},
    "emissiveTexture": {"index": 1}})"));
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  const Material& m = scene->materials.at(0);
  ASSERT_THAT(scene->textures, SizeIs(2));
  EXPECT_EQ(m.base_color_texture.texture, m.emission_texture.texture);
  EXPECT_NE(m.base_color_texture.texture, m.metallic_roughness_texture.texture);
  EXPECT_TRUE(scene->textures[m.base_color_texture.texture].srgb);
  EXPECT_FALSE(scene->textures[m.metallic_roughness_texture.texture].srgb);
  // 188 is half the light in sRGB, and 188/255 as a number
  EXPECT_NEAR(sample_texture(*scene, m.base_color_texture, {0.5f, 0.5f}).r, 0.5f, 0.003f);
  EXPECT_NEAR(sample_texture(*scene, m.metallic_roughness_texture, {0.5f, 0.5f}).r, 188.0f / 255.0f,
              1e-6f);
}

TEST(GltfTextures, ReadSamplersAndTransforms) {
  GltfBuilder builder = with_image(test::png_of(1, 1, kGrey));
  builder.append("samplers", {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}});
  builder.root["textures"][0]["sampler"] = 0;
  builder.append("materials", Json::parse(R"({"pbrMetallicRoughness": {"baseColorTexture": {
    "index": 0, "texCoord": 0, "extensions": {"KHR_texture_transform": {
      "offset": [0.5, -1], "rotation": 0.25, "scale": [2, 3], "texCoord": 1}}}}})"));
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  const TextureView& view = scene->materials.at(0).base_color_texture;
  EXPECT_EQ(view.wrap_u, Wrap::clamp_to_edge);
  EXPECT_EQ(view.wrap_v, Wrap::mirrored_repeat);
  EXPECT_TRUE(view.nearest);
  EXPECT_EQ(view.uv_set, 1);
  EXPECT_EQ(view.uv_offset, glm::vec2(0.5f, -1));
  EXPECT_EQ(view.uv_rotation, 0.25f);
  EXPECT_EQ(view.uv_scale, glm::vec2(2, 3));
}

TEST(GltfTextures, PreferWebp) {
  GltfBuilder builder = with_image(test::png_of(1, 1, kGrey));
  std::uint8_t* encoded = nullptr;
  const std::vector<std::uint8_t> red = {255, 0, 0, 128};
  const std::size_t size = WebPEncodeLosslessRGBA(red.data(), 1, 1, 4, &encoded);
  ASSERT_GT(size, 0u);
  const std::vector<std::uint8_t> file(encoded, encoded + size);
  WebPFree(encoded);
  builder.append("images", {{"bufferView", builder.view(file)}, {"mimeType", "image/webp"}});
  builder.root["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 1;
  builder.root["extensionsRequired"] = {"EXT_texture_webp"};
  builder.append("materials", Json::parse(R"({"emissiveTexture": {"index": 0}})"));
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_EQ(scene->textures.at(0).levels.at(0).rgba, red);
}

TEST(GltfTextures, FallBackFromBasisToThePlainImage) {
  GltfBuilder builder = with_image(test::png_of(1, 1, kGrey));
  builder.append("images", {{"bufferView", builder.view(std::vector<std::uint8_t>{1, 2, 3})}});
  builder.root["textures"][0]["extensions"]["KHR_texture_basisu"]["source"] = 1;
  builder.root["extensionsUsed"] = {"KHR_texture_basisu"};
  builder.append("materials", Json::parse(R"({"emissiveTexture": {"index": 0}})"));
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_EQ(scene->textures.at(0).levels.at(0).rgba, kGrey);
  EXPECT_THAT(scene->source.warnings, Contains(HasSubstr("KHR_texture_basisu")));
}

TEST(GltfTextures, AreLeftOutWithAWarningWhereNoImageOfTheirsCanBeRead) {
  GltfBuilder builder = with_image(test::png_of(1, 1, kGrey));
  builder.root["textures"][0]["extensions"]["KHR_texture_basisu"]["source"] = 0;
  builder.root["textures"][0].erase("source");
  builder.append("materials", Json::parse(R"({
    "emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}})"));
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_TRUE(scene->textures.empty());
  EXPECT_EQ(scene->materials.at(0).emission_texture.texture, -1);
  EXPECT_THAT(scene->source.warnings, Contains(HasSubstr("only as KTX2 (KHR_texture_basisu)")));
  // It would glow all over, where its map had let it glow in places
  EXPECT_EQ(scene->materials.at(0).emission, glm::vec3(0.0f));
}

// A material that reads one texture in every way; without it, its factors say what it is.
const char* const kAllFromOne = R"({
  "name": "all", "emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0},
  "normalTexture": {"index": 0},
  "pbrMetallicRoughness": {
    "baseColorFactor": [0.5, 0.25, 0.125, 1], "metallicFactor": 0.25,
    "baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 0}}})";

TEST(GltfTextures, CorruptImagesLeaveTheFactorsAndAreNamed) {
  std::vector<std::uint8_t> truncated = test::png_of(1, 1, kGrey);
  truncated.resize(truncated.size() / 2);
  const std::vector<std::uint8_t> no_image = {'n', 'o', 't', '!'};
  const std::vector<std::uint8_t> ktx2 = {0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb, '\r', '\n'};
  const std::pair<std::vector<std::uint8_t>, const char*> cases[] = {
      {truncated, "images[0]: the image is corrupt"},
      {no_image, "images[0]: the image is not PNG, JPEG or WebP"},
      {ktx2, "images[0]: the image is KTX2; convert it"}};
  for (const auto& [file, words] : cases) {
    GltfBuilder builder = with_image(file);
    // A good image after the bad one keeps its place
    builder.append("images", {{"bufferView", builder.view(test::png_of(1, 1, kGrey))}});
    builder.append("textures", {{"source", 1}});
    builder.append("materials", Json::parse(kAllFromOne));
    builder.append("materials", Json::parse(R"({
      "emissiveFactor": [1, 0, 0], "emissiveTexture": {"index": 1}})"));
    const Expected<Scene> scene = builder.load();
    ASSERT_TRUE(scene) << error_of(scene);
    const Material& m = scene->materials.at(0);
    EXPECT_EQ(m.base_color, glm::vec4(0.5f, 0.25f, 0.125f, 1.0f));
    EXPECT_EQ(m.metallic, 0.25f);
    EXPECT_EQ(m.emission, glm::vec3(0.0f));
    for (const TextureView& view : {m.base_color_texture, m.metallic_roughness_texture,
                                    m.normal_texture, m.emission_texture}) {
      EXPECT_EQ(view.texture, -1);
    }
    ASSERT_THAT(scene->textures, SizeIs(1));
    EXPECT_EQ(scene->materials.at(1).emission_texture.texture, 0);
    EXPECT_EQ(scene->materials.at(1).emission, glm::vec3(1, 0, 0));
    // Read as color and as data, it is one texture to people
    ASSERT_THAT(scene->source.warnings, SizeIs(1));
    EXPECT_THAT(scene->source.warnings[0], HasSubstr("1 texture could not be read"));
    EXPECT_THAT(scene->source.warnings[0], HasSubstr(words));
    EXPECT_THAT(scene->source.warnings[0], HasSubstr("in material 'all'"));
  }
}

TEST(GltfTextures, ManyMissingOnesAreOneWarning) {
  GltfBuilder builder;
  builder.show(builder.triangle());
  constexpr int kMissing = 300;
  for (int i = 0; i < kMissing; ++i) {
    builder.append("images", {{"uri", "\x1b[31m" + std::to_string(i) + ".png"}});
    builder.append("textures", {{"source", i}});
    builder.append("materials", {{"emissiveTexture", {{"index", i}}}});
  }
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  ASSERT_THAT(scene->source.warnings, SizeIs(1));
  const std::string& warning = scene->source.warnings[0];
  EXPECT_THAT(warning, HasSubstr("300 textures could not be read"));
  EXPECT_THAT(warning, HasSubstr("0.png"));
  EXPECT_THAT(warning, HasSubstr("and 297 more"));
  EXPECT_LT(warning.size(), 1000u);
  // Names come from files: they must not command a terminal
  EXPECT_EQ(warning.find('\x1b'), std::string::npos);
}

TEST(GltfMaterials, TooBrightOnesAreReducedAndKeepTheirHue) {
  GltfBuilder builder;
  builder.show(builder.triangle());
  builder.append("materials", Json::parse(R"({"emissiveFactor": [1, 0.5, 0], "extensions": {
    "KHR_materials_emissive_strength": {"emissiveStrength": 1e38}}})"));
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_EQ(scene->materials.at(0).emission, glm::vec3(1e10f, 5e9f, 0.0f));
  EXPECT_THAT(scene->source.warnings, Contains(HasSubstr("reduced to 1e10 W/(m^2 sr)")));
}

TEST(GltfMaterials, FactorsOutOfRangeAreBroughtIntoIt) {
  GltfBuilder builder;
  builder.show(builder.triangle());
  builder.append("materials", Json::parse(R"({
    "pbrMetallicRoughness": {"metallicFactor": 7, "roughnessFactor": -1},
    "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1.5}}})"));
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_EQ(scene->materials.at(0).metallic, 1.0f);
  EXPECT_EQ(scene->materials.at(0).roughness, 0.0f);
  EXPECT_EQ(scene->materials.at(0).clearcoat, 1.0f);
  EXPECT_THAT(scene->source.warnings, Contains(HasSubstr("3 numbers out of the range of glTF")));
}

TEST(GltfMaterials, WrongNumbersNameTheirPlace) {
  const std::pair<const char*, const char*> cases[] = {
      {R"({"normalTexture": {"index": 0, "scale": 1e30}})",
       "materials[0].normalTexture.scale: is 1e+30, which is not within -1000000 to 1000000"},
      {R"({"emissiveTexture": {"index": 0, "extensions": {
        "KHR_texture_transform": {"scale": [1e30, 1]}}}})",
       "KHR_texture_transform.scale[0]: is 1e+30, which is not within -100000000 to 100000000"},
  };
  for (const auto& [material, words] : cases) {
    GltfBuilder builder = with_image(test::png_of(1, 1, kGrey));
    builder.append("materials", Json::parse(material));
    EXPECT_THAT(error_of(builder.load()), HasSubstr(words));
  }
}

TEST(GltfTextures, AbsurdSizesFailBeforeAnyAllocation) {
  std::vector<std::uint8_t> png = test::png_of(1, 1, kGrey);
  // The width, big-endian, stands at byte 16
  png[18] = 0x80;
  GltfBuilder builder = with_image(png);
  builder.append("materials", Json::parse(R"({"emissiveTexture": {"index": 0}})"));
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_TRUE(scene->textures.empty());
  EXPECT_THAT(scene->source.warnings, Contains(HasSubstr("exceeds 16384")));
}

TEST(GltfTextures, MissingTextureCoordinatesAreAWarning) {
  GltfBuilder builder = with_image(test::png_of(1, 1, kGrey));
  builder.append("materials", Json::parse(R"({"emissiveTexture": {"index": 0}})"));
  builder.root["meshes"][0]["primitives"][0]["material"] = 0;
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_THAT(scene->source.warnings, Contains(HasSubstr("lack texture coordinates")));
}

}  // namespace
}  // namespace lambent::gltf_materials_test
