// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lambent {

/// Reinhard et al. 2002: the value of mid-grey that the log-average of a picture is brought to.
inline constexpr double kMidGrey = 0.18;

}  // namespace lambent
