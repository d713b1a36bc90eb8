// SPDX-License-Identifier: Apache-2.0
// The importance of each probe to a picture: its weight in the light of visible surfaces, directly
// and through other probes.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "field/probes/probe_store.h"
#include "field/transport/surfels.h"
#include "lambent/field.h"

namespace lambent {

/// The importance of every probe to the irradiance at the points, 0 to 1, where 1 is that of the
/// most important probe. All are 0 where no probe lights the points. Importance is the solution of
/// the adjoint of light transport, here for light that reaches the points from a probe directly,
/// and after one and two more bounces. The error at the points is the sum of the probes' errors,
/// weighted by their importance. Pattanaik and Mudur, "Adjoint Equations and Random Walks for
/// Illumination Computation", ACM TOG 14(1), 1995.
std::vector<float> probe_importance(const ProbeStore& store, std::span<const FieldQuery> points,
                                    std::span<const ProbeTrace> traces);

/// Scatters the importance of those probes that have more than `least` through their surfels to the
/// probes that these read. Takes and returns one number per probe.
using ImportanceScatter =
    std::function<std::vector<float>(std::span<const float> received, float least)>;

/// The ImportanceScatter of probes whose surfels are in `traces`.
std::vector<float> scatter_from_surfels(const ProbeStore& store, std::span<const ProbeTrace> traces,
                                        std::span<const float> received, float least);

/// probe_importance() with another implementation of the scattering.
std::vector<float> probe_importance(const ProbeStore& store, std::span<const FieldQuery> points,
                                    const ImportanceScatter& scatter_importance);

}  // namespace lambent
