// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace lambent {

/// How lookups read the corrections that the field has learned.
enum class CorrectionUse : std::uint8_t {
  smooth,  ///< Interpolates between cells, for lookups that are displayed.
  picked,  ///< Reads one random cell, for many lookups of which only the mean matters.
  none,    ///< Lookups are not corrected.
};

}  // namespace lambent
