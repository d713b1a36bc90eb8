// SPDX-License-Identifier: Apache-2.0
// Output of the program: data on stdout; results, warnings and errors on stderr.
#pragma once

#include <string>
#include <vector>

#include "lambent/error.h"

namespace lambent::cli {

/// With --quiet, only errors are printed on stderr: no line of success, no warning, no progress.
/// Global, since there is one stderr.
void set_quiet(bool quiet);
bool is_quiet();
/// From now on, not even errors are printed, since another process of the same job prints them.
void set_mute();

/// Prints "lambent: TEXT" on stderr, unless the program is quiet.
void tell(const std::string& text);

/// Prints "lambent: warning: TEXT" on stderr, unless the program is quiet.
void warn(const std::string& text);

/// Prints "lambent: TEXT" on stderr.
void tell_error(const std::string& text);

/// Prints that a file was written: its name, its contents ("640x360 pixels"), its size, and the
/// time since the program started. `more` is further information, or empty.
void tell_written(const std::string& path, const std::string& what, const std::string& more = "");

/// Prints that several files were written, at least one, such as the pictures of a sequence.
void tell_written(const std::vector<std::string>& paths, const std::string& what,
                  const std::string& more = "");

/// Flushes stdout. Fails if any output could not be written.
Expected<void> finish_stdout();

}  // namespace lambent::cli
