#include "firmware_app/service_manager/service_manager.h"

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/notify_socket.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

class ServiceManagerTest : public testing::Test {
 protected:
  support::TemporaryFolder folder_;
  support::NotifySocket socket_{folder_.path() / "notify"};
};

TEST_F(ServiceManagerTest, GetsTheMessages) {
  const ServiceManager manager({.notifySocket = socket_.path(), .watchdogUsec = {}});
  ASSERT_TRUE(manager.isThere());
  EXPECT_FALSE(manager.watchdogPeriod());
  manager.notify("READY=1\nSTATUS=painting");
  EXPECT_THAT(socket_.take(), ElementsAre("READY=1\nSTATUS=painting"));
}

TEST_F(ServiceManagerTest, MayListenAtAnAbstractName) {
  const std::string name = "pleinair-test-" + std::to_string(getpid());
  const int listening = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0);
  sockaddr_un here{};
  here.sun_family = AF_UNIX;
  std::memcpy(&here.sun_path[1], name.data(), name.size());
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  ASSERT_EQ(bind(listening, reinterpret_cast<const sockaddr*>(&here), length), 0);
  const ServiceManager manager({.notifySocket = "@" + name, .watchdogUsec = {}});
  manager.notify("READY=1");
  std::array<char, 16> text{};
  EXPECT_EQ(recv(listening, text.data(), text.size(), 0), 7);
  close(listening);
}

TEST_F(ServiceManagerTest, WantsSignsOfLifeOfThisProcessOnly) {
  ServiceEnvironment environment{.notifySocket = socket_.path(), .watchdogUsec = "10000000"};
  EXPECT_EQ(ServiceManager(environment).watchdogPeriod(), 10s);
  environment.watchdogPid = std::to_string(getpid());
  EXPECT_EQ(ServiceManager(environment).watchdogPeriod(), 10s);
  environment.watchdogPid = std::to_string(getppid());
  EXPECT_FALSE(ServiceManager(environment).watchdogPeriod());
  for (const char* wrong : {"", "0", "-1", "soon", "10s"}) {
    environment = {.notifySocket = socket_.path(), .watchdogUsec = wrong};
    EXPECT_FALSE(ServiceManager(environment).watchdogPeriod()) << wrong;
  }
}

TEST_F(ServiceManagerTest, NeedNotBeThere) {
  for (const std::string& name : {std::string(), std::string("relative"), std::string(200, '/')}) {
    const ServiceManager manager({.notifySocket = name, .watchdogUsec = "10000000"});
    EXPECT_FALSE(manager.isThere());
    EXPECT_FALSE(manager.watchdogPeriod());
    manager.notify("READY=1");
  }
  const ServiceManager gone({.notifySocket = "/nowhere/notify", .watchdogUsec = {}});
  gone.notify("READY=1");
}

TEST_F(ServiceManagerTest, IsTakenOutOfTheEnvironment) {
  setenv("NOTIFY_SOCKET", socket_.path().c_str(), 1);
  setenv("WATCHDOG_USEC", "5", 1);
  const ServiceEnvironment environment = takeServiceEnvironment();
  EXPECT_EQ(environment.notifySocket, socket_.path());
  EXPECT_EQ(environment.watchdogUsec, "5");
  EXPECT_EQ(environment.watchdogPid, "");
  EXPECT_EQ(std::getenv("NOTIFY_SOCKET"), nullptr);
  EXPECT_EQ(std::getenv("WATCHDOG_USEC"), nullptr);
}

}  // namespace
}  // namespace pleinair::app
