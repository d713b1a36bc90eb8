// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/textures.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "scene/image_decode.h"

namespace lambent::gltf {
namespace {

// The image of a texture: WebP where there is one, else the plain one; -1: none that we can read.
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

Expected<Texture> decode_use(const Document& document, int image, bool srgb) {
  const ImageSource& source = document.images[image];
  const std::string place = entry("images", image);
  Texture texture;
  texture.name =
      source.name.empty() && source.uri.rfind("data:", 0) != 0 ? source.uri : source.name;
  if (texture.name.empty()) texture.name = place;
  texture.srgb = srgb;

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
  build_mips(texture);
  return texture;
}

}  // namespace

Expected<TextureView> TextureLibrary::view(int texture, int tex_coord,
                                           const tinygltf::ExtensionMap& extensions, bool srgb,
                                           const std::string& place) {
  const tinygltf::Texture& source = document_->model.textures[texture];
  const int image = image_of(source);
  if (image < 0) {
    document_->repaired("textures without an image of a supported format were left out", 1,
                        entry("textures", texture));
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

  // Share the texture with an earlier use of the image as the same
  const auto same = [image, srgb](const Use& use) {
    return use.image == image && use.srgb == srgb;
  };
  const auto found = std::find_if(uses_.begin(), uses_.end(), same);
  view.texture = static_cast<int>(found - uses_.begin());
  if (found == uses_.end()) uses_.push_back({image, srgb});
  return view;
}

Expected<std::vector<Texture>> TextureLibrary::decode() const {
  std::vector<Expected<Texture>> decoded(uses_.size(), Texture{});
  tbb::parallel_for(std::size_t{0}, uses_.size(), [&](std::size_t i) {
    decoded[i] = decode_use(*document_, uses_[i].image, uses_[i].srgb);
  });
  std::vector<Texture> textures;
  for (Expected<Texture>& texture : decoded) {
    if (!texture) return tl::unexpected(std::move(texture).error());
    textures.push_back(std::move(*texture));
  }
  return textures;
}

}  // namespace lambent::gltf
