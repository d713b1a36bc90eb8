// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace lambent {

/// How lookups are corrected by what the field has learned of how far they are off.
enum class CorrectionUse : std::uint8_t {
  smooth,  ///< Interpolated between cells: for what is shown as it is.
  picked,  ///< By one cell each, picked at random: for many lookups whose mean counts.
  none,
};

}  // namespace lambent
