// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lambent::cli {

/// Notes what the program does from now on, as "reading the scene": what is told where memory runs
/// out. `doing` must live on.
void begin_step(const char* doing);

/// What was begun last.
const char* current_step();

}  // namespace lambent::cli
