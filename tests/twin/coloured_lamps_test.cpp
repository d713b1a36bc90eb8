// SPDX-License-Identifier: Apache-2.0
// Light of lamps of several colours is filtered on a device as on the host.
#include <cstdio>

#include "core/image/metrics.h"
#include "lambent/renderer.h"
#include "lambent/world.h"
#include "support/coloured_lamps.h"
#include "support/vulkan_device.h"

namespace lambent::coloured_lamps_twin {
namespace {

using ColouredLampsTwin = test::OnDevice;

constexpr double kTolerance = 1e-3;  // rounding

TEST_F(ColouredLampsTwin, HaveTheSameFilteredLight) {
  const Scene scene = test::two_lamps();
  const World here(scene), there(scene, shared_device());
  FrameSettings settings = quality_settings(Quality::interactive);
  settings.width = settings.height = 48;
  // Of one sample, whose variance is estimated, and of several, whose variance is measured
  for (const int samples : {1, 4}) {
    settings.emissive_samples = samples;
    const auto direct_of = [&](const World& world) {
      return *Renderer(world).render(scene.cameras[0], settings).value().image.find("direct");
    };
    const Metrics found =
        compare_images(direct_of(there), direct_of(here), {.block = 1, .perceptual = false})
            .value();
    std::printf("%d samples: relative RMSE %.2e\n", samples, found.relative_rmse);
    EXPECT_LE(found.relative_rmse, kTolerance) << samples;
  }
}

}  // namespace
}  // namespace lambent::coloured_lamps_twin
