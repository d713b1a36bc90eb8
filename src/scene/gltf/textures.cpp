// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/textures.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/image_decode.h"
#include "scene/texture.h"

namespace lambent::gltf {
namespace {

// The image of a texture: WebP if there is one, else the plain one; -1: none is supported.
int image_of(const tinygltf::Texture& texture) {
  if (const auto* webp = find_extension(texture.extensions, "EXT_texture_webp")) {
    return integer_or(*webp, "source", -1);
  }
  return texture.source;
}

Wrap wrap_of(int mode) {
  if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::clamp_to_edge;
  if (mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return Wrap::mirrored_repeat;
  return Wrap::repeat;
}

void apply_transform(const tinygltf::Value& transform, TextureView& view) {
  const auto pair = [&transform](const char* key, glm::vec2& value) {
    if (!transform.Has(key)) return;
    const tinygltf::Value& numbers = transform.Get(key);
    value = glm::vec2(numbers.Get(0).GetNumberAsDouble(), numbers.Get(1).GetNumberAsDouble());
  };
  pair("offset", view.uv_offset);
  pair("scale", view.uv_scale);
  view.uv_rotation = static_cast<float>(number_or(transform, "rotation", 0.0));
}

// Turns glossiness, in alpha, into the green of a metallic-roughness texture.
void make_roughness(float glossiness_factor, TextureLevel& level) {
  constexpr float kLargest = 255.0f;
  for (std::size_t i = 0; i + 3 < level.rgba.size(); i += 4) {
    const float glossiness = glossiness_factor * static_cast<float>(level.rgba[i + 3]);
    const auto roughness = static_cast<std::uint8_t>(std::lround(kLargest - glossiness));
    level.rgba[i] = level.rgba[i + 2] = 0;
    level.rgba[i + 1] = roughness;
    level.rgba[i + 3] = 255;
  }
}

}  // namespace

Expected<Texture> TextureLibrary::decode(const Document& document, const Use& use) {
  const ImageSource& source = document.images[use.image];
  const std::string place = entry("images", use.image);
  Texture texture;
  texture.name =
      source.name.empty() && source.uri.rfind("data:", 0) != 0 ? source.uri : source.name;
  if (texture.name.empty()) texture.name = place;
  texture.srgb = use.texels == Texels::color || use.texels == Texels::covering_color;

  Bytes file_bytes;
  ByteSpan bytes;
  if (!source.uri.empty()) {
    LAMBENT_TRY(content, read_uri(document, source.uri, place));
    file_bytes = std::move(content);
    bytes = file_bytes;
  } else if (source.buffer_view >= 0) {
    LAMBENT_TRY(content, view_bytes(document, source.buffer_view));
    bytes = content;
  } else {
    return document.fail_at(place, "the image has neither a uri nor a buffer view");
  }
  LAMBENT_TRY(level, decode_image(bytes, document.file, place));
  texture.levels.push_back(std::move(level));
  if (use.glossiness > 0.0f) make_roughness(use.glossiness, texture.levels.front());
  if (use.texels == Texels::normals) {
    build_normal_mips(texture);
  } else {
    const bool covers = use.texels == Texels::covering_color;
    build_mips(texture, covers ? MipWeights::alpha : MipWeights::equal);
  }
  return texture;
}

namespace {

// Maximum number of names listed in a warning; the rest is counted.
constexpr std::size_t kNamed = 3;

// The materials that use a texture for which reads_texture(index) is true, for display.
template <class Reads>
std::string users_of(const std::vector<Material>& materials, Reads reads_texture) {
  std::size_t users = 0;
  std::string named;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const auto views = texture_views(materials[i]);
    const bool reads = std::any_of(views.begin(), views.end(), [&](const TextureView* view) {
      return view->texture >= 0 && reads_texture(view->texture);
    });
    if (!reads) continue;
    ++users;
    if (users > kNamed) continue;
    named += (users > 1 ? ", " : "") +
             (materials[i].name.empty() ? entry("materials", i) : "'" + materials[i].name + "'");
  }
  if (users > kNamed) named += " and " + std::to_string(users - kNamed) + " more";
  return (users == 1 ? "material " : "materials ") + named;
}

}  // namespace

Expected<TextureView> TextureLibrary::view(int texture, int tex_coord,
                                           const tinygltf::ExtensionMap& extensions, Texels texels,
                                           const std::string& place) {
  return view(texture, tex_coord, extensions, Use{-1, texels, 0.0f}, place);
}

Expected<TextureView> TextureLibrary::view_of_glossiness(int texture, int tex_coord,
                                                         const tinygltf::ExtensionMap& extensions,
                                                         float factor, const std::string& place) {
  return view(texture, tex_coord, extensions, Use{-1, Texels::data, factor}, place);
}

Expected<TextureView> TextureLibrary::view(int texture, int tex_coord,
                                           const tinygltf::ExtensionMap& extensions, Use use,
                                           const std::string& place) {
  const tinygltf::Texture& source = document_->model.textures[texture];
  const int image = image_of(source);
  if (image < 0) {
    const bool ktx2 = find_extension(source.extensions, "KHR_texture_basisu") != nullptr;
    document_->repaired(
        ktx2 ? "textures were left out, and their materials show their plain factors: they exist "
               "only as KTX2 (KHR_texture_basisu), which is not read; convert them to PNG, JPEG or "
               "WebP"
             : "textures were left out, and their materials show their plain factors: they have no "
               "image of a supported format",
        without_image_.insert(texture).second ? 1 : 0, entry("textures", texture));
    return TextureView{};
  }

  TextureView view;
  if (source.sampler >= 0) {
    const tinygltf::Sampler& sampler = document_->model.samplers[source.sampler];
    view.wrap_u = wrap_of(sampler.wrapS);
    view.wrap_v = wrap_of(sampler.wrapT);
    view.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
  }
  view.uv_set = tex_coord;
  if (const auto* transform = find_extension(extensions, "KHR_texture_transform")) {
    apply_transform(*transform, view);
    view.uv_set = integer_or(*transform, "texCoord", tex_coord);
  }
  if (view.uv_set > 1) {
    document_->repaired("textures use TEXCOORD_2 or higher and read TEXCOORD_0 instead", 1, place);
    view.uv_set = 0;
  }

  // Share the texture with an earlier use of the image of the same kind
  use.image = image;
  const auto found = std::find(uses_.begin(), uses_.end(), use);
  view.texture = static_cast<int>(found - uses_.begin());
  if (found == uses_.end()) uses_.push_back(use);
  return view;
}

std::vector<Texture> TextureLibrary::decode(std::vector<Material>& materials) {
  std::vector<Expected<Texture>> decoded(uses_.size(), Texture{});
  tbb::parallel_for(std::size_t{0}, uses_.size(),
                    [&](std::size_t i) { decoded[i] = decode(*document_, uses_[i]); });
  warn_of_missing(decoded, materials);

  std::vector<Texture> textures;
  std::vector<int> index_of(decoded.size(), -1);
  for (std::size_t i = 0; i < decoded.size(); ++i) {
    if (!decoded[i]) continue;
    index_of[i] = static_cast<int>(textures.size());
    textures.push_back(std::move(*decoded[i]));
  }
  for (Material& material : materials) {
    const bool had_emission_map = material.emission_texture.texture >= 0;
    for (TextureView* view : texture_views(material)) {
      if (view->texture < 0) continue;
      view->texture = index_of[view->texture];
      if (view->texture < 0) *view = TextureView{};
    }
    if (had_emission_map && material.emission_texture.texture < 0) {
      material.emission = glm::vec3(0.0f);
    }
  }
  return textures;
}

void TextureLibrary::warn_of_missing(const std::vector<Expected<Texture>>& decoded,
                                     const std::vector<Material>& materials) {
  std::set<int> missing_images;
  std::string named;
  for (std::size_t i = 0; i < decoded.size(); ++i) {
    // Report an image that is read as color and as data only once
    const int image = uses_[i].image;
    if (decoded[i] || !missing_images.insert(image).second) continue;
    if (missing_images.size() > kNamed) continue;
    const Error& error = decoded[i].error();
    named += (missing_images.size() > 1 ? "; " : "") + error.place + ": " + error.cause + ", in " +
             users_of(materials, [&](int texture) { return uses_[texture].image == image; });
  }
  const std::size_t missing = missing_images.size();
  if (missing == 0) return;
  if (missing > kNamed) named += "; and " + std::to_string(missing - kNamed) + " more";
  document_->warn(
      std::to_string(missing) +
      (missing == 1 ? " texture could not be read and is" : " textures could not be read and are") +
      " left out; materials show their plain factors, and emit nothing where the "
      "emission map is missing: " +
      named + ".");
}

}  // namespace lambent::gltf
