// SPDX-License-Identifier: Apache-2.0
// Without the CPU backend there is no Embree: a world needs a device.
#include <stdexcept>

#include "raytracing/raytracer.h"

namespace lambent {

std::unique_ptr<RayTracer> make_embree_raytracer(const Scene&) {
  throw std::runtime_error("this build of Lambent traces rays on Vulkan devices alone");
}

}  // namespace lambent
