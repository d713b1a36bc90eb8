// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lambent::cli {

/// Sets the current step of the program, such as "reading the scene", which is reported where
/// memory runs out. `doing` must remain valid.
void begin_step(const char* doing);

/// The current step.
const char* current_step();

}  // namespace lambent::cli
