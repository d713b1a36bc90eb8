// SPDX-License-Identifier: Apache-2.0
#include "lambent/progress_bar.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "lambent/console.h"
#include "lambent/words.h"

namespace lambent::cli {
namespace {

/// Stages that end within this time [s] are not shown.
constexpr double kQuietSeconds = 1.0;
/// Least time between two redraws [s]: eyes cannot follow more, and terminals are slow.
constexpr double kRedrawSeconds = 0.1;
constexpr int kMinBarColumns = 10, kMaxBarColumns = 40;
/// Time between two lines in a log [s]: a reader sees that work goes on, and few lines in all.
constexpr double kLogSeconds = 30.0;
/// A line in a log estimates the time that is left once a stage has taken this long [s]. Before,
/// its first rays would decide.
constexpr double kMinElapsedSeconds = 5.0;
/// Assumed width of a terminal that does not report it.
constexpr int kDefaultColumns = 80;
/// Moves to the start of the line and erases it (ECMA-48 EL).
constexpr std::string_view kWipe = "\r\x1b[K";

int terminal_columns() {
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return kDefaultColumns;
  return size.ws_col;
}

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// A share that a stage reports, within 0 to 1.
double limited_share(double share_done) {
  return std::isfinite(share_done) ? std::clamp(share_done, 0.0, 1.0) : 0.0;
}

/// "12 s left" of a stage of which this share, above 0, is done.
std::string time_left_text(double share, double elapsed_seconds) {
  return whole_seconds_text(elapsed_seconds * (1.0 - share) / share) + " left";
}

}  // namespace

std::string progress_line(std::string_view stage, double share_done, double elapsed_seconds,
                          int columns) {
  const double share = limited_share(share_done);
  char percent[16];
  std::snprintf(percent, sizeof percent, " %3d %%", static_cast<int>(share * 100.0));
  std::string tail = percent;
  if (share > 0.0) tail += "  " + time_left_text(share, elapsed_seconds);

  // The bar takes the rest of the line, and is omitted first where the terminal is narrow.
  std::string line(stage);
  const int room = columns - static_cast<int>(line.size() + tail.size()) - 4;
  if (room >= kMinBarColumns) {
    const int bar = std::min(room, kMaxBarColumns);
    const int full = static_cast<int>(share * bar);
    line += "  [" + std::string(static_cast<std::size_t>(full), '#') +
            std::string(static_cast<std::size_t>(bar - full), '.') + "]";
  }
  line += tail;
  return line.substr(0, static_cast<std::size_t>(std::max(columns, 0)));
}

ProgressBar::ProgressBar(Write write, Clock clock, int columns)
    : write_(std::move(write)), clock_(std::move(clock)), columns_(columns) {}

void ProgressBar::update(std::string_view stage, double share_done) {
  const double now = clock_();
  if (stage != stage_) {
    clear();
    stage_ = stage;
    stage_start_ = now;
    last_drawn_ = now;
  }
  if (share_done >= 1.0) {
    clear();
    // The same stage may come again, such as in the next frame, and then starts anew.
    stage_.clear();
    return;
  }
  if (now - stage_start_ < kQuietSeconds || now - last_drawn_ < kRedrawSeconds) return;
  // Leave the last column free, since writing there makes some terminals wrap.
  write_(std::string(kWipe) + progress_line(stage, share_done, now - stage_start_, columns_ - 1));
  last_drawn_ = now;
  drawn_ = true;
}

void ProgressBar::clear() {
  if (drawn_) write_(kWipe);
  drawn_ = false;
}

ProgressLog::ProgressLog(Write write, Clock clock)
    : write_(std::move(write)), clock_(std::move(clock)), last_written_(clock_()) {}

void ProgressLog::update(std::string_view stage, double share_done) {
  const double now = clock_();
  if (stage != stage_) {
    stage_ = stage;
    stage_start_ = now;
  }
  if (share_done >= 1.0) stage_.clear();  // the same stage may come again
  if (share_done >= 1.0 || now - last_written_ < kLogSeconds) return;
  const double share = limited_share(share_done), elapsed = now - stage_start_;
  std::string line =
      std::string(stage) + ": " + std::to_string(static_cast<int>(share * 100.0)) + " %";
  if (share > 0.0 && elapsed >= kMinElapsedSeconds) line += ", " + time_left_text(share, elapsed);
  write_(line);
  last_written_ = now;
}

ProgressFn stderr_progress() {
  if (is_quiet() || isatty(STDERR_FILENO) != 0) return terminal_progress();
  const auto log = std::make_shared<ProgressLog>(
      [](std::string_view line) { tell(std::string(line)); }, steady_seconds);
  return [log](std::string_view stage, double share_done) { log->update(stage, share_done); };
}

ProgressFn terminal_progress() {
  if (is_quiet() || isatty(STDERR_FILENO) == 0) return {};
  const auto write = [](std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
  };
  const auto bar = std::make_shared<ProgressBar>(write, steady_seconds, terminal_columns());
  return [bar](std::string_view stage, double share_done) { bar->update(stage, share_done); };
}

}  // namespace lambent::cli
