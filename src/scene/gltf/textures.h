// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <set>

#include "lambent/scene.h"
#include "scene/gltf/document/document.h"

namespace lambent::gltf {

/// What a texture's texels are: sRGB-encoded colours; such colours with an alpha that tells how
/// much of each texel is covered; numbers; or a normal map's vectors.
enum class Texels : std::uint8_t { color, covering_color, data, normals };

/// Collects the uses of images by materials, as kinds of texels, and then decodes each use once.
class TextureLibrary {
 public:
  explicit TextureLibrary(Document& document) : document_(&document) {}

  /// How a material reads a glTF texture. Uses of one image as the same kind of texels share a
  /// texture. `texture`, `tex_coord` and `extensions` are those of a textureInfo; `place`
  /// is its material, for warnings. Empty, with a warning, where the texture has no image of a
  /// supported format.
  Expected<TextureView> view(int texture, int tex_coord, const tinygltf::ExtensionMap& extensions,
                             Texels texels, const std::string& place);

  /// The same of the alpha of a texture of glossiness, read as a metallic-roughness texture of
  /// roughness 1 - `factor` * alpha, whose metal is to be multiplied with 0.
  Expected<TextureView> view_of_glossiness(int texture, int tex_coord,
                                           const tinygltf::ExtensionMap& extensions, float factor,
                                           const std::string& place);

  /// Decodes all images in use, with MIP levels, in parallel, and updates the views of `materials`
  /// to refer to the result. One warning names the images that cannot be read. Materials then use
  /// their factors alone, except that without its map, emission is 0, since a map restricts it to
  /// lamps and screens.
  std::vector<Texture> decode(std::vector<Material>& materials);

 private:
  struct Use {
    int image;
    Texels texels;
    float glossiness;  ///< Its factor, above 0, where roughness is made of alpha; else 0.
    bool operator==(const Use&) const = default;
  };
  /// How a textureInfo reads its texture; `use` tells what of. Its image is filled in here.
  Expected<TextureView> view(int texture, int tex_coord, const tinygltf::ExtensionMap& extensions,
                             Use use, const std::string& place);
  static Expected<Texture> decode(const Document& document, const Use& use);
  void warn_of_missing(const std::vector<Expected<Texture>>& decoded,
                       const std::vector<Material>& materials);
  Document* document_;
  std::vector<Use> uses_;
  std::set<int> without_image_;  // textures of the file
};

}  // namespace lambent::gltf
