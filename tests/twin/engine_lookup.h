// SPDX-License-Identifier: Apache-2.0
// What the lookup for engines is tried with.
#ifndef LAMBENT_TESTS_TWIN_ENGINE_LOOKUP_H
#define LAMBENT_TESTS_TWIN_ENGINE_LOOKUP_H

#include "field/lookup/field_record.h"

LAMBENT_BEGIN

struct EngineLookupArguments {
  FieldRecord field;
  QueryArray queries;
  Vec3Array irradiance;
  uint count;
  uint unused;
};

/// The same for a lookup that traces rays in the engine's structure.
struct EngineLookupByRaysArguments {
  EngineLookupArguments lookup;
  uvec2 structure;  ///< Its address, low word first.
};

LAMBENT_END
#endif
