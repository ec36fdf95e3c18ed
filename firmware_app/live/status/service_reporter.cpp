#include "firmware_app/live/status/service_reporter.h"

#include <chrono>
#include <utility>

#include <fmt/format.h>

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;

/// Until the first picture, so that READY follows it closely; and afterwards.
constexpr hal::Duration kFirstInterval = 20ms;
constexpr hal::Duration kInterval = 250ms;
constexpr hal::Duration kStatusInterval = 5s;
/// While there is nothing to show a picture on, the start may take this much longer.
constexpr hal::Duration kExtension = 30s;
/// Signs of life, and waiting pictures, in a period of the watchdog.
constexpr int kFeedsInPeriod = 4;

}  // namespace

ServiceReporter::ServiceReporter(const ServiceManager& manager) : manager_(manager) {}

hal::Duration ServiceReporter::renewal() const {
  const auto period = manager_.watchdogPeriod();
  // A picture is renewed before a sign of life is due.
  return period ? *period / (kFeedsInPeriod + 1) : hal::Duration{0};
}

bool ServiceReporter::isDue(hal::TimePoint now) const {
  if (!manager_.isThere()) return false;
  return now - updatedAt_ >= (isReady_ ? kInterval : kFirstInterval);
}

void ServiceReporter::update(PresentationWatch::Seen seen, const std::string& status,
                             hal::TimePoint now) {
  updatedAt_ = now;
  watch_.update(std::move(seen), now);
  sendStatus(status, now);
  const hal::Duration period = manager_.watchdogPeriod().value_or(kExtension);
  const bool isBecomingReady = !isReady_ && watch_.hasShown();
  if (!isBecomingReady && now - fedAt_ < period / kFeedsInPeriod) return;
  if (!watch_.takeProgress()) return;
  fedAt_ = now;
  if (isBecomingReady) {
    isReady_ = true;
    manager_.notify("READY=1");
  }
  if (!isReady_) {
    manager_.notify(fmt::format("EXTEND_TIMEOUT_USEC={}", kExtension / 1us));
  } else if (manager_.watchdogPeriod()) {
    manager_.notify("WATCHDOG=1");
  }
}

void ServiceReporter::sendStatus(const std::string& status, hal::TimePoint now) {
  const std::string text = problem_.empty() ? status : problem_ + " · " + status;
  if (text == status_ || (!status_.empty() && now - statusAt_ < kStatusInterval)) return;
  status_ = text;
  statusAt_ = now;
  manager_.notify("STATUS=" + text);
}

void ServiceReporter::reloading(hal::TimePoint now) const {
  if (!isReady_) return;
  manager_.notify(fmt::format("RELOADING=1\nMONOTONIC_USEC={}", now.time_since_epoch() / 1us));
}

void ServiceReporter::reloaded(std::string problem) {
  problem_ = std::move(problem);
  status_.clear();
  if (isReady_) manager_.notify("READY=1");
}

}  // namespace pleinair::app
