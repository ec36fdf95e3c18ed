#include "hal/supervisor/hotplug_monitor.h"

#include <condition_variable>
#include <deque>
#include <mutex>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/hal/supervisor/supervised.h"

namespace pleinair::hal {
namespace {

/// Scripted device events.
class ScriptedEvents final : public DeviceEvents {
 public:
  struct Feed {
    void give(Result<DeviceEvent> event) {
      const std::scoped_lock lock(mutex);
      waiting.push_back(std::move(event));
      changed.notify_all();
    }
    /// Waits until all events were passed on and the monitor waits for another.
    void waitUntilTaken() {
      std::unique_lock lock(mutex);
      changed.wait(lock, [this] { return waiting.empty() && isAsked; });
    }
    std::mutex mutex;
    std::condition_variable changed;
    std::deque<Result<DeviceEvent>> waiting;
    bool isAsked = false;
    bool isInterrupted = false;
  };

  explicit ScriptedEvents(Feed& feed) : feed_(feed) {}

  Result<DeviceEvent> next() override {
    std::unique_lock lock(feed_.mutex);
    feed_.isAsked = true;
    feed_.changed.notify_all();
    feed_.changed.wait(lock, [this] { return !feed_.waiting.empty() || feed_.isInterrupted; });
    feed_.isAsked = false;
    if (feed_.waiting.empty()) return tl::unexpected(Error{.kind = ErrorKind::kNotFound});
    Result<DeviceEvent> event = std::move(feed_.waiting.front());
    feed_.waiting.pop_front();
    return event;
  }
  void interrupt() override {
    const std::scoped_lock lock(feed_.mutex);
    feed_.isInterrupted = true;
    feed_.changed.notify_all();
  }

 private:
  Feed& feed_;
};

TEST(HotplugMonitor, TellsOfEachEvent) {
  ScriptedEvents::Feed feed;
  std::vector<std::string> told;
  {
    const HotplugMonitor monitor(
        std::make_unique<ScriptedEvents>(feed),
        [&](const DeviceEvent& event) { told.push_back(event.action + " " + event.node); });
    feed.give(DeviceEvent{.action = "remove", .subsystem = "video4linux", .node = "/dev/video0"});
    feed.give(DeviceEvent{.action = "add", .subsystem = "usb", .node = ""});
    feed.waitUntilTaken();
  }
  EXPECT_THAT(told, testing::ElementsAre("remove /dev/video0", "add "));
}

TEST(HotplugMonitor, EndsWithItsEvents) {
  ScriptedEvents::Feed feed;
  const HotplugMonitor monitor(std::make_unique<ScriptedEvents>(feed), [](const DeviceEvent&) {});
  feed.give(tl::unexpected(Error{.kind = ErrorKind::kIo}));
}

TEST(HotplugMonitor, CutsASupervisorsBackOffShort) {
  Supervised supervised;
  supervised.run(std::chrono::milliseconds(4000));  // tried at 0, 0.5, 1.5, 3.5; then at 7.5 s
  ScriptedEvents::Feed feed;
  const HotplugMonitor monitor(std::make_unique<ScriptedEvents>(feed), [&](const DeviceEvent&) {
    supervised.supervisor().devicesChanged();
  });
  feed.give(DeviceEvent{.action = "add", .subsystem = "video4linux", .node = "/dev/video0"});
  feed.waitUntilTaken();
  EXPECT_EQ(firstOf(supervised.run(std::chrono::seconds(1)), "opening").at,
            std::chrono::milliseconds(4100));
}

TEST(UdevEvents, AreInterruptedOrSayWhyThereAreNone) {
  Result<std::unique_ptr<DeviceEvents>> events = udevEvents();
  if (!events) {
    EXPECT_FALSE(events.error().message().empty());
    GTEST_SKIP() << events.error().message();
  }
  // It ends, whatever events this machine's devices send in the meantime.
  const HotplugMonitor monitor(std::move(*events), [](const DeviceEvent&) {});
}

}  // namespace
}  // namespace pleinair::hal
