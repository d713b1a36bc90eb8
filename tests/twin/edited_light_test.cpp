// SPDX-License-Identifier: Apache-2.0
// Compares sums over the direct light along rays before and after an edit on a device with the
// processor's.
#include "field/edits/invalidation.h"
#include "support/vulkan_device.h"
#include "twin/field_update_cpu.h"
#include "vulkan/device_memory.h"

namespace lambent::edited_light_twin_test {
namespace {

class EditedLightTwin : public test::OnDevice {};

// Probes of even number trace twice as many rays as the others.
TEST_F(EditedLightTwin, IsThatOfTheProcessor) {
  constexpr float kClose = 1e-5f;
  const test::Stage stage("cornell");
  const test::UpdateOnCpu update(stage, test::few_probes());
  FieldResources field(device(), update.settings, update.store);
  field.write_surfels(update.all, update.traces);
  std::vector<ProbeTrace> edited = update.traces;
  for (ProbeTrace& trace : edited) {
    for (std::size_t i = 0; i < trace.surfels.size(); i += 3) trace.surfels[i].light *= 5.0f;
  }
  const DeviceProbes list = field.list(update.all);
  device().run([&](vulkan::Recorder& to) { field.record_rays_before(to, list); });
  field.write_surfels(update.all, edited);
  const vulkan::Buffer found(device(), update.all.size() * sizeof(EditedLight),
                             vulkan::Memory::readback, "edited light");
  device().run(
      [&](vulkan::Recorder& to) { field.record_edited_light(to, list, {found.address()}); });
  for (std::size_t k = 0; k < update.all.size(); ++k) {
    EditedLight expected{};
    for (std::size_t i = 0; i < edited[k].surfels.size(); ++i) {
      const Surfel& before = update.traces[k].surfels[i];
      const Surfel& after = edited[k].surfels[i];
      expected =
          add_ray(expected, static_cast<uint>(after.kind), ray_light(before), ray_light(after));
    }
    const EditedLight there = found.as<EditedLight>()[list.position[k]];
    EXPECT_EQ(there.rays, expected.rays);
    // Devices may fuse products with sums
    EXPECT_NEAR(there.before, expected.before, kClose * expected.before);
    EXPECT_NEAR(there.after, expected.after, kClose * expected.after);
    EXPECT_NEAR(there.before_squares, expected.before_squares, kClose * expected.before_squares);
    EXPECT_NEAR(there.after_squares, expected.after_squares, kClose * expected.after_squares);
    EXPECT_NEAR(there.products, expected.products, kClose * expected.products);
  }
}

}  // namespace
}  // namespace lambent::edited_light_twin_test
