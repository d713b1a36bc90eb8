// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "scene/gltf/document/document.h"

namespace lambent::gltf {

/// What the importer makes of an extension.
struct Extension {
  const char* name;
  bool required;     ///< May stand in extensionsRequired: the picture is right.
  const char* note;  ///< What is lost where the file only uses it; null: nothing.
};

/// Every extension that the importer knows, sorted by name.
std::span<const Extension> known_extensions();

/// Fails with the name of a required extension that is not supported; warns of optional ones.
Expected<void> check_extensions(Document& document);

}  // namespace lambent::gltf
