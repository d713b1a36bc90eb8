// SPDX-License-Identifier: Apache-2.0
#include "compose/gather/excess.h"

#include <algorithm>
#include <cassert>

#include "compose/frame_tasks.h"
#include "core/parallel.h"

namespace lambent {

void add_excess(const DenoiseView& view, std::span<const glm::vec3> excess,
                std::span<const glm::vec3> detail, const DenoiseSettings& settings,
                Denoiser& denoiser, std::vector<glm::vec3>& scratch,
                std::span<glm::vec3> filtered) {
  const auto is_some = [](const glm::vec3& light) { return light != glm::vec3(0.0f); };
  if (std::none_of(excess.begin(), excess.end(), is_some)) return;
  scratch.resize(excess.size());
  [[maybe_unused]] const Expected<void> done =
      denoiser.filter(view, {excess, detail, {}}, settings, scratch);
  assert(done);  // sizes are the view's
  parallel_chunks(excess.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) filtered[i] += scratch[i];
  });
}

void filter_gathered(const DenoiseView& view, const NoisyLight& light,
                     std::span<const glm::vec3> excess, Denoiser& denoiser,
                     std::vector<glm::vec3>& scratch, std::span<glm::vec3> filtered) {
  [[maybe_unused]] const Expected<void> done = denoiser.filter(view, light, {}, filtered);
  assert(done);  // sizes are the view's
  add_excess(view, excess, filtered, geometric_denoising(), denoiser, scratch, filtered);
}

}  // namespace lambent
