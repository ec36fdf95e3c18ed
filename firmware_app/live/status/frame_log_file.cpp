#include "firmware_app/live/status/frame_log_file.h"

#include <cerrno>
#include <cstdint>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "pipeline/runtime/outcome.h"

namespace pleinair::app {
namespace {

/// Seconds on the steady clock.
std::string timeText(std::optional<hal::TimePoint> time) {
  if (!time) return {};
  return fmt::format("{:.9f}", std::chrono::duration<double>(time->time_since_epoch()).count());
}

std::string countText(std::optional<std::uint64_t> count) {
  return count ? std::to_string(*count) : std::string();
}

/// A field with commas or quotation marks in it stands between quotation marks (RFC 4180).
std::string csvField(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char each : text) field += each == '"' ? std::string("\"\"") : std::string(1, each);
  return field + '"';
}

}  // namespace

FrameLogFile::FrameLogFile(const std::filesystem::path& path, std::vector<std::string> outputs)
    : path_(path.string()), outputs_(std::move(outputs)), file_(path) {
  for (std::string& each : outputs_) each = csvField(each);
  file_ << "output,frame,captured_s,ready_s,due_s,due_refresh,shown_s,refresh,outcome\n"
        << std::flush;
  if (!file_) throw hal::Failure(hal::errnoError(path_, "cannot be written", errno));
}

hal::Result<void> FrameLogFile::update() {
  if (!file_) return {};
  const std::uint64_t lost = log_.take(records_);
  if (lost > 0) spdlog::warn("{}: {} frames are missing", path_, lost);
  if (records_.empty()) return {};
  for (const runtime::FrameRecord& each : records_) {
    file_ << fmt::format("{},{},{},{},{},{},{},{},{}\n", outputs_.at(each.output), each.sequence,
                         timeText(each.captured), timeText(each.ready), timeText(each.due),
                         countText(each.dueRefresh), timeText(each.shown), countText(each.refresh),
                         runtime::nameOf(each.outcome));
  }
  file_.flush();
  if (file_) return {};
  return tl::unexpected(hal::errnoError(path_, "cannot be written", errno));
}

}  // namespace pleinair::app
