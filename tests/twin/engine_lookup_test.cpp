// SPDX-License-Identifier: Apache-2.0
// The lookup that engines include in their shaders, against the processor's.
#include "twin/engine_lookup.h"

#include <algorithm>

#include "field/lookup/lookup_volumes.h"
#include "shaders/engine_lookup_comp.h"
#include "shaders/engine_lookup_other_comp.h"
#include "support/vulkan_device.h"
#include "support/walked_volumes.h"
#include "vulkan/buffer.h"
#include "vulkan/recorder.h"

namespace lambent::engine_lookup_test {
namespace {

// Sums in another order, divisions and square roots of the device's own making; visibility is the
// cube of a quotient of small differences. A share of the answer's largest channel.
constexpr float kTolerance = 1e-4f;

class EngineLookup : public test::OnDevice {
 protected:
  /// Looks the store up by a shader, and compares.
  void compare(const FieldSettings& settings, vulkan::Spirv shader) {
    const ProbeStore store = test::walked_store(settings);
    const std::vector<FieldQuery> queries = test::walked_queries(2000);
    std::vector<vec3> expected(queries.size());
    lookup_irradiance(store, {}, queries, expected);

    const vulkan::Buffer grids = vulkan::upload(device(), store.grids(), "grids");
    const vulkan::Buffer offsets = vulkan::upload(device(), store.offset_words(), "offsets");
    const vulkan::Buffer light = vulkan::upload(device(), store.irradiance_words(), "irradiance");
    const vulkan::Buffer far = vulkan::upload(device(), store.distance_words(), "distance");
    const vulkan::Buffer asked = vulkan::upload(device(), queries, "queries");
    const vulkan::Buffer found(device(), sizeof(vec3) * queries.size(), vulkan::Memory::device,
                               "found");
    const FieldRecord field = {
        {{grids.address()}, {offsets.address()}, {light.address()}, {far.address()}},
        {},
        {},
        store.volumes(),
        kVisibilityMoments};
    const auto count = static_cast<std::uint32_t>(queries.size());
    const EngineLookupArguments arguments = {
        field, {asked.address()}, {found.address()}, count, 0u};
    const vulkan::Kernel kernel(device(), shader, "engine");
    device().run([&](vulkan::Recorder& to) { to.run(kernel, arguments, count); });
    const std::vector<vec3> answers = vulkan::download<vec3>(device(), found);
    for (std::size_t i = 0; i < answers.size(); ++i) {
      const vec3 e = expected[i], off = abs(e - answers[i]);
      ASSERT_LE(std::max({off.x, off.y, off.z}), kTolerance * std::max({e.x, e.y, e.z})) << i;
    }
  }
};

TEST_F(EngineLookup, AnswersAsTheProcessorDoes) {
  compare(test::walked_settings(), shaders::engine_lookup_comp());
}

TEST_F(EngineLookup, OfOtherTilesAndFormatsDoes) {
  FieldSettings settings = test::walked_settings();
  settings.irradiance_texels = 6;
  settings.distance_texels = 8;
  settings.irradiance_format = IrradianceFormat::r11g11b10f;
  settings.distance_format = DistanceFormat::rg32f;
  compare(settings, shaders::engine_lookup_other_comp());
}

}  // namespace
}  // namespace lambent::engine_lookup_test
