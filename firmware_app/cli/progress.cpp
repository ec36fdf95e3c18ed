#include "firmware_app/cli/progress.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "firmware_app/cli/standard_streams.h"

namespace pleinair::app {
namespace {

constexpr hal::Duration kRedrawPeriod = std::chrono::milliseconds(250);

double rate(std::uint64_t done, hal::Duration elapsed) {
  const double seconds = hal::toSeconds(elapsed);
  return seconds > 0.0 ? static_cast<double>(done) / seconds : 0.0;
}

}  // namespace

std::string progressLine(const std::string& subcommand, std::uint64_t done,
                         std::optional<std::uint64_t> total, hal::Duration elapsed) {
  const double perSecond = rate(done, elapsed);
  std::string line = total ? fmt::format("{} {}/{}", subcommand, done, *total)
                           : fmt::format("{} frame {}", subcommand, done);
  line += fmt::format("  {:.1f} frames/s", perSecond);
  if (total && perSecond > 0.0) {
    const auto left = static_cast<double>(*total - std::min(done, *total)) / perSecond;
    line += fmt::format("  {} s left", std::lround(left));
  }
  return line;
}

Progress::Progress(std::string subcommand, std::optional<std::uint64_t> total,
                   const hal::Clock& clock)
    : subcommand_(std::move(subcommand)),
      total_(total),
      clock_(clock),
      began_(clock.now()),
      drawn_(began_),
      isTerminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (!isTerminal_) return;
  draw();
  std::fputc('\n', stderr);
}

void Progress::advance() {
  ++done_;
  if (!isTerminal_ || clock_.now() - drawn_ < kRedrawPeriod) return;
  drawn_ = clock_.now();
  draw();
}

void Progress::interrupt() {
  if (!isTerminal_) return;
  writeText(stderr, "\r\x1b[K");
  std::fflush(stderr);
  drawn_ = clock_.now() - kRedrawPeriod;
}

double Progress::framesPerSecond() const {
  return rate(done_, elapsed());
}

hal::Duration Progress::elapsed() const {
  return clock_.now() - began_;
}

void Progress::draw() const {
  // Carriage return, text, then clear to the end of the line.
  writeText(stderr, fmt::format("\r{}\x1b[K", progressLine(subcommand_, done_, total_, elapsed())));
  std::fflush(stderr);
}

}  // namespace pleinair::app
