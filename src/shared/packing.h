// SPDX-License-Identifier: Apache-2.0
#ifndef LAMBENT_SHARED_PACKING_H
#define LAMBENT_SHARED_PACKING_H
#include "shared/lang.h"
LAMBENT_BEGIN
LAMBENT_END
#endif
