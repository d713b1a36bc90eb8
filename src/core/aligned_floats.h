// SPDX-License-Identifier: Apache-2.0
// Floats that start at a cache line, for kernels whose loads should not straddle two.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>

namespace lambent {

/// An array of floats, all 0 at first.
class AlignedFloats {
 public:
  AlignedFloats() = default;
  explicit AlignedFloats(std::size_t count)
      : floats_(static_cast<float*>(::operator new(count * sizeof(float), kAlignment))) {
    std::fill_n(floats_.get(), count, 0.0f);
  }
  float* data() { return floats_.get(); }
  const float* data() const { return floats_.get(); }

 private:
  static constexpr std::align_val_t kAlignment{64};
  struct Delete {
    void operator()(float* floats) const { ::operator delete(floats, kAlignment); }
  };
  std::unique_ptr<float, Delete> floats_;
};

}  // namespace lambent
