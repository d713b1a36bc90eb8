// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "scene/gltf/document/document.h"

namespace lambent::gltf {

/// The importer's support of an extension.
struct Extension {
  const char* name;
  bool required;     ///< Supported in extensionsRequired: pictures are correct.
  const char* note;  ///< What is lost if the extension is used but not required; null: nothing.
};

/// Every extension that the importer knows, sorted by name.
std::span<const Extension> known_extensions();

/// Fails with the name of a required extension that is not supported; warns of optional ones.
Expected<void> check_extensions(Document& document);

}  // namespace lambent::gltf
