// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdio>
#include <functional>
#include <string>
#include <string_view>

#include "lambent/progress.h"

namespace lambent::cli {

/// One line such as "trace  [#####.....]  50 %  12 s left" of at most `columns` characters.
std::string progress_line(std::string_view stage, double share_done, double elapsed_seconds,
                          int columns);

/// Draws the progress of successive stages on one line of a terminal, and erases it when a stage is
/// done. Stages of under a second are not shown.
class ProgressBar {
 public:
  using Clock = std::function<double()>;  ///< Seconds since some fixed moment.
  using Write = std::function<void(std::string_view)>;

  ProgressBar(Write write, Clock clock, int columns);
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar() { clear(); }

  void update(std::string_view stage, double share_done);
  /// Erases the line, so that other output starts on an empty one.
  void clear();

 private:
  Write write_;
  Clock clock_;
  int columns_;
  std::string stage_;
  double stage_start_ = 0.0;
  double last_drawn_ = 0.0;
  bool drawn_ = false;
};

/// Writes the progress of successive stages as lines for a log, one every half minute.
class ProgressLog {
 public:
  using Clock = ProgressBar::Clock;
  using Write = ProgressBar::Write;  ///< Of a line, without its end.

  ProgressLog(Write write, Clock clock);

  void update(std::string_view stage, double share_done);

 private:
  Write write_;
  Clock clock_;
  double last_written_;
  std::string stage_;
  double stage_start_ = 0.0;
};

/// Shows progress on stderr, as a bar on a terminal and as lines elsewhere, unless the program is
/// quiet.
ProgressFn stderr_progress();

/// Shows progress on stderr if that is a terminal and the program is not quiet; silent otherwise.
/// The line is erased when the last copy of the function is destroyed.
ProgressFn terminal_progress();

}  // namespace lambent::cli
