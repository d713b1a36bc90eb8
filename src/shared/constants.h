// SPDX-License-Identifier: Apache-2.0
#ifndef LAMBENT_SHARED_CONSTANTS_H
#define LAMBENT_SHARED_CONSTANTS_H

#include "shared/lang.h"

LAMBENT_BEGIN

const float kPi = 3.14159265358979f;
const float kTwoPi = 6.28318530717959f;
const float kInvPi = 0.318309886183791f;
const float kGoldenRatio = 1.61803398874989f;

LAMBENT_END
#endif
