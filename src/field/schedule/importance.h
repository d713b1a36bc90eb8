// SPDX-License-Identifier: Apache-2.0
// How much each probe matters to a picture: by what surfaces in it read of the probe, and by what
// the probes that these read receive through it.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "field/probes/probe_store.h"
#include "field/transport/surfels.h"
#include "lambent/field.h"

namespace lambent {

/// Importance of every probe to the irradiance at the points, 0 to 1, over that of the most
/// important one; all 0 where no probe lights them. It is the adjoint of light transport, of light
/// that reaches the points from a probe straight and after one and two more bounces; its error
/// there is the probe's error times this. Pattanaik and Mudur, "Adjoint Equations and Random Walks
/// for Illumination Computation", ACM TOG 14(1), 1995.
std::vector<float> probe_importance(const ProbeStore& store, std::span<const FieldQuery> points,
                                    std::span<const ProbeTrace> traces);

/// What surfels that probes see take of the probes' importance, where that is more than `least`:
/// what they receive of light that those reflect. One number a probe in and out.
using ImportanceScatter =
    std::function<std::vector<float>(std::span<const float> received, float least)>;

/// The same by another way of sending importance back.
std::vector<float> probe_importance(const ProbeStore& store, std::span<const FieldQuery> points,
                                    const ImportanceScatter& scatter_importance);

}  // namespace lambent
