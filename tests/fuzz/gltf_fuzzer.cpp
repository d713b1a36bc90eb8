// SPDX-License-Identifier: Apache-2.0
// Feeds arbitrary bytes to the importer. Whatever it makes of them must hold what every pass relies
// on.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "fuzz/gltf_input.h"
#include "scene/gltf/import.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = lambent::test::gltf_from_fuzz_input({data, size});
  lambent::Expected<lambent::Scene> scene = lambent::load_scene_from_memory(file);
  if (scene && !lambent::validate(*scene)) std::abort();
  for (const float time_s : {0.0f, 0.5f, 1e30f}) {
    if (!scene) break;
    lambent::animate(*scene, -1, time_s);
    if (!lambent::validate(*scene)) std::abort();
  }
  if (!scene && scene.error().cause.empty()) std::abort();
  return 0;
}
