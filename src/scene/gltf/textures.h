// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lambent/scene.h"
#include "scene/gltf/document/document.h"

namespace lambent::gltf {

/// Collects which images materials use, and as what; then decodes each use once.
class TextureLibrary {
 public:
  explicit TextureLibrary(Document& document) : document_(&document) {}

  /// How a material reads a glTF texture. Uses of one image share a texture, but colour (`srgb`)
  /// and data do not. `texture`, `tex_coord` and `extensions` are those of a textureInfo; `place`
  /// is its material, for warnings. Empty, with a warning, where the texture has no image that we
  /// can read.
  Expected<TextureView> view(int texture, int tex_coord, const tinygltf::ExtensionMap& extensions,
                             bool srgb, const std::string& place);

  /// Decodes everything asked for, with MIPs, in parallel. In the order in which views were asked
  /// for.
  Expected<std::vector<Texture>> decode() const;

 private:
  struct Use {
    int image;
    bool srgb;
  };
  Document* document_;
  std::vector<Use> uses_;
};

}  // namespace lambent::gltf
